"""Comparison of ensembles: differences and ratios of means, each with its standard error.

Solutions that did not converge are left out and counted. Members are the same surfaces but for their scale, so changes
are computed member by member. Different Hurst exponents, and lines and surfaces, are independent.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.analysis import grid_convergence
from contactsim.errors import InputError
from contactsim.status import is_solved

WIDENING = "_widening"
"""End of the name of what is added to a number where its error is computed."""
ROUNDING = 1e-9
"""Relative rounding error of the ends of a selection."""


def converged(values: xr.DataArray, data: xr.Dataset) -> xr.DataArray:
    """Return values with NaN where the solution did not converge."""
    return values.where(is_solved(data.status))


def waves_name(data: xr.Dataset) -> str | None:
    """Return the name of the study whose random surfaces a dataset has, if it has a name."""
    settings = dataset.settings_of(data)
    return settings.get("same_surfaces_as") or settings.get("name")


def widen(data: xr.Dataset) -> xr.Dataset:
    """Return a dataset for the computation of errors: changes of few members count for more, as Student says."""
    widened = [str(name) for name in data.data_vars if str(name).endswith(WIDENING)]
    numbers = {name.removesuffix(WIDENING): data[name.removesuffix(WIDENING)] + data[name] for name in widened}
    return data.assign(numbers).drop_vars(widened)


def unconverged(data: xr.Dataset) -> tuple[int, int]:
    """Return the number of solutions that did not converge, and of all; paths of a study may differ in length."""
    exist = data.status.notnull()
    return int((exist & ~is_solved(data.status)).sum()), int(exist.sum())


def widen_interval(low: float, high: float) -> tuple[float, float]:
    """Return the ends of a selection, moved outwards by a rounding error."""
    return low - ROUNDING * abs(low), high + ROUNDING * abs(high)


def on_all_grids(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return a quantity of the members that converged on all grids; NaN for the others."""
    values = converged(data[name], data)
    return values.where(values.notnull().all("points"))


def ratio_limits(above: xr.Dataset, below: xr.Dataset, name: str) -> xr.Dataset:
    """Return the ratio of a quantity's means in two independent ensembles, on three grids and extrapolated.

    Parameters
    ----------
    above, below : Dataset
        Ensembles on three grids, with the same points per wavelength as `points`.
    name : str
        Name of the quantity.

    Returns
    -------
    Dataset
        `ratio` along `points`; of the extrapolated means `limit` and `spread`, the limit less that of first order; each
        with its standard error.

    Raises
    ------
    InputError
        For grids that differ.
    """
    grids, grids_below = above.points.values, below.points.values
    if grids.shape != grids_below.shape or not np.allclose(grids, grids_below, rtol=1e-9, atol=0):
        allowed = f"those per wavelength of the other ensemble, {grids.tolist()}"
        raise InputError("points", grids_below.tolist(), allowed)
    below = below.assign_coords(points=grids)

    def ratios(numerator: xr.DataArray, denominator: xr.DataArray) -> xr.Dataset:
        """Return the ratio of the means on each grid."""
        return (numerator / denominator).to_dataset(name="ratio")

    def limits(numerator: xr.DataArray, denominator: xr.DataArray) -> xr.Dataset:
        """Return the ratio of the extrapolated means."""
        top, bottom = grid_convergence.extrapolate(numerator), grid_convergence.extrapolate(denominator)
        limit = top.limit / bottom.limit
        first = (top.limit - top.spread) / (bottom.limit - bottom.spread)
        return xr.Dataset({"limit": limit, "spread": limit - first})

    ensembles = [on_all_grids(data, name) for data in (above, below)]
    return xr.merge([grid_convergence.jackknife(measure, *ensembles) for measure in (ratios, limits)])


def relative_change(data: xr.Dataset, name: str, along: str, reference: object) -> xr.Dataset:
    """Return the relative change of a quantity from its value at a reference along a dimension.

    It is computed member by member, so the dimension must leave the profiles as they are. Variables `NAME_change` and
    `NAME_change_standard_error`, the latter NaN for one member.
    """
    change = difference(data, name, along, reference)
    values = converged(data[name], data)
    start = values.sel({along: reference}, drop=True)
    level = start.where(values.notnull()).mean("member")
    names = {f"{name}_difference{error}": f"{name}_change{error}" for error in ("", "_standard_error")}
    return (change / level).rename(names)


def difference(data: xr.Dataset, name: str, along: str, reference: object) -> xr.Dataset:
    """Return the difference of a quantity from its value at a reference along a dimension.

    It is computed member by member, over those that converged at both. Variables are `NAME_difference` and
    `NAME_difference_standard_error`, the latter NaN for one member.
    """
    values = converged(data[name], data)
    change = values - values.sel({along: reference}, drop=True)
    mean = change.mean("member")
    error = np.sqrt(_squared_error(change)) if data.member.size > 1 else mean * np.nan
    return xr.Dataset({f"{name}_difference": mean, f"{name}_difference_standard_error": error})


def _squared_error(values: xr.DataArray) -> xr.DataArray:
    """Return the squared standard error of the mean over the members that converged."""
    return values.var("member", ddof=1) / values.notnull().sum("member")


def ratio_of_means(above: xr.Dataset, below: xr.Dataset, name: str) -> xr.Dataset:
    """Return the ratio of a quantity's means in two independent ensembles: `value` and its standard `error`."""
    value = above[f"{name}_mean"] / below[f"{name}_mean"]
    parts = [data[f"{name}_standard_error"] / data[f"{name}_mean"] for data in (above, below)]
    return xr.Dataset({"value": value, "error": value * np.sqrt(parts[0] ** 2 + parts[1] ** 2)})
