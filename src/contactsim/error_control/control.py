"""Solve a scene to a wanted error: on two grids, the error estimated, and refined where it is missed.

Scenes without measured relations are solved as `stepwise` describes.

The coarse companion is solved first. At a hard wall it shows how small the contacts are, so the grid of the run follows
from it better than from any relation, and its pressure is where the cascade of the run begins. Along a path it has
longer increments too, so that its difference from the run is what all knobs together leave. The estimate is the larger
of that difference, which shrinks with the order of convergence, and of the error expected of such a grid, as a
difference may vanish by chance. The states of a slide tell what its increments leave. That error is added, and both
companions of a slide have the increments of the run.
"""

from __future__ import annotations

import itertools
import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.contact.problem_kind import ProblemKind
from contactsim.error_control.estimates import describe_errors, estimate_errors, expected_errors
from contactsim.error_control.measured import KEPT_QUANTITIES, even_part, is_measured
from contactsim.error_control.options import (
    SAFETY,
    choose_companions,
    choose_options,
    coarsen,
    scale_increment,
    set_grid,
)
from contactsim.error_control.relations import Family, scaling_relations
from contactsim.error_control.scaling import DEFAULT_GRID_ORDER, GRID_ORDERS, QUANTITIES, scene_family
from contactsim.error_control.solution import Solution, relative_difference, solve_setup
from contactsim.error_control.stepwise import has_relations, keep_present, solve_stepwise
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.paths.options import Setup

logger = logging.getLogger(__name__)

MAX_REFINEMENT = {1: 8.0, 2: 4.0}
"""Largest ratio of a run's grid to its companion's, and of a refined grid to the one before, by dimension."""
INCREMENT_SHARE = 0.3
"""Part of the error that increments may leave where the states tell what they leave."""
INCREMENT_ORDERS = {"static_friction": 2.0}
"""Powers of the increment with which the errors that states tell fall; others fall with the increment itself."""
MAX_INCREMENT_DIVISION = 8.0
"""How many times shorter increments may become at once."""
BLIND_REFINEMENT = 2.0
"""Ratio of a refined grid to the one before where nothing is known of the error."""
MIN_REFINEMENT = 1.4
"""Smallest ratio of a refined grid to the one before: from nearer grids an error is not told."""
MAX_REFINEMENTS = 2
"""How often a run is refined at most."""


@dataclass(frozen=True)
class Controlled:
    """Outcome of a run to a wanted error.

    Parameters
    ----------
    last : Solution
        The final run.
    before : list of Solution
        What was solved before it, in that order.
    errors : dict from str to Array
        Estimated relative error by quantity, of each load or of the path.
    wanted : float
        The relative error that was asked for.
    companion : Solution
        The run on a coarser grid that the estimate compares with.
    refinements : int
        How often the run was refined.
    """

    last: Solution
    before: list[Solution]
    errors: dict[str, Array]
    wanted: float
    companion: Solution
    refinements: int = 0

    @property
    def met(self) -> bool:
        """True where every estimate is within the wanted error."""
        return all(bool((values <= self.wanted).all()) for values in self.errors.values())

    @property
    def data(self) -> xr.Dataset:
        """Dataset of the final run with its quantities, the estimated error of each, and the work done before it."""
        data = self.last.data
        for name, values in self.errors.items():
            sizes = values * np.abs(self.last.values[name])
            if name in data:
                data = data.assign({f"{name}_estimated_error": ("step", sizes)})
            else:
                numbers = {name: self.last.values[name][0], f"{name}_estimated_error": sizes[0]}
                data = data.assign({key: float(value) for key, value in numbers.items()})
        seconds_before = sum(solution.seconds for solution in self.before)
        seconds = data.seconds.values + seconds_before * (np.arange(data.step.size) == 0)
        data = data.assign(
            accuracy=self.wanted,
            accuracy_reached=int(self.met),
            coarse_run_points=self.companion.points,
            refinements=self.refinements,
            coarse_run_transforms=self.work - self.last.transforms,
            seconds=("step", seconds),
        )
        return dataset.describe(data)

    @property
    def work(self) -> float:
        """Transforms of all runs, in those of the last one's grid."""
        return sum(run.transforms * run.size for run in [*self.before, self.last]) / self.last.size

    @property
    def seconds(self) -> float:
        """CPU seconds of all runs."""
        return sum(run.seconds for run in [*self.before, self.last])

    @property
    def summary(self) -> str:
        """Estimated errors in words."""
        return describe_errors(self.errors, self.wanted)


def solve_to_error(setup: Setup, error: float, quantities: Sequence[str] = ()) -> Controlled:
    """Solve a scene to a relative error of its quantities, as it is estimated.

    Parameters
    ----------
    setup, error, quantities
        As in `contactsim.error_control.options.choose_options`.

    Returns
    -------
    Controlled
        The final solution with its estimates. `met` is false where the error is missed after `MAX_REFINEMENTS`, or on
        the largest grid.
    """
    first = choose_options(setup, error, quantities)
    if is_measured(first.scene):
        return _solve_measured(first, error, quantities)
    if not has_relations(first.scene):
        (*before, last), errors = solve_stepwise(first, error, quantities)
        return Controlled(last, before, errors, error, before[-1], len(before) - 1)
    return _solve_by_relations(first, error, quantities)


