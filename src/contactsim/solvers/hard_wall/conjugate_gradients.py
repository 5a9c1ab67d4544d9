"""Conjugate gradients on the contact of a surface, preconditioned without a transform: the default in two dimensions.

Minimise ½ p·Sp - p·h over p ≥ 0 at a given load. An iteration moves the pressure along a conjugate direction (Polak and
Ribière's), cuts it at zero, shifts it so that the load stays, and takes the exact step along the resulting change, but
no further than to a pressure of zero. Points that carry nothing and have a gap are removed at once, points that overlap
are added. The gap is updated with the same transform that gives the step: one application of S an iteration.

The residual is preconditioned on the contact alone (`contactsim.solvers.hard_wall.contact_preconditioner`).

All fields but the pressure are in single precision, and the gap is counted from its level on the contact. Each outer
step begins with a gap in double precision, which is computed anew before the rounding of later additions matters. The
start is the solution on half of the points a side, and so on: pressure in contact and, with a negative sign, gap
elsewhere are interpolated as one field, which puts the edge of the contact in its place.

Memory at the peak, in bytes a point, 60 in all. Before an iteration a run needs at most 48, after it 50.

    8  heights of the scene, nm                   8  pressure at the beginning of the outer step
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
from contactsim.errors import InputError
from contactsim.grid import Array, FourierOperator
from contactsim.solvers.base import State, check_cascade, coarser_level
from contactsim.solvers.hard_wall import kernels, prolongation
from contactsim.solvers.hard_wall.contact_preconditioner import CELL, LastStep, Preconditioner
from contactsim.traits import Trait

MAX_RESIDUAL_FALL = 5e-7
"""Fall of the residual after which rounding in single precision begins to show, and the gap is computed anew."""
MAX_STEP_RATIO = 3.0
"""Largest ratio of a step to its trial length, and of the next trial length to this one."""
EPSILON = float(np.finfo(float).eps)
LOAD_ERROR, MAX_CORRECTIONS = 1e-12, 30
"""Relative error of the load to which the shift of a step is corrected, and the largest number of corrections."""
GAP_WEIGHT = 0.75
"""Pressure that stands for a gap, in E* a spacing, when both are interpolated as one field."""


@dataclass(frozen=True)
class ConjugateGradients:
    """Conjugate gradients; one outer step iterates until the residual is small enough.

    Parameters
    ----------
    inner_budget
        Largest number of iterations in an outer step.
    wavelength
        In points; see `Preconditioner`.
    budget
        Largest number of outer steps.
    """

    inner_budget: int = 200
    wavelength: float = 16.0
    budget: int = 60
    fields = 8
    accepts = frozenset({Trait.SURFACE, Trait.WALL, Trait.HALF_SPACE, Trait.LAYER, Trait.MEAN_PRESSURE, Trait.APPROACH})

    def __post_init__(self) -> None:
        if not self.wavelength > 0:
            raise InputError("wavelength", self.wavelength, "a positive number of points")

    def transforms(self, points: int) -> float:
        """Return the real transforms of an iteration: two, and two on the cells."""
        return 2 + 2 / CELL**2

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> State:
        """Return the first state: a guess, uniform pressure, or at an approach no pressure."""
        if guess is not None:
            return State(problem.project(guess), False)
        pressure = np.zeros_like(problem.heights)
        if problem.load is not None:
            pressure += problem.load
        return State(pressure, False)

    def step(self, problem: HardWallProblem, state: State) -> State:
        """Iterate from the pressure of a state, the gap of which is computed anew."""
        pressure, gap = problem.project(state.pressure), np.empty(problem.heights.shape, np.float32)
        return State(pressure, self.relax(problem, pressure, gap)[0])

    def relax(self, problem: HardWallProblem, pressure: Array, gap: Array) -> tuple[bool, float]:
        """Iterate in place.

        Parameters
        ----------
        problem
            The problem of a surface.
        pressure
            Pressure (ny, nx), changed.
        gap
            Memory (ny, nx) in single precision, into which the gap is written.

        Returns
        -------
        converged, level
            Whether the residual is within the tolerance, and the level of the gap on the contact.
        """
        iterate = _Iterate(problem, pressure, gap, self.wavelength)
        for _ in range(self.inner_budget):
            if not iterate.points:  # an approach that leaves no contact is solved: the certificate decides
                return problem.load is None, iterate.level
            if iterate.residual <= 0.9 * problem.tolerance and not iterate.added:
                return True, iterate.level
            if iterate.residual < MAX_RESIDUAL_FALL * iterate.first_residual:
                iterate.recompute_gap()
            beta = iterate.precondition()
            trial = iterate.try_step(beta)
            rise = iterate.apply_compliance()
            if not rise.product > 0:
                break
            iterate.take_step(trial, rise)
        return False, iterate.level


class _Iterate:
    """Pressure, gap and direction of an outer step, and the numbers that steer the iteration.

    level: gap on the contact; residual: largest deviation of the gap from it, in contact or overlap; points: in
    contact; added: of these, by the last step; length: of a trial step; last: the last step, by which the gap changed.
    """

    def __init__(self, problem: HardWallProblem, pressure: Array, gap: Array, wavelength: float) -> None:
        shape = problem.heights.shape
        self.problem, self.pressure, self.gap = problem, pressure, gap
        self._rows = kernels.Rows(shape, problem.compliance.grid.threads)
        self._preconditioner = Preconditioner(problem.compliance, wavelength)
        self._spread = _Spread(problem.compliance)
        self._spread.compute_gap(problem, pressure, pressure > 0, gap)
        self._direction = np.zeros(shape, np.float32)
        self._contact = kernels.contact_of((pressure > 0) | (gap < -problem.tolerance / 2))
        self._load = None if problem.load is None else problem.load * problem.heights.size
        self._overlap = np.float32(problem.tolerance / 2)
        zero = np.float32(0)
        moved = self._advance(zero, zero)
        self.level = moved.gap / moved.points if self._load is not None and moved.points else 0.0
        self.residual = max(moved.overlap, moved.opening) + abs(self.level)
        self.first_residual = self.residual
        self._length, self._energy = 1.0, 0.0
        self._last = LastStep(self._spread.out, zero, np.float32(self.level))

    def _advance(self, theta: np.float32, level: np.float32) -> kernels.Advance:
        """Move along the change by a part theta, and update the contact."""
        moved = kernels.advance_step(
            self._rows,
            contact=self._contact,
            pressure=self.pressure,
            change=self._spread.change,
            gap=self.gap,
            spread=self._spread.out,
            theta=theta,
            level=level,
            overlap=self._overlap,
            direction=self._direction,
        )
        self.points, self.added, self._along = moved.points, moved.added, moved.direction
        return moved

    def recompute_gap(self) -> None:
        """Compute the gap anew in double precision, counted from its level."""
        spread, theta, before = self._last
        self._last = LastStep(spread, theta, before - np.float32(self.level))
        contact = self._contact.points[:, : self.gap.shape[1]].view(bool)
        self._spread.compute_gap(self.problem, self.pressure, contact, self.gap)
        self.level, self.first_residual = 0.0, self.residual

    def precondition(self) -> float:
        """Precondition the residual, in place of the change, and return Polak and Ribière's factor of the direction."""
        now, then, self._sum = self._preconditioner(
            self._rows,
            gap=self.gap,
            level=np.float32(self.level),
            last=self._last,
            contact=self._contact,
            scratch=self._spread.scratch,
            out=self._spread.change,
        )
        beta = max(0.0, (now - then) / self._energy) if self._energy > 0 else 0.0
        self._energy = now
        return beta

    def try_step(self, beta: float) -> kernels.Trial:
        """Turn the direction and try a step, with a shift that is corrected until it keeps a prescribed load."""
        load, fresh, factor = self._load, np.float32(1), np.float32(beta)
        shift = self._length * (self._sum + beta * self._along) / self.points if load is not None else 0.0
        for _ in range(1 + MAX_CORRECTIONS):  # Newton's method, which from the left does not overshoot
            trial = kernels.try_step(
                self._rows,
                contact=self._contact,
                pressure=self.pressure,
                direction=self._direction,
                length=self._length,
                shift=shift,
                gap=self.gap,
                level=np.float32(self.level),
                change=self._spread.change,
                fresh=fresh,
                beta=factor,
            )
            if load is None or abs(trial.load - load) <= max(LOAD_ERROR * load, EPSILON * trial.points * abs(shift)):
                break
            shift += (trial.load - load) / trial.points if trial.points else -abs(shift) - load
            fresh, factor = np.float32(0), np.float32(1)  # the direction is turned already
        return trial

    def apply_compliance(self) -> kernels.Rise:
        """Compute the change of the gap that belongs to the change of the pressure."""
        self._spread.apply()
        return kernels.work_of(self._rows, contact=self._contact, change=self._spread.change, spread=self._spread.out)

    def take_step(self, trial: kernels.Trial, rise: kernels.Rise) -> None:
        """Take the exact step along the change, as far as no pressure turns negative."""
        exact = trial.product / rise.product
        if not exact > 0:  # rounding has moved the load, and the change only brings it back: take it
            exact, self._energy = 1.0, 0.0
        largest = 1 / trial.removed if trial.removed > 0 else MAX_STEP_RATIO
        theta = np.float32(min(exact, MAX_STEP_RATIO, largest))
        self._length *= min(max(exact, 1 / MAX_STEP_RATIO), MAX_STEP_RATIO)
        self._last = LastStep(self._spread.out, theta, np.float32(self.level))
        level = self.level + theta * rise.gap / self.points if self._load is not None else 0.0
        moved = self._advance(theta, np.float32(level))
        self.residual = max(moved.overlap, moved.opening)
        self.level = moved.gap / moved.points if self._load is not None and moved.points else 0.0


