"""Polonsky and Keer's constrained conjugate gradients: the method most contact codes use, as a baseline.

Wear 231, 206 (1999), doi:10.1016/S0043-1648(99)00113-1. Pressure is moved along conjugate directions of the gap on the
current contact, clipped at zero and rescaled to the load; points that overlap outside the contact are given pressure,
which restarts the directions. Four transforms an iteration.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.grid import Array
from contactsim.solvers.base import State
from contactsim.traits import Trait


@dataclass(frozen=True)
class PolonskyKeerState(State):
    """Pressure and last direction, (n,) or (ny, nx), the last squared gap, and whether the set of points has grown."""

    direction: Array
    square: float
    grown: bool


@dataclass(frozen=True)
class PolonskyKeer:
    """One outer step is a batch of iterations, ended early when the gap is uniform enough."""

    batch: int = 25
    budget: int = 400
    fields = 15
    accepts = frozenset({Trait.LINE, Trait.SURFACE, Trait.WALL, Trait.HALF_SPACE, Trait.LAYER, Trait.MEAN_PRESSURE})

    def transforms(self, points: int) -> float:
        """Real transforms of an iteration on a grid of that size."""
        return 4.0

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> PolonskyKeerState:
        """From a guess or uniform pressure."""
        pressure = np.full_like(problem.heights, problem.load) if guess is None else problem.project(guess)
        return PolonskyKeerState(pressure, False, np.zeros_like(pressure), 1.0, True)

    def step(self, problem: HardWallProblem, state: PolonskyKeerState) -> PolonskyKeerState:
        """At most `batch` iterations."""
        for _ in range(self.batch):
            state = self._iteration(problem, state)
            if state.done:
                break
        return state

    @staticmethod
    def _iteration(problem: HardWallProblem, state: PolonskyKeerState) -> PolonskyKeerState:
        pressure = state.pressure
        active = pressure > 0
        gap = problem.compliance(pressure) - problem.heights
        gap -= gap[active].mean()
        uneven, overlap = np.max(np.abs(gap[active])), -gap.min()
        if max(uneven, overlap) <= problem.tolerance:
            return PolonskyKeerState(pressure, True, state.direction, 1.0, False)
        settled = uneven <= 1e-3 * problem.tolerance  # no direction to follow, as when one point carries the load
        if settled:
            active |= gap < 0
        square = float(gap[active] @ gap[active])
        factor = 0.0 if state.grown or settled else square / state.square
        direction = np.where(active, gap + factor * state.direction, 0.0)
        moved = problem.compliance(direction)
        moved -= moved[active].mean()
        curvature = float(np.vdot(moved, direction))
        length = float(gap[active] @ direction[active]) / curvature if curvature > 0 else 0.0
        pressure = np.maximum(pressure - length * direction, 0.0)
        overlapping = (pressure == 0) & (gap < 0)
        pressure[overlapping] -= length * gap[overlapping]
        grown = settled or bool(overlapping.any())
        return PolonskyKeerState(problem.project(pressure), False, direction, square, grown)
