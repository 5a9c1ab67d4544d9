"""The problem that a scene with a hard wall poses at one load step.

It has no units, so that no solver can depend on the units of the input. Lengths are in grid steps, the typical height
difference of neighbouring points (see `grid_step`); pressures are in E*·step/spacing. With w the displacement of the
elastic surface and h ≤ 0 the heights below the highest point,

    gap = w - h - a ≥ 0,   w = S p,   p ≥ 0,   p·gap = 0,

where a is the approach beyond first touch; it is prescribed, or follows from a prescribed mean pressure. The mean of w
is zero on a half-space by convention, and on an incompressible layer because it keeps its volume. Under a prescribed
mean pressure it is zero for any body: a uniform displacement does not change the gap, and is added to the approach
afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contactsim.contact.scene import Scene
from contactsim.contact.steps import LoadStep
from contactsim.errors import InputError, is_number
from contactsim.grid import Array, FourierOperator, Grid, TransformCounter
from contactsim.traits import Trait

MIN_GRID_STEP = 1e-10
"""Smallest grid step that is no rounding, over p·spacing/E* or the approach; below it, these times it are the unit."""
SAMPLE_SIZE = 2**16
"""Points from which the grid step of a surface is estimated, unless it has fewer than twice as many."""
GOLDEN_FRACTION = 0x9E3779B97F4A7C15
"""Golden fraction of 2^64: its multiples by 1, 3, 6, 10, … are spread without any period."""
MIN_DIFFERENCE = 1e-9
"""Height differences below it, over the rms of all, do not count in the grid step."""


@dataclass(frozen=True)
class Scale:
    """Units of a problem, and what is left out of its approach.

    Parameters
    ----------
    step
        Length of a grid step, nm.
    pressure
        Unit of pressure E*·step/spacing, GPa.
    highest
        Largest height, nm.
    mean_displacement
        Mean displacement under the prescribed mean pressure, nm.
    """

    step: float
    pressure: float
    highest: float
    mean_displacement: float = 0.0


def grid_step(heights: Array) -> float:
    """Return the typical height difference of neighbouring points on a periodic grid.

    Parameters
    ----------
    heights
        Heights (n,) or (ny, nx) in any unit of length.

    Returns
    -------
    float
        In the unit of the heights: the median of all differences that are not zero, over 0.6745, and at most their rms.
        For Gaussian heights both are equal. The rms alone would be large for a single pit, which the contact never
        feels, and make every tolerance loose.
    """
    scale = max(abs(float(heights.max())), abs(float(heights.min())))
    if not scale:
        return 0.0
    differences = _differences(heights, scale)
    np.abs(differences, out=differences)
    rms = float(np.sqrt(np.vdot(differences, differences) / differences.size))
    nonzero = differences[differences > MIN_DIFFERENCE * rms]
    del differences
    return float(scale * min(rms, np.median(nonzero, overwrite_input=True) / 0.6745)) if nonzero.size else 0.0


def _differences(heights: Array, scale: float) -> Array:
    """Return the differences of heights over scale to the preceding neighbour, a row for each direction, x first.

    Of many points a scattered sample is used: whole rows, or points in a regular order, could all lie at the same place
    of a periodic texture and miss its edges.
    """
    if heights.ndim == 1 or heights.size < 2 * SAMPLE_SIZE:
        here = heights / scale
        differences = np.empty((heights.ndim, *here.shape))
        for row, axis in zip(range(heights.ndim), (-1, 0), strict=False):
            np.subtract(here, np.roll(here, 1, axis), out=differences[row])
        return differences
    count = np.arange(1, SAMPLE_SIZE + 1, dtype=np.uint64)
    place = (count * (count + 1) // 2 * GOLDEN_FRACTION >> 32) * heights.size >> 32
    y, x = np.divmod(place.astype(np.int64), heights.shape[1])
    here = heights[y, x] / scale
    return np.stack([here - heights[y, x - 1] / scale, here - heights[y - 1, x] / scale])


@dataclass(frozen=True)
class WarmStart:
    """A solution on fewer points, from which a cascade of grids can start.

    Parameters
    ----------
    pressure
        Pressure (m,) or (my, mx) in E*·step/spacing.
    gap
        Gap of the same shape, in grid steps of the problem that uses it.
    """

    pressure: Array
    gap: Array


@dataclass
class HardWallProblem:
    """The complementarity problem at one load step, without units; see the module's text.

    Parameters
    ----------
    heights
        Heights (n,) or (ny, nx), at most 0.
    compliance
        S.
    tolerance
        Largest gap in contact, and largest overlap elsewhere, in grid steps.
    load, approach
        Mean pressure, or approach beyond first touch; the other one is None.
    counter
        Counter of the work.
    warm_start
        Solution on fewer points, if there is one.
    """

    heights: Array
    compliance: FourierOperator
    tolerance: float
    load: float | None
    approach: float | None
    counter: TransformCounter
    warm_start: WarmStart | None = None

    @property
    def is_separated(self) -> bool:
        """Whether there is no contact to solve for: no load, or an approach before first touch."""
        return self.load == 0 if self.approach is None else self.approach <= 0

    def coarser(self, tolerance: float) -> HardWallProblem:
        """Return the problem on half of the points in each direction, in grid steps of its own; heights are sampled."""
        shape = tuple(size // 2 for size in self.heights.shape)
        places = [np.arange(half) * size // half for half, size in zip(shape, self.heights.shape, strict=True)]
        ratio = shape[-1] / self.heights.shape[-1]
        sampled = self.heights[np.ix_(*places)] * ratio
        highest = sampled.max()
        sampled -= highest
        grid = self.compliance.grid.coarser(shape)
        symbol = self.compliance.symbol[grid.modes_of(self.compliance.grid)] * ratio
        approach = None if self.approach is None else self.approach * ratio + highest
        warm_start = self.warm_start and replace(self.warm_start, gap=self.warm_start.gap * ratio)
        return HardWallProblem(
            sampled,
            FourierOperator(grid, symbol, self.counter),
            tolerance,
            self.load,
            approach,
            self.counter,
            warm_start,
        )

    @property
    def usable_start(self) -> WarmStart | None:
        """Warm start if this grid has at most twice as many points along x as that has; None elsewhere."""
        start = self.warm_start
        return start if start is not None and self.heights.shape[-1] <= 2 * start.pressure.shape[-1] else None

    def project(self, pressure: Array) -> Array:
        """Return a pressure cut at zero and scaled to the prescribed load, in memory of its own."""
        result = np.maximum(pressure, 0.0)
        if self.load is not None:
            mean = result.mean()
            if mean > 0:
                result *= self.load / mean
            else:
                result[...] = self.load
        return result

    def certify(self, pressure: Array) -> tuple[Certificate, Array]:
        """Return the errors of a pressure, and its gap in grid steps, both computed from the pressure alone."""
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
    """Errors of a pressure; lengths in grid steps.

    Parameters
    ----------
    max_contact_gap
        Largest |gap| in contact.
    penetration
        Largest overlap elsewhere.
    min_pressure
        Smallest pressure in E*·step/spacing; never negative in a solution.
    load_error
        Relative error of the load.
    approach
        Approach that belongs to the pressure.
    """

    max_contact_gap: float
    penetration: float
    min_pressure: float
    load_error: float
    approach: float

    def met(self, tolerance: float) -> bool:
        """Return whether this is a solution to within `tolerance` grid steps; NaN is none."""
        worst = max(self.max_contact_gap, self.penetration)
        return worst <= tolerance and self.min_pressure >= 0 and self.load_error <= 1e-12


def _without_units(scene: Scene, grid: Grid, heights: Array, unit: float, pressure: float) -> Array:
    """Return the compliance over spacing/E*; refuse units that leave the range of floating point."""
    with np.errstate(over="ignore", under="ignore", divide="ignore", invalid="ignore"):
        flexibility = grid.spacing[-1] / np.float64(scene.contact_modulus)
        symbol = grid.of_wavenumber(lambda q: scene.compliance(q) / flexibility)
        largest = np.float64(heights.size) * max(unit / flexibility, pressure)
        extents = flexibility, largest, (heights.max() - heights.min()) / unit
    positive = np.isfinite(symbol).all() and (symbol.ravel()[1:] > 0).all()
    if not (np.isfinite(extents).all() and flexibility > 0 and positive):
        values = f"{grid.spacing[-1]:g}, {scene.contact_modulus:g}, {np.abs(heights).max():g}, {pressure:g}"
        allowed = "units in which heights, pressures and their ratios stay within the range of floating point"
        raise InputError("spacing, contact_modulus, heights, mean_pressure", values, allowed)
    return symbol


def _zero_mean_reason(scene: Scene) -> str:
    """Return the reason for which the mean displacement is zero."""
    if Trait.HALF_SPACE in scene.traits:
        return "by convention on a half-space"
    return "as an incompressible layer keeps its volume"


def pose_hard_wall(
    scene: Scene, step: LoadStep, heights: Array, tolerance: float, threads: int
) -> tuple[HardWallProblem, Scale]:
    """Return the problem that a scene poses at one load step, and its units.

    Parameters
    ----------
    scene
        Scene whose only effect is a hard wall.
    step
        One of its load steps.
    heights
        Sum of both surfaces' heights (n,) or (ny, nx), nm.
    tolerance
        Largest gap in contact, and largest overlap elsewhere, in grid steps.
    threads
        Threads of a transform.

    Raises
    ------
    InputError
        If the tolerance is not positive, the approach is beyond full contact of a body whose mean displacement is zero,
        or the units leave the range of floating point.
    """
    if not (is_number(tolerance) and tolerance > 0):
        raise InputError("tolerance", tolerance, "a positive number of grid steps")
    grid = Grid(heights.shape, scene.lengths, threads)
    highest = float(heights.max())
    value = step.value + scene.path.origin(heights)
    overlap = value + highest  # beyond first touch, if it is an approach
    pressure = step.value if step.control is Trait.MEAN_PRESSURE else None
    # A profile that is flat but for rounding has no grid step of its own: the displacement takes its place.
    with np.errstate(over="ignore"):  # refused below
        flexibility = float(grid.spacing[-1] / np.float64(scene.contact_modulus))
        displacement = max(overlap, 0.0) if pressure is None else pressure * flexibility
        unit = max(grid_step(heights), MIN_GRID_STEP * displacement) or flexibility
    symbol = _without_units(scene, grid, heights, unit, pressure or 0.0)
    scale = Scale(unit, unit / flexibility, highest)
    load, approach = None, None
    if pressure is None:
        _check_full_contact(scene, heights, value, overlap, float(symbol.flat[0]))
        approach = overlap / unit
    else:  # a uniform displacement does not change the gaps, and would only add rounding to them
        scale = replace(scale, mean_displacement=float(symbol.flat[0]) * flexibility * pressure)
        load = pressure / scale.pressure
        symbol.flat[0] = 0.0
    counter = TransformCounter(heights.size)
    below = heights - highest
    below /= unit
    return HardWallProblem(below, FourierOperator(grid, symbol, counter), tolerance, load, approach, counter), scale


def _check_full_contact(scene: Scene, heights: Array, value: float, overlap: float, uniform: float) -> None:
    """Refuse an approach beyond full contact where the compliance of the uniform mode is zero."""
    if uniform == 0 and overlap > 0 and value >= -heights.mean():
        limit = 0.0 if abs(heights.mean()) < 1e-12 * np.abs(heights).max() else -heights.mean()
        allowed = f"below {limit:.17g}, full contact: the mean displacement is zero, {_zero_mean_reason(scene)}"
        raise InputError("approach", value, allowed)
