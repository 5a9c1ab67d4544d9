"""Error-controlled runs on trial: error reached, cost over the least possible, time predicted and spent."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim import dataset
from contactsim.figures import style
from contactsim.figures.layout import empty_figure, save

SCENE_LOOKS = {
    "line": ("o", style.WHOLE, "line, wall"),
    "surface": ("s", style.CONTACT, "surface, wall"),
    "path": ("^", style.PAIRS, "asperity, adhesion"),
    "rough_path": ("D", style.BROWN, "rough line, adhesion"),
    "slide": ("v", style.PURPLE, "asperity, sliding"),
}
"""Marker, colour and label of each kind of scene."""
SMALLEST_ERROR = 1e-5
"""Smaller errors are plotted here."""
DIAGONAL: dict[str, Any] = {"color": style.EXACT, "lw": 0.8}
GUIDE: dict[str, Any] = {"color": style.LIGHT_GREY, "lw": 0.8, "ls": "--"}


@mpl.rc_context(style.RC_PARAMS)
def write_trials(
    plan: Mapping[str, Any], data: Sequence[str], costs: Sequence[str], targets: Mapping[str, str]
) -> None:
    """Join all trials, plot them and write the files.

    Parameters
    ----------
    plan : of `contactsim.evaluation.calibration.validation.trials_figure_job`
    data, costs : paths of the files of `contactsim.evaluation.calibration.validation.run_trial`, scene by scene
    targets : data (netCDF), png, pdf, svg and csv
    """
    trials = xr.concat([dataset.load_dataset(path) for path in data], "scene")
    dataset.write(dataset.stamp(trials, plan["settings"]["title"], plan, plan["data"]), targets["data"])
    table = trial_table(trials, [json.loads(Path(path).read_text()) for path in costs])
    figure, panels = empty_figure(plan["settings"] | {"panels": 3}, footer_text(table, plan))
    plot_trials(table, panels)
    save(figure, table, targets)


def trial_table(trials: xr.Dataset, costs: list[dict[str, float]]) -> pd.DataFrame:
    """Return one row a scene: error asked for and reached, cost over the least, seconds predicted and spent."""
    table = pd.concat([trials.to_dataframe().reset_index(), pd.DataFrame(costs)], axis=1)
    return table.assign(
        met=table.true_error <= table.requested_error,
        cost=table.work / table.min_work,
        cost_in_seconds=table.seconds / table.least,
        prediction=table.predicted / table.seconds,
    )


def footer_text(table: pd.DataFrame, plan: Mapping[str, Any]) -> str:
    """Return how many scenes met the error asked for, and at which cost."""
    within_two = table.prediction.between(0.5, 2.0)
    return " · ".join(
        [
            f"{plan['tier']} tier, seed {plan['seed']}",
            f"{int(table.met.sum())} of {len(table)} scenes within the error asked for",
            f"median cost {table.cost.median():.3g} times the least ({table.cost_in_seconds.median():.3g} in seconds)",
            f"time within a factor of two in {int(within_two.sum())} of {len(table)}",
            f"refined in {int((table.solve_count > 2).sum())}",
        ]
    )


def plot_trials(table: pd.DataFrame, panels: Sequence[Axes]) -> None:
    """Plot error, cost and seconds of all scenes on three panels."""
    error, cost, seconds = panels
    for kind, (marker, colour, label) in SCENE_LOOKS.items():
        rows = table[table.kind == kind]
        if rows.empty:
            continue
        look = style.marker_look(colour, marker, 5) | {"ls": ""}
        error.plot(rows.requested_error, np.maximum(rows.true_error, SMALLEST_ERROR), label=label, **look)
        cost.plot(rows.true_error.clip(lower=SMALLEST_ERROR) / rows.requested_error, rows.cost, **look)
        seconds.plot(rows.seconds, rows.predicted, **look)
    missed = table[~table.met]
    if len(missed):
        ring = {"color": style.WHOLE, "marker": "o", "ms": 11, "mfc": "none", "ls": "", "label": "missed"}
        error.plot(missed.requested_error, missed.true_error, **ring)
    _label_errors(error, table)
    cost.axvline(1, **DIAGONAL)
    cost.axhline(table.cost.median(), **GUIDE)
    cost.set(xscale="log", yscale="log", xlabel="true error over that asked for")
    cost.set(ylabel="work over the least that meets it")
    ends = np.array([table.seconds.min() / 2, table.seconds.max() * 2])
    seconds.plot(ends, ends, **DIAGONAL)
    for factor in (0.5, 2.0):
        seconds.plot(ends, factor * ends, **GUIDE)
    seconds.set(xscale="log", yscale="log", xlabel="CPU seconds spent", ylabel="CPU seconds predicted")
    style.set_log_ticks(cost.yaxis, *cost.get_ylim())
    style.add_letters(panels)


def _label_errors(axes: Axes, table: pd.DataFrame) -> None:
    """Label the panel of errors, with the line on which true and requested error agree."""
    errors = sorted(set(table.requested_error))
    ends = np.array([errors[0] / 1.5, errors[-1] * 1.5])
    axes.plot(ends, ends, **DIAGONAL)
    axes.set(xscale="log", yscale="log", xlabel="requested relative error", ylabel="true relative error")
    axes.set_xticks(errors, [f"{value:g}" for value in errors])
    axes.minorticks_off()
    axes.legend(fontsize=6.5)
