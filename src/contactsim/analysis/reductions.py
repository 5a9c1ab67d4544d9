"""Reduce the quantities of a dataset to single numbers.

A quantity is a mean over members, or its limit on finer grids. A reduction is a function of one quantity. Its further
parameters `against` (another quantity), `along` and `across` (dimensions) say what else it needs.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable

import numpy as np
import xarray as xr

from contactsim import reference
from contactsim.analysis import grid_convergence
from contactsim.analysis.ensemble import converged, on_all_grids
from contactsim.analysis.fits import fit_line_area
from contactsim.observables.dataset_forms import AVERAGED, PATH_SUMMARIES, form_of


def mean(values: xr.DataArray) -> float:
    """Return the mean over all points."""
    return float(values.mean())


def spread(values: xr.DataArray, along: str) -> float:
    """Return (largest − smallest)/mean along a dimension, averaged over the others."""
    return float(((values.max(along) - values.min(along)) / values.mean(along)).mean())


def largest_spread(values: xr.DataArray, along: str) -> float:
    """Return (largest − smallest)/|mean| along a dimension, the largest over the others."""
    return float(((values.max(along) - values.min(along)) / abs(values.mean(along))).max())


def rise(values: xr.DataArray, along: str) -> float:
    """Return the relative rise from the first to the last value of a dimension, averaged over the others."""
    return float(_rise(values, along).mean())


def largest_rise(values: xr.DataArray, along: str) -> float:
    """Return the relative rise from the first to the last value of a dimension, the largest over the others."""
    return float(_rise(values, along).max())


def least_rise(values: xr.DataArray, along: str) -> float:
    """Return the relative rise from the first to the last value of a dimension, the smallest over the others."""
    return float(_rise(values, along).min())


def rise_gain(values: xr.DataArray, along: str, across: str) -> float:
    """Return the mean difference of the relative rise between the last and the first value of another dimension."""
    rises = _rise(values, along)
    return float((rises.isel({across: -1}) - rises.isel({across: 0})).mean())


def shortfall(values: xr.DataArray, along: str) -> float:
    """Return the part by which the first value of a dimension is below the last, averaged over the others."""
    return float((1 - values.isel({along: 0}) / values.isel({along: -1})).mean())


def _rise(values: xr.DataArray, along: str) -> xr.DataArray:
    """Return the relative rise from the first to the last value of a dimension."""
    return values.isel({along: -1}) / values.isel({along: 0}) - 1


def least_step(values: xr.DataArray, along: str) -> float:
    """Return the smallest change from one value of a dimension to the next, over all others."""
    return float(values.diff(along).min())


def largest_step(values: xr.DataArray, along: str) -> float:
    """Return the largest change from one value of a dimension to the next, over all others."""
    return float(values.diff(along).max())


def least(values: xr.DataArray) -> float:
    """Return the smallest of all points."""
    return float(values.min())


def largest(values: xr.DataArray) -> float:
    """Return the largest of all points."""
    return float(values.max())


def fall(values: xr.DataArray, along: str) -> float:
    """Return the relative fall from the first to the last value of a dimension, averaged over the others."""
    return float((1 - values.isel({along: -1}) / values.isel({along: 0})).mean())


def slope(values: xr.DataArray, against: xr.DataArray, along: str) -> float:
    """Return the slope of the line through the logarithms along a dimension, averaged over the others."""
    x = np.log(against) - np.log(against).mean(along)
    return float(((x * np.log(values)).sum(along, skipna=False) / (x**2).sum(along)).mean())


def spread_ratio(values: xr.DataArray, against: xr.DataArray, along: str) -> float:
    """Return the spread of a quantity over the spread of another."""
    return spread(values, along) / spread(against, along)


def departure(values: xr.DataArray, against: xr.DataArray) -> float:
    """Return the largest relative departure from another quantity."""
    return float(abs(values / against - 1).max())


def ratio(values: xr.DataArray, against: xr.DataArray) -> float:
    """Return the largest ratio to another quantity."""
    return float((values / against).max())


REDUCTIONS: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (
        *(mean, spread, fall, slope, spread_ratio, departure, ratio),
        *(least, largest, least_step, largest_step, largest_spread),
        *(rise, least_rise, largest_rise, rise_gain, shortfall),
    )
}
"""Reductions by the name that claims give them."""


def reduction_inputs(reduction: str) -> list[str]:
    """Return what a reduction needs beside the quantity: some of `against`, `along` and `across`."""
    return list(inspect.signature(REDUCTIONS[reduction]).parameters)[1:]


FITTED: dict[str, tuple[str, bool]] = {
    "kappa_fit": ("area", False),
    "kappa_fit_logarithm": ("logarithm", False),
    "kappa_fit_all": ("area", True),
}
"""κ of Eq. 3.11 fitted to the selected loads: its weighting, and whether all Hurst exponents share one fit."""
LIMIT = "_limit"
"""End of the name of a quantity's limit on finer grids, from three grids."""


def mean_quantity(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return a quantity as the mean over members, or as the limit of that mean on finer grids.

    Parameters
    ----------
    data
        Dataset of a study. Solutions that did not converge are left out.
    name
        A variable, a variable with `LIMIT`, one of `FITTED`, `half_width` or `contact_radius`.

    Notes
    -----
    If one of the means has no limit, all limits are NaN: the others would not be a fair sample.
    """
    if name.removesuffix(LIMIT) in AVERAGED and name.endswith(LIMIT):
        means = on_all_grids(data, name.removesuffix(LIMIT)).mean("member")
        limit = grid_convergence.extrapolate(means).limit
        return limit.where(limit.notnull().all())
    if name in FITTED:
        return _fitted_kappa(data, *FITTED[name])
    if name == "half_width":
        return mean_quantity(data, "relative_contact_area") * data.length / 2
    if name == "contact_radius":
        return np.sqrt(mean_quantity(data, "relative_contact_area") * data.length * data.length_y / np.pi)
    return form_of(data).member_mean(data, name)


def _fitted_kappa(data: xr.Dataset, weighting: str, together: bool) -> xr.DataArray:
    """Return κ of Eq. 3.11 fitted to the area, (hurst_exponent, reduced_pressure)."""
    area = converged(data.relative_contact_area, data).transpose("hurst_exponent", "member", "reduced_pressure").values
    pressure = data.reduced_pressure.values
    samples = [area] * len(area) if together else area
    kappa = [reference.line_area(pressure, *fit_line_area(pressure, rows, weighting)) / pressure for rows in samples]
    return xr.DataArray(kappa, dims=("hurst_exponent", "reduced_pressure"))


def source_quantity(name: str) -> str | None:
    """Return the averaged quantity that another is computed from; None for an exact one, which has no grid error."""
    source = "relative_contact_area" if name in (*FITTED, "half_width", "contact_radius") else name.removesuffix(LIMIT)
    return source if source in (*AVERAGED, *PATH_SUMMARIES) else None


def grid_error_name(name: str) -> str | None:
    """Return the variable that holds the grid error of a quantity's source; None for an exact quantity."""
    source = source_quantity(name)
    if source is None:
        return None
    return f"{source}_spread" if name.endswith(LIMIT) else f"{source}_grid_error"
