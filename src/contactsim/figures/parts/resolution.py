"""Curves of a quantity against points per shortest wavelength, with its limit of fine grids."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from contactsim.analysis.resolution import (
    QUANTITIES,
    change_texts,
    grid_count,
    grid_counts,
    grid_name,
    grid_table,
    per_wavelength,
)
from contactsim.figures import style
from contactsim.figures.parts.proportionality import FACTOR_COLOURS
from contactsim.variables import RESULTS

FAINTEST = 0.35
"""Opacity of the smallest load."""
CORNER: dict[str, Any] = {"fontsize": 7, "ha": "right", "va": "top"}
"""Text in the upper right corner."""
LIMIT_PLACE = 2.2
"""Where limits stand, over the points of the finest grid."""


def plot_grids(data: xr.Dataset, finer: xr.Dataset, axes: list[Axes], thesis: Mapping[str, float]) -> pd.DataFrame:
    """Plot the factors of proportionality against the grid, one panel each, with the changes as text.

    Parameters
    ----------
    data : an ensemble on several grids
    finer : some of its members on a finer grid
    axes : one for each of `contactsim.analysis.resolution.QUANTITIES`
    thesis : the thesis's values by factor, as far as it gives them

    Returns
    -------
    table : of `contactsim.analysis.resolution.grid_table`
    """
    table = grid_table(data, finer)
    middle = grid_name(float(per_wavelength(data).points[-2:][0]))
    for panel, name in zip(axes, QUANTITIES, strict=True):
        plot_factor(table, name, panel)
        if (factor := _factor(name)) in thesis:
            look = {"color": style.EXACT, "lw": 0.8, "ls": style.THESIS}
            panel.axhline(thesis[factor], label=f"thesis, {thesis[factor]:.2f}", **look)
        style.add_headroom(panel, 0.35)
        panel.text(0.97, 0.97, "\n".join(change_texts(table, name, middle)), transform=panel.transAxes, **CORNER)
    for pair in (axes[:2], axes[2:]):
        style.share_vertical_range(pair)
    style.add_letters(axes)
    values = " and ".join(f"{value:.2f}" for value in thesis.values())
    handles = style.hurst_handles(data.hurst_exponent.values) + load_handles(list(data.reduced_pressure.values))
    handles += style.line_handles({f"thesis, {values}": style.THESIS})
    axes[-1].legend(handles=handles, loc="center", ncols=2)
    return table


def plot_factor(table: pd.DataFrame, name: str, axes: Axes) -> None:
    """Plot one factor against points per shortest wavelength, and its limits with bars to the right."""
    rows = table[table.quantity == name]
    counts = grid_counts(rows.grid)
    end = counts[-1] * LIMIT_PLACE
    loads, exponents = sorted(rows.reduced_pressure.unique()), sorted(rows.hurst_exponent.unique())
    for (hurst_exponent, load), curve in rows.groupby(["hurst_exponent", "reduced_pressure"]):
        look = style.hurst_look(hurst_exponent)
        label = f"$H={hurst_exponent:g}$, $p^*={load:g}$"
        look |= {"color": FACTOR_COLOURS[_factor(name)], "alpha": _opacity(loads, load), "label": label}
        x = np.array([grid_count(grid) for grid in curve.grid])
        on_grid, limit = curve[np.isfinite(x)], curve[~np.isfinite(x)]
        style.errorbars(axes, x[np.isfinite(x)], on_grid.value, on_grid.standard_error, **look)
        if len(limit):
            place = end * (1 + 0.05 * (3 * loads.index(load) + exponents.index(hurst_exponent)))
            bars = limit_error(limit.standard_error, limit.spread)
            style.plot_limits(axes, limit.value, [place], bars, **look | {"label": f"{label}, limit of fine grids"})
    axes.axvspan(end * 0.93, end * 1.5, color="#eeeeee", zorder=0, lw=0)
    axes.set(xscale="log", xlabel="points per shortest wavelength", ylabel=RESULTS[name].symbol)
    axes.set_xlim(counts[0] / 1.2, end * 1.5)
    axes.xaxis.set_major_locator(FixedLocator([*counts, end * 1.2]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}" if value <= counts[-1] else "limit"))


def _factor(name: str) -> str:
    """Return the factor that a quantity of the tables estimates."""
    return name.removesuffix("_corrected")


def limit_error(standard_error: pd.Series, spread: pd.Series) -> pd.Series:
    """Return the error of a limit: standard error and spread in quadrature."""
    return np.hypot(standard_error.fillna(0.0), spread)


def load_handles(loads: Sequence[float]) -> list[Line2D]:
    """Return legend handles for the opacity of loads."""
    return [Line2D([], [], color=style.EXACT, alpha=_opacity(loads, load), label=f"$p^*={load:g}$") for load in loads]


def _opacity(loads: Sequence[float], load: float) -> float:
    """Return the opacity of a load: the larger, the darker."""
    return FAINTEST + (1 - FAINTEST) * list(loads).index(load) / max(1, len(loads) - 1)
