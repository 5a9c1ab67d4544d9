"""Put error control on trial: random scenes are solved to a requested error and judged by finer runs.

The true error is against a run that is finer in every knob, with what the finer grid itself leaves if errors fall as
they are taken to: nearly all is seen on 8 times the points, half on 1.5 times. The cheapest setting has the least CPU
time among all grids and increments, coarser than those of the final run, whose true error is small enough.
"""

from __future__ import annotations

import itertools
import logging
import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import xarray as xr

from contactsim import dataset
from contactsim.contact.problem_kind import ProblemKind
from contactsim.error_control.estimates import ORDER
from contactsim.error_control.forecast import forecast_to_error
from contactsim.error_control.ladder import Controlled, estimate_error, largest_error, solve_to_error
from contactsim.error_control.options import (
    choose_options,
    coarser_setups,
    known_quantities,
    refine,
    scale_increment,
    usual_quantities,
)
from contactsim.error_control.solution import Solution, relative_difference, solve_setup
from contactsim.errors import InputError
from contactsim.evaluation.calibration.population import KIND_NAMES, draw_scene
from contactsim.paths.options import Setup

logger = logging.getLogger(__name__)

REFERENCE_GRIDS = {1: 8.0, 2: 3.0}
"""Points of the reference at a hard wall, over those of the final run along x, by dimension."""
PATH_REFERENCES, MAX_SECONDS = {1: (4.0, 2.0), 2: (2.0, 1.5)}, 30.0
"""The same along a path, in grid and increments: the second where the first is expected to take more seconds."""
REFERENCE_TOLERANCE = 0.1
"""Tolerance of a reference over that of the final run."""
LADDER_GRIDS = tuple(2 ** (-step / 2) for step in range(7))
"""Grids of the settings among which the cheapest is sought, over the final one's points."""
LADDER_INCREMENTS = (1.0, 4.0)
"""Their increments, over the final ones."""


@dataclass(frozen=True)
class Trial:
    """One scene on trial: its kind, number and seed, and the error that is requested of it."""

    kind: str
    count: int
    seed: int
    requested_error: float

    @classmethod
    def draw(cls, seed: int, errors: Sequence[float], kind: str, count: int) -> Trial:
        """Return a trial with the errors of a list in turn, from another one for each kind."""
        return cls(kind, count, seed, errors[(count + KIND_NAMES.index(kind)) % len(errors)])

    @property
    def setup(self) -> Setup:
        """The scene."""
        return Setup(draw_scene(self.seed, self.kind, self.count))


@dataclass(frozen=True)
class Judged:
    """Final run of a trial and those before it, the finer run that judges them, and settings that may be cheaper."""

    result: Controlled
    reference: Solution
    settings: list[Solution]

    def true_error(self, run: Solution, *names: str) -> float:
        """Return the largest relative error of some quantities of a run, of those usual where none is named."""
        names = names or usual_quantities(run.setup.scene)
        seen = 1 - (run.points / self.reference.points) ** ORDER if run.points < self.reference.points else 1.0
        return float(max(relative_difference(self.reference, run, name).max() for name in names)) / seen

    def covered(self, *names: str) -> list[bool]:
        """Return if the errors stated of some quantities cover the true ones; of those alone that are finite."""
        runs = [*self.result.before, self.result.last]
        stated = {name: largest_error({name: estimate_error(runs, name)}) for name in names}
        return [self.true_error(runs[-1], name) <= error for name, error in stated.items() if math.isfinite(error)]

    def cheapest(self, error: float) -> Solution | None:
        """Return the setting with the least CPU time whose true error is small enough; None where there is none."""
        accurate = [run for run in self.settings if self.true_error(run) <= error]
        return min(accurate, key=lambda run: run.seconds, default=None)


def solve_with_reference(trial: Trial) -> Judged:
    """Solve a random scene to an error, and once more with finer knobs."""
    setup, error = trial.setup, trial.requested_error
    solve_setup(coarser_setups(choose_options(setup, error))[0], ())  # compiles the kernels
    result = solve_to_error(setup, error)
    return Judged(result, solve_setup(_reference_setup(result.last), known_quantities(result.last.setup)), [])


