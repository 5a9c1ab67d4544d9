"""Overdamped flow of smooth laws from a state to the next stable one, by linearly implicit steps.

The flow du/dt = -(K u + T) is what a slow experiment follows from the end of a branch. Each step solves

    (K + T' + s) du = -r,

with a shift s, the inverse of the time step, that adapts to the change of the displacement in a step. Steps that go
uphill or too far are refused; after an uphill one the shift follows from the rate of growth. Once s is small against
the laws' tangent it is set to zero, and the last steps are Newton's. An unstable state is left along a growing
displacement. The flow of laws without a potential need not end: it may go on in cycles, or at random.
"""

from __future__ import annotations

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import Equilibrium, cannot_carry_load, largest_change
from contactsim.solvers.cohesive.linearised import Growth, find_growth, newton_forcing, solve_linearised
from contactsim.solvers.cohesive.zone_preconditioner import ZonePreconditioner
from contactsim.status import Status

FLOW_FORCING = 0.3
"""Relative residual of the linear solve in a step of the flow: its direction need not be exact."""
INITIAL_SHIFT, MIN_LONG_SHIFT, MIN_UPHILL_SHIFT, NEGLIGIBLE_SHIFT = 0.03, 0.02, 1e-5, 1e-3
"""Shift over the laws' tangent at zero gap: at first, at least after a step that is too long or uphill, and below which
it is set to zero."""
REFUSAL_RATIO = 3.0
"""Least ratio of the shift after a refused step to the one before."""
GROWTH_SHIFT, GROWTH_STEPS = 2.0, 12
"""Least shift over the rate of growth, and for how many steps, where a displacement grows: it about doubles in each."""
NUDGE, MAX_NUDGES = 0.03, 5
"""Size of the displacement that is added to an unstable state, over the interaction range, and how often at most."""
WANDERING = 10.0
"""Length of the way of a motion, over its largest distance from the start, beyond which it does not come to rest."""


class Way:
    """The way that a motion has come, by the mean size of its steps over the points.

    Surfaces that snap or creep to a new state move in one direction at each point, so that the way is about as long as
    the distance from the start. It grows on and on where they move in a cycle or at random.
    """

    def __init__(self) -> None:
        self._length, self._farthest = 0.0, 0.0
        self._moved: Array | float = 0.0

    def add(self, change: Array) -> None:
        """Add a change of the displacement (exerted, n), nm."""
        self._moved = self._moved + change
        self._length += float(np.abs(change).mean())
        self._farthest = max(self._farthest, float(np.abs(self._moved).mean()))

    @property
    def wanders(self) -> bool:
        """True for a motion that does not come to rest."""
        return self._length > WANDERING * self._farthest


def flow(problem: CohesiveProblem, start: Array, largest_step: float, budget: int, krylov_budget: int) -> Equilibrium:
    """Return the end of the overdamped flow from a state.

    Parameters
    ----------
    problem
        The problem at the load step.
    start
        Coefficients of a displacement (exerted, m), nm.
    largest_step
        Largest change of the displacement in a step, over the interaction range.
    budget
        Largest number of steps.
    krylov_budget
        Largest number of Krylov iterations in a step.
    """
    return _Flow(problem, largest_step, krylov_budget).run(start, budget)


class _Flow:
    """The shift of the next step, and what the steps before it have shown."""

    def __init__(self, problem: CohesiveProblem, largest_step: float, krylov_budget: int) -> None:
        self._problem, self._largest_step, self._krylov_budget = problem, largest_step, krylov_budget
        self._shift = INITIAL_SHIFT * problem.law_stiffness
        self._least_shift, self._growth_steps = 0.0, 0  # of a flow that leaves an unstable state
        self._nudges, self._way = 0, Way()

    def run(self, start: Array, budget: int) -> Equilibrium:
        """Return the end of the flow from a state."""
        problem, displacement = self._problem, start
        status, worst, count = Status.MAX_ITERATIONS, np.inf, 0
        while count < budget:
            count += 1
            gap = problem.gap(displacement)
            traction, tangent = problem.tangent(gap)
            residual = problem.residual(displacement, traction)
            worst = problem.norm(residual)
            status = self._status(gap, worst)
            if status is not Status.MAX_ITERATIONS:
                break
            precondition = ZonePreconditioner(problem, tangent, self._shift)
            if self._shift or worst > problem.tolerance:
                displacement = self._advance(displacement, tangent, precondition, residual, worst)
                continue
            growing = find_growth(tangent, precondition)
            if growing is None:
                status = Status.CONVERGED
                break
            if self._nudges == MAX_NUDGES:
                break
            displacement = self._leave(displacement, growing)
        distance = largest_change(problem, displacement - start)
        return Equilibrium(displacement, gap, traction, status, worst, distance, count)

    def _status(self, gap: Array, worst: float) -> Status:
        """Return the status of a flow that goes no further, or MAX_ITERATIONS."""
        if not np.isfinite(worst):
            return Status.NON_FINITE
        if cannot_carry_load(self._problem, gap):
            return Status.NO_EQUILIBRIUM
        return Status.NO_REST if self._way.wanders else Status.MAX_ITERATIONS

    def _leave(self, displacement: Array, growing: Growth) -> Array:
        """Return a displacement beside an unstable state."""
        self._nudges += 1
        self._least_shift, self._growth_steps = GROWTH_SHIFT * growing.rate, GROWTH_STEPS
        self._shift = max(INITIAL_SHIFT * self._problem.law_stiffness, self._least_shift)
        return displacement + NUDGE * self._problem.interaction_range * growing.wave

    def _advance(
        self, displacement: Array, tangent: Tangent, precondition: ZonePreconditioner, residual: Array, worst: float
    ) -> Array:
        """Return the displacement after a step, the same if the step is refused."""
        problem = self._problem
        forcing = FLOW_FORCING if self._shift else newton_forcing(problem, worst)
        change, _ = solve_linearised(tangent, precondition, residual, forcing, self._krylov_budget, self._shift)
        field = problem.field(change)[: len(change)]
        accepted, growth = self._judge(change, field, residual)
        self._growth_steps -= accepted
        if growth:
            self._least_shift, self._growth_steps = GROWTH_SHIFT * growth, GROWTH_STEPS
        if self._growth_steps > 0:
            self._shift = max(self._shift, self._least_shift)
        if not accepted:
            return displacement
        self._way.add(field)
        return displacement + change

    def _judge(self, change: Array, field: Array, residual: Array) -> tuple[bool, float]:
        """Return whether a step is accepted, and a rate of growth; adapt the shift.

        A step that goes uphill shows that displacements along it grow, and at which rate; elsewhere the rate is zero.
        """
        size, shift, stiffness = float(np.abs(field).max()), self._shift, self._problem.law_stiffness
        largest = self._largest_step * self._problem.interaction_range
        uphill, square = float(np.vdot(change, residual).real), float(np.vdot(change, change).real)
        if not size <= 2 * largest:
            self._shift = max(REFUSAL_RATIO * shift, MIN_LONG_SHIFT * stiffness)
            return False, 0.0
        if uphill >= 0 and square:  # at a state that is exact there is no change
            growth = shift + uphill / square
            self._shift = max(GROWTH_SHIFT * growth, REFUSAL_RATIO * shift, MIN_UPHILL_SHIFT * stiffness)
            return False, growth
        shift /= 3 if size < 0.3 * largest else 1.5 if size < largest else 1
        self._shift = shift if shift > NEGLIGIBLE_SHIFT * stiffness else 0.0
        return True, 0.0
