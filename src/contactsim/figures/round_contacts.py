"""Contacts of a cylinder and of a sphere beside the exact answers: figures, each of which returns its numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim.analysis.mean_errors import grid_error
from contactsim.analysis.round_contact import beside_exact
from contactsim.figures import style
from contactsim.figures.parts import proportionality

FREE_OF_NEIGHBOURS = 0.25
"""Largest c/R at which a cylinder or sphere at L/R = 4 does not feel its neighbours."""
ROUND_LABELS = {
    "cylinder": r"cylinder, exact $8/(\pi\sqrt{3})$ = 1.470",
    "sphere": r"sphere, exact $3\pi/(4\sqrt{2})$ = 1.666",
}
ROUND_LOOKS = {"cylinder": ("o", "-"), "sphere": ("s", "--")}
"""Marker of κ_r and line of the exact value."""
ROUND_ESTIMATORS: dict[str, tuple[str, dict[str, Any]]] = {
    proportionality.AS_IN_THESIS: ("", {"mfc": "white", "ms": 6.0}),
    proportionality.CORRECTED: ("_corrected", {"ms": 2.6}),
}
"""Estimators of κ_r of a smooth body: the small markers fit into the large ones where both agree."""
TABLE_HEADS = {
    "contact_ratio": r"$c/R$",
    "area_exact": "$a_{act}$\nexact",
    "area_array": "$a_{act}$\nperiodic",
    "area": "$a_{act}$\nthesis",
    "area_corrected": "$a_{act}$\ncorrected",
    "load": "$L$\ngiven",
    "rms_gradient_exact": r"$\bar g_r$" + "\nexact",
    "rms_gradient_array": r"$\bar g_r$" + "\nperiodic",
    "rms_gradient_contact": r"$\bar g_r$" + "\nthesis",
    "rms_gradient_contact_corrected": r"$\bar g_r$" + "\ncorrected",
    "kappa_r_exact": r"$\kappa_r$" + "\nexact",
    "kappa_r_array": r"$\kappa_r$" + "\nperiodic",
    "kappa_r": r"$\kappa_r$" + "\nthesis",
    "kappa_r_corrected": r"$\kappa_r$" + "\ncorrected",
}


def fig_3_1(line: xr.Dataset, surface: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Plot κ_r of a cylinder and of a sphere against the load, on which it does not depend (thesis Fig. 3.1)."""
    lines, tables = [], []
    for data, name in ((line, "cylinder"), (surface, "sphere")):
        body = beside_exact(data)
        exact_line = ROUND_LOOKS[name][1]
        is_free = body.contact_ratio.values <= FREE_OF_NEIGHBOURS
        _plot_kappa_r(axes, body.isel(contact_ratio=is_free), name, 1.0)
        _plot_kappa_r(axes, body.isel(contact_ratio=~is_free), f"{name} near its neighbours", style.FAINT)
        exact = float(body.kappa_r_exact[0])
        lines.append(axes.axhline(exact, color=style.EXACT, lw=1, ls=exact_line, label=ROUND_LABELS[name]))
        tables.append(body.to_dataframe().reset_index().assign(body=name))
    array = beside_exact(line)
    pressure = array.mean_pressure / (array.rms_gradient_array * array.contact_modulus)
    look: dict[str, Any] = {"color": style.EXACT, "lw": 1, "ls": ":", "label": "cylinders $4R$ apart, exact"}
    lines += axes.plot(pressure, array.kappa_r_array, **look)
    markers = [
        Line2D([], [], ls="", label=f"{name}, {words}", color=style.CONTACT, marker=ROUND_LOOKS[name][0], **look)
        for words, (_, look) in ROUND_ESTIMATORS.items()
        for name in ROUND_LOOKS
    ]
    axes.set(xscale="log", xlabel=r"reduced pressure $p_r^*$", ylabel=r"$\kappa_r$")
    style.add_headroom(axes, 0.5)
    axes.legend(handles=markers + lines, loc="upper left", ncols=2)
    return pd.concat(tables)[["body", *TABLE_HEADS]]


def _plot_kappa_r(axes: Axes, body: xr.Dataset, name: str, alpha: float) -> None:
    """Plot κ_r of a cylinder or sphere by both estimators with its grid error.

    The bar of the estimator of the thesis leads from its value to that less its change on halving the grid once more,
    since its error has a known sign. name: of the body, with its neighbours or without
    """
    for words, (end, look) in ROUND_ESTIMATORS.items():
        quantity = f"kappa_r{end}"
        bars: Any = None
        if f"{quantity}_grid_change" in body and end:
            bars = grid_error(body, quantity)
        elif f"{quantity}_grid_change" in body:
            change = body[f"{quantity}_grid_change"]
            bars = np.stack([np.maximum(-change, 0), np.maximum(change, 0)])
        curve = look | {"color": style.CONTACT, "alpha": alpha, "fmt": ROUND_LOOKS[name.split()[0]][0]}
        curve |= {"elinewidth": 0.7, "label": f"{name}, {words}"}
        pressure = body[f"reduced_pressure_contact{end}"]
        axes.errorbar(pressure, body[quantity], bars, zorder=3 if end else 2, **curve)


def table_3_1(line: xr.Dataset, surface: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Draw the table of a cylinder's and a sphere's contact, exact and computed (thesis Table 3.1)."""
    bodies = {"cylinder": beside_exact(line), "sphere": beside_exact(surface)}
    tables = [body.to_dataframe().reset_index().assign(body=name) for name, body in bodies.items()]
    table = pd.concat(tables)[["body", *TABLE_HEADS]]
    text = [[name, f"{ratio:g}", *map(_digits, values)] for name, ratio, *values in table.to_numpy()]
    style.draw_table(axes, ["", *TABLE_HEADS.values()], text)
    return table


def _digits(value: float) -> str:
    """Return a number with four digits, a small one with three; a dash for NaN."""
    digits = 4 if value >= 1e-3 else 3
    return f"{value:#.{digits}g}" if np.isfinite(value) else "–"
