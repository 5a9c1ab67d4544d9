"""Curves of cycles of approach and retraction of rough contacts, and what a cycle costs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis.ensemble import converged
from contactsim.analysis.rough_paths import mean_with_increments
from contactsim.figures import style
from contactsim.figures.parts.rough_curves import LABELS
from contactsim.observables.path_summary import LEGS, legs


def plot_cycle(data: xr.Dataset, label: str, colour: str, axes: dict[str, Axes]) -> pd.DataFrame:
    """Plot both legs of one path against the indentation, each quantity in its panel.

    data: of one member; label: of the loading leg
    """
    indentation = (data.approach - data.approach_first_touch).values
    table = {"indentation": indentation}
    for name, panel in axes.items():
        table[name] = converged(data[name], data).values
        for leg, states in zip(LEGS, legs(indentation), strict=True):
            states = slice(max(states.start - 1, 0), states.stop)
            first = leg == LEGS[0]
            leg_label = label if first else f"_{label}, {leg}"
            look: dict[str, Any] = {"color": colour, "lw": 1.0, "ls": "-" if first else "--", "label": leg_label}
            panel.plot(indentation[states], table[name][states], **look)
        panel.set(xlabel=LABELS["indentation"], ylabel=LABELS[name])
    return pd.DataFrame(table)


def plot_against_height(
    axes: Axes, data: xr.Dataset, name: str, unit: float, label: str, colour: str, fill: str
) -> dict[str, np.ndarray]:
    """Plot the mean over members against the rms height; return mean, error and number of members as columns.

    unit: that the quantity is shown over; bars: standard error and increment error in quadrature
    """
    mean, error, members = mean_with_increments(data, name)
    scale = 1 / unit
    look = style.marker_look(colour, fill=fill) | {"ls": "-", "lw": 0.8, "label": label}
    axes.errorbar(data.surface_rms_height.values, scale * mean, scale * error, **look, **style.BARS)
    return {f"{name}_mean": mean, f"{name}_error": error, f"{name}_members": members}
