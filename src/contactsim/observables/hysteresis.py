"""Measure the energy that a cycle of approach and retraction dissipates, on lines and surfaces.

A path that begins and ends with separated surfaces is a closed loop of load against approach. Its area is the energy
that the jumps dissipate. On a line a load is a force per unit thickness, so the area is an energy per unit thickness.
Over the period, or over the area of a surface, it is an energy per area, comparable to a work of separation.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.load_curve import LoadCurve, curve_inputs, dimensions_of

CYCLE = ("dissipated_energy", "dissipated_work")
"""Numbers that summarise a cycle on a line."""
SURFACE_CYCLE = ("dissipated_work",)
"""The same on a surface."""
CYCLES = {1: CYCLE, 2: SURFACE_CYCLE}
"""By the number of dimensions."""
SEPARATED_LOAD = 0.02
"""Part of the largest pull below which the load at the ends of a path shows that the surfaces are separated."""


def dissipated_energy(curve: LoadCurve) -> tuple[float, float]:
    """Return the energy (nJ/m, on a surface nN nm) that a cycle dissipates, and its error due to the increments.

    Returns
    -------
    Energy by the trapezoidal rule along the path, and half of the rectangle over the width of each jump, which may lie
    anywhere in it. Those of several jumps are added in squares, as they lie anywhere independently. NaN if the surfaces
    touch at either end, if the path never turns, or if a state is unknown.
    """
    approach, load = curve.approach, curve.load
    if load.size < 3 or np.isnan(load).any() or approach[-1] >= approach.max():
        return np.nan, np.nan
    if np.abs(load[[0, -1]]).max() > SEPARATED_LOAD * max(-load.min(), 0.0):
        return np.nan, np.nan
    steps, changes = np.diff(approach), np.diff(load)
    energy = float(np.sum(steps * (load[1:] + load[:-1]) / 2))
    return energy, float(np.sqrt(np.sum((curve.width[1:] * changes / 2) ** 2)))


def summarise_cycles(data: xr.Dataset) -> xr.Dataset:
    """Return paths with the numbers of their cycles; NaN where a state did not converge."""

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
    area = data.length * data.get("length_y", 1.0)  # of a line, that of a body of unit thickness
    sizes = {"dissipated_energy": xr.ones_like(area), "dissipated_work": area}
    names = CYCLES[dimensions_of(data)]
    numbers = {name: energy / sizes[name] for name in names}
    return data.assign(numbers | {f"{name}_increment_error": error / sizes[name] for name in names})
