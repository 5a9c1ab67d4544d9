"""Curves without negligible effects beside those with all, and the work that is saved."""

from __future__ import annotations

import textwrap
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
    markers = style.marker_look(colour, "s" if work else "o") | {"ls": ""}
    axes.errorbar(simplified.indentation[full], mean, error, **markers)


def label_savings(axes: Axes, lines: list[str]) -> None:
    """Label the bars of work, and put the decisions as text below them."""
    count = len(lines)
    axes.set(ylim=(-2 * count, 0.6), xlabel="transforms of all members: full, what was done; faint, all effects")
    axes.set(yticks=-np.arange(count), yticklabels=[line.partition(":")[0] for line in lines])
    text = "\n".join("\n".join(textwrap.wrap(line, 100, subsequent_indent="   ")) for line in lines)
    axes.text(0.02, 0.02, text, transform=axes.transAxes, fontsize=5, va="bottom")
