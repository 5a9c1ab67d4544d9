"""What effects cost, drawn: one bar a scene, one panel a price."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from contactsim import dataset
from contactsim.figures import style
from contactsim.figures.layout import framed, save

PRICES = {
    "unknowns": "unknowns of an increment",
    "transforms": "transforms of the path",
    "seconds": "CPU seconds, one thread",
    "megabytes": "peak of arrays (MB)",
}


def render(plan: Mapping, data: str, costs: str, targets: Mapping[str, str]) -> None:
    """Draw the ladder into its files; plan: settings with titles; data, costs: of
    `contactsim.evaluation.effects.effect_cost.measure`.
    """
    found = dataset.load_dataset(data)
    prices = pd.DataFrame(json.loads(Path(costs).read_text())).T.loc[found.variant.values].reset_index(drop=True)
    table = pd.concat([found.to_dataframe().reset_index(), prices], axis=1)
    table.insert(1, "title", [plan["titles"][name] for name in found.variant.values])
    lost, steps = int(table.unconverged.sum()), int(table.steps.sum())
    points = f"{plan['tier']} tier · {int(table.unknowns.min())} points"
    footer = f"{points} · {lost} of {steps} increments unconverged · best of {plan['repeats']} runs"
    figure, panels = framed(plan["settings"] | {"panels": len(PRICES)}, footer)
    places = np.arange(len(table))[::-1]
    for panel, (name, words) in zip(panels, PRICES.items(), strict=True):
        panel.barh(places, table[name], color=style.WHOLE, height=0.6)
        panel.set(xlabel=words, yticks=places, yticklabels=table.title if panel is panels[0] else [])
        panel.set_xlim(0, 1.28 * table[name].max())
        for place, value in zip(places, table[name], strict=True):
            panel.text(value, place, f" {value:.3g}" if value < 1e3 else f" {value:,.0f}", va="center", fontsize=7)
        panel.tick_params(axis="y", length=0)
    save(figure, table, targets)
