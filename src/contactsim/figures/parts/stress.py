"""Maps of the stress inside a body, as it lies below its surface."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim.elasticity.subsurface import SubsurfaceFields
from contactsim.figures import style
from contactsim.grid import Array

STRESSES = {"stress_xx": r"$\sigma_{xx}$", "stress_zz": r"$\sigma_{zz}$", "stress_xz": r"$\sigma_{xz}$"}
COLOURS = "RdBu_r"
"""Tension red, compression blue, none white."""


def plot_stress(fields: SubsurfaceFields, axes: Sequence[Axes], scale: float = 1.0, unit: str = "GPa") -> pd.DataFrame:
    """Map σ_xx, σ_zz and σ_xz onto three axes, each on its own colour scale, symmetric about zero.

    Parameters
    ----------
    fields : inside the body
    axes : three panels
    scale : unit of the colours, GPa, such as a peak pressure
    unit : its name, such as "$p_0$"

    Returns
    -------
    table : depth, x and the three stresses, one row for each depth and position
    """
    table = pd.DataFrame(
        {"depth": np.repeat(fields.depth, fields.position.size), "x": np.tile(fields.position, fields.depth.size)}
    )
    for panel, stress, (name, symbol) in zip(axes, np.moveaxis(fields.stress, 1, 0), STRESSES.items(), strict=True):
        table[name] = (stress / scale).ravel()
        _plot_map(panel, fields, stress / scale, f"{symbol} ({unit})")
    style.add_letters(axes)
    return table


def _plot_map(axes: Axes, fields: SubsurfaceFields, values: Array, label: str) -> None:
    """Map one stress, with lines at tenths of its largest value."""
    limit = np.abs(values).max() or 1.0
    place = fields.position, fields.depth
    colours = {"cmap": COLOURS, "vmin": -limit, "vmax": limit}
    mesh = axes.pcolormesh(*place, values, shading="gouraud", rasterized=True, label=label, **colours)
    axes.contour(*place, values, levels=limit * np.linspace(-0.9, 0.9, 10), colors="k", linewidths=0.3)
    axes.figure.colorbar(mesh, ax=axes, label=label, location="bottom", aspect=25)
    depths = fields.depth.max(), fields.depth.min()
    axes.set(xlabel=r"$x$ (nm)", ylabel="depth (nm)", aspect="equal", ylim=depths)
    axes.tick_params(direction="out", top=False, right=False)
