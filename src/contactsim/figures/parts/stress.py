"""Maps of the stress inside a body, as it lies below its surface."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim.elasticity.subsurface import Fields
from contactsim.figures import style

STRESSES = {"stress_xx": r"$\sigma_{xx}$", "stress_zz": r"$\sigma_{zz}$", "stress_xz": r"$\sigma_{xz}$"}
COLOURS = "RdBu_r"
"""Tension red, compression blue, none white."""


def draw(fields: Fields, axes: Sequence[Axes], scale: float = 1.0, unit: str = "GPa") -> pd.DataFrame:
    """Map σ_xx, σ_zz and σ_xz onto three axes, each on a colour scale of its own, symmetric about zero.

    scale: stress (GPa) that the colours count in, with its name in `unit`, such as a peak pressure and "$p_0$".
    Returns what is shown: one row for each depth and position.
    """
    shown = pd.DataFrame(
        {"depth": np.repeat(fields.depth, fields.position.size), "x": np.tile(fields.position, fields.depth.size)}
    )
    for panel, values, (name, symbol) in zip(axes, np.moveaxis(fields.stress, 1, 0), STRESSES.items(), strict=True):
        values = values / scale
        shown[name] = values.ravel()
        limit = np.abs(values).max() or 1.0
        colours = {"cmap": COLOURS, "vmin": -limit, "vmax": limit}
        mesh = panel.pcolormesh(fields.position, fields.depth, values, shading="gouraud", rasterized=True, **colours)
        panel.contour(
            fields.position, fields.depth, values, levels=limit * np.linspace(-0.9, 0.9, 10), colors="k", linewidths=0.3
        )
        panel.figure.colorbar(mesh, ax=panel, label=f"{symbol} ({unit})", location="bottom", aspect=25)
        panel.set(
            xlabel=r"$x$ (nm)", ylabel="depth (nm)", aspect="equal", ylim=(fields.depth.max(), fields.depth.min())
        )
        panel.tick_params(direction="out", top=False, right=False)
    style.letters(axes)
    return shown
