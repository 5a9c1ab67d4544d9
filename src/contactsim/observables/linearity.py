"""Measure how far the relation of contact area and load is from a straight line.

Adhesion makes loads negative at large areas, so neither the ratio of area and load nor an exponent exists. A curve is
read where load rises with area, that is at the last crossing of a load: the area at a load, and the misfit of the best
straight line through the origin. Besides, the share of the square in a parabola of load against area, the load at a
given area, and area and load at a given approach.
"""

from __future__ import annotations

from itertools import takewhile

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.path_summary import legs
from contactsim.status import is_solved

MAX_AREA = 0.3
"""Largest relative area that a parabola is fitted to; beyond it a contact begins to be complete."""
AREA_LEVELS = {"pressure_at_area_0_02": 0.02, "pressure_at_area_0_1": 0.1, "pressure_at_area_one_third": 1 / 3}
"""Relative areas at which the pressure is read."""
LOAD_LEVELS = {"area_at_zero_load": 0.0, "area_at_load_0_001": 0.001, "area_at_load_0_003": 0.003}
"""Pressures over E* at which the area is read."""
APPROACH_LEVELS = 12.0, 20.0
"""Approaches (nm) beyond first touch at which area and pressure are read."""
REACHES = 0.001, 0.003
"""Pressures over E* up to which a curve is compared with a straight line."""
LINE_LOADS = 40
"""Number of evenly spaced loads at which a curve is compared with a straight line."""
AREA_LOAD = (
    *("nonlinearity", "nonlinearity_to_0_003", "nonlinearity_reduced", "nonlinearity_reduced_to_0_003"),
    *("curvature", "curvature_reduced"),
    *AREA_LEVELS,
    *LOAD_LEVELS,
    *("area_at_12nm", "pressure_at_12nm", "area_at_20nm", "pressure_at_20nm"),
    *("gradient_ratio_at_area_0_02", "gradient_ratio_2nm_after_contact"),
)
"""Numbers that summarise a curve of area against load; those with `_reduced` use p_r*, the others p/E*."""
FIRST_AREA, AFTER_CONTACT = 0.001, 2.0
"""Relative area at which a contact begins, and the approach (nm) after it at which the gradient is read."""
MIN_STATES = 3
"""Smallest number of states that a parabola is fitted to."""


def values_at_loads(pressure: Array, values: Array, loads: Array) -> Array:
    """Return values where the pressure last rises through each of some loads, interpolated; NaN where it never does.

    pressure, values: (step,). Before the last rise adhesive contacts carry the same load at other areas.
    """
    interpolated = np.full(len(loads), np.nan)
    for number, load in enumerate(loads):
        rises = np.flatnonzero((pressure[:-1] < load) & (pressure[1:] >= load))
        if rises.size:
            before = rises[-1]
            share = (load - pressure[before]) / (pressure[before + 1] - pressure[before])
            interpolated[number] = values[before] + share * (values[before + 1] - values[before])
    return interpolated


def nonlinearity(area: Array, pressure: Array, abscissa: Array, reach: float) -> float:
    """Return the rms misfit of the best line of area against an abscissa through the origin, over the largest area.

    Parameters
    ----------
    area
        Relative contact area, (step,).
    pressure
        Mean pressure over E*, (step,).
    abscissa
        What the area is plotted against: the pressure, or the reduced pressure, (step,).
    reach
        Pressure over E* up to which the curve is compared, at even distances from zero.

    Returns
    -------
    0 on a straight line through the origin; NaN for a curve that does not rise to all these loads.
    """
    loads = np.linspace(0, reach, LINE_LOADS + 1)[1:]
    areas, places = (values_at_loads(pressure, values, loads) for values in (area, abscissa))
    if not (np.isfinite(areas + places).all() and areas.max() > 0):
        return np.nan
    line = (areas * places).sum() / (places**2).sum()
    return float(np.sqrt(np.mean((areas - line * places) ** 2)) / areas.max())


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


def value_after_contact(approach: Array, area: Array, values: Array) -> float:
    """Return the value 2 nm after the relative area first is 0.001; all (step,).

    NaN for a path that begins with a larger area, or that ends before.
    """
    start = value_at_level(area, FIRST_AREA, approach)
    return np.nan if np.isnan(start) else value_at_level(approach, start + AFTER_CONTACT, values)


def bridge_gaps(columns: list[Array], share: float) -> list[Array]:
    """Return columns, (step,), with single unknown states between two known ones filled in.

    The state after was reached from the state before. What lies between, even a jump, lies between their values.

    Parameters
    ----------
    columns
        Pressure and other quantities; a state is unknown where the first is NaN.
    share
        Share of the state after in the value that is filled in; the rest is that of the state before.
    """
    known = np.isfinite(columns[0])
    alone = np.flatnonzero(~known[1:-1] & known[:-2] & known[2:]) + 1
    filled = [column.copy() for column in columns]
    for column in filled:
        column[alone] = (1 - share) * column[alone - 1] + share * column[alone + 1]
    return filled


