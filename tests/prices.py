"""Small made datasets of an accuracy case: what jobs and a study give, without solving anything."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

LOADS = [0.01, 0.1]
SETTINGS = {"load": LOADS, "quantities": ["kappa_r"]}


def job(settings: Sequence[tuple], values: Sequence, transforms: Sequence | None = None) -> xr.Dataset:
    """A job's dataset: settings as (knob, points, tolerance), values of κ_r and transforms as (setting, load)."""
    dims, shape = ("setting", "reduced_pressure"), (len(settings), len(LOADS))
    values = np.broadcast_to(np.reshape(values, (len(settings), -1)), shape).astype(float)
    spent = np.ones(shape) if transforms is None else np.broadcast_to(np.reshape(transforms, (-1, 1)), shape)
    variables = {"kappa_r": (dims, values), "transforms": (dims, spent), "status": (dims, np.zeros(shape, np.int8))}
    for name, column in zip(("knob", "points", "tolerance"), zip(*settings, strict=True), strict=True):
        variables[name] = ("setting", list(column))
    return xr.Dataset(variables, {"reduced_pressure": LOADS})


def study(members: int = 3, points: int = 64) -> xr.Dataset:
    """A study's dataset: κ_r of 2 with a standard error of 0.02, and transforms that rise with the member."""
    shape = (members, len(LOADS))
    spent = np.broadcast_to(np.arange(1.0, members + 1)[:, None], shape)
    dims = ("member", "reduced_pressure")
    variables = {
        "kappa_r_mean": ("reduced_pressure", [2.0, 2.0]),
        "kappa_r_standard_error": ("reduced_pressure", [0.02, 0.02]),
        "transforms": (dims, spent),
        "status": (dims, np.zeros(shape, np.int8)),
        "points": points,
    }
    return xr.Dataset(variables, {"member": range(members), "reduced_pressure": LOADS})


REFERENCE = job([("points", 1024, 1e-6), ("tolerance", 32, 1e-6)], [2.0, 4.0])
"""The two references differ, so that errors against the wrong one are found out."""
