"""Every increment of a path as requested."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from contactsim.arguments import Positive, checked
from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import Steps
from contactsim.paths.continuation import STATE_BUDGET, Continuation
from contactsim.paths.jumps import FOLD_WIDTH
from contactsim.paths.state import PathState
from contactsim.solvers.cohesive.base import CohesiveSolver


@checked
@dataclass(frozen=True)
class Requested:
    """Every increment of the path as requested.

    States are solved to a tolerance of 3e-3 or less: others predict the next one badly.

    Parameters
    ----------
    fold_width
        Largest distance (nm) that the load moves the surface between both sides of a jump: the step is divided. On
        approach the jump of one contact among many is located where the pull may be the largest; elsewhere it stays
        between two steps, no longer than the laws' length.
    budget
        Transforms that a state may take. Where all are spent, the path ends with the status `OVER_BUDGET`, and the
        states before it are kept. A path that has spent 0.8 of them, and 0.04 more for each state, leaves its jumps
        between two steps: the state has the status `UNLOCATED`.

    Raises
    ------
    InputError
        If the width or the budget is not positive.
    """

    fold_width: Positive = FOLD_WIDTH
    budget: Positive = STATE_BUDGET
    needs_period = False

    def check(self, points: int, steps: Steps, solver: CohesiveSolver) -> None:
        """Accept any path."""

    def follow(self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Steps) -> Iterator[PathState]:
        """Yield the states at all steps, in order."""
        path = Continuation(problem, solver, self.fold_width, budget=self.budget)
        for step in steps:
            yield path.advance(step)
