"""Curves of contact area and of the factors κ and κ_r against reduced pressure (Chapter 3)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim.analysis.mean_errors import estimate_trend, grid_error, mean_error
from contactsim.analysis.rounding import rounded_texts
from contactsim.figures import style
from contactsim.grid import Array
from contactsim.reference.persson import persson_area
from contactsim.variables import RESULTS

GRADIENTS = {
    r"$\kappa$: $\bar g$ of the whole surface": style.WHOLE,
    r"$\kappa_r$: $\bar g_r$ over the contact": style.CONTACT,
}
"""Labels and colours of the gradients that a factor counts with."""
FACTOR_COLOURS = {"kappa": style.WHOLE, "kappa_r": style.CONTACT}
PRESSURES = {"kappa": "$p^*$", "kappa_r": "$p_r^*$"}
"""Reduced pressure that a factor is plotted against."""
PERSSON_LABEL = r"Persson (2D), erf$(\sqrt{2}p^*)$"
CORRECTED, AS_IN_THESIS = "corrected for the grid", "as in the thesis"
ESTIMATORS: dict[str, tuple[str, dict[str, Any]]] = {
    AS_IN_THESIS: ("", {"marker": "", "alpha": style.FAINT, "linewidth": 1.6}),
    CORRECTED: ("_corrected", {}),
}
"""Estimators of area and gradient: the end of a quantity's name, and what differs in the look of its curves."""


def _curves(data: xr.Dataset) -> Iterator[tuple[xr.Dataset, str, dict[str, Any]]]:
    """Yield the means of each Hurst exponent with the end of an estimator's names, look and label of its curves."""
    for hurst_exponent in data.hurst_exponent.values:
        for words, (end, look) in ESTIMATORS.items():
            label = {"label": f"$H={hurst_exponent:g}$, {words}"}
            yield data.sel(hurst_exponent=hurst_exponent), end, style.hurst_look(hurst_exponent) | look | label


def plot_areas(axes: Axes, data: xr.Dataset) -> None:
    """Plot the mean area against the reduced pressure p* and against p_r*, by both estimators."""
    for means, end, look in _curves(data):
        area, error = means[f"relative_contact_area{end}_mean"], _bars(means, "relative_contact_area", end)
        for factor, colour in FACTOR_COLOURS.items():
            curve = look | {"color": colour, "label": f"against {PRESSURES[factor]}, {look['label']}"}
            style.errorbars(axes, _pressure(means, factor + end), area, error, **curve)
    axes.set(yscale="log", ylabel=r"relative contact area $a_{\mathrm{rel}}$")


def plot_factors(axes: Axes, data: xr.Dataset, names: Iterable[str]) -> None:
    """Plot mean factors of proportionality by both estimators, κ against p*, κ_r against p_r*."""
    for means, end, look in _curves(data):
        for name in names:
            mean, error = means[f"{name}{end}_mean"], _bars(means, name, end)
            style.errorbars(axes, _pressure(means, name + end), mean, error, **_factor_look(name, look))


def plot_distances(axes: Axes, data: xr.Dataset, levels: Mapping[str, float]) -> None:
    """Plot how far corrected mean factors lie above given values, in per cent; levels: the values."""
    corrected = (curve for curve in _curves(data) if curve[1] == ESTIMATORS[CORRECTED][0])
    for means, end, look in corrected:
        for name, level in levels.items():
            distance = 100 * (means[f"{name}{end}_mean"] / level - 1)
            error = 100 * _bars(means, name, end) / level
            style.errorbars(axes, _pressure(means, name + end), distance, error, **_factor_look(name, look))
    axes.axhline(0, **style.ZERO)


def plot_grid_errors(axes: Axes, data: xr.Dataset, names: Iterable[str]) -> None:
    """Plot the grid errors of mean factors in per cent, by both estimators, also on the thesis's own grid."""
    for means, end, look in _curves(data):
        for name in names:
            if f"{name}{end}_grid_error" in means:
                change = means[f"{name}{end}_grid_error"]
                error = 100 * (grid_error(means, name + end) if end else change) / means[f"{name}{end}_mean"]
                axes.plot(_pressure(means, name + end), error, **_factor_look(name, look))
    axes.set(yscale="log")


def _factor_look(name: str, look: Mapping[str, Any]) -> dict[str, Any]:
    """Return the look of the curve of a factor, with its colour and its symbol in the label."""
    return {**look, "color": FACTOR_COLOURS[name], "label": f"{RESULTS[name].symbol}, {look['label']}"}


def _bars(means: xr.Dataset, name: str, end: str) -> xr.DataArray:
    """Return the error of a corrected mean, and of another that of the ensemble alone.

    The grid error of counted points has a known sign: it is the distance to the corrected curve.
    """
    return mean_error(means, name + end) if end else means[f"{name}_standard_error"]


def _pressure(means: xr.Dataset, name: str) -> xr.DataArray:
    """Return the reduced pressure that a factor is plotted against."""
    if not name.startswith("kappa_r"):
        return means.reduced_pressure
    return means[f"reduced_pressure_contact{name.removeprefix('kappa_r')}_mean"]


def estimator_handles() -> list[Line2D]:
    """Return legend handles of the estimators, of which only the corrected one has markers."""
    marker: dict[str, Any] = {"marker": "o", "markerfacecolor": "white", "markersize": 3.5}
    return [Line2D([], [], color=style.GREY, label=name, **marker | look) for name, (_, look) in ESTIMATORS.items()]


def persson_curve(data: xr.Dataset, points: int = 100) -> tuple[Array, Array]:
    """Return reduced pressures over the range of a dataset, and Persson's area erf(√2 p*) at them."""
    pressure = np.geomspace(*data.reduced_pressure.values[[0, -1]], points)
    return pressure, persson_area(pressure)


def plot_persson(area: Axes, factor: Axes, data: xr.Dataset) -> None:
    """Plot Persson's area and the factor κ that follows from it."""
    pressure, persson = persson_curve(data)
    for panel, values in ((area, persson), (factor, persson / pressure)):
        panel.plot(pressure, values, color=style.EXACT, lw=0.8, ls="-.", label=PERSSON_LABEL)


def trend_text(data: xr.Dataset, name: str = "kappa_r_corrected") -> str:
    """Return how a factor's straight trend changes with pressure and Hurst exponent; empty for one member."""
    if data.member.size < 2:
        return ""
    lines = [r"straight trend of the corrected $\kappa_r$:"]
    for along, symbol in (("reduced_pressure", r"$\log p^*$"), ("hurst_exponent", "$H$")):
        ends = data[along].values[[0, -1]]
        trend = estimate_trend(data, name, along)
        value, error = rounded_texts(100 * trend.value, 100 * trend.error)
        lines.append(rf"   {symbol}, {ends[0]:g} to {ends[1]:g}: {value} ± {error} %")
    return "\n".join(lines)
