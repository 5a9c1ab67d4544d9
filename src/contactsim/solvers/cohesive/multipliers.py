"""The method of multipliers: states of smooth laws beside a hard wall, by any solver of smooth laws alone.

The wall pushes as a smooth law does, at an estimate of its pressure (`contactsim.interface.wall_pressure`). The solver
finds the equilibrium, which gives the next estimate, until gaps in contact are zero to the tolerance. The first
estimate is the pressure that balances the displacement from which the search starts, so a good guess has a good one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.wall import balance_wall, is_beyond_closure
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import Equilibrium, EquilibriumFinder, largest_change
from contactsim.status import Status

SEARCH_RATIO = 2.0
"""Change from a guess that the solver is allowed, over the largest one of use. A guess may leave a large residual in
contact, where gaps must be zero, and yet be near a state; so the solver must not judge it by the residual."""

LARGEST_RATIO, STIFFENING = 0.45, 4.0
"""Largest gap in contact after a correction, over the one before it; and factor of the stiffness where it is larger."""


def fit_solver(solver: EquilibriumFinder, problem: CohesiveProblem) -> EquilibriumFinder:
    """Return a solver of a problem: where a wall acts, the method of multipliers about the one given."""
    return solver if problem.wall is None else Multipliers(solver)


@dataclass(frozen=True)
class Multipliers:
    """Method of multipliers about a solver of smooth laws.

    Parameters
    ----------
    solver
        The solver at each estimate of the pressure.
    budget
        Largest number of estimates.
    """

    solver: EquilibriumFinder
    budget: int = 30

    @property
    def uses_guess(self) -> bool:
        """True where the solver uses a guess; see `EquilibriumFinder`."""
        return self.solver.uses_guess

    @property
    def trust_radius(self) -> float:
        """Trust radius of the solver; see `EquilibriumFinder`."""
        return self.solver.trust_radius

    def new_memory(self) -> Any:
        """Return an empty memory of the solver."""
        return self.solver.new_memory()

    def solve_near(self, problem: CohesiveProblem, guess: Array, memory: Any, within: float = np.inf) -> Equilibrium:
        """Return the equilibrium near a guess; see `EquilibriumFinder`."""
        if is_beyond_closure(problem):
            return _no_state(problem, guess)
        near = balance_wall(problem, guess)
        state = self.solver.solve_near(near, guess, memory, SEARCH_RATIO * within)
        return self._correct(near, state, guess, memory, follows_flow=False)

    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return the equilibrium that a slow motion reaches from a displacement; see `EquilibriumFinder`."""
        if is_beyond_closure(problem):
            return _no_state(problem, start)
        near = balance_wall(problem, start)
        state = self.solver.flow_from(near, start)
        return self._correct(near, state, start, self.solver.new_memory(), follows_flow=True)

    def _correct(
        self, near: CohesiveProblem, state: Equilibrium, start: Array, memory: Any, follows_flow: bool
    ) -> Equilibrium:
        """Return the state at which the wall's pressure no longer changes, from the one at the first estimate.

        follows_flow: True to let the bodies move on where a correction ends a branch
        """
        iterations, allowed, before = state.iterations, near.tolerance * near.interaction_range, np.inf
        wall, count = near.wall, 0
        while wall is not None and state.is_stable and (gap := wall.largest_gap(state.gap[0])) > allowed:
            if count == self.budget:
                state = replace(state, status=Status.MAX_ITERATIONS)
                break
            wall = wall.corrected(state.gap[0], 1.0 if gap <= LARGEST_RATIO * before else STIFFENING)
            near, before, count, here = replace(near, wall=wall), gap, count + 1, state.displacement
            state = self.solver.solve_near(near, here, memory)
            iterations += state.iterations
            if follows_flow and not state.is_stable:
                state = self.solver.flow_from(near, here)
                iterations += state.iterations
        change = largest_change(near, state.displacement - start, self.trust_radius * near.interaction_range)
        return replace(state, largest_change=change, iterations=iterations)


def _no_state(problem: CohesiveProblem, displacement: Array) -> Equilibrium:
    """Return the outcome of a step at which no state exists."""
    gap = problem.gap(displacement)
    traction = problem.traction(gap)
    return Equilibrium(displacement, gap, traction, Status.NO_EQUILIBRIUM, np.nan, 0.0, 0)
