"""The map of stability: outcome and cost of every solver on every hazard, at every severity."""

from __future__ import annotations

import re
from itertools import groupby

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from contactsim import dataset
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.figures import style

COLOURS = {
    Outcome.EXACT: "#56b4e9",
    Outcome.CERTIFIED: "#c3e3f5",
    Outcome.REFUSED: "#d9d9d9",
    Outcome.FAILED: "#f0e442",
    Outcome.WRONG: "#d55e00",
    Outcome.NON_FINITE: "#000000",
}
"""Told apart without seeing red and green, and in grey (Okabe and Ito's)."""
FONT = 5.2
"""Points of the text in cells, which fits 21 columns."""
HEAD = 1.25
"""Rows that a block takes beside its solvers'."""


def stability(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Cells hazard × solver × severity by outcome, with the cost as a number in each."""
    parts = [taken(data.sel(hazard=hazard)) for hazard in data.hazard.values]
    tops = np.cumsum([0.0, *(part.solver.size + HEAD for part in parts)])
    places = np.searchsorted(tops[-1] * np.arange(1, len(axes)) / len(axes), (tops[:-1] + tops[1:]) / 2)
    panels = [[part for part, at in zip(parts, places, strict=True) if at == place] for place in range(len(axes))]
    room = max(sum(part.solver.size + HEAD for part in own) for own in panels)
    for own, panel in zip(panels, axes, strict=True):
        _blocks(own, panel, room)
    cells = np.concatenate([part.outcome.values.ravel() for part in parts])
    counts = {outcome: int((cells == outcome.value[0]).sum()) for outcome in Outcome}
    keys = [
        Patch(facecolor=COLOURS[outcome], edgecolor="#999999", lw=0.4, label=f"{outcome.value[1]}: {counts[outcome]}")
        for outcome in Outcome
    ]
    axes[0].figure.legend(handles=keys, loc="outside upper right", ncols=3)
    names = {outcome.value[0]: outcome.name.lower() for outcome in Outcome}
    rows = data[["outcome", "transforms", "reason"]].to_dataframe().reset_index()
    return rows.assign(outcome=rows.outcome.map(names))


def taken(one: xr.Dataset) -> xr.Dataset:
    """One hazard without the solvers that do not take its kind of case at all; whole if that would leave none."""
    takes = one.applicable.values > 0
    return one.isel(solver=takes) if takes.any() else one


LETTERS = 118
"""How many a head has room for at its usual size."""


def _blocks(parts: list[xr.Dataset], axes: Axes, room: float) -> None:
    """One block a hazard: its name and what gets harder, then a row a solver; room: height of the panel in rows."""
    columns = parts[0].severity.size
    colours = ListedColormap([COLOURS[outcome] for outcome in Outcome])
    ticks, bottom = [], 0.0
    for one in parts:
        hazard, solvers, top = str(one.hazard.values), one.solver.size, bottom + HEAD - 0.15
        bottom += solvers + HEAD
        axes.pcolormesh(
            np.arange(columns + 1),
            top + np.arange(solvers + 1),
            one.outcome.values,
            cmap=colours,
            vmin=-0.5,
            vmax=len(COLOURS) - 0.5,
            edgecolors="white",
            linewidth=0.4,
        )
        harder = str(one.difficulty.values)
        head = {"fontsize": 6 * min(1.0, LETTERS / len(hazard + harder)), "va": "bottom"}
        axes.text(0, top - 0.15, f"{hazard}: ", ha="left", weight="bold", **head)
        axes.annotate(harder, (1, 0), xycoords=axes.texts[-1], annotation_clip=False, **head)
        look = {"fontsize": FONT, "ha": "center", "va": "center"}
        for (row, column), cost in np.ndenumerate(one.transforms.values):
            axes.text(column + 0.5, top + row + 0.53, _short(cost), **look)
        for row, refused in enumerate(refusals(one)):
            for (start, stop), reason in refused.items():
                under = {"facecolor": COLOURS[Outcome.REFUSED], "linewidth": 0, "pad": 0.5}
                axes.text((start + stop) / 2, top + row + 0.53, reason, bbox=under, **look)
        ticks += [(top + row + 0.5, style.solver(name)) for row, name in enumerate(one.solver.values)]
    axes.set(xlim=(0, columns), ylim=(room, 0), xlabel="severity")
    axes.set_yticks([at for at, _ in ticks], [name for _, name in ticks], fontsize=6)
    shown = np.unique(np.linspace(0, columns - 1, min(columns, 11)).round().astype(int))
    axes.set_xticks(shown + 0.5, [f"{value:g}" for value in parts[0].severity.values[shown]], fontsize=7)
    axes.tick_params(length=0, top=False, right=False)
    axes.spines[:].set_visible(False)


def refusals(data: xr.Dataset) -> list[dict[tuple[int, int], str]]:
    """Of each solver on one hazard, the short reason of each run of cells that were refused for it."""
    refused = data.outcome.values == Outcome.REFUSED.value[0]
    rows = []
    for cells, reasons in zip(refused, data.reason.values, strict=True):
        texts = [short_reason(str(reason)) if cell else "" for cell, reason in zip(cells, reasons, strict=True)]
        runs, start = {}, 0
        for text, run in groupby(texts):
            stop = start + len(list(run))
            runs |= {(start, stop): text} if text else {}
            start = stop
        rows.append(runs)
    return rows


def short_reason(reason: str) -> str:
    """The heart of a refusal: the trait that a solver does not take, or the last clause."""
    trait = re.search(r"one that accepts (\w+)", reason)
    return f"takes no {trait[1].lower().replace('_', ' ')}" if trait else reason.rpartition(": ")[2]


def _short(cost: float) -> str:
    if cost == 0:
        return ""
    return f"{cost:.0f}" if cost < 9999.5 else f"{cost / 1000:.0f}k"


def footer(data: xr.Dataset) -> str:
    """Tier, cells, those not drawn, and what must not occur."""
    settings = dataset.settings_of(data)
    bad = [int((data.outcome == outcome.value[0]).sum()) for outcome in (Outcome.WRONG, Outcome.NON_FINITE)]
    left_out = int((data.applicable == 0).sum()) * data.severity.size
    beside = f" · refused and left out, as their solver does not take the kind of case: {left_out}" * bool(left_out)
    return f"{settings['tier']} tier · {data.outcome.size} cells{beside} · {bad[0]} wrong, {bad[1]} not finite"
