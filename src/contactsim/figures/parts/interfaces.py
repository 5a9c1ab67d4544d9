"""Pictures of the interface of rough adhesive contacts: the rigid profile and the surface below it."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.figures import style
from contactsim.figures.parts import rough_curves as rough

INTERFACE = 20.0
"""Approach (nm) beyond first touch of the pictures of the interface."""
BESIDE = ({"ha": "center", "va": "bottom"}, {"ha": "right", "va": "center"})
"""Where words stand at a bar along x, and at one along z."""


def interface(
    axes: Axes, one: xr.Dataset, place: float, looks: dict[str, str], part: slice, filled: bool = True
) -> pd.DataFrame:
    """The rigid profile and the deformed surface of one member at a snapshot, over a part of the period.

    filled: the profile grey; else a line in the colour of the surface alone, beside another that is grey.
    """
    here = one.isel(member=0).sel(snapshot=place, method="nearest", tolerance=style.SAME)
    x = here.x.values[part]
    down = float(here.approach_first_touch) + place
    rigid = -here.heights.values[part] - down
    surface = rigid - here.normal_gap.values[part]
    if filled:
        axes.fill_between(x, rigid, rigid.max() + 5.0, color="#cccccc", lw=0, zorder=0)
    axes.margins(x=0)
    axes.plot(x, rigid, color="#777777" if filled else looks["color"], lw=0.6, alpha=1.0 if filled else 0.5)
    axes.plot(x, surface, lw=0.9, **looks)
    return pd.DataFrame({"x": x, "rigid": rigid, "surface": surface})


def beside_wall(data: xr.Dataset, wall: xr.Dataset, axes: Axes, part: float) -> pd.DataFrame:
    """The interface with the strongest adhesion, and the surface under a hard wall, over a part of the period."""
    strong = data.sel(work_of_separation=data.work_of_separation.max())
    place = about(strong, peak(strong), part)
    looks = {"color": style.PAIRS, "label": rough.work_words(data, float(strong.work_of_separation))}
    shown = interface(axes, strong, INTERFACE, looks, place)
    surface = _wall_surface(wall)[place]
    axes.plot(shown.x, surface, color=style.WHOLE, lw=0.9, label="hard wall")
    return shown.assign(wall=surface)


def _wall_surface(wall: xr.Dataset) -> np.ndarray:
    """Height (nm) of the surface of the first member under a hard wall, at its last approach."""
    one = wall.isel(member=0)
    return -one.heights.values - float(one.approach_first_touch) - INTERFACE - one.isel(step=-1).gap.values


def scale_bars(axes: Axes, begin: float, bottom: float) -> None:
    """Bars along x and z with their lengths, from a place."""
    for ends, words in (
        (([begin + 80, begin + 280], [bottom, bottom]), "200 nm"),
        (([begin + 80, begin + 80], [bottom, bottom + 10]), "10 nm"),
    ):
        axes.plot(*ends, color=style.EXACT, lw=1.5, solid_capstyle="butt")
        upright = ends[0][0] == ends[0][1]
        place = (begin + 65, bottom + 5) if upright else (begin + 180, bottom + 0.8)
        axes.text(*place, words, rotation=90 * upright, fontsize=7, **BESIDE[upright])


def peak(one: xr.Dataset) -> float:
    """Where the highest point of the first member is, in parts of the period."""
    heights = one.heights.isel(member=0).values
    return float(np.argmax(heights)) / heights.size


def about(one: xr.Dataset, place: float, share: float) -> slice:
    """A part of the period about a place, also given as a part of it."""
    count = one.x.size
    width = int(count * share)
    middle = int(np.clip(round(place * count), width // 2, count - width // 2))
    return slice(middle - width // 2, middle + width // 2)
