"""Error-controlled runs on trial: error reached, cost over the least possible, and true over stated error."""

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
    "rough_line": ("o", style.WHOLE, "rough line"),
    "line_on_a_layer": ("o", style.CONTACT, "rough line on a layer"),
    "two_bodies": ("o", style.PAIRS, "two bodies"),
    "cylinder": ("o", style.BROWN, "cylinder"),
    "waves": ("s", style.WHOLE, "waves"),
    "rough_surface": ("s", style.CONTACT, "rough surface"),
    "free_surface": ("s", style.PAIRS, "free surface"),
    "sphere": ("s", style.BROWN, "sphere"),
    "adhesive_cylinder": ("^", style.WHOLE, "adhesive cylinder"),
    "cylinder_under_load": ("^", style.CONTACT, "the same under load"),
    "attracting_wall": ("^", style.PAIRS, "attracting wall"),
    "rough_adhesive_line": ("^", style.BROWN, "rough adhesive line"),
    "adhesive_surface": ("D", style.PURPLE, "adhesive surface"),
    "slide": ("v", style.PURPLE, "slide"),
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
    plan : of `contactsim.evaluation.calibration.settings.trials_figure_job`
    data, costs : paths of the files of `contactsim.evaluation.calibration.trial.run_trial`, scene by scene
    targets : data (netCDF), png, pdf, svg and csv
    """
    trials = xr.concat([dataset.load_dataset(path) for path in data], "scene")
    dataset.write(dataset.stamp(trials, plan["settings"]["title"], plan, plan["data"]), targets["data"])
    table = trial_table(trials, [json.loads(Path(path).read_text()) for path in costs])
    figure, panels = empty_figure(plan["settings"] | {"panels": 3}, footer_text(table, plan))
    plot_trials(table, panels)
    save(figure, table, targets)


def trial_table(trials: xr.Dataset, costs: list[dict[str, float]]) -> pd.DataFrame:
    """Return one row a scene: error asked for, stated and reached, and CPU time over the least."""
    table = pd.concat([trials.to_dataframe().reset_index(), pd.DataFrame(costs)], axis=1)
    met = ~(table.true_error > table.requested_error) | (table.accuracy_reached == 0)
    return table.assign(met=met, cost=table.seconds / table.least, prediction=table.predicted / table.seconds)


def footer_text(table: pd.DataFrame, plan: Mapping[str, Any]) -> str:
    """Return how many scenes met the error asked for, how many errors were covered, and at which cost."""
    reached = table[table.accuracy_reached == 1]
    told, costs = table[np.isfinite(table.predicted_error)], table.groupby("kind").cost.median()
    return " · ".join(
        [
            f"{plan['tier']} tier, seed {plan['seed']}",
            f"{int(told.covered.sum())} of {len(told)} stated errors cover the true one",
            f"{int(reached.met.sum())} of {len(reached)} reached are within the error asked for",
            f"median cost {table.cost.median():.3g} times the least, {costs.min():.3g} to {costs.max():.3g} by kind",
            f"time within a factor of two in {int(table.prediction.between(0.5, 2.0).sum())}",
        ]
    )


def plot_trials(table: pd.DataFrame, panels: Sequence[Axes]) -> None:
    """Plot error, cost and coverage of all scenes on three panels."""
    error, cost, cover = panels
    spread = np.linspace(0.85, 1.18, len(SCENE_LOOKS))  # beside each other, not upon each other
    for (kind, (marker, colour, label)), shift in zip(SCENE_LOOKS.items(), spread, strict=True):
        rows = table[table.kind == kind]
        if rows.empty:
            continue
        look = style.marker_look(colour, marker, 4) | {"ls": ""}
        true = rows.true_error.clip(lower=SMALLEST_ERROR)
        error.plot(rows.requested_error * shift, true, label=label, **look)
        cost.plot(true / rows.requested_error, rows.cost, **look)
        cover.plot(rows.predicted_error, true, **look)
    missed = table[~table.met]
    if len(missed):
        ring = {"color": style.WHOLE, "marker": "o", "ms": 11, "mfc": "none", "ls": "", "label": "missed"}
        error.plot(missed.requested_error, missed.true_error, **ring)
    _label_errors(error, table)
    cost.axvline(1, **DIAGONAL)
    cost.axhline(table.cost.median(), **GUIDE)
    cost.set(xscale="log", yscale="log", xlabel="true error over that asked for")
    cost.set(ylabel="CPU time over the least that meets it")
    stated = table.predicted_error[np.isfinite(table.predicted_error)]
    ends = np.array([stated.min() / 1.5, stated.max() * 1.5])
    cover.plot(ends, ends, **DIAGONAL)
    cover.set(xscale="log", yscale="log", xlabel="stated relative error", ylabel="true relative error")
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
    axes.set_ylim(top=3.0)
    axes.legend(fontsize=5, ncols=2)
