"""Fit what error control takes from a population of scenes: coverage factors, and relations between runs and work.

Factors are in `error_control.estimates`, relations in `error_control/scaling.json`; no trial takes part in either.
"""

from __future__ import annotations

import json
import logging
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import least_squares

from contactsim.contact.problem_kind import ProblemKind
from contactsim.error_control.estimates import FACTORS, told_changes
from contactsim.error_control.forecast import transform_seconds
from contactsim.error_control.ladder import told_values
from contactsim.error_control.options import scale_increment
from contactsim.error_control.scaling import FAMILIES, features, run_family
from contactsim.error_control.solution import Solution, relative_difference, solve_setup
from contactsim.evaluation.calibration.trial import Trial, solve_with_reference
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.options import Setup
from contactsim.traits import Trait

logger = logging.getLogger(__name__)

COVERAGE, SELECTION = 0.99, 1.3
"""Part of true errors that estimates cover, one by one; and a margin, as runs end where their estimate is small, be it
by chance. Both together cover 95 of 100 final runs at all their loads."""
FAINT, LARGE = 1e-3, 0.3
"""Errors smaller than the first, true and estimated, and estimates larger than the second are left out."""
LEAST = 1e-5
"""Least estimate, in place of none where runs agree."""
RIDGE_WEIGHT = 1e-2
"""Weight that keeps coefficients small where features are alike."""
UNITS = ("step", "transform", "point")
"""Work that takes time: of a load or step, of a transform, and of its points times their binary logarithm."""
NOT_RANGED = ("one", "tolerance", "every", "steps")
"""Features of a user's options: they do not put a scene outside the measured ranges."""


def measure_scene(trial: Trial) -> pd.DataFrame:
    """Return one row for each run that tells a work, and for each run, quantity and load that tells an error.

    Columns are `family`, features, `transforms`, `seconds`, `count` and `total` of the first, which begin from nothing;
    and `changes`, how many changes tell the error, and `ratio`, the true error over what they say, of the second.
    """
    judged = solve_with_reference(trial)
    runs = [*judged.result.before, judged.result.last]
    cold = [solve_setup(setup, ()) for setup in _cold_setups(runs)]
    lattice = math.isfinite(trial.setup.scene.pairing.lattice_constant)  # whose costs are not fitted
    rows = [row for run in [*cold, judged.reference] for row in ([] if lattice else _work_rows(run))]
    for count, name in ((count, name) for count in range(2, len(runs) + 1) for name in judged.reference.values):
        run, sizes = runs[count - 1], np.abs(judged.reference.values[name])
        changes = told_changes(*told_values(runs[:count], name))
        told = np.divide(np.linalg.norm(changes, axis=0), sizes, out=np.full(sizes.shape, np.inf), where=sizes > 0)
        true = relative_difference(judged.reference, run, name)
        with np.errstate(invalid="ignore"):  # what the increments tell is covered whatever the factors are
            true[true * sizes <= run.increment_errors.get(name, 0.0)] = 0.0
        counts = (np.maximum(told, true) > FAINT) & (told < LARGE) & np.isfinite(run.values[name])
        rows += [{"changes": len(changes), "ratio": ratio} for ratio in true[counts] / np.maximum(told[counts], LEAST)]
    return pd.DataFrame(rows).assign(scene=f"{trial.kind} {trial.count}", unit=transform_seconds())


def _cold_setups(runs: Sequence[Solution]) -> list[Setup]:
    """Return setups like those of some runs, which begin from nothing; of paths with other increments too."""
    setups = [run.setup for run in runs]
    if setups[0].scene.kind is ProblemKind.HARD_WALL:
        return [setup.with_options(keep=()) for setup in setups]
    setups.append(scale_increment(setups[-2], 0.4))
    if {Trait.MEAN_PRESSURE, Trait.WALL} & setups[0].scene.traits:  # adaptive ones would locate each point that touches
        return setups
    return [*setups, setups[-2].with_options(increments=Adaptive())]


def _work_rows(run: Solution) -> list[dict[str, Any]]:
    """Return a row for each load, or one for a path."""
    scene, data = run.setup.scene, run.data
    shared = {"family": run_family(scene), "total": run.size}
    places = features(run.setup)
    if len(places) == 1:
        works = [(data.step.size, run.transforms, run.seconds)]
    else:
        works = [(1, *numbers) for numbers in zip(data.transforms.values, data.seconds.values, strict=True)]
    return [
        shared | numbers | {"count": count, "transforms": float(transforms), "seconds": float(seconds)}
        for numbers, (count, transforms, seconds) in zip(places, works, strict=True)
    ]


def coverage_factors(table: pd.DataFrame) -> list[float]:
    """Return the factors of estimates from two and from three changes that cover true errors."""
    ratios = table[table.changes.isin(FACTORS)].groupby("changes").ratio
    return [_round(SELECTION * value) for value in ratios.quantile(COVERAGE).sort_index()]


def fit_family(works: pd.DataFrame, family: str) -> dict[str, Any]:
    """Fit the relations of one family to its rows: a straight line through logarithms by least squares."""
    unit, rows = works.unit.median(), works[works.family == family].dropna(axis=1, how="all")
    known = {"family", "total", "count", "transforms", "seconds", "scene", "unit"}
    names = [str(name) for name in rows if name not in known]
    rows = rows[rows.transforms > 0]
    matrix, logs = rows[names].to_numpy(float), np.log(rows.transforms.to_numpy(float))
    penalty = np.sqrt(RIDGE_WEIGHT * len(rows)) * np.diag([float(name != "one") for name in names])
    padded = np.vstack([matrix, penalty]), np.concatenate([logs, np.zeros(len(names))])
    solution = np.linalg.lstsq(*padded, rcond=None)[0]
    size, seconds = rows.total.to_numpy(float), rows.seconds.to_numpy(float)
    parts = np.stack([rows["count"], rows.transforms, rows.transforms * size * np.log2(size)], axis=1).astype(float)
    begin = np.log(np.median(seconds[:, None] / parts, axis=0) / len(parts.T))
    times = np.exp(least_squares(lambda logs: np.log(parts @ np.exp(logs) / seconds), begin, loss="soft_l1").x)
    return {
        "transforms": {name: _round(value) for name, value in zip(names, solution, strict=True)},
        "units": {name: _round(value / unit) for name, value in zip(UNITS, times, strict=True)},
        "ranges": {
            name: [_round(rows[name].min()), _round(rows[name].max())] for name in names if name not in NOT_RANGED
        },
    }


def _round(value: float) -> float:
    """Return a value with four digits, which is more than its accuracy."""
    return float(f"{value:.4g}")


def format_fit(tables: Sequence[pd.DataFrame]) -> str:
    """Return the fitted relations as the text of their file, a line each; the coverage factors are logged."""
    table = pd.concat(tables, ignore_index=True)
    works = table.dropna(subset="family")
    families = [f'"{name}": {json.dumps(fit_family(works, name))}' for name in FAMILIES]
    logger.info("coverage factors of two and of three changes: %s", coverage_factors(table))
    return "{\n" + ",\n".join(families) + "\n}\n"
