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

Memory at the peak, in bytes a point, 39 in all; cells of the preconditioner and the allocator add 1 to 3.

    8  heights of the scene, nm                   8  pressure
    8  gap, direction                             4  change of the gap
    1  symbol of the compliance, half of its rows 2  contact, its code
    8  change of the pressure and scratch, or in their place a gap in double precision

A free half-space adds 8 for its response and 8 for coefficients, and 16 while a gap in double precision is computed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.solvers.base import State, check_cascade, coarser_level
from contactsim.traits import Trait

MAX_RESIDUAL_FALL = 5e-7
"""Fall of the residual after which rounding in single precision begins to show, and the gap is computed anew."""
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
    fields = 5.5
    accepts = frozenset(
        {*(Trait.SURFACE, Trait.WALL, Trait.HALF_SPACE, Trait.FREE, Trait.LAYER, Trait.MEAN_PRESSURE, Trait.APPROACH)}
    )

    def __post_init__(self) -> None:
        if not self.wavelength > 0:
            raise InputError("wavelength", self.wavelength, "a positive number of points")

    def transforms(self, points: int) -> float:
        """Return the real transforms of an iteration: two, and two on the cells."""
        from contactsim.solvers.hard_wall.contact_preconditioner import CELL

        return 2 + 2 / CELL**2

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> State:
        """Return the first state: a guess, uniform pressure, or at an approach no pressure."""
        if guess is not None:
            return State(problem.project(guess), False)
        pressure = np.zeros(problem.shape)
        if problem.load is not None:
            pressure += problem.load
        return State(pressure, False)

    def step(self, problem: HardWallProblem, state: State) -> State:
        """Iterate from the pressure of a state, in place; its gap is computed anew."""
        pressure, gap = problem.project(state.pressure, out=state.pressure), np.empty(problem.shape, np.float32)
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
        from contactsim.solvers.hard_wall.contact_iteration import Iterate  # compiles, or loads what was compiled

        iterate = Iterate(problem, pressure, gap, self.wavelength)
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
            from contactsim.solvers.hard_wall.contact_iteration import refine_signed_field

            guess = refine_signed_field(signed, problem.shape, problem.compliance.grid.threads)
        return super().start(problem, guess)

    def _coarse_field(self, problem: HardWallProblem) -> Array | None:
        """Return the signed field of a warm start or of the coarser level (my, mx); None without both."""
        if problem.usable_start is not None:
            return _signed_field(problem.usable_start.pressure, problem.usable_start.gap)
        coarse = coarser_level(problem, self.coarsest, self.coarse_tolerance)
        if coarse is None:
            return None
        pressure, gap = self.start(coarse).pressure, np.empty(coarse.shape, np.float32)
        level = ConjugateGradients(self.coarse_budget, self.wavelength).relax(coarse, pressure, gap)[1]
        gap -= np.float32(level)
        return _signed_field(pressure, gap)


def _signed_field(pressure: Array, gap: Array) -> Array:
    """Return the pressure in contact and, with a negative sign, the gap elsewhere; (ny, nx)."""
    return np.where(pressure > 0, pressure, -GAP_WEIGHT * np.maximum(gap, 0))
