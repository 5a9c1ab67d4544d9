"""Conjugate gradients on the contact of a surface, preconditioned without a transform: the default in two dimensions.

Minimise ½ p·Sp - p·h over p ≥ 0 at a given load. An iteration moves the pressure along a conjugate direction (Polak
and Ribière's), cuts it at zero, shifts it so that the load stays, and takes the exact step along the change that is
left, as far as no pressure turns negative. Points that carry nothing and gape are dropped at once, points that
overlap are added. The gap is updated with the same transform that gives the step: one application of S an iteration.

The residual is preconditioned by Gᵀ(1 - B)G. G is a factorised sparse approximate inverse of S on the contact: the row
of a point solves S among it and those of four preceding neighbours that are in contact, so there are 16 rows for all
points (SIAM J. Matrix Anal. Appl. 14, 45, doi:10.1137/0614004). It has short waves right and long ones too soft; B
takes their excess away on cells of 4 × 4 points, through transforms of that reduced size.

Inside, everything but the pressure is in single precision, on a gap counted from the contact's level: each step of the
outer loop begins with a gap in double precision, which is computed anew before the rounding of what is added to it
matters. The start is the solution on half as many points, and so on: pressure where there is contact and, with a
negative sign, gap where there is none are continued as one field, which puts the edge of the contact in its place.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import ducc0
import numpy as np

from contactsim.errors import SceneError
from contactsim.grid import Array, Operator
from contactsim.scene import WallProblem
from contactsim.solvers import kernels
from contactsim.solvers.base import State, iterate
from contactsim.traits import Trait

PADDING = 8
"""Extra columns: transforms of rows that lie a power of two apart are several times slower."""
NEIGHBOURS = ((0, -1), (-1, -1), (-1, 0), (-1, 1))
"""West, north-west, north and north-east: (row, column)."""
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
class ConjugateGradientsState(State):
    """Pressure (ny, nx), never negative; gap (ny, nx) in single precision, from the contact's level, after a step."""

    gap: Array | None = field(repr=False)


