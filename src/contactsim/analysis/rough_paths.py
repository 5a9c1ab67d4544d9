"""Paths of rough adhesive contacts: indentation, reduced pressure, means over members, savings by a simplification."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from contactsim.analysis.ensemble import converged
from contactsim.grid import Array
from contactsim.observables.linearity import values_at_loads
from contactsim.status import is_solved

EQUAL_PRESSURES = 60
"""Number of pressures at which curves are averaged."""
ENDS = ("mean", "standard_error")
"""Endings of the names of ensemble means and their errors."""
WALL_NAMES = {"relative_interacting_area": "relative_contact_area", "normalised_pressure": "normalised_pressure"}
"""Quantities of a hard wall that stand beside those of a cohesive law."""


def with_indentation(data: xr.Dataset) -> xr.Dataset:
    """Return a dataset of paths with `indentation`: the approach beyond first touch, nm, mean over all but the steps.

    A hard wall also gets the quantities of a cohesive law that it has under other names.
    """
    indentation = data.approach - data.approach_first_touch
    data = data.assign(indentation=indentation.mean([dim for dim in indentation.dims if dim != "step"]))
    return data.assign(_wall_quantities(data)) if "relative_contact_area" in data else data


def _wall_quantities(data: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the quantities of a hard wall by the names that they have with a cohesive law."""
    quantities = {f"{name}_{end}": data[f"{wall}_{end}"] for name, wall in WALL_NAMES.items() for end in ENDS}
    gradient = data.rms_gradient.mean("member")
    for end in ENDS:
        quantities[f"gradient_ratio_interacting_{end}"] = data[f"rms_gradient_contact_{end}"] / gradient
    return quantities


def on_full_grid(data: xr.Dataset) -> Array:
    """Return which states are solved on the full grid, bool (step,)."""
    if "solved_points" not in data:
        return np.ones(data.step.size, bool)
    others = [dim for dim in data.solved_points.dims if dim != "step"]
    return np.asarray((data.solved_points == data.solved_points.max()).all(others).values)


def reduced_pressure(data: xr.Dataset) -> xr.DataArray:
    """Return p_r* = p/(ḡ_r E*) of the ensemble means; data: of `with_indentation`."""
    gradient = data.rms_gradient.mean([dim for dim in data.rms_gradient.dims if dim != "step"])
    return data.normalised_pressure_mean / (data.gradient_ratio_interacting_mean * gradient)


@dataclass(frozen=True)
class EqualPressure:
    """Means over members at equal pressures where the load rises for the last time, and their standard errors.

    abscissa: what the area is plotted against; all (pressure,).
    """

    pressure: Array
    abscissa: Array
    abscissa_error: Array
    area: Array
    area_error: Array


def at_equal_pressure(data: xr.Dataset, reduced: bool, area: str, end: float) -> EqualPressure:
    """Return the area of one variant at `EQUAL_PRESSURES` even pressures, as far as all members reach them.

    Parameters
    ----------
    data
        Paths of one variant.
    reduced
        True for an abscissa of p_r*, the pressure over the gradient in the contact; else it is the pressure over E*.
    area
        Name of the area.
    end
        Largest pressure over E*.
    """
    pressure = converged(data.normalised_pressure, data).transpose("member", "step").values
    areas = data[area].transpose("member", "step").values
    gradient = _gradient(data).transpose("member", "step").values if reduced else np.ones_like(pressure)
    low = float(np.nanmin(pressure, axis=1).max())
    loads = np.linspace(low, min(float(np.nanmax(pressure, axis=1).min()), end), EQUAL_PRESSURES + 1)[1:]
    columns = (areas, pressure / gradient)
    rows = [[values_at_loads(p, row, loads) for p, row in zip(pressure, part, strict=True)] for part in columns]
    (area_mean, area_error), (mean, error) = (
        (np.mean(part, axis=0), np.std(part, axis=0, ddof=min(1, len(part) - 1)) / np.sqrt(len(part))) for part in rows
    )
    return EqualPressure(loads, mean, error, area_mean, area_error)


def _gradient(data: xr.Dataset) -> xr.DataArray:
    """Return the rms gradient over the contact: by the usual criterion, or at a hard wall."""
    return data["rms_gradient_interacting" if "rms_gradient_interacting" in data else "rms_gradient_contact"]


def states_of_all_members(data: xr.Dataset) -> Array:
    """Return the numbers of the states that every member has, (states,); a path may end at complete contact.

    A mean over the members that go on would be one of other surfaces at each state. data: paths of one variant
    """
    return np.flatnonzero(is_solved(data.status).all("member").values)


def member_mean(values: xr.DataArray) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the mean over members and its standard error."""
    return values.mean("member"), values.std("member", ddof=1) / np.sqrt(values.count("member"))


def mean_with_increments(data: xr.Dataset, name: str) -> tuple[Array, Array, Array]:
    """Return the mean of a quantity of paths over members, its error, and the number of members.

    The error is the standard error and the mean error of the increments, added in squares.
    """
    mean, spread = member_mean(data[name])
    error = np.hypot(spread, data[f"{name}_increment_error"].mean("member"))
    return mean.values, error.values, data[name].count("member").values


def relative_areas(data: xr.Dataset, lengths: list[str]) -> dict[str, xr.DataArray]:
    """Return lengths of contact, by several criteria, over the period; NaN where not converged."""
    return {name: converged(data[name], data) / data.length for name in lengths}


@dataclass(frozen=True)
class Saving:
    """Saved work and changed results of neglecting effects.

    transforms: without the neglected effects, check included; transforms_whole: with all effects; change_of_mean:
    relative change of the area at 12 nm, over the members of both; decision: the neglected effects.
    """

    transforms: float
    transforms_whole: float
    change_of_mean: float
    decision: str

    @classmethod
    def of(cls, simplified: xr.Dataset, whole: xr.Dataset) -> Saving:
        """Return the saving of a study without negligible effects, compared with the same study with all."""
        area, members = "area_at_12nm", simplified.member.values
        change = abs(simplified[area].mean("member") / whole[area].sel(member=members).mean("member") - 1)
        return cls(
            float(simplified.transforms.sum() + simplified.check_transforms.sum()),
            float(whole.transforms.sum()),
            float(change),
            str(simplified.decision.isel(member=0).item()),
        )

    @property
    def factor(self) -> float:
        """Return the work with all effects over that without the neglected ones."""
        return self.transforms_whole / self.transforms
