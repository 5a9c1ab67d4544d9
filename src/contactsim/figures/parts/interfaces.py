"""Pictures of the interface of rough adhesive contacts: the rigid profile and the surface below it."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim.figures import style
from contactsim.figures.parts.rough_curves import WALL_LOOK, work_colours, work_label

INDENTATION = 20.0
"""Approach (nm) beyond first touch of the pictures."""
HORIZONTAL_TEXT: dict[str, Any] = {"ha": "center", "va": "bottom"}
VERTICAL_TEXT: dict[str, Any] = {"ha": "right", "va": "center", "rotation": 90}
BAR: dict[str, Any] = {"color": style.EXACT, "lw": 1.5, "solid_capstyle": "butt"}
"""Scale bars."""
PALE = 0.55
"""Share of white in a pale colour."""
MAX_NODES = 4000
"""Most nodes of a profile that are drawn, more than a picture can show."""
MANY_WAVES, FEW_WAVES = 512, 64
"""Period over the shortest wavelength, of two profiles that are compared."""


def plot_interface(
    axes: Axes, data: xr.Dataset, nodes: slice, *, colour: str, label: str, filled: bool = True, width: float = 0.9
) -> pd.DataFrame:
    """Plot the rigid profile and the deformed surface of the first member, over a part of the period.

    filled: the profile is grey; otherwise it is a faint line in the colour of the surface, beside one that is grey;
    width: of the line of the surface
    """
    state = data.isel(member=0).sel(snapshot=INDENTATION, method="nearest", tolerance=style.PLACE_TOLERANCE)
    x = state.x.values[nodes]
    rigid = -state.heights.values[nodes] - (float(state.approach_first_touch) + INDENTATION)
    surface = rigid - state.normal_gap.values[nodes]
    if filled:
        axes.fill_between(x, rigid, rigid.max() + 5.0, color="#cccccc", lw=0, zorder=0)
    axes.margins(x=0)
    axes.plot(x, rigid, **_rigid_look(colour, filled), label=f"_{label}, rigid profile")
    axes.plot(x, surface, lw=width, color=colour, label=label)
    axes.set(xlabel="$x$ (nm)", ylabel="$z$ (nm)")
    return pd.DataFrame({"x": x, "rigid": rigid, "surface": surface})


def _rigid_look(colour: str, filled: bool) -> dict[str, Any]:
    """Return the look of the rigid profile above a surface of a colour, which is grey if it is filled."""
    return {"color": style.GREY if filled else colour, "lw": 0.6, "alpha": 1.0 if filled else 0.5}


def plot_beside_wall(axes: Axes, data: xr.Dataset, wall: xr.Dataset, share: float) -> pd.DataFrame:
    """Plot the interface with the strongest adhesion, and the surface under a hard wall, over a part of the period."""
    strong = data.sel(work_of_separation=data.work_of_separation.max())
    nodes = nodes_around(strong, highest_place(strong), share)
    work = float(strong.work_of_separation)
    colour = work_colours(data.work_of_separation.values.tolist())[work]
    table = plot_interface(axes, strong, nodes, colour=colour, label=work_label(data, work), width=1.2)
    surface = _wall_surface(wall)[nodes]
    look: dict[str, Any] = {**WALL_LOOK, "marker": "", "label": "hard wall"}
    axes.plot(table.x, surface, **look)
    return table.assign(wall=surface)


def _wall_surface(wall: xr.Dataset) -> np.ndarray:
    """Return the height (nm) of the surface of the first member under a hard wall, at its last approach."""
    member = wall.isel(member=0)
    down = -member.heights.values - float(member.approach_first_touch) - INDENTATION
    return np.asarray(down - member.isel(step=-1).gap.values)


def add_scale_bars(axes: Axes, x: float, z: float) -> None:
    """Add bars along x and z with their lengths, from a place (nm)."""
    axes.plot([x + 80, x + 280], [z, z], **BAR, label="_200 nm")
    axes.text(x + 180, z + 0.8, "200 nm", fontsize=7, **HORIZONTAL_TEXT)
    axes.plot([x + 80, x + 80], [z, z + 10], **BAR, label="_10 nm")
    axes.text(x + 65, z + 5, "10 nm", fontsize=7, **VERTICAL_TEXT)


def add_magnification(axes: Axes) -> None:
    """Add how many times larger heights are drawn than lengths; the panel must have its final limits."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    figure.draw_without_rendering()  # gives the panel its final size
    box = axes.get_window_extent()
    heights, lengths = (abs(high - low) for low, high in (axes.get_ylim(), axes.get_xlim()))
    times = (box.height / heights) / (box.width / lengths)
    axes.text(0.03, 0.92, f"heights × {times:.2g}", transform=axes.transAxes, fontsize=7, va="top")


def highest_place(data: xr.Dataset) -> float:
    """Return the place of the highest point of the first member, as a part of the period."""
    heights = data.heights.isel(member=0).values
    return float(np.argmax(heights)) / heights.size


def nodes_around(data: xr.Dataset, place: float, share: float) -> slice:
    """Return nodes of a part of the period around a place, both as parts of the period: all, or evenly chosen ones."""
    count = data.x.size
    width = int(count * share)
    middle = int(np.clip(round(place * count), width // 2, count - width // 2))
    step = -(-width // MAX_NODES)
    half = width // 2 // step * step  # the place itself is among the nodes
    return slice(middle - half, middle + half, step)


def plot_waves(axes: Axes, many: xr.Dataset, few: xr.Dataset, share: float, dark: str) -> None:
    """Plot the interface around the highest point, with many (thick, pale) and with few short waves (thin, dark)."""
    place, handles = highest_place(many), []
    for data, waves, colour, width in ((many, MANY_WAVES, _paler(dark), 2.4), (few, FEW_WAVES, dark, 0.8)):
        nodes, filled, label = nodes_around(data, place, share), data is many, waves_label(waves)
        plot_interface(axes, data, nodes, colour=colour, label=label, filled=filled, width=width)
        handles.append(Line2D([], [], color=colour, lw=width, label=label))
        handles.append(Line2D([], [], label=f"{label}, rigid", **_rigid_look(colour, filled)))
    style.add_headroom(axes, 0.0, below=0.25)
    axes.legend(handles=handles, loc="lower center", ncols=2, fontsize=7, columnspacing=0.8, handlelength=1.2)
    add_magnification(axes)


def _paler(colour: str) -> str:
    """Return a colour mixed with white."""
    red, green, blue = (PALE + (1 - PALE) * part for part in mpl.colors.to_rgb(colour))
    return mpl.colors.to_hex((red, green, blue))


def waves_label(waves: int) -> str:
    """Return the label of the shortest wavelength over the period."""
    return rf"$\epsilon_f=1/{waves}$"
