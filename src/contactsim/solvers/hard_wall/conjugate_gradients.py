"""Conjugate gradients on the contact of a surface, preconditioned without a transform: the default in two dimensions.

Minimise ½ p·Sp - p·h over p ≥ 0 at a given load. An iteration moves the pressure along a conjugate direction (Polak
and Ribière's), cuts it at zero, shifts it so that the load stays, and takes the exact step along the change that is
left, as far as no pressure turns negative. Points that carry nothing and gape are dropped at once, points that
overlap are added. The gap is updated with the same transform that gives the step: one application of S an iteration.

The residual is preconditioned on the contact alone (`contactsim.solvers.hard_wall.contact_preconditioner`).

Inside, everything but the pressure is in single precision, on a gap counted from the contact's level: each step of the
outer loop begins with a gap in double precision, which is computed anew before the rounding of what is added to it
matters. The start is the solution on half as many points, and so on: pressure where there is contact and, with a
negative sign, gap where there is none are continued as one field, which puts the edge of the contact in its place.

What a run holds at its peak, in bytes a point, 60 in all. Before an iteration a run needs at most 48, after it 50.

    8  heights of the scene, nm                   8  pressure at which the outer step began
    8  heights of the problem, in grid steps      8  pressure
    4  symbol of the compliance                   4  the same in single precision 2, contact 1, its code 1
    8  gap, direction                             4  change of the gap
    8  change of the pressure and scratch, or in their place a gap in double precision
"""

from __future__ import annotations

from dataclasses import dataclass

import ducc0
import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.errors import SceneError
from contactsim.grid import Array, Operator
from contactsim.solvers.base import State, check_cascade
from contactsim.solvers.hard_wall import kernels, prolongation
from contactsim.solvers.hard_wall.contact_preconditioner import CELL, Preconditioner
from contactsim.traits import Trait

ROUNDING = 5e-7
"""Fall of the residual after which rounding in single precision begins to show, and the gap is computed anew."""
LONGEST = 3.0
"""Most by which a step may be longer than was tried, and the next trial than this one."""
EPSILON = float(np.finfo(float).eps)
SHARE, CORRECTIONS = 1e-12, 30
"""Part of the load by which the shift of a step may miss it, and most corrections of the shift."""
OPENING = 0.75
"""Pressure over gap, in E* a spacing, when both are continued as one field."""


@dataclass(frozen=True)
class ConjugateGradients:
    """One outer step iterates until the residual is small enough.

    inner_budget: most iterations of an outer step; wavelength: see `Preconditioner`.
    """

    inner_budget: int = 200
    wavelength: float = 16.0
    budget: int = 60
    fields = 8
    accepts = frozenset({Trait.SURFACE, Trait.WALL, Trait.HALF_SPACE, Trait.LAYER, Trait.MEAN_PRESSURE, Trait.APPROACH})

    def __post_init__(self) -> None:
        if not self.wavelength > 0:
            raise SceneError("wavelength", self.wavelength, "a positive number of points")

    def transforms(self, points: int) -> float:
        """Real transforms of an iteration: two, and two on the cells."""
        return 2 + 2 / CELL**2

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> State:
        """From a guess; else from uniform pressure, or with an approach from the overlap of the bodies."""
        if guess is not None:
            return State(problem.admissible(guess), False)
        pressure = np.zeros_like(problem.heights)
        if problem.load is not None:
            pressure += problem.load
        return State(pressure, False)

    def step(self, problem: HardWallProblem, state: State) -> State:
        """Iterate from the state's pressure, whose gap is computed anew."""
        pressure, gap = problem.admissible(state.pressure), np.empty(problem.heights.shape, np.float32)
        return State(pressure, self.relax(problem, pressure, gap)[0])

    def relax(self, problem: HardWallProblem, pressure: Array, gap: Array) -> tuple[bool, float]:
        """Iterate in place, gap (ny, nx) being written; whether it is done, and the gap's level on the contact."""
        shape, free = problem.heights.shape, problem.load is not None
        rows = kernels.Rows(shape, problem.compliance.grid.threads)
        condition = Preconditioner(problem.compliance, self.wavelength)
        spread = _Spread(problem.compliance)
        spread.anew(problem, pressure, pressure > 0, gap)
        direction = np.zeros(shape, np.float32)
        where = kernels.contact_of((pressure > 0) | (gap < -problem.tolerance / 2))
        load = problem.load * problem.heights.size if free else 0.0
        overlap, none = np.float32(problem.tolerance / 2), np.float32(0)
        moving = (*where, pressure, spread.change, gap, spread.out)
        total, points, added, along, deepest, widest = rows(kernels.advance, *moving, none, none, overlap, direction)
        level = total / points if free and points else 0.0
        first = worst = max(deepest, widest) + abs(level)
        length, past, energy = 1.0, (spread.out, none, np.float32(level)), 0.0
        for _ in range(self.inner_budget):
            if not points:  # an approach that leaves no contact is answered: the certificate judges
                return not free, level
            if worst <= 0.9 * problem.tolerance and not added:
                return True, level
            if worst < ROUNDING * first:
                past = (*past[:2], past[2] - np.float32(level))
                spread.anew(problem, pressure, where[0][:, : shape[1]].view(bool), gap)
                level, first = 0.0, worst
            here = np.float32(level)
            now, then, sums, *_ = condition(rows, gap, here, past, where, spread.scratch, spread.change)
            beta = max(0.0, (now - then) / energy) if energy > 0 else 0.0
            energy = now
            shift = length * (sums + beta * along) / points if free else 0.0
            along_it = (*where, pressure, direction, length)
            product, taken = _tried(rows, along_it, shift, (gap, here, spread.change), beta, load if free else None)
            spread.apply()
            stiffness, risen, *_ = rows(kernels.work, *where, spread.change, spread.out)
            if not stiffness > 0:
                break
            exact = product / stiffness
            if not exact > 0:  # rounding has moved the load, and the change does nothing but bring it back: let it
                exact, energy = 1.0, 0.0
            theta = np.float32(min(exact, LONGEST, 1 / taken if taken > 0 else LONGEST))
            length *= min(max(exact, 1 / LONGEST), LONGEST)
            past = (spread.out, theta, here)
            level = level + theta * risen / points if free else 0.0
            total, points, added, along, deepest, widest = rows(
                kernels.advance, *moving, theta, np.float32(level), overlap, direction
            )
            worst = max(deepest, widest)
            level = total / points if free and points else 0.0
        return False, level


