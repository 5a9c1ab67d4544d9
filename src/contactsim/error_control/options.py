"""The runs that an error is estimated from: their grids, increments and tolerance.

A wanted error leads to the setup that most scenes of the kind need for it. Coarser ones come before it: a half and a
quarter of its grid, with two and four times its increments, as far as they show the scene. Finer ones follow where the
estimate asks for them. Measured heights have no finer grid; their coarser ones are every second and fourth point.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Scene
from contactsim.error_control.grids import choose_grid, coarsest_points, expected_points, shortest_range
from contactsim.error_control.measured import MIN_POINTS, STRIDES, is_measured, thin_out
from contactsim.errors import InputError, Words
from contactsim.observables.dataset_forms import KEPT_NUMBERS
from contactsim.observables.friction import ONSET
from contactsim.observables.hysteresis import CYCLES
from contactsim.observables.path_summary import SUMMARIES
from contactsim.paths.nested import Nested
from contactsim.paths.options import Setup
from contactsim.paths.requested import Requested
from contactsim.traits import Trait

MIN_RATIO, RATIO = math.sqrt(2), 2.0
"""Least and usual ratio of the grids of two runs: nearer ones agree by chance."""
TOLERANCES = {ProblemKind.HARD_WALL: 0.1, ProblemKind.COHESIVE: 0.01}
MAX_TOLERANCES = {ProblemKind.HARD_WALL: 1e-3, ProblemKind.COHESIVE: 1e-4}
"""Tolerance over the wanted error, and the largest, in its own unit: what it leaves is far below that error."""
FINE_INCREMENT, FINE_STEPS = 0.7, 16
"""Increment, in the shortest range of the laws, and steps through mean pressures that most paths need for an error of
0.01; other errors by their root."""
MAX_INCREMENT, MIN_STEPS = 2.8, 4
"""Longest increment, in the same range, and fewest steps, of the coarsest run."""
JUMP_INCREMENT = 0.5
"""Longest increment, in the same range, in which a jump is told from a smooth motion."""
LENGTHS = ("approach", "mean_gap")
LOAD_QUANTITIES = ("relative_contact_area_subgrid", *LENGTHS, "max_pressure", "rms_gradient_contact_subgrid")
"""Numbers of a load at a hard wall whose error is told. Whole numbers, as of points or slips, agree by chance: none."""
KEPT_QUANTITIES = {"contact_stiffness": "stiffness"}
"""The same of those that a run has to keep: under which name it does."""
USUAL_QUANTITIES = {
    (ProblemKind.HARD_WALL, 1): LOAD_QUANTITIES[:1],
    (ProblemKind.HARD_WALL, 2): LOAD_QUANTITIES[:1],
    (ProblemKind.COHESIVE, 1): ("pull_off_load_loading", "final_contact_length"),
    (ProblemKind.COHESIVE, 2): ("pull_off_force_loading", "final_contact_area"),
}
"""Quantities whose error counts where no others are named, by kind of problem and dimension."""


def usual_quantities(scene: Scene) -> tuple[str, ...]:
    """Return the quantities whose error counts where no others are named."""
    return ("static_friction",) if scene.sliding else USUAL_QUANTITIES[scene.kind, len(scene.lengths)]


def known_quantities(setup: Setup) -> tuple[str, ...]:
    """Return all quantities whose error can be told: what unloading shows only of a path that turns back."""
    scene, dimensions = setup.scene, len(setup.scene.lengths)
    if scene.kind is ProblemKind.HARD_WALL:
        keep = setup.options.keep or ()
        return (*LOAD_QUANTITIES, *(name for name, part in KEPT_QUANTITIES.items() if part in keep))
    onset = [name for name in ONSET if scene.sliding and not name.endswith("_count")]
    if any(after < before for before, after in itertools.pairwise(scene.path.turning_points)):
        return (*SUMMARIES[dimensions], *CYCLES[dimensions], *onset)
    return (*(name for name in SUMMARIES[dimensions] if not name.endswith("_unloading")), *onset)


def check_quantities(setup: Setup, quantities: Sequence[str]) -> tuple[str, ...]:
    """Return the quantities whose errors are told: those named, or those usual for the scene.

    Raises
    ------
    InputError
        For a quantity that such a scene does not have, and for paths without one measure of finer and coarser.
    """
    scene = setup.scene
    if scene.kind is ProblemKind.HARD_WALL and Trait.APPROACH in scene.traits:
        raise InputError("path", "approach", "mean pressures: with a hard wall an accuracy needs loads above zero")
    if {Trait.APPROACH, Trait.MEAN_PRESSURE} <= scene.traits and not scene.sliding:
        raise InputError("path", Words("approaches and mean pressures"), "one of them, with an accuracy")
    known = known_quantities(setup)
    for name in quantities:
        if name not in known:
            missing = f", or one of {', '.join(KEPT_QUANTITIES)} where `keep` has it" if name in KEPT_NUMBERS else ""
            raise InputError("quantities", name, f"some of {', '.join(known)}{missing}")
    return tuple(quantities) or usual_quantities(scene)


def choose_options(setup: Setup, error: float, quantities: Sequence[str] = ()) -> Setup:
    """Choose grid, tolerance and increments that most scenes of the kind need for a relative error.

    Parameters
    ----------
    setup : Setup
        Scene and options; its grid, tolerance and increments do not matter.
    error : float
        Relative error, above 0 and below 1.
    quantities : sequence of str, optional
        Quantities whose error counts; those usual for the scene where empty.

    Returns
    -------
    Setup
        The same scene, its path in other increments, with options for that error.

    Raises
    ------
    InputError
        For a quantity that the scene does not have, or where no affordable grid is fine enough.
    """
    check_quantities(setup, quantities)
    scene, kind = setup.scene, setup.scene.kind
    tolerance = min(MAX_TOLERANCES[kind], TOLERANCES[kind] * error)
    setup = setup.with_options(tolerance=tolerance)
    if kind is ProblemKind.COHESIVE:
        setup = setup.with_options(increments=Requested())  # adaptive ones would locate every jump
        if scene.path.increment is not None:
            increment = _longest_increment(scene) * FINE_INCREMENT / MAX_INCREMENT * math.sqrt(error / 0.01)
            setup = setup.with_increment(float(f"{min(increment, _longest_increment(scene) / RATIO):.3g}"))
    if is_measured(scene):
        return setup
    points = max(expected_points(scene, error), RATIO * coarsest_points(scene))
    return setup.with_options(points=choose_grid(scene, points, error))


def _longest_increment(scene: Scene) -> float:
    """Return the increment of the coarsest run along a path, nm or GPa."""
    if scene.path.steps[-1].control is Trait.MEAN_PRESSURE:
        return sum(abs(after - before) for before, after in itertools.pairwise(scene.path.turning_points)) / MIN_STEPS
    return MAX_INCREMENT * shortest_range(scene)


def shows_jumps(setup: Setup) -> bool:
    """Return True where a jump, or the onset of a slide, would be seen: those of a path by load always are."""
    path = setup.scene.path
    if path.increment is None or path.steps[-1].control is Trait.MEAN_PRESSURE:
        return True
    return path.increment <= JUMP_INCREMENT * shortest_range(setup.scene)


def coarser_setups(setup: Setup) -> list[Setup]:
    """Return two setups that are coarser than another in grid and increments, the coarsest first.

    They have a quarter and a half of its points along x, or as few as still show the scene. InputError where none is
    coarser, and for nested increments.
    """
    if isinstance(setup.options.increments, Nested):
        raise InputError("increments", "Nested", "Requested or Adaptive: an error is told by longer ones")
    if is_measured(setup.scene):
        shape = setup.scene.upper.surface.shape(setup.points)
        if min(shape) < MIN_POINTS:
            raise InputError("surface", Words(f"{shape} points"), f"{MIN_POINTS} points or more each way")
        return [scale_increment(thin_out(setup, stride), stride) for stride in STRIDES]
    coarsest = coarsest_points(setup.scene)
    ratio = min(RATIO, math.sqrt(setup.points / coarsest))
    if ratio < MIN_RATIO * (1 - 1e-9):
        least = math.ceil(2 * coarsest)
        raise InputError("points", setup.points, f"{least} or more: an error is told by two coarser grids")
    return [refine(setup, ratio**-2), refine(setup, 1 / ratio)]


def refine(setup: Setup, ratio: float, error: float = 0.0) -> Setup:
    """Return a setup with that many times the points along x and as much shorter increments; error: see `choose_grid`.

    Measured heights keep their points.
    """
    setup = scale_increment(setup, 1 / ratio)
    if is_measured(setup.scene):
        return setup
    return setup.with_options(points=choose_grid(setup.scene, setup.points * ratio, error))


def scale_increment(setup: Setup, factor: float) -> Setup:
    """Return a setup with the increments of its slide or path times a factor; unchanged where there are none."""
    increment = setup.scene.path.increment
    return setup if increment is None else setup.with_increment(float(f"{increment * factor:.4g}"))
