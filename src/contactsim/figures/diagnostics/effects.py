"""Cost of effects: one bar a scene, one panel a kind of cost."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim import dataset
from contactsim.figures import style
from contactsim.figures.layout import empty_figure, save

COSTS = {
    "unknowns": "unknowns of an increment",
    "transforms": "transforms of the path",
    "seconds": "CPU seconds, one thread",
    "megabytes": "peak of arrays (MB)",
}


@mpl.rc_context(style.RC_PARAMS)
def write_effects(plan: Mapping[str, Any], data: str, costs: str, targets: Mapping[str, str]) -> None:
    """Plot the cost of scenes with more and more effects, and write the files.

    Parameters
    ----------
    plan : tier, repeats, settings of the figure, and titles of the scenes by name
    data, costs : paths of the files of `contactsim.evaluation.effects.effect_cost.measure_effects`
    targets : png, pdf and csv
    """
    scenes = dataset.load_dataset(data)
    spent = pd.DataFrame(json.loads(Path(costs).read_text())).T.loc[scenes.variant.values].reset_index(drop=True)
    table = pd.concat([scenes.to_dataframe().reset_index(), spent], axis=1)
    table.insert(1, "title", [plan["titles"][name] for name in scenes.variant.values])
    unconverged, steps = int(table.unconverged.sum()), int(table.steps.sum())
    sample = f"{plan['tier']} tier · {int(table.unknowns.min())} points"
    footer = f"{sample} · {unconverged} of {steps} increments unconverged · best of {plan['repeats']} runs"
    figure, panels = empty_figure(plan["settings"] | {"panels": len(COSTS)}, footer)
    for panel, (name, label) in zip(panels, COSTS.items(), strict=True):
        plot_bars(panel, table[name], label, table.title if panel is panels[0] else pd.Series([], dtype=str))
    save(figure, table, targets)


def plot_bars(axes: Axes, values: pd.Series, label: str, names: pd.Series) -> None:
    """Plot one bar a scene with its value beside it; names: of the scenes, none where another panel has them."""
    places = np.arange(len(values))[::-1]
    axes.barh(places, values, color=style.WHOLE, height=0.6)
    axes.set(xlabel=label, yticks=places, yticklabels=names)
    axes.set_xlim(0, 1.28 * values.max())
    for place, value in zip(places, values, strict=True):
        axes.text(value, place, f" {value:.3g}" if value < 1e3 else f" {value:,.0f}", va="center", fontsize=7)
    axes.tick_params(axis="y", length=0)
