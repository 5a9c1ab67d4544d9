"""Text about results: names and symbols of quantities, rounded values, grids, errors and the summary of a dataset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from contactsim import dataset, status, variables
from contactsim.analysis import ensemble

TINY = 1e-9
"""Numbers below it are written with a power of ten."""
FACTORS = ("kappa", "kappa_corrected", "kappa_r", "kappa_r_corrected")
SUMMARY_NAMES = {name: variables.RESULTS[name].phrase for name in FACTORS} | {
    "final_contact_length": "contact",
    "pull_off_load_loading": "pull-off on loading",
    "pull_off_load_unloading": "on unloading",
}
"""Quantities whose largest errors a summary gives, with their names in it."""
SLIDE_SUMMARY_NAMES = {
    name: variables.RESULTS[name].symbol for name in ("static_friction", "first_force_drop", "reattached_fraction")
}
"""The same for slides."""
ROUGH_SUMMARY_NAMES = {name: variables.RESULTS[name].phrase for name in ("area_at_12nm", "area_at_load_0_001")}
"""The same for paths of rough contacts."""
REDUCTION_PHRASES = {
    "kappa_fit": "κ of the fit to each H",
    "kappa_fit_logarithm": "κ of the logarithmic fit",
    "kappa_fit_all": "κ of the fit to all H",
    "spread_ratio": "ratio of spreads",
    "rise_gain": "gain of the rise",
    "least_rise_gain": "least gain of the rise",
    "largest_rise_gain": "largest gain of the rise",
}
"""Quantities and reductions of claims that no dataset holds."""
INDEX_LETTERS = {"κ_r": "κᵣ", "p_r*": "pᵣ*"}
"""Symbols of statements as they are printed."""


def rounded_texts(value: float, *errors: float) -> list[str]:
    """Return a value and its errors as texts, rounded as far as they are known.

    Errors have two digits. The value has as many decimals as the smallest error that is not zero, or four digits
    without one. A dash stands for NaN. A value that is zero but for rounding gets a power of ten.
    """
    if 0 < abs(value) < TINY:
        return [f"{number:.1e}" if np.isfinite(number) else "–" for number in (value, *errors)]
    decimals = {error: _decimals(error, 2) for error in errors if np.isfinite(error) and error > 0}
    finest = decimals[min(decimals)] if decimals else _decimals(value, 4)
    texts = [f"{value:.{finest}f}" if np.isfinite(value) else "–"]
    return texts + [f"{error:.{decimals.get(error, 0)}f}" if np.isfinite(error) else "–" for error in errors]


def _decimals(value: float, digits: int) -> int:
    """Return the number of decimals that show so many significant digits."""
    return max(0, digits - 1 - int(f"{abs(value):.{digits - 1}e}".split("e")[1])) if np.isfinite(value) else 0


def quantity_text(name: str) -> str:
    """Return a quantity's name as it is read in a sentence; an unknown word stays as it is."""
    errors = {f"_{kind}_error": f"{kind.replace('_', ' ')} error of " for kind in variables.ERRORS}
    for suffix, words in errors.items():
        if name.endswith(suffix):
            return words + quantity_text(name.removesuffix(suffix))
    return REDUCTION_PHRASES.get(name) or variables.find_variable(name).phrase or name


def range_text(dim: str, low: float, high: float) -> str:
    """Return the range of a load or of a varied key in words, such as "p* from 0.001 to 0.01"."""
    variable = variables.find_variable(dim)
    unit = "" if variable.unit == "1" else f" {variable.unit}"
    values = f"= {low:g}{unit}" if low == high else f"from {low:g} to {high:g}{unit}"
    return f"{variable.phrase or dim.replace('_', ' ')} {values}"


def measure_text(measure: str) -> str:
    """Return the measure of a claim with symbols in place of the names of quantities."""
    return " ".join(quantity_text(word).replace("_", " ") for word in measure.split())


def beside_text(row: Mapping[str, Any]) -> str:
    """Return the second row of a claim, which is not counted: quantity, number, errors and verdict; or nothing."""
    name = row.get("beside")
    if not isinstance(name, str) or not name:
        return ""
    numbers = rounded_texts(*(row[f"beside_{key}"] for key in ("value", "ensemble_error", "grid_error")))
    return f"{quantity_text(name)} {' ± '.join(numbers)}, {row['beside_verdict']}"


def choices_text(row: Mapping[str, Any]) -> str:
    """Return with how many admissible readings and sets of parameters a claim holds, and the default's verdict."""
    texts = [candidates_text(row)]
    if isinstance(row.get("choices"), str) and row["choices"]:
        count = int(row["choices_decided"])
        share = f"{row['choices_share']:.0%}" if count else "none"
        texts = [f"holds with {share} of {count} decided readings", *texts]
    texts = [text for text in texts if text]
    return "; ".join([*texts, f"as judged: {row['default_verdict']}"]) if texts else ""


def candidates_text(row: Mapping[str, Any]) -> str:
    """Return the shares of both sets of candidates in which a claim holds, with binomial errors; or nothing."""
    words = {"admitted": "admitted cells", "admitted_by_signs": "those with the signs of the text"}
    texts = [
        f"{row[f'{group}_share']:.0%} ± {row[f'{group}_error']:.0%} of {row[f'{group}_decided']:.0f} {name}"
        for group, name in words.items()
        if row.get(f"{group}_decided", 0.0) > 0
    ]
    return f"holds in {' and '.join(texts)}" if texts else ""


def printed(text: str) -> str:
    """Return a statement with its symbols as they are printed."""
    for plain, letters in INDEX_LETTERS.items():
        text = text.replace(plain, letters)
    return text


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
    """Return tier, grids, members, unconverged solutions and CPU time of several studies in one line."""
    settings = [dataset.settings_of(part) for part in data]
    parts = [f"{settings[0]['tier']} tier"]
    for own, part in zip(settings, data, strict=True):
        grid, members, _ = sample_texts(part)
        parts.append(f"{own['name'].replace('_', ' ')}: {grid}, {members}")
    unconverged, total = (sum(counts) for counts in zip(*map(ensemble.unconverged, data), strict=True))
    parts.append(f"{unconverged} of {total} solutions unconverged")
    return " · ".join([*parts, f"studies solved in {seconds_text(costs)}"])


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
