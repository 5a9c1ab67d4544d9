"""Look of the figures: colours, markers, lines, legend handles, error bars, axes, panel letters and tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter
from numpy.typing import ArrayLike

from contactsim.variables import SUFFIXES

RC_PARAMS: dict[Any, Any] = {
    "font.size": 9,
    "axes.labelsize": 9,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "savefig.dpi": 200,
    "pdf.fonttype": 42,
}
"""Settings of Matplotlib for all figures, used in `matplotlib.rc_context` alone."""

WHOLE, CONTACT, PAIRS = "#c1272d", "#1f4e9c", "#2a9d6f"
"""Colours of the gradient over the whole surface, over the contact (Eq. 3.8), over pairs of points in contact."""
EXACT = "#333333"
"""Colour of exact answers, values of the thesis and axes."""
GREY = "#777777"
"""Colour of legend handles that show a marker or a line style."""
LIGHT_GREY = "#999999"
"""Colour of guides to the eye."""
BROWN, PURPLE = "#8c6d31", "#7b4fa3"
"""Further colours, for a fourth and a fifth kind."""
THESIS: Any = (0, (6, 3))
"""Line style of values that the thesis gives."""
ZERO: dict[str, Any] = {"color": EXACT, "lw": 0.5, "label": "_zero"}
"""Line at zero. A label that begins with an underscore is a name outside the legend."""
BARS: dict[str, Any] = {"elinewidth": 0.8, "capsize": 1.5}
"""Error bars."""
FAINT = 0.35
"""Opacity of a curve beside the main ones."""
PLACE_TOLERANCE = 1e-6
"""Largest distance between a coordinate that a figure asks for and that in the dataset, in the coordinate's unit."""

HURST_LOOKS = {0.2: ("o", "-"), 0.5: ("s", "--"), 0.8: ("^", ":")}
"""Marker and line of the thesis's Hurst exponents."""
HURST_COLOURS = {0.2: WHOLE, 0.5: PAIRS, 0.8: CONTACT}
POISSON_LOOKS = {0.1: ("o", 5.5), 0.45: ("x", 3.8)}
"""Marker and size of Poisson's ratios: the small one fits into the large one where they coincide."""
HUES = {
    "work_of_separation": ("Blues", (0.2, 0.4, 0.8, 2.0, 4.0)),
    "poisson_ratio": ("Oranges", (0.1, 0.3, 0.45)),
    "work_ratio": ("Purples", (0.0, 0.1, 0.5, 1.0)),
    "surface_rms_height": ("RdPu", (10.0, 15.0, 20.0, 30.0)),
    "thickness": ("YlOrBr", (500.0, 5000.0)),
}
"""Hues of variables, so that a colour means the same in all figures of a chapter, and their usual values."""
HUE_RANGE = 0.5, 0.92
"""Part of a hue that is used: below it is too pale, and above it several hues end in one dark purple."""
SOLVER_NAMES = {
    "active_set": "active set",
    "conjugate_gradients": "conjugate gradients",
    "damped_verlet": "damped Verlet",
    "energy_minimisation": "energy minimisation",
    "mass_weighted_verlet": "mass-weighted Verlet",
    "newton": "Newton–Krylov",
    "polonsky_keer": "Polonsky–Keer",
    "tamaas": "tamaas",
    "verlet": "Verlet",
}
"""Solvers as the literature names them."""


def hurst_look(value: float) -> dict[str, Any]:
    """Return the marker and line of a Hurst exponent; one that the thesis does not have gets a cross."""
    marker, line = HURST_LOOKS.get(round(float(value), 6), ("x", "-."))
    return {"marker": marker, "linestyle": line, "markersize": 3.5, "linewidth": 1.0, "markerfacecolor": "white"}


def hurst_colour(value: float) -> str:
    """Return the colour of a Hurst exponent; one that the thesis does not have is grey."""
    return HURST_COLOURS.get(round(float(value), 6), GREY)


def poisson_look(value: float) -> dict[str, Any]:
    """Return the marker of a Poisson's ratio; one that the thesis does not have gets a triangle."""
    marker, size = POISSON_LOOKS.get(round(float(value), 6), ("^", 3.5))
    return {"marker": marker, "markersize": size, "markerfacecolor": "none", "markeredgewidth": 0.8}


def solver_name(kind: str) -> str:
    """Return the name of a solver as in the literature, or else its name in the config without underscores."""
    return SOLVER_NAMES.get(kind, kind.replace("_", " "))


def shades(values: ArrayLike) -> dict[float, str]:
    """Return a colour for each value, from dark to light in their order."""
    keys = [float(value) for value in np.asarray(values, float).ravel()]
    colours = mpl.colormaps["viridis"](np.linspace(0.0, 0.82, len(keys)))
    return dict(zip(keys, map(mpl.colors.to_hex, colours), strict=True))


def variable_colours(variable: str, values: ArrayLike) -> dict[float, str]:
    """Return a colour for each value of a variable that has a hue of its own, from light to dark in their order."""
    hue, usual = HUES[variable]
    keys = sorted({*usual, *map(float, np.asarray(values).ravel())})
    colours = mpl.colormaps[hue](np.linspace(*HUE_RANGE, len(keys)))
    return dict(zip(keys, map(mpl.colors.to_hex, colours), strict=True))


def hurst_handles(values: Iterable[float]) -> list[Line2D]:
    """Return legend handles of Hurst exponents."""
    return [Line2D([], [], color=GREY, label=f"$H={value:g}$", **hurst_look(value)) for value in values]


def poisson_handles(values: Iterable[float]) -> list[Line2D]:
    """Return legend handles of Poisson's ratios."""
    return [Line2D([], [], color=GREY, ls="none", label=rf"$\nu={value:g}$", **poisson_look(value)) for value in values]


