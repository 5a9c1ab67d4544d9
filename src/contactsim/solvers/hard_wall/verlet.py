"""Damped Verlet dynamics of the surface, the scheme of the thesis (Eqs 2.4–2.7), as a baseline.

With unit mass on every node the position-Verlet update is u⁺ = 2u - u⁻ + δt² F - d (u - u⁻), where F is the elastic
restoring force plus the applied pressure and d = ηδt²; the sign of the damping as printed in Eq. 2.5 would feed energy
in. The surface is cut at the indenter, which is correct only for equal masses: with masses that depend on the
wavevector, the cut does not commute with 1/m and the contact set is wrong, so there are none. The pressure is the force
with which the wall holds the cut nodes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.elasticity.fourier_operator import FourierOperator
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.solvers.base import State
from contactsim.traits import Trait


@dataclass(frozen=True)
class VerletState(State):
    """Pressure (n,), the surface's present and previous positions (n,), in grid steps, and its stiffness."""

    surface: Array
    previous: Array
    stiffness: FourierOperator


@dataclass(frozen=True)
class HardWallVerlet:
    """Damped Verlet dynamics; one outer step is a batch of time steps.

    Parameters
    ----------
    time_step
        δt over the stability limit 2/√K_max of the undamped scheme, below 1.
    damping
        Over the critical damping of the softest wave (on a half-space the longest), which comes to rest fastest at 1.
    batch
        Time steps in an outer step.
    budget
        Largest number of outer steps.
    """

    time_step: float = 0.7
    damping: float = 1.0
    batch: int = 100
    budget: int = 2000
    fields = 15
    accepts = frozenset({Trait.LINE, Trait.WALL, Trait.HALF_SPACE, Trait.LAYER, Trait.MEAN_PRESSURE})

    def __post_init__(self) -> None:
        if not 0 < self.time_step < 1:
            raise InputError("time_step", self.time_step, "above 0 and below 1, the stability limit")
        if not self.damping > 0:
            raise InputError("damping", self.damping, "a positive number")

    def transforms(self, points: int) -> float:
        """Return the real transforms of a time step."""
        return 2.0

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> VerletState:
        """Return the first state, at rest: undeformed with the highest point just touching, or deformed by a guess."""
        symbol = np.zeros_like(problem.compliance.symbol)
        symbol[1:] = 1 / problem.compliance.symbol[1:]
        stiffness = FourierOperator(problem.compliance.grid, symbol, problem.counter)
        surface = np.zeros_like(problem.heights)
        if guess is not None:
            surface = problem.compliance(guess)
            surface += np.max(problem.heights - surface)
        return VerletState(np.full_like(surface, problem.load), False, surface, surface, stiffness)

    def step(self, problem: HardWallProblem, state: VerletState) -> VerletState:
        """Return the state after a batch of time steps; its pressure is the reaction of the wall."""
        stiffness, load = state.stiffness, problem.prescribed_load
        square = 4 * self.time_step**2 / stiffness.symbol.max()
        friction = min(2 * self.damping * np.sqrt(stiffness.symbol[1:].min() * square), 1.0)
        surface, previous = state.surface, state.previous
        for _ in range(self.batch):
            force = -load - stiffness(surface)
            moved = surface + (1 - friction) * (surface - previous) + square * force
            surface, previous = np.maximum(moved, problem.heights), surface
        reaction = load + stiffness(surface)
        contact = surface <= problem.heights
        pressure = np.where(contact, reaction, 0.0)
        return VerletState(pressure, bool(contact.any()), surface, previous, stiffness)
