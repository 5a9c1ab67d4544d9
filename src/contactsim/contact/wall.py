"""A hard wall beside smooth laws: its pressure in a state, the first estimate of it, and the contact with it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from contactsim.grid import Array

if TYPE_CHECKING:
    from contactsim.contact.cohesive import CohesiveProblem


def wall_pressure(problem: CohesiveProblem, gap: Array, traction: Array) -> Array:
    """Return the pressure of the wall (n,), GPa, in a state with a gap (read, n), nm, and a traction (exerted, n)."""
    return np.maximum(problem.law.traction(gap)[0] - traction[0], 0.0)


def contact_gap(problem: CohesiveProblem, gap: Array, traction: Array) -> Array:
    """Return the gap (n,), nm, of a state, negative in contact.

    In contact with a wall it is minus the pressure over the wall's stiffness, as if the wall were a spring. So the edge
    of contact lies between points, as it does with laws that overlap.
    """
    if problem.wall is None:
        return gap[0]
    pressure = wall_pressure(problem, gap, traction)
    return np.where(pressure > 0, -pressure / problem.wall.edge_stiffness, np.maximum(gap[0], 0.0))


def hold_wall(problem: CohesiveProblem, gap: Array, traction: Array) -> CohesiveProblem:
    """Return the problem with the wall's pressure in a state with a gap (read, n) and a traction (exerted, n)."""
    if problem.wall is None:
        return problem
    return replace(problem, wall=replace(problem.wall, values=wall_pressure(problem, gap, traction)))


def balance_wall(problem: CohesiveProblem, displacement: Array) -> CohesiveProblem:
    """Return the problem with the wall's pressure that balances a displacement (exerted, m) in contact.

    A point is in contact where that pressure is larger than what an open gap takes from it. If the mean displacement is
    fixed, its reaction is unknown, and the same at all points: at open ones, where only laws act, it is the residual.
    """
    if problem.wall is None:
        return problem
    gap = problem.gap(displacement)
    pressure = problem.field(problem.residual(displacement, problem.law.traction(gap)))[0]
    if problem.fixed_modes[0]:
        is_open = gap[0] > 0
        pressure -= np.median(pressure[is_open]) if is_open.any() else pressure.min()
    touches = pressure > problem.wall.stiffness * gap[0]
    values = np.where(touches, np.maximum(pressure, 0.0), 0.0)
    return replace(problem, wall=replace(problem.wall, values=values))


def correct_wall(problem: CohesiveProblem, gap: Array) -> CohesiveProblem | None:
    """Return the problem with the wall's pressure corrected at a gap (read, n); None where gaps in contact are zero."""
    wall = problem.wall
    if wall is None or wall.largest_gap(gap[0]) <= problem.tolerance * problem.interaction_range:
        return None
    return replace(problem, wall=wall.corrected(gap[0]))


def is_beyond_closure(problem: CohesiveProblem) -> bool:
    """Return True for an approach beyond the one at which every gap to a wall is closed, where no state exists.

    Where the mean displacement is fixed, the approach alone decides the mean gap.
    """
    if problem.wall is None or problem.approach is None or not problem.fixed_modes[0]:
        return False
    return bool(problem.shape[0].mean() < problem.approach)
