"""From a scene with a hard wall and a load step to a problem without units."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from contactsim.contact.grid_step import grid_step
from contactsim.contact.hard_wall import HardWallProblem, Profile, Scale
from contactsim.contact.scene import Scene
from contactsim.contact.steps import LoadStep
from contactsim.elasticity.fourier_operator import Compliance, FourierOperator, RadialSymbol
from contactsim.elasticity.free_operator import free_operator
from contactsim.errors import InputError, is_number
from contactsim.grid import Array, Grid, TransformCounter, blocks
from contactsim.traits import Trait

MIN_GRID_STEP = 1e-10
"""Smallest grid step that is no rounding, over p·spacing/E* or the approach; below it, these times it are the unit."""


def _without_units(scene: Scene, grid: Grid, heights: Array, unit: float, pressure: float) -> tuple[Any, float]:
    """Return the compliance over spacing/E* and that of the uniform mode; refuse units out of the range of numbers."""
    with np.errstate(over="ignore", under="ignore", divide="ignore", invalid="ignore"):
        flexibility = grid.spacing[-1] / np.float64(scene.contact_modulus)
        symbol, uniform, positive = _symbol(scene, flexibility, grid)
        largest = np.float64(heights.size) * max(unit / flexibility, pressure)
        extents = flexibility, largest, (heights.max() - heights.min()) / unit
    if not (np.isfinite(extents).all() and flexibility > 0 and positive):
        values = f"{grid.spacing[-1]:g}, {scene.contact_modulus:g}, {np.abs(heights).max():g}, {pressure:g}"
        allowed = "units in which heights, pressures and their ratios stay within the range of floating point"
        raise InputError("spacing, contact_modulus, heights, mean_pressure", values, allowed)
    return symbol, uniform


def _symbol(scene: Scene, flexibility: float, grid: Grid) -> tuple[Any, float, bool]:
    """Return the compliance over a flexibility, that of the uniform mode, and whether all others are positive."""

    def relative_compliance(wavenumber: Array) -> Array:
        """Return the compliance over the flexibility at each |q|."""
        return scene.compliance(wavenumber) / flexibility

    uniform = float(relative_compliance(np.zeros(1))[0])
    if len(grid.shape) == 1:
        line = grid.of_wavenumber(relative_compliance)
        return line, uniform, bool(np.isfinite(line).all() and (line[1:] > 0).all())
    symbol = RadialSymbol(grid, relative_compliance, uniform)
    return symbol, uniform, bool(np.isfinite(uniform) and _is_positive(symbol))


def _is_positive(symbol: RadialSymbol) -> bool:
    """Return True if a symbol is finite and positive at all |q| but zero."""
    parts = (replace(symbol, uniform=1.0).rows(low, high) for low, high in blocks(symbol.grid.shape))
    return all(np.isfinite(part).all() and (part > 0).all() for part in parts)


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
    is_free = not scene.repeats
    overlap = value + highest  # beyond first touch, if it is an approach
    pressure = step.value if step.control is Trait.MEAN_PRESSURE else None
    # A profile that is flat but for rounding has no grid step of its own: the displacement takes its place.
    with np.errstate(over="ignore"):  # refused below
        flexibility = float(grid.spacing[-1] / np.float64(scene.contact_modulus))
        reach = max(grid.shape) if is_free else 1  # a free body moves as a whole
        displacement = max(overlap, 0.0) if pressure is None else pressure * flexibility * reach
        unit = max(grid_step(heights), MIN_GRID_STEP * displacement) or flexibility
    symbol, uniform = _without_units(scene, grid, heights, unit, pressure or 0.0)
    scale = Scale(unit, unit / flexibility, highest)
    load = None if pressure is None else pressure / scale.pressure
    approach = overlap / unit if pressure is None else None
    counter = TransformCounter(heights.size)
    if is_free:
        compliance: Compliance = free_operator(grid, symbol, counter)
    else:
        if pressure is None:
            _check_full_contact(scene, heights, value, overlap, uniform)
        else:  # a uniform displacement does not change the gaps, and would only add rounding to them
            scale = replace(scale, mean_displacement=uniform * flexibility * pressure)
            symbol = _without_mean(symbol)
        compliance = FourierOperator(grid, symbol, counter)
    return HardWallProblem(Profile(heights, highest, unit), compliance, tolerance, load, approach, counter), scale


def _without_mean(symbol: Any) -> Any:
    """Return a compliance, an array of a line or the symbol of a surface, that does not move the mean."""
    if isinstance(symbol, RadialSymbol):
        return replace(symbol, uniform=0.0)
    symbol[0] = 0.0
    return symbol


def _check_full_contact(scene: Scene, heights: Array, value: float, overlap: float, uniform: float) -> None:
    """Refuse an approach beyond full contact where the compliance of the uniform mode is zero."""
    if uniform == 0 and overlap > 0 and value >= -heights.mean():
        limit = 0.0 if abs(heights.mean()) < 1e-12 * np.abs(heights).max() else -heights.mean()
        allowed = f"below {limit:.17g}, full contact: the mean displacement is zero, {_zero_mean_reason(scene)}"
        raise InputError("approach", value, allowed)
