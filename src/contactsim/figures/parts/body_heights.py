"""Differences between load curves against the height of the body."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim.figures import style

LABELS = {"works": "any two works", "works_and_wall": "any two works or the wall", "repulsion": "and repulsion alone"}
"""Labels of the kinds of difference."""


def plot_differences(axes: Axes, table: pd.DataFrame) -> None:
    """Plot each kind of difference against the height; hollow where p h/C11 is not all that the height adds.

    table: of `contactsim.analysis.body_heights.compare_heights`; 0 is a half-space
    """
    places = np.arange(len(table))
    exact = table.is_exact.to_numpy()
    for (name, label), colour in zip(LABELS.items(), style.shades(range(len(LABELS))).values(), strict=True):
        value, error = table[name].to_numpy(), table[f"{name}_error"].to_numpy()
        axes.plot(places, value, color=colour, lw=0.8, label=f"_{label}")
        for part, fill, words in ((exact, colour, "exact"), (~exact, "white", "not $ph/C_{11}$ alone")):
            look = style.marker_look(colour, fill=fill) | {"ls": "none", "label": f"_{label}, {words}"}
            axes.errorbar(places[part], value[part], error[part], **look, **style.BARS)
        axes.plot([], [], marker="o", ms=4, color=colour, lw=0.8, label=label)
    labels = [f"{height:g}" if height else "half-space" for height in table.height]
    axes.set(xticks=places, xticklabels=labels, xlabel="height of the body (nm)", ylabel="largest difference of $p$")
    axes.set_ylim(bottom=0)
    axes.legend(loc="best", fontsize=7)
