"""Tractions of a coupled law against one gap, at fixed values of the other."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim import dataset
from contactsim.analysis.scales import LawScales
from contactsim.figures import style
from contactsim.reference import adhesion

NORMAL_PEAK, TANGENTIAL_PEAK = 1.0, 2**-0.5
"""Gaps of the strengths, over the characteristic lengths (Eq. 2.18)."""


def plot_tractions(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Plot both tractions of a tabulated law on two axes; return curves and strengths."""
    law = LawScales.of(data)
    normal = _plot_normal(axes[0], data, law)
    tangential = _plot_tangential(axes[1], data, law)
    return pd.concat([*normal, *tangential])[["component", "fixed_gap", "gap", "traction", "strength", "bsg_traction"]]


def _plot_normal(axes: Axes, data: xr.Dataset, law: LawScales) -> list[pd.DataFrame]:
    """Plot the normal traction against the normal gap."""
    tables, length, unit = [], law.normal_length, law.work_of_separation / law.normal_length
    for gap, colour in style.shades(data.tangential_gap).items():
        ratio = gap / law.tangential_length
        traction = data.normal_traction.sel(tangential_gap=gap)
        label = rf"$\Delta_t/\delta_t={ratio:g}$"
        axes.plot(data.opening / length, traction / unit, color=colour, lw=1.2, label=label)
        strength = adhesion.normal_strength(law.work_of_separation, length, ratio) / unit
        axes.plot([NORMAL_PEAK], [strength], **style.marker_look(colour), label=f"_{label}, strength")
        tables.append(_table("normal", gap, data.opening, traction, strength * unit))
    _label(axes, "n", data.opening / length)
    return tables


def _plot_tangential(axes: Axes, data: xr.Dataset, law: LawScales) -> list[pd.DataFrame]:
    """Plot the tangential traction and the BSG law's against the tangential gap, with strengths in both directions."""
    tables, length, unit = [], law.tangential_length, law.tangential_work / law.tangential_length
    for gap, colour in style.shades(data.normal_gap).items():
        ratio = gap / law.normal_length
        traction = data.tangential_traction.sel(normal_gap=gap)
        label = rf"$\Delta_n/\delta_n={ratio:g}$"
        axes.plot(data.slip_gap / length, traction / unit, color=colour, lw=1.2, label=label)
        strength = adhesion.tangential_strength(law.tangential_work, length, ratio) / unit
        bsg = adhesion.bsg_factor(ratio) * traction
        axes.plot(data.slip_gap / length, bsg / unit, color=colour, lw=1.0, ls=":", label=f"_{label}, BSG law")
        peaks = np.array([-1.0, 1.0])
        look = style.marker_look(colour) | {"ls": "none", "label": f"_{label}, strengths"}
        axes.plot(peaks * TANGENTIAL_PEAK, peaks * strength, **look)
        tables.append(_table("tangential", gap, data.slip_gap, traction, strength * unit).assign(bsg_traction=bsg))
    _label(axes, "t", data.slip_gap / length)
    return tables


def _table(
    component: str, fixed_gap: float, gap: xr.DataArray, traction: xr.DataArray, strength: float
) -> pd.DataFrame:
    """Return one curve with its strength."""
    curve = pd.DataFrame({"gap": gap.values, "traction": traction.values, "strength": strength})
    return curve.assign(component=component, fixed_gap=fixed_gap)


def _label(axes: Axes, index: str, gap: xr.DataArray) -> None:
    """Add zero lines, labels and legend."""
    axes.axhline(0.0, **style.ZERO)
    axes.axvline(0.0, **style.ZERO | {"label": "_closed" if index == "n" else "_no slip"})
    axes.set_xlabel(rf"$\Delta_{index}/\delta_{index}$")
    axes.set_ylabel(rf"$T_{{\mathrm{{if}},{index}}}\,\delta_{index}/\varphi_{index}$")
    axes.set_xlim(gap.values[[0, -1]])
    axes.legend(loc="lower right")


def footer(data: xr.Dataset) -> str:
    """Return the law of the curves; nothing is simulated."""
    law = dataset.settings_of(data)
    name = law["effect"].replace("_", " ")
    return f"{name} (Eq. 2.17) with φt/φn = {law['work_ratio']:g}, evaluated; nothing is simulated"
