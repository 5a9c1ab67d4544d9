"""Curves of the ratios of factors of proportionality of lines over those of surfaces (Fig. 3.5)."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim.analysis.resolution import IN_LIMIT
from contactsim.figures import style
from contactsim.figures.parts.proportionality import AS_IN_THESIS, CORRECTED, ESTIMATORS
from contactsim.figures.parts.resolution import limit_error

LIMIT_MARKER = "x"
"""Marker of ratios of extrapolated factors."""
LIMIT_SHIFT = 0.07
"""Distance of the markers of neighbouring Hurst exponents in the limit, relative to the load."""


def plot_curves(axes: Axes, table: pd.DataFrame, colour: str) -> None:
    """Plot the corrected ratios with their errors, one curve a Hurst exponent."""
    for hurst_exponent, rows in table.groupby("hurst_exponent"):
        label = f"$H={float(str(hurst_exponent)):g}$, {CORRECTED}"
        look = style.hurst_look(float(str(hurst_exponent))) | {"color": colour, "label": label}
        style.errorbars(axes, rows.reduced_pressure, rows.value, rows.error, **look)


def plot_equal_grids(axes: Axes, table: pd.DataFrame, grid: str, colour: str) -> None:
    """Plot ratios by the estimator of the thesis on one grid of both, and of both extrapolated.

    Parameters
    ----------
    axes : to plot on
    table : rows of one quantity of `contactsim.analysis.resolution.ratio_table`
    grid : the grid, an entry of the table
    colour : of the curves
    """
    exponents = sorted(table.hurst_exponent.unique())
    on_grid_label, limit_label = _thesis_labels(grid)
    for place, hurst_exponent in enumerate(exponents):
        rows = table[table.hurst_exponent == hurst_exponent]
        look = style.hurst_look(hurst_exponent) | {"color": colour}
        on_grid, limit = rows[rows.grid == grid], rows[rows.grid == IN_LIMIT]
        grid_look = look | ESTIMATORS[AS_IN_THESIS][1] | {"label": f"$H={hurst_exponent:g}$, {on_grid_label}"}
        style.errorbars(axes, on_grid.reduced_pressure, on_grid.value, None, **grid_look)
        shift = 1 + LIMIT_SHIFT * (place - (len(exponents) - 1) / 2)
        bars = limit_error(limit.error, limit.spread)
        limit_look = look | {"marker": LIMIT_MARKER, "markersize": 4.5, "alpha": 0.7}
        limit_look |= {"label": f"$H={hurst_exponent:g}$, {limit_label}"}
        style.plot_limits(axes, limit.value, limit.reduced_pressure * shift, bars, **limit_look)


def _thesis_labels(grid: str) -> tuple[str, str]:
    """Return the labels of the estimator of the thesis, on a grid and extrapolated."""
    return f"{AS_IN_THESIS}, {grid} per wavelength", f"{AS_IN_THESIS}, extrapolated"


def ratio_handles(grid: str) -> list[Line2D]:
    """Return legend handles of the estimators of a ratio; grid: the one of both, as a table names it."""
    on_grid, limit = _thesis_labels(grid)
    labels = {
        CORRECTED: {"marker": "o", "markerfacecolor": "white", "ms": 3.5},
        on_grid: ESTIMATORS[AS_IN_THESIS][1],
        limit: {"marker": LIMIT_MARKER, "ms": 4.5, "ls": "none", "alpha": 0.7},
    }
    return [Line2D([], [], color=style.GREY, label=label, **look) for label, look in labels.items()]
