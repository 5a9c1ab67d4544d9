"""Pictures of one state of a contact, and its mark on the curve of all."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap

from contactsim.figures import style
from contactsim.figures.parts import slide_curves
from contactsim.figures.parts.scale_bar import add_scale_bar
from contactsim.figures.sketch import ELASTIC_COLOUR, RIGID_COLOUR
from contactsim.grid import Array
from contactsim.observables.contact import touching

HEIGHT_COLOURS = ("#8c8c8c", "#a3a3a3", "#b8b8b8", "#cbcbcb", "#dcdcdc", "#ebebeb")
"""Colours of equal parts of the range of heights, from low to high."""

MARK = "state"
"""Group of the marks of a state on curves."""


def plot_contact_map(axes: Axes, state: xr.Dataset) -> None:
    """Map the contact of a surface on its heights."""
    heights = state.heights.values
    levels = np.linspace(heights.min(), heights.max(), len(HEIGHT_COLOURS) + 1)[1:-1]
    kinds = np.where(touching(state.pressure.values), len(HEIGHT_COLOURS), np.digitize(heights, levels))
    length, colours = float(state.length), ListedColormap([*HEIGHT_COLOURS, style.CONTACT])
    extent = (0.0, length, 0.0, float(state.length_y))
    look: dict[str, Any] = {"vmin": -0.5, "vmax": len(HEIGHT_COLOURS) + 0.5, "interpolation": "nearest"}
    axes.imshow(kinds, origin="lower", extent=extent, cmap=colours, **look)
    axes.axis("off")
    add_scale_bar(axes, length, "nm")
    words = f"contact blue; heights ${heights.min():.0f}$ (dark)\nto ${heights.max():.0f}$ nm (light) in equal steps"
    axes.text(1.0, -0.03, words, transform=axes.transAxes, fontsize=7, ha="right", va="top")


def plot_bodies(axes: Axes, position: Array, state: xr.Dataset, nodes: Array, approach: float) -> None:
    """Plot a rigid body and the deformed surface below it.

    position: places of the nodes in the order drawn; approach: of the state, nm, counted from the mean planes
    """
    rigid = -state.heights.values[nodes] - approach
    surface = rigid - state.normal_gap.values[nodes]
    axes.fill_between(position, rigid, rigid.max(), color=RIGID_COLOUR, lw=0)
    axes.plot(position, rigid, color=style.EXACT, lw=0.8, label="_rigid body")
    axes.fill_between(position, surface, surface.min() - 100, color=ELASTIC_COLOUR, lw=0)
    axes.plot(position, surface, color=style.PAIRS, lw=1.0, label="_surface of the layer")


def mark_state(axes: Axes, x: float, y: float, colour: str) -> None:
    """Mark the state of the picture on a curve."""
    axes.plot(x, y, "o", color=colour, ms=5, zorder=5, label="_state", gid=MARK)


def plot_slide(axes: Axes, table: pd.DataFrame, name: str, slide: float, colour: str, label: str) -> None:
    """Plot a quantity of a slide against its distance, with the state at one distance (nm).

    table: of `slide_table`; name: of its column; label: of the axis
    """
    axes.plot(table.slide, table[name], color=colour, lw=1.1, label=f"_{name}")
    row = table.loc[(table.slide - slide).abs().idxmin()]
    mark_state(axes, row.slide, row[name], colour)
    axes.set(xlabel=slide_curves.SLIDE_NM, ylabel=label)
