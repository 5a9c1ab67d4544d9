"""Effects that a scene has and lacks, what they cost, and what leaving them out changes."""

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

EFFECTS = {
    "has_adhesion": "adhe-\nsion",
    "has_friction": "fric-\ntion",
    "has_coupling": "coup-\nling",
    "has_second_body": "second\nbody",
    "has_height": "finite\nthickness",
}
"""Columns of the table, with their heads."""
CHANGES = {"largest_pull": ("largest pull", style.WHOLE), "contact_length_at_load": ("contact length", style.CONTACT)}
"""Numbers whose change is shown, with label and colour."""
CHANGE_TICKS = (-100, -10, -1, 0, 1, 10, 100)
"""Changes in per cent with a label; the axis is linear within the smallest and logarithmic beyond."""
CHANGE_ENDS = (-1000, 1000)
"""Ends of that axis in per cent, with room for the numbers beside the bars."""
WIDTHS = (1.1, 0.9, 1.1)
"""Widths of the panels."""
BAR, SIDE = 0.56, 11
"""Height of a bar, over that of a row, and side of a square, points."""


@mpl.rc_context(style.RC_PARAMS)
def write_effects(plan: Mapping[str, Any], data: str, costs: str, targets: Mapping[str, str]) -> None:
    """Plot scenes with some of the effects, and write the files.

    Parameters
    ----------
    plan : tier, repeats, settings of the figure, and titles of the scenes by name
    data, costs : paths of the files of `contactsim.evaluation.effects.effect_cost.measure_effects`
    targets : png, pdf, svg and csv
    """
    scenes = dataset.load_dataset(data)
    spent = pd.DataFrame(json.loads(Path(costs).read_text())).T.loc[scenes.variant.values].reset_index(drop=True)
    table = pd.concat([scenes.to_dataframe().reset_index(), spent], axis=1)
    table.insert(1, "title", [plan["titles"][name] for name in scenes.variant.values])
    table["cost"] = table.transforms / table.transforms[0]
    for name in CHANGES:
        table[f"{name}_change"] = table[name] / table[name][0] - 1
    unconverged, steps = int(table.unconverged.sum()), int(table.steps.sum())
    seconds = f"CPU time {table.seconds.min():.2g} to {table.seconds.max():.2g} s, best of {plan['repeats']} runs"
    footer = (
        f"{plan['tier']} tier · {int(table.unknowns.min())} points · {unconverged} of {steps} increments unconverged"
    )
    layout = plan["settings"] | {"panels": len(WIDTHS)}
    figure, panels = empty_figure(layout, f"{footer} · {seconds}", widths=WIDTHS)
    plot_effects(panels[0], table)
    plot_costs(panels[1], table)
    plot_changes(panels[2], table)
    save(figure, table, targets)


def plot_effects(axes: Axes, table: pd.DataFrame) -> None:
    """Draw a square for each scene and effect, filled where the scene has it."""
    for column, name in enumerate(EFFECTS):
        for value, face in ((1, style.EXACT), (0, "white")):
            rows = np.flatnonzero(table[name] == value)
            axes.plot(np.full(rows.size, column), rows, "s", ms=SIDE, mfc=face, mec=style.LIGHT_GREY)
    axes.set_yticks(range(len(table)), table.title)
    axes.set_xticks(range(len(EFFECTS)), EFFECTS.values())
    axes.tick_params(axis="x", labelsize=7.5)
    axes.tick_params(length=0, labeltop=True, labelbottom=False, top=False, right=False)
    axes.set(xlim=(-0.6, len(EFFECTS) - 0.4), ylim=(len(table) - 0.4, -0.6))
    axes.spines[:].set_visible(False)


def plot_costs(axes: Axes, table: pd.DataFrame) -> None:
    """Plot the cost of each scene over that of the first."""
    seconds = table.seconds / table.seconds[0]
    axes.barh(range(len(table)), table.cost, color=style.GREY, height=BAR, label="Fourier transforms")
    axes.barh(np.arange(len(table)) + 0.68 * BAR, seconds, color=style.BROWN, height=0.25 * BAR, label="CPU time")
    for row, cost in enumerate(table.cost):
        axes.text(cost, row, f" {cost:.2f}", va="center", fontsize=8)
    axes.set(xlim=(0, 1.25 * max(table.cost.max(), seconds.max())), xlabel="cost / cost with all effects")
    axes.legend(loc="lower right", fontsize=6.5)
    _share_rows(axes, len(table))


def plot_changes(axes: Axes, table: pd.DataFrame) -> None:
    """Plot the change of each number against the first scene, in per cent."""
    height = BAR / len(CHANGES)
    for place, (name, (label, colour)) in enumerate(CHANGES.items()):
        changes = 100 * table[f"{name}_change"].to_numpy()[1:]
        rows = np.arange(1, len(table)) + (place - (len(CHANGES) - 1) / 2) * height
        axes.barh(rows, changes, color=colour, height=0.86 * height, label=label)
        for row, change in zip(rows, changes, strict=True):
            side = "left" if change >= 0 else "right"
            axes.text(change, row, f" {change:.1f} % ", va="center", ha=side, fontsize=6.5)
    axes.axvline(0, **style.ZERO)
    axes.set_xscale("symlog", linthresh=CHANGE_TICKS[4])
    axes.set(xlim=CHANGE_ENDS, xlabel="change when left out (%)")
    axes.set_xticks(CHANGE_TICKS, [f"{value:g}" for value in CHANGE_TICKS])
    axes.minorticks_off()
    axes.legend(loc="upper left", fontsize=6.5)
    _share_rows(axes, len(table))


def _share_rows(axes: Axes, rows: int) -> None:
    """Give a panel the rows of the table, without their names."""
    axes.set(ylim=(rows - 0.4, -0.6), yticks=[])
    axes.tick_params(top=False, right=False)
    axes.spines[["top", "right", "left"]].set_visible(False)
