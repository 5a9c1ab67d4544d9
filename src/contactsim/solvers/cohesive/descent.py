"""Descent in energy from a state: the end of a slow motion, for laws that have a potential.

A limited-memory quasi-Newton method, at first in the metric of K + k, K the stiffness and k the laws' tangent at zero
gap. In it a step along the gradient is one of a slow flow, and the number of steps does not depend on the grid. Where
the residual is small, k gives way to the tangents at the state where they are positive, since the long waves of a
surface that hardly touches are far softer than K + k. If the residual grows again, because the state was at the
beginning of a jump, k is taken back. A few pairs of steps and changes of the gradient are remembered: there are few
soft directions. The slope of the energy along a step is known from the laws at one gap, without a transform, and the
search along a step stops as soon as the slope is small. Energies themselves, which lose half of the digits, are not
compared.

References
----------
J. Nocedal, Math. Comp. 35, 773 (1980), doi:10.1090/S0025-5718-1980-0572855-7.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import Equilibrium, cannot_carry_load, largest_change
from contactsim.solvers.cohesive.zone_preconditioner import ZonePreconditioner
from contactsim.status import Status

PAIRS = 3
"""Pairs of a step and a change of the gradient that are remembered."""
LONGEST_STEP = 1.0
"""Largest displacement in a step, over the interaction range."""
UPHILL = 0.3
"""Largest slope at the end of a step, uphill, over the slope downhill at its beginning."""
MAX_SHORTENINGS, LEAST_SHORTENING = 20, 0.1
"""How often a step is shortened at most, and its smallest fraction."""
NEAR_RESIDUAL, RENEWAL_RATIO = 0.03, 0.03
"""Root mean square of the residual, over the strength, at which tangents first enter the metric. Once they did at a
residual r, they are renewed at RENEWAL_RATIO times r."""
RETURN_RATIO = 10.0
"""Residual over that at which tangents entered the metric, beyond which they are left out again."""
LEAST_CURVATURE = 1e-8
"""Smallest cosine between a step and the change of the gradient that is remembered."""


@dataclass
class _Place:
    """A displacement, what acts at it, and the gradient of the energy.

    Displacement, elastic traction and gradient are in a row of real numbers: real and imaginary parts of coefficients
    (exerted, m), times the root of how often each counts in a mean. Their products add up to means over the period.
    """

    displacement: Array
    elastic: Array
    gap: Array
    traction: Array
    gradient: Array


def descend(problem: CohesiveProblem, start: Array, budget: int) -> Equilibrium:
    """Return the minimum of the energy below a state.

    Parameters
    ----------
    problem
        Problem at a load step, of laws with a potential.
    start
        Coefficients of a displacement (exerted, m), nm.
    budget
        Largest number of steps.
    """
    return _Descent(problem).run(start, budget)


class _Descent:
    """The preconditioner, which is the inverse of the metric, and the pairs that are remembered."""

    def __init__(self, problem: CohesiveProblem) -> None:
        self._problem = problem
        self._scale = np.tile(np.repeat(np.sqrt(problem.mode_weights), 2), problem.unknowns[0])
        self._unscale = 1 / self._scale
        self._stiffened = problem.regularised_stiffness.inverse(problem.law_stiffness)
        self._precondition: Callable[[Array], Array] = self._apply_stiffened
        self._renewal_residual, self._return_residual = NEAR_RESIDUAL, np.inf
        self._pairs: deque[tuple[Array, Array, float]] = deque(maxlen=PAIRS)

    def run(self, start: Array, budget: int) -> Equilibrium:
        """Return the minimum below a state."""
        problem, status, count = self._problem, Status.MAX_ITERATIONS, 0
        here = self._place_at(start)
        while True:
            worst = self._worst(here.gradient)
            needs_renewal = worst <= self._renewal_residual
            if count and (needs_renewal or worst <= problem.tolerance):  # sums of many steps have their rounding
                here = self._place_at(self._unscaled(here.displacement))
                worst = self._worst(here.gradient)
            if worst <= problem.tolerance:
                status = Status.CONVERGED
            elif not np.isfinite(worst):
                status = Status.NON_FINITE
            elif cannot_carry_load(problem, here.gap):
                status = Status.NO_EQUILIBRIUM
            if status is not Status.MAX_ITERATIONS or count == budget:
                break
            if needs_renewal:
                self._renew_metric(here.gap, worst)
            elif worst > self._return_residual:
                self._leave_tangents_out(worst)
            step, slope = self._direction(here.gradient)
            after = self._search(here, step, slope) if slope < 0 else None
            if after is None:
                break
            count, here = count + 1, after
        displacement = self._unscaled(here.displacement)
        distance = largest_change(problem, displacement - start)
        if status is not Status.CONVERGED:
            worst = problem.norm(self._unscaled(here.gradient))
        return Equilibrium(displacement, here.gap, here.traction, status, worst, distance, count)

    def _place_at(self, displacement: Array) -> _Place:
        """Return the place at the coefficients of a displacement (exerted, m)."""
        gap = self._problem.gap(displacement)
        scaled = _numbers(displacement) * self._scale
        return self._place(scaled, self._elastic(scaled), gap, self._problem.traction(gap))

    def _elastic(self, scaled: Array) -> Array:
        """Return the elastic traction at a displacement, both in scaled numbers."""
        return _numbers(self._problem.elastic(self._coefficients(scaled)))

    def _place(self, displacement: Array, elastic: Array, gap: Array, traction: Array) -> _Place:
        """Return a place with its gradient."""
        problem = self._problem
        gradient = problem.coefficients(traction)
        numbers = _numbers(gradient)
        numbers *= self._scale
        numbers += elastic
        if problem.load is not None:
            gradient[0, 0] += problem.load
        gradient[problem.fixed_modes, 0] = 0
        return _Place(displacement, elastic, gap, traction, numbers)

    def _worst(self, gradient: Array) -> float:
        """Return the largest residual at any point, or less where its root mean square is above the tolerance."""
        problem = self._problem
        mean = float(np.sqrt(gradient @ gradient)) / (problem.strength * np.sqrt(problem.unknowns[0]))
        return problem.norm(self._unscaled(gradient)) if mean <= problem.tolerance else mean

    def _renew_metric(self, gap: Array, residual: float) -> None:
        """Take the positive tangents at a gap into the metric; what was remembered in the old metric is forgotten."""
        problem = self._problem
        values = problem.tangent(gap)[1].values
        stiffening = np.zeros_like(values)
        for row in range(len(values)):
            np.maximum(values[row, row], 0, out=stiffening[row, row])
        inverse = ZonePreconditioner(problem, Tangent(problem, stiffening))
        self._precondition = lambda gradient: _numbers(inverse(self._unscaled(gradient))) * self._scale
        self._renewal_residual = RENEWAL_RATIO * residual
        self._return_residual = max(RETURN_RATIO * residual, NEAR_RESIDUAL)
        self._pairs.clear()

    def _leave_tangents_out(self, residual: float) -> None:
        """Return to the metric of K + k."""
        self._precondition = self._apply_stiffened
        self._renewal_residual, self._return_residual = min(NEAR_RESIDUAL, residual / RETURN_RATIO), np.inf
        self._pairs.clear()

    def _direction(self, gradient: Array) -> tuple[Array, float]:
        """Return a step as real numbers and the slope along it; along the gradient where the pairs give none."""
        for pairs in (self._pairs, ()):
            step, shares = -gradient, []
            for moved, turned, product in reversed(pairs):
                shares.append((moved @ step) / product)
                step -= shares[-1] * turned
            step = self._precondition(step)
            for (moved, turned, product), share in zip(pairs, reversed(shares), strict=True):
                step += (share - (turned @ step) / product) * moved
            slope = float(gradient @ step)
            if slope < 0:
                break
            self._pairs.clear()
        return step, slope

    def _apply_stiffened(self, gradient: Array) -> Array:
        """Return the step along a gradient in the metric of K + k, both in scaled numbers."""
        return _numbers(self._stiffened.apply(self._coefficients(gradient)))

    def _coefficients(self, numbers: Array) -> Array:
        """Return real numbers as the coefficients (exerted, m) that they are parts of."""
        return numbers.view(complex).reshape(self._problem.unknowns)

    def _unscaled(self, numbers: Array) -> Array:
        """Return coefficients (exerted, m) from scaled numbers."""
        return self._coefficients(numbers * self._unscale)

    def _search(self, here: _Place, step: Array, slope: float) -> _Place | None:
        """Return the place at the end of a step, shortened until it does not go far uphill; None if it never ends."""
        problem = self._problem
        field = problem.field(self._unscaled(step))
        along = field[: problem.unknowns[0]]
        elastic = self._elastic(step)
        bend = float(step @ elastic)
        fixed = slope - float(np.vdot(here.traction, along)) / along.shape[1]
        length = min(1.0, LONGEST_STEP * problem.interaction_range / max(float(along.max()), -float(along.min())))
        for _ in range(MAX_SHORTENINGS):
            gap = length * field
            gap += here.gap
            traction = problem.traction(gap)
            end = fixed + length * bend + float(np.vdot(traction, along)) / along.shape[1]
            if end <= -UPHILL * slope:
                break
            length *= max(LEAST_SHORTENING, slope / (slope - end)) if np.isfinite(end) else LEAST_SHORTENING
        else:
            return None
        moved = length * step
        elastic *= length
        elastic += here.elastic
        after = self._place(here.displacement + moved, elastic, gap, traction)
        self._remember(moved, after.gradient - here.gradient)
        return after

    def _remember(self, moved: Array, turned: Array) -> None:
        """Remember a step and the change of the gradient where the energy curves upwards along it."""
        product = float(moved @ turned)
        if product > LEAST_CURVATURE * np.sqrt(float(moved @ moved) * float(turned @ turned)):
            self._pairs.append((moved, turned, product))
        else:
            self._pairs.clear()


def _numbers(coefficients: Array) -> Array:
    """Return the real and imaginary parts of coefficients (exerted, m) in a row."""
    return coefficients.reshape(-1).view(float)
