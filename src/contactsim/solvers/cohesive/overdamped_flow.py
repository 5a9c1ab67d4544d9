"""Overdamped flow of smooth laws from a state to the next stable one, by linearly implicit steps.

The flow du/dt = -(K u + T) is what a slow experiment follows from the end of a branch. Each step solves

    (K + T' + s) du = -r,

with a shift s, the inverse of the time step, that adapts to the change of the displacement in a step. Steps that go
uphill or too far are refused; after an uphill one the shift follows from the rate of growth. Once s is small against
the laws' tangent it is set to zero, and the last steps are Newton's. An unstable state is left along a growing
displacement. Laws without a potential have tangents that are not symmetric, and there such a displacement may yet
decay. A state to which the flow returns, in steps in which growth would about double, is stable. Nor need the flow of
such laws end: it may turn in a cycle, which is told from a slow approach by the residual at each turn.
"""

from __future__ import annotations

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import Equilibrium, are_pulled_apart, largest_change
from contactsim.solvers.cohesive.linearised import find_growth, newton_forcing, solve_linearised
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
NEAR, FAR, TURNS, STEADY = 0.3, 0.6, 5, 2.0
"""Distances from a place, over the farthest one since, within which a motion is back there and beyond which it is away;
returns after which it is a cycle, if the residual has changed by no more than that factor."""


class Cycle:
    """Tells whether a motion returns to one place again and again; the place is renewed at steps 2, 4, 8 and so on."""

    def __init__(self) -> None:
        self._place: Array | None = None
        self._residual, self._farthest, self._turns, self._away = np.inf, 0.0, 0, False

    def closes(self, problem: CohesiveProblem, count: int, displacement: Array, residual: float) -> bool:
        """Return True if the displacement at a step ends a cycle."""
        if self._place is None or count & (count - 1) == 0:
            self._place, self._residual, self._farthest, self._turns, self._away = displacement, residual, 0.0, 0, False
            return False
        distance = largest_change(problem, displacement - self._place)
        self._farthest = max(self._farthest, distance)
        if distance > FAR * self._farthest:
            self._away = True
        elif self._away and distance < NEAR * self._farthest:
            self._away, self._turns = False, self._turns + 1
        return self._turns >= TURNS and 1 / STEADY <= residual / self._residual <= STEADY


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
    displacement, shift = start, INITIAL_SHIFT * problem.law_stiffness
    status, worst, count, nudges = Status.MAX_ITERATIONS, np.inf, 0, 0
    least_shift, growth_steps = 0.0, 0  # of a flow that leaves an unstable state
    left: Array | None = None  # the state that the flow was made to leave, since it seemed to be unstable
    cycle = Cycle()
    while count < budget:
        count += 1
        gap = problem.gap(displacement)
        traction, tangent = problem.tangent(gap)
        residual = problem.residual(displacement, traction)
        worst = problem.norm(residual)
        if not np.isfinite(worst):
            status = Status.NON_FINITE
            break
        if are_pulled_apart(problem, gap):
            status = Status.NO_EQUILIBRIUM
            break
        if cycle.closes(problem, count, displacement, worst):
            status = Status.NO_REST
            break
        precondition = ZonePreconditioner(problem, tangent, shift)
        if shift == 0 and worst <= problem.tolerance:
            growing = find_growth(tangent, precondition)
            nudge = NUDGE * problem.interaction_range
            returned = left is not None and largest_change(problem, displacement - left) < nudge / 2
            if growing is None or returned:
                status = Status.CONVERGED
                break
            if nudges == MAX_NUDGES:
                break
            nudges, least_shift, growth_steps = nudges + 1, GROWTH_SHIFT * growing.rate, GROWTH_STEPS
            shift = max(INITIAL_SHIFT * problem.law_stiffness, least_shift)
            left, displacement = displacement, displacement + nudge * growing.wave
            continue
        forcing = FLOW_FORCING if shift else newton_forcing(problem, worst)
        change, _ = solve_linearised(tangent, precondition, residual, forcing, krylov_budget, shift)
        accepted, shift, growth = _judge_step(problem, change, residual, shift, largest_step)
        growing_on = least_shift, growth_steps - accepted
        least_shift, growth_steps = (GROWTH_SHIFT * growth, GROWTH_STEPS) if growth else growing_on
        shift = max(shift, least_shift) if growth_steps > 0 else shift
        displacement = displacement + change if accepted else displacement
    distance = largest_change(problem, displacement - start)
    return Equilibrium(displacement, gap, traction, status, worst, distance, count)


def _judge_step(
    problem: CohesiveProblem, change: Array, residual: Array, shift: float, largest_step: float
) -> tuple[bool, float, float]:
    """Return whether a step of the flow is accepted, the shift of the next step, and a rate of growth.

    A step that goes uphill shows that displacements along it grow, and at which rate; elsewhere the rate is zero.
    """
    size = float(np.abs(problem.field(change)[: len(change)]).max())
    largest, stiffness = largest_step * problem.interaction_range, problem.law_stiffness
    uphill, square = float(np.vdot(change, residual).real), float(np.vdot(change, change).real)
    if not size <= 2 * largest:
        return False, max(REFUSAL_RATIO * shift, MIN_LONG_SHIFT * stiffness), 0.0
    if uphill >= 0:
        growth = shift + (uphill / square if square else 0.0)
        return False, max(GROWTH_SHIFT * growth, REFUSAL_RATIO * shift, MIN_UPHILL_SHIFT * stiffness), growth
    shift /= 3 if size < 0.3 * largest else 1.5 if size < largest else 1
    return True, shift if shift > NEGLIGIBLE_SHIFT * stiffness else 0.0, 0.0