def judge(trial: Trial) -> Judged:
    """Solve a random scene to an error, then with finer knobs, and then with all coarser settings that are cheaper."""
    error = trial.requested_error
    judged = solve_with_reference(trial)
    result, names = judged.result, usual_quantities(trial.setup.scene)
    for candidate in _settings(result.last.setup):
        least = judged.cheapest(error)
        if least is not None and _size(candidate) > 2 * _size(least.setup):
            break
        try:
            judged.settings.append(solve_setup(candidate, names))
        except InputError:  # a grid that is too coarse for its path
            continue
    return judged


def _reference_setup(last: Solution) -> Setup:
    """Return a finer grid, shorter increments and a tighter tolerance than those of a final run."""
    setup, dimensions = last.setup, len(last.setup.scene.lengths)
    tight = setup.with_options(tolerance=setup.options.tolerance * REFERENCE_TOLERANCE)
    if setup.scene.kind is ProblemKind.HARD_WALL:
        return refine(tight, REFERENCE_GRIDS[dimensions])
    usual, smaller = PATH_REFERENCES[dimensions]
    steps = 1 if setup.scene.path.increment is None else usual
    return refine(tight, usual if last.seconds * usual**dimensions * steps < MAX_SECONDS else smaller)


def _settings(last: Setup) -> list[Setup]:
    """Return grids and increments about those of a final run, the smallest first."""
    found: dict[tuple[int, float], Setup] = {}
    for grid, pace in itertools.product(LADDER_GRIDS, LADDER_INCREMENTS):
        try:
            setup = scale_increment(scale_increment(refine(last, grid), grid), pace)
        except InputError:  # no such path
            continue
        found.setdefault((setup.points, setup.scene.path.increment or 0.0), setup)
    return sorted(found.values(), key=_size)


def _size(setup: Setup) -> int:
    """Return the points of all steps."""
    return setup.size * len(setup.scene.path.steps)


def run_trial(trial: Trial) -> tuple[xr.Dataset, dict[str, float]]:
    """Judge one random scene; return its errors, points and work, and the seconds predicted, spent and of the cheapest.

    Of a scene that is refused `covered` and `accuracy_reached` are -1.
    """
    error = trial.requested_error
    row = {"requested_error": error} | dict.fromkeys(("true_error", "predicted_error", "work"), math.nan)
    row |= dict.fromkeys(("covered", "accuracy_reached", "points", "min_work_points"), -1)
    row |= dict.fromkeys(("others", "covered_others", "solve_count"), 0)
    costs = {"predicted": math.nan, "seconds": math.nan, "least": math.nan}
    try:
        judged = judge(trial)
    except InputError as refused:
        logger.warning("refused: %s", refused)
    else:
        with suppress(InputError):  # costs of lattices were not measured
            costs["predicted"] = forecast_to_error(trial.setup, error).seconds
        result, least = judged.result, judged.cheapest(error)
        usual = usual_quantities(trial.setup.scene)
        others = judged.covered(*(name for name in judged.reference.values if name not in usual))
        row |= {
            "true_error": judged.true_error(result.last),
            "predicted_error": largest_error(result.errors),
            "covered": int(all(judged.covered(*usual))),
            "others": len(others),
            "covered_others": sum(others),
            "accuracy_reached": int(result.met),
            "solve_count": len(result.before) + 1,
            "points": result.last.points,
            "work": result.work * result.last.size,
            "min_work_points": least.points if least else -1,
        }
        costs |= {"seconds": result.seconds, "least": least.seconds if least else math.nan}
    coordinates = {"scene": [f"{trial.kind} {trial.count}"], "kind": ("scene", [trial.kind])}
    data = xr.Dataset({name: ("scene", [value]) for name, value in row.items()}, coordinates)
    return dataset.describe(data), costs
