"""Estimate the number that answers a claim, its ensemble error and its grid error by the rules of docs/judging.md."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import stdtrit

from contactsim import dataset
from contactsim.analysis.carried import CARRIED
from contactsim.analysis.comparison import Comparison, Datasets, members_left_out
from contactsim.analysis.ensemble import widen
from contactsim.analysis.quantities import (
    PATH_ERRORS,
    SCATTERS,
    SECOND_ESTIMATORS,
    grid_change_name,
    resolves_edges,
    scatter_name,
    second_estimate,
    source_quantity,
)
from contactsim.grid import Array
from contactsim.observables.dataset_forms import EXACT_SUMMARIES, PATH_SUMMARIES

NAN = float("nan")
MIN_MARGIN = 2.0
"""Least distance from the edge of a band, in errors, at which a claim is decided."""
Number = Callable[[Datasets], Any]
"""Function of datasets: one number, or an array of numbers that each have an error."""


@dataclass(frozen=True)
class Estimate:
    """A number with its ensemble error and its grid error; NaN is unknown."""

    value: float = NAN
    ensemble_error: float = NAN
    grid_error: float = NAN

    @property
    def error(self) -> float:
        """Both errors in quadrature."""
        return math.hypot(self.ensemble_error, self.grid_error)


def estimate(comparison: Comparison) -> Estimate:
    """Return the number that answers a claim, all NaN where the selection is empty."""
    if comparison.is_empty:
        return Estimate()
    if comparison.claim["grid"] == "thesis":
        return estimate_on_thesis_grid(comparison)
    return _estimate(comparison, _grid_error(_at_fixed_places(comparison), comparison))


def estimate_on_thesis_grid(comparison: Comparison) -> Estimate:
    """Return the number of the thesis's own number of points, without a grid error; on another it is unknown."""
    if comparison.is_empty:
        return Estimate()
    return _estimate(comparison, 0.0 if all(map(is_on_thesis_grid, comparison.data)) else NAN)


def is_on_thesis_grid(data: xr.Dataset) -> bool:
    """Return True if a dataset has the thesis's own number of points."""
    return bool((data.points == dataset.settings_of(data)["thesis_points"]).all())


def estimate_steps(number: Number, comparison: Comparison) -> tuple[Array, Array]:
    """Return the changes of an ordered quantity, positive in the claimed sense, and the error of each; flat arrays.

    number: `Comparison.steps`, or `Comparison.end_to_end` for the changes from one end to the other
    """
    if comparison.is_empty:
        return np.full(1, NAN), np.full(1, NAN)
    errors = [_ensemble_error(number, comparison), _grid_error(number, comparison)]
    return number(comparison.data), _in_quadrature(errors)


def _estimate(comparison: Comparison, grid_error: float) -> Estimate:
    """Return the number with its ensemble error and a given grid error."""
    errors = [_ensemble_error(comparison.unbiased_number, comparison), *_errors_of_changes(comparison)]
    ensemble_error = _in_quadrature(errors)
    return Estimate(comparison.unbiased_number(comparison.data), float(ensemble_error), float(grid_error))


def _at_fixed_places(comparison: Comparison) -> Number:
    """Return the number as a function of datasets, with extremes where they are in those of the comparison."""
    return lambda data: comparison.number(data, searched=comparison.data)


def _in_quadrature(errors: Iterable[Any]) -> Any:
    """Return the root of the sum of the squares."""
    return np.sqrt(sum(np.square(error) for error in errors))


def _ensemble_error(number: Number, comparison: Comparison) -> Any:
    """Return the jackknife errors of independent ensembles in quadrature."""
    return _in_quadrature(_jackknife_error(number, comparison.data, group) for group in comparison.groups)


