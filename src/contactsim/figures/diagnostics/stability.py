"""Map of robustness: outcome and cost of every solver on every hazard, at every severity."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import groupby
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from contactsim import dataset
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.figures import style
from contactsim.solvers.registry import DEFAULT_SOLVERS

COLOURS = {
    Outcome.EXACT: "#56b4e9",
    Outcome.CERTIFIED: "#c3e3f5",
    Outcome.REFUSED: "#d9d9d9",
    Outcome.FAILED: "#f0e442",
    Outcome.WRONG: "#d55e00",
    Outcome.NON_FINITE: "#000000",
}
"""Distinct without red and green, and in grey (Okabe and Ito)."""
WORDS = {
    Outcome.EXACT: "right: the exact answer",
    Outcome.CERTIFIED: "certified: right by its residual",
    Outcome.REFUSED: "refused with a reason",
    Outcome.FAILED: "failed and says so",
    Outcome.WRONG: "wrong",
    Outcome.NON_FINITE: "not finite",
}
"""What colours mean."""
CELL_LOOK: dict[str, Any] = {"fontsize": 5.2, "ha": "center", "va": "center"}
"""Text in cells, which fits 21 columns."""
HEAD_HEIGHT = 1.25
"""Height of the head of a hazard's block, in rows."""
HEAD_LETTERS = 118
"""Letters of a head at its usual size."""
TICKS = 11
"""Largest number of labels along the severity."""


def stability(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Map the cells hazard × solver × severity by outcome, with the cost as a number in each."""
    blocks = [supported(data.sel(hazard=hazard)) for hazard in data.hazard.values]
    tops = np.cumsum([0.0, *(block.solver.size + HEAD_HEIGHT for block in blocks)])
    limits = tops[-1] * np.arange(1, len(axes)) / len(axes)
    columns = np.searchsorted(limits, (tops[:-1] + tops[1:]) / 2)
    panels = [[block for block, own in zip(blocks, columns, strict=True) if own == panel] for panel in range(len(axes))]
    height = max(sum(block.solver.size + HEAD_HEIGHT for block in own) for own in panels)
    for panel, own in zip(axes, panels, strict=True):
        _plot_blocks(panel, own, height)
    outcomes = np.concatenate([block.outcome.values.ravel() for block in blocks])
    add_outcome_legend(axes[0], WORDS, outcomes)
    names = {outcome.value[0]: outcome.name.lower() for outcome in Outcome}
    table = data[["outcome", "transforms", "reason"]].to_dataframe().reset_index()
    return table.assign(outcome=table.outcome.map(names))


def supported(data: xr.Dataset) -> xr.Dataset:
    """Return one hazard without the solvers that do not support its kind of case; all if none does."""
    solvers = data.applicable.values > 0
    return data.isel(solver=solvers) if solvers.any() else data


def add_outcome_legend(axes: Axes, words: Mapping[Outcome, str], outcomes: np.ndarray) -> None:
    """Add outcomes in words, with how often each is among the outcomes of all cells."""
    handles = [
        Patch(
            facecolor=COLOURS[outcome],
            edgecolor=style.LIGHT_GREY,
            lw=0.4,
            label=f"{text}: {int((outcomes == outcome.value[0]).sum())}",
        )
        for outcome, text in words.items()
    ]
    axes.figure.legend(handles=handles, loc="outside upper right", ncols=3)


def _plot_blocks(axes: Axes, blocks: list[xr.Dataset], height: float) -> None:
    """Plot one block a hazard; height: of the panel, in rows."""
    ticks, bottom = {}, 0.0
    for block in blocks:
        top = bottom + HEAD_HEIGHT - 0.15
        bottom += block.solver.size + HEAD_HEIGHT
        _plot_block(axes, block, top)
        ticks |= {top + row + 0.5: _row_name(str(name)) for row, name in enumerate(block.solver.values)}
    severity = blocks[0].severity
    axes.set(xlim=(0, severity.size), ylim=(height, 0), xlabel="severity")
    axes.set_yticks(list(ticks), list(ticks.values()), fontsize=6)
    columns = np.unique(np.linspace(0, severity.size - 1, min(severity.size, TICKS)).round().astype(int))
    axes.set_xticks(columns + 0.5, [f"{value:g}" for value in severity.values[columns]], fontsize=7)
    axes.tick_params(length=0, top=False, right=False)
    axes.spines[:].set_visible(False)


def _row_name(solver: str) -> str:
    """Return the name of a solver, with an arrow where it is the default one of its kind of case."""
    return f"→ {style.solver_name(solver)}" if solver in DEFAULT_SOLVERS.values() else style.solver_name(solver)


def _plot_block(axes: Axes, block: xr.Dataset, top: float) -> None:
    """Plot one hazard: its name and what gets harder, then a row a solver with costs and reasons of refusal."""
    x, y = np.arange(block.severity.size + 1), top + np.arange(block.solver.size + 1)
    colours = ListedColormap([COLOURS[outcome] for outcome in Outcome])
    look: dict[str, Any] = {"cmap": colours, "vmin": -0.5, "vmax": len(COLOURS) - 0.5}
    axes.pcolormesh(x, y, block.outcome.values, edgecolors="white", linewidth=0.4, **look)
    hazard, harder = str(block.hazard.values), str(block.difficulty.values)
    head: dict[str, Any] = {"fontsize": 6 * min(1.0, HEAD_LETTERS / len(hazard + harder)), "va": "bottom"}
    name = axes.text(0, top - 0.15, f"{hazard}: ", ha="left", weight="bold", **head)
    axes.annotate(harder, (1, 0), xycoords=name, annotation_clip=False, **head)
    for (row, column), cost in np.ndenumerate(block.transforms.values):
        axes.text(column + 0.5, top + row + 0.53, cost_text(cost), **CELL_LOOK)
    for row, reasons in enumerate(refusals(block)):
        for (start, stop), reason in reasons.items():
            box = {"facecolor": COLOURS[Outcome.REFUSED], "linewidth": 0, "pad": 0.5}
            axes.text((start + stop) / 2, top + row + 0.53, reason, bbox=box, **CELL_LOOK)


def refusals(data: xr.Dataset) -> list[dict[tuple[int, int], str]]:
    """Return, for each solver on one hazard, the short reason of each run of refused cells by its first and last."""
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
    """Return the trait that a solver does not accept, or the last clause of a reason."""
    trait = re.search(r"one that accepts (\w+)", reason)
    return f"takes no {trait[1].lower().replace('_', ' ')}" if trait else reason.rpartition(": ")[2]


def cost_text(cost: float) -> str:
    """Return a number of transforms; a large one in thousands."""
    if cost == 0:
        return ""
    return f"{cost:.0f}" if cost < 9999.5 else f"{cost / 1000:.0f}k"


def footer(data: xr.Dataset) -> str:
    """Return tier, number of cells, cells that are not shown, and those that must not occur."""
    tier = dataset.settings_of(data)["tier"]
    wrong, non_finite = (int((data.outcome == bad.value[0]).sum()) for bad in (Outcome.WRONG, Outcome.NON_FINITE))
    hidden = int((data.applicable == 0).sum()) * data.severity.size
    text = f" · {hidden} cells left out, whose solver does not take the kind of case" if hidden else ""
    return f"{tier} tier · {data.outcome.size} cells{text} · {wrong} wrong, {non_finite} not finite"
