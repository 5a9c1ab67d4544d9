"""Leave out the share of peel where the edges of the contact have not moved enough to tell it."""

from __future__ import annotations

import xarray as xr

from contactsim.variables import GRID_ERROR

MIN_PEEL = 10.0
"""Smallest length that peels at both edges, in errors of the edges, at which a share of it means something."""


def leave_out_unresolved_peel(data: xr.Dataset) -> xr.Dataset:
    """Return slides whose `peel_asymmetry` is NaN where what peels is less than `MIN_PEEL` errors of the edges.

    The error of an edge is the change of what peels there on halving the grid. Other paths are returned as they are.
    """
    for suffix in ("_halfway", ""):
        name, edges = f"peel_asymmetry{suffix}", [f"{edge}_peel{suffix}" for edge in ("trailing", "leading")]
        if name not in data or any(f"{edge}{GRID_ERROR}" not in data for edge in edges):
            continue
        peel = data[edges[0]] + data[edges[1]]
        error = data[f"{edges[0]}{GRID_ERROR}"] + data[f"{edges[1]}{GRID_ERROR}"]
        data = data.assign({name: data[name].where(peel > MIN_PEEL * error)})
    return data
