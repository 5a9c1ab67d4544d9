"""Reduce the quantities of a dataset to single numbers.

A reduction is a function of one quantity. Its further parameters `against` (another quantity), `along` and `across`
(dimensions) say what else it needs. A value that is unknown makes the number unknown. A reduction to an extreme first
locates it, so that its place and its value can come from different members (`contactsim.analysis.cross_validation`).
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from contactsim.variables import LOADS

Places = Any
"""Places of extremes, as `DataArray.isel` takes them."""


@dataclass(frozen=True)
class Reduction:
    """A reduction of a quantity to one number.

    Attributes
    ----------
    measure
        Function of the quantity, of `against`, `along` and `across` as far as it needs them, and, for an extreme, of
        its `places`.
    locate
        Function of the same without `places` that returns these; None where there is no extreme.
    neutral
        Value where nothing varies or differs; None where the reduction has none.
    against_first
        True if `against` is that of the first of two studies, not their ratio or difference.
    """

    measure: Callable[..., float]
    locate: Callable[..., Places] | None = None
    neutral: float | None = None
    against_first: bool = False

    @property
    def inputs(self) -> list[str]:
        """Inputs that it needs beside the quantity: some of `against`, `along` and `across`."""
        return [name for name in inspect.signature(self.measure).parameters if name not in ("values", "places")]

    def __call__(self, values: xr.DataArray, **inputs: Any) -> float:
        """Return the number, with places and values from the same data."""
        return self.measure_at(self.places(values, **inputs), values, **inputs)

    def places(self, values: xr.DataArray, **inputs: Any) -> Places:
        """Return the places of the extremes; None without extremes."""
        return None if self.locate is None else self.locate(values, **inputs)

    def measure_at(self, places: Places, values: xr.DataArray, **inputs: Any) -> float:
        """Return the number, with the extremes at given places."""
        return self.measure(values, **inputs) if self.locate is None else self.measure(values, places, **inputs)


def mean(values: xr.DataArray) -> float:
    """Return the mean over all points."""
    return float(values.mean(skipna=False))


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
    return mean(_rises(values, along))


def fall(values: xr.DataArray, along: str) -> float:
    """Return the relative fall from the first to the last value of a dimension, averaged over the others."""
    return mean(-_rises(values, along))


def rise_gain(values: xr.DataArray, along: str, across: str) -> float:
    """Return the mean difference of the relative rise between the last and the first value of another dimension."""
    rises = _rises(values, along)
    return mean(rises.isel({across: -1}) - rises.isel({across: 0}))


def shortfall(values: xr.DataArray, along: str) -> float:
    """Return the part by which the first value of a dimension is below the last, averaged over the others."""
    return mean(1 - values.isel({along: 0}) / values.isel({along: -1}))


def slope(values: xr.DataArray, against: xr.DataArray, along: str) -> float:
    """Return the slope of the line through the logarithms along a dimension, averaged over the others."""
    x = _logarithm(against) - _logarithm(against).mean(along, skipna=False)
    return mean((x * _logarithm(values)).sum(along, skipna=False) / (x**2).sum(along, skipna=False))


def origin_slope(values: xr.DataArray, against: xr.DataArray, along: str) -> float:
    """Return the slope of the line of least squares through the origin along a dimension, averaged over the others."""
    return mean((against * values).sum(along, skipna=False) / (against**2).sum(along, skipna=False))


def spread(values: xr.DataArray, places: Places, along: str) -> float:
    """Return (largest − smallest)/|mean| along a dimension, averaged over the others."""
    return mean(_ranges(values, places, along))


def largest_spread(values: xr.DataArray, places: Places, along: str) -> float:
    """Return (largest − smallest)/|mean| along a dimension, the largest over the others."""
    ends, place = places
    return float(_ranges(values, ends, along).isel(place))


def spread_ratio(values: xr.DataArray, places: Places, against: xr.DataArray, along: str) -> float:
    """Return the spread of a quantity over the spread of another."""
    return spread(values, places[0], along) / spread(against, places[1], along)


def least(values: xr.DataArray, places: Places) -> float:
    """Return the smallest of all points."""
    return float(values.isel(places))


def largest(values: xr.DataArray, places: Places) -> float:
    """Return the largest of all points."""
    return float(values.isel(places))


def least_rise(values: xr.DataArray, places: Places, along: str) -> float:
    """Return the relative rise from the first to the last value of a dimension, the smallest over the others."""
    return float(_rises(values, along).isel(places))


def largest_rise(values: xr.DataArray, places: Places, along: str) -> float:
    """Return the relative rise from the first to the last value of a dimension, the largest over the others."""
    return float(_rises(values, along).isel(places))


def departure(values: xr.DataArray, places: Places, against: xr.DataArray) -> float:
    """Return the largest relative departure from another quantity."""
    place, sign = places
    return sign * float((values / against - 1).isel(place))


def ratio(values: xr.DataArray, places: Places, against: xr.DataArray) -> float:
    """Return the largest ratio to another quantity."""
    return float((values / against).isel(places))


def furthest_from_one(values: xr.DataArray, places: Places) -> float:
    """Return the value that is furthest from one, such as the ratio of two studies that are said to agree."""
    return float(values.isel(places))


def correlation(values: xr.DataArray, against: xr.DataArray) -> float:
    """Return the correlation with another quantity over all points."""
    first, second = xr.broadcast(values, against)
    return float(np.corrcoef(first.values.ravel(), second.values.ravel())[0, 1])


def largest_size(values: xr.DataArray, places: Places) -> float:
    """Return the largest size of all points, whatever their sign."""
    return float(abs(values).isel(places))


def ratio_size(values: xr.DataArray, places: Places, against: xr.DataArray) -> float:
    """Return the largest size of the ratio to another quantity, whatever its sign."""
    return float(abs(values / against).isel(places))


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


def _logarithm(values: xr.DataArray) -> xr.DataArray:
    """Return the natural logarithms."""
    return xr.apply_ufunc(np.log, values)


def _rises(values: xr.DataArray, along: str) -> xr.DataArray:
    """Return the relative rise from the first to the last value of a dimension."""
    return values.isel({along: -1}) / values.isel({along: 0}) - 1


def _ranges(values: xr.DataArray, ends: Places, along: str) -> xr.DataArray:
    """Return the difference between two places along a dimension over |mean|."""
    low, high = ends
    difference = values.isel({along: high}, drop=True) - values.isel({along: low}, drop=True)
    return difference / abs(values.mean(along, skipna=False))


def _ends(values: xr.DataArray, along: str) -> Places:
    """Return the places of the smallest and of the largest value along a dimension."""
    return values.argmin(along, skipna=False), values.argmax(along, skipna=False)


def _place_of_largest(values: xr.DataArray) -> Places:
    """Return the place of the largest value."""
    return values.argmax(..., skipna=False) if values.ndim else {}


def _place_of_largest_spread(values: xr.DataArray, along: str) -> Places:
    """Return the ends of all ranges along a dimension, and the place of the largest range."""
    ends = _ends(values, along)
    return ends, _place_of_largest(_ranges(values, ends, along))


def _place_of_departure(values: xr.DataArray, against: xr.DataArray) -> Places:
    """Return the place of the largest departure, and its sign."""
    departures = values / against - 1
    place = _place_of_largest(abs(departures))
    return place, float(np.sign(departures.isel(place)))


REDUCTIONS: dict[str, Reduction] = {
    "mean": Reduction(mean),
    "trend": Reduction(trend, neutral=0.0),
    "spread": Reduction(spread, _ends, neutral=0.0),
    "largest_spread": Reduction(largest_spread, _place_of_largest_spread, neutral=0.0),
    "spread_ratio": Reduction(
        spread_ratio, lambda values, against, along: (_ends(values, along), _ends(against, along)), neutral=0.0
    ),
    "slope": Reduction(slope),
    "origin_slope": Reduction(origin_slope),
    "fall": Reduction(fall, neutral=0.0),
    "rise": Reduction(rise, neutral=0.0),
    "least_rise": Reduction(least_rise, lambda values, along: _place_of_largest(-_rises(values, along)), neutral=0.0),
    "largest_rise": Reduction(
        largest_rise, lambda values, along: _place_of_largest(_rises(values, along)), neutral=0.0
    ),
    "rise_gain": Reduction(rise_gain, neutral=0.0),
    "shortfall": Reduction(shortfall, neutral=0.0),
    "departure": Reduction(departure, _place_of_departure, neutral=0.0),
    "ratio": Reduction(ratio, lambda values, against: _place_of_largest(values / against), neutral=0.0),
    "ratio_size": Reduction(ratio_size, lambda values, against: _place_of_largest(abs(values / against)), neutral=0.0),
    "least": Reduction(least, lambda values: _place_of_largest(-values)),
    "largest": Reduction(largest, _place_of_largest),
    "furthest_from_one": Reduction(furthest_from_one, lambda values: _place_of_largest(abs(values - 1)), neutral=1.0),
    "correlation": Reduction(correlation, neutral=1.0, against_first=True),
    "largest_size": Reduction(largest_size, lambda values: _place_of_largest(abs(values)), neutral=0.0),
}
"""Reductions to one number, by the name that claims give them."""
ORDERS: dict[str, Callable[[xr.DataArray, str], xr.DataArray]] = {
    "rising_steps": rising_steps,
    "falling_steps": falling_steps,
    "steps_from_one": steps_from_one,
    "steps_to_one": steps_to_one,
}
"""Reductions to the steps of an ordered quantity, `along` a dimension; each step has its own error."""


def reduction_inputs(name: str) -> list[str]:
    """Return what a reduction needs beside the quantity: some of `against`, `along` and `across`."""
    return ["along"] if name in ORDERS else REDUCTIONS[name].inputs
