"""Grids and increments for a wanted error where no relation is known: from one grid to a finer one, until it is met.

The first grid has a few points for the shortest length of the scene, and the next two have twice as many along x each,
at half the increments. The error of a run is estimated from its change from the run before, and from the change before
that one, as either may be small by chance. Two grids are enough where they hardly differ. Further grids are as fine as
the estimate asks for.
"""

from __future__ import annotations

import itertools
import logging
import math
from collections.abc import Mapping, Sequence

import numpy as np

from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Scene
from contactsim.error_control.grids import choose_grid, shortest_wave
from contactsim.error_control.measured import QUANTITIES as LOAD_QUANTITIES
from contactsim.error_control.scaling import (
    LINE,
    PATH,
    QUANTITIES,
    SLIDE,
    SURFACE,
    contact_scale,
    scene_family,
    shortest_range,
    total_strength,
)
from contactsim.error_control.solution import Solution, relative_difference, solve_setup
from contactsim.errors import InputError, Words
from contactsim.grid import Array
from contactsim.observables.friction import ONSET
from contactsim.observables.hysteresis import CYCLES
from contactsim.observables.path_summary import SUMMARIES
from contactsim.paths.options import Setup
from contactsim.paths.requested import Requested
from contactsim.status import process_zone
from contactsim.surfaces.shapes import Cylinder, Sphere
from contactsim.traits import Trait

logger = logging.getLogger(__name__)

FIRST_POINTS = {1: 64, 2: 32}
"""Least points of the first grid along x, by dimension."""
FIRST_RESOLUTION, ZONE_RESOLUTION = 4.0, 1.0
"""Points of the first grid for the shortest wavelength or the half-width of a round contact, and for the process zone,
where the wanted error is `FIRST_ERROR`."""
FIRST_ERROR, MAX_COARSENING = 0.01, 2.0
"""Wanted error below which the first grid is the same; how much coarser it may be for larger ones."""
FIRST_RANGE, FIRST_STEPS = 1.0, 12
"""First increment of an approach or slide, in the laws' length; steps of a path through mean pressures at first."""
SMALL_CHANGE = 0.5
"""Part of the wanted error that the change between the first two grids is at most, where they are enough."""
MAX_GRIDS = 6
"""Most grids that are solved."""
REFINEMENTS = (1.4, 2.0)
"""Least and largest ratio of a further grid to the last."""
ORDER = 1.5
"""Power of the spacing with which errors are taken to fall: below two, as contacts of a few points are no smooth
sums."""
SAFETY = 0.7
"""Part of the error that a further grid is chosen for."""
TOLERANCE_SHARE, MAX_TOLERANCE = 1e-2, 1e-4
"""Tolerance over the wanted error, and the largest: far below what grid and increments leave."""
USUAL_QUANTITIES = {
    (ProblemKind.HARD_WALL, 1): QUANTITIES[LINE],
    (ProblemKind.HARD_WALL, 2): QUANTITIES[SURFACE],
    (ProblemKind.COHESIVE, 1): QUANTITIES[PATH],
    (ProblemKind.COHESIVE, 2): ("pull_off_force_loading", "final_contact_area"),
}
"""Quantities whose relative error counts where no others are named, by kind of problem and dimension."""


def has_relations(scene: Scene) -> bool:
    """Return True where measured relations tell which grid a scene needs."""
    try:
        scene_family(scene)
    except InputError:
        return False
    return True


def begin_stepwise(setup: Setup, error: float, quantities: Sequence[str]) -> Setup:
    """Return a setup with the first grid, and with its tolerance and increments.

    Raises
    ------
    InputError
        For a quantity that such a scene does not have, and for a wall that is pressed by approach: its loads pass zero.
    """
    scene = setup.scene
    if scene.kind is ProblemKind.HARD_WALL and Trait.APPROACH in scene.traits:
        raise InputError("path", "approach", "mean pressures: with a hard wall an accuracy needs loads above zero")
    if {Trait.APPROACH, Trait.MEAN_PRESSURE} <= scene.traits and not scene.sliding:
        raise InputError("path", Words("approaches and mean pressures"), "one of them, with an accuracy")
    known = known_quantities(scene)
    for name in quantities:
        if name not in known:
            raise InputError("accuracy.quantities", name, f"some of {', '.join(known)}")
    increment = _first_increment(scene)
    setup = setup if increment is None else setup.with_increment(increment)
    points = choose_grid(scene, scene.length / _first_spacing(scene, error), error)
    tolerance = min(MAX_TOLERANCE, TOLERANCE_SHARE * error)
    increments = None if scene.kind is ProblemKind.HARD_WALL else Requested()  # adaptive ones locate every jump
    return setup.with_options(points=points, tolerance=tolerance, increments=increments)


def usual_quantities(scene: Scene) -> tuple[str, ...]:
    """Return the quantities of a scene without relations whose error counts where no others are named."""
    return QUANTITIES[SLIDE] if scene.sliding else USUAL_QUANTITIES[scene.kind, len(scene.lengths)]