class _Spread:
    """Compliance in single precision, from `change` to `out`; `scratch` may be used by others; (ny, nx and padding).

    A gap in double precision is computed in the memory of change and scratch.
    """

    def __init__(self, compliance: FourierOperator) -> None:
        self._grid, self._counter, self._columns = compliance.grid, compliance.counter, compliance.grid.shape[1]
        self._symbol = compliance.symbol.astype(np.float32)
        shape = compliance.grid.wide_shape
        self._double = np.zeros(shape)
        self.change, self.scratch = self._double.view(np.float32).reshape(2, *shape)
        self._half = self.scratch.view(np.complex64)[:, : self._columns // 2 + 1]
        self.out = np.zeros(shape, np.float32)

    def apply(self) -> None:
        """Compute out = S change; the change stays."""
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
        self._counter.add(2, self._grid.size)

    def compute_gap(self, problem: HardWallProblem, pressure: Array, contact: Array, out: Array) -> None:
        """Write the gap, computed in double precision, less its level on the contact (bool); the change turns zero."""
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
    """Conjugate gradients that start from a cascade of coarser grids of the same surface.

    Parameters
    ----------
    coarsest
        Smallest number of points along a side of a level.
    coarse_tolerance
        Tolerance of a coarse level, in its own grid steps.
    coarse_budget
        Largest number of iterations on a coarse level.
    """

    coarsest: int = 64
    coarse_tolerance: float = 0.1
    coarse_budget: int = 15

    def __post_init__(self) -> None:
        super().__post_init__()
        check_cascade(self.coarsest, self.coarse_tolerance)

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> State:
        """Return the first state: a guess, or the solution on half of the points a side, down to the coarsest level."""
        signed = self._coarse_field(problem) if guess is None else None
        if signed is not None:
            guess = np.empty_like(problem.heights)
            kernels.Rows(guess.shape, problem.compliance.grid.threads)(prolongation.refine, signed, guess)
        return super().start(problem, guess)

    def _coarse_field(self, problem: HardWallProblem) -> Array | None:
        """Return the signed field of a warm start or of the coarser level (my, mx); None without both."""
        if problem.usable_start is not None:
            return _signed_field(problem.usable_start.pressure, problem.usable_start.gap)
        coarse = coarser_level(problem, self.coarsest, self.coarse_tolerance)
        if coarse is None:
            return None
        pressure, gap = self.start(coarse).pressure, np.empty(coarse.heights.shape, np.float32)
        level = ConjugateGradients(self.coarse_budget, self.wavelength).relax(coarse, pressure, gap)[1]
        gap -= np.float32(level)
        return _signed_field(pressure, gap)


def _signed_field(pressure: Array, gap: Array) -> Array:
    """Return the pressure in contact and, with a negative sign, the gap elsewhere; (ny, nx)."""
    return np.where(pressure > 0, pressure, -GAP_WEIGHT * np.maximum(gap, 0))
