"""Descent in energy from a state in convex steps: the rest of a motion that is long in the laws' length.

The traction of a law is the sum of a part that rises with the gap, as that of a repulsion, and of one that falls, as
that of a pull beyond its peak. The energy of the first and that of the bodies and of a wall are convex, the energy of
the second is concave. Where the falling part keeps its value, the energy is therefore a convex bound from above that
touches at the state. Its minimum is lower, and between the two the energy is nowhere above that of the state: no
barrier is crossed. Newton's method finds the minimum in a few steps, however far it is and however steep the laws are.
Near a stable state the steps are Newton's of the whole problem.

References
----------
A. L. Yuille and A. Rangarajan, Neural Comput. 15, 915 (2003), doi:10.1162/08997660360581958.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent
from contactsim.grid import Array
from contactsim.interface.base import has_peak, rising_part
from contactsim.solvers.cohesive.base import Equilibrium, cannot_carry_load, largest_change
from contactsim.solvers.cohesive.linearised import find_growth, solve_linearised
from contactsim.solvers.cohesive.zone_preconditioner import ZonePreconditioner
from contactsim.status import Status

FORCING, KRYLOV_BUDGET = 1e-3, 60
"""Relative residual of a linear solve, and its largest number of iterations."""
CONVEX_STEPS, CONVEX_RESIDUAL = 60, 0.01
"""Largest number of Newton steps to a minimum of the bound, and residual there, over that at the state: at most this
part of the strength."""
NEAR_CHANGE, NEAR_RESIDUAL = 0.5, 0.1
"""Change of the gap, over the interaction range, and residual, over the strength, up to which steps are Newton's."""
FAR = 1e9
"""Distance, over the interaction range, at which no law acts."""
UPHILL, SHORTENINGS = 0.3, 12
"""Largest slope at the end of a step, uphill, over the slope at its beginning, and how often a longer one is halved."""
DOUBLINGS, HALVINGS = 80, 60
"""How often the distance of a rigid motion is doubled at most, and how often it is halved."""


def settle(problem: CohesiveProblem, start: Array, budget: int) -> Equilibrium | None:
    """Return a minimum of the energy below a state; None for laws that do not tell their rising part.

    Parameters
    ----------
    problem
        Problem at a load step, of laws with a potential.
    start
        Coefficients of a displacement (exerted, m), nm.
    budget
        Largest number of convex steps.
    """
    if not has_peak(problem.law):
        return None
    displacement, status, moved = start, Status.MAX_ITERATIONS, np.inf
    for count in range(budget + 1):
        gap = problem.gap(displacement)
        traction, tangent = problem.tangent(gap)
        residual = problem.residual(displacement, traction)
        worst = problem.norm(residual)
        if worst <= problem.tolerance:
            status = Status.CONVERGED
        elif not np.isfinite(worst):
            status = Status.NON_FINITE
        elif cannot_carry_load(problem, gap):
            status = Status.NO_EQUILIBRIUM
        if status is not Status.MAX_ITERATIONS or count == budget:
            break
        after = None
        if moved <= NEAR_CHANGE * problem.interaction_range and worst <= NEAR_RESIDUAL:
            after = _newton_step(displacement, tangent, residual, worst)
        if after is None:
            after = _convex_step(problem, displacement, traction - _rising(problem, gap)[0], worst)
            after = displacement + _stretched(problem, gap, residual, after - displacement)
        moved = largest_change(problem, after - displacement)
        displacement = after
    distance = largest_change(problem, displacement - start)
    return Equilibrium(displacement, gap, traction, status, worst, distance, count)


def _rising(problem: CohesiveProblem, gap: Array) -> tuple[Array, Array]:
    """Return the rising part of the traction of laws and wall, and its derivative."""
    rising, slope = rising_part(problem.law, gap)
    if problem.wall is None:
        return rising, slope
    push = problem.wall.push(gap[0])
    return rising - push, slope + problem.wall.stiffness * (push > 0)


def _newton_step(displacement: Array, tangent: Tangent, residual: Array, worst: float) -> Array | None:
    """Return the displacement after a step of Newton's method; None where it is unstable, or does not get nearer."""
    problem = tangent.problem
    precondition = ZonePreconditioner(problem, tangent)
    if find_growth(tangent, precondition):
        return None
    step = solve_linearised(tangent, precondition, residual, FORCING, KRYLOV_BUDGET)[0]
    if np.vdot(step * problem.mode_weights, residual).real >= 0:  # uphill, back to where a branch has ended
        return None
    after = displacement + step
    gap = problem.gap(after)
    is_nearer = problem.norm(problem.residual(after, problem.traction(gap))) < worst / 2
    return after if is_nearer else None


