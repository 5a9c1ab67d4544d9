"""A path walked on a coarse grid, whose states are then solved for on a finer one, and some of them on the whole.

Where and how far a rough contact jumps is decided by waves that a coarser grid carries as well, and by the increments
of the path; what the finest waves do in a state follows from it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, check_tolerance
from contactsim.contact.loading import LoadStep
from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.paths.continuation import PathState, Walk
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.status import Status

STRAYING = 0.5
"""Where a flow ends farther from its begin than this, in the laws' length, the next state is sought by flow too."""
CLOSE = 1e-9
"""How near (nm or GPa) a step is to a value that asks for it."""


@dataclass(frozen=True)
class Nested:
    """Every increment on a coarse grid, then on one between; states asked for are solved on the whole grid too.

    settled: values (nm or GPa) of the steps asked for; ratio, between: of the whole grid's points to those of the
    coarse grid and of the one between, powers of two; walking, reading: tolerances on these two, in parts of the
    strength. A walk leads to each state, whatever grid it is read on.
    """

    settled: list[float]
    ratio: int = 16
    between: int = 4
    walking: float = 1e-3
    reading: float = 1e-4

    def __post_init__(self) -> None:
        for name in ("walking", "reading"):
            check_tolerance(getattr(self, name), name)
        for name in ("ratio", "between"):
            value = getattr(self, name)
            if value < 1 or value & (value - 1):
                raise SceneError(name, value, "a power of two")
        if self.between > self.ratio:
            raise SceneError("between", self.between, f"at most the ratio of the coarse grid, {self.ratio}")

    def check(self, points: int, steps: Sequence[LoadStep], solver: CohesiveSolver) -> None:
        """SceneError for a grid that cannot be made coarser, states that the path does not visit, and slides."""
        if any(step.held is not None for step in steps):
            raise SceneError("increments", "nested", "requested or adaptive, as the path slides")
        if points % (2 * self.ratio):
            raise SceneError("ratio", self.ratio, f"such that it divides half the grid's {points} points")
        found = np.abs(np.subtract.outer(self.settled, [step.value for step in steps])).min(1) <= CLOSE
        lost = [value for value, is_found in zip(self.settled, found, strict=True) if not is_found]
        if lost:
            raise SceneError("settled", lost, "steps of the path, which these are not")

    def coarsened(self, factor: int) -> Nested:
        """Return the same for a grid that many times coarser."""
        ratio = max(self.ratio // factor, 1)
        return replace(self, ratio=ratio, between=min(self.between, ratio))

    def follow(
        self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Sequence[LoadStep]
    ) -> Iterator[PathState]:
        """States at all steps, in order."""
        size, tally = problem.grid.size, problem.tally
        self.check(size, steps, solver)
        walk = Walk(problem.coarser(size // self.ratio, self.walking), solver, divides=False)
        between = problem.coarser(size // self.between, self.reading)
        coarse, fine = (np.zeros(level.unknowns, complex) for level in (walk.problem, between))  # of the last state
        middle, finest = (Level(level, solver) for level in (between, problem))
        for step in steps:
            before = tally.transforms
            state = walk.advance(step)
            if state.status is Status.CONVERGED:
                expected = fine + between.prolong(state.displacement - coarse)
                refined = middle.state(state, expected)
                if refined.status is Status.CONVERGED:
                    coarse, fine = state.displacement, refined.displacement
                state = refined
            settled = min((abs(value - step.value) for value in self.settled), default=np.inf) <= CLOSE
            if settled and state.status is Status.CONVERGED:
                state = finest.state(state, problem.prolong(state.displacement))
            yield replace(state, transforms=tally.transforms - before)


class Level:
    """A finer grid than that of a walk, on which its states are solved for."""

    def __init__(self, problem: CohesiveProblem, solver: CohesiveSolver) -> None:
        self._problem, self._solver = problem, solver
        self._strays = False

    def state(self, coarse: PathState, start: Array) -> PathState:
        """The state here that one of a coarser grid leads to, from where it is expected.

        Where the last one was found far from there, or not without a flow, the flow is tried at once.
        """
        here, count = self._problem.at(coarse.step), coarse.iterations
        found = (
            None
            if self._strays
            else self._solver.solve_near(here, start, self._solver.new_memory(), here.interaction_range)
        )
        if found is None or not (found.is_stable and found.largest_change <= here.interaction_range):
            count += found.iterations if found else 0
            found = self._solver.flow_from(here, start)
            self._strays = found.largest_change > STRAYING * here.interaction_range
        count += found.iterations
        rest = found.status, found.residual, coarse.jump, count, 0.0, found, coarse.leaps
        return PathState(coarse.step, here, found.displacement, *rest)
