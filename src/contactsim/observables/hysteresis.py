"""What a cycle of approach and retraction costs: the work that is put in and does not come back.

A path that begins and ends with surfaces apart is a closed loop of load against approach, and the area in it is what
the jumps have dissipated. Load is a force per unit thickness, so that area is an energy per unit thickness; over the
period it is an energy per area, to be held against a work of separation.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.status import is_solved

CYCLE = ("dissipated_energy", "dissipated_work")
"""What a cycle amounts to."""
APART = 0.02
"""Part of the largest pull below which the load at the ends of a path says that surfaces are apart."""


def dissipated(approach: Array, load: Array, jump: Array) -> tuple[float, float]:
    """Energy per unit thickness (nJ/m) that a cycle dissipates, and what the increments leave open of it.

    approach (nm), load (N/m) and jump, above zero where the surface jumped since the step before: (step,). By the
    trapezoidal rule along the path; a jump lies anywhere in its step, which leaves half of its rectangle open. NaN
    where surfaces are not apart at both ends, where the path never turns, and where a state is unknown.
    """
    if load.size < 3 or np.isnan(load).any() or approach[-1] >= approach.max():
        return np.nan, np.nan
    if np.abs(load[[0, -1]]).max() > APART * max(-load.min(), 0.0):
        return np.nan, np.nan
    steps, changes = np.diff(approach), np.diff(load)
    found = float(np.sum(steps * (load[1:] + load[:-1]) / 2))
    return found, float(np.sum(np.abs(steps * changes)[jump[1:] > 0]) / 2)


def cycled(data: xr.Dataset) -> xr.Dataset:
    """A study of paths with what its cycles amount to (`CYCLE`); states that did not converge leave it unknown."""
    converged = is_solved(data.status)
    energy, error = xr.apply_ufunc(
        dissipated,
        *(data.approach, data.line_load.where(converged), data.jump),
        input_core_dims=[["step"]] * 3,
        output_core_dims=[[], []],
        vectorize=True,
    )
    found = {"dissipated_energy": energy, "dissipated_work": energy / data.length}
    found |= {"dissipated_energy_increment_error": error, "dissipated_work_increment_error": error / data.length}
    return data.assign(found)
