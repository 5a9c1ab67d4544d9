"""Combine the datasets of single runs, and derive from their states the numbers that depend on several variables."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from typing import cast

import numpy as np
import xarray as xr

from contactsim.observables.adhesion import AREAS
from contactsim.observables.deformation import DEFORMATION, DEFORMATIONS, summarise_deformation
from contactsim.observables.friction import ONSET, SLIDE_INPUTS, summarise_slides
from contactsim.observables.hysteresis import CYCLE, summarise_cycles
from contactsim.observables.linearity import AREA_LOAD, summarise_area_load
from contactsim.observables.load_curve import dimensions_of
from contactsim.observables.path_summary import SUMMARY, SURFACE_SUMMARY, summarise_load_curves
from contactsim.observables.threshold import THRESHOLD

GRADIENT_RATIOS = {
    "gradient_ratio_repulsive": "rms_gradient_repulsive",
    "gradient_ratio_interacting_0_1": "rms_gradient_interacting_0_1",
    "gradient_ratio_interacting": "rms_gradient_interacting",
    "gradient_ratio_interacting_0_001": "rms_gradient_interacting_0_001",
    "gradient_ratio_interacting_1e_6": "rms_gradient_interacting_1e_6",
}
"""Rms gradients over parts of a surface, whose ratios to that over all of it are derived."""
RUN_ONLY_VARIABLES = ("contact_bits", "contact_pressure", "profile_real", "profile_imag", "point_digest")
"""Variables that stay with the single runs."""
EVERYTHING: frozenset[str] = frozenset(
    (*SUMMARY, *SURFACE_SUMMARY, *CYCLE, *DEFORMATION, *ONSET, *THRESHOLD, *AREA_LOAD)
)
"""All summaries of a path."""
SHARED_SCALARS = ("points", "length", "contact_modulus", "seed", "points_y", "length_y")
"""Variables that become scalars where all runs have the same value."""


def combine_runs(runs: Sequence[tuple[xr.Dataset, dict[str, object]]]) -> xr.Dataset:
    """Return one dataset of several runs.

    Parameters
    ----------
    runs
        The dataset of each run, and its coordinates: the values of the varied keys and the member.

    Returns
    -------
    Dataset with a dimension for each coordinate. Paths of unequal length are filled up with NaN.
    """
    for dim in ("step", "fold", "event"):  # paths of a study may differ in length, and in how often they jump or slip
        longest = max((data.sizes.get(dim, 0) for data, _ in runs), default=0)
        if any(data.sizes.get(dim, longest) < longest for data, _ in runs):
            runs = [(data.reindex({dim: np.arange(longest)}), coordinates) for data, coordinates in runs]
    expanded = [
        data.drop_vars([*RUN_ONLY_VARIABLES, *coordinates], errors="ignore").expand_dims(
            {name: [value] for name, value in coordinates.items()}
        )
        for data, coordinates in runs
    ]
    data = cast(
        xr.Dataset, xr.combine_by_coords(expanded, combine_attrs="drop", join="outer", compat="no_conflicts")
    )  # never an array, as datasets are given
    data.attrs["problem"] = runs[0][0].attrs["problem"]
    for name in set(SHARED_SCALARS) & set(data):
        if (data[name] == data[name].values.flat[0]).all():
            data[name] = data[name].values.flat[0]
    return data


def summarise_approaches(data: xr.Dataset) -> xr.Dataset:
    """Return approaches to a hard wall with their normalised pressure and the summary of their area-load curves."""
    data = data.assign(normalised_pressure=data.mean_pressure / data.contact_modulus)
    return summarise_area_load(data, "relative_contact_area", "rms_gradient_contact")


def summarise_paths(data: xr.Dataset, names: Container[str] = EVERYTHING) -> xr.Dataset:
    """Return cohesive paths with relative areas, normalised pressures and the summaries of their curves.

    Parameters
    ----------
    data
        Combined paths.
    names
        Summaries that are asked for; what none of them needs is not computed.
    """
    ratios = {name: data[length] / data.length for name, length in AREAS.items() if length in data}
    ratios |= {ratio: data[name] / data.rms_gradient for ratio, name in GRADIENT_RATIOS.items()}
    data = data.assign(ratios | {"normalised_pressure": data.mean_pressure / data.contact_modulus})
    for numbers, summarise in SUMMARIES:
        if any(name in names for name in numbers):
            data = summarise(data)
    return data


def _summarise_slides(data: xr.Dataset) -> xr.Dataset:
    """Return slides with their summaries, and paths that do not slide as they are."""
    return summarise_slides(data) if set(SLIDE_INPUTS) <= set(data) else data


def _summarise_deformation(data: xr.Dataset) -> xr.Dataset:
    """Return paths of lines with the numbers of their deformation, and paths of surfaces as they are."""
    return summarise_deformation(data) if DEFORMATIONS[dimensions_of(data)] else data


def _summarise_interaction(data: xr.Dataset) -> xr.Dataset:
    """Return paths with the summaries of interacting area against load."""
    return summarise_area_load(data, "relative_interacting_area", "rms_gradient_interacting")


SUMMARIES: tuple[tuple[tuple[str, ...], Callable[[xr.Dataset], xr.Dataset]], ...] = (
    ((*SUMMARY, *SURFACE_SUMMARY, *DEFORMATION), summarise_load_curves),
    (CYCLE, summarise_cycles),
    (DEFORMATION, _summarise_deformation),
    ((*ONSET, *THRESHOLD), _summarise_slides),
    (AREA_LOAD, _summarise_interaction),
)
"""Names of summaries of a path, and the function that computes them from the states and from those before."""
