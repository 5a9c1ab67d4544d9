"""Accuracy asked for and reached, drawn: error, cost over the least possible, time predicted and spent."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim import dataset
from contactsim.figures import style
from contactsim.figures.layout import framed, save

LOOKS = {
    "line": ("o", style.WHOLE, "line, wall"),
    "surface": ("s", style.CONTACT, "surface, wall"),
    "path": ("^", style.PAIRS, "asperity, adhesion"),
    "rough_path": ("D", "#8c6d31", "rough line, adhesion"),
    "slide": ("v", "#7b4fa3", "asperity, sliding"),
}
LEAST = 1e-5
"""Errors below it are drawn there."""


def render(plan: Mapping, data: Sequence[str], costs: Sequence[str], targets: Mapping[str, str]) -> None:
    """All trials into one dataset, a table and a figure; data, costs: of
    `contactsim.evaluation.calibration.validation.trial`, scene by scene.
    """
    found = xr.concat([dataset.load_dataset(path) for path in data], "scene")
    dataset.write(dataset.stamped(found, plan["settings"]["title"], plan, plan["data"]), targets["data"])
    table = tabulated(found, [json.loads(Path(path).read_text()) for path in costs])
    figure, panels = framed(plan["settings"] | {"panels": 3}, _footer(table, plan))
    draw(table, panels)
    save(figure, table, targets)


def tabulated(found: xr.Dataset, spent: list[dict]) -> pd.DataFrame:
    """One row a scene: what was asked and reached, cost over the least, seconds predicted and spent."""
    table = pd.concat([found.to_dataframe().reset_index(), pd.DataFrame(spent)], axis=1)
    return table.assign(
        met=table.true_error <= table.requested_error,
        cost=table.work / table.min_work,
        cost_in_seconds=table.seconds / table.least,
        prediction=table.predicted / table.seconds,
    )


def _footer(table: pd.DataFrame, plan: Mapping) -> str:
    """How many met what was asked, and at which cost."""
    near = table.prediction.between(0.5, 2.0)
    return " · ".join(
        [
            f"{plan['tier']} tier, seed {plan['seed']}",
            f"{int(table.met.sum())} of {len(table)} scenes within the error asked for",
            f"median cost {table.cost.median():.3g} times the least ({table.cost_in_seconds.median():.3g} in seconds)",
            f"time within a factor of two in {int(near.sum())} of {len(table)}",
            f"refined in {int((table.solve_count > 2).sum())}",
        ]
    )


def draw(table: pd.DataFrame, panels: Sequence[Axes]) -> None:
    """The three panels."""
    errors, cost, seconds = panels
    for kind, (marker, color, words) in LOOKS.items():
        rows = table[table.kind == kind]
        look = {"marker": marker, "color": color, "ls": "", "ms": 5, "mfc": "white"}
        if rows.empty:
            continue
        errors.plot(rows.requested_error, np.maximum(rows.true_error, LEAST), label=words, **look)
        cost.plot(rows.true_error.clip(lower=LEAST) / rows.requested_error, rows.cost, **look)
        seconds.plot(rows.seconds, rows.predicted, **look)
    ends = np.array([table.requested_error.min() / 1.5, table.requested_error.max() * 1.5])
    errors.plot(ends, ends, color=style.EXACT, lw=0.8)
    errors.set(xscale="log", yscale="log", xlabel="relative error asked for", ylabel="true relative error")
    errors.set_xticks(
        sorted(set(table.requested_error)), [f"{value:g}" for value in sorted(set(table.requested_error))]
    )
    errors.minorticks_off()
    errors.legend(fontsize=6.5)
    cost.axvline(1, color=style.EXACT, lw=0.8)
    cost.axhline(table.cost.median(), color="#999999", lw=0.8, ls="--")
    cost.set(
        xscale="log", yscale="log", xlabel="true error over that asked for", ylabel="work over the least that meets it"
    )
    ends = np.array([table.seconds.min() / 2, table.seconds.max() * 2])
    seconds.plot(ends, ends, color=style.EXACT, lw=0.8)
    for factor in (0.5, 2.0):
        seconds.plot(ends, factor * ends, color="#999999", lw=0.8, ls="--")
    seconds.set(xscale="log", yscale="log", xlabel="CPU seconds spent", ylabel="CPU seconds predicted")
    style.ticks(cost.yaxis, *cost.get_ylim())
    style.letters(panels)
