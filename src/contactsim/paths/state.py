"""States of a path."""

from __future__ import annotations

from dataclasses import dataclass, field

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.contact.wall import balance_wall
from contactsim.grid import Array
from contactsim.paths.jumps import Jump
from contactsim.solvers.cohesive.base import Equilibrium
from contactsim.status import Status


@dataclass(frozen=True)
class PathState:
    """One state of a path.

    Attributes
    ----------
    step
        Load step of the state.
    problem
        The problem at that step.
    displacement
        Coefficients of the displacement, (exerted, m), nm.
    status
        How the solution ended.
    residual
        Largest residual traction over the laws' strength.
    jump
        Distance that the surface jumped since the state before, in all jumps, nm.
    iterations, transforms
        Iterations and real transforms since the state before.
    solution
        The solution, or what was interpolated between solutions; None after the path has ended.
    jumps
        The jumps since the state before.
    """

    step: LoadStep
    problem: CohesiveProblem = field(repr=False)
    displacement: Array = field(repr=False)
    status: Status
    residual: float
    jump: float
    iterations: int
    transforms: float
    solution: Equilibrium | None = field(default=None, repr=False)
    jumps: tuple[Jump, ...] = field(default=(), repr=False)

    @property
    def points(self) -> int:
        """Number of points of the grid that the state is a solution on."""
        return self.problem.heights.size

    def fields(self) -> tuple[Array, Array]:
        """Return the gap (read, n), nm, and the traction (exerted, n), GPa."""
        if self.solution is not None:
            return self.solution.gap, self.solution.traction
        gap = self.problem.gap(self.displacement)
        return gap, balance_wall(self.problem, self.displacement).traction(gap)