def _errors_of_changes(comparison: Comparison) -> Iterator[float]:
    """Yield the error of a number about a grid error for each study: few members are solved on both grids.

    The grid error of all loads is moved by its standard error at once. From one member of a random surface it is
    unknown.
    """
    name, data = comparison.claim["quantity"], comparison.data
    scatter = scatter_name(name)
    for index, study in enumerate(data if scatter else ()):
        settings = dataset.settings_of(study)
        if settings["surface"]["kind"] != "self_affine":
            continue
        if scatter not in study:
            yield NAN
            continue
        errors = student_factor(settings["coarse_grid"]["members"]) * study[scatter]
        moved = [*data[:index], study.assign({name: study[name] + errors}), *data[index + 1 :]]
        yield comparison.number(moved) - comparison.number(data)


def _jackknife_error(number: Number, data: Datasets, group: Sequence[int]) -> Any:
    """Return the error from leaving out members of a group of datasets: a standard error, widened for a small ensemble.

    One member has no error if the surface is not random, else an unknown one.
    """
    count = data[group[0]].member.size
    if count == 1:
        return NAN if dataset.settings_of(data[group[0]])["surface"]["kind"] == "self_affine" else 0.0
    numbers = [number(parts) for parts in members_left_out([widen(study) for study in data], group)]
    return student_factor(len(numbers)) * np.sqrt((len(numbers) - 1) * np.var(numbers, axis=0))


def student_factor(parts: int) -> float:
    """Return the factor by which a standard error from some parts grows, so that two errors hold 95 % (Student)."""
    return float(stdtrit(parts - 1, 0.975)) / MIN_MARGIN


def _grid_error(number: Number, comparison: Comparison) -> Any:
    """Return the change of a number on the coarser grid, in quadrature with the errors of paths and of their fits.

    Of corrected quantities it is at least the distance to their second estimator, where the grid resolves that.
    """
    data, claim = comparison.data, comparison.claim
    names = sorted(
        {name for name in (claim["quantity"], claim["against"]) if name is not None and source_quantity(name)}
    )
    changes = {str(source_quantity(name)): str(grid_change_name(name)) for name in names}
    if any(change not in study for study in data for change in changes.values()):
        return NAN
    if any(_lacks_path_error(study, name) for study in data for name in changes):
        return NAN
    fine = number(data)
    is_scatter = claim["quantity"] in SCATTERS
    coarse = [study.assign({name: _on_coarser_grid(study, name, is_scatter) for name in changes}) for study in data]
    change = abs(number(coarse) - fine)
    corrected = [name for name in changes if name in (*SECOND_ESTIMATORS, *CARRIED)]
    if corrected and all(resolves_edges(study) for study in data):
        second = [study.assign({name: second_estimate(study, name) for name in corrected}) for study in data]
        change = np.maximum(change, abs(number(second) - fine))
    moved = [parts for name in changes for parts in _moved_by_path_errors(data, name)]
    return _in_quadrature([change, *(number(parts) - fine for parts in moved)])


def _on_coarser_grid(data: xr.Dataset, name: str, is_scatter: bool) -> xr.DataArray:
    """Return a quantity of all members on the coarser grid, where the change of its mean is known.

    All members change alike; for the scatter of the members, in proportion.
    """
    values, change = data[name], data[str(grid_change_name(name))]
    return values * (1 - change / values.mean("member")) if is_scatter else values - change


def _lacks_path_error(data: xr.Dataset, name: str) -> bool:
    """Return True for a summary of a path in which the increments leave an error that was not measured."""
    if name not in PATH_SUMMARIES or name in EXACT_SUMMARIES:
        return False
    return not any(f"{name}_{kind}_error" in data for kind in PATH_ERRORS)


def _moved_by_path_errors(data: Datasets, name: str) -> Iterator[list[xr.Dataset]]:
    """Yield the datasets with a quantity moved by an error of one variant of one study after another."""
    for index, study in enumerate(data):
        for kind in PATH_ERRORS:
            if f"{name}_{kind}_error" not in study:
                continue
            errors = study[f"{name}_{kind}_error"]  # the paths of members are independent
            error = (errors**2).sum("member", skipna=False) ** 0.5 / errors.sizes["member"]
            for place in np.ndindex(error.shape):
                step = xr.zeros_like(error)
                step[place] = error[place]
                yield [*data[:index], study.assign({name: study[name] + step}), *data[index + 1 :]]
