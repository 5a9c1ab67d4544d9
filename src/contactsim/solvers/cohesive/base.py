"""What solvers of smooth laws share: the state they look for, and what a path asks of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.grid import Array
from contactsim.status import Status
from contactsim.traits import Trait

CONTROLS = {Trait.APPROACH, Trait.MEAN_PRESSURE, Trait.SLIDE}
SMOOTH_PATHS = frozenset({Trait.LINE, Trait.SMOOTH, Trait.HALF_SPACE, Trait.LAYER, *CONTROLS})
"""What every one of these solvers takes; laws without a potential are for those that minimise nothing."""
APART = 40.0
"""Smallest gap, in the laws' length, from which on a load has pulled the bodies apart."""


@dataclass(frozen=True)
class Equilibrium:
    """A state of the interface: its displacement (exerted, m), coefficients, and how good it is.

    gap (read, n), nm; traction (exerted, n), GPa; residual: largest at any point, over the laws'
    strength; moved: largest change (nm) from where it was looked for; iterations: steps of the method; unstable:
    whether it was found to be no minimum, as the balance on a knife's edge is.
    """

    displacement: Array = field(repr=False)
    gap: Array = field(repr=False)
    traction: Array = field(repr=False)
    status: Status
    residual: float
    moved: float
    iterations: int
    unstable: bool = False

    @property
    def settled(self) -> bool:
        """Whether it is a solution that the least disturbance would not lead away from, as far as was looked."""
        return self.status is Status.CONVERGED and not self.unstable


class CohesiveSolver(Protocol):
    """A method that follows smooth laws.

    accepts: the traits it can take; predicts: whether it starts from a guess beyond the last state, or else flows from
    that one always; trusted: how far (in the laws' length) a state may lie from its guess to be believed on the same
    branch; fields: doubles a point and component at its peak.
    """

    accepts: frozenset[Trait]
    predicts: bool
    trusted: float
    fields: int

    def transforms(self, points: int) -> float:
        """Real transforms of an iteration, for each unknown component."""
        ...

    def new_memory(self) -> object:
        """What `near` keeps between the states of one walk."""
        ...

    def near(self, problem: CohesiveProblem, guess: Array, memory: object, within: float = np.inf) -> Equilibrium:
        """The equilibrium near a guess; one farther than `within` (nm) is of no use, and may be given up."""
        ...

    def flow(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """The equilibrium that the overdamped flow reaches from a state."""
        ...


def judged(residual: float, problem: CohesiveProblem) -> Status:
    """What a residual, over the laws' strength, makes of a state."""
    if not np.isfinite(residual):
        return Status.NON_FINITE
    return Status.CONVERGED if residual <= problem.tolerance else Status.MAX_ITERATIONS


def apart(problem: CohesiveProblem, gap: Array) -> bool:
    """Whether a load has pulled the bodies apart; gap: (components, n), nm."""
    return problem.load is not None and bool(gap[0].min() > APART * problem.interaction_range)


def moved(problem: CohesiveProblem, change: Array, enough: float = 0.0) -> float:
    """Largest change of the displacement anywhere, nm; only a bound on it where that is at most `enough`."""
    bound = 2 * float(np.abs(change).sum(axis=1).max())
    return bound if bound <= enough else float(np.abs(problem.field(change)[: len(change)]).max())
