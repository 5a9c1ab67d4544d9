"""Chapter 2: what acts at the interface. Each function draws one figure and returns the numbers that it shows."""

from __future__ import annotations

import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from contactsim import dataset, reference
from contactsim.figures import style


def fig_2_2(data: xr.Dataset, axes: list[Axes]) -> pd.DataFrame:
    """Normal traction for several tangential gaps, tangential traction for several normal gaps (thesis Fig. 2.2).

    Dots: the strengths of Eq. 2.18.
    """
    law = dataset.settings_of(data)
    lengths = {"normal": law["normal_length"], "tangential": law["tangential_length"]}
    works = {"normal": law["work_of_separation"], "tangential": law["work_of_separation"] * law["work_ratio"]}
    rows = []
    for panel, name, other, along, sign, strength, peak in (
        (axes[0], "normal", "tangential", "opening", "n", reference.normal_strength, 1.0),
        (axes[1], "tangential", "normal", "slip_gap", "t", reference.tangential_strength, 2**-0.5),
    ):
        fixed, unit = f"{other}_gap", works[name] / lengths[name]
        subscript = {"n": "t", "t": "n"}[sign]
        colours = style.shades(data[fixed].values)
        for value, colour in colours.items():
            curve = data[f"{name}_traction"].sel({fixed: value})
            ratio = value / lengths[other]
            words = rf"$\Delta_{subscript}/\delta_{subscript}={ratio:g}$"
            panel.plot(data[along] / lengths[name], curve / unit, color=colour, lw=1.2, label=words)
            top = strength(works[name], lengths[name], ratio) / unit
            panel.plot([peak], [top], "o", color=colour, ms=4, mfc="white")
            if sign == "t":
                panel.plot([-peak], [-top], "o", color=colour, ms=4, mfc="white")
            shown = pd.DataFrame({along: data[along].values, "traction": curve.values, "strength": top * unit})
            rows.append(shown.rename(columns={along: "gap"}).assign(component=name, fixed_gap=value))
        panel.axhline(0.0, color=style.EXACT, lw=0.5)
        panel.axvline(0.0, color=style.EXACT, lw=0.5)
        panel.set(
            xlabel=rf"$\Delta_{sign}/\delta_{sign}$",
            ylabel=rf"$T_{{\mathrm{{if}},{sign}}}\,\delta_{sign}/\varphi_{sign}$",
        )
        panel.set_xlim(data[along].values[[0, -1]] / lengths[name])
        panel.legend(loc="lower right")
    style.letters(axes)
    return pd.concat(rows)[["component", "fixed_gap", "gap", "traction", "strength"]]


def footer(data: xr.Dataset) -> str:
    """What the curves are: nothing is simulated."""
    law = dataset.settings_of(data)
    words = law["effect"].replace("_", " ")
    return f"{words} (Eq. 2.17) with φt/φn = {law['work_ratio']:g}, evaluated; nothing is simulated"
