"""Measured heights, of which there are no more than were measured: their error is what leaving out points changes.

The same loads are solved on every second point. Where heights are rough down to their spacing, the change tells what
finer points would add; elsewhere it is the error of the grid. It is a change, not a bound.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Body, Scene
from contactsim.errors import InputError, Words
from contactsim.grid import Grid
from contactsim.observables.dataset_forms import KEPT_NUMBERS
from contactsim.paths.options import Setup
from contactsim.surfaces.measured import MeasuredLine
from contactsim.surfaces.open_statistics import rms_gradient_open
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.topography import Topography

TOLERANCE = 1e-4
"""Tolerance at which measured heights are solved, in grid steps: its error is far below that of the spacing."""
MIN_POINTS = 8
"""Fewest measured points each way, of which half make the coarser grid."""
WAVE_POINTS = 4.0
"""Spacings in the shortest wavelength that measured heights are taken to have, for costs."""
TYPICAL_HURST = 0.8
"""Hurst exponent that measured heights are taken to have, for costs."""
QUANTITIES = (
    "relative_contact_area_subgrid",
    "relative_contact_area",
    "relative_contact_area_corrected",
    "approach",
    "mean_gap",
    "max_pressure",
    "rms_gradient_contact_subgrid",
)
"""Numbers of a load whose error can be asked for."""
KEPT_QUANTITIES = {"contact_stiffness": "stiffness", "patches": "patches", "largest_patch_share": "patches"}
"""The same of those that a run has to keep: under which name it does."""


@dataclass(frozen=True)
class MeasuredRoughness:
    """Measured heights as costs see them: a self-affine surface up to half of their length.

    Parameters
    ----------
    long_cutoff, effective_short_cutoff : float
        Longest and shortest wavelength, nm.
    profile_rms_gradient : float
        Rms gradient of the heights of both bodies together.
    hurst_exponent : float
        Taken as typical.
    """

    long_cutoff: float
    effective_short_cutoff: float
    profile_rms_gradient: float
    hurst_exponent: float = TYPICAL_HURST


@lru_cache(maxsize=4)
def measure_roughness(scene: Scene) -> MeasuredRoughness:
    """Return the roughness of the measured heights of a scene."""
    heights = scene.heights(Setup(scene).points)
    spacing = Grid(heights.shape, scene.lengths).spacing
    gradient = rms_gradient_open(heights, spacing)
    if not gradient > 0:
        raise InputError("surface", "flat heights", "heights that differ, for a forecast or an accuracy")
    short = WAVE_POINTS * max(spacing)
    return MeasuredRoughness(max(min(scene.lengths) / 2, short), short, gradient)


def is_measured(scene: Scene) -> bool:
    """Return True where the heights of a body are measured, so that the grid is given."""
    return any(body.surface.points is not None for body in (scene.lower, scene.upper))


def choose_measured(setup: Setup, quantities: Sequence[str]) -> Setup:
    """Return a setup of measured heights with the tolerance of an error-controlled run.

    Raises
    ------
    InputError
        For smooth laws, whose path would need increments, for too few points, and for quantities without an error.
    """
    scene = setup.scene
    if scene.kind is not ProblemKind.HARD_WALL:
        raise InputError("accuracy", setup.options.accuracy, "none: paths over measured heights have no relations")
    shape = scene.upper.surface.shape(setup.points)
    if min(shape) < MIN_POINTS:
        allowed = f"{MIN_POINTS} points or more each way: the error of an accuracy is what every second one changes"
        raise InputError("surface", Words(f"{shape} points"), allowed)
    keep = setup.options.keep or ()
    known = (*QUANTITIES, *(name for name, part in KEPT_QUANTITIES.items() if part in keep))
    for name in quantities:
        if name not in known:
            missing = f", or one of {', '.join(KEPT_QUANTITIES)} where `keep` has it" if name in KEPT_NUMBERS else ""
            raise InputError("quantities", name, f"some of {', '.join(known)}{missing}")
    return setup.with_options(tolerance=TOLERANCE)


def sample_every_second(setup: Setup) -> Setup:
    """Return a setup with every second point of its measured heights, in an even part of them."""
    return _with_surfaces(even_part(setup), Topography.every_second)


def even_part(setup: Setup) -> Setup:
    """Return a setup with the last point of its measured heights left out each way that has an odd number of them."""
    shape = setup.scene.upper.surface.shape(setup.points)
    return _with_surfaces(setup, Topography.even_part) if any(n % 2 for n in shape) else setup


def _with_surfaces(setup: Setup, change: Callable[[Topography], Topography]) -> Setup:
    """Return a setup with its measured topographies changed by a function; a flat body faces the changed one."""
    scene = setup.scene
    bodies = [_changed(body, change) for body in (scene.lower, scene.upper)]
    measured = next(body.surface for body in bodies if isinstance(body.surface, Topography))
    lower, upper = (
        replace(body, surface=Flat.facing(measured)) if isinstance(body.surface, Flat) else body for body in bodies
    )
    return replace(setup, scene=Scene(lower, upper, scene.effects, scene.path, scene.pairing))


def _changed(body: Body, change: Callable[[Topography], Topography]) -> Body:
    """Return a body with its measured topography changed by a function, or as it is."""
    surface = body.surface.topography if isinstance(body.surface, MeasuredLine) else body.surface
    return replace(body, surface=change(surface)) if isinstance(surface, Topography) else body
