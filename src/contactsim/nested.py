"""A path walked on a coarser grid, some of whose states are then solved for on the whole one.

Where and how far a rough contact jumps is decided by waves that a coarser grid carries as well, and by the increments
of the path; what the finest waves do in a state follows from it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from contactsim.errors import SceneError
from contactsim.interface import InterfaceProblem
from contactsim.loading import LoadStep
from contactsim.solvers.base import Status
from contactsim.solvers.equilibrium import Equilibrium, PathSolver
from contactsim.walk import PathState, Walk


@dataclass(frozen=True)
class Nested:
    """Every increment on a coarser grid; states asked for are then solved for on the whole grid, through one between.

    settled: values (nm or GPa) of the steps asked for; ratio: of the points to those of the coarser grid, a power of
    two; walking, settling, between: tolerances (of the strength) of the walk, of its states before they are refined,
    and of the grid between. The states that are not asked for are those of the coarser grid, read on the whole one.
    """

    settled: list[float]
    ratio: int = 16
    walking: float = 1e-3
    settling: float = 1e-6
    between: float = 1e-4

    def __post_init__(self) -> None:
        for name in ("walking", "settling", "between"):
            if not getattr(self, name) > 0:
                raise SceneError(name, getattr(self, name), "a positive number, in parts of the laws' strength")
        if self.ratio < 2 or self.ratio & (self.ratio - 1):
            raise SceneError("ratio", self.ratio, "a power of two, 2 or more")

    def follow(self, problem: InterfaceProblem, solver: PathSolver, steps: Sequence[LoadStep]) -> Iterator[PathState]:
        """States at all steps, in order."""
        size = problem.grid.size
        if size % (2 * self.ratio):
            raise SceneError("ratio", self.ratio, f"such that it divides half the grid's {size} points")
        walk = Walk(problem.coarser(size // self.ratio, self.walking), solver)
        for step in steps:
            before = problem.tally.transforms
            state = walk.advance(step)
            found, count = None, state.iterations
            if state.status is Status.CONVERGED and any(np.isclose(self.settled, step.value, rtol=0, atol=1e-9)):
                found, count = self._settle(problem, solver, step, state)
            cost = problem.tally.transforms - before
            if found is None:
                displacement = problem.refined(state.displacement)
                yield replace(state, displacement=displacement, found=None, transforms=cost)
                continue
            yield PathState(
                step, found.displacement, found.status, found.residual, state.jump, count, cost, size, found
            )

    def _settle(
        self, problem: InterfaceProblem, solver: PathSolver, step: LoadStep, state: PathState
    ) -> tuple[Equilibrium, int]:
        """The state on the whole grid that one of the coarser grid leads to, and all iterations."""
        size, start, count = problem.grid.size, state.displacement, state.iterations
        middle = max(size // round(self.ratio**0.5), size // self.ratio)
        levels = [(size // self.ratio, self.settling)] + [(middle, self.between)] * (self.ratio > 2)
        for level in [problem.coarser(*level) for level in levels] + [problem]:
            here = level.at(step)
            start = start if start.shape == here.unknowns else here.refined(start)
            found = solver.near(here, start, solver.begin_walk())
            if not (found.settled and found.moved <= problem.reach):
                count += found.iterations
                found = solver.flow(here, start)
            start, count = found.displacement, count + found.iterations
            if not found.settled:
                break
        return found, count
