"""How figures look: one place for colours, markers, legends, tables and the words about the grid."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import matplotlib as mpl
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

from contactsim.variables import SUFFIXES

HURST = {0.2: ("o", "-"), 0.5: ("s", "--"), 0.8: ("^", ":")}
WHOLE, CONTACT, PAIRS = "#c1272d", "#1f4e9c", "#2a9d6f"
"""Gradient over the whole surface, over the contact (Eq. 3.8), over pairs in contact."""
EXACT = "#333333"
SAME = 1e-6
"""Distance, in a dimension's unit, up to which a place in a dataset is the one that is asked for."""
SOLVERS = {
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
"""Names of solvers, as in the literature."""

mpl.rcParams.update(
    {
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
)


def hurst(value: float) -> dict[str, object]:
    """Marker and line of a Hurst exponent; those not in the thesis get a cross."""
    marker, line = HURST.get(round(float(value), 6), ("x", "-."))
    return {"marker": marker, "linestyle": line, "markersize": 3.5, "linewidth": 1.0, "markerfacecolor": "white"}


POISSON = {0.1: ("o", 5.5), 0.45: ("x", 3.2)}
"""Marker and size for a Poisson's ratio: one fits into the other, so that both are seen where they meet."""
HURST_COLOURS = {0.2: WHOLE, 0.5: PAIRS, 0.8: CONTACT}


def hurst_colour(value: float) -> str:
    """Colour of a Hurst exponent where its marker stands for something else; those not in the thesis are grey."""
    return HURST_COLOURS.get(round(float(value), 6), "#777777")


def poisson(value: float) -> dict[str, object]:
    """Marker of a Poisson's ratio; those not in the thesis get a triangle."""
    marker, size = POISSON.get(round(float(value), 6), ("^", 3.5))
    return {"marker": marker, "markersize": size, "markerfacecolor": "none", "markeredgewidth": 0.8}


def poisson_key(values: Iterable[float]) -> list[Line2D]:
    """Legend entries for Poisson's ratios."""
    return [Line2D([], [], color="#777777", ls="none", label=rf"$\nu={value:g}$", **poisson(value)) for value in values]


def hurst_key(values: Iterable[float]) -> list[Line2D]:
    """Legend entries for Hurst exponents."""
    return [Line2D([], [], color="#777777", label=f"$H={value:g}$", **hurst(value)) for value in values]


def shades(values: Iterable[float]) -> dict[float, str]:
    """A colour for each value, dark to light in their order."""
    known = [float(value) for value in values]
    colours = mpl.colormaps["viridis"](np.linspace(0.0, 0.82, len(known)))
    return dict(zip(known, map(mpl.colors.to_hex, colours), strict=True))


def key(colours: Mapping[str, str], lines: Mapping[str, object]) -> list[Line2D]:
    """Legend entries: a coloured line for each name, then a dark line of each style."""
    coloured = [Line2D([], [], color=color, lw=1.5, label=name) for name, color in colours.items()]
    return coloured + [Line2D([], [], color=EXACT, lw=0.8, ls=line, label=name) for name, line in lines.items()]


def with_errors(axes: Axes, x: xr.DataArray, data: xr.Dataset, name: str, **look: object) -> None:
    """A curve of ensemble means with standard errors as bars; no bars where there is one member."""
    bars(axes, x, data[f"{name}_mean"], data[f"{name}_standard_error"], **look)


def bars(axes: Axes, x: xr.DataArray, y: xr.DataArray, error: xr.DataArray, **look: object) -> None:
    """A curve with bars, without them where no error is known."""
    known = error.values if np.isfinite(error).any() else None
    axes.errorbar(x.values, y.values, yerr=known, elinewidth=0.8, capsize=1.5, **look)


def grid_error(axes: Axes, x: xr.DataArray, data: xr.Dataset, name: str, **look: object) -> None:
    """The grid error of a curve of means, where it was measured."""
    if f"{name}_grid_error" in data:
        axes.plot(x.values, data[f"{name}_grid_error"].values, **look)


def keep_in_view(axes: Axes, least: float, most: float) -> None:
    """Show at least this range of the vertical axis, and all that is drawn."""
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, least), max(high, most))


