"""What accuracy costs: one panel, a line for each kind of scene."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim import dataset
from contactsim.figures import style
from contactsim.figures.layout import empty_figure, save

LOOKS = {
    "cylinder": ("o", style.WHOLE),
    "sphere": ("o", style.CONTACT),
    "rough_line": ("s", style.WHOLE),
    "layer": ("D", style.WHOLE),
    "rough_surface": ("s", style.CONTACT),
    "adhesive_asperity": ("^", style.PAIRS),
    "adhesive_sphere": ("v", style.PAIRS),
    "rough_adhesive": ("P", style.PAIRS),
    "sliding": ("X", style.PURPLE),
}
"""Marker and colour of each kind: red for lines and blue for surfaces at a hard wall, green with adhesion, violet with
friction."""
OTHER_LOOK = ("h", style.BROWN)
FORECAST: Any = (0, (4, 3))
"""Line of forecasts beyond the last run that was solved."""
TIMES = {1.0: "1 s", 60.0: "1 min", 3600.0: "1 h"}
"""Times at which there are lines."""
TICKS = (0.1, 0.01, 1e-3, 1e-4)
"""Errors with a label."""
LABEL_PLACE, HIGHEST_LABEL = 0.77, 0.97
"""Where labels begin, and the highest of them, over width and height."""
LABEL_GAP = 0.045
"""Least distance of labels, over the height of the panel."""
LABEL_ROOM = 0.42
"""Room right of the smallest error for labels, over the width of all errors, both as logarithms."""


@mpl.rc_context(style.RC_PARAMS)
def write_prices(plan: Mapping[str, Any], files: Mapping[str, Sequence[str]], targets: Mapping[str, str]) -> None:
    """Plot all scenes and write the files.

    Parameters
    ----------
    plan : of `contactsim.evaluation.work_precision.prices.prices_figure_job`
    files : data and costs, named after their scenes, in any order
    targets : png, pdf, svg and csv
    """
    data, costs = ({Path(path).stem: path for path in files[kind]} for kind in ("data", "costs"))
    tables = [price_table(data[scene], costs[scene]).assign(scene=scene) for scene in plan["titles"]]
    table = pd.concat(tables, ignore_index=True)
    figure, (panel,) = empty_figure(plan["settings"] | {"panels": 1}, footer_text(table, plan["tier"]))
    plot_prices(panel, table, plan["titles"])
    save(figure, table, targets)


def footer_text(table: pd.DataFrame, tier: str) -> str:
    """Return how many runs were solved, and how their time compares with the forecast."""
    solved = table[table.accuracy_reached >= 0]
    text = f"{tier} tier · {len(solved)} runs solved, {int((solved.accuracy_reached == 1).sum())} within the error"
    ratios = (solved.seconds / solved.predicted_seconds).dropna()
    if ratios.empty:
        return text
    return f"{text} · time over forecast: {ratios.min():.2g} to {ratios.max():.2g}, median {ratios.median():.2g}"


def price_table(data: str, costs: str) -> pd.DataFrame:
    """Return one row an error asked for: seconds, forecast seconds, and those on the grid of the thesis."""
    values, spent = dataset.load_dataset(data), json.loads(Path(costs).read_text())
    table = values.to_dataframe().reset_index()
    solved = table.accuracy_reached >= 0
    table["seconds"] = np.nan
    table.loc[solved, "seconds"] = spent["seconds"]
    unit = spent["transform_seconds"]
    return table.assign(predicted_seconds=table.predicted_units * unit, thesis_seconds=table.thesis_units * unit)


def plot_prices(axes: Axes, table: pd.DataFrame, titles: Mapping[str, str]) -> None:
    """Plot the scenes: forecast and solved, the thesis's grid, and a label."""
    least, most = table.requested_error.min(), table.requested_error.max()
    ends = {}
    for name, rows in table.groupby("scene", sort=False):
        marker, colour = LOOKS.get(str(name), OTHER_LOOK)
        place = int(np.flatnonzero(rows.accuracy_reached >= 0).max(initial=0))
        for part, line in ((rows.iloc[: place + 1], "-"), (rows.iloc[place:], FORECAST)):
            axes.plot(part.requested_error, part.predicted_seconds, color=colour, lw=1.0, ls=line)
        for reached, face in ((1, colour), (0, "white")):
            part = rows[rows.accuracy_reached == reached]
            axes.plot(part.requested_error, part.seconds, ls="", marker=marker, ms=5, color=colour, mfc=face)
        first = rows.iloc[0]
        for symbol, size, face in (("o", 11, "none"), (marker, 4, colour)):
            axes.plot(first.thesis_error, first.thesis_seconds, marker=symbol, ms=size, color=colour, mfc=face, ls="")
        seconds = rows.seconds.fillna(rows.predicted_seconds)
        last = seconds.last_valid_index()
        if last is not None:
            ends[titles[str(name)]] = rows.requested_error[last], seconds[last], marker, colour
    axes.set(xscale="log", yscale="log", xlabel="relative error asked for", ylabel="CPU time on one core (s)")
    axes.set_xlim(most * 1.3, least * (least / most) ** LABEL_ROOM)
    ticks = [value for value in TICKS if least * 0.99 <= value <= most * 1.01]
    axes.set_xticks(ticks, [f"{100 * value:g} %" for value in ticks])
    axes.minorticks_off()
    axes.tick_params(right=False, top=False)
    _add_times(axes)
    _add_labels(axes, ends)


def _add_times(axes: Axes) -> None:
    """Draw lines at a second, a minute and an hour, as far as the panel reaches, and name them on the right."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high)
    for value, text in TIMES.items():
        if low < value < high:
            axes.axhline(value, color=style.LIGHT_GREY, lw=0.6, ls=":", zorder=0)
            axes.text(1.01, value, text, transform=axes.get_yaxis_transform(), fontsize=8, va="center")


def _add_labels(axes: Axes, ends: Mapping[str, tuple[float, float, str, str]]) -> None:
    """Write the labels of all lines one above the other, each joined with the end of its line."""
    low, high = np.log(axes.get_ylim())
    order = sorted(ends, key=lambda text: ends[text][1])
    places: list[float] = []
    for text in order:
        place = float((np.log(ends[text][1]) - low) / (high - low))
        places.append(max(place, places[-1] + LABEL_GAP) if places else place)
    excess = max(places[-1] - HIGHEST_LABEL, 0.0) if places else 0.0
    for text, place in zip(order, places, strict=True):
        error, seconds, marker, colour = ends[text]
        mark = LABEL_PLACE - 0.015, place - excess
        axes.plot(*mark, marker=marker, ms=4, ls="", color=colour, transform=axes.transAxes, clip_on=False)
        axes.text(LABEL_PLACE, mark[1], text, transform=axes.transAxes, fontsize=7.5, color=colour, va="center")
        leader = {"arrowstyle": "-", "lw": 0.4, "color": colour, "shrinkA": 4, "shrinkB": 2}
        axes.annotate("", (error, seconds), mark, textcoords=axes.transAxes, arrowprops=leader)
