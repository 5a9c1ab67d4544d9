"""Every increment of a path as requested."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.errors import POSITIVE, InputError, is_positive, keep_floats
from contactsim.paths.continuation import Continuation
from contactsim.paths.jumps import FOLD_WIDTH
from contactsim.paths.state import PathState
from contactsim.solvers.cohesive.base import CohesiveSolver


@dataclass(frozen=True)
class Requested:
    """Every increment of the path as requested.

    States are solved to a tolerance of 3e-3 or less: others predict the next one badly.

    Parameters
    ----------
    fold_width
        Largest distance (nm) that the load moves the surface between both sides of a jump: the step is divided. On
        approach the jump of one contact among many stays between two steps, no longer than the laws' length.

    Raises
    ------
    InputError
        If the width is not positive.
    """

    fold_width: float = FOLD_WIDTH
    needs_period = False

    def __post_init__(self) -> None:
        if not is_positive(self.fold_width):
            raise InputError("fold_width", self.fold_width, POSITIVE)
        keep_floats(self)

    def check(self, points: int, steps: Sequence[LoadStep], solver: CohesiveSolver) -> None:
        """Accept any path."""

    def coarsened(self, factor: int) -> Requested:
        """Return the same increments: they do not depend on the grid."""
        return self

    def follow(
        self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Sequence[LoadStep]
    ) -> Iterator[PathState]:
        """Yield the states at all steps, in order."""
        path = Continuation(problem, solver, self.fold_width)
        for step in steps:
            yield path.advance(step)