def limits(errors: pd.Series) -> tuple[float, float]:
    """The range of an axis that holds these, and a factor of ten at least."""
    if errors.empty:
        return 0.1, 1.0
    low, high = errors.min() / 1.3, errors.max() * 1.3
    wider = max(1.0, 10 * low / high) ** 0.5
    return low / wider, high * wider


def ticks(axis: Axis, low: float, high: float) -> None:
    """Ticks and labels inside the range only: decades, of small ranges their halves and fifths too."""
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    steps = np.outer(decades, np.arange(1, 10))
    few = high / low < 20 or ((low <= decades) & (decades <= high)).sum() < 2
    kept = (1, 2, 5) if few else (1,)
    thin = -(-len(decades) // 7)
    major, minor = np.outer(decades[::thin], kept).ravel(), steps.ravel()
    axis.set_major_locator(FixedLocator([at for at in major if low <= at <= high]))
    axis.set_minor_locator(FixedLocator([at for at in minor if low <= at <= high]))
    axis.set_major_formatter(
        FuncFormatter(lambda value, _: _number(value, low >= 1e-3 and high <= 1e4 and len(kept) > 1))
    )
    axis.set_minor_formatter(NullFormatter())


def _number(value: float, plain: bool) -> str:
    if plain:
        return f"{value:g}"
    digit, power = f"{value:.0e}".split("e")
    return (rf"${digit}\times" if digit != "1" else "$") + f"10^{{{int(power)}}}$"


def solver(kind: str) -> str:
    """A solver's name as in the literature; one that has none there, as in the config."""
    return SOLVERS.get(kind, kind.replace("_", " "))


def letter(axes: Axes, name: str) -> None:
    """The panel's letter, above its left corner."""
    axes.set_title(f"({name})", loc="left", fontsize=9)


def letters(axes: Iterable[Axes]) -> None:
    """Letters above the panels, from a on."""
    for panel, name in zip(axes, "abcdefgh", strict=False):
        letter(panel, name)


def table(axes: Axes, heads: list[str], rows: list[list[str]]) -> None:
    """A table in place of axes."""
    axes.axis("off")
    drawn = axes.table(rows, colLabels=heads, loc="center", cellLoc="center")
    drawn.auto_set_font_size(False)
    drawn.set_fontsize(8)
    for (row, _), cell in drawn.get_celld().items():
        cell.set(edgecolor="#bbbbbb", linewidth=0.6, height=(1.7 if row == 0 else 1) / (len(rows) + 1.7))


def averages(data: xr.Dataset, names: Iterable[str]) -> pd.DataFrame:
    """Mean, standard error and grid error of each quantity, one row a point: what a figure of averages shows."""
    columns = [f"{name}{suffix}" for name in names for suffix in SUFFIXES]
    return data[[column for column in columns if column in data]].to_dataframe().reset_index()


def points_text(settings: Mapping, *points: int) -> str:
    """Grid points, with those per shortest wavelength where the surface has one, beside the thesis's own."""
    surface, thesis = settings["surface"], settings["thesis_points"]
    if settings.get("accuracy"):
        return f"{min(points):.0f} to {max(points):.0f} points, for an accuracy of {settings['accuracy']['error']:g}"
    grids = ", ".join(f"{count:.0f}" for count in points)
    if surface["kind"] != "self_affine":
        return f"{grids} points (thesis {thesis})" if thesis else f"{grids} points"
    share = surface["shortest_wavelength"] / surface["length"]
    beside = f" (thesis {thesis * share:g})" if thesis else ""
    waves = ", ".join(f"{count * share:g}" for count in points)
    return f"{grids} points, {waves} per shortest wavelength{beside}"
