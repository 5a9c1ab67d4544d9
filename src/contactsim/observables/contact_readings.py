"""Numbers of paths through rough contacts by other readings of the text, above all of what is contact.

The text counts as contact what exceeds "a threshold approaching zero". Names of these numbers are those of
`contactsim.observables.linearity` with the criterion behind. On the body's height see
`contactsim.observables.body_readings`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.body_readings import BY_HEIGHT, CURVES, ERROR, readings_on_bodies
from contactsim.observables.linearity import (
    APPROACH_LEVELS,
    LOAD_LEVELS,
    solved_loading,
    summarise_area_load,
    value_at_level,
    values_at_loads,
)
from contactsim.observables.path_summary import TURN_TOLERANCE
from contactsim.status import is_solved

CRITERIA = {
    "by_repulsion": ("contact_length", "rms_gradient_repulsive"),
    "above_0_1": ("interacting_length_0_1", "rms_gradient_interacting_0_1"),
    "above_0_001": ("interacting_length_0_001", "rms_gradient_interacting_0_001"),
    "above_1e_6": ("interacting_length_1e_6", "rms_gradient_interacting_1e_6"),
}
"""Length of contact and gradient over it by each criterion beside that of a hundredth of the strength."""
CRITERION_NUMBERS = (
    *("nonlinearity", "nonlinearity_reduced", "area_at_zero_load", "area_at_load_0_001"),
    *("area_at_12nm", "area_at_20nm", "gradient_ratio_at_area_0_02", "gradient_ratio_2nm_after_contact"),
)
"""Numbers that depend on the criterion."""
BY_CRITERION = tuple(f"{number}_{criterion}" for criterion in CRITERIA for number in CRITERION_NUMBERS)
"""Names of the numbers by each criterion."""
AT_LOAD = ("mean_gap_at_load_0_001",)
AT_APPROACH = {
    "touching_peaks": "touching_peaks_at_20nm",
    "conformity_long": "conformity_at_20nm_long",
    "conformity_short": "conformity_at_20nm_short",
}
"""Further numbers of rough contacts: the gap at a load, and numbers of a state that are read at an approach."""
BY_WAVES = ("conformity_at_20nm_contrast", "gap_at_20nm_long_over_short")
"""Short waves against long ones: the difference of what is followed, and the ratio of what is not."""
UP_TO_APPROACH = {"rms_slip": "rms_slip_to_20nm", "slipped_share": "slipped_share_to_20nm"}
"""Largest numbers of a state on loading up to 20 nm, where a law reads the tangential gap."""
READINGS = (*BY_CRITERION, *CURVES, *BY_HEIGHT, *AT_LOAD, *AT_APPROACH.values(), *BY_WAVES, *UP_TO_APPROACH.values())
"""Names of all these numbers."""


@dataclass(frozen=True)
class RoughPath:
    """What decides which numbers a path through a rough contact has.

    Parameters
    ----------
    adheres
        True where surfaces interact across a gap, False at a hard wall.
    slips
        True where a law reads the tangential gap.
    uniaxial_modulus
        Stiffness C11 of the one half-space that all paths are pressed into, GPa; None where there are several, or
        where it is not known.
    """

    adheres: bool
    slips: bool
    uniaxial_modulus: float | None = None

    @property
    def reading_names(self) -> set[str]:
        """Names of the numbers that such a path has."""
        names = {*BY_CRITERION, *AT_LOAD, CURVES[0]}
        names |= {*AT_APPROACH.values(), *BY_WAVES} if self.adheres else set()
        names |= {*UP_TO_APPROACH.values()} if self.slips else set()
        return names | ({*CURVES, *BY_HEIGHT} if self.uniaxial_modulus is not None else set())


def summarise_readings(data: xr.Dataset, path: RoughPath) -> xr.Dataset:
    """Return paths with the numbers that they have, and the errors of their increments."""
    data = data.assign(numbers_by_criterion(data))
    data = data.assign(_read_loading(data, "mean_gap", AT_LOAD[0], _gap_at_load))
    if path.adheres and set(AT_APPROACH) <= set(data):
        for name, number in AT_APPROACH.items():
            data = data.assign(_read_loading(data, name, number, _value_at_approach))
        data = data.assign(_compare_waves(data))
    if path.slips:
        for name, number in UP_TO_APPROACH.items():
            data = data.assign(_read_loading(data, name, number, _largest_up_to_approach))
    return data.assign(readings_on_bodies(data, path.uniaxial_modulus))


def numbers_by_criterion(data: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return `BY_CRITERION` and their errors; at a hard wall all criteria are the same."""
    numbers: dict[str, xr.DataArray] = {}
    for criterion, (length, gradient) in CRITERIA.items():
        curves = data
        if length in data:
            areas = data.assign(area_by_criterion=data[length] / data.length)
            curves = summarise_area_load(areas, "area_by_criterion", gradient)
        for name in CRITERION_NUMBERS:
            numbers |= {f"{name}_{criterion}{end}": curves[f"{name}{end}"] for end in ("", ERROR)}
    return numbers


