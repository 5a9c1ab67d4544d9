"""Relative change of the results without an effect: one panel a cut through a map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.ticker import FuncFormatter

from contactsim import dataset
from contactsim.figures import style
from contactsim.figures.layout import empty_figure, save
from contactsim.variables import find_variable

PANELS_IN_ROW = 4
SMALLEST_CHANGE, LARGEST_CHANGE = 1e-4, 1.0
"""Ends of the colours."""
NUMBER_LOOK: dict[str, Any] = {"fontsize": 5.5, "ha": "center", "va": "center"}
DARK = 0.5
"""Lightness of a colour below which numbers on it are white."""
CONDITION_PAD = 14
"""Room between a panel and its title for conditions, points."""
CONTOURS = {0.01: ":", 0.05: "-"}
"""Lines of equal change."""
PER_CENT = FuncFormatter(lambda change, _: f"{100 * change:g} %")
RATIO_LABELS = {
    "spacing": "w/R",
    "strength": "φₙ/(δₙ E)",
    "stiffness": "E of the stiffer over the softer body",
    "thickness": "thickness over roll-off wavelength",
    "cutoff_ratio": "λₛ/λᵣ",
}
"""Labels of axes that are ratios of two or more keys."""


@mpl.rc_context(style.RC_PARAMS)
def write_effect_maps(plan: Mapping[str, Any], data: Sequence[str], targets: Mapping[str, str]) -> None:
    """Plot all cuts and write the files.

    Parameters
    ----------
    plan : of `contactsim.evaluation.effects.survey.maps_figure_job`
    data : paths of the maps, in the order of their names
    targets : png, pdf, svg and csv
    """
    maps = dict(zip(sorted(plan["titles"]), map(dataset.load_dataset, data), strict=True))
    cuts = plan["settings"]["panels"]
    scenes = sum(part.change_without.size for part in maps.values())
    footer = f"{plan['tier']} tier · {len(maps)} maps, {scenes} scenes, each with the effect and without"
    rows = -(-len(cuts) // PANELS_IN_ROW)
    figure, panels = empty_figure(plan["settings"] | {"panels": PANELS_IN_ROW}, footer, rows=rows)
    meshes = [
        plot_cut(panel, maps[cut["map"]], cut, plan["titles"][cut["map"]])
        for panel, cut in zip(panels, cuts, strict=False)
    ]
    for panel in panels[len(cuts) :]:
        panel.axis("off")
    figure.colorbar(
        meshes[-1], ax=panels, label="largest relative change without it", format=PER_CENT, shrink=0.7, pad=0.01
    )
    tables = [part.change_without.to_dataframe().reset_index().assign(map=name) for name, part in maps.items()]
    save(figure, pd.concat(tables), targets)


def plot_cut(axes: Axes, data: xr.Dataset, cut: Mapping[str, Any], title: str) -> QuadMesh:
    """Plot the change over two axes of a map, with its numbers in per cent.

    Parameters
    ----------
    axes : to plot on
    data : the map
    cut : its axes `across` and `up`, the values of the others in `at`, and texts of `conditions` with their places
    title : of the map
    """
    changes = data.change_without.sel(cut["at"], method="nearest").transpose(cut["up"], cut["across"])
    x, y = np.arange(changes.shape[1]), np.arange(changes.shape[0])
    values = np.clip(changes.values, SMALLEST_CHANGE, LARGEST_CHANGE)
    norm = LogNorm(SMALLEST_CHANGE, LARGEST_CHANGE)
    mesh = axes.pcolormesh(x, y, values, norm=norm, cmap="YlOrBr", shading="nearest")
    levels = [level for level in CONTOURS if values.min() < level < values.max()]
    if min(changes.shape) > 1 and levels:
        lines = {"colors": style.CONTACT, "linestyles": [CONTOURS[level] for level in levels]}
        axes.contour(x, y, np.log(values), np.log(levels), **lines)
    for (row, column), change in np.ndenumerate(changes.values):
        lightness = np.dot(mesh.to_rgba(values[row, column])[:3], (0.3, 0.6, 0.1))
        colour = "white" if lightness < DARK else style.EXACT
        axes.text(column, row, per_cent_text(change), color=colour, **NUMBER_LOOK)
    axes.set(xticks=x, yticks=y, xlabel=axis_label(cut["across"]), ylabel=axis_label(cut["up"]))
    axes.set_xticklabels([value_text(value) for value in changes[cut["across"]].values], fontsize=6)
    axes.set_yticklabels([value_text(value) for value in changes[cut["up"]].values], fontsize=6)
    axes.tick_params(length=0)
    fixed = ", ".join(f"{axis_label(name)} {value_text(value)}" for name, value in cut["at"].items())
    axes.set_title(
        f"{title}\n{fixed}" if fixed else title, fontsize=7, pad=CONDITION_PAD if cut["conditions"] else None
    )
    look = {"fontsize": 6.5, "color": style.CONTACT, "va": "bottom"}
    for text, place in cut["conditions"].items():
        axes.text(*place, text, transform=axes.transAxes, ha="right" if place[0] > 0.5 else "left", **look)
    return mesh


def axis_label(axis: str) -> str:
    """Return the label of an axis of a map."""
    return RATIO_LABELS.get(axis) or find_variable(axis).symbol or axis.replace("_", " ")


def per_cent_text(change: float) -> str:
    """Return a change in per cent with two digits; a dash if it is not known."""
    if not np.isfinite(change):
        return "–"
    return "<0.01" if change < 1e-4 else f"{float(f'{100 * change:.2g}'):g}"


def value_text(value: float) -> str:
    """Return a value of an axis; a small fraction as one over a whole number."""
    return f"1/{1 / value:.0f}" if 0 < value < 0.1 and abs(1 / value - round(1 / value)) < 1e-9 else f"{value:g}"
