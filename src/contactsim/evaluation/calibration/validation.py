"""Put error control on trial: random scenes are solved to a requested error and judged by finer runs.

The true error is against a run that is finer in every knob than all judged runs. The cheapest setting has the least
work, transforms times points, among all settings of a ladder about the final one whose true error is small enough.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.contact.problem_kind import ProblemKind
from contactsim.error_control.control import Controlled, solve_to_error
from contactsim.error_control.forecast import forecast_to_error
from contactsim.error_control.options import choose_options, coarsen, scale_increment, set_grid
from contactsim.error_control.relations import FILE
from contactsim.error_control.scaling import FAMILIES, LINE, QUANTITIES, SURFACE
from contactsim.error_control.solution import Solution, relative_difference, solve_setup
from contactsim.errors import InputError
from contactsim.evaluation.calibration.sampling import FAMILY_RANGES, Ranges, Trials, draw_scene
from contactsim.paths.options import Setup
from contactsim.provenance import digest
from contactsim.solvers.registry import DEFAULT_SOLVERS, solver_module
from contactsim.study.run import Run
from contactsim.study.stages import computing_stage_digest, stage_digest
from contactsim.variables import RESULTS

LADDER_GRIDS = (1 / 8, 1 / 5.7, 1 / 4, 1 / 2.8, 1 / 2, 1 / 1.4, 1.0, 1.4, 2.0)
"""Grids of the ladder, over the final one's points."""
LADDER_FACTORS = {
    ProblemKind.HARD_WALL: ((1.0,), (10.0, 1.0)),
    ProblemKind.COHESIVE: ((4.0, 2.0, 1.0), (1.0,)),
}
"""Increments and tolerances of the ladder, over the final ones."""
"""Symbols of loads."""
REFERENCE_GRIDS = {LINE: 6.0, SURFACE: 3.0}
"""How many times finer the grid of the reference is than the final one; along paths three times."""
PATH_REFERENCE_GRID, REFERENCE_INCREMENT, REFERENCE_TOLERANCE = 3.0, 0.25, 0.1
"""Of a reference along a path: its grid's points, increments, tolerance, over the final ones."""


@dataclass(frozen=True)
class Trial:
    """One scene on trial: its family, number, ranges and seed, and the error that is requested of it."""

    kind: str
    count: int
    ranges: Ranges
    seed: int
    requested_error: float

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> Trial:
        """Return the trial from its JSON, of `trial_job`."""
        kind, count, shared = settings["kind"], settings["count"], settings["settings"]
        ranges = FAMILY_RANGES[kind](**shared["kinds"][kind])
        return cls(kind, count, ranges, shared["trial"]["seed"], requested_error(shared["errors"], kind, count))


def trial_names(trials: Trials) -> list[str]:
    """Return the names of all trials, which are those of their files."""
    return [f"{kind}_{count}" for kind, count in _scenes(trials)]


def _scenes(trials: Trials) -> list[tuple[str, int]]:
    """Return the family and number of every scene."""
    return [(kind, count) for kind in trials.kinds for count in range(trials.trial.scenes)]


def trial_job(trials: Trials, kind: str, count: int) -> dict[str, Any]:
    """Return what one trial depends on."""
    solvers = [solver_module(name) for name in DEFAULT_SOLVERS.values()]
    source = digest(computing_stage_digest("trial", *solvers), FILE.read_text(encoding="utf-8"))
    kinds = {name: asdict(ranges) for name, ranges in trials.kinds.items()}
    shared = {"kinds": kinds, "trial": {"seed": trials.trial.seed}, "errors": trials.errors}
    return {"settings": shared, "kind": kind, "count": count, "source": source}


def trials_figure_job(trials: Trials, tier: str) -> dict[str, Any]:
    """Return what the figure of all trials depends on."""
    data = [trial_job(trials, kind, count) for kind, count in _scenes(trials)]
    code, seed = stage_digest("trials_figure"), trials.trial.seed
    return {"settings": trials.layout, "tier": tier, "seed": seed, "source": code, "data": digest(data)}


def requested_error(errors: Sequence[float], kind: str, count: int) -> float:
    """Return the error requested of a scene: the errors of the list in turn, from another one for each family."""
    return errors[(count + sorted(FAMILIES).index(kind)) % len(errors)]


