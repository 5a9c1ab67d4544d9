"""The error of every setting against what it took, and solvers compared at equal error.

The error of points is measured against a finer grid, that of the tolerance against the same grid solved far more
tightly, that of a path's increment against far smaller ones; the error of the ensemble is its standard error. Cost is
transforms, in equivalents of one on the grid at hand, times its size, so that grids compare; of a path those of all its
steps.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.evaluation.work_precision.cases import REFERENCE
from contactsim.evaluation.work_precision.knobs import KNOBS, summarise_solutions
from contactsim.observables.dataset_forms import load_dimension
from contactsim.status import is_solved

ROUNDING = 1e-10
"""Errors below it are rounding: both solutions have the same contact."""


def error_table(
    quantities: Sequence[str],
    loads: Sequence[float] | None,
    jobs: Mapping[str, xr.Dataset],
    study: xr.Dataset,
    default: str,
) -> pd.DataFrame:
    """Return one row a setting: solver, knob, its values, members, error of each quantity, work, share unconverged.

    loads: those of the case, None for a path; jobs: datasets by solver, with the reference's; study: the dataset of the
    study as far as it is priced, for the size of the ensemble; default: its own solver. Errors are relative, root mean
    square over variants, members and loads, infinite where one of them has no value, as without contact; work is
    transforms times all points of the grid.
    """
    rows = []
    references = {str(solution.knob.item()): solution for solution in _split_settings(jobs[REFERENCE])}
    knobs = [knob for knob in KNOBS if knob in jobs[REFERENCE]]
    for kind, data in jobs.items():
        for solution in _split_settings(data) if kind != REFERENCE else ():
            reference = references[solution.knob.item()]
            rows.append({"solver": kind} | {name: solution[name].item() for name in ("knob", *knobs)})
            for name in quantities:
                rows[-1][name] = _root_mean_square(solution[name] / reference[name] - 1)
            rows[-1]["work"] = float(solution.transforms.sum() * _size(solution))
            rows[-1]["unconverged"] = unconverged_share(solution)
    columns = ["solver", "knob", *knobs, "members", *quantities, "work", "unconverged"]
    table = pd.DataFrame(rows + list(_ensembles(quantities, loads, study, default)), columns=columns)
    return table.assign(own=table.solver == default)


def _split_settings(data: xr.Dataset) -> Iterable[xr.Dataset]:
    return (data.isel(setting=place) for place in range(data.setting.size))


def _size(data: xr.Dataset) -> float:
    """Return the points of the whole grid."""
    return float(data.points) * float(data.get("points_y", 1))


def _ensembles(
    quantities: Sequence[str], loads: Sequence[float] | None, study: xr.Dataset, default: str
) -> Iterable[dict[str, Any]]:
    """Return the standard errors of ensembles of two to all members, from the study's own scatter."""
    most = study.member.size
    summary = summarise_solutions(study.sel({load_dimension(study): loads}, method="nearest") if loads else study)
    for members in range(2, most + 1) if most > 1 else ():
        row = {"solver": default, "knob": "members", "points": int(study.points), "members": members}
        for name in quantities:
            row[name] = _root_mean_square(_standard_error(summary, name) * np.sqrt(most / members))
        work = float(summary.transforms.mean("member").sum() * members * _size(study))
        yield row | {"work": work, "unconverged": unconverged_share(summary)}


def _standard_error(study: xr.Dataset, name: str) -> xr.DataArray:
    """Of the mean over all members, as a part of it; a study of paths leaves it to be made of them."""
    if f"{name}_mean" in study:
        return study[f"{name}_standard_error"] / study[f"{name}_mean"]
    values = study[name]
    return values.std("member", ddof=1) / np.sqrt(values.count("member")) / values.mean("member")


def _root_mean_square(errors: xr.DataArray) -> float:
    """Return the root mean square of errors; infinite where one of them has no value."""
    return float(np.sqrt((errors**2).mean(skipna=False).fillna(np.inf)))


def unconverged_share(data: xr.Dataset) -> float:
    """Return the share of unconverged solutions."""
    return float((~is_solved(data.status)).mean())


def converged_rows(table: pd.DataFrame, quantity: str) -> pd.DataFrame:
    """Return the settings at which every solution converged and has an error."""
    return table[(table.unconverged == 0) & np.isfinite(table[quantity])]


def convergence_order(table: pd.DataFrame, quantity: str) -> float:
    """Return the observed order of convergence in the number of points: slope of log error, by least squares.

    Settings that failed, and those whose error is rounding, are left out.
    """
    good = converged_rows(table, quantity)
    good = good[good[quantity] > ROUNDING]
    return -float(np.polyfit(np.log(good.points), np.log(good[quantity]), 1)[0]) if len(good) > 1 else float("nan")


def pareto_front(table: pd.DataFrame, quantity: str, cost: str) -> pd.DataFrame:
    """Return the settings that no other beats in both error and cost, the cheapest first; rounding errors are equal."""
    good = converged_rows(table, quantity).sort_values([cost, quantity])
    errors = np.maximum(good[quantity], ROUNDING)
    return good[errors < errors.cummin().shift(fill_value=np.inf)]


def cost_at_error(table: pd.DataFrame, quantity: str, error: float, cost: str) -> float:
    """Return the least cost that meets the error, on straight lines between a curve's points; NaN outside its errors.

    Where larger errors cost more, it is that of the cheapest setting.
    """
    curve = table.sort_values(cost)
    errors = np.log(np.maximum(curve[quantity], np.finfo(float).eps))  # an error of zero is rounding
    if not (errors.min() <= np.log(error) <= errors.max()):
        return float("nan")
    return float(np.exp(np.interp(-np.log(error), -np.minimum.accumulate(errors), np.log(curve[cost]))))


def compare_solvers(
    table: pd.DataFrame, quantity: str, levels: Mapping[str, Iterable[float]], costs: Iterable[str]
) -> pd.DataFrame:
    """Return the cost of each solver over that of the study's own at equal error: a row a knob, level and solver.

    levels: errors by knob; a ratio is NaN where a solver was not measured at that error.
    """
    rows = []
    good = converged_rows(table, quantity)
    good = good[good.knob.isin(levels)]
    for (knob, kind), curve in good.groupby(["knob", "solver"], sort=False):
        own = good[(good.knob == knob) & good.own]
        for level in levels[knob]:
            ratios = {
                cost: cost_at_error(curve, quantity, level, cost) / cost_at_error(own, quantity, level, cost)
                for cost in costs
            }
            rows.append({"knob": knob, "error": level, "solver": kind} | ratios)
    return pd.DataFrame(rows, columns=["knob", "error", "solver", *costs])