def _read_loading(
    data: xr.Dataset, name: str, number: str, read: Callable[[Array, Array, Array], float]
) -> dict[str, xr.DataArray]:
    """Return one number of each path on loading, and its change without every second state.

    Parameters
    ----------
    data
        Paths.
    name
        Quantity of a state that is read.
    number
        Name of the number.
    read
        Function of the mean pressure over E*, of the approach beyond first touch, and of the quantity, (step,).
    """

    def per_path(indentation: Array, pressure: Array, values: Array) -> tuple[float, float]:
        """Return the number and its change."""
        columns = solved_loading(indentation, pressure, indentation, values)
        value = read(*columns)
        return value, abs(read(*(column[::-2][::-1] for column in columns)) - value)

    columns = xr.apply_ufunc(
        per_path,
        data.approach - data.approach_first_touch,
        data.normalised_pressure.where(is_solved(data.status)),
        data[name],
        input_core_dims=[["step"]] * 3,
        output_core_dims=[[], []],
        vectorize=True,
    )
    return dict(zip((number, f"{number}{ERROR}"), columns, strict=True))


def _gap_at_load(pressure: Array, indentation: Array, gap: Array) -> float:
    """Return the mean gap where the load last rises through 0.001 E*."""
    return float(values_at_loads(pressure, gap, np.array([LOAD_LEVELS["area_at_load_0_001"]]))[0])


def _value_at_approach(pressure: Array, indentation: Array, values: Array) -> float:
    """Return a quantity at 20 nm beyond first touch."""
    return value_at_level(indentation, APPROACH_LEVELS[1], values)


def _largest_up_to_approach(pressure: Array, indentation: Array, values: Array) -> float:
    """Return the largest value up to 20 nm beyond first touch; NaN for a path that ends before."""
    last = APPROACH_LEVELS[1] + TURN_TOLERANCE
    is_reached = indentation.size > 0 and indentation[-1] >= last - 2 * TURN_TOLERANCE
    return float(values[indentation <= last].max()) if is_reached else np.nan


def _compare_waves(data: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return `BY_WAVES` and their errors, those of the two conformities in quadrature."""
    long, short = AT_APPROACH["conformity_long"], AT_APPROACH["conformity_short"]
    left = {name: 1 - data[name] for name in (long, short)}
    contrast, ratio = BY_WAVES
    numbers = {contrast: data[short] - data[long], ratio: left[long] / left[short]}
    errors = {name: data[f"{name}{ERROR}"] for name in (long, short)}
    numbers[f"{contrast}{ERROR}"] = (errors[short] ** 2 + errors[long] ** 2) ** 0.5
    squares = [(errors[name] / left[name]) ** 2 for name in (short, long)]
    numbers[f"{ratio}{ERROR}"] = numbers[ratio] * sum(squares) ** 0.5
    return numbers
