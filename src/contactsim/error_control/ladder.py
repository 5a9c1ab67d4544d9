"""Solve a scene on finer and finer grids, and tell the error of the finest run from what the coarser ones change.

Each run has about twice the points along x of the one before and, along a path, as much shorter increments; at a
hard wall it begins from the solution before. `contactsim.error_control.estimates` tells the error from their changes.
"""

from __future__ import annotations

import itertools
import logging
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.contact.problem_kind import ProblemKind
from contactsim.error_control.estimates import ORDER, TOLERANCE_SHARES, tell_error
from contactsim.error_control.measured import is_measured, thin_out
from contactsim.error_control.options import (
    MIN_RATIO,
    RATIO,
    check_quantities,
    choose_options,
    coarser_setups,
    known_quantities,
    refine,
    shows_jumps,
)
from contactsim.error_control.solution import Solution, solve_setup
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.observables.contact import DEFAULT_KEPT
from contactsim.paths.options import Setup

logger = logging.getLogger(__name__)

SAFETY = 0.8
"""Part of the error that a further grid is chosen for."""
MAX_RUNS, MAX_WORK = 8, 1e11
"""Most runs, and most transforms times points that a further one is expected to take: about an hour."""
FIELDS = ("pressure", "gap", "heights", "x", "y")
"""What a run at a hard wall keeps for the next one to begin from."""
MAX_FIELDS = 2**25
"""Most points of all its loads that it keeps them for: half a gigabyte. The next run then begins from its own grids."""