def colour_handles(colours: Mapping[str, str]) -> list[Line2D]:
    """Return legend handles: one coloured line for each label."""
    return [Line2D([], [], color=colour, lw=1.5, label=label) for label, colour in colours.items()]


def line_handles(lines: Mapping[str, Any]) -> list[Line2D]:
    """Return legend handles: one dark line of each style."""
    return [Line2D([], [], color=EXACT, lw=0.8, ls=line, label=label) for label, line in lines.items()]


def opacity_handles(opacities: Mapping[str, float]) -> list[Line2D]:
    """Return legend handles: one dark line of each opacity."""
    return [Line2D([], [], color=EXACT, alpha=alpha, lw=1.5, label=label) for label, alpha in opacities.items()]


def marker_look(colour: str, marker: str = "o", size: float = 4.0, fill: str = "white") -> dict[str, Any]:
    """Return the look of hollow or filled markers."""
    return {"color": colour, "marker": marker, "ms": size, "mfc": fill}


def errorbars(axes: Axes, x: ArrayLike, y: ArrayLike, error: ArrayLike | None, **look: Any) -> None:
    """Plot a curve with error bars; without bars where no error is finite."""
    bars = None if error is None or not np.isfinite(np.asarray(error, float)).any() else np.asarray(error, float)
    axes.errorbar(np.asarray(x), np.asarray(y), yerr=bars, **BARS | look)


def plot_means(axes: Axes, x: xr.DataArray, data: xr.Dataset, name: str, **look: Any) -> None:
    """Plot the ensemble means of a quantity, with their standard errors as bars."""
    errorbars(axes, x, data[f"{name}_mean"], data[f"{name}_standard_error"], **look)


def plot_grid_error(axes: Axes, x: xr.DataArray, data: xr.Dataset, name: str, **look: Any) -> None:
    """Plot the grid error of a quantity if the study measured it."""
    if f"{name}_grid_error" in data:
        axes.plot(x.values, data[f"{name}_grid_error"].values, **look)


def plot_limits(axes: Axes, limits: pd.Series, places: ArrayLike, bars: pd.Series, **look: Any) -> None:
    """Plot values in the limit of fine grids as single markers with bars."""
    axes.errorbar(np.asarray(places), limits, bars, **BARS | look | {"linestyle": "none"})


def mean_table(data: xr.Dataset, names: Iterable[str]) -> pd.DataFrame:
    """Return mean, standard error and grid error of each quantity, with one row for each point of the dataset."""
    columns = [f"{name}{suffix}" for name in names for suffix in SUFFIXES]
    return data[[column for column in columns if column in data]].to_dataframe().reset_index()


def add_headroom(axes: Axes, above: float, below: float = 0.0) -> None:
    """Add room above and below the curves for a legend or text, as parts of their range."""
    low, high = axes.get_ylim()
    axes.set_ylim(low - below * (high - low), high + above * (high - low))


def add_log_headroom(axes: Axes, above: float) -> None:
    """Add room above the curves of a logarithmic axis, as a part of its range."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high * (high / low) ** above)


def include_range(axes: Axes, low: float, high: float) -> None:
    """Widen the vertical axis so that it shows this range too."""
    bottom, top = axes.get_ylim()
    axes.set_ylim(min(bottom, low), max(top, high))


def share_vertical_range(axes: Sequence[Axes]) -> None:
    """Give all panels the vertical range that holds those of each."""
    ranges = [panel.get_ylim() for panel in axes]
    for panel in axes:
        panel.set_ylim(min(low for low, _ in ranges), max(high for _, high in ranges))


def add_letters(axes: Iterable[Axes]) -> None:
    """Put the letters (a), (b), … above the left corners of the panels."""
    for panel, letter in zip(axes, "abcdefgh", strict=False):
        panel.set_title(f"({letter})", loc="left", fontsize=9)


def log_range(values: pd.Series) -> tuple[float, float]:
    """Return the range of a logarithmic axis that holds the values and spans a factor of ten at least."""
    if values.empty:
        return 0.1, 1.0
    low, high = values.min() / 1.3, values.max() * 1.3
    wider = max(1.0, 10 * low / high) ** 0.5
    return low / wider, high * wider


def set_log_ticks(axis: Axis, low: float, high: float) -> None:
    """Set ticks and labels of a logarithmic axis inside a range: decades, and 2 and 5 of them if there are few."""
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    few = high / low < 20 or ((low <= decades) & (decades <= high)).sum() < 2
    digits = (1, 2, 5) if few else (1,)
    stride = -(-len(decades) // 7)
    major, minor = np.outer(decades[::stride], digits).ravel(), np.outer(decades, np.arange(1, 10)).ravel()
    plain = low >= 1e-3 and high <= 1e4 and few
    axis.set_major_locator(FixedLocator([tick for tick in major if low <= tick <= high]))
    axis.set_minor_locator(FixedLocator([tick for tick in minor if low <= tick <= high]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}" if plain else _power_of_ten(value)))
    axis.set_minor_formatter(NullFormatter())


def _power_of_ten(value: float) -> str:
    """Return a number as digit times a power of ten."""
    digit, power = f"{value:.0e}".split("e")
    return (rf"${digit}\times" if digit != "1" else "$") + f"10^{{{int(power)}}}$"


def draw_table(axes: Axes, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Draw a table in place of axes."""
    axes.axis("off")
    table = axes.table([list(row) for row in rows], colLabels=list(heads), loc="center", cellLoc="center")
    table.auto_set_font_size(False)
    table.set_fontsize(8)
    for (row, _), cell in table.get_celld().items():
        cell.set(edgecolor="#bbbbbb", linewidth=0.6, height=(1.7 if row == 0 else 1) / (len(rows) + 1.7))