def solved_loading(indentation: Array, pressure: Array, *others: Array) -> list[Array]:
    """Return pressure and other columns on loading up to the first unknown state; a single one is bridged.

    All (step,); a state is unknown where the pressure is NaN.
    """
    loading = legs(indentation)[0]
    columns = bridge_gaps([column[loading] for column in (pressure, *others)], 0.5)
    unknown = np.flatnonzero(np.isnan(columns[0]))
    end = int(unknown[0]) if unknown.size else columns[0].size
    return [column[:end] for column in columns]


def area_load_numbers(
    indentation: Array, area: Array, pressure: Array, gradient: Array, surface_gradient: float
) -> tuple[float, ...]:
    """Return the numbers `AREA_LOAD` of one curve, and the error that its increments leave in each.

    A curve is read on loading up to the first unknown state. A single unknown state is bridged by the mean of its
    neighbours. The error is the largest change if such a state is like one of them, or if every second state is left
    out.

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
    loading = legs(indentation)[0]
    approach, columns = indentation[loading], [column[loading] for column in (pressure, area, gradient)]
    before, number, after = (bridge_gaps(columns, share) for share in (0.0, 0.5, 1.0))
    coarse = [column[::-2][::-1] for column in number]  # every second state, the last one included
    readings = np.array([_read_curve(approach, filled, surface_gradient) for filled in (number, before, after)])
    halved = _read_curve(approach[::-2][::-1], coarse, surface_gradient)
    errors = np.abs(np.stack([*readings[1:], halved]) - readings[0])
    return *readings[0], *errors.max(axis=0)


def _read_curve(indentation: Array, columns: list[Array], surface_gradient: float) -> Array:
    """Return the numbers `AREA_LOAD` of a curve on loading up to the first unknown state.

    columns: pressure, area and gradient, (step,).
    """
    count = len(list(takewhile(bool, np.isfinite(columns[0]))))
    indentation, (pressure, area, gradient) = indentation[:count], (column[:count] for column in columns)
    reduced = np.divide(pressure, gradient, out=np.where(pressure == 0, 0.0, np.nan), where=gradient > 0)
    light = (area > 0) & (area <= MAX_AREA) & np.isfinite(gradient)
    numbers = [nonlinearity(area, pressure, x, reach) for x in (pressure, reduced) for reach in REACHES]
    numbers += [curvature(area[light], x[light]) for x in (pressure, reduced)]
    numbers += [value_at_level(area, level, pressure) for level in AREA_LEVELS.values()]
    numbers += values_at_loads(pressure, area, np.array(list(LOAD_LEVELS.values()))).tolist()
    numbers += [value_at_level(indentation, x, values) for x in APPROACH_LEVELS for values in (area, pressure)]
    ratio = gradient / surface_gradient if surface_gradient > 0 else np.full_like(gradient, np.nan)
    numbers += [value_at_level(area, AREA_LEVELS["pressure_at_area_0_02"], ratio)]
    return np.array([*numbers, value_after_contact(indentation, area, ratio)])


def summarise_area_load(data: xr.Dataset, area: str, gradient: str) -> xr.Dataset:
    """Return paths with the numbers `AREA_LOAD` of their curves of area against load, and their errors.

    `bridged_states` counts the single states without a solution between two with one.

    Parameters
    ----------
    data
        Paths; a curve ends at the first state that did not converge, unless that can be bridged.
    area, gradient
        Names of the relative area, and of the rms gradient over it.
    """
    pressure = data.normalised_pressure.where(is_solved(data.status))
    surface_gradient = data.rms_gradient.mean(set(data.rms_gradient.dims) & {"step"})
    columns = xr.apply_ufunc(
        area_load_numbers,
        *(data.approach - data.approach_first_touch, data[area], pressure, data[gradient], surface_gradient),
        input_core_dims=[["step"]] * 4 + [[]],
        output_core_dims=[[]] * 2 * len(AREA_LOAD),
        vectorize=True,
    )
    solved = is_solved(data.status)
    alone = ~solved & solved.shift(step=1, fill_value=False) & solved.shift(step=-1, fill_value=False)
    data = data.assign(bridged_states=alone.sum("step"))
    names = (*AREA_LOAD, *(f"{name}_increment_error" for name in AREA_LOAD))
    return data.assign(dict(zip(names, columns, strict=True)))