class Preconditioner:
    """Gᵀ(1 - B)G on a contact set that changes; arrays of shape (ny, nx or more) are lent by the caller."""

    def __init__(self, compliance: Operator, wavelength: float) -> None:
        """wavelength: in points, above which G alone would be too soft."""
        grid = compliance.grid
        self.tally = compliance.tally
        self.table = stencil(compliance)
        coarse = grid.coarser(tuple(max(-(-size // kernels.CELL), 2) for size in grid.shape))
        self.cells = np.zeros(coarse.shape, np.float32)
        symbol = np.abs(compliance.symbol[coarse.modes_of(grid)])
        ratio = np.divide(wavelength / np.pi, symbol, out=np.zeros_like(symbol), where=symbol > 0)
        excess = (1 - ratio / np.hypot(1, ratio)) / kernels.CELL**2
        self._excess = excess.astype(np.float32)
        self._grid = coarse
        self._code = np.zeros(grid.shape, np.uint8)

    def __call__(self, rows: kernels.Rows, gap: Array, level: float, past: tuple, where: tuple, *lent: Array) -> Array:
        """The preconditioned residual into the second array lent; its products with residuals, now and before; its sum.

        past: change of the gap in the last step, its length and the level before; where: contact and its words.
        """
        work, out = lent
        self.cells[:] = 0
        rows(kernels.factor, gap, level, *where, self.table, self._code, work, self.cells)
        smooth = self._grid.backward(self._grid.forward(self.cells) * self._excess)
        self.tally.add(2, self.cells.size)
        return rows(kernels.adjoint, gap, level, *past, *where, self.table, self._code, work, smooth, out)


def stencil(compliance: Operator, most: int = 64) -> Array:
    """Rows of G, shape (16, 5): weights of a point and its four neighbours, by the bits of those in contact."""
    grid = compliance.grid
    steps = [max(size // most, 1) for size in grid.shape]
    sizes = [min(size, most) for size in grid.shape]
    row = np.fft.fftfreq(sizes[0], 1 / sizes[0]).astype(int) * steps[0]
    places = np.ix_(np.where(row < 0, row + grid.shape[0], row), np.arange(sizes[1] // 2 + 1) * steps[1])
    response = np.fft.irfft2(compliance.symbol[places], sizes)
    offsets = np.array([(0, 0), *NEIGHBOURS])
    apart = (offsets[:, None] - offsets) % sizes
    matrix = response[apart[..., 0], apart[..., 1]]
    table = np.zeros((16, 5), np.float32)
    for bits in range(16):
        among = [0, *(place + 1 for place in range(4) if bits >> place & 1)]
        weights = np.linalg.lstsq(matrix[np.ix_(among, among)], np.eye(len(among))[0])[0]
        table[bits, among] = weights / np.sqrt(max(weights[0], np.finfo(float).tiny))
    return table


@dataclass(frozen=True)
class ConjugateGradients:
    """One outer step iterates until the residual is small enough.

    inner_budget: most iterations of an outer step; wavelength: see `Preconditioner`.
    """

    inner_budget: int = 200
    wavelength: float = 16.0
    budget: int = 60
    fields = 12
    accepts = frozenset({Trait.SURFACE, Trait.WALL, Trait.HALF_SPACE, Trait.LAYER, Trait.MEAN_PRESSURE, Trait.APPROACH})

    def __post_init__(self) -> None:
        if not self.wavelength > 0:
            raise SceneError("wavelength", self.wavelength, "a positive number of points")

    def transforms(self, points: int) -> float:
        """Real transforms of an iteration: two, and two on the cells."""
        return 2 + 2 / kernels.CELL**2

    def start(self, problem: WallProblem, guess: Array | None = None) -> ConjugateGradientsState:
        """From a guess; else from uniform pressure, or with an approach from the overlap of the bodies."""
        if guess is not None:
            return ConjugateGradientsState(problem.admissible(guess), False, None)
        pressure = np.zeros_like(problem.heights)
        if problem.load is not None:
            pressure += problem.load
        return ConjugateGradientsState(pressure, False, None)

    def step(self, problem: WallProblem, state: ConjugateGradientsState) -> ConjugateGradientsState:
        """Iterate from the state's pressure, whose gap is computed anew."""
        pressure = problem.admissible(state.pressure)
        gap = _gap(problem, pressure, pressure > 0)
        done, level = self._relax(problem, pressure, gap)
        gap -= np.float32(level)
        return ConjugateGradientsState(pressure, done, gap)

    def _relax(self, problem: WallProblem, pressure: Array, gap: Array) -> tuple[bool, float]:
        """Iterate in place; whether the residual is within the tolerance, and the gap's level on the contact."""
        shape, free = problem.heights.shape, problem.load is not None
        rows = kernels.Rows(shape, problem.compliance.grid.threads)
        condition = Preconditioner(problem.compliance, self.wavelength)
        spread = _Spread(problem.compliance)
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
            if not points:
                break
            if worst <= 0.9 * problem.tolerance and not added:
                return True, level
            if worst < ROUNDING * first:
                past = (*past[:2], past[2] - np.float32(level))
                gap[:], level, first = _gap(problem, pressure, where[0][:, : shape[1]].view(bool)), 0.0, worst
            here = np.float32(level)
            now, then, sums, *_ = condition(rows, gap, here, past, where, spread.scratch, spread.change)
            beta = max(0.0, (now - then) / energy) if energy > 0 else 0.0
            energy = now
            shift = length * (sums + beta * along) / points if free else 0.0
            turning = (*where, spread.change, np.float32(beta), direction, pressure, length, shift)
            carried, carriers, *_ = rows(kernels.turn, *turning)
            for _ in range(CORRECTIONS if free else 0):  # Newton's, which from the left do not overshoot
                if abs(carried - load) <= max(SHARE * load, EPSILON * carriers * abs(shift)):
                    break
                shift += (carried - load) / carriers if carriers else -abs(shift) - load
                carried, carriers, *_ = rows(kernels.carried, *where, pressure, direction, length, shift)
            product, *_, taken, _ = rows(
                kernels.trial, *where, pressure, direction, length, shift, gap, here, spread.change
            )
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


class _Spread:
    """The compliance in single precision, from `change` to `out`, both (ny, nx and padding); `scratch` is lent."""

    def __init__(self, compliance: Operator) -> None:
        ny, nx = compliance.grid.shape
        self._grid, self._tally, self._columns = compliance.grid, compliance.tally, nx
        self._symbol = compliance.symbol.astype(np.float32)
        self.change = np.zeros((ny, nx + PADDING), np.float32)
        self.out = np.zeros((ny, nx + PADDING), np.float32)
        wide = np.empty((ny, nx // 2 + 1 + PADDING), np.complex64)
        self._half = wide[:, : nx // 2 + 1]
        self.scratch = wide.view(np.float32)

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


def _gap(problem: WallProblem, pressure: Array, contact: Array) -> Array:
    """The gap computed in double precision, from its level on the contact (bool), in single precision."""
    gap = problem.compliance(pressure)
    gap -= problem.heights
    if problem.approach is not None:
        level = problem.approach
    else:
        level = float(gap.mean(where=contact) if contact.any() else gap.min())
    gap -= level
    return gap.astype(np.float32)


@dataclass(frozen=True)
class NestedConjugateGradients(ConjugateGradients):
    """Conjugate gradients started from a cascade of coarser grids of the same surface.

    coarsest: fewest points along a side of a level; coarse_tolerance: in grid steps of the level's own; coarse_budget:
    most iterations on a coarse level.
    """

    coarsest: int = 64
    coarse_tolerance: float = 0.03
    coarse_budget: int = 15

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.coarse_tolerance > 0:
            raise SceneError("coarse_tolerance", self.coarse_tolerance, "a positive number of grid steps")
        if self.coarsest < 2:
            raise SceneError("coarsest", self.coarsest, "a whole number of points, 2 or more")

    def start(self, problem: WallProblem, guess: Array | None = None) -> ConjugateGradientsState:
        """From a guess, or from the solution on half as many points a side, and so on down to the coarsest level."""
        if guess is None and min(problem.heights.shape) // 2 >= self.coarsest:
            coarse = problem.coarser(self.coarse_tolerance)
            if not coarse.untouched:
                loose = ConjugateGradients(self.coarse_budget, self.wavelength)
                state, *_ = iterate(loose, coarse, self.start(coarse), 1)
                gap = np.maximum(state.gap, 0)
                signed = np.where(state.pressure > 0, state.pressure, -OPENING * gap)
                guess = np.empty_like(problem.heights)
                kernels.Rows(guess.shape, problem.compliance.grid.threads)(kernels.refine, signed, guess)
        return super().start(problem, guess)
