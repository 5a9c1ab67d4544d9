"""Counted areas and gradients carried from another grid to the thesis's own.

What counting points adds to the corrected number is of first order in the spacing of the grid (docs/continuum.md). So n
points in place of the thesis's N leave the part n/N of it on the thesis's grid.
"""

from __future__ import annotations

import xarray as xr

from contactsim import dataset
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


def carried_quantity(data: xr.Dataset, name: str) -> dict[str, xr.DataArray]:
    """Return a carried quantity and the change of its mean on halving the grid, zero on the thesis's own grid.

    data: with the counted and the corrected quantity of each member, and the changes of their means if they are known
    """
    counted, corrected = CARRIED[name], f"{CARRIED[name]}_corrected"
    share = grid_share(data)
    excess = data[counted] - data[corrected]
    carried = {name: data[corrected] + share * excess}
    if f"{counted}{GRID_CHANGE}" not in data:
        on_thesis_grid = bool((share == 1).all())
        return carried | ({f"{name}{GRID_CHANGE}": 0 * excess.mean("member")} if on_thesis_grid else {})
    change, change_corrected = (data[f"{part}{GRID_CHANGE}"] for part in (counted, corrected))
    carried_change = share / 2 * (excess.mean("member") + change) + (1 - share / 2) * change_corrected
    return carried | {f"{name}{GRID_CHANGE}": carried_change.where(share != 1, 0.0)}
