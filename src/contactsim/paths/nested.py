"""A path followed on a coarse grid, with its states solved on an intermediate grid, and some on the full grid.

The long waves and the increments of the path decide where and how far a rough contact jumps, and a coarse grid
resolves the long waves. The short waves of a state follow from it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from contactsim.arguments import Only, Positive, checked
from contactsim.contact.coarse_grid import coarsen, prolong
from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.pose_cohesive import check_tolerance
from contactsim.contact.steps import LoadStep, Steps
from contactsim.errors import InputError, is_whole
from contactsim.grid import Array, OutOfWorkError
from contactsim.paths.continuation import STATE_BUDGET, Continuation
from contactsim.paths.state import PathState
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.solvers.cohesive.multipliers import fit_solver
from contactsim.status import Status

FLOW_DISTANCE = 0.5
"""Distance that a flow covers, in the laws' length, beyond which the next state is found by flow too."""
ROUNDING = 1e-9
"""Largest difference (nm or GPa) between a step and the value that selects it."""

PowerOfTwo = Annotated[int, Only("a power of two", lambda value: is_whole(value) and not int(value) & (int(value) - 1))]


@checked
@dataclass(frozen=True)
class Nested:
    """Every increment on a coarse grid, then on an intermediate one; some states also on the full grid.

    Parameters
    ----------
    full_grid_at
        Values (nm or GPa) of the steps whose states are solved on the full grid.
    coarse_ratio, intermediate_ratio
        Points along a side of the full grid over those of the coarse and of the intermediate grid; powers of two.
    coarse_tolerance, intermediate_tolerance
        Tolerances on these grids, in parts of the laws' strength.
    budget
        Transforms, as many as on the full grid, that a state may take on each grid; see `Requested`.

    Raises
    ------
    InputError
        If a ratio is not a power of two, or the intermediate grid is coarser than the coarse one.
    """

    full_grid_at: Sequence[float]
    coarse_ratio: PowerOfTwo = 16
    intermediate_ratio: PowerOfTwo = 4
    coarse_tolerance: float = 1e-3
    intermediate_tolerance: float = 1e-4
    budget: Positive = STATE_BUDGET
    needs_period = True

    def __post_init__(self) -> None:
        for name in ("coarse_tolerance", "intermediate_tolerance"):
            check_tolerance(getattr(self, name), name)
        if self.intermediate_ratio > self.coarse_ratio:
            allowed = f"at most the ratio of the coarse grid, {self.coarse_ratio}"
            raise InputError("intermediate_ratio", self.intermediate_ratio, allowed)

    def check(self, points: int, steps: Steps, solver: CohesiveSolver) -> None:
        """Raise InputError for slides, for a grid that cannot be coarsened, and for values that are no steps."""
        if any(step.held is not None for step in steps):
            raise InputError("increments", "nested", "requested or adaptive, as the path slides")
        if points % (2 * self.coarse_ratio):
            allowed = f"such that it divides half the grid's {points} points"
            raise InputError("coarse_ratio", self.coarse_ratio, allowed)
        distances = np.abs(np.subtract.outer(self.full_grid_at, [step.value for step in steps])).min(1)
        missing = [value for value, far in zip(self.full_grid_at, distances > ROUNDING, strict=True) if far]
        if missing:
            raise InputError("full_grid_at", missing, "steps of the path, which these are not")

    def follow(self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Steps) -> Iterator[PathState]:
        """Yield the states at all steps, in order."""
        counter = problem.counter
        for points in problem.grid.shape:
            self.check(points, steps, solver)
        coarse_problem = coarsen(problem, self.coarse_ratio, self.coarse_tolerance)
        middle_problem = coarsen(problem, self.intermediate_ratio, self.intermediate_tolerance)
        path = Continuation(coarse_problem, solver, divides=False, budget=self.budget)
        middle_grid, full_grid = FinerGrid(middle_problem, solver), FinerGrid(problem, solver)
        coarse, middle = (np.zeros(level.unknowns, complex) for level in (coarse_problem, middle_problem))
        for step in steps:
            before = counter.transforms
            state = path.advance(step)
            try:
                with counter.granted(2 * self.budget):
                    if state.status.solved:
                        change = prolong(middle_problem, coarse_problem.grid, state.displacement - coarse)
                        refined = middle_grid.refine(state, middle + change)
                        if refined.status.solved:
                            coarse, middle = state.displacement, refined.displacement
                        state = refined
                    if state.status.solved and self._needs_full_grid(step):
                        state = full_grid.refine(state, prolong(problem, middle_problem.grid, state.displacement))
            except OutOfWorkError:
                state = replace(state, status=Status.OVER_BUDGET)
                path.end()
            yield replace(state, transforms=counter.transforms - before)

    def _needs_full_grid(self, step: LoadStep) -> bool:
        """Return True if the state at a step is solved on the full grid."""
        return min((abs(value - step.value) for value in self.full_grid_at), default=np.inf) <= ROUNDING


class FinerGrid:
    """A grid finer than that of the path, on which its states are solved again."""

    def __init__(self, problem: CohesiveProblem, solver: CohesiveSolver) -> None:
        self._problem, self._solver = problem, fit_solver(solver, problem)
        self._prefers_flow = False

    def refine(self, coarse: PathState, start: Array) -> PathState:
        """Return the state on this grid that belongs to a state of a coarser grid.

        Parameters
        ----------
        coarse
            State of the coarser grid.
        start
            Expected displacement on this grid. If the previous flow ended far from its start, the state is found by
            flow at once.
        """
        here, solver, iterations = self._problem.at(coarse.step), self._solver, coarse.iterations
        trusted = here.interaction_range
        state = None if self._prefers_flow else solver.solve_near(here, start, solver.new_memory(), trusted)
        if state is None or not (state.is_stable and state.largest_change <= trusted):
            iterations += state.iterations if state else 0
            state = solver.flow_from(here, start)
            self._prefers_flow = state.largest_change > FLOW_DISTANCE * trusted
        iterations += state.iterations
        numbers = state.status, state.residual, coarse.jump, iterations, 0.0
        # the jumps stay with the coarse grid: the loads beside them are not those of this one
        return PathState(coarse.step, here, state.displacement, *numbers, state)
