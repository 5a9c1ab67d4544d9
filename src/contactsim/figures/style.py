"""How figures look: one place for colours, markers, labels and footers."""

from __future__ import annotations

from collections.abc import Mapping

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

HURST = {0.2: ("o", "-"), 0.5: ("s", "--"), 0.8: ("^", ":")}
WHOLE, CONTACT, PAIRS = "#c1272d", "#1f4e9c", "#2a9d6f"
"""Gradient over the whole surface, over the contact (Eq. 3.8), over pairs in contact."""
EXACT = "#333333"

mpl.rcParams.update(
    {
        "font.size": 9,
        "axes.labelsize": 9,
        "legend.fontsize": 7.5,
        "legend.frameon": False,
        "xtick.direction": "in",
        "ytick.direction": "in",
        "xtick.top": True,
        "ytick.right": True,
        "savefig.dpi": 200,
        "svg.hashsalt": "contactsim",
        "pdf.fonttype": 42,
    }
)


def hurst(value: float) -> dict[str, object]:
    """Marker and line of a Hurst exponent; those not in the thesis get a cross."""
    marker, line = HURST.get(round(value, 6), ("x", "-."))
    return {"marker": marker, "linestyle": line, "markersize": 3.5, "linewidth": 1.0, "markerfacecolor": "white"}


def with_errors(axes: Axes, x: xr.DataArray, data: xr.Dataset, name: str, **look: object) -> None:
    """A curve of ensemble means with standard errors as bars; without errors where there is one member."""
    error = data[f"{name}_standard_error"].values
    bars = error if np.isfinite(error).any() else None
    axes.errorbar(x.values, data[f"{name}_mean"].values, yerr=bars, elinewidth=0.8, capsize=1.5, **look)


def header(figure: Figure, title: str) -> None:
    """The figure's title."""
    figure.suptitle(title, fontsize=9.5, x=0.01, ha="left")


def footer(figure: Figure, text: str) -> None:
    """A line below the axes that says how the figure was made."""
    figure.text(0.01, 0.005, text, fontsize=6, color="#666666", ha="left", va="bottom")


def points_text(settings: Mapping, points: int) -> str:
    """Grid points, with those per shortest wavelength where the surface has one, beside the thesis's own."""
    surface, thesis = settings["surface"], settings["thesis_points"]
    if surface["kind"] == "self_affine":
        per_point = surface["shortest_wavelength"] / surface["length"]
        return f"{points} points, {points * per_point:g} per shortest wavelength (thesis {thesis * per_point:g})"
    return f"{points} points (thesis {thesis})" if thesis else f"{points} points"
