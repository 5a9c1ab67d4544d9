"""Stress inside the body below an adhesive contact, from the tractions that a dataset keeps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.elasticity.registry import make_elasticity
from contactsim.elasticity.subsurface import SubsurfaceFields, subsurface_fields
from contactsim.grid import Grid

DEPTHS, MARGIN = 81, 1.2
"""Number of depths, and the largest of them over the length of contact, which also bounds the positions."""


def stress_below_contact(state: xr.Dataset) -> SubsurfaceFields:
    """Return displacement and stress in the lower body around the contact (Section 2.2).

    Parameters
    ----------
    state : one snapshot of one path, with tractions (x), heights (x) and the contact length at the end of the path

    Returns
    -------
    fields : positions (nm) from the highest point of the upper surface, depths from the surface down
    """
    grid = Grid((state.x.size,), (float(state.length),))
    shift = state.x.size // 2 - int(np.argmax(state.heights.values))
    traction = np.stack([np.roll(state[f"{name}_traction"].values, shift) for name in ("normal", "tangential")])
    reach = MARGIN * float(state.final_contact_length)
    middle = grid.positions()[state.x.size // 2]
    body = make_elasticity(**dataset.settings_of(state)["body"])
    fields = subsurface_fields(body, grid, traction, np.linspace(0.0, reach, DEPTHS)).between(
        middle - reach, middle + reach
    )
    return replace(fields, position=fields.position - middle)
