"""Extrapolation and interpolation along a path, by Lagrange's polynomials of at most third order."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contactsim.grid import Array

POINTS = 4
"""Largest number of states that a polynomial goes through."""


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
    values = np.zeros_like(states[0])
    for weight, state in zip(lagrange_weights(parameters, parameter), states, strict=True):
        values += weight * state
    return values


class History:
    """The last few states of one smooth segment of a path, with their load parameters."""

    def __init__(self) -> None:
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
        return interpolate(self.parameters, self.states, parameter)

    @property
    def order(self) -> int:
        """Order of the polynomial that predicts a state."""
        return len(self.parameters) - 1
