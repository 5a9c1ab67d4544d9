"""Measure how far the relation of contact area and load is from a straight line.

Adhesion makes loads negative at large areas, so neither the ratio of area and load nor an exponent exists. Four kinds
of numbers exist for every curve: the angle between area and load, taken as vectors over the states; the share of the
square in a parabola of load against area; the load at a given area; and area and load at a given approach.
"""

from __future__ import annotations

from itertools import takewhile

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.adhesion import legs
from contactsim.status import is_solved

MAX_AREA = 0.3
"""Largest relative area that is compared with a straight line; beyond it a contact begins to be complete."""
LEVELS = {"pressure_at_area_0_02": 0.02, "pressure_at_area_0_1": 0.1, "pressure_at_area_one_third": 1 / 3}
"""Relative areas at which the pressure is read."""
READING_DEPTH = 12.0
"""Approach (nm) beyond first touch at which area and pressure are read."""
AREA_LOAD = (
    *("nonlinearity", "curvature", "nonlinearity_reduced", "curvature_reduced"),
    *LEVELS,
    *("area_at_12nm", "pressure_at_12nm", "gradient_ratio_at_area_0_02"),
)
"""Numbers that summarise a curve of area against load; those with `_reduced` use p_r*, the others p/E*."""
MIN_STATES = 3
"""Smallest number of states that a curve is measured by."""


def nonlinearity(area: Array, pressure: Array) -> float:
    """Return the sine of the angle between area and pressure, (step,), as vectors.

    It is 0 on a straight line through the origin; NaN for fewer than three states.
    """
    scale = np.sqrt((area**2).sum() * (pressure**2).sum())
    if area.size < MIN_STATES or not scale > 0:
        return np.nan
    return float(np.sqrt(max(1 - ((area * pressure).sum() / scale) ** 2, 0.0)))


def curvature(area: Array, pressure: Array) -> float:
    """Return the share of the square in the best parabola p = b1 a + b2 a² at the largest area.

    area, pressure: (step,). It is 0 on a straight line and 1 without b1; positive if the pressure rises faster than
    the area; NaN for fewer than three states.
    """
    if area.size < MIN_STATES or not area.max() > 0:
        return np.nan
    share = area / area.max()
    line, square = np.linalg.lstsq(np.stack([share, share**2], axis=1), pressure, rcond=None)[0]
    return float(square / (abs(line) + abs(square))) if square else 0.0


def value_at_level(quantity: Array, level: float, values: Array) -> float:
    """Return the value where a quantity first reaches a level, interpolated; NaN if it never does; all (step,)."""
    reached = np.flatnonzero(quantity >= level)
    if not reached.size or reached[0] == 0:
        return np.nan
    after = reached[0]
    share = (level - quantity[after - 1]) / (quantity[after] - quantity[after - 1])
    return float(values[after - 1] + share * (values[after] - values[after - 1]))


def area_load_numbers(
    indentation: Array, area: Array, pressure: Array, gradient: Array, surface_gradient: float
) -> tuple[float, ...]:
    """Return the numbers `AREA_LOAD` of one curve, on loading up to the first unknown state.

    Parameters
    ----------
    indentation
        Approach beyond first touch, nm, (step,).
    area
        Relative contact area, (step,).
    pressure
        Mean pressure over E*, (step,).
    gradient
        Rms gradient over the contact, (step,).
    surface_gradient
        Rms gradient over all of the surface.
    """
    solved = np.isfinite(pressure[legs(indentation)[0]])
    count = len(list(takewhile(bool, solved)))
    indentation, area, pressure, gradient = (column[:count] for column in (indentation, area, pressure, gradient))
    light = (area > 0) & (area <= MAX_AREA) & np.isfinite(gradient)
    pressures = pressure[light], pressure[light] / gradient[light]
    numbers = [measure(area[light], values) for values in pressures for measure in (nonlinearity, curvature)]
    numbers += [value_at_level(area, level, pressure) for level in LEVELS.values()]
    numbers += [value_at_level(indentation, READING_DEPTH, values) for values in (area, pressure)]
    ratio = gradient / surface_gradient if surface_gradient > 0 else np.full_like(gradient, np.nan)
    return *numbers, value_at_level(area, LEVELS["pressure_at_area_0_02"], ratio)


def summarise_area_load(data: xr.Dataset, area: str, gradient: str) -> xr.Dataset:
    """Return paths with the numbers `AREA_LOAD` of their curves of area against load.

    Parameters
    ----------
    data
        Paths; a curve ends at the first state that did not converge.
    area, gradient
        Names of the relative area, and of the rms gradient over it.
    """
    pressure = data.normalised_pressure.where(is_solved(data.status))
    surface_gradient = data.rms_gradient.mean(set(data.rms_gradient.dims) & {"step"})
    columns = xr.apply_ufunc(
        area_load_numbers,
        *(data.approach - data.approach_first_touch, data[area], pressure, data[gradient], surface_gradient),
        input_core_dims=[["step"]] * 4 + [[]],
        output_core_dims=[[]] * len(AREA_LOAD),
        vectorize=True,
    )
    return data.assign(dict(zip(AREA_LOAD, columns, strict=True)))
