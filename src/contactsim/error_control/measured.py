"""Measured heights, of which there are no more than were measured: their error is what every second point changes.

Where heights are rough down to their spacing, it tells what finer points would add, and no choice of a grid makes it
smaller.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from contactsim.contact.scene import Body, ProblemKind, Scene
from contactsim.errors import InputError, Words
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


@dataclass(frozen=True)
class MeasuredRoughness:
    """Measured heights as costs see them: a self-affine surface up to half of their length.

    Parameters
    ----------
    long_cutoff, effective_short_cutoff : float
        Longest and shortest wavelength, nm.
    profile_rms_gradient : float
        Rms gradient of the heights.
    hurst_exponent : float
        Taken as typical.
    """

    long_cutoff: float
    effective_short_cutoff: float
    profile_rms_gradient: float
    hurst_exponent: float = TYPICAL_HURST

    @classmethod
    def of(cls, surface: Topography | MeasuredLine) -> MeasuredRoughness:
        """Return the roughness of measured heights."""
        topography = surface if isinstance(surface, Topography) else surface.topography
        gradient = rms_gradient_open(topography.values, topography.spacing)
        if not gradient > 0:
            raise InputError("surface", "flat heights", "heights that differ, for a forecast or an accuracy")
        short = WAVE_POINTS * max(topography.spacing)
        return cls(max(min(topography.lengths) / 2, short), short, gradient)


def is_measured(scene: Scene) -> bool:
    """Return True where heights are measured, so that the grid is given."""
    return scene.upper.surface.points is not None


def choose_measured(setup: Setup) -> Setup:
    """Return a setup of measured heights with the tolerance of an error-controlled run.

    Raises
    ------
    InputError
        For smooth laws, whose path would need increments, and for heights that have no coarser grid.
    """
    scene = setup.scene
    if scene.kind is not ProblemKind.HARD_WALL:
        raise InputError("accuracy", setup.options.accuracy, "none: paths over measured heights have no relations")
    shape = scene.upper.surface.shape(setup.points)
    if min(shape) < MIN_POINTS or (scene.repeats and any(size % 2 for size in shape)):
        kind = "an even number of points" if scene.repeats else "points"
        allowed = f"{kind} each way, {MIN_POINTS} or more: the error of an accuracy is what every second one changes"
        raise InputError("surface", Words(f"{shape} points"), allowed)
    return setup.with_options(tolerance=TOLERANCE)


def sample_every_second(setup: Setup) -> Setup:
    """Return a setup with every second point of its measured heights."""
    scene = setup.scene
    lower, upper = (_sampled(body) for body in (scene.lower, scene.upper))
    if isinstance(lower.surface, Flat):
        lower = replace(lower, surface=Flat.facing(upper.surface))
    return replace(setup, scene=Scene(lower, upper, scene.effects, scene.path, scene.pairing))


def _sampled(body: Body) -> Body:
    """Return a body with every second point of its measured heights, or as it is."""
    surface = body.surface
    return replace(body, surface=surface.every_second()) if isinstance(surface, Topography | MeasuredLine) else body
