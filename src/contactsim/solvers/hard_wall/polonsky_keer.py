"""Constrained conjugate gradients of Polonsky and Keer, the method of most contact codes, as a baseline.

Wear 231, 206 (1999), doi:10.1016/S0043-1648(99)00113-1. The pressure moves along conjugate directions of the gap on the
current contact, is cut at zero and scaled to the load. Points that overlap outside the contact get pressure, which
restarts the directions. An iteration takes four transforms.
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
    """Pressure and last direction (n,) or (ny, nx), last squared gap, and whether the last step added points."""

    direction: Array
    square: float
    grown: bool


@dataclass(frozen=True)
class PolonskyKeer:
    """Constrained conjugate gradients; one outer step is a batch of iterations.

    Parameters
    ----------
    batch
        Largest number of iterations in an outer step, which ends early once the gap is uniform within the tolerance.
    budget
        Largest number of outer steps.
    """

    batch: int = 25
    budget: int = 400
    fields = 15
    accepts = frozenset(
        {*(Trait.LINE, Trait.SURFACE, Trait.WALL, Trait.HALF_SPACE, Trait.FREE, Trait.LAYER, Trait.MEAN_PRESSURE)}
    )

    def transforms(self, points: int) -> float:
        """Return the real transforms of an iteration."""
        return 4.0

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> PolonskyKeerState:
        """Return the first state: a guess, or uniform pressure."""
        problem.compliance.hold_symbol()
        pressure = np.full(problem.shape, problem.load) if guess is None else problem.project(guess)
        return PolonskyKeerState(pressure, False, np.zeros_like(pressure), 1.0, True)

    def step(self, problem: HardWallProblem, state: PolonskyKeerState) -> PolonskyKeerState:
        """Return the state after at most `batch` iterations."""
        for _ in range(self.batch):
            state = self._iteration(problem, state)
            if state.done:
                break
        return state

    @staticmethod
    def _iteration(problem: HardWallProblem, state: PolonskyKeerState) -> PolonskyKeerState:
        """Return the state after one iteration."""
        pressure = state.pressure
        active = pressure > 0
        gap = problem.compliance(pressure) - problem.heights
        gap -= gap[active].mean()
        uneven, overlap = np.max(np.abs(gap[active])), -gap.min()
        if max(uneven, overlap) <= problem.tolerance:
            return PolonskyKeerState(pressure, True, state.direction, 1.0, False)
        balanced = uneven <= 1e-3 * problem.tolerance  # no direction to follow, as when one point carries the load
        if balanced:
            active |= gap < 0
        square = float(gap[active] @ gap[active])
        factor = 0.0 if state.grown or balanced else square / state.square
        direction = np.where(active, gap + factor * state.direction, 0.0)
        change = problem.compliance(direction)
        change -= change[active].mean()
        curvature = float(np.vdot(change, direction))
        length = float(gap[active] @ direction[active]) / curvature if curvature > 0 else 0.0
        pressure = np.maximum(pressure - length * direction, 0.0)
        overlapping = (pressure == 0) & (gap < 0)
        pressure[overlapping] -= length * gap[overlapping]
        grown = balanced or bool(overlapping.any())
        return PolonskyKeerState(problem.project(pressure), False, direction, square, grown)
