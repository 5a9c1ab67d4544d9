"""Rough adhesive contacts: curves of means through every state of a path, and what cycles of it amount to."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim import dataset
from contactsim.analysis.ensemble import converged
from contactsim.figures import style
from contactsim.observables.adhesion import LEGS, legs

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
WALL_LOOK = {"color": style.EXACT, "ls": "--", "lw": 1.0, "marker": "x"}
"""Looks of a hard wall beside adhesive contacts."""


def prepared(data: xr.Dataset) -> xr.Dataset:
    """With δ, the approach beyond first touch (nm), and of a hard wall the gradient in contact over all of it."""
    data = data.assign(indentation=data.approach - data.approach_first_touch)
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


def of_works(
    panel: Axes, data: xr.Dataset, wall: xr.Dataset, across: Callable[[xr.Dataset], xr.DataArray], name: str
) -> list[pd.DataFrame]:
    """One curve a work of separation, and that of the hard wall; across: what is along x, of a part of the data."""
    rows = []
    for work, color in works(data).items():
        one = data.sel(work_of_separation=work)
        rows.append(curve(panel, one, across(one), name, work_words(data, work), color=color, lw=1.0))
    return [*rows, curve(panel, wall, across(wall), name, "hard wall", **WALL_LOOK)]


def cycles(data: xr.Dataset, names: dict[str, Axes]) -> list[pd.DataFrame]:
    """Both legs of each rms height against the approach beyond first touch, of quantities in their panels."""
    rows = []
    for height, color in style.shades(data.surface_rms_height.values).items():
        one = data.sel(surface_rms_height=height).isel(member=0)
        indentation = (one.approach - one.approach_first_touch).values
        shown = {"rms_height": height, "indentation": indentation}
        for name, panel in names.items():
            shown[name] = converged(one[name], one).values
            for leg, part in zip(LEGS, legs(indentation), strict=True):
                part = slice(max(part.start - 1, 0), part.stop)
                words = rf"$h_{{\mathrm{{rms}}}}={height:g}$ nm" if leg == LEGS[0] else None
                look = {"color": color, "lw": 1.0, "ls": "-" if leg == LEGS[0] else "--", "label": words}
                panel.plot(indentation[part], shown[name][part], **look)
            panel.set(xlabel=LABELS["indentation"], ylabel=LABELS[name])
        rows.append(pd.DataFrame(shown))
    return rows


def against_height(
    panel: Axes, data: xr.Dataset, name: str, scale: float, words: str, color: str, fill: str
) -> dict[str, np.ndarray]:
    """Mean over members against the rms height; bars: standard error and what the increments leave open, together."""
    values, count = data[name], data[name].count("member")
    spread = values.std("member", ddof=1) / np.sqrt(count)
    error = np.hypot(spread, data[f"{name}_increment_error"].mean("member"))
    look = {"fmt": "o-", "ms": 4, "mfc": fill, "color": color, "lw": 0.8, "elinewidth": 0.8, "capsize": 1.5}
    mean = values.mean("member")
    panel.errorbar(data.surface_rms_height.values, scale * mean.values, scale * error.values, label=words, **look)
    return {f"{name}_mean": mean.values, f"{name}_error": error.values, f"{name}_members": count.values}


def against_pressure(panel: Axes, one: xr.Dataset, words: str, **look: object) -> pd.DataFrame:
    """Relative area against pressure."""
    return curve(panel, one, one.normalised_pressure_mean, "relative_interacting_area", words, lw=1.0, **look)


def pressures(panel: Axes) -> None:
    """Area against pressure, as far as the contact is not yet whole."""
    panel.set(xlabel=LABELS["normalised_pressure"], ylabel=LABELS["relative_interacting_area"])
    panel.set(xlim=reached(panel, -0.006, 0.03), ylim=(0, 1.02))
    panel.legend(loc="best", fontsize=6.5)


def reached(panel: Axes, least: float, most: float) -> tuple[float, float]:
    """The part of a range of pressures that curves reach, with a margin."""
    drawn = np.concatenate([np.asarray(line.get_xdata(), float) for line in panel.lines])
    drawn = drawn[np.isfinite(drawn) & (drawn > least) & (drawn < most)]
    margin = 0.06 * np.ptp(drawn)
    return max(drawn.min() - margin, least), min(drawn.max() + margin, most)
