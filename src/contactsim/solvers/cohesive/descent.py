"""Descent in energy from a state: the end of a slow motion, for laws that have a potential.

A limited-memory quasi-Newton method in the metric of K + k, K the stiffness and k the laws' largest tangent. In it the
curvature of the energy is at most about one in all directions, so that a step along the gradient is one of a slow flow
and the number of steps does not depend on the grid. A few pairs of steps and changes of the gradient are remembered:
there are few soft directions. The slope of the energy along a step is known from the laws at one gap, without a
transform, and the search along a step stops as soon as the slope is small. Energies themselves, which lose half of the
digits, are not compared.

References
----------
J. Nocedal, Math. Comp. 35, 773 (1980), doi:10.1090/S0025-5718-1980-0572855-7.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.elasticity.symbol import Symbol
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import Equilibrium, are_pulled_apart, largest_change
from contactsim.status import Status

PAIRS = 3
"""Pairs of a step and a change of the gradient that are remembered."""
LONGEST_STEP = 1.0
"""Largest displacement in a step, over the interaction range."""
UPHILL = 0.3
"""Largest slope at the end of a step, uphill, over the slope downhill at its beginning."""
MAX_SHORTENINGS, LEAST_SHORTENING = 20, 0.1
"""How often a step is shortened at most, and its smallest fraction."""
LEAST_CURVATURE = 1e-8
"""Smallest cosine between a step and the change of the gradient that is remembered."""


@dataclass
class _Place:
    """A displacement (exerted, m), what acts at it, and its gradient as real numbers whose products are means."""

    displacement: Array
    gap: Array
    traction: Array
    residual: Array = field(init=False)
    gradient: Array = field(init=False)


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
    """The metric, and the pairs that are remembered."""

    def __init__(self, problem: CohesiveProblem) -> None:
        self._problem = problem
        self._metric: Symbol = problem.regularised_stiffness.inverse(problem.law_stiffness)
        self._weights = np.sqrt(problem.mode_weights)
        self._pairs: deque[tuple[Array, Array, float]] = deque(maxlen=PAIRS)

    def run(self, start: Array, budget: int) -> Equilibrium:
        """Return the minimum below a state."""
        problem, status, count = self._problem, Status.MAX_ITERATIONS, 0
        here = self._place_at(start)
        while True:
            worst = self._worst(here.residual)
            if worst <= problem.tolerance and count:  # the gap of many steps, added up, has their rounding
                here = self._place_at(here.displacement)
                worst = self._worst(here.residual)
            if worst <= problem.tolerance:
                status = Status.CONVERGED
            elif not np.isfinite(worst):
                status = Status.NON_FINITE
            elif are_pulled_apart(problem, here.gap):
                status = Status.NO_EQUILIBRIUM
            if status is not Status.MAX_ITERATIONS or count == budget:
                break
            step, slope = self._direction(here.gradient)
            after = self._search(here, step, slope) if slope < 0 else None
            if after is None:
                break
            count, here = count + 1, after
        distance = largest_change(problem, here.displacement - start)
        if status is not Status.CONVERGED:
            worst = problem.norm(here.residual)
        return Equilibrium(here.displacement, here.gap, here.traction, status, worst, distance, count)

    def _place_at(self, displacement: Array) -> _Place:
        """Return the place at a displacement."""
        gap = self._problem.gap(displacement)
        return self._place(displacement, gap, self._problem.traction(gap))

    def _place(self, displacement: Array, gap: Array, traction: Array) -> _Place:
        """Return a place with its gradient."""
        place = _Place(displacement, gap, traction)
        place.residual = self._problem.residual(displacement, traction)
        place.gradient = self._real(place.residual)
        return place

    def _real(self, coefficients: Array) -> Array:
        """Return coefficients (exerted, m) as real numbers, whose products are means over the period."""
        return (coefficients * self._weights).reshape(-1).view(float)

    def _complex(self, numbers: Array) -> Array:
        """Return real numbers as coefficients (exerted, m)."""
        return numbers.view(complex).reshape(self._problem.unknowns) / self._weights

    def _worst(self, residual: Array) -> float:
        """Return the largest residual at any point, or less where its root mean square is above the tolerance."""
        problem = self._problem
        numbers = self._real(residual)
        mean = float(np.sqrt(numbers @ numbers)) / (problem.strength * np.sqrt(len(residual)))
        return problem.norm(residual) if mean <= problem.tolerance else mean

    def _direction(self, gradient: Array) -> tuple[Array, float]:
        """Return a step as real numbers and the slope along it; along the gradient where the pairs give none."""
        for pairs in (self._pairs, ()):
            step, shares = -gradient, []
            for moved, turned, product in reversed(pairs):
                shares.append((moved @ step) / product)
                step -= shares[-1] * turned
            step = self._real(self._metric.apply(self._complex(step)))
            for (moved, turned, product), share in zip(pairs, reversed(shares), strict=True):
                step += (share - (turned @ step) / product) * moved
            slope = float(gradient @ step)
            if slope < 0:
                break
            self._pairs.clear()
        return step, slope

    def _search(self, here: _Place, step: Array, slope: float) -> _Place | None:
        """Return the place at the end of a step, shortened until it does not go far uphill; None if it never ends."""
        problem = self._problem
        change = self._complex(step)
        field = problem.field(change)[: len(change)]
        elastic = problem.add_elastic(np.zeros_like(change), change)
        bend = float(step @ self._real(elastic))
        fixed = slope - float(np.vdot(here.traction, field)) / field.shape[1]
        length = min(1.0, LONGEST_STEP * problem.interaction_range / float(np.abs(field).max()))
        for _ in range(MAX_SHORTENINGS):
            gap = here.gap + length * field
            traction = problem.traction(gap)
            end = fixed + length * bend + float(np.vdot(traction, field)) / field.shape[1]
            if end <= -UPHILL * slope:
                break
            length *= max(LEAST_SHORTENING, slope / (slope - end)) if np.isfinite(end) else LEAST_SHORTENING
        else:
            return None
        after = self._place(here.displacement + length * change, gap, traction)
        self._remember(length * step, after.gradient - here.gradient)
        return after

    def _remember(self, moved: Array, turned: Array) -> None:
        """Remember a step and the change of the gradient where the energy curves upwards along it."""
        product = float(moved @ turned)
        if product > LEAST_CURVATURE * np.linalg.norm(moved) * np.linalg.norm(turned):
            self._pairs.append((moved, turned, product))
        else:
            self._pairs.clear()
