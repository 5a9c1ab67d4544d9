"""Measure the energy that a cycle of approach and retraction dissipates.

A path that begins and ends with separated surfaces is a closed loop of load against approach. Its area is the energy
that the jumps dissipate. A load is a force per unit thickness, so the area is an energy per unit thickness; over the
period it is an energy per area, comparable to a work of separation.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.status import is_solved

CYCLE = ("dissipated_energy", "dissipated_work")
"""Numbers that summarise a cycle."""
SEPARATED_LOAD = 0.02
"""Part of the largest pull below which the load at the ends of a path shows that the surfaces are separated."""


def dissipated_energy(approach: Array, load: Array, jump: Array) -> tuple[float, float]:
    """Return the energy per unit thickness (nJ/m) that a cycle dissipates, and its error due to the increments.

    Parameters
    ----------
    approach
        Approach, nm, (step,).
    load
        Load, N/m, (step,).
    jump
        Distance that the surface jumped since the step before, nm, (step,).

    Returns
    -------
    Energy by the trapezoidal rule along the path, and half of the rectangle of each step with a jump, which may lie
    anywhere in it. NaN if the surfaces touch at either end, if the path never turns, or if a state is unknown.
    """
    if load.size < 3 or np.isnan(load).any() or approach[-1] >= approach.max():
        return np.nan, np.nan
    if np.abs(load[[0, -1]]).max() > SEPARATED_LOAD * max(-load.min(), 0.0):
        return np.nan, np.nan
    steps, changes = np.diff(approach), np.diff(load)
    energy = float(np.sum(steps * (load[1:] + load[:-1]) / 2))
    return energy, float(np.sum(np.abs(steps * changes)[jump[1:] > 0]) / 2)


def summarise_cycles(data: xr.Dataset) -> xr.Dataset:
    """Return paths with the numbers `CYCLE` of their cycles; NaN where a state did not converge."""
    energy, error = xr.apply_ufunc(
        dissipated_energy,
        *(data.approach, data.line_load.where(is_solved(data.status)), data.jump),
        input_core_dims=[["step"]] * 3,
        output_core_dims=[[], []],
        vectorize=True,
    )
    numbers = {"dissipated_energy": energy, "dissipated_work": energy / data.length}
    numbers |= {"dissipated_energy_increment_error": error, "dissipated_work_increment_error": error / data.length}
    return data.assign(numbers)
