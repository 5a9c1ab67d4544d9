"""Steps of an ordered quantity along a dimension, positive in the sense of the order."""

from __future__ import annotations

import xarray as xr


def rising_steps(values: xr.DataArray, along: str) -> xr.DataArray:
    """Return the changes from one value of a dimension to the next, positive where the quantity rises."""
    return values.diff(along)


def falling_steps(values: xr.DataArray, along: str) -> xr.DataArray:
    """Return the changes from one value of a dimension to the next, positive where the quantity falls."""
    return -values.diff(along)


def steps_from_one(values: xr.DataArray, along: str) -> xr.DataArray:
    """Return the changes of the distance to one along a dimension, positive where the quantity departs from one."""
    return abs(values - 1).diff(along)


def steps_to_one(values: xr.DataArray, along: str) -> xr.DataArray:
    """Return the changes of the distance to one along a dimension, positive where the quantity comes closer to one."""
    return -abs(values - 1).diff(along)
