"""Made-up datasets and claims, with the numbers that tests ask for."""

from __future__ import annotations

import json

import numpy as np
import xarray as xr

from contactsim.study.claim_plan import read_claim
from contactsim.study.plan import Plan
from support.places import ROOT

PLAN = Plan.read(ROOT / "config", "quick")
STUDIES = {
    name: PLAN.studies[name]
    for name in ("smooth_line", "rough_line", "rough_line_many", "rough_surface", "surface_resolution")
}
PATHS = {name: PLAN.studies[name] for name in ("indentation", "indentation_uncoupled", "pull_off")}
PRESSURES = [0.001, 0.01, 0.1]
VALUE = {
    "source": "Section 0",
    "statement": "κ is 2.",
    "rationale": "A test.",
    "study": "rough_line",
    "quantity": "kappa",
    "reduce": "mean",
    "expect": 2.0,
    "tolerance": 0.1,
}
PULL = VALUE | {"study": "indentation", "quantity": "pull_off_load_loading", "expect": 15.0, "tolerance": 1.0}
BANDLESS = {"expect": None, "tolerance": None}


def claim(**changes):
    """The settings of a claim on rough lines as read, with some changed; None leaves a key out."""
    section = {key: value for key, value in (VALUE | changes).items() if value is not None}
    return read_claim("test", section, "ch3.yaml", STUDIES).settings


def path_claim(**changes):
    """The settings of a claim on paths as read, with some changed; None leaves a key out."""
    section = {key: value for key, value in (PULL | changes).items() if value is not None}
    return read_claim("test", section, "ch4.yaml", PATHS).settings


def made_up(level=2.0, scatter=0.0, grid=0.0, tilt=0.0, members=4, points=262144):
    """A dataset of rough lines: κ of a level, a scatter over members, a change of the grid and a slope in log p*."""
    offsets = scatter * np.linspace(-1, 1, members) if members > 1 else np.zeros(1)
    kappa = level + tilt * np.log10(np.array(PRESSURES) / 0.01) + np.zeros((2, 1, 1)) + offsets[:, None]
    dims = ("hurst_exponent", "member", "reduced_pressure")
    change = (("hurst_exponent", "reduced_pressure"), np.full((2, 3), grid))
    values = {
        "kappa": (dims, kappa),
        "relative_contact_area": (dims, kappa * PRESSURES),
        "status": (dims, np.zeros(kappa.shape, np.int8)),
        "kappa_grid_change": change,
        "kappa_grid_error": (change[0], abs(change[1])),
        "kappa_grid_change_standard_error": (change[0], np.zeros((2, 3))),
        "relative_contact_area_grid_change": (change[0], grid * np.tile(PRESSURES, (2, 1))),
        "points": points,
    }
    places = {"hurst_exponent": [0.2, 0.8], "member": range(members), "reduced_pressure": PRESSURES}
    surface = {"kind": "self_affine", "length": 160000.0, "short_cutoff": 39.0625}  # 262144 points: 64 a wavelength
    settings = {"surface": surface, "thesis_points": 262144, "coarse_grid": {"members": 3}}
    return xr.Dataset(values, places, {"problem": "hard_wall", "settings": json.dumps(settings)})


def with_corrected(data, level, change, subgrid):
    """The same dataset with a corrected κ, its change on halving the grid, and κ with edges between points."""
    return data.assign(
        kappa_corrected=data.kappa * 0 + level,
        kappa_subgrid=data.kappa * 0 + subgrid,
        kappa_corrected_grid_change=data.kappa_grid_change * 0 + change,
    )


def paths(values, grid=0.0, increment=None, **places):
    """A dataset of one path for each place, with a pull-off, its errors, and fields of a grid of its own."""
    values = np.asarray(values, float)
    variables = {
        "pull_off_load_loading": ((*places, "member"), values[..., None]),
        "pull_off_load_loading_grid_change": (tuple(places), np.full(values.shape, grid)),
        "status": ((*places, "member", "step"), np.zeros((*values.shape, 1, 5), np.int8)),
        "heights": ("x", np.zeros(int(values.size))),
    }
    if increment is not None:
        errors = np.full((*values.shape, 1), increment)
        variables["pull_off_load_loading_increment_error"] = ((*places, "member"), errors)
    settings = {"surface": {"kind": "cylinder"}, "thesis_points": 2048}
    coordinates = places | {"x": np.linspace(0, 1, values.size)}
    return xr.Dataset(variables, coordinates, {"problem": "hard_wall", "settings": json.dumps(settings)})
