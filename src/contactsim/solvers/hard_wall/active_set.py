"""Primal–dual active set for the hard wall on a line: the default solver.

Guess the contact set, solve the linear problem on it, drop points that pull, add points that overlap, repeat (SIAM J.
Optim. 13, 865, doi:10.1137/S1052623401383558). The stiffness |q| is an M-matrix on the grid (its off-diagonal entries
are not positive), so with exact inner solutions the sets shrink monotonically after the first step and cannot cycle.
That of an incompressible layer much thinner than the contacts are wide is no M-matrix; on rough lines, with layers of
half a spacing and more, the sets have settled nevertheless.

The inner solver is conjugate gradients on the contact set, preconditioned across the gaps (see
`contactsim.solvers.hard_wall.negative_gap_preconditioner`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.solvers.base import State, check_cascade, iterate
from contactsim.solvers.hard_wall.negative_gap_preconditioner import BlockStiffness, Continuation, block_of
from contactsim.traits import Trait


@dataclass(frozen=True)
class ActiveSetState(State):
    """Pressure (n,), zero outside the contact set that `continuation` describes; outer steps done; what they need.

    stiffness: of the preconditioner; work: (3, n), overwritten by every step.
    """

    continuation: Continuation
    count: int
    stiffness: BlockStiffness
    work: Array


@dataclass(frozen=True)
class ActiveSet:
    """One outer step solves on a contact set and updates the set.

    reduction: factor by which an inner solution lowers the residual; it is squared every tenth outer step, so that a
    set which does not settle is met with exact inner solutions. inner_budget: most inner iterations.
    """

    reduction: float = 0.2
    inner_budget: int = 200
    budget: int = 200
    fields = 29
    accepts = frozenset({Trait.LINE, Trait.WALL, Trait.HALF_SPACE, Trait.LAYER, Trait.MEAN_PRESSURE, Trait.APPROACH})

    def __post_init__(self) -> None:
        if not 0 < self.reduction < 1:
            raise SceneError("reduction", self.reduction, "above 0 and below 1")

    def transforms(self, points: int) -> float:
        """Real transforms of an inner iteration on a grid of that size: two, and two on the blocks."""
        return 2 + 2 / block_of(points)

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> ActiveSetState:
        """From a guess, or with a load from uniform pressure, with an approach from the overlap of the bodies."""
        pressure = np.zeros_like(problem.heights) if guess is None else problem.admissible(guess)
        contact = pressure > 0
        if not contact.any():
            contact = problem.heights > (-np.inf if problem.load is not None else -problem.approach)
            pressure[contact] = problem.load or 0.0
        stiffness = BlockStiffness(problem.compliance, uniform=problem.load is not None)
        work = np.empty((3, problem.heights.size))
        return ActiveSetState(
            pressure, False, Continuation(_solvable(problem, contact), stiffness.decay), 0, stiffness, work
        )

    def step(self, problem: HardWallProblem, state: ActiveSetState) -> ActiveSetState:
        """Solve on the contact set, then drop what pulls and add what overlaps."""
        pressure, index = state.pressure.copy(), state.continuation.index
        reduction = self.reduction ** (2 ** (state.count // 10))
        gap, approach = self._relax(problem, pressure, state, reduction)
        residual = np.max(np.abs(gap[index] - approach))
        overlapping = gap < approach - problem.tolerance / 2
        overlapping[index] = False
        if not (overlapping.any() or (pressure < 0).any()):
            return replace(state, pressure=pressure, done=residual <= problem.tolerance, count=state.count + 1)
        continuation = Continuation(_solvable(problem, (pressure > 0) | overlapping), state.stiffness.decay)
        moved = continuation.share(np.roll(pressure, -continuation.index[0]))
        pressure[:] = 0.0
        if problem.load is not None and moved.size == 1:
            moved[:] = problem.load * pressure.size  # exactly: a small load is lost in the rounding of what moved
        pressure[continuation.index] = moved  # what dropped points carried went to their neighbours: the load stays
        return replace(state, pressure=pressure, continuation=continuation, count=state.count + 1)

    def _relax(
        self, problem: HardWallProblem, pressure: Array, state: ActiveSetState, reduction: float
    ) -> tuple[Array, float]:
        """Conjugate gradients on the contact set, in place; returns the gap less the approach, and the approach."""
        continuation, stiffness, (gap, spread, moved) = state.continuation, state.stiffness, state.work
        index = continuation.index
        problem.compliance(pressure, out=gap)
        gap -= problem.heights
        residual, approach = _residual(problem, gap[index])
        target = max(reduction * np.max(np.abs(residual)), 0.3 * problem.tolerance)
        direction, energy = 0.0, 1.0
        for _ in range(self.inner_budget):
            if np.max(np.abs(residual)) <= target:
                break
            continuation.extend(residual, stiffness.field, moved)
            corrected = continuation.restrict(stiffness(spread, moved), moved)
            if problem.load is not None:
                corrected -= corrected.mean()  # every direction keeps the load
            previous, energy = energy, float(residual @ corrected)
            if not energy > 0:
                break
            direction = corrected + (energy / previous) * direction
            spread[:] = 0.0
            spread[index] = direction
            problem.compliance(spread, out=moved)
            length = energy / float(direction @ moved[index])
            pressure[index] += length * direction
            moved *= length
            gap += moved
            residual, approach = _residual(problem, gap[index])
        return gap, approach


def _residual(problem: HardWallProblem, gap: Array) -> tuple[Array, float]:
    """Approach less gap on the contact set, and the approach: given, or what balances the gap with the load given."""
    approach = float(gap.mean()) if problem.approach is None else problem.approach
    return approach - gap, approach


def _solvable(problem: HardWallProblem, contact: Array) -> Array:
    """A set on which the inner problem has a solution: never empty; full only where the approach is free or felt."""
    if not contact.any():
        contact[np.argmax(problem.heights)] = True
    if problem.load is None and problem.compliance.symbol[0] == 0 and contact.all():
        contact[np.argmin(problem.heights)] = False
    return contact


@dataclass(frozen=True)
class NestedActiveSet(ActiveSet):
    """The active set started from a cascade of coarser grids of the same profile.

    coarsest: fewest points of a level; coarse_tolerance: in grid steps of the level's own; coarse_budget: most outer
    steps on a coarse level.
    """

    coarsest: int = 64
    coarse_tolerance: float = 0.3
    coarse_budget: int = 30

    def __post_init__(self) -> None:
        super().__post_init__()
        check_cascade(self.coarsest, self.coarse_tolerance)

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> ActiveSetState:
        """From a guess, or from the solution on half as many points, and so on down to the coarsest level."""
        size, half = problem.heights.size, problem.heights.size // 2
        if guess is None and problem.can_start_warm:
            guess = _between(problem.begun.pressure, size)
        elif guess is None and half >= self.coarsest:
            coarse = problem.coarser(self.coarse_tolerance)
            if not coarse.untouched:
                state, *_ = iterate(self, coarse, self.start(coarse), self.coarse_budget)
                guess = _between(state.pressure, size)
        return super().start(problem, guess)


def _between(pressure: Array, size: int) -> Array:
    """A periodic field (m,) on the points of a finer grid (size,)."""
    positions = np.arange(pressure.size + 1) * (size / pressure.size)
    return np.interp(np.arange(size), positions, np.append(pressure, pressure[0]))