def _solve_by_relations(first: Setup, error: float, quantities: Sequence[str]) -> Controlled:
    """Solve a setup that relations chose after its companions, and refine it while its estimate is too large."""
    name_of_family = scene_family(first.scene)
    family, names = scaling_relations().families[name_of_family], tuple(quantities or QUANTITIES[name_of_family])
    keep = COMPANIONS[first.scene.kind]
    runs = [solve_setup(keep(companion), names) for companion in choose_companions(first)]
    setup = _follow_companion(first, runs[0], family, names, error)
    for refinements in itertools.count():
        runs.append(solve_setup(setup, names, runs[0]))
        names = keep_present(runs[-2], runs[-1], names, quantities)
        coarser = _coarser_runs(runs)
        errors = estimate_errors(runs[-1], coarser, family, names)
        logger.info("on %d points, after %d: %s", runs[-1].points, coarser[-1].points, describe_errors(errors, error))
        outcome = Controlled(runs[-1], runs[:-1], errors, error, coarser[-1], refinements)
        if outcome.met or refinements == MAX_REFINEMENTS or not any(run.solved for run in runs[-2:]):
            break
        try:
            setup = _refine(runs[-1], errors, error)
        except InputError as refused:
            if refused.key != "accuracy":
                raise
            logger.info("kept as it is, since finer is refused: %s", refused)  # beyond the largest grid
            break
    return outcome


def _coarser_runs(runs: Sequence[Solution]) -> list[Solution]:
    """Return the solved ones of some runs on coarser grids than the final one's; the first run where there is none.

    Increments alone may be refined, and a companion's grid is not coarser where the surface allows no coarser one.
    """
    coarser = [run for run in runs if run.points < runs[-1].points] or list(runs[:1])
    return [run for run in coarser if run.solved] or coarser


def _solve_measured(setup: Setup, error: float, quantities: Sequence[str]) -> Controlled:
    """Solve measured heights and every second point of them; the change is the error, and no grid makes it less."""
    names = tuple(quantities or QUANTITIES[scene_family(setup.scene)])
    kept = {KEPT_QUANTITIES[name] for name in names if name in KEPT_QUANTITIES}
    lean = setup.with_options(keep=tuple(kept))
    even = even_part(lean)
    coarse = solve_setup(coarsen(lean), names)
    fine = solve_setup(setup, names)
    base = fine if even is lean else solve_setup(even, names)
    errors = {name: relative_difference(base, coarse, name) for name in names}
    logger.info("on %d points, and on every second: %s", fine.points, describe_errors(errors, error))
    return Controlled(fine, [coarse] if base is fine else [base, coarse], errors, error, coarse)


COMPANIONS: dict[ProblemKind, Callable[[Setup], Setup]] = {
    ProblemKind.HARD_WALL: lambda setup: setup.with_options(keep=("fields",)),
    ProblemKind.COHESIVE: lambda setup: setup,
}
"""Options of a companion: at a hard wall its fields are kept, from which the run begins."""


def _follow_companion(setup: Setup, companion: Solution, family: Family, names: Sequence[str], error: float) -> Setup:
    """Return the setup of a run after its companion: at a hard wall on the grid that the contacts found there need."""
    if not companion.resolved.size:
        return setup
    refinement, wanted = 1.0, SAFETY[scene_family(setup.scene)] * error
    for name in names:
        expected = expected_errors(companion, family, name).max()
        refinement = max(refinement, (expected / wanted) ** (1 / GRID_ORDERS.get(name, DEFAULT_GRID_ORDER)))
    return set_grid(setup, companion.points * min(max(refinement, 2.0), _max_refinement(companion)), error)


def _refine(run: Solution, errors: dict[str, Array], error: float) -> Setup:
    """Return the setup of a run that missed: its grid finer and its increments shorter, by as much as estimates say.

    Where no state tells what the increments leave, they are halved.
    """
    wanted, increment_errors = SAFETY[scene_family(run.setup.scene)] * error, run.increment_errors
    refinement = 1.0
    division = 1.0 if all(name in increment_errors for name in errors) else 2.0
    for name, values in errors.items():
        of_increments = float(increment_errors[name].max()) if name in increment_errors else 0.0
        of_grid = float(values.max()) - of_increments
        division = max(division, (of_increments / (INCREMENT_SHARE * error)) ** (1 / INCREMENT_ORDERS.get(name, 1.0)))
        order = GRID_ORDERS.get(name, DEFAULT_GRID_ORDER)
        refinement = max(refinement, BLIND_REFINEMENT if np.isinf(of_grid) else (of_grid / wanted) ** (1 / order))
    setup = scale_increment(run.setup, 1 / min(division, MAX_INCREMENT_DIVISION))
    if refinement == 1.0:
        return setup
    return set_grid(setup, run.points * float(np.clip(refinement, MIN_REFINEMENT, _max_refinement(run))), error)


def _max_refinement(run: Solution) -> float:
    """Return the largest ratio of the next grid's points to those of a run, along x."""
    return MAX_REFINEMENT[len(run.setup.scene.lengths)]