def _convex_step(problem: CohesiveProblem, displacement: Array, falling: Array, worst: float) -> Array:
    """Return the displacement at the minimum of the energy in which the falling part of the traction is held."""
    goal = max(problem.tolerance, CONVEX_RESIDUAL * min(worst, 1.0))
    if problem.load is not None:
        displacement = _move_rigidly(problem, displacement, falling)
        farthest = _rising(problem, problem.gap(displacement) + FAR * problem.interaction_range)[0]
        if problem.load + float((falling + farthest).mean()) <= 0:
            return displacement  # the load pulls more than what is held: the bound has no minimum
    for _ in range(CONVEX_STEPS):
        gap = problem.gap(displacement)
        rising, slope = _rising(problem, gap)
        residual = problem.residual(displacement, falling + rising)
        if problem.norm(residual) <= goal:
            break
        tangent = Tangent(problem, slope)
        precondition = ZonePreconditioner(problem, tangent)
        change = solve_linearised(tangent, precondition, residual, FORCING, KRYLOV_BUDGET)[0]
        step = _shortened(problem, gap, residual, _limited(problem, gap, change))
        if step is None:
            step = _shortened(problem, gap, residual, change)
        if step is None:  # by rounding
            break
        displacement = displacement + step
    return displacement


def _slope_along(
    problem: CohesiveProblem, gap: Array, residual: Array, step: Array, traction: Callable[[Array], Array]
) -> tuple[Callable[[float], float], float]:
    """Return the slope of an energy at each part of a step, and the largest change of the gap in all of it, nm.

    traction: of the energy, at a gap (1, n)
    """
    along, weighted = problem.field(step)[: len(step)], step * problem.mode_weights
    bend = float(np.vdot(weighted, problem.elastic(step)).real)
    fixed = float(np.vdot(weighted, residual).real) - float(np.vdot(traction(gap), along)) / along.shape[1]

    def slope(part: float) -> float:
        """Return the slope at a part of the step."""
        return fixed + part * bend + float(np.vdot(traction(gap + part * along), along)) / along.shape[1]

    return slope, float(np.abs(along).max())


def _stretched(problem: CohesiveProblem, gap: Array, residual: Array, step: Array) -> Array:
    """Return a step, doubled as long as its end goes downhill and is near: a motion may be slow before it jumps."""
    slope, length = _slope_along(problem, gap, residual, step, problem.traction)
    part = 1.0
    while 0 < 2 * part * length <= NEAR_CHANGE * problem.interaction_range and slope(2 * part) < 0:
        part *= 2
    return part * step


def _shortened(problem: CohesiveProblem, gap: Array, residual: Array, step: Array) -> Array | None:
    """Return a step to the minimum of the bound, ended at the lowest place on its way; None if it begins uphill."""
    slope, _ = _slope_along(problem, gap, residual, step, lambda place: _rising(problem, place)[0])
    begin = slope(0.0)
    if not begin < 0:
        return None
    if slope(1.0) <= -UPHILL * begin:
        return step
    low, high = 0.0, 1.0
    for _ in range(SHORTENINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if slope(middle) < 0 else (low, middle)
    return high * step


def _limited(problem: CohesiveProblem, gap: Array, change: Array) -> Array:
    """Return a change that deepens no overlap of laws by more than their length: they stiffen in it."""
    if problem.wall is not None:
        return change
    deepest = np.minimum(gap, 0.0) - problem.interaction_range
    excess = np.maximum(deepest - gap - problem.field(change), 0.0)
    if not excess.any():
        return change
    back = problem.coefficients(excess)
    back[problem.fixed_modes, 0] = 0
    return change + back


def _move_rigidly(problem: CohesiveProblem, displacement: Array, falling: Array) -> Array:
    """Return the displacement moved as a whole until the traction carries the load; far away where it never does.

    Towards each other the bodies move while the falling part of the traction is held, away from each other as it falls.
    """
    gap = problem.gap(displacement)

    def force(distance: float) -> float:
        """Return the mean traction that is out of balance."""
        moved = gap + distance
        pull = problem.traction(moved) if distance > 0 else falling + _rising(problem, moved)[0]
        return float(pull.mean()) + float(problem.load or 0.0)

    towards = force(0.0) > 0
    inner, outer = 0.0, problem.interaction_range * (-1 if towards else 1)
    for _ in range(DOUBLINGS):
        if (force(outer) > 0) is not towards or cannot_carry_load(problem, gap + outer):
            break
        inner, outer = outer, 2 * outer
    for _ in range(HALVINGS if (force(outer) > 0) is not towards else 0):
        middle = (inner + outer) / 2
        inner, outer = (middle, outer) if (force(middle) > 0) is towards else (inner, middle)
    moved = displacement.copy()
    moved[0, 0] += outer
    return moved
