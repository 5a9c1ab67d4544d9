"""Rough adhesive contacts: curves of means through every state of a path, and pictures of the interface."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim import dataset
from contactsim.figures import style

MEANS = (
    "normalised_pressure",
    "relative_repulsive_area",
    "relative_interacting_area",
    "gradient_ratio_repulsive",
    "gradient_ratio_interacting",
)
LABELS = {
    "normalised_pressure": r"$p/E^*$",
    "relative_interacting_area": r"relative contact area $a_{\mathrm{rel}}$",
    "gradient_ratio_interacting": r"$\bar g_r/\bar g$",
    "indentation": r"$\delta$ (nm)",
}
WALL = {"relative_interacting_area": "relative_contact_area", "normalised_pressure": "normalised_pressure"}
"""What a hard wall has in the place of a law's quantities."""


def prepared(data: xr.Dataset) -> xr.Dataset:
    """With δ, the approach beyond first touch (nm), and of a hard wall the gradient in contact over all of it."""
    data = data.assign(indentation=(data.get("approach", data.get("approach_found")) - data.approach_first_touch))
    data["indentation"] = data.indentation.mean([dim for dim in data.indentation.dims if dim != "step"])
    if "relative_contact_area" not in data:
        return data
    ratio = data.rms_gradient_contact_mean / data.rms_gradient.mean("member")
    renamed = {f"{ours}_{kind}": data[f"{theirs}_{kind}"] for ours, theirs in WALL.items() for kind in ENDS}
    spread = data.rms_gradient_contact_standard_error / data.rms_gradient.mean("member")
    renamed |= {"gradient_ratio_interacting_mean": ratio, "gradient_ratio_interacting_standard_error": spread}
    return data.assign(renamed)


ENDS = ("mean", "standard_error")


def settled(one: xr.Dataset) -> np.ndarray:
    """Which states are solved on the whole grid, bool (step,)."""
    if "solved_points" not in one:
        return np.ones(one.step.size, bool)
    others = [dim for dim in one.solved_points.dims if dim != "step"]
    return (one.solved_points == one.solved_points.max()).all(others).values


def reduced(one: xr.Dataset) -> xr.DataArray:
    """p_r* = p/(ḡ_r E*), of means."""
    gradient = one.rms_gradient.mean([dim for dim in one.rms_gradient.dims if dim != "step"])
    return one.normalised_pressure_mean / (one.gradient_ratio_interacting_mean * gradient)


def curve(axes: Axes, one: xr.Dataset, x: xr.DataArray, name: str, words: str, **look: object) -> pd.DataFrame:
    """The means of all states as a line, those solved on the whole grid with symbols and standard errors."""
    marker = look.pop("marker", "o")
    y, error = one[f"{name}_mean"], one[f"{name}_standard_error"]
    axes.plot(x, y, **look)
    chosen = settled(one)
    known = error.values[chosen] if np.isfinite(error).any() else None
    symbols = {"fmt": marker, "ms": 3, "mfc": "white", "elinewidth": 0.8, "capsize": 1.5, "color": look["color"]}
    axes.errorbar(x.values[chosen], y.values[chosen], known, **symbols)
    axes.plot([], [], marker=marker, ms=3, mfc="white", label=words, **look)
    shown = {"case": words.replace("$", ""), "indentation": one.indentation, "x": x, "whole_grid": chosen}
    shown |= {f"{entry}_{kind}": one[f"{entry}_{kind}"] for entry in MEANS for kind in ENDS if f"{entry}_{kind}" in one}
    grid = f"{name}_grid_error"
    return pd.DataFrame(shown | ({grid: one[grid]} if grid in one else {}))


def interface(
    axes: Axes, one: xr.Dataset, place: float, looks: dict[str, str], part: slice, filled: bool = True
) -> pd.DataFrame:
    """The rigid profile and the deformed surface of one member at a snapshot, over a part of the period.

    filled: the profile grey; else a line in the colour of the surface alone, beside another that is grey.
    """
    here = one.isel(member=0).sel(snapshot=place, method="nearest", tolerance=style.SAME)
    x = here.x.values[part]
    down = float(here.approach_first_touch) + place
    rigid = -here.heights.values[part] - down
    surface = rigid - here.normal_gap.values[part]
    if filled:
        axes.fill_between(x, rigid, rigid.max() + 5.0, color="#cccccc", lw=0, zorder=0)
    axes.margins(x=0)
    axes.plot(x, rigid, color="#777777" if filled else looks["color"], lw=0.6, alpha=1.0 if filled else 0.5)
    axes.plot(x, surface, lw=0.9, **looks)
    return pd.DataFrame({"x": x, "rigid": rigid, "surface": surface})


def work_words(data: xr.Dataset, work: float) -> str:
    """φn* = φn/(δn E) of a work of separation."""
    settings = dataset.settings_of(data)
    length = settings[settings["effects"][0]]["normal_length"]
    return rf"$\varphi_n^*={work / (length * settings['body']['youngs_modulus']):.2g}$"


def work(data: xr.Dataset) -> float:
    """The work of separation of the first effect of a study that does not vary it (N/m)."""
    settings = dataset.settings_of(data)
    return settings[settings["effects"][0]]["work_of_separation"]


def works(data: xr.Dataset) -> dict[float, str]:
    """A colour for each work of separation."""
    return style.shades(np.atleast_1d(data.work_of_separation.values))
