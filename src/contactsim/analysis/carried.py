"""Counted areas and gradients carried from another grid to the thesis's own.

What counting points adds to the corrected number is of first order in the spacing of the grid (docs/continuum.md). So n
points in place of the thesis's N leave the part n/N of it on the thesis's grid.
"""

from __future__ import annotations

from typing import Any

import xarray as xr

from contactsim import dataset
from contactsim.analysis.ensemble import WIDENING
from contactsim.variables import GRID_CHANGE

SUFFIX = "_carried"
CARRIED = {f"{name}{SUFFIX}": name for name in ("relative_contact_area", "rms_gradient_contact", "kappa", "kappa_r")}
"""Counted quantities on the thesis's grid, and the same on the grid of the study."""


def carried_name(name: str) -> str:
    """Return the name of a counted quantity on the thesis's grid."""
    return f"{name}{SUFFIX}"


def grid_share(data: xr.Dataset) -> xr.DataArray:
    """Return the points of a study over those of the thesis."""
    return data.points / dataset.settings_of(data)["thesis_points"]


def carry(counted: Any, corrected: Any, share: Any) -> Any:
    """Return a counted number on the thesis's grid; share: points of its own grid over those of the thesis."""
    return corrected + share * (counted - corrected)


def carried_quantity(data: xr.Dataset, name: str) -> dict[str, xr.DataArray]:
    """Return a carried quantity and the change of its mean on halving the grid, zero on the thesis's own grid.

    data: with the counted and the corrected quantity of each member, and the changes of their means if they are known
    """
    counted, corrected = CARRIED[name], f"{CARRIED[name]}_corrected"
    share = grid_share(data)
    carried = carry(data[counted], data[corrected], share)
    mean, numbers = carried.mean("member"), {name: carried}
    if f"{counted}{WIDENING}" in data:
        numbers[f"{name}{WIDENING}"] = carry(data[f"{counted}{WIDENING}"], data[f"{corrected}{WIDENING}"], share)
    if (share == 1).all():
        return numbers | {f"{name}{GRID_CHANGE}": xr.zeros_like(mean)}
    if not {f"{counted}{GRID_CHANGE}", f"{corrected}{GRID_CHANGE}"} <= {*data}:
        return numbers
    coarse_counted, coarse_corrected = (
        data[part].mean("member") - data[f"{part}{GRID_CHANGE}"] for part in (counted, corrected)
    )
    return numbers | {f"{name}{GRID_CHANGE}": mean - carry(coarse_counted, coarse_corrected, share / 2)}
