"""The protocol of cohesive solvers, the equilibrium that they return, and its status."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from contactsim.grid import Array
from contactsim.solvers.base import Solver
from contactsim.status import Status
from contactsim.traits import Trait

if TYPE_CHECKING:
    from contactsim.contact.cohesive import CohesiveProblem

CONTROLS = {Trait.APPROACH, Trait.MEAN_PRESSURE, Trait.SLIDE}
SMOOTH_PATHS = frozenset(
    {Trait.LINE, Trait.SURFACE, Trait.SMOOTH, Trait.HALF_SPACE, Trait.FREE, Trait.LAYER, *CONTROLS}
)
"""Traits that each of these solvers accepts. One that minimises no energy also accepts laws without a potential."""
SEPARATION = 40.0
"""Smallest gap, over the interaction range of the laws, beyond which a load has pulled the bodies apart; overlap beyond
which it may have pressed them through each other."""
LOST_REPULSION = 10.0
"""Repulsion that surfaces would exert had they not slipped, over the load, above which slip has taken it from them."""


@dataclass(frozen=True)
class Equilibrium:
    """A state of the interface, and how good it is.

    Parameters
    ----------
    displacement
        Coefficients (exerted, m), nm.
    gap, traction
        Gap (read, n), nm, and traction (exerted, n), GPa.
    status
        Status of the solution.
    residual
        Largest residual at any point, over the strength of the laws.
    largest_change
        Largest change of the displacement from the guess, nm.
    iterations
        Iterations of the method.
    unstable
        True where a small disturbance would grow, as on the balance on a knife's edge.
    """

    displacement: Array = field(repr=False)
    gap: Array = field(repr=False)
    traction: Array = field(repr=False)
    status: Status
    residual: float
    largest_change: float
    iterations: int
    unstable: bool = False

    @property
    def is_stable(self) -> bool:
        """True where it has converged to a state that no small disturbance leaves, as far as the solver has looked."""
        return self.status is Status.CONVERGED and not self.unstable


class EquilibriumFinder(Protocol):
    """What finds equilibria of cohesive problems along a load path."""

    @property
    def uses_guess(self) -> bool:
        """True where `solve_near` uses a guess beyond the last state; elsewhere it follows the flow from there."""

    @property
    def trust_radius(self) -> float:
        """Largest change from a guess to a state on the same branch, over the interaction range of the laws."""

    def new_memory(self) -> Any:
        """Return what `solve_near` keeps from state to state of one path; empty at first."""

    def solve_near(
        self,
        problem: CohesiveProblem,
        guess: Array,
        memory: Any,
        within: float = np.inf,
    ) -> Equilibrium:
        """Return the equilibrium near a guess.

        Parameters
        ----------
        problem
            The problem at the load step.
        guess
            Coefficients of a displacement (exerted, m), nm.
        memory
            Of `new_memory`.
        within
            Largest change of the displacement, nm, that is of use to the caller; the search may end beyond it.
        """

    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return the equilibrium that the overdamped flow reaches from a displacement (exerted, m), nm."""


class CohesiveSolver(Solver, EquilibriumFinder, Protocol):
    """A method that finds equilibria, with what a scene needs to know of it."""


def status_of(residual: float, problem: CohesiveProblem) -> Status:
    """Return the status of a state with a residual, over the strength of the laws."""
    if not np.isfinite(residual):
        return Status.NON_FINITE
    return Status.CONVERGED if residual <= problem.tolerance else Status.MAX_ITERATIONS


def cannot_carry_load(problem: CohesiveProblem, gap: Array) -> bool:
    """Return True if a load has pulled the bodies apart, or pressed them through each other; gap: (read, n), nm."""
    if problem.load is None:
        return False
    farthest = SEPARATION * problem.interaction_range
    if gap[0].min() > farthest and float(problem.law.traction(gap)[0].max()) < -problem.load:
        return True
    if not gap[0].max() < -farthest:
        return False
    without_slip = np.zeros_like(gap)
    without_slip[0] = gap[0]
    repulsion = -float(problem.law.traction(without_slip)[0].max())
    return repulsion > LOST_REPULSION * abs(problem.load)  # slip takes the repulsion of a coupled law


def largest_change(problem: CohesiveProblem, change: Array, enough: float = 0.0) -> float:
    """Return the largest value anywhere of a change of the displacement (exerted, m), nm.

    If an upper bound, the sum of all coefficients, is at most `enough` (nm), the bound is returned.
    """
    bound = 2 * float(np.abs(change).sum(axis=1).max())
    return bound if bound <= enough else float(np.abs(problem.field(change)[: len(change)]).max())
