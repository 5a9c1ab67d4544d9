"""Curves of rough adhesive contacts through every state of a path, beside those of a hard wall."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim.analysis.rough_paths import (
    ENDS,
    at_equal_pressure,
    on_full_grid,
    reduced_pressure,
    states_of_all_members,
)
from contactsim.analysis.scales import reduced_work
from contactsim.figures import style

COLUMNS = (
    "normalised_pressure",
    "relative_repulsive_area",
    "relative_interacting_area",
    "gradient_ratio_repulsive",
    "gradient_ratio_interacting",
)
"""Quantities whose means are columns of the tables."""
AREA = "relative_interacting_area"
"""Quantity that figures show as the contact area."""
LABELS = {
    "normalised_pressure": r"$p/E^*$",
    "relative_interacting_area": r"relative contact area $a_{\mathrm{rel}}$",
    "gradient_ratio_interacting": r"$\bar g_r/\bar g$",
    "indentation": r"$\delta$ (nm)",
}
LARGEST_PRESSURE = 0.03
"""Largest pressure over E* up to which curves are averaged at equal pressure."""
BAR_SPACING = 10
"""Number of states between the error bars of a curve."""
WALL_LOOK = {"color": style.EXACT, "ls": "--", "lw": 1.0, "marker": "x"}
"""Look of a hard wall beside adhesive contacts."""


def plot_path(axes: Axes, data: xr.Dataset, x: xr.DataArray, name: str, label: str, **look: Any) -> pd.DataFrame:
    """Plot the ensemble means of a quantity along a path.

    All states that every member has are a line; those solved on the full grid have markers and standard errors.

    Parameters
    ----------
    axes : to plot on
    data : of one variant, from `contactsim.analysis.rough_paths.with_indentation`
    x : horizontal coordinate of each state
    name : of the quantity
    label : of the curve
    look : of the curve, with its color

    Returns
    -------
    table : of all means along the path, one row a state
    """
    marker = look.pop("marker", "o")
    states = states_of_all_members(data)
    data, x = data.isel(step=states), x.isel(step=states)
    mean, error = data[f"{name}_mean"], data[f"{name}_standard_error"]
    axes.plot(x, mean, **look, label=f"_{label}")
    full = on_full_grid(data)
    markers = {"fmt": marker, "ms": 3, "mfc": "white", "color": look["color"], "label": f"_{label}, on the full grid"}
    style.errorbars(axes, x.values[full], mean.values[full], _bars(error, full), **markers)
    axes.plot([], [], marker=marker, ms=3, mfc="white", label=label, **look)
    table = {"case": label.replace("$", ""), "indentation": data.indentation, "x": x, "whole_grid": full}
    means = (f"{column}_{end}" for column in COLUMNS for end in ENDS)
    table |= {column: data[column] for column in means if column in data}
    grid_error = f"{name}_grid_error"
    return pd.DataFrame(table | ({grid_error: data[grid_error]} if grid_error in data else {}))


def _bars(error: xr.DataArray, full: np.ndarray) -> np.ndarray | None:
    """Return the errors of some states; None if no state of the path has one."""
    return error.values[full] if np.isfinite(error).any() else None


def work_label(data: xr.Dataset, work: float) -> str:
    """Return the label of a work of separation, φn* = φn/(δn E)."""
    return rf"$\varphi_n^*={reduced_work(data, work):.2g}$"


def work_colours(works: list[float]) -> dict[float, str]:
    """Return a colour for each work of separation, the darkest for the strongest adhesion."""
    colours = style.shades(works)
    return dict(zip(works, reversed(colours.values()), strict=True))


def plot_works(
    axes: Axes, data: xr.Dataset, wall: xr.Dataset, name: str, across: Callable[[xr.Dataset], xr.DataArray]
) -> list[pd.DataFrame]:
    """Plot one curve for each work of separation, and that of the hard wall.

    across: returns the horizontal coordinate of the states of one variant
    """
    tables = []
    for work, colour in work_colours(data.work_of_separation.values.tolist()).items():
        variant = data.sel(work_of_separation=work)
        tables.append(plot_path(axes, variant, across(variant), name, work_label(data, work), color=colour, lw=1.0))
    return [*tables, plot_path(axes, wall, across(wall), name, "hard wall", **WALL_LOOK)]


def plot_repulsions(
    axes: Axes,
    repulsive: xr.Dataset,
    stiff: xr.Dataset,
    works: list[float],
    name: str,
    across: Callable[[xr.Dataset], xr.DataArray],
) -> list[pd.DataFrame]:
    """Plot the repulsion of each law alone, and the adhesion of a stiff repulsion, each as a thin line.

    works: of all adhesive laws, whose colours the lines have; across: as in `plot_works`
    """
    colours, tables = work_colours(works), []
    for data, line, words in ((repulsive, ":", "repulsion alone"), (stiff, "-.", "stiff repulsion")):
        for work in data.work_of_separation.values:
            variant = data.sel(work_of_separation=work)
            variant = variant.isel(step=states_of_all_members(variant))
            x, mean = across(variant), variant[f"{name}_mean"]
            label = f"_{work_label(data, work)}, {words}"
            axes.plot(x, mean, color=colours[float(work)], ls=line, lw=0.6, label=label)
            table = {"case": f"{words}, {work:g} N/m", "indentation": variant.indentation, "x": x}
            table |= {f"{name}_{end}": variant[f"{name}_{end}"] for end in ENDS}
            tables.append(pd.DataFrame(table))
    return tables


def plot_thin_against_pressure(
    axes: Axes, repulsive: xr.Dataset, stiff: xr.Dataset, works: list[float], end: float
) -> list[pd.DataFrame]:
    """Plot the area by the repulsion of each law alone, and with a stiff repulsion, against p_r* as thin lines.

    works: of all adhesive laws, whose colours the lines have; end: largest pressure over E*
    """
    colours, tables = work_colours(works), []
    for data, line, words in ((repulsive, ":", "repulsion alone"), (stiff, "-.", "stiff repulsion")):
        for work in data.work_of_separation.values:
            means = at_equal_pressure(data.sel(work_of_separation=work), True, AREA, end)
            label = f"_{work_label(data, work)}, {words}"
            axes.plot(means.abscissa, means.area, color=colours[float(work)], ls=line, lw=0.6, label=label)
            tables.append(pd.DataFrame(vars(means)).assign(case=f"{words}, {work:g} N/m"))
    return tables


def repulsion_handles() -> list[Line2D]:
    """Return legend handles of the thin lines of other repulsions."""
    return style.line_handles({"repulsion alone": ":", "repulsion of the strongest": "-."})


def falling_handle() -> Line2D:
    """Return the legend handle of the states before the load rises for the last time."""
    return Line2D([], [], color=style.EXACT, lw=0.6, alpha=style.FAINT, label="load still falls")


def indentation(data: xr.Dataset) -> xr.DataArray:
    """Return the approach beyond first touch, nm; data: of `contactsim.analysis.rough_paths.with_indentation`."""
    return data.indentation


def plot_against_pressure(
    axes: Axes, data: xr.Dataset, label: str, *, reduced: bool = False, end: float = LARGEST_PRESSURE, **look: Any
) -> pd.DataFrame:
    """Plot the relative area against the pressure: means over members at equal pressure, where the load rises.

    Bars are standard errors at equal pressure, of the area and of p_r*. The states before, in which loads fall as the
    area grows, are a faint line of means at equal approach.

    Parameters
    ----------
    axes
        To plot on.
    data
        Of one variant, of `contactsim.analysis.rough_paths.with_indentation`.
    label
        Of the curve.
    reduced
        True to plot against p_r*.
    end
        Largest pressure over E*.
    look
        Of the curve, with its color.
    """
    marker, name = look.pop("marker", "o"), AREA if AREA in data else "relative_contact_area"
    means = at_equal_pressure(data, reduced, name, end)
    axes.plot(means.abscissa, means.area, **{"lw": 1.0, **look}, label=f"_{label}")
    least = int(np.nanargmin(data.normalised_pressure_mean.values))
    before = slice(0, least + 1)
    x = reduced_pressure(data) if reduced else data.normalised_pressure_mean
    faint = {"color": look["color"], "lw": 0.6, "alpha": style.FAINT, "label": f"_{label}, at equal approach"}
    axes.plot(x[before], data[f"{AREA}_mean"][before], **faint)
    some = slice(4, None, 8)
    bars = {"xerr": means.abscissa_error[some] if reduced else None, "yerr": means.area_error[some]}
    dots = {"fmt": marker, "ms": 3, "mfc": "white", "color": look["color"], "label": f"_{label} with its error"}
    axes.errorbar(means.abscissa[some], means.area[some], **bars, **dots, **style.BARS)
    axes.plot([], [], marker=marker, ms=3, mfc="white", label=label, **{"lw": 1.0, **look})
    return pd.DataFrame(vars(means)).assign(case=label.replace("$", ""))


def label_pressures(axes: Axes) -> None:
    """Label a panel of area against pressure, and limit it to contact that is not yet complete."""
    axes.set(xlabel=LABELS["normalised_pressure"], ylabel=LABELS["relative_interacting_area"])
    axes.set(xlim=plotted_range(axes, -0.006, 0.03), ylim=(0, 1.02))
    axes.legend(handles=[*axes.get_legend_handles_labels()[0], falling_handle()], loc="best", fontsize=7)


def plotted_range(axes: Axes, low: float, high: float) -> tuple[float, float]:
    """Return the part of a horizontal range that curves reach, with a margin."""
    x = np.concatenate([np.asarray(line.get_xdata(), float) for line in axes.lines])
    x = x[np.isfinite(x) & (x > low) & (x < high)]
    margin = 0.06 * np.ptp(x)
    return max(x.min() - margin, low), min(x.max() + margin, high)
