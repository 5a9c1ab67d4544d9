"""The problem that a scene with a hard wall poses at one load step.

It is posed without units. Lengths are in grid steps, the typical height difference of neighbouring
points (see `grid_step`); pressures in E*·step/spacing. Nothing a solver does can then depend on the units of the
input. With w the displacement of the elastic surface and h ≤ 0 the heights below the highest point,

    gap = w - h - a ≥ 0,   w = S p,   p ≥ 0,   p·gap = 0,

where a is the approach beyond first touch, given or, with the mean pressure prescribed, found. On a half-space w is
zero on average by convention, on an incompressible layer because it keeps its volume. With the mean pressure
prescribed it is so for any body: a uniform displacement leaves the gap alone, and is added to the approach afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contactsim.contact.loading import LoadStep
from contactsim.contact.scene import Scene
from contactsim.errors import SceneError, is_number
from contactsim.grid import Array, Grid, Operator, Tally
from contactsim.traits import Trait

FLATTEST = 1e-10
"""Smallest grid step told from rounding, over p·spacing/E* or the approach: below it the latter counts as length."""
SAMPLE = 2**16
"""Points of a surface that are enough to say what is typical; below twice as many, all are looked at."""
SCATTER = 0x9E3779B97F4A7C15
"""Golden part of 2^64: its multiples by the numbers 1, 3, 6, 10, … are spread without any period."""
STEEPEST = 1e-9
"""Height differences below it, over the rms of all, count as none when the typical one is sought."""


@dataclass(frozen=True)
class Scale:
    """Units of a problem: length of a grid step (nm), pressure E*·step/spacing (GPa); and what its approach leaves out.

    highest: largest height (nm); sunk: mean displacement under the load given (nm), which no gap feels.
    """

    step: float
    pressure: float
    highest: float
    sunk: float = 0.0


def grid_step(heights: Array) -> float:
    """Typical height difference of neighbouring points on the periodic grid, any shape to a number in the same unit.

    The median over 0.6745, which for Gaussian heights is the rms difference, of what differs at all; at most the rms.
    The rms itself would let a single pit, which the contact never feels, make every tolerance loose.
    """
    scale = max(abs(float(heights.max())), abs(float(heights.min())))
    if not scale:
        return 0.0
    differences = _differences(heights, scale)
    np.abs(differences, out=differences)
    rms = float(np.sqrt(np.vdot(differences, differences) / differences.size))
    felt = differences[differences > STEEPEST * rms]
    del differences
    return float(scale * min(rms, np.median(felt, overwrite_input=True) / 0.6745)) if felt.size else 0.0


def _differences(heights: Array, scale: float) -> Array:
    """Differences of heights over scale to the neighbour before, a row for each direction, x first.

    Of many points, those of a scattered sample: whole rows, or points in any regular order, could all lie in the same
    place of a periodic texture and miss its edges.
    """
    if heights.ndim == 1 or heights.size < 2 * SAMPLE:
        here = heights / scale
        differences = np.empty((heights.ndim, *here.shape))
        for place, axis in zip(range(heights.ndim), (-1, 0), strict=False):
            np.subtract(here, np.roll(here, 1, axis), out=differences[place])
        return differences
    count = np.arange(1, SAMPLE + 1, dtype=np.uint64)
    place = (count * (count + 1) // 2 * SCATTER >> 32) * heights.size >> 32
    y, x = np.divmod(place.astype(np.int64), heights.shape[1])
    here = heights[y, x] / scale
    return np.stack([here - heights[y, x - 1] / scale, here - heights[y - 1, x] / scale])


@dataclass(frozen=True)
class WarmStart:
    """A solution on fewer points, from which a cascade of grids can begin.

    pressure in E*·step/spacing, gap in grid steps of the problem that it is handed to; (m,) or (my, mx).
    """

    pressure: Array
    gap: Array


@dataclass
class HardWallProblem:
    """The complementarity problem at one load step, without units (see the module's text).

    heights: (n,) or (ny, nx), at most 0; compliance: S; tolerance: in grid steps; exactly one of load (mean pressure)
    and approach (beyond first touch) is given; tally counts the work; begun: where a cascade may begin.
    """

    heights: Array
    compliance: Operator
    tolerance: float
    load: float | None
    approach: float | None
    tally: Tally
    begun: WarmStart | None = None

    @property
    def untouched(self) -> bool:
        """Whether nothing has to be solved: no load, or not yet a touch."""
        return self.load == 0 if self.approach is None else self.approach <= 0

    def coarser(self, tolerance: float) -> HardWallProblem:
        """The same scene on half as many points in each direction, in grid steps of its own; heights are picked."""
        shape = tuple(size // 2 for size in self.heights.shape)
        places = [np.arange(half) * size // half for half, size in zip(shape, self.heights.shape, strict=True)]
        ratio = shape[-1] / self.heights.shape[-1]
        picked = self.heights[np.ix_(*places)] * ratio
        highest = picked.max()
        picked -= highest
        grid = self.compliance.grid.coarser(shape)
        symbol = self.compliance.symbol[grid.modes_of(self.compliance.grid)] * ratio
        approach = None if self.approach is None else self.approach * ratio + highest
        begun = self.begun and replace(self.begun, gap=self.begun.gap * ratio)
        return HardWallProblem(
            picked, Operator(grid, symbol, self.tally), tolerance, self.load, approach, self.tally, begun
        )

    @property
    def can_start_warm(self) -> bool:
        """Whether it has at most twice as many points a side as what it may begin from."""
        return self.begun is not None and self.heights.shape[-1] <= 2 * self.begun.pressure.shape[-1]

    def admissible(self, pressure: Array) -> Array:
        """The nearest field with p ≥ 0 and exactly the load asked for, in memory of its own."""
        nearest = np.maximum(pressure, 0.0)
        if self.load is not None:
            mean = nearest.mean()
            if mean > 0:
                nearest *= self.load / mean
            else:
                nearest[...] = self.load
        return nearest

    def certify(self, pressure: Array) -> tuple[Certificate, Array]:
        """Everything that makes `pressure` a solution, and its gap in grid steps, recomputed from it alone."""
        gap = self.compliance(pressure)
        gap -= self.heights
        contact = pressure > 0
        touching = gap[contact]
        approach = self.approach
        if approach is None:
            approach = float(touching.mean()) if touching.size else 0.0
        gap -= approach
        touching -= approach
        gap[contact] = 0.0  # to find the deepest overlap elsewhere
        lowest = float(gap.min())
        gap[contact] = touching
        certificate = Certificate(
            max_contact_gap=float(np.abs(touching, out=touching).max(initial=0.0)),
            penetration=0.0 - min(lowest, 0.0),
            min_pressure=float(pressure.min()),
            load_error=0.0 if not self.load else float(abs(pressure.mean() / self.load - 1)),
            approach=approach,
        )
        return certificate, gap


@dataclass(frozen=True)
class Certificate:
    """How far a field of pressure is from the solution; lengths in grid steps.

    max_contact_gap: largest |gap| in contact; penetration: largest overlap elsewhere; min_pressure: in
    E*·step/spacing, never negative; load_error: relative; approach: that belongs to the pressure.
    """

    max_contact_gap: float
    penetration: float
    min_pressure: float
    load_error: float
    approach: float

    def met(self, tolerance: float) -> bool:
        """Whether this is a solution to within `tolerance` grid steps (NaN is not)."""
        worst = max(self.max_contact_gap, self.penetration)
        return worst <= tolerance and self.min_pressure >= 0 and self.load_error <= 1e-12


def _without_units(scene: Scene, grid: Grid, heights: Array, unit: float, pressure: float) -> Array:
    """The compliance over spacing/E*; refused where that, heights or pressures leave the range of floating point."""
    with np.errstate(over="ignore", under="ignore", divide="ignore", invalid="ignore"):
        flexibility = grid.spacing[-1] / np.float64(scene.contact_modulus)
        symbol = grid.of_wavenumber(lambda q: scene.compliance(q) / flexibility)
        largest = np.float64(heights.size) * max(unit / flexibility, pressure)
        extents = flexibility, largest, (heights.max() - heights.min()) / unit
    positive = np.isfinite(symbol).all() and (symbol.ravel()[1:] > 0).all()
    if not (np.isfinite(extents).all() and flexibility > 0 and positive):
        given = f"{grid.spacing[-1]:g}, {scene.contact_modulus:g}, {np.abs(heights).max():g}, {pressure:g}"
        allowed = "units in which heights, pressures and their ratios stay within the range of floating point"
        raise SceneError("spacing, contact_modulus, heights, mean_pressure", given, allowed)
    return symbol


def _why_zero(scene: Scene) -> str:
    """Why the compliance of the uniform mode is zero."""
    if Trait.HALF_SPACE in scene.traits:
        return "by convention on a half-space"
    return "as an incompressible layer keeps its volume"


def pose_hard_wall(
    scene: Scene, step: LoadStep, heights: Array, tolerance: float, threads: int
) -> tuple[HardWallProblem, Scale]:
    """The problem that a scene poses at one load step on the grid of `heights`, nm; and its units."""
    if not (is_number(tolerance) and tolerance > 0):
        raise SceneError("tolerance", tolerance, "a positive number of grid steps")
    grid = Grid(heights.shape, scene.lengths, threads)
    highest = float(heights.max())
    asked = step.value + scene.path.origin(heights)
    overlap = asked + highest  # beyond first touch, if it is an approach
    pressure = step.value if step.control is Trait.MEAN_PRESSURE else None
    # A profile that is flat but for rounding has no grid step of its own: what the load moves takes its place.
    with np.errstate(over="ignore"):  # refused below
        flexibility = float(grid.spacing[-1] / np.float64(scene.contact_modulus))
        moved = max(overlap, 0.0) if pressure is None else pressure * flexibility
        unit = max(grid_step(heights), FLATTEST * moved) or flexibility
    approach = None if pressure is not None else overlap / unit
    symbol = _without_units(scene, grid, heights, unit, pressure or 0.0)
    uniform = float(symbol.flat[0])
    if uniform == 0 and approach is not None and approach > 0 and asked >= -heights.mean():
        limit = 0.0 if abs(heights.mean()) < 1e-12 * np.abs(heights).max() else -heights.mean()
        allowed = f"below {limit:.17g}, full contact: the mean displacement is zero, {_why_zero(scene)}"
        raise SceneError("approach", asked, allowed)
    scale = Scale(unit, unit / flexibility, highest)
    load = None if pressure is None else pressure / scale.pressure
    if load is not None:  # a uniform displacement leaves the gaps alone, and would only add its rounding to them
        scale = replace(scale, sunk=uniform * flexibility * pressure)
        symbol.flat[0] = 0.0
    tally = Tally(heights.size)
    below = heights - highest
    below /= unit
    return HardWallProblem(below, Operator(grid, symbol, tally), tolerance, load, approach, tally), scale
