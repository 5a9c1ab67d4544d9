"""Errors of means and trends that figures show, by the rules of verdicts (docs/judging.md)."""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.analysis.comparison import SECOND_STUDY, Comparison
from contactsim.analysis.quantities import SECOND_ESTIMATORS, resolves_edges, second_estimate
from contactsim.analysis.uncertainty import Estimate, estimate, is_on_thesis_grid


def second_mean(data: xr.Dataset, name: str) -> xr.DataArray | None:
    """Return the mean of the second estimator of a corrected quantity if the grids resolve it, else None."""
    return second_estimate(data, name, "_mean") if name in SECOND_ESTIMATORS and resolves_edges(data) else None


def grid_error(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return the grid error of a quantity's mean; NaN where the study has no coarser grid.

    It is the change on halving the grid. Of a corrected quantity it is at least the distance to the second estimator if
    the grid resolves that. A quantity that is not corrected has none on the thesis's own number of points.
    """
    if name not in SECOND_ESTIMATORS and is_on_thesis_grid(data):
        return xr.DataArray(0.0)
    change, second = data.get(f"{name}_grid_error", xr.DataArray(np.nan)), second_mean(data, name)
    if second is None:
        return change
    return xr.apply_ufunc(np.maximum, change, abs(data[f"{name}_mean"] - second))


def mean_error(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return ensemble and grid error of a quantity's mean in quadrature, without the one that a study has not."""
    return xr.apply_ufunc(np.hypot, data[f"{name}_standard_error"].fillna(0.0), grid_error(data, name).fillna(0.0))


def estimate_trend(data: xr.Dataset, name: str, along: str) -> Estimate:
    """Return the change of a quantity's straight trend along a dimension over its mean, with its errors."""
    others = dict.fromkeys(("against", "across", "absent", *SECOND_STUDY, "grid"))
    return estimate(Comparison(others | {"quantity": name, "reduce": "trend", "along": along}, [data]))
