"""Increments in which a path of a cohesive problem is followed, by name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Protocol

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.nested import Nested
from contactsim.paths.requested import Requested
from contactsim.paths.state import PathState
from contactsim.solvers.cohesive.base import CohesiveSolver


class Increments(Protocol):
    """A way to choose the increments of a path."""

    @property
    def needs_period(self) -> bool:
        """True where only heights that repeat can be followed."""
        ...

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


INCREMENTS: dict[str, Any] = {"requested": Requested, "adaptive": Adaptive, "nested": Nested}
