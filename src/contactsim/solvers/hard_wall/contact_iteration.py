"""One outer step of conjugate gradients on the contact of a surface: its state, and the compiled loops that change it.

`contactsim.solvers.hard_wall.conjugate_gradients` is the solver. What is compiled is imported with this module, so the
solver can be named and checked without it.
"""

from __future__ import annotations

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.elasticity.fourier_operator import Compliance
from contactsim.grid import Array, blocks
from contactsim.solvers.hard_wall import kernels, prolongation
from contactsim.solvers.hard_wall.contact_preconditioner import LastStep, Preconditioner

MAX_STEP_RATIO = 3.0
"""Largest ratio of a step to its trial length, and of the next trial length to this one."""
EPSILON = float(np.finfo(float).eps)
LOAD_ERROR, MAX_CORRECTIONS = 1e-12, 30
"""Relative error of the load to which the shift of a step is corrected, and the largest number of corrections."""


class Iterate:
    """Pressure, gap and direction of an outer step, and the numbers that steer the iteration.

    level: gap on the contact; residual: largest deviation of the gap from it, in contact or overlap; points: in
    contact; added: of these, by the last step; length: of a trial step; last: the last step, by which the gap changed.
    """

    def __init__(self, problem: HardWallProblem, pressure: Array, gap: Array, wavelength: float) -> None:
        shape = problem.shape
        self.problem, self.pressure, self.gap = problem, pressure, gap
        self._rows = kernels.Rows(shape, problem.compliance.grid.threads)
        self._preconditioner = Preconditioner(problem.compliance, wavelength)
        self._spread = _Spread(problem.compliance)
        self._spread.compute_gap(problem, pressure, pressure > 0, gap)
        self._direction = np.zeros(shape, np.float32)
        self._contact = kernels.contact_of((pressure > 0) | (gap < -problem.tolerance / 2))
        self._load = None if problem.load is None else problem.load * problem.size
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

    def __init__(self, compliance: Compliance) -> None:
        self._product = compliance.in_single_precision()
        shape = compliance.grid.wide_shape
        self._double = np.zeros(shape)
        self.change, self.scratch = self._double.view(np.float32).reshape(2, *shape)
        self.out = np.zeros(shape, np.float32)

    def apply(self) -> None:
        """Compute out = S change; the change stays."""
        self._product(self.change, self.scratch, self.out)

    def compute_gap(self, problem: HardWallProblem, pressure: Array, contact: Array, out: Array) -> None:
        """Write the gap, computed in double precision, less its level on the contact (bool); the change turns zero."""
        gap = problem.compliance(pressure, out=self._double)
        problem.profile.subtract_from(gap, problem.compliance.grid.threads)
        if problem.approach is not None:
            level = problem.approach
        else:
            count = np.count_nonzero(contact)
            total = sum(gap[low:high][contact[low:high]].sum() for low, high in blocks(gap.shape))
            level = total / count if count else float(gap.min())
        np.subtract(gap, level, out=out, casting="same_kind")
        self.change[:] = 0


def refine_signed_field(signed: Array, shape: tuple[int, ...], threads: int) -> Array:
    """Return a signed field (my, mx) prolongated to a grid (ny, nx)."""
    field = np.empty(shape)
    kernels.Rows(shape, threads)(prolongation.refine, signed, field)
    return field
