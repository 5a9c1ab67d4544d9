"""Equilibrium of laws that have a potential, as a minimum of the energy: a second route to the same states.

The variables are the Fourier coefficients times √(K + k0), K the stiffness and k0 the laws' largest tangent: in them
the curvature of the energy is about equal in all directions, and a limited-memory quasi-Newton method (L-BFGS-B, ACM
Trans. Math. Softw. 23, 550, doi:10.1145/279232.279236) needs as many steps on a fine grid as on a coarse one. It goes
downhill from its start. Beyond the end of a branch it therefore finds the state that the overdamped flow finds, unless
there are several minima below. If rounding of the energy stops its line search, it starts anew.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import SMOOTH_PATHS, Equilibrium, cannot_carry_load, largest_change, status_of
from contactsim.status import Status
from contactsim.traits import Trait


@dataclass(frozen=True)
class EnergyMinimisation:
    """Limited-memory quasi-Newton minimisation.

    Parameters
    ----------
    memory
        Number of pairs of steps and gradients that are remembered.
    budget
        Largest number of steps.
    restarts
        Largest number of new starts after rounding or a bad memory has stopped the method.
    """

    memory: int = 20
    budget: int = 5000
    restarts: int = 5
    fields = 80
    uses_guess = False
    trust_radius = 0.0
    accepts = SMOOTH_PATHS | {Trait.ADHESIVE_WALL}

    def transforms(self, points: int) -> float:
        """Return the real transforms of a step, for each unknown component."""
        return 2.0

    def new_memory(self) -> None:
        """Return nothing: the method has no memory of earlier states."""

    def solve_near(self, problem: CohesiveProblem, guess: Array, memory: None, within: float = np.inf) -> Equilibrium:
        """Return the minimum below a guess."""
        return self.flow_from(problem, guess)

    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return the minimum below a state."""
        from scipy.optimize import minimize  # slow to import, and reading a study imports every solver

        descent = _Descent(problem)
        place, count = descent.variables(start), 0
        with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is reported
            for _ in range(self.restarts + 1):
                options = {"maxiter": self.budget - count, "maxfun": 2 * self.budget, "maxcor": self.memory}
                result = minimize(
                    descent, place, jac=True, method="L-BFGS-B", callback=descent.stop, options=options | NO_TOLERANCES
                )
                place, count = result.x, count + result.nit
                displacement = descent.displacement(place)
                gap = problem.gap(displacement)
                traction = problem.traction(gap)
                worst = problem.norm(problem.residual(displacement, traction))
                status = Status.NO_EQUILIBRIUM if cannot_carry_load(problem, gap) else status_of(worst, problem)
                if status is not Status.MAX_ITERATIONS or count >= self.budget or not result.nit:
                    break
            distance = largest_change(problem, displacement - start)
        return Equilibrium(displacement, gap, traction, status, worst, distance, count)


NO_TOLERANCES = {"ftol": 0.0, "gtol": 0.0}
"""Options that leave the end of a descent to the residual, or to a failure of the line search."""


class _Descent:
    """Energy and gradient in the variables of the module's text."""

    def __init__(self, problem: CohesiveProblem) -> None:
        self._problem = problem
        self._count = np.sqrt(problem.mode_weights)
        self._root = np.sqrt(problem.regularised_stiffness.diagonal + problem.law_stiffness)
        self._residual, self._gap = np.full(problem.unknowns, np.inf), np.zeros_like(problem.shape)

    def variables(self, displacement: Array) -> Array:
        """Return the real variables of a displacement (1, m)."""
        return np.ravel(displacement * (self._root * self._count)).view(float)

    def displacement(self, variables: Array) -> Array:
        """Return the coefficients of the displacement (1, m)."""
        return variables.view(complex).reshape(self._root.shape) / (self._root * self._count)

    def __call__(self, variables: Array) -> tuple[float, Array]:
        """Return the energy and its gradient."""
        problem, displacement = self._problem, self.displacement(variables)
        self._gap = problem.gap(displacement)
        self._residual = problem.residual(displacement, problem.traction(self._gap))
        slope = np.ravel(self._residual * (self._count / self._root)).view(float)
        return problem.energy(displacement, self._gap), slope

    def stop(self, variables: Array) -> None:
        """End the descent at the tolerance, or when no state can carry the load."""
        problem = self._problem
        mean_square = float((np.abs(self._residual) ** 2 * problem.mode_weights).sum())  # at most the largest square
        near = np.sqrt(mean_square) <= problem.tolerance * problem.strength
        if (near and problem.norm(self._residual) <= problem.tolerance) or cannot_carry_load(problem, self._gap):
            raise StopIteration