@dataclass(frozen=True)
class Controlled:
    """A run whose errors are told, and the coarser ones that tell them.

    Parameters
    ----------
    last : Solution
        The final run.
    before : list of Solution
        What was solved before it, in that order.
    errors : dict from str to Array
        Estimated relative error by quantity, of each load or of the path; zero of one that the path lacks.
    wanted : float, optional
        The relative error that was asked for.
    refinements : int
        How often the run was refined beyond the grid that was expected to do.
    """

    last: Solution
    before: list[Solution]
    errors: dict[str, Array]
    wanted: float | None = None
    refinements: int = 0

    @property
    def met(self) -> bool:
        """True where every estimate is within the wanted error."""
        return self.wanted is None or bool(all((values <= self.wanted).all() for values in self.errors.values()))

    @property
    def data(self) -> xr.Dataset:
        """Dataset of the final run with its quantities, the estimated error of each, and the work done before it."""
        data = self.last.data
        for name, values in self.errors.items():
            sizes, known = np.full(values.shape, np.inf), np.isfinite(values)
            sizes[known] = values[known] * self.last.scale(name)[known]
            if name in data:
                data = data.assign({f"{name}_estimated_error": ("step", sizes)})
            else:
                numbers = {name: self.last.values[name][0], f"{name}_estimated_error": sizes[0]}
                data = data.assign({key: float(value) for key, value in numbers.items()})
        seconds_before = sum(solution.seconds for solution in self.before)
        seconds = data.seconds.values + seconds_before * (np.arange(data.step.size) == 0)
        if self.wanted is not None:
            data = data.assign(accuracy=self.wanted, accuracy_reached=int(self.met), refinements=self.refinements)
        data = data.assign(
            coarse_run_points=self.before[-1].points,
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
        of = "" if self.wanted is None else f" of {self.wanted:g}"
        return ", ".join(f"{name} to {values.max():.2g}{of}" for name, values in self.errors.items())


def solve_to_error(setup: Setup, error: float, quantities: Sequence[str] = ()) -> Controlled:
    """Solve a scene to a relative error of its quantities, as it is estimated.

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
    Controlled
        The final solution with its estimates. `met` is false where the error is missed after `MAX_RUNS`, where two runs
        one after the other were not solved, and where a finer grid is too large, takes too long or was not measured.
    """
    return _climb(choose_options(setup, error, quantities), quantities, error)


def solve_with_errors(setup: Setup, quantities: Sequence[str] = ()) -> Controlled:
    """Solve a setup as it is, and two coarser ones before it, to tell the errors of its quantities.

    Parameters
    ----------
    setup : Setup
        Scene and options.
    quantities : sequence of str, optional
        Quantities whose error is told; those usual for the scene where empty.
    """
    return _climb(setup, quantities, None)


def _climb(expected: Setup, quantities: Sequence[str], error: float | None) -> Controlled:
    """Solve coarser setups, the expected one and finer ones, until the error is small enough; without one, three."""
    names, runs = check_quantities(expected, quantities), list[Solution]()
    known = known_quantities(expected)
    kept = expected.options.keep
    if expected.scene.kind is ProblemKind.COHESIVE and expected.scene.path.increment is None:
        logger.warning("a path without an increment has its %d states alone", len(expected.scene.path.steps))
    if expected.scene.kind is ProblemKind.HARD_WALL and kept is None:
        kept = DEFAULT_KEPT
    divisible = thin_out(expected, 1) if is_measured(expected.scene) else expected
    waiting, wanted = [*coarser_setups(expected), divisible], math.inf if error is None else error
    fewest = len(waiting)
    while waiting:
        for setup in waiting:
            if kept is not None:
                fields = ["fields"] * (setup.size * len(setup.scene.path.steps) <= MAX_FIELDS)
                setup = setup.with_options(keep=tuple(dict.fromkeys((*kept, *fields))))
            runs.append(solve_setup(setup, known, runs[-1] if runs else None))
            runs[:-1] = [replace(run, data=run.data.drop_vars(FIELDS, errors="ignore")) for run in runs[:-1]]
        errors = {name: estimate_error(runs, name) for name in names}
        worst = largest_error(errors)
        logger.info("on %d points: an error of %.2g", runs[-1].points, worst)
        is_last = worst <= wanted or len(runs) >= MAX_RUNS or not (runs[-1].solved or runs[-2].solved)
        waiting = [] if is_last else _finer_setups(runs[-1], worst / wanted)
    refinements = len(runs) - fewest
    is_whole = divisible.size == expected.size
    if not is_whole:  # errors of the part that can be thinned out stand for those of all points
        runs.append(solve_setup(expected, known))
    dropped = [name for name in FIELDS if kept is None or "fields" not in kept]
    last = replace(runs[-1], data=runs[-1].data.drop_vars(dropped, errors="ignore"))
    lacking = [name for name in names if last.solved and np.isnan(last.values[name]).all()]
    if lacking:
        logger.warning("the path shows no %s, so there is no error of it", ", no ".join(lacking))
    if not (is_whole or last.solved) or len(lacking) == len(names):
        errors = {name: np.full(told.shape, np.inf) for name, told in errors.items()}
    return Controlled(last, runs[:-1], errors, error, refinements)


def _finer_setups(run: Solution, excess: float) -> list[Setup]:
    """Return a finer setup than a run's for an error that many times too large; none beyond largest grid and work."""
    setup = run.setup
    ratio = RATIO if math.isinf(excess) else min(max((excess / SAFETY) ** (1 / ORDER), MIN_RATIO), RATIO)
    if is_measured(setup.scene):
        return []
    has_increments = setup.scene.path.increment is not None
    if run.transforms * run.size * ratio ** (len(setup.scene.lengths) + has_increments) > MAX_WORK:
        logger.info("kept as it is: a finer run would take too long")
        return []
    try:
        return [refine(setup, ratio)]
    except InputError as refused:
        if refused.key not in ("accuracy", "increment"):
            raise
        logger.info("kept as it is, since finer is refused: %s", refused)
        return []


def estimate_error(runs: Sequence[Solution], name: str) -> Array:
    """Return the relative error of a quantity of the last of some runs, each finer than the one before.

    A quantity that the last three lack has none, where their increments are short enough to show jumps.
    """
    last, setup = runs[-1], runs[-1].setup
    scale = last.scale(name)
    tolerance = TOLERANCE_SHARES[setup.scene.kind] * setup.options.tolerance
    least = np.fmax(tolerance * scale, last.increment_errors.get(name, 0.0))
    error = tell_error(*told_values(runs, name), least)
    relative = np.full(scale.shape, np.inf)
    np.divide(error, scale, out=relative, where=(scale > 0) & np.isfinite(scale))
    relative[(error == 0) & ~np.isinf(scale)] = 0.0
    return np.where(np.isnan(scale) & (not shows_jumps(setup)), np.inf, relative)


def told_values(runs: Sequence[Solution], name: str) -> tuple[list[Array], list[float]]:
    """Return a quantity of some runs, infinite where one was not solved, and how many times finer each is."""
    values = [run.values[name] if run.solved else np.full_like(run.values[name], np.inf) for run in runs]
    return values, [fine.points / coarse.points for coarse, fine in itertools.pairwise(runs)]


def largest_error(errors: dict[str, Array]) -> float:
    """Return the largest error of all quantities."""
    return max(float(values.max()) for values in errors.values())
