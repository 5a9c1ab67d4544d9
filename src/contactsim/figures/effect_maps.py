"""What leaving effects out changes, drawn: one panel a cut through a map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from contactsim import dataset
from contactsim.figures.render import framed, save

COLUMNS = 4
LEAST, MOST = 1e-4, 1.0
"""Ends of the colours."""
LINES = {0.01: ":", 0.05: "-"}
NAMES = {
    "poisson_ratio": "Poisson's ratio ν",
    "work_ratio": "φt/φn",
    "spacing": "w/R",
    "strength": "φn/(δn E)",
    "stiffness": "E of the stiffer over the softer body",
    "thickness": "thickness over roll-off wavelength",
    "hurst": "Hurst exponent H",
    "finest": "λs/λr",
}


def render(plan: Mapping, data: Sequence[str], targets: Mapping[str, str]) -> None:
    """Draw all panels into their files; plan: of `contactsim.effect_maps.figure`; data: the maps, in order."""
    maps = dict(zip(plan["titles"], map(dataset.read, data), strict=True))
    panels = plan["settings"]["panels"]
    rows = -(-len(panels) // COLUMNS)
    places = sum(one.change_without.size for one in maps.values())
    footer = f"{plan['tier']} tier · {len(maps)} maps, {places} scenes, each with the effect and without"
    figure, axes = framed(plan["settings"] | {"panels": COLUMNS}, footer, rows=rows)
    shown = None
    for panel, one in zip(axes, panels, strict=False):
        shown = draw(panel, maps[one["map"]], one, plan["titles"][one["map"]])
    for panel in axes[len(panels) :]:
        panel.axis("off")
    figure.colorbar(shown, ax=axes, label="largest relative change without it", shrink=0.7, pad=0.01)
    tables = [one.change_without.to_dataframe().reset_index().assign(map=name) for name, one in maps.items()]
    save(figure, pd.concat(tables), targets)


def draw(axes: Axes, data: xr.Dataset, panel: Mapping, title: str):
    """One cut: the change over two axes of the map, at values of the others."""
    cut = data.change_without.sel(panel["at"], method="nearest").transpose(panel["up"], panel["across"])
    x, y = np.arange(cut.shape[1]), np.arange(cut.shape[0])
    values = np.clip(cut.values, LEAST, MOST)
    shown = axes.pcolormesh(x, y, values, norm=LogNorm(LEAST, MOST), cmap="magma_r", shading="nearest")
    if min(cut.shape) > 1:
        found = [level for level in LINES if values.min() < level < values.max()]
        if found:
            axes.contour(
                x, y, np.log(values), np.log(found), colors="#1f4e9c", linestyles=[LINES[one] for one in found]
            )
    for row in y:
        for column in x:
            dark = values[row, column] > 0.05
            text = f"{100 * cut.values[row, column]:.2g}"
            axes.text(column, row, text, ha="center", va="center", fontsize=5, color="white" if dark else "#333333")
    axes.set(xticks=x, yticks=y, xlabel=NAMES[panel["across"]], ylabel=NAMES[panel["up"]])
    axes.set_xticklabels([f"{value:.3g}" for value in cut[panel["across"]].values], fontsize=6)
    axes.set_yticklabels([f"{value:.3g}" for value in cut[panel["up"]].values], fontsize=6)
    others = ", ".join(f"{NAMES[name]} {value:.3g}" for name, value in panel["at"].items())
    axes.set_title(title + f"\n{others}" * bool(others), fontsize=7)
    for words, place in panel["conditions"].items():
        axes.text(*place, words, transform=axes.transAxes, fontsize=9, weight="bold", color="#1f4e9c", ha="center")
    return shown
