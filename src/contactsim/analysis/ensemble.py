"""What ensembles say when they are compared: differences and ratios of means, each with its standard error.

Solutions that did not converge are left out and counted. Members are the same surfaces but for their scale, so what is
changed on them is taken member by member; different Hurst exponents, and lines and surfaces, are independent.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from contactsim.analysis import grid_convergence
from contactsim.errors import InputError
from contactsim.status import is_solved

ROUNDING = 1e-9
"""Of the ends of a selection."""


def converged(values: xr.DataArray, data: xr.Dataset) -> xr.DataArray:
    """Values with NaN where the solution did not converge."""
    return values.where(is_solved(data.status))


def unconverged(data: xr.Dataset) -> tuple[int, int]:
    """How many solutions did not converge, and how many there are; paths of a study need not be equally long."""
    exist = data.status.notnull()
    return int((exist & ~is_solved(data.status)).sum()), int(exist.sum())


def widen_interval(low: float, high: float) -> tuple[float, float]:
    """Return the ends of a selection, moved outwards by a rounding error."""
    return low - ROUNDING * abs(low), high + ROUNDING * abs(high)


def on_all_grids(data: xr.Dataset, name: str) -> xr.DataArray:
    """A quantity of the members that converged on all grids; NaN for the others."""
    values = converged(data[name], data)
    return values.where(values.notnull().all("points"))


def ratio_limits(one: xr.Dataset, two: xr.Dataset, name: str) -> xr.Dataset:
    """The mean of a quantity over that in another, independent ensemble, on three grids and extrapolated.

    `points` of both count the same points per wavelength: InputError if not. Returns `ratio` along `points` and, with
    both means extrapolated, `limit` and its `spread`: less that of first order; each with its standard error.
    """
    grids, others = one.points.values, two.points.values
    if grids.shape != others.shape or not np.allclose(grids, others, rtol=1e-9, atol=0):
        raise InputError("points", others.tolist(), f"per wavelength those of the other ensemble, {grids.tolist()}")
    two = two.assign_coords(points=grids)

    def ratios(above: xr.DataArray, below: xr.DataArray) -> xr.Dataset:
        """Of the means, on each grid."""
        return (above / below).to_dataset(name="ratio")

    def limits(above: xr.DataArray, below: xr.DataArray) -> xr.Dataset:
        """Of the means, extrapolated."""
        top, bottom = grid_convergence.extrapolated(above), grid_convergence.extrapolated(below)
        limit = top.limit / bottom.limit
        first = (top.limit - top.spread) / (bottom.limit - bottom.spread)
        return xr.Dataset({"limit": limit, "spread": limit - first})

    ensembles = [on_all_grids(data, name) for data in (one, two)]
    return xr.merge([grid_convergence.jackknifed(measure, *ensembles) for measure in (ratios, limits)])


@dataclass(frozen=True)
class Departure:
    """A difference of two means: its size, its standard error, and the two places."""

    difference: float
    standard_error: float
    places: tuple[dict[str, float], dict[str, float]]

    @property
    def in_errors(self) -> float:
        """The difference over its standard error."""
        return self.difference / self.standard_error


def departure(data: xr.Dataset, name: str, along: str) -> Departure:
    """The most significant difference of a quantity between two values of `along`, all else being equal.

    Members are the same profiles but for their scale along everything else than the Hurst exponent, so differences are
    taken member by member there; different Hurst exponents are independent. Needs two members or more.
    """
    if data.member.size < 2:
        raise InputError("members", data.member.size, "2 or more: without a spread nothing is significant")
    if data[along].size < 2:
        raise InputError(along, data[along].size, "2 or more values: a difference needs two")
    values = converged(data[name], data)
    others = [dim for dim in values.dims if dim not in ("member", along)]
    best = None
    for (i, first), (j, second) in (
        (a, b) for a in enumerate(data[along]) for b in enumerate(data[along]) if a[0] < b[0]
    ):
        one, two = values.isel({along: i}, drop=True), values.isel({along: j}, drop=True)
        paired = along != "hurst_exponent"
        gap = abs((one - two).mean("member")) if paired else abs(one.mean("member") - two.mean("member"))
        square = _squared_error(one - two) if paired else _squared_error(one) + _squared_error(two)
        error = np.sqrt(square)
        if not (gap / error).notnull().any():
            continue
        place = (gap / error).argmax(...)
        found = Departure(
            float(gap[place]),
            float(error[place]),
            tuple(
                {dim: float(data[dim][place[dim]]) for dim in others} | {along: float(end)} for end in (first, second)
            ),
        )
        if best is None or found.in_errors > best.in_errors:
            best = found
    return best


def relative_change(data: xr.Dataset, name: str, along: str, reference: object) -> xr.Dataset:
    """Change of a quantity from its value at a reference of `along`, as a part of that, with its standard error.

    Taken member by member, so only for what leaves the profiles as they are. Variables `NAME_change` and
    `NAME_change_standard_error`, the latter NaN for one member.
    """
    apart = difference(data, name, along, reference)
    values = converged(data[name], data)
    start = values.sel({along: reference}, drop=True)
    level = start.where(values.notnull()).mean("member")
    names = {f"{name}_difference{error}": f"{name}_change{error}" for error in ("", "_standard_error")}
    return (apart / level).rename(names)


def difference(data: xr.Dataset, name: str, along: str, reference: object) -> xr.Dataset:
    """Difference of a quantity from its value at a reference of `along`, and its standard error.

    Taken member by member, over those known at both. Variables `NAME_difference` and `NAME_difference_standard_error`,
    the latter NaN for one member.
    """
    values = converged(data[name], data)
    apart = values - values.sel({along: reference}, drop=True)
    mean = apart.mean("member")
    error = np.sqrt(_squared_error(apart)) if data.member.size > 1 else mean * np.nan
    return xr.Dataset({f"{name}_difference": mean, f"{name}_difference_standard_error": error})


def _squared_error(values: xr.DataArray) -> xr.DataArray:
    """Squared standard error of the mean over the members that are known."""
    return values.var("member", ddof=1) / values.notnull().sum("member")


def ratio_of_means(one: xr.Dataset, two: xr.Dataset, name: str) -> xr.Dataset:
    """The mean of a quantity over that in another, independent ensemble: `value` and its standard `error`."""
    value = one[f"{name}_mean"] / two[f"{name}_mean"]
    parts = [data[f"{name}_standard_error"] / data[f"{name}_mean"] for data in (one, two)]
    return xr.Dataset({"value": value, "error": value * np.sqrt(parts[0] ** 2 + parts[1] ** 2)})
