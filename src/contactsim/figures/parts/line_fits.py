"""Curves of Eq. 3.11 fitted to the contact area of rough lines (Fig. 3.3)."""

from __future__ import annotations

from typing import Any

import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim.analysis.rounding import rounded_texts
from contactsim.figures import style
from contactsim.figures.parts.proportionality import AS_IN_THESIS, CORRECTED, ESTIMATORS, persson_curve
from contactsim.grid import Array
from contactsim.reference import hard_wall

WEIGHTINGS = {"area": "the area", "logarithm": "its logarithm"}
"""What a fit minimises: its name in a dataset, and in words."""
POINTS = 200
"""Points of a curve."""


def plot_fits(axes: Axes, data: xr.Dataset) -> None:
    """Plot the fits of one weighting by both estimators, the corrected κ that they are fitted to, and Persson's κ.

    data: of a study of rough lines, at one limit of pressure.
    """
    pressure, persson = persson_curve(data, POINTS)
    for words, (end, look) in ESTIMATORS.items():
        for name in data.fitted.values:
            fit = data.sel(fitted=name)
            kappa = fitted_kappa(pressure, fit[f"fit_b1{end}"].item(), fit[f"fit_b2{end}"].item())
            line = {key: value for key, value in look.items() if key == "alpha"}
            axes.plot(pressure, kappa, **fit_look(str(name)) | line, label=f"fit to {_fitted_words(name)}, {words}")
    for hurst_exponent in data.hurst_exponent.values:
        means = data.sel(hurst_exponent=hurst_exponent)
        look = style.hurst_look(hurst_exponent) | {"linestyle": "none", "color": style.GREY}
        look |= {"label": f"$H={hurst_exponent:g}$, {CORRECTED}"}
        style.plot_means(axes, means.reduced_pressure, means, "kappa_corrected", **look)
    axes.plot(pressure, persson / pressure, color=style.EXACT, lw=0.8, ls="-.", label="Persson (2D)")


def _fitted_words(fitted: str) -> str:
    """Return what was fitted: one Hurst exponent, or all."""
    return "all $H$" if fitted == "all" else f"$H={fitted}$"


def fit_look(fitted: str) -> dict[str, Any]:
    """Return the line of a fit to one Hurst exponent, or to all."""
    if fitted == "all":
        return {"color": style.PAIRS, "lw": 1.8, "ls": "--"}
    return {"color": style.WHOLE, "lw": 1.3, "ls": style.hurst_look(float(fitted))["linestyle"]}


def fit_handles(data: xr.Dataset) -> list[Line2D]:
    """Return legend handles of the fits with their constants, of the estimators and of the data."""
    handles = []
    for name in data.fitted.values:
        fit = data.sel(fitted=name)
        b1, b2 = (_constant_text(fit, f"fit_{constant}_corrected") for constant in ("b1", "b2"))
        handles.append(
            Line2D([], [], label=f"{_fitted_words(name)}: $b_1$ = {b1}, $b_2$ = {b2}", **fit_look(str(name)))
        )
    handles.append(Line2D([], [], color=style.GREY, alpha=style.FAINT, label=f"the same fits, area {AS_IN_THESIS}"))
    markers: dict[str, Any] = {"color": style.GREY, "marker": "o", "mfc": "white", "ms": 3.5, "ls": "none"}
    handles.append(Line2D([], [], label=f"$\\kappa$, {CORRECTED}", **markers))
    return handles + style.line_handles({"Persson (2D)": "-."})


def _constant_text(fit: xr.Dataset, name: str) -> str:
    """Return a constant of a fit with half the width of its confidence interval."""
    value, half_width = rounded_texts(fit[name].item(), fit[f"{name}_half_width"].item())
    return f"{value} ± {half_width}"


def fit_table(data: xr.Dataset) -> pd.DataFrame:
    """Return the constants of every fit by both estimators, and κ of it at each load of the data."""
    names = [name for name in data.data_vars if str(name).startswith("fit_")]
    kappa = {
        f"kappa_fit{end}": xr.apply_ufunc(
            fitted_kappa, data.reduced_pressure, data[f"fit_b1{end}"], data[f"fit_b2{end}"]
        )
        for end, _ in ESTIMATORS.values()
    }
    order = [*data.fit_b1.dims, "reduced_pressure"]
    return data[names].assign(kappa).to_dataframe(dim_order=order).reset_index()


def fitted_kappa(pressure: Array, b1: float, b2: float) -> Array:
    """Return κ = a_rel/p* of Eq. 3.11; arrays of constants broadcast."""
    return hard_wall.line_area(pressure, b1, b2) / pressure
