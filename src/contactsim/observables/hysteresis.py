"""Measure the energy that a cycle of approach and retraction dissipates.

A path that begins and ends with separated surfaces is a closed loop of load against approach. Its area is the energy
that the jumps dissipate. A load is a force per unit thickness, so the area is an energy per unit thickness; over the
period it is an energy per area, comparable to a work of separation.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.load_curve import LoadCurve, curve_inputs

CYCLE = ("dissipated_energy", "dissipated_work")
"""Numbers that summarise a cycle."""
SEPARATED_LOAD = 0.02
"""Part of the largest pull below which the load at the ends of a path shows that the surfaces are separated."""


def dissipated_energy(curve: LoadCurve) -> tuple[float, float]:
    """Return the energy per unit thickness (nJ/m) that a cycle dissipates, and its error due to the increments.

    Returns
    -------
    Energy by the trapezoidal rule along the path, and half of the rectangle over the width of each jump, which may lie
    anywhere in it. NaN if the surfaces touch at either end, if the path never turns, or if a state is unknown.
    """
    approach, load = curve.approach, curve.load
    if load.size < 3 or np.isnan(load).any() or approach[-1] >= approach.max():
        return np.nan, np.nan
    if np.abs(load[[0, -1]]).max() > SEPARATED_LOAD * max(-load.min(), 0.0):
        return np.nan, np.nan
    steps, changes = np.diff(approach), np.diff(load)
    energy = float(np.sum(steps * (load[1:] + load[:-1]) / 2))
    return energy, float(np.sum(curve.width[1:] * np.abs(changes)) / 2)


def summarise_cycles(data: xr.Dataset) -> xr.Dataset:
    """Return paths with the numbers `CYCLE` of their cycles; NaN where a state did not converge."""

    def per_path(approach: Array, load: Array, jump: Array, *folds: Array) -> tuple[float, float]:
        """Return the energy of one cycle and its error."""
        return dissipated_energy(LoadCurve.from_states(approach, load, jump, folds))

    inputs, dimensions = curve_inputs(data)
    energy, error = xr.apply_ufunc(
        per_path,
        *inputs,
        input_core_dims=dimensions,
        output_core_dims=[[], []],
        vectorize=True,
    )
    numbers = {"dissipated_energy": energy, "dissipated_work": energy / data.length}
    numbers |= {"dissipated_energy_increment_error": error, "dissipated_work_increment_error": error / data.length}
    return data.assign(numbers)
