"""Extrapolation and interpolation along a path, by Lagrange's polynomials of at most third order."""

from __future__ import annotations

import math
from collections.abc import Sequence

from contactsim.grid import Array

POINTS = 4
"""Largest number of states that a polynomial goes through."""
MAX_AMPLIFICATION = 16.0
"""Largest ratio of a prediction's error to those of the states; a cubic and equal increments have 15."""


def lagrange_weights(parameters: Sequence[float], parameter: float) -> list[float]:
    """Return the weight of each state in the polynomial through all of them, at a parameter.

    Parameters
    ----------
    parameters
        Load parameters of the states, all different.
    parameter
        Load parameter at which the polynomial is evaluated.
    """
    return [
        math.prod((parameter - other) / (own - other) for other in parameters if other != own) for own in parameters
    ]


def interpolate(parameters: Sequence[float], states: Sequence[Array], parameter: float) -> Array:
    """Return the polynomial through the states at a parameter; arguments as of `lagrange_weights`."""
    return combine(lagrange_weights(parameters, parameter), states)


def combine(weights: Sequence[float], states: Sequence[Array]) -> Array:
    """Return the sum of the states, each with its weight."""
    values = weights[0] * states[0]
    for weight, state in zip(weights[1:], states[1:], strict=True):
        values += weight * state
    return values


class History:
    """The last few states of one smooth segment of a path, with their load parameters.

    Parameters
    ----------
    max_amplification
        Largest ratio of a prediction's error to those of the states.
    """

    def __init__(self, max_amplification: float = MAX_AMPLIFICATION) -> None:
        self.max_amplification = max_amplification
        self.parameters: list[float] = []
        self.states: list[Array] = []

    def add(self, parameter: float, state: Array) -> None:
        """Append a state and drop the oldest; where the path turns, keep only the state at the turn."""
        parameters = self.parameters
        turned = len(parameters) > 1 and (parameter - parameters[-1]) * (parameters[-1] - parameters[-2]) < 0
        if turned:
            self.parameters, self.states = self.parameters[-1:], self.states[-1:]
        if self.parameters and parameter == self.parameters[-1]:
            self.parameters, self.states = self.parameters[:-1], self.states[:-1]
        self.parameters = [*self.parameters, parameter][-POINTS:]
        self.states = [*self.states, state][-POINTS:]

    def restart(self, parameter: float, state: Array) -> None:
        """Drop all states before this one."""
        self.parameters, self.states = [parameter], [state]

    def turns_at(self, parameter: float) -> bool:
        """Return True if only the last state predicts the one at a parameter: it is the only one, or the path turns."""
        parameters = self.parameters
        return not self.order or (parameter - parameters[-1]) * (parameters[-1] - parameters[-2]) <= 0

    def extrapolate(self, parameter: float) -> Array:
        """Return the expected state at a parameter; where the path turns, the last state."""
        if self.turns_at(parameter):
            return self.states[-1]
        count = self.order_at(parameter) + 1
        return interpolate(self.parameters[-count:], self.states[-count:], parameter)

    def order_at(self, parameter: float) -> int:
        """Return the order of the polynomial that predicts the state at a parameter.

        It is the highest that does not amplify the errors of the states too much. Close states predict one far ahead
        badly: a cubic through four states 1 apart amplifies their errors 13 000-fold at a distance of 20.
        """
        for count in range(len(self.parameters), 2, -1):
            if sum(map(abs, lagrange_weights(self.parameters[-count:], parameter))) <= self.max_amplification:
                return count - 1
        return min(self.order, 1)

    @property
    def order(self) -> int:
        """Highest order of a polynomial through the states."""
        return len(self.parameters) - 1
