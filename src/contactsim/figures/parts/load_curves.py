"""Curves of load against approach, with their jumps and their largest pull."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim.analysis.ensemble import converged
from contactsim.analysis.scales import LawScales, reduced_line_load
from contactsim.figures import style
from contactsim.observables.path_summary import LEGS, legs

LOAD_LABEL = r"$\bar L=L\times 1\,\mathrm{µm}/(\pi R\varphi_0)$"
NEGLIGIBLE_LOAD = 0.01
"""Part of the largest load below which a curve is not shown."""


def plot_leg(axes: Axes, data: xr.Dataset, leg: str, **look: Any) -> pd.DataFrame:
    """Plot loading or unloading of one path; the largest pull is a dot, jumps are dotted lines.

    Parameters
    ----------
    axes : to plot on
    data : one path; states that did not converge are left out
    leg : one of `LEGS`
    look : of the curve, with its color and label

    Returns
    -------
    table : approach over δn, reduced load and jump of the states
    """
    states = legs(data.approach.values)[LEGS.index(leg)]
    approach = data.approach.values[states] / LawScales.of(data).normal_length
    load = reduced_line_load(converged(data.line_load, data).values[states], data)
    jumps = np.flatnonzero(data.jump.values[states] > 0)
    label = look.pop("label")
    name = label if label.startswith("_") else f"_{label}"
    for number, piece in enumerate(np.split(np.arange(load.size), jumps)):
        piece_label = f"{name}, after jump {number}" if number else label
        axes.plot(approach[piece], load[piece], **look, label=piece_label)
    for number, jump in enumerate(jumps[jumps > 0], 1):
        ends = slice(jump - 1, jump + 1)
        axes.plot(approach[ends], load[ends], color=look["color"], ls=":", lw=0.7, label=f"{name}, jump {number}")
    if np.isfinite(load).any():
        lowest = np.nanargmin(load)
        axes.plot(approach[lowest], load[lowest], "o", color=look["color"], ms=3, label=f"{name}, largest pull")
    return pd.DataFrame({"approach": approach, "load": load, "jump": data.jump.values[states]})


def label_panels(axes: list[Axes], titles: tuple[str, ...]) -> None:
    """Label panels of load against approach, and limit them to where the load is not negligible."""
    for panel, title in zip(axes, titles, strict=True):
        points = np.concatenate([line.get_xydata() for line in panel.lines])
        loaded = points[np.abs(points[:, 1]) > NEGLIGIBLE_LOAD * np.nanmax(np.abs(points[:, 1])), 0]
        panel.set_xlim(loaded.min() - 2.0, loaded.max() + 1.0)
        panel.axhline(0.0, **style.ZERO)
        panel.set(xlabel=r"approach $\delta/\delta_n$", ylabel=LOAD_LABEL)
        panel.set_title(title, fontsize=9)
    style.add_letters(axes)
