"""Primal–dual active set for the hard wall on a line: the default solver there.

Guess the contact set, solve the linear problem on it, remove points that pull, add points that overlap, repeat (SIAM J.
Optim. 13, 865, doi:10.1137/S1052623401383558). The stiffness |q| is an M-matrix on the grid (its off-diagonal entries
are not positive), so with exact inner solutions the sets shrink monotonically after the first step and cannot cycle.
The stiffness of an incompressible layer much thinner than the contacts are wide is no M-matrix; on rough lines, with
layers of half a grid spacing and more, the sets have settled all the same.

Few contact points have a matrix that is solved directly. More of them, and complete contact, are left to conjugate
gradients on the contact set, preconditioned across the gaps (see
`contactsim.solvers.hard_wall.negative_gap_preconditioner`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.solvers.base import State, check_cascade, coarser_level, iterate
from contactsim.solvers.hard_wall.contact_set import ContactSet, Line
from contactsim.solvers.hard_wall.negative_gap_preconditioner import block_size
from contactsim.traits import Trait

FIRST_SHARE, MIN_FIRST = 8.0, 4
"""Share of the points in the first contact set over a load, which is a reduced pressure, and their smallest number."""


@dataclass(frozen=True)
class ActiveSetState(State):
    """Pressure (n,), zero outside the contact set, and what the next outer step needs.

    Parameters
    ----------
    contact
        Contact set.
    count
        Outer steps done.
    """

    contact: ContactSet
    count: int


@dataclass(frozen=True)
class ActiveSet:
    """Active set; one outer step solves on a contact set and updates the set.

    Parameters
    ----------
    direct_points
        Most contact points whose matrix is solved directly: the matrix of more of them costs more than iterations.
    reduction
        Factor by which an inner solution by conjugate gradients lowers the residual. It is squared every tenth outer
        step, so that a set which does not settle gets exact inner solutions.
    inner_budget
        Largest number of inner iterations in an outer step.
    budget
        Largest number of outer steps.
    """

    direct_points: int = 160
    reduction: float = 0.2
    inner_budget: int = 200
    budget: int = 200
    fields = 28
    accepts = frozenset(
        {*(Trait.LINE, Trait.WALL, Trait.HALF_SPACE, Trait.FREE, Trait.LAYER, Trait.MEAN_PRESSURE, Trait.APPROACH)}
    )

    def __post_init__(self) -> None:
        if not 0 < self.reduction < 1:
            raise InputError("reduction", self.reduction, "above 0 and below 1")

    def transforms(self, points: int) -> float:
        """Return the real transforms of an inner iteration: two, and two on the blocks."""
        return 2 + 2 / block_size(points)

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> ActiveSetState:
        """Return the first state: a guess, or the load on the highest points, or at an approach on the overlap."""
        heights = problem.heights
        pressure = np.zeros_like(heights) if guess is None else problem.project(guess)
        touches = pressure > 0
        if not touches.any():
            touches = _highest(problem) if problem.approach is None else heights > -problem.approach
            pressure = problem.project(np.where(touches, problem.load or 0.0, 0.0))
        contact = ContactSet(_solvable(problem, touches), Line(problem))
        return ActiveSetState(contact.only(pressure), False, contact, 0)

    def step(self, problem: HardWallProblem, state: ActiveSetState) -> ActiveSetState:
        """Solve on the contact set, then remove points that pull and add points that overlap."""
        pressure, contact, count = state.pressure.copy(), state.contact, state.count + 1
        reduction = self.reduction ** (2 ** (state.count // 10))
        if self._eliminates(contact, pressure.size):
            pressure, contact = contact.eliminate(problem)
            reduction = 0.0  # only rounding is left to remove
        gap, approach = self._relax(problem, pressure, contact, reduction)
        residual = np.max(np.abs(gap[contact.index] - approach))
        overlapping = gap < approach - problem.tolerance / 2
        overlapping[contact.index] = False
        if not (overlapping.any() or (pressure < 0).any()):
            return replace(state, pressure=pressure, done=residual <= problem.tolerance, count=count)
        contact = ContactSet(_solvable(problem, (pressure > 0) | overlapping), contact.line)
        eliminates = self._eliminates(contact, pressure.size)
        pressure = contact.only(pressure) if eliminates else contact.gather(problem, pressure)
        return replace(state, pressure=pressure, contact=contact, count=count)

    def _eliminates(self, contact: ContactSet, size: int) -> bool:
        """Return whether a set is solved directly: it has few points, and is not all of a line of some size."""
        return contact.index.size <= min(self.direct_points, size - 1)

    def _relax(
        self, problem: HardWallProblem, pressure: Array, contact: ContactSet, reduction: float
    ) -> tuple[Array, float]:
        """Iterate by conjugate gradients on a contact set, in place; return w - h and the approach."""
        index, (gap, spread, change) = contact.index, contact.line.work
        problem.compliance(pressure, out=gap)
        gap -= problem.heights
        residual, approach = _residual(problem, gap[index])
        target = max(reduction * np.max(np.abs(residual)), 0.3 * problem.tolerance)
        direction, energy = np.zeros(len(index)), 1.0
        for _ in range(self.inner_budget):
            if np.max(np.abs(residual)) <= target:
                break
            corrected = contact.preconditioner(residual, spread, change)
            if problem.load is not None:
                corrected -= corrected.mean()  # every direction keeps the load
            previous, energy = energy, float(residual @ corrected)
            if not energy > 0:
                break
            direction = corrected + (energy / previous) * direction
            spread[:] = 0.0
            spread[index] = direction
            problem.compliance(spread, out=change)
            length = energy / float(direction @ change[index])
            pressure[index] += length * direction
            change *= length
            gap += change
            residual, approach = _residual(problem, gap[index])
        return gap, approach


def _residual(problem: HardWallProblem, gap: Array) -> tuple[Array, float]:
    """Return the approach less the gap on the contact set, and the approach: prescribed, or the mean of the gap."""
    approach = float(gap.mean()) if problem.approach is None else problem.approach
    return approach - gap, approach


def _highest(problem: HardWallProblem) -> Array:
    """Return the highest points, several times as many as carry a light load, and at most about half; bool (n,)."""
    heights = problem.heights
    count = int(min(heights.size / 2, max(MIN_FIRST, FIRST_SHARE * problem.prescribed_load * heights.size)))
    return heights >= np.partition(heights, -count)[-count]


def _solvable(problem: HardWallProblem, contact: Array) -> Array:
    """Return the indices of a set, bool (n,), on which the inner problem has a solution.

    It is never empty, and not full where full contact has none.
    """
    if not contact.any():
        contact[np.argmax(problem.heights)] = True
    if problem.load is None and problem.compliance.holds_mean and contact.all():
        contact[np.argmin(problem.heights)] = False
    return np.flatnonzero(contact)


@dataclass(frozen=True)
class NestedActiveSet(ActiveSet):
    """Active set that starts from a cascade of coarser grids of the same profile.

    Parameters
    ----------
    coarsest
        Smallest number of points of a level.
    coarse_tolerance
        Tolerance of a coarse level, in its own grid steps.
    coarse_budget
        Largest number of outer steps on a coarse level.
    """

    coarsest: int = 160
    coarse_tolerance: float = 0.3
    coarse_budget: int = 30

    def __post_init__(self) -> None:
        super().__post_init__()
        check_cascade(self.coarsest, self.coarse_tolerance)

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> ActiveSetState:
        """Return the first state: a guess, or the solution on half of the points, down to the coarsest level."""
        if guess is None:
            coarse_pressure = self._coarse_pressure(problem)
            guess = None if coarse_pressure is None else _interpolate(coarse_pressure, problem.heights.size)
        return super().start(problem, guess)

    def _coarse_pressure(self, problem: HardWallProblem) -> Array | None:
        """Return the pressure on fewer points, of a warm start or of the coarser level; None without both."""
        if problem.usable_start is not None:
            return problem.usable_start.pressure
        coarse = coarser_level(problem, self.coarsest, self.coarse_tolerance)
        if coarse is None:
            return None
        return iterate(self, coarse, self.start(coarse), self.coarse_budget)[0].pressure


def _interpolate(pressure: Array, size: int) -> Array:
    """Return a periodic field (m,) on the points of a finer grid (size,), linear between its own."""
    positions = np.arange(pressure.size + 1) * (size / pressure.size)
    return np.interp(np.arange(size), positions, np.append(pressure, pressure[0]))
