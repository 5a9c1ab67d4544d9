"""Follow smooth laws through a load path: the increments there are to choose from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.loading import LoadStep
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.continuation import PathState, Walk
from contactsim.paths.nested import Nested
from contactsim.solvers.cohesive.base import CohesiveSolver


class Increments(Protocol):
    """A way to follow a path."""

    def check(self, points: int, steps: Sequence[LoadStep], solver: CohesiveSolver) -> None:
        """SceneError for what it cannot follow so."""
        ...

    def coarsened(self, factor: int) -> Increments:
        """Return the same for a grid that many times coarser."""
        ...

    def follow(
        self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Sequence[LoadStep]
    ) -> Iterator[PathState]:
        """States at all steps, in order."""
        ...


@dataclass(frozen=True)
class Requested:
    """Every increment of the path as it is asked for."""

    def check(self, points: int, steps: Sequence[LoadStep], solver: CohesiveSolver) -> None:
        """Any path can be followed so."""

    def coarsened(self, factor: int) -> Requested:
        """Return the same for a coarser grid: it does not depend on the grid."""
        return self

    def follow(
        self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Sequence[LoadStep]
    ) -> Iterator[PathState]:
        """States at all steps, in order."""
        walk = Walk(problem, solver)
        for step in steps:
            yield walk.advance(step)


INCREMENTS = {"requested": Requested, "adaptive": Adaptive, "nested": Nested}
