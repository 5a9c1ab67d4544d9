"""How far the relation of contact area and load is from a straight line, and numbers to compare such curves by.

Adhesion makes loads negative where the area is large already, so that neither their ratio nor an exponent exists. What
does exist of every curve is the angle between area and load, taken as vectors over its states; a parabola through the
origin, load by area; the load at which an area is first reached; and the area at an approach.
"""

from __future__ import annotations

from itertools import takewhile

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.adhesion import legs
from contactsim.status import is_solved

LARGEST = 0.3
"""Relative area up to which a curve is held against a straight line: beyond, a contact begins to be complete."""
LEVELS = {"pressure_at_area_0_02": 0.02, "pressure_at_area_0_1": 0.1, "pressure_at_area_one_third": 1 / 3}
"""Relative areas at which the pressure is read."""
DEEP = 12.0
"""Approach (nm) beyond first touch at which the area is read."""
AREA_LOAD = (
    *("nonlinearity", "curvature", "nonlinearity_reduced", "curvature_reduced"),
    *LEVELS,
    *("area_at_12nm", "pressure_at_12nm", "gradient_ratio_at_area_0_02"),
)
"""What the curve of area against load amounts to; `_reduced` of p_r*, else of p/E*."""
KINDS = {
    "relative_interacting_area": "rms_gradient_interacting",
    "relative_contact_area": "rms_gradient_contact",
}
"""The area in question, of smooth laws and of a hard wall, and the gradient over it."""


def nonlinearity(area: Array, pressure: Array) -> float:
    """Sine of the angle between area and pressure (step,) as vectors: 0 on a straight line through the origin."""
    scale = np.sqrt((area**2).sum() * (pressure**2).sum())
    if area.size < 3 or not scale > 0:
        return np.nan
    return float(np.sqrt(max(1 - ((area * pressure).sum() / scale) ** 2, 0.0)))


def curvature(area: Array, pressure: Array) -> float:
    """Part of the square in the best p = b1 a + b2 a² at the largest area: 0 on a straight line, 1 without b1.

    area, pressure (step,). Signed: above zero the pressure rises faster than the area.
    """
    if area.size < 3 or not area.max() > 0:
        return np.nan
    share = area / area.max()
    line, square = np.linalg.lstsq(np.stack([share, share**2], axis=1), pressure, rcond=None)[0]
    return float(square / (abs(line) + abs(square))) if square else 0.0


def first_reached(area: Array, level: float, values: Array) -> float:
    """A value (step,) where the area (step,) first reaches a level, between states; NaN where it never does."""
    beyond = np.flatnonzero(area >= level)
    if not beyond.size or beyond[0] == 0:
        return np.nan
    after = beyond[0]
    share = (level - area[after - 1]) / (area[after] - area[after - 1])
    return float(values[after - 1] + share * (values[after] - values[after - 1]))


def curve_numbers(indentation: Array, area: Array, pressure: Array, gradient: Array, whole: float) -> tuple[float, ...]:
    """`AREA_LOAD` of one curve (step,); indentation: approach beyond first touch (nm); pressure over E*.

    gradient: over the contact, (step,); whole: over all of the surface. Of the loading leg, up to the first state that
    is unknown.
    """
    known = np.isfinite(pressure[legs(indentation)[0]])
    count = len(list(takewhile(bool, known)))
    indentation, area, pressure, gradient = (one[:count] for one in (indentation, area, pressure, gradient))
    few = (area > 0) & (area <= LARGEST) & np.isfinite(gradient)
    kinds = pressure[few], pressure[few] / gradient[few]
    found = [how(area[few], one) for one in kinds for how in (nonlinearity, curvature)]
    found += [first_reached(area, level, pressure) for level in LEVELS.values()]
    found += [first_reached(indentation, DEEP, one) for one in (area, pressure)]
    share = gradient / whole if whole > 0 else np.full_like(gradient, np.nan)
    return *found, first_reached(area, LEVELS["pressure_at_area_0_02"], share)


def related(data: xr.Dataset) -> xr.Dataset:
    """A study of paths with what its curves of area against load amount to; they end where one did not converge."""
    name = next(kind for kind in KINDS if kind in data)
    approach = data.approach
    pressure = data.normalised_pressure.where(is_solved(data.status))
    whole = data.rms_gradient.mean("step") if "step" in data.rms_gradient.dims else data.rms_gradient
    columns = xr.apply_ufunc(
        curve_numbers,
        *(approach - data.approach_first_touch, data[name], pressure, data[KINDS[name]], whole),
        input_core_dims=[["step"]] * 4 + [[]],
        output_core_dims=[[]] * len(AREA_LOAD),
        vectorize=True,
    )
    return data.assign(dict(zip(AREA_LOAD, columns, strict=True)))
