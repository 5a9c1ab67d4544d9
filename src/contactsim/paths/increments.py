"""Increments in which a path of a cohesive problem is followed, by name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.continuation import Continuation
from contactsim.paths.nested import Nested
from contactsim.paths.state import PathState
from contactsim.solvers.cohesive.base import CohesiveSolver


class Increments(Protocol):
    """A way to choose the increments of a path."""

    def check(self, points: int, steps: Sequence[LoadStep], solver: CohesiveSolver) -> None:
        """Raise InputError for a grid, a path or a solver that these increments do not suit."""
        ...

    def coarsened(self, factor: int) -> Increments:
        """Return the same increments for a grid that many times coarser."""
        ...

    def follow(
        self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Sequence[LoadStep]
    ) -> Iterator[PathState]:
        """Yield the states at all steps, in order."""
        ...


@dataclass(frozen=True)
class Requested:
    """Every increment of the path as requested."""

    def check(self, points: int, steps: Sequence[LoadStep], solver: CohesiveSolver) -> None:
        """Accept any path."""

    def coarsened(self, factor: int) -> Requested:
        """Return the same increments: they do not depend on the grid."""
        return self

    def follow(
        self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Sequence[LoadStep]
    ) -> Iterator[PathState]:
        """Yield the states at all steps, in order."""
        path = Continuation(problem, solver)
        for step in steps:
            yield path.advance(step)


INCREMENTS = {"requested": Requested, "adaptive": Adaptive, "nested": Nested}
