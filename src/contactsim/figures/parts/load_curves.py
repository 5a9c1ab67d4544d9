"""Paths of adhesive contacts as curves: load against approach in its two legs, jumps dotted, and what they need."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim import dataset
from contactsim.analysis.ensemble import converged
from contactsim.grid import Array
from contactsim.observables.adhesion import LEGS, legs

THICKNESS, WORK_UNIT = 1000.0, 1.0
"""Of the bodies, nm, and φ0, N/m: what makes the thesis's loads numbers."""
LOAD_LABEL = r"$\bar L=L/(\pi R\varphi_0)$, thickness 1 µm"


def settings(data: xr.Dataset) -> dict:
    """The settings of the study."""
    return dataset.settings_of(data)


def radius(data: xr.Dataset) -> float:
    """Radius of the cylinder, nm."""
    return settings(data)["surface"]["radius"]


def normal_length(data: xr.Dataset) -> float:
    """Normal characteristic length of the first effect, nm."""
    known = settings(data)
    return known[known["effects"][0]]["normal_length"]


def normalised(load: Array, data: xr.Dataset) -> Array:
    """Line loads (N/m) over πRφ0, of bodies 1 µm thick (Eq. 4.3)."""
    return load * THICKNESS / (np.pi * radius(data) * WORK_UNIT)


def centred(data: xr.Dataset) -> tuple[Array, Array]:
    """Positions from the highest point of the upper surface, nm, ascending, and the nodes that they belong to."""
    heights = data.heights.isel(member=0) if "member" in data.heights.dims else data.heights
    middle, count = int(np.argmax(heights.values)), data.x.size
    order = (np.arange(count) - count // 2 + middle) % count
    return (np.arange(count) - count // 2) * float(data.length) / count, order


def branch(axes: Axes, one: xr.Dataset, leg: str, **look: object) -> pd.DataFrame:
    """One leg of a path, its largest pull a dot, its jumps dotted lines; what did not converge is left out."""
    part = legs(one.approach.values)[LEGS.index(leg)]
    approach = one.approach.values[part] / normal_length(one)
    load = normalised(converged(one.line_load, one).values[part], one)
    jumps = np.flatnonzero(one.jump.values[part] > 0)
    words = {"label": look.pop("label", None)}
    for piece in np.split(np.arange(load.size), jumps):
        axes.plot(approach[piece], load[piece], **look, **words)
        words = {}
    for jump in jumps[jumps > 0]:
        axes.plot(approach[jump - 1 : jump + 1], load[jump - 1 : jump + 1], color=look["color"], ls=":", lw=0.7)
    if np.isfinite(load).any():
        least = np.nanargmin(load)
        axes.plot(approach[least], load[least], "o", color=look["color"], ms=3)
    return pd.DataFrame({"approach": approach, "load": load, "jump": one.jump.values[part]})
