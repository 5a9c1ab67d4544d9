"""A dataset in one line: its grid, members, unconverged solutions, largest errors and CPU time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import ArrayLike

from contactsim import dataset, status, variables
from contactsim.analysis import ensemble

FACTORS = ("kappa", "kappa_corrected", "kappa_r", "kappa_r_corrected")
SUMMARY_NAMES = {name: variables.RESULTS[name].phrase for name in FACTORS} | {
    "final_contact_length": "contact",
    "pull_off_load_loading": "pull-off on loading",
    "pull_off_load_unloading": "on unloading",
    "pull_off_force_loading": "pull-off on loading",
    "pull_off_force_unloading": "on unloading",
}
"""Quantities whose largest errors a summary gives, with their names in it."""
SLIDE_SUMMARY_NAMES = {
    name: variables.RESULTS[name].symbol for name in ("static_friction", "first_force_drop", "reattached_fraction")
}
"""The same for slides."""
ROUGH_SUMMARY_NAMES = {name: variables.RESULTS[name].phrase for name in ("area_at_12nm", "area_at_load_0_001")}
"""The same for paths of rough contacts."""


def grid_text(settings: Mapping[str, Any], *points: float) -> str:
    """Return the number of grid points, with the points for each shortest wavelength and the thesis's own.

    Parameters
    ----------
    settings : of a study, as its dataset stores them
    points : grid points along x, of each grid of the study
    """
    surface, thesis = settings["surface"], settings["thesis_points"]
    if settings.get("accuracy"):
        return f"{min(points):.0f} to {max(points):.0f} points, for an accuracy of {settings['accuracy']['error']:g}"
    grids = ", ".join(f"{count:.0f}" for count in points)
    if surface["kind"] != "self_affine":
        return f"{grids} points (thesis {thesis})" if thesis else f"{grids} points"
    share = surface["short_cutoff"] / surface["length"]
    thesis_text = f" (thesis {thesis * share:g})" if thesis else ""
    per_wavelength = ", ".join(f"{count * share:g}" for count in points)
    return f"{grids} points, {per_wavelength} per shortest wavelength{thesis_text}"


def sample_texts(data: xr.Dataset) -> list[str]:
    """Return grid, members and unconverged solutions of a dataset as short texts."""
    unconverged, total = ensemble.unconverged(data)
    members = data.member.size
    bridged = int(data.bridged_states.sum()) if "bridged_states" in data else 0
    bridged_text = f", {bridged} of them bridged" if bridged else ""
    return [
        grid_text(dataset.settings_of(data), *data.points.values.ravel()),
        f"{members} members" if members > 1 else "1 member",
        f"{unconverged} of {total} solutions unconverged{bridged_text}",
    ]


def dataset_summary(data: xr.Dataset, costs: pd.DataFrame) -> str:
    """Return tier, grid, members, unconverged solutions, largest errors and CPU time of a study in one line.

    Parameters
    ----------
    data : dataset of the study, or the part of it that a figure shows
    costs : table of the study's costs, with a column of seconds
    """
    settings = dataset.settings_of(data)
    parts = [f"{settings['tier']} tier, {settings['name'].replace('_', ' ')}", *sample_texts(data)]
    if "validity_flags" in data and (excess := status.describe_excess(data)):
        parts.append(f"beyond the model: {', '.join(excess)} of the states")
    return " · ".join([*parts, *error_texts(data), f"study solved in {seconds_text([costs])}"])


def sources_summary(data: Sequence[xr.Dataset], costs: Sequence[pd.DataFrame]) -> str:
    """Return tier, grids, members, unconverged solutions and CPU time of all studies of a figure in one short line."""
    tier = dataset.settings_of(data[0])["tier"]
    unconverged, total = (sum(counts) for counts in zip(*map(ensemble.unconverged, data), strict=True))
    members = [part.member.size for part in data]
    parts = [f"{tier} tier", _grids_text(data), f"{_range_text(members)} member{'s' if max(members) > 1 else ''}"]
    solved = f"{unconverged} of {total} unconverged" if unconverged else f"all {total} converged"
    return " · ".join([*parts, solved, seconds_text(costs)])


def _grids_text(data: Sequence[xr.Dataset]) -> str:
    """Return the grid of studies that share one, else the range of their grids."""
    settings = [dataset.settings_of(part) for part in data]
    grids = [part.points.values.ravel() for part in data]
    texts = {grid_text(own, *points) for own, points in zip(settings, grids, strict=True)}
    if len(texts) == 1:
        return texts.pop()
    text = f"{_range_text(np.concatenate(grids))} points"
    surfaces = [own["surface"] for own in settings]
    if any(surface["kind"] != "self_affine" for surface in surfaces):
        return text
    shares = [surface["short_cutoff"] / surface["length"] for surface in surfaces]
    counts = [points * share for points, share in zip(grids, shares, strict=True)]
    return f"{text}, {_range_text(np.concatenate(counts))} per shortest wavelength"


def _range_text(numbers: ArrayLike) -> str:
    """Return the least and the largest of some numbers, or the one that all are."""
    low, high = f"{np.min(numbers):.7g}", f"{np.max(numbers):.7g}"
    return low if low == high else f"{low} to {high}"


def seconds_text(costs: Sequence[pd.DataFrame]) -> str:
    """Return the CPU time of some tables of costs in words."""
    seconds = float(sum(table.seconds.sum() for table in costs))
    return f"{seconds:.0f} CPU s" if seconds >= 10 else f"{seconds:.2g} CPU s"


def error_texts(data: xr.Dataset) -> list[str]:
    """Return the largest errors of a dataset's main quantities, one text for each kind of error."""
    names = SLIDE_SUMMARY_NAMES if "static_friction" in data else SUMMARY_NAMES
    names = ROUGH_SUMMARY_NAMES if "area_at_12nm_by_repulsion" in data else names
    texts = []
    for error in variables.ERRORS:
        sizes = [
            f"{words} {float(data[f'{name}_{error}_error'].max()):.1g}{_unit_text(data[name])}"
            for name, words in names.items()
            if f"{name}_{error}_error" in data and not np.isnan(data[f"{name}_{error}_error"]).all()
        ]
        if sizes:
            texts.append(f"{error.replace('_', ' ')} error up to: {', '.join(sizes)}")
    return texts


def _unit_text(values: xr.DataArray) -> str:
    """Return the unit with a space before it, or nothing for a ratio."""
    unit = values.attrs.get("units", "1")
    return "" if unit == "1" else f" {unit}"
