"""Reduce the quantities of a dataset to single numbers.

A reduction is a function of one quantity. Its further parameters `against` (another quantity), `along` and `across`
(dimensions) say what else it needs. A value that is unknown makes the number unknown. A reduction to an extreme first
locates it, so that its place and its value can come from different members (`contactsim.analysis.cross_validation`).
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import xarray as xr

from contactsim.analysis import measures, order_steps
from contactsim.analysis.measures import Places


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
    compares_ends
        True if it compares the two ends of a dimension, so that a part of the dimension says something else.
    values_of
        Function of the quantity and its inputs that gives the values at all places, of which the number is an extreme;
        None where there is no extreme.
    """

    measure: Callable[..., float]
    locate: Callable[..., Places] | None = None
    neutral: float | None = None
    against_first: bool = False
    compares_ends: bool = False
    values_of: Callable[..., xr.DataArray] | None = None

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


def largest_of(values_of: Callable[..., xr.DataArray], sign: float = 1.0, **attributes: Any) -> Reduction:
    """Return the reduction to the largest of the values that a function gives; with sign -1 to the smallest.

    Parameters
    ----------
    values_of
        Function of the quantity and of `against`, `along` and `across` as far as it needs them.
    sign
        1 or -1.
    attributes
        Further attributes of the reduction.
    """

    @functools.wraps(values_of)  # with its signature, which says what the reduction needs
    def measure(values: xr.DataArray, places: Places, **inputs: Any) -> float:
        """Return the value at a place."""
        return measures.number_of(values_of(values, **inputs).isel(places))

    def locate(values: xr.DataArray, **inputs: Any) -> Places:
        """Return the place of the extreme."""
        return measures.place_of_largest(sign * values_of(values, **inputs))

    return Reduction(measure, locate, values_of=values_of, **attributes)


REDUCTIONS: dict[str, Reduction] = {
    "mean": Reduction(measures.mean),
    "trend": Reduction(measures.trend, neutral=0.0),
    "spread": Reduction(measures.spread, measures.ends_of_range, neutral=0.0),
    "largest_spread": Reduction(measures.largest_spread, measures.place_of_largest_spread, neutral=0.0),
    "largest_difference": Reduction(measures.largest_difference, measures.place_of_largest_difference, neutral=0.0),
    "spread_ratio": Reduction(
        measures.spread_ratio,
        lambda values, against, along: (measures.ends_of_range(values, along), measures.ends_of_range(against, along)),
        neutral=0.0,
    ),
    "slope": Reduction(measures.slope),
    "largest_slope": largest_of(measures.slopes),
    "slope_furthest_from_one": Reduction(
        measures.slope_furthest_from_one,
        lambda values, against, along: measures.place_of_largest(abs(measures.slopes(values, against, along) - 1)),
        neutral=1.0,
    ),
    "origin_slope": Reduction(measures.origin_slope),
    "fall": Reduction(measures.fall, neutral=0.0, compares_ends=True),
    "rise": Reduction(measures.rise, neutral=0.0, compares_ends=True),
    "least_rise": largest_of(measures.rises, -1, neutral=0.0, compares_ends=True),
    "largest_rise": largest_of(measures.rises, neutral=0.0, compares_ends=True),
    "rise_gain": Reduction(measures.rise_gain, neutral=0.0, compares_ends=True),
    "least_rise_gain": largest_of(measures.rise_gains, -1, neutral=0.0, compares_ends=True),
    "largest_rise_gain": largest_of(measures.rise_gains, neutral=0.0, compares_ends=True),
    "shortfall": Reduction(measures.shortfall, neutral=0.0, compares_ends=True),
    "excess": Reduction(measures.excess, neutral=0.0, compares_ends=True),
    "departure": Reduction(measures.departure, measures.place_of_departure, neutral=0.0),
    "ratio": largest_of(measures.ratios, neutral=0.0),
    "ratio_size": largest_of(measures.ratio_sizes, neutral=0.0),
    "least": largest_of(measures.identity, -1),
    "largest": largest_of(measures.identity),
    "furthest_from_one": Reduction(
        measures.furthest_from_one, lambda values: measures.place_of_largest(abs(values - 1)), neutral=1.0
    ),
    "correlation": Reduction(measures.correlation, neutral=1.0, against_first=True),
    "largest_size": largest_of(measures.sizes, neutral=0.0),
}
"""Reductions to one number, by the name that claims give them."""
ORDERS: dict[str, Callable[[xr.DataArray, str], xr.DataArray]] = {
    "rising_steps": order_steps.rising_steps,
    "falling_steps": order_steps.falling_steps,
    "steps_from_one": order_steps.steps_from_one,
    "steps_to_one": order_steps.steps_to_one,
}
"""Reductions to the steps of an ordered quantity, `along` a dimension; each step has its own error."""


def reduction_inputs(name: str) -> list[str]:
    """Return what a reduction needs beside the quantity: some of `against`, `along` and `across`."""
    return ["along"] if name in ORDERS else REDUCTIONS[name].inputs
