"""Smooth segments of a path, and the interpolation between their states."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, field

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.wall import hold_wall
from contactsim.grid import Array
from contactsim.paths.extrapolation import POINTS, combine, lagrange_weights
from contactsim.paths.jumps import Jump
from contactsim.solvers.cohesive.base import Equilibrium
from contactsim.solvers.cohesive.linearised import grows_on_its_own
from contactsim.status import Status

SHIFTS, LOAD_ROUNDING = 20, 1e-14
"""Newton steps to the mean gap at which the laws carry a load, and error of the load, over their strength, that ends
them."""


@dataclass
class Segment:
    """Solved states between two jumps, by their load parameters, and the jumps with which the segment begins."""

    jumps: tuple[Jump, ...] = ()
    parameters: list[float] = field(default_factory=list)
    states: list[Equilibrium] = field(default_factory=list)

    def add(self, parameter: float, state: Equilibrium) -> None:
        """Append a solved state."""
        self.parameters.append(parameter)
        self.states.append(state)

    def interpolate(self, problem: CohesiveProblem, parameter: float) -> Equilibrium:
        """Return the state at a parameter inside the segment, by the polynomial through the nearest states.

        Notes
        -----
        As elasticity is linear, the elastic traction of the interpolated displacement is the interpolated traction.
        The residual is the law's traction at the interpolated gap minus that. Under a load the mean displacement is
        free: it is shifted until the laws carry the load.
        """
        window = self._nearest(parameter)
        parameters, states = self.parameters[window], self.states[window]
        if parameter in parameters:
            return states[parameters.index(parameter)]
        weights = lagrange_weights(parameters, parameter)
        gap = combine(weights, [state.gap for state in states])
        elastic = combine(weights, [state.traction for state in states])
        held = hold_wall(problem, gap, elastic)
        shift = _shift_to_load(held, gap)
        gap[0] += shift
        traction = held.traction(gap)
        error = traction - elastic
        error[problem.fixed_modes] -= error[problem.fixed_modes].mean(axis=1, keepdims=True)
        inherited = sum(abs(weight) * state.residual for weight, state in zip(weights, states, strict=True))
        residual = float(np.abs(error).max() / problem.strength) + inherited
        if held.wall is not None:
            residual = max(residual, held.wall.largest_gap(gap[0]) / problem.interaction_range)
        is_solved = residual <= problem.tolerance and not grows_on_its_own(held, gap)
        status = Status.CONVERGED if is_solved else Status.INTERPOLATED
        displacement = combine(weights, [state.displacement for state in states])
        displacement[0, 0] += shift
        return Equilibrium(displacement, gap, traction, status, residual, 0.0, 0)

    def _nearest(self, parameter: float) -> slice:
        """Return the window of the states nearest to a parameter."""
        side = self.parameters[0] - parameter  # parameters are in order, so those before this one are the first
        before = bisect_left(self.parameters, True, key=lambda other: (other - parameter) * side <= 0)
        first = min(max(before - POINTS // 2, 0), max(len(self.parameters) - POINTS, 0))
        return slice(first, first + POINTS)


def _shift_to_load(problem: CohesiveProblem, gap: Array) -> float:
    """Return the change of the mean gap (nm) by which the laws carry the load at a gap (read, n); 0 under an approach.

    Newton's method stops where the laws soften: there the load alone does not tell the mean gap.
    """
    shift, moved = 0.0, gap.copy()
    for _ in range(SHIFTS if problem.load is not None else 0):
        traction, tangent = problem.tangent(moved)
        off, slope = float(traction[0].mean()) + float(problem.load or 0.0), float(tangent.values[0, 0].mean())
        if not slope > 0 or abs(off) <= LOAD_ROUNDING * problem.strength:
            break
        shift -= off / slope
        moved[0] = gap[0] + shift
    return shift if abs(shift) <= problem.interaction_range else 0.0