def run_trial(trial: Trial) -> tuple[xr.Dataset, dict[str, float]]:
    """Solve one random scene to a requested error and judge the result by a finer run.

    Parameters
    ----------
    trial : Trial
        The scene and the error.

    Returns
    -------
    data : xarray.Dataset
        Errors, points and work, dimension (scene); reproducible.
    costs : dict
        Seconds predicted, spent, and of the cheapest setting.
    """
    kind, tolerated = trial.kind, trial.requested_error
    run = draw_scene(kind, trial.ranges, trial.seed, trial.count)
    setup = run.setup
    expected = forecast_to_error(setup, tolerated)
    solve_setup(coarsen(choose_options(setup, tolerated)), QUANTITIES[kind])  # compiles the kernels
    result = solve_to_error(setup, tolerated)
    names = QUANTITIES[kind]
    reference = solve_setup(REFERENCES[setup.scene.kind](result.last.setup, kind), names)
    errors = [(solution, _error(solution, reference)) for solution in _ladder(result, names)]
    accurate = [solution for solution, error in errors if error <= tolerated]
    least = min(accurate, key=lambda solution: solution.transforms * solution.size, default=None)
    work = result.work * result.last.size
    row = {
        "requested_error": tolerated,
        "true_error": _error(result.last, reference),
        "predicted_error": max(float(values.max()) for values in result.errors.values()),
        "solve_count": len(result.before) + 1,
        "points": result.last.points,
        "predicted_points": expected.points,
        "work": work,
        "predicted_work": expected.transforms * setup.with_options(points=expected.points).size,
        "min_work": least.transforms * least.size if least else np.nan,
        "min_work_points": least.points if least else -1,
        "settings_tried": len(errors),
        "settings_within_error": len(accurate),
    }
    coordinates = {"scene": [f"{kind} {trial.count}"], "kind": ("scene", [kind])}
    data = xr.Dataset({name: ("scene", [value]) for name, value in row.items()}, coordinates)
    data = data.assign(description=("scene", [_describe_scene(run)]))
    costs = {"predicted": expected.seconds, "seconds": result.seconds, "least": least.seconds if least else math.nan}
    return dataset.describe(data), costs


def _error(solution: Solution, reference: Solution) -> float:
    """Return the largest relative error of all quantities."""
    return max(float(relative_difference(reference, solution, name).max()) for name in solution.values)


def _load_reference(setup: Setup, kind: str) -> Setup:
    """Return a finer grid and a tighter tolerance for loads at a hard wall."""
    tight = setup.with_options(tolerance=setup.options.tolerance * REFERENCE_TOLERANCE)
    return set_grid(tight, setup.points * REFERENCE_GRIDS[kind])


def _path_reference(setup: Setup, kind: str) -> Setup:
    """Return a finer grid, shorter increments and a tighter tolerance for a path of cohesive laws."""
    tight = scale_increment(
        setup.with_options(tolerance=setup.options.tolerance * REFERENCE_TOLERANCE), REFERENCE_INCREMENT
    )
    return set_grid(tight, setup.points * PATH_REFERENCE_GRID)


REFERENCES = {ProblemKind.HARD_WALL: _load_reference, ProblemKind.COHESIVE: _path_reference}


def _ladder(result: Controlled, names: tuple[str, ...]) -> list[Solution]:
    """Return every setting about the final one, solved on its own."""
    last = result.last.setup
    setups = {}
    for grid, pace, tolerance in itertools.product(LADDER_GRIDS, *LADDER_FACTORS[last.scene.kind]):
        setup = last.with_options(tolerance=last.options.tolerance * tolerance)
        setup = set_grid(scale_increment(setup, pace), last.points * grid)
        setups[setup.points, pace, tolerance] = setup
    return [solution for solution in (_solved(setup, names) for setup in setups.values()) if solution]


def _solved(setup: Setup, names: tuple[str, ...]) -> Solution | None:
    """Return a setting solved; None where it cannot be posed, as on a grid that is too coarse for its path."""
    try:
        return solve_setup(setup, names)
    except InputError:
        return None


def _describe_scene(run: Run) -> str:
    """Return the drawn quantities of a scene in a few words."""
    settings = run.settings
    surface, load, body = settings["surface"], settings["load"], settings.get("counter_body") or settings["body"]
    if "hurst_exponent" in surface:
        parts = [
            f"H {surface['hurst_exponent']:.2g}",
            f"λr/λs {surface['long_cutoff'] / surface['short_cutoff']:.0f}",
        ]
    else:
        parts = [f"{surface['kind']} R {surface['radius'] / 1000:.3g} µm"]
    if "values" in load:
        parts.append(f"{RESULTS[load['name']].phrase} {load['values'][0]:.2g}")
    law = next((settings[name] for name in settings["effects"] if settings.get(name)), None)
    if law is not None:
        deepest = settings["slide"]["approach"] if "slide" in settings else load["through"][-1]
        parts += [f"φn {law['work_of_separation']:.2g} N/m", f"φt/φn {law['work_ratio']:.2g}"]
        parts += [f"ν {body['poisson_ratio']:.2g}", f"δ {deepest:.3g} nm"]
    return ", ".join(parts)
