"""Curves of contact area and of the factors κ and κ_r against reduced pressure (Chapter 3)."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from contactsim import reference
from contactsim.analysis import ensemble
from contactsim.figures import style
from contactsim.grid import Array

GRADIENTS = {
    r"$\bar g$ over the whole surface": style.WHOLE,
    r"$\bar g_r$ over the contact (Eq. 3.8)": style.CONTACT,
    r"$\bar g_r$ over pairs in contact": style.PAIRS,
}
"""Labels and colours of the gradients that a factor counts with."""
FACTOR_COLOURS = {"kappa": style.WHOLE, "kappa_r": style.CONTACT, "kappa_r_pairs": style.PAIRS}
FIT_LINES: dict[str, dict[str, Any]] = {"area": {"lw": 1.6, "alpha": 1.0}, "logarithm": {"lw": 0.8, "alpha": 0.6}}
"""Lines of fits, by what they minimise."""


def plot_areas(axes: Axes, data: xr.Dataset) -> None:
    """Plot the mean area against the reduced pressure p* and against p_r*, one curve a Hurst exponent."""
    for hurst_exponent in data.hurst_exponent.values:
        means, look = data.sel(hurst_exponent=hurst_exponent), style.hurst_look(hurst_exponent)
        for pressure, colour in (
            (means.reduced_pressure, style.WHOLE),
            (means.reduced_pressure_contact_mean, style.CONTACT),
        ):
            style.plot_means(axes, pressure, means, "relative_contact_area", color=colour, **look)
    axes.set(yscale="log", ylabel=r"relative contact area $a_{\mathrm{rel}}$")


def plot_factors(axes: Axes, data: xr.Dataset, names: tuple[str, ...]) -> None:
    """Plot mean factors of proportionality, κ against p*, κ_r against p_r*, one curve a Hurst exponent."""
    for hurst_exponent in data.hurst_exponent.values:
        means = data.sel(hurst_exponent=hurst_exponent)
        for name in names:
            look = style.hurst_look(hurst_exponent) | {"color": FACTOR_COLOURS[name]}
            style.plot_means(axes, _pressure(means, name), means, name, **look)


def plot_grid_errors(axes: Axes, data: xr.Dataset, names: tuple[str, ...]) -> None:
    """Plot the grid errors of factors of proportionality, one curve a Hurst exponent."""
    for hurst_exponent in data.hurst_exponent.values:
        means = data.sel(hurst_exponent=hurst_exponent)
        for name in names:
            look = style.hurst_look(hurst_exponent) | {"color": FACTOR_COLOURS[name]}
            style.plot_grid_error(axes, _pressure(means, name), means, name, **look)
    axes.set(yscale="log")


def _pressure(means: xr.Dataset, name: str) -> xr.DataArray:
    """Return the reduced pressure that a factor is plotted against."""
    return means.reduced_pressure if name == "kappa" else means.reduced_pressure_contact_mean


def persson_curve(data: xr.Dataset, points: int = 100) -> tuple[Array, Array]:
    """Return reduced pressures over the range of a dataset, and Persson's area erf(√2 p*) at them."""
    pressure = np.geomspace(*data.reduced_pressure.values[[0, -1]], points)
    return pressure, reference.persson_area(pressure)


def plot_persson(area: Axes, factor: Axes, data: xr.Dataset) -> None:
    """Plot Persson's area and the factor κ that follows from it."""
    pressure, persson = persson_curve(data)
    area.plot(pressure, persson, color=style.EXACT, lw=0.8)
    factor.plot(pressure, persson / pressure, color=style.EXACT, lw=0.8)


def constancy_text(data: xr.Dataset) -> str:
    """Return the most significant changes of κ_r with pressure and with the Hurst exponent; empty for one member."""
    if data.member.size < 2:
        return ""
    lines = []
    for along, symbol, other in (("reduced_pressure", "$p^*$", "$H$"), ("hurst_exponent", "$H$", "$p^*$")):
        change = ensemble.departure(data, "kappa_r", along)
        first, second = (place[along] for place in change.places)
        (fixed,) = (value for name, value in change.places[0].items() if name != along)
        lines.append(rf"{symbol} from {first:g} to {second:g} at {other} = {fixed:g}: $\kappa_r$ changes")
        lines.append(f"    by {change.difference:.3f}, {change.in_errors:.1f} standard errors")
    return "\n".join(lines)


def fit_look(fitted: str, weighting: str) -> dict[str, Any]:
    """Return the line of a fit; that to all Hurst exponents is broad and lies below those to one of them."""
    look = FIT_LINES[weighting]
    if fitted == "all":
        return {"color": style.PAIRS, "lw": 2.5 * look["lw"], "alpha": 0.5 * look["alpha"], "zorder": 1.5}
    line = "-" if fitted == "one" else style.hurst_look(float(fitted))["linestyle"]
    return look | {"color": style.WHOLE, "ls": line}


def fitted_kappa(pressure: Array, b1: Array, b2: Array) -> Array:
    """Return κ = a_rel/p* of Eq. 3.11; the arrays broadcast."""
    return reference.line_area(pressure, b1, b2) / pressure