def known_quantities(scene: Scene) -> tuple[str, ...]:
    """Return the quantities whose error can be asked for in a scene without relations."""
    if scene.kind is ProblemKind.HARD_WALL:
        return LOAD_QUANTITIES
    dimensions = len(scene.lengths)
    return (*SUMMARIES[dimensions], *CYCLES[dimensions], *(ONSET if scene.sliding else ()))


def solve_stepwise(first: Setup, error: float, quantities: Sequence[str]) -> tuple[list[Solution], dict[str, Array]]:
    """Solve a scene on finer and finer grids until the estimated errors are small enough.

    Parameters
    ----------
    first : Setup
        As `begin_stepwise` returns it.
    error : float
        Relative error.
    quantities : sequence of str
        Quantities whose error counts; those usual for the scene where empty.

    Returns
    -------
    solutions : list of Solution
        All runs, the last of which counts.
    errors : dict from str to Array
        Its estimated relative error by quantity; larger than the wanted one where `MAX_GRIDS` were not enough, a grid
        would be too large, or two runs one after the other were not solved.
    """
    names = tuple(quantities or usual_quantities(first.scene))
    coarse, fine = (solve_setup(setup, names) for setup in (first, _refine(first, 2.0, error)))
    solutions = [coarse, fine]
    names = keep_present(coarse, fine, names, quantities)
    errors = {name: relative_difference(fine, coarse, name) for name in names}
    if _largest(errors) <= SMALL_CHANGE * error:
        return solutions, errors
    ratio = 2.0
    while len(solutions) < MAX_GRIDS and (solutions[-1].solved or solutions[-2].solved):
        try:
            setup = _refine(solutions[-1].setup, ratio, error)
        except InputError:  # beyond the largest grid: what was solved is kept, and called too coarse
            break
        solutions.append(solve_setup(setup, names))
        errors = estimate_from_changes(solutions, names)
        logger.info("on %d points: an error of %.2g of %g", solutions[-1].points, _largest(errors), error)
        if _largest(errors) <= error:
            break
        ratio = float(np.clip((_largest(errors) / (SAFETY * error)) ** (1 / ORDER), *REFINEMENTS))
    return solutions, errors


def estimate_from_changes(solutions: Sequence[Solution], names: Sequence[str]) -> dict[str, Array]:
    """Return the relative errors of the last of three or more runs, each on a finer grid than the one before.

    The larger counts of what the last change says, and of what the one before says of a coarser run.
    """
    errors = {}
    for name in names:
        before, last = (
            relative_difference(fine, coarse, name) / (_refinement(coarse, fine) ** ORDER - 1)
            for coarse, fine in itertools.pairwise(solutions[-3:])
        )
        errors[name] = np.maximum(last, before / _refinement(*solutions[-2:]) ** ORDER)
    return errors


def keep_present(coarse: Solution, fine: Solution, names: Sequence[str], asked: Sequence[str]) -> tuple[str, ...]:
    """Return the quantities that a scene has; all where a run was not solved, as nobody knows then.

    Raises
    ------
    InputError
        Where one that was asked for is missing, or all.
    """
    if not (coarse.solved and fine.solved):
        return tuple(names)
    present = tuple(name for name in names if np.isfinite([coarse.values[name], fine.values[name]]).any())
    missing = [name for name in (asked or names if not present else asked) if name not in present]
    if missing:
        allowed = "a quantity that this path has: it does not come so far, or does not turn back"
        raise InputError("accuracy.quantities", missing[0], allowed)
    return present


def _largest(errors: Mapping[str, Array]) -> float:
    """Return the largest error of all quantities."""
    return max(float(values.max()) for values in errors.values())


def _refinement(coarse: Solution, fine: Solution) -> float:
    """Return the points along x of a run over those of another."""
    return fine.points / coarse.points


def _refine(setup: Setup, ratio: float, error: float) -> Setup:
    """Return a setup with that many times the points along x, and with increments as much shorter."""
    if setup.scene.path.increment is not None:
        setup = setup.with_increment(setup.scene.path.increment / ratio)
    return setup.with_options(points=choose_grid(setup.scene, setup.points * ratio, error))


def _first_spacing(scene: Scene, error: float) -> float:
    """Return the spacing (nm) of the first grid for a wanted error."""
    spacings = [scene.length / FIRST_POINTS[len(scene.lengths)], shortest_wave(scene) / FIRST_RESOLUTION]
    if isinstance(scene.upper.surface, Cylinder | Sphere):
        least = min((step.value for step in scene.path.steps if step.value > 0), default=None)
        spacings += [contact_scale(scene, least) / FIRST_RESOLUTION] if least else []
    if scene.kind is ProblemKind.COHESIVE:
        zone = process_zone(scene.contact_modulus, total_strength(scene), shortest_range(scene))
        spacings.append(zone / ZONE_RESOLUTION)
    return min(spacings) * min(max(math.sqrt(error / FIRST_ERROR), 1.0), MAX_COARSENING)


def _first_increment(scene: Scene) -> float | None:
    """Return the first increment of a path or slide, None for single steps."""
    path = scene.path
    if path.increment is None:
        return None
    if path.steps[-1].control is Trait.MEAN_PRESSURE and not scene.sliding:
        return sum(abs(after - before) for before, after in itertools.pairwise(path.turning_points)) / FIRST_STEPS
    return FIRST_RANGE * shortest_range(scene)
