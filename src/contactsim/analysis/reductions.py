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

import xarray as xr

from contactsim.analysis import measures
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
    """

    measure: Callable[..., float]
    locate: Callable[..., Places] | None = None
    neutral: float | None = None
    against_first: bool = False
    compares_ends: bool = False

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


REDUCTIONS: dict[str, Reduction] = {
    "mean": Reduction(measures.mean),
    "trend": Reduction(measures.trend, neutral=0.0),
    "spread": Reduction(measures.spread, measures.ends_of_range, neutral=0.0),
    "largest_spread": Reduction(measures.largest_spread, measures.place_of_largest_spread, neutral=0.0),
    "spread_ratio": Reduction(
        measures.spread_ratio,
        lambda values, against, along: (measures.ends_of_range(values, along), measures.ends_of_range(against, along)),
        neutral=0.0,
    ),
    "slope": Reduction(measures.slope),
    "largest_slope": Reduction(
        measures.largest_slope,
        lambda values, against, along: measures.place_of_largest(measures.slopes(values, against, along)),
    ),
    "origin_slope": Reduction(measures.origin_slope),
    "fall": Reduction(measures.fall, neutral=0.0, compares_ends=True),
    "rise": Reduction(measures.rise, neutral=0.0, compares_ends=True),
    "least_rise": Reduction(
        measures.least_rise,
        lambda values, along: measures.place_of_largest(-measures.rises(values, along)),
        neutral=0.0,
        compares_ends=True,
    ),
    "largest_rise": Reduction(
        measures.largest_rise,
        lambda values, along: measures.place_of_largest(measures.rises(values, along)),
        neutral=0.0,
        compares_ends=True,
    ),
    "rise_gain": Reduction(measures.rise_gain, neutral=0.0, compares_ends=True),
    "least_rise_gain": Reduction(
        measures.least_rise_gain,
        lambda values, along, across: measures.place_of_largest(-measures.rise_gains(values, along, across)),
        neutral=0.0,
        compares_ends=True,
    ),
    "largest_rise_gain": Reduction(
        measures.largest_rise_gain,
        lambda values, along, across: measures.place_of_largest(measures.rise_gains(values, along, across)),
        neutral=0.0,
        compares_ends=True,
    ),
    "shortfall": Reduction(measures.shortfall, neutral=0.0, compares_ends=True),
    "departure": Reduction(measures.departure, measures.place_of_departure, neutral=0.0),
    "ratio": Reduction(
        measures.ratio, lambda values, against: measures.place_of_largest(values / against), neutral=0.0
    ),
    "ratio_size": Reduction(
        measures.ratio_size, lambda values, against: measures.place_of_largest(abs(values / against)), neutral=0.0
    ),
    "least": Reduction(measures.least, lambda values: measures.place_of_largest(-values)),
    "largest": Reduction(measures.largest, measures.place_of_largest),
    "furthest_from_one": Reduction(
        measures.furthest_from_one, lambda values: measures.place_of_largest(abs(values - 1)), neutral=1.0
    ),
    "correlation": Reduction(measures.correlation, neutral=1.0, against_first=True),
    "largest_size": Reduction(
        measures.largest_size, lambda values: measures.place_of_largest(abs(values)), neutral=0.0
    ),
}
"""Reductions to one number, by the name that claims give them."""
ORDERS: dict[str, Callable[[xr.DataArray, str], xr.DataArray]] = {
    "rising_steps": measures.rising_steps,
    "falling_steps": measures.falling_steps,
    "steps_from_one": measures.steps_from_one,
    "steps_to_one": measures.steps_to_one,
}
"""Reductions to the steps of an ordered quantity, `along` a dimension; each step has its own error."""


def reduction_inputs(name: str) -> list[str]:
    """Return what a reduction needs beside the quantity: some of `against`, `along` and `across`."""
    return ["along"] if name in ORDERS else REDUCTIONS[name].inputs
