"""Small made datasets of an accuracy case: what jobs and a study give, without solving anything."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from contactsim.contact.problem_kind import ProblemKind
from contactsim.observables.adhesion import GRADIENTS
from contactsim.observables.load_curve import join_folds

LOADS = [0.01, 0.1]
WALL, COHESIVE = ({"problem": kind.value} for kind in (ProblemKind.HARD_WALL, ProblemKind.COHESIVE))
SETTINGS = {"load": LOADS, "quantities": ["kappa_r"]}


def job(settings: Sequence[tuple], values: Sequence, transforms: Sequence | None = None) -> xr.Dataset:
    """A job's dataset: settings as (knob, points, tolerance), values of κ_r and transforms as (setting, load)."""
    dims, shape = ("setting", "reduced_pressure"), (len(settings), len(LOADS))
    values = np.broadcast_to(np.reshape(values, (len(settings), -1)), shape).astype(float)
    spent = np.ones(shape) if transforms is None else np.broadcast_to(np.reshape(transforms, (-1, 1)), shape)
    variables = {"kappa_r": (dims, values), "transforms": (dims, spent), "status": (dims, np.zeros(shape, np.int8))}
    for name, column in zip(("knob", "points", "tolerance"), zip(*settings, strict=True), strict=True):
        variables[name] = ("setting", list(column))
    return xr.Dataset(variables, {"reduced_pressure": LOADS}, WALL)


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
        "contact_modulus": 1.0,
    }
    ends = ("", "_corrected", "_subgrid", "_pairs")
    inputs = ["mean_pressure", *(f"rms_gradient_contact{end}" for end in ends)]
    inputs += [f"relative_contact_area{end}" for end in ends[:-1]]
    variables |= {name: (dims, np.ones(shape)) for name in inputs}
    return xr.Dataset(variables, {"member": range(members), "reduced_pressure": LOADS}, WALL)


def path_job(settings: Sequence[tuple], values: Sequence, transforms: Sequence | float = 1.0) -> xr.Dataset:
    """A job's dataset on a path of one member: settings as (knob, points, tolerance, increment), one value each."""
    dims, shape = ("setting", "member"), (len(settings), 1)
    spent = np.broadcast_to(np.reshape(transforms, (-1, 1)), shape).astype(float)
    variables = {
        "pull_off_load_loading": (dims, np.reshape(values, shape).astype(float)),
        "transforms": (dims, spent),
        "status": (dims, np.zeros(shape, np.int8)),
    }
    for name, column in zip(("knob", "points", "tolerance", "increment"), zip(*settings, strict=True), strict=True):
        variables[name] = ("setting", list(column))
    return xr.Dataset(variables, {"member": [0]}, COHESIVE)


def path_study(pulls: Sequence[float], points: int = 64) -> xr.Dataset:
    """A study's dataset of paths of three steps, 10 transforms each; the largest pull of each member, N/m."""
    shape = (len(pulls), 3)
    load = np.zeros(shape)
    load[:, 1] = -np.asarray(pulls)
    dims = ("member", "step")
    states = {"line_load": load, "approach": np.broadcast_to([-1.0, 0.0, 1.0], shape)}
    states |= {name: np.ones(shape) for name in ("contact_length", "repulsive_load", "adhesive_load")}
    states |= {name: np.ones(shape) for name in ("max_pressure", "max_tensile_traction", "jump")}
    states |= {"transforms": np.full(shape, 10.0), "status": np.zeros(shape, np.int8)}
    of_area = ("interacting_length_0_01", "rms_gradient_repulsive", *GRADIENTS, "rms_gradient")
    states |= {name: np.ones(shape) for name in of_area} | {"mean_pressure": load / 1000.0}
    variables = {name: (dims, value) for name, value in states.items()}
    variables |= {"points": points, "length": 1000.0, "contact_modulus": 1.0, "approach_first_touch": 0.0}
    data = xr.Dataset(variables, {"member": range(len(pulls)), "step": range(3)}, COHESIVE)
    return data.merge(join_folds([]))


REFERENCE = job([("points", 1024, 1e-6), ("tolerance", 32, 1e-6)], [2.0, 4.0])
"""The two references differ, so that errors against the wrong one are found out."""
PATH_SETTINGS = {"load": None, "quantities": ["pull_off_load_loading"]}
PATH_REFERENCE = path_job(
    [("points", 1024, 1e-6, 0.5), ("tolerance", 32, 1e-6, 0.5), ("increment", 32, 1e-3, 0.02)], [200.0, 100.0, 50.0]
)
"""So do the three of a path."""
