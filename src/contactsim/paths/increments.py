"""Increments in which a path of a cohesive problem is followed, by name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Protocol

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import Steps
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

    def check(self, points: int, steps: Steps, solver: CohesiveSolver) -> None:
        """Raise InputError for a grid, a path or a solver that these increments do not suit."""
        ...

    def follow(self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Steps) -> Iterator[PathState]:
        """Yield the states at all steps, in order."""
        ...


INCREMENTS: dict[str, Any] = {"requested": Requested, "adaptive": Adaptive, "nested": Nested}
