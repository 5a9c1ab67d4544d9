"""Numbers that a quantity of a dataset amounts to, each a function of its values.

Further parameters: `against`, another quantity; `along` and `across`, dimensions. An extreme is measured at given
`places`, so that its place and its value can come from different members (`contactsim.analysis.cross_validation`).
A value that is unknown makes the number unknown. Values along a dimension `SPLIT`, which are those of many halves of an
ensemble, give as many numbers.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from contactsim.observables.body_readings import CURVE_DIMENSION
from contactsim.variables import LOADS

SPLIT = "split"
"""Dimension of values that come from many halves of an ensemble."""
Places = Any
"""Places of extremes, as `DataArray.isel` takes them."""


def mean(values: xr.DataArray) -> float:
    """Return the mean over all points, over loads by trapezoids in their logarithm.

    So it does not depend on how many loads a study has, nor on where they are dense.
    """
    for load in LOADS:
        if load in values.dims and values.sizes[load] > 1:
            values = values.assign_coords({load: _logarithm(values[load])})
            values = values.integrate(load) / (values[load][-1] - values[load][0])
    return number_of(values.mean(_all_but_splits(values), skipna=False))


def _all_but_splits(values: xr.DataArray) -> list[Any]:
    """Return the dimensions over which one number is taken."""
    return [dim for dim in values.dims if dim != SPLIT]


def number_of(values: xr.DataArray) -> Any:
    """Return the only value as a number, or those of all splits."""
    return values if SPLIT in values.dims else float(values)


def trend(values: xr.DataArray, along: str) -> float:
    """Return the change of the straight trend from end to end over the mean, averaged over the other dimensions.

    The trend is that of least squares, against the logarithm of a load and against other dimensions as they are. The
    values at all loads of an ensemble come from the same surfaces. Weights from their covariance would scatter 1 to 7 %
    less if it were known; estimated from ten members it makes the trend scatter more.
    """
    places = _logarithm(values[along]) if along in LOADS else values[along].astype(float)
    centred = places - places.mean()
    change = (centred * values).sum(along, skipna=False) / (centred**2).sum() * (places[-1] - places[0])
    return mean(change / abs(values.mean(along, skipna=False)))


def rise(values: xr.DataArray, along: str) -> float:
    """Return the relative rise from the first to the last value of a dimension, averaged over the others."""
    return mean(rises(values, along))


def fall(values: xr.DataArray, along: str) -> float:
    """Return the relative fall from the first to the last value of a dimension, averaged over the others."""
    return mean(-rises(values, along))


def rise_gain(values: xr.DataArray, along: str, across: str) -> float:
    """Return the mean difference of the relative rise between the last and the first value of another dimension."""
    return mean(rise_gains(values, along, across))


def shortfall(values: xr.DataArray, along: str) -> float:
    """Return the part by which the first value of a dimension is below the last, averaged over the others."""
    return mean(1 - values.isel({along: 0}) / values.isel({along: -1}))


def excess(values: xr.DataArray, along: str) -> float:
    """Return the part of the last value of a dimension by which the first exceeds it, averaged over the others."""
    return -shortfall(values, along)


def slope(values: xr.DataArray, against: xr.DataArray, along: str) -> float:
    """Return the slope of the line through the logarithms along a dimension, averaged over the others."""
    return mean(slopes(values, against, along))


def slope_furthest_from_one(values: xr.DataArray, places: Places, against: xr.DataArray, along: str) -> float:
    """Return the slope of the line through the logarithms that is furthest from one, over the other dimensions."""
    return number_of(slopes(values, against, along).isel(places))


def origin_slope(values: xr.DataArray, against: xr.DataArray, along: str) -> float:
    """Return the slope of the line of least squares through the origin along a dimension, averaged over the others."""
    return mean((against * values).sum(along, skipna=False) / (against**2).sum(along, skipna=False))


def spread(values: xr.DataArray, places: Places, along: str) -> float:
    """Return (largest − smallest)/|mean| along a dimension, averaged over the others."""
    return mean(ranges(values, places, along))


def largest_spread(values: xr.DataArray, places: Places, along: str) -> float:
    """Return (largest − smallest)/|mean| along a dimension, the largest over the others."""
    ends, place = places
    return number_of(ranges(values, ends, along).isel(place))


def largest_difference(values: xr.DataArray, places: Places, along: str) -> float:
    """Return the largest difference between any two values along a dimension, or between one and zero, over the others.

    Of departures from a curve, zero is that curve.
    """
    ends, place = places
    return number_of(differences(_with_zero(values, along), ends, along).isel(place))


def spread_ratio(values: xr.DataArray, places: Places, against: xr.DataArray, along: str) -> float:
    """Return the spread of a quantity over the spread of another."""
    return spread(values, places[0], along) / spread(against, places[1], along)


def departure(values: xr.DataArray, places: Places, against: xr.DataArray) -> float:
    """Return the largest relative departure from another quantity."""
    place, sign = places
    return sign * number_of((values / against - 1).isel(place))


def furthest_from_one(values: xr.DataArray, places: Places) -> float:
    """Return the value that is furthest from one, such as the ratio of two studies that are said to agree."""
    return number_of(values.isel(places))


def identity(values: xr.DataArray) -> xr.DataArray:
    """Return the values themselves."""
    return values


def sizes(values: xr.DataArray) -> xr.DataArray:
    """Return the sizes of the values, whatever their sign."""
    return abs(values)


def correlation(values: xr.DataArray, against: xr.DataArray) -> float:
    """Return the correlation with another quantity over all points."""
    first, second = xr.broadcast(values, against)
    return float(np.corrcoef(first.values.ravel(), second.values.ravel())[0, 1])


def _logarithm(values: xr.DataArray) -> xr.DataArray:
    """Return the natural logarithms."""
    return xr.apply_ufunc(np.log, values)


def ratios(values: xr.DataArray, against: xr.DataArray) -> xr.DataArray:
    """Return the ratios to another quantity."""
    return values / against


def ratio_sizes(values: xr.DataArray, against: xr.DataArray) -> xr.DataArray:
    """Return the sizes of the ratios to another quantity, whatever their sign."""
    return abs(values / against)


def rises(values: xr.DataArray, along: str) -> xr.DataArray:
    """Return the relative rise from the first to the last value of a dimension."""
    return values.isel({along: -1}) / values.isel({along: 0}) - 1


def rise_gains(values: xr.DataArray, along: str, across: str) -> xr.DataArray:
    """Return the difference of the relative rise between the last and the first value of another dimension."""
    each = rises(values, along)
    return each.isel({across: -1}) - each.isel({across: 0})


def slopes(values: xr.DataArray, against: xr.DataArray, along: str) -> xr.DataArray:
    """Return the slopes of the lines through the logarithms along a dimension."""
    x = _logarithm(against) - _logarithm(against).mean(along, skipna=False)
    return (x * _logarithm(values)).sum(along, skipna=False) / (x**2).sum(along, skipna=False)


def departure_of_curves(values: xr.DataArray, reference: xr.DataArray) -> xr.DataArray:
    """Return the difference of curves from others over the largest value of each of these, along the curve."""
    return (values - reference) / reference.max(CURVE_DIMENSION, skipna=False)


def _with_zero(values: xr.DataArray, along: str) -> xr.DataArray:
    """Return the values, and zeros as one more along a dimension, which loses its coordinates."""
    zeros = xr.zeros_like(values.isel({along: [0]}))
    return xr.concat([values.drop_vars(along, errors="ignore"), zeros.drop_vars(along, errors="ignore")], along)


def ranges(values: xr.DataArray, ends: Places, along: str) -> xr.DataArray:
    """Return the difference between two places along a dimension over |mean|; ends: as `ends_of_range` gives them."""
    return differences(values, ends, along) / abs(values.mean(along, skipna=False))


def differences(values: xr.DataArray, ends: Places, along: str) -> xr.DataArray:
    """Return the difference between two places along a dimension.

    ends: as `ends_of_range` gives them, with all other dimensions of the values
    """
    axis, others = values.get_axis_num(along), [dim for dim in values.dims if dim != along]
    low, high = (
        np.take_along_axis(values.values, np.expand_dims(end.transpose(*others).values, axis), axis).squeeze(axis)
        for end in ends
    )
    places = {dim: values[dim] for dim in others if dim in values.coords}
    return xr.DataArray(high - low, places, dims=others)


def ends_of_range(values: xr.DataArray, along: str) -> Places:
    """Return the places of the smallest and of the largest value along a dimension."""
    return values.argmin(along, skipna=False), values.argmax(along, skipna=False)


def place_of_largest(values: xr.DataArray) -> Places:
    """Return the place of the largest value."""
    return values.argmax(dims, skipna=False) if (dims := _all_but_splits(values)) else {}


def place_of_largest_spread(values: xr.DataArray, along: str) -> Places:
    """Return the ends of all ranges along a dimension, and the place of the largest range."""
    ends = ends_of_range(values, along)
    return ends, place_of_largest(ranges(values, ends, along))


def place_of_largest_difference(values: xr.DataArray, along: str) -> Places:
    """Return the ends of all ranges along a dimension, zero counted, and the place of the largest range."""
    values = _with_zero(values, along)
    ends = ends_of_range(values, along)
    return ends, place_of_largest(differences(values, ends, along))


def place_of_departure(values: xr.DataArray, against: xr.DataArray) -> Places:
    """Return the place of the largest departure, and its sign."""
    departures = values / against - 1
    place = place_of_largest(abs(departures))
    return place, np.sign(number_of(departures.isel(place)))
