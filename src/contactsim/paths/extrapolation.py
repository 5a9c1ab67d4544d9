"""Extrapolation and interpolation along a path of states, by Lagrange's polynomials of at most third order."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contactsim.grid import Array

POINTS = 4
"""Most states that a polynomial goes through."""


def shares(places: Sequence[float], place: float) -> list[float]:
    """How much each of the states at `places`, all different, counts in the polynomial through them at `place`."""
    return [math.prod((place - other) / (own - other) for other in places if other != own) for own in places]


def lagrange(places: Sequence[float], states: Sequence[Array], place: float) -> Array:
    """The polynomial through (place, state) pairs, evaluated at `place`; places differ from each other."""
    out = np.zeros_like(states[0])
    for share, state in zip(shares(places, place), states, strict=True):
        out += share * state
    return out


class History:
    """The last few states of one smooth stretch of a path."""

    def __init__(self) -> None:
        self.places: list[float] = []
        self.states: list[Array] = []

    def add(self, place: float, state: Array) -> None:
        """Remember a state, forgetting the oldest; a turn of the path begins anew from its last state."""
        turned = len(self.places) > 1 and (place - self.places[-1]) * (self.places[-1] - self.places[-2]) < 0
        if turned:
            self.places, self.states = self.places[-1:], self.states[-1:]
        if self.places and place == self.places[-1]:
            self.places, self.states = self.places[:-1], self.states[:-1]
        self.places = [*self.places, place][-POINTS:]
        self.states = [*self.states, state][-POINTS:]

    def restart(self, place: float, state: Array) -> None:
        """Forget all states before this one."""
        self.places, self.states = [place], [state]

    def holds(self, place: float) -> bool:
        """Whether no more than the last state is known about a place: it alone, or the path turns there."""
        return not self.order or (place - self.places[-1]) * (self.places[-1] - self.places[-2]) <= 0

    def guess(self, place: float) -> Array:
        """The state to be expected at a place; on a turn of the path, the last state."""
        if self.holds(place):
            return self.states[-1]
        return lagrange(self.places, self.states, place)

    @property
    def order(self) -> int:
        """Order of the polynomial behind a guess."""
        return len(self.places) - 1
