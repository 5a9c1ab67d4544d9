"""Load curves of rough contacts at even approaches, on a half-space and on bodies of finite height.

The text gives no height of the body. On a half-space the mean displacement is zero by convention. A body of height h
adds p h/C11 to the approach. If it is half as high as the period, the longest wave is stiffer by 8 %. This is left out.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.linearity import APPROACH_LEVELS, solved_loading, value_at_level
from contactsim.status import is_solved

CHAPTER_4_HEIGHT = 5000.0
"""Height of the bodies of Chapter 4, nm."""
HEIGHTS = ("on_5um", "on_one_period", "on_two_periods")
"""Bodies: of Chapter 4's height, as high as the period, and twice as high."""
HEIGHT_NUMBERS = ("area_at_12nm", "pressure_at_20nm")
"""Numbers at an approach, which depends on the height of the body."""
BY_HEIGHT = tuple(f"{number}_{height}" for height in HEIGHTS for number in HEIGHT_NUMBERS)
"""Names of these numbers on each body."""
CURVE_APPROACHES = np.arange(1.0, APPROACH_LEVELS[1] + 1)
"""Approaches (nm) beyond first touch at which load curves are read."""
CURVE_DIMENSION = "curve_approach"
"""Dimension of load curves."""
CURVES = ("pressure_curve", *(f"pressure_curve_{height}" for height in HEIGHTS))
"""Mean pressure over E* at `CURVE_APPROACHES`, on a half-space and on each body."""
ERROR = "_increment_error"
"""End of the name of the error that increments leave in a number."""


def readings_on_bodies(data: xr.Dataset, uniaxial_modulus: float | None) -> dict[str, xr.DataArray]:
    """Return `BY_HEIGHT` and `CURVES` of paths, with the errors of their increments.

    uniaxial_modulus: C11, GPa; None where it is not known or varies, for the load curve on a half-space alone
    """
    area = data["relative_interacting_area" if "relative_interacting_area" in data else "relative_contact_area"]
    pressure = data.normalised_pressure.where(is_solved(data.status))
    indentation = data.approach - data.approach_first_touch
    bodies = {CURVES[0]: 0.0 * pressure}
    if uniaxial_modulus is not None:
        strain = pressure * data.contact_modulus / uniaxial_modulus
        heights = (CHAPTER_4_HEIGHT, data.length, 2 * data.length)
        bodies |= {curve: strain * height for curve, height in zip(CURVES[1:], heights, strict=True)}
    readings: dict[str, xr.DataArray] = {}
    for curve, compression in bodies.items():
        columns = xr.apply_ufunc(
            _read_on_body,
            *(indentation, compression, area, pressure),
            input_core_dims=[["step"]] * 4,
            output_core_dims=[["number"], [CURVE_DIMENSION]] * 2,
            vectorize=True,
        )
        for end, numbers, pressures in (("", *columns[:2]), (ERROR, *columns[2:])):
            readings[f"{curve}{end}"] = pressures.assign_coords({CURVE_DIMENSION: CURVE_APPROACHES})
            height = curve.removeprefix(CURVES[0])
            for place, name in enumerate(HEIGHT_NUMBERS if height else ()):
                readings[f"{name}{height}{end}"] = numbers[..., place]
    return readings


def _read_on_body(indentation: Array, compression: Array, area: Array, pressure: Array) -> tuple[Array, ...]:
    """Return `HEIGHT_NUMBERS` and a load curve of a path on loading, and their errors; all (step,).

    States that the body passes in a jump, because it is more compliant than the contact, are left out: the approach
    never falls back. The error of a number is its change without every second state, that of a curve the smaller of its
    changes without one or the other half of the states: at a solved state it is zero.

    compression: of the body, nm, which adds to the approach
    """
    pressure, approach, area = solved_loading(indentation, pressure, indentation + compression, area)
    rises = is_beyond_all_before(approach)
    approach, area, pressure = approach[rises], area[rises], pressure[rises]
    last_half, other_half = slice(int(approach.size % 2 == 0), None, 2), slice(int(approach.size % 2), None, 2)
    numbers, coarse = (
        np.array(
            [
                value_at_level(approach[part], level, column[part])
                for level, column in zip(APPROACH_LEVELS, (area, pressure), strict=True)
            ]
        )
        for part in (slice(None), last_half)
    )
    curve, *halves = (
        load_curve_at(approach[part], pressure[part], CURVE_APPROACHES) for part in (slice(None), last_half, other_half)
    )
    changes = [np.abs(half - curve) for half in halves]
    return numbers, curve, np.abs(coarse - numbers), np.fmin(*changes)


def is_beyond_all_before(approach: Array) -> Array:
    """Return which states of a path have a larger approach than all before them, bool (step,)."""
    return approach > np.concatenate(([-np.inf], np.maximum.accumulate(approach)[:-1]))


def load_curve_at(approach: Array, pressure: Array, levels: Array) -> Array:
    """Return the pressure at some approaches, interpolated by a monotone cubic; NaN beyond the curve.

    approach, pressure: (step,), the approach ascending
    """
    from scipy.interpolate import PchipInterpolator  # takes longer to import than to interpolate

    if approach.size < 2:
        return np.full(len(levels), np.nan)
    return PchipInterpolator(approach, pressure, extrapolate=False)(levels)
