"""Lengths of increments by the error of the predictions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

SAFETY, MIN_FACTOR, MAX_FACTOR = 0.9, 0.4, 2.0
"""Share of the increment that the error allows, and smallest and largest factor between two increments."""
ROUNDING = 1e-6
"""Part of an increment below which two parameters are the same."""
REJECTION = 4.0
"""Ratio of the error of a prediction to the allowed error beyond which an increment is rejected."""


@dataclass
class IncrementController:
    """Control of the increments of a path by the error of the predictions.

    Attributes
    ----------
    error
        Allowed error of a prediction, nm.
    smallest, largest
        Bounds of the increment, nm or GPa.
    increment
        Length of the next increment, nm or GPa.
    """

    error: float
    smallest: float
    largest: float
    increment: float

    def propose(self, parameter: float, end: float) -> float:
        """Return the next parameter towards the end; the last two increments are equal, to interpolate well."""
        distance = end - parameter
        if abs(distance) <= self.increment * (1 + ROUNDING):
            return end
        return parameter + math.copysign(min(self.increment, abs(distance) / 2), distance)

    def rejects(self, error: float) -> bool:
        """Return True if a prediction with that error (nm) asks for a shorter increment, and there is one."""
        return not error <= REJECTION * self.error and self.can_shrink

    @property
    def can_shrink(self) -> bool:
        """True where there is a shorter increment."""
        return self.increment > self.smallest

    def shrink(self) -> None:
        """Shorten the increment after a rejection."""
        self.increment = max(self.increment * MIN_FACTOR, self.smallest)

    def accept(self, error: float, order: int, flowed: bool) -> None:
        """Adapt the increment after a prediction of that error (nm) and polynomial order, or after a flow."""
        unknown = flowed or not 0 < error < np.inf
        factor = MAX_FACTOR if unknown else SAFETY * (self.error / error) ** (1 / (order + 1))
        increment = self.increment * np.clip(factor, MIN_FACTOR, MAX_FACTOR)
        self.increment = float(np.clip(increment, self.smallest, self.largest))
