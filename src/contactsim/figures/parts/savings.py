"""Curves without negligible effects beside those with all, and the work that is saved."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis.rough_paths import on_full_grid
from contactsim.figures import style
from contactsim.figures.parts import rough_curves as rough


def plot_simplified(
    axes: Axes, simplified: xr.Dataset, complete: xr.Dataset, label: str, colour: str, work: float
) -> None:
    """Plot the area with all effects as a line, without the negligible ones as markers with standard errors."""
    look: dict[str, Any] = {"color": colour, "ls": "-" if work else "--", "lw": 1.0, "marker": ""}
    rough.plot_path(axes, complete, complete.indentation, rough.AREA, label, **look)
    full = on_full_grid(simplified)
    mean, error = (simplified[f"{rough.AREA}_{end}"][full] for end in ("mean", "standard_error"))
    markers = style.marker_look(colour, "s" if work else "o")
    markers |= {"ls": "", "label": f"_{label}, without negligible effects"}
    axes.errorbar(simplified.indentation[full], mean, error, **markers)


def label_savings(axes: Axes, shares: Mapping[str, float]) -> None:
    """Label the bars of work; shares: work that was done over that with all effects, by the variant's label."""
    axes.set(ylim=(0.6 - len(shares), 0.6), xlabel="transforms of all members (thousands)")
    axes.set(yticks=-np.arange(len(shares)), yticklabels=list(shares))
    axes.set_xlim(right=1.5 * axes.get_xlim()[1])
    axes.xaxis.set_major_formatter(lambda value, _: f"{value / 1e3:g}")
    for row, share in enumerate(shares.values()):
        axes.text(0.98, -row, f"{share:.2g} of the work", transform=axes.get_yaxis_transform(), ha="right", va="center")