def _tried(rows: kernels.Rows, before: tuple, shift: float, after: tuple, beta: float, load: float | None) -> tuple:
    """Try a step along the turned direction, the shift being corrected until it keeps the load, if one is given.

    before, after: what `kernels.trial` takes around the shift. The change times residual; the largest part taken away.
    """
    turn = np.float32(1), np.float32(beta)
    for _ in range(1 + CORRECTIONS):  # Newton's, which from the left do not overshoot
        carried, carriers, product, _, taken, _ = rows(kernels.trial, *before, shift, *after, *turn)
        if load is None or abs(carried - load) <= max(SHARE * load, EPSILON * carriers * abs(shift)):
            break
        shift += (carried - load) / carriers if carriers else -abs(shift) - load
        turn = np.float32(0), np.float32(1)
    return product, taken


class _Spread:
    """The compliance in single precision, from `change` to `out`; `scratch` is lent. All are (ny, nx and padding).

    What is computed in double precision takes the place of change and scratch.
    """

    def __init__(self, compliance: Operator) -> None:
        self._grid, self._tally, self._columns = compliance.grid, compliance.tally, compliance.grid.shape[1]
        self._symbol = compliance.symbol.astype(np.float32)
        shape = compliance.grid.wide_shape
        self._double = np.zeros(shape)
        self.change, self.scratch = self._double.view(np.float32).reshape(2, *shape)
        self._half = self.scratch.view(np.complex64)[:, : self._columns // 2 + 1]
        self.out = np.zeros(shape, np.float32)

    def apply(self) -> None:
        """Out = S change; the change stays."""
        self._grid.forward(self.change[:, : self._columns], out=self._half)
        self._half *= self._symbol
        ducc0.fft.c2r(
            self._half,
            lastsize=self._columns,
            forward=False,
            out=self.out[:, : self._columns],
            nthreads=self._grid.threads,
            allow_overwriting_input=True,
        )
        self._tally.add(2, self._grid.size)

    def anew(self, problem: HardWallProblem, pressure: Array, contact: Array, out: Array) -> None:
        """`out` = the gap computed in double precision, from its level on the contact (bool); change turns zero."""
        gap = problem.compliance(pressure, out=self._double)
        gap -= problem.heights
        if problem.approach is not None:
            level = problem.approach
        else:
            touching = gap[contact]
            level = float(touching.mean() if touching.size else gap.min())
        np.subtract(gap, level, out=out, casting="same_kind")
        self.change[:] = 0


@dataclass(frozen=True)
class NestedConjugateGradients(ConjugateGradients):
    """Conjugate gradients started from a cascade of coarser grids of the same surface.

    coarsest: fewest points along a side of a level; coarse_tolerance: in grid steps of the level's own; coarse_budget:
    most iterations on a coarse level.
    """

    coarsest: int = 64
    coarse_tolerance: float = 0.1
    coarse_budget: int = 15

    def __post_init__(self) -> None:
        super().__post_init__()
        check_cascade(self.coarsest, self.coarse_tolerance)

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> State:
        """From a guess, or from the solution on half as many points a side, and so on down to the coarsest level."""
        signed = None
        if guess is None and problem.can_start_warm:
            signed = _one_field(problem.begun.pressure, problem.begun.gap)
        elif guess is None and min(problem.heights.shape) // 2 >= self.coarsest:
            coarse = problem.coarser(self.coarse_tolerance)
            signed = None if coarse.untouched else self._signed(coarse)
        if signed is not None:
            guess = np.empty_like(problem.heights)
            kernels.Rows(guess.shape, problem.compliance.grid.threads)(prolongation.refine, signed, guess)
        return super().start(problem, guess)

    def _signed(self, problem: HardWallProblem) -> Array:
        """A coarse level's solution: pressure where there is contact and, with a negative sign, gap elsewhere."""
        pressure, gap = self.start(problem).pressure, np.empty(problem.heights.shape, np.float32)
        level = ConjugateGradients(self.coarse_budget, self.wavelength).relax(problem, pressure, gap)[1]
        gap -= np.float32(level)
        return _one_field(pressure, gap)


def _one_field(pressure: Array, gap: Array) -> Array:
    """Pressure where there is contact and, with a negative sign, the gap elsewhere; (ny, nx)."""
    return np.where(pressure > 0, pressure, -OPENING * np.maximum(gap, 0))
