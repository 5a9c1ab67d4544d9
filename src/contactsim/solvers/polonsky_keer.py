"""Polonsky and Keer's constrained conjugate gradients: the method most contact codes use, as a baseline.

Wear 231, 206 (1999), doi:10.1016/S0043-1648(99)00113-1. Pressure is moved along conjugate directions of the gap on the
current contact, clipped at zero and rescaled to the load; points that overlap outside the contact are given pressure,
which restarts the directions. Four transforms an iteration.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.grid import Array
from contactsim.scene import WallProblem
from contactsim.solvers.base import State
from contactsim.traits import Trait


@dataclass(frozen=True)
class PolonskyKeerState(State):
    """Pressure (n,), last direction (n,), the last squared gap, and whether the set of points has grown."""

    direction: Array
    square: float
    grown: bool


@dataclass
class PolonskyKeer:
    """One outer step is a batch of iterations, ended early when the gap is uniform enough."""

    batch: int = 25
    budget: int = 400
    accepts = frozenset({Trait.LINE, Trait.WALL, Trait.HALF_SPACE, Trait.MEAN_PRESSURE})

    def start(self, problem: WallProblem, guess: Array | None = None) -> PolonskyKeerState:
        """From a guess or uniform pressure."""
        pressure = np.full_like(problem.heights, problem.load) if guess is None else problem.admissible(guess)
        return PolonskyKeerState(pressure, False, np.zeros_like(pressure), 1.0, True)

    def step(self, problem: WallProblem, state: PolonskyKeerState) -> PolonskyKeerState:
        """At most `batch` iterations."""
        for _ in range(self.batch):
            state = self._iteration(problem, state)
            if state.done:
                break
        return state

    @staticmethod
    def _iteration(problem: WallProblem, state: PolonskyKeerState) -> PolonskyKeerState:
        pressure = state.pressure
        contact = pressure > 0
        gap = problem.compliance(pressure) - problem.heights
        gap -= gap[contact].mean()
        worst = max(np.max(np.abs(gap[contact])), -gap.min())
        square = float(gap[contact] @ gap[contact])
        if worst <= problem.tolerance or square == 0:
            return PolonskyKeerState(pressure, True, state.direction, square, False)
        factor = 0.0 if state.grown else square / state.square
        direction = np.where(contact, gap + factor * state.direction, 0.0)
        moved = problem.compliance(direction)
        moved -= moved[contact].mean()
        curvature = float(moved @ direction)
        length = float(gap[contact] @ direction[contact]) / curvature if curvature > 0 else 0.0
        pressure = np.maximum(pressure - length * direction, 0.0)
        overlapping = (pressure == 0) & (gap < 0)
        pressure[overlapping] -= length * gap[overlapping]
        return PolonskyKeerState(problem.admissible(pressure), False, direction, square, bool(overlapping.any()))
