"""What leaving effects out changes, drawn: one panel a cut through a map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from contactsim import dataset
from contactsim.figures.layout import framed, save

COLUMNS = 4
LEAST, MOST = 1e-4, 1.0
"""Ends of the colours."""
NUMBER = {"fontsize": 5.5, "color": "#222222"}
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
    """Draw all panels into their files; plan: of `contactsim.evaluation.effects.survey.figure`; data: the maps, by
    name.
    """
    maps = dict(zip(sorted(plan["titles"]), map(dataset.load_dataset, data), strict=True))
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
    shown = axes.pcolormesh(x, y, values, norm=LogNorm(LEAST, MOST), cmap="YlOrBr", shading="nearest")
    if min(cut.shape) > 1:
        found = [level for level in LINES if values.min() < level < values.max()]
        if found:
            axes.contour(
                x, y, np.log(values), np.log(found), colors="#1f4e9c", linestyles=[LINES[one] for one in found]
            )
    for row in y:
        for column in x:
            axes.text(column, row, _per_cent(cut.values[row, column]), ha="center", va="center", **NUMBER)
    axes.set(xticks=x, yticks=y, xlabel=_words(panel["across"]), ylabel=_words(panel["up"]))
    axes.set_xticklabels([_short(value) for value in cut[panel["across"]].values], fontsize=6)
    axes.set_yticklabels([_short(value) for value in cut[panel["up"]].values], fontsize=6)
    axes.tick_params(length=0)
    others = ", ".join(f"{_words(name)} {_short(value)}" for name, value in panel["at"].items())
    axes.set_title(title + f"\n{others}" * bool(others), fontsize=7)
    for words, place in panel["conditions"].items():
        box = {"boxstyle": "round,pad=0.2", "fc": "white", "ec": "#1f4e9c", "lw": 0.6}
        axes.text(*place, words, transform=axes.transAxes, fontsize=6.5, color="#1f4e9c", ha="center", bbox=box)
    return shown


def _words(axis: str) -> str:
    """What an axis is called."""
    return NAMES.get(axis, axis.replace("_", " "))


def _per_cent(change: float) -> str:
    """A change in per cent, to two digits."""
    if not np.isfinite(change):
        return "–"
    return "<0.01" if change < 1e-4 else f"{float(f'{100 * change:.2g}'):g}"


def _short(value: float) -> str:
    """A value of an axis; a small part as one over a whole number."""
    return f"1/{1 / value:.0f}" if 0 < value < 0.1 and abs(1 / value - round(1 / value)) < 1e-9 else f"{value:g}"
