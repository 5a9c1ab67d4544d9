"""Grids finer and finer: a quantity against points per shortest wavelength, and where it tends."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from contactsim import dataset, notation
from contactsim.analysis import ensemble
from contactsim.figures import style

QUANTITIES = {"kappa": style.WHOLE, "kappa_r": style.CONTACT, "kappa_r_pairs": style.PAIRS}
FAINTEST = 0.35
"""Opacity of the smallest load."""
CORNER = {"fontsize": 6.5, "ha": "right", "va": "top"}
"""Looks of words in the upper right corner."""


def per_wavelength(data: xr.Dataset) -> xr.Dataset:
    """A dataset of rough contacts with its grids, `points`, counted per shortest wavelength."""
    surface = dataset.settings_of(data)["surface"]
    data = data if "points" in data.dims else data.drop_vars("points").expand_dims(points=[int(data.points)])
    return data.assign_coords(points=data.points * surface["shortest_wavelength"] / surface["length"])


def joined(data: xr.Dataset, finer: xr.Dataset) -> xr.Dataset:
    """What the members have on the grids of both studies, which press the same surfaces; NaN where there is nothing.

    finer: of some of the members, Hurst exponents and loads, or of more.
    """
    one, two = (per_wavelength(part)[[*QUANTITIES, "status"]] for part in (data, finer))
    two = two.reindex({dim: one[dim] for dim in ("hurst", "member", "reduced_pressure")})
    return xr.concat([one, two], "points").drop_duplicates("points").sortby("points")


def table(data: xr.Dataset, finer: xr.Dataset) -> pd.DataFrame:
    """Every quantity on every grid and in the limit, one row each.

    value: the mean, of `finer` the mean on the finest grid of `data` and the change from there, member by member;
    above_common, above_finest: by how much it lies above that on the finest grid of `data` and on that of both, member
    by member; in the limit: spread and order of `contactsim.analysis.grid_convergence`.
    """
    grids, common = joined(data, finer), per_wavelength(data)
    settled, finest = float(common.points[-1]), float(grids.points[-1])
    rows = []
    for name in QUANTITIES:
        found = {}
        for column, reference in (("above_common", settled), ("above_finest", finest)):
            apart = ensemble.difference(grids, name, "points", reference)
            found[column], found[f"{column}_standard_error"] = apart.values()
        means = common[f"{name}_mean"].sel(points=settled, drop=True) + found["above_common"]
        errors = common[f"{name}_standard_error"].reindex(points=grids.points)
        one = xr.Dataset({"value": means, "standard_error": errors, **found})
        rows.append(one.to_dataframe().reset_index().assign(quantity=name))
        if f"{name}_limit" in common:
            kinds = {"value": "limit", "standard_error": "limit_standard_error", "spread": "spread", "order": "order"}
            kinds["order_standard_error"] = "order_standard_error"
            limit = xr.Dataset({column: common[f"{name}_{kind}"] for column, kind in kinds.items()})
            limit["above_finest"] = limit.value - means.sel(points=finest, drop=True)
            rows.append(limit.to_dataframe().reset_index().assign(quantity=name, points=np.inf))
    shown = pd.concat(rows, ignore_index=True).dropna(subset="value")
    shown["grid"] = [_grid(count) for count in shown.pop("points")]
    first = ["quantity", "hurst", "reduced_pressure", "grid"]
    return shown[[*first, *(column for column in shown if column not in first)]]


def draw(shown: pd.DataFrame, quantity: str, axes: Axes) -> None:
    """One quantity of a `table` against points per shortest wavelength, its limits with bars to the right."""
    mine = shown[shown.quantity == quantity]
    counts = sorted({_count(grid) for grid in mine.grid} - {np.inf})
    end = counts[-1] * 2.2
    loads = sorted(mine.reduced_pressure.unique())
    for (hurst, load), rows in mine.groupby(["hurst", "reduced_pressure"]):
        look = {"color": QUANTITIES[quantity], "alpha": _shade(loads, load)} | style.hurst(hurst)
        x = np.array([_count(grid) for grid in rows.grid])
        on_grid, limit = rows[np.isfinite(x)], rows[~np.isfinite(x)]
        style.bars(axes, pd.Series(x[np.isfinite(x)]), on_grid.value, on_grid.standard_error, **look)
        place = end * (1 + 0.05 * (3 * loads.index(load) + sorted(mine.hurst.unique()).index(hurst)))
        if len(limit):
            error = np.hypot(limit.standard_error.fillna(0.0), limit.spread)
            axes.errorbar([place], limit.value, error, elinewidth=0.8, capsize=1.5, **look | {"linestyle": "none"})
    axes.axvspan(end * 0.93, end * 1.5, color="#eeeeee", zorder=0, lw=0)
    axes.set(xscale="log", xlabel="points per shortest wavelength", ylabel=notation.SYMBOLS[quantity])
    axes.set_xlim(counts[0] / 1.2, end * 1.5)
    axes.xaxis.set_major_locator(FixedLocator([*counts, end * 1.2]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}" if value <= counts[-1] else "limit"))


def _grid(count: float) -> str:
    return f"{count:g} points" if np.isfinite(count) else "limit"


def _count(grid: str) -> float:
    return np.inf if grid == "limit" else float(grid.removesuffix(" points"))


def _shade(loads: list[float], load: float) -> float:
    """Opacity of a load: the larger, the darker."""
    return FAINTEST + (1 - FAINTEST) * loads.index(load) / max(1, len(loads) - 1)


def load_key(loads: list[float]) -> list[Line2D]:
    """Legend entries for the opacity of loads."""
    return [Line2D([], [], color=style.EXACT, alpha=_shade(loads, load), label=f"$p^*={load:g}$") for load in loads]


def in_words(shown: pd.DataFrame, quantity: str, grid: str) -> str:
    """How far a quantity on one grid lies above the finest of all members, the finest of any, and the limit; orders."""
    mine = shown[shown.quantity == quantity].set_index(["hurst", "reduced_pressure", "grid"])
    here = mine.xs(grid, level="grid")
    counts = sorted({_count(name) for name in mine.index.get_level_values("grid")} - {np.inf})
    settled = mine[mine.above_common == 0].index.get_level_values("grid")[0]
    limits = here.value - mine.xs("limit", level="grid").value if "limit" in mine.index.levels[2] else pd.Series([])
    lines = [f"on {grid}, above that"]
    for words, apart in (
        (f"on {settled}", here.above_common),
        (f"on {_grid(counts[-1])}", here.above_finest if _grid(counts[-1]) != settled else pd.Series([])),
        ("in the limit", limits),
    ):
        known = apart.dropna()
        if len(known):
            lines.append(f"{words}: {known.min():+.3f} to {known.max():+.3f}")
    if mine.order.notna().any():
        lines.append(f"order observed: {mine.order.min():.1f} to {mine.order.max():.1f}")
    return "\n".join(lines)


def grids(data: xr.Dataset, finer: xr.Dataset, axes: list[Axes], thesis: dict[str, float]) -> pd.DataFrame:
    """One panel a quantity, with the value of the thesis if any, and in words what a grid costs against finer ones."""
    shown = table(data, finer)
    middle = f"{float(per_wavelength(data).points[-2:][0]):g} points"
    for panel, name, letter in zip(axes, QUANTITIES, "abc", strict=True):
        draw(shown, name, panel)
        if name in thesis:
            panel.axhline(thesis[name], color=style.EXACT, lw=0.8, ls=(0, (6, 3)))
        low, high = panel.get_ylim()
        below = 0.35 if panel is axes[-1] else 0.0  # room for the legend
        panel.set_ylim(low - below * (high - low), high + 0.4 * (high - low))
        panel.text(0.97, 0.97, in_words(shown, name, middle), **CORNER, transform=panel.transAxes)
        style.letter(panel, letter)
    values = " and ".join(f"{value:.2f}" for value in thesis.values())
    keys = style.key({}, {f"thesis, {values}": (0, (6, 3))})
    loads = load_key(list(data.reduced_pressure.values))
    axes[-1].legend(handles=style.hurst_key(data.hurst.values) + loads + keys, loc="lower right", ncols=2)
    return shown


def ratios(lines: xr.Dataset, surfaces: xr.Dataset) -> pd.DataFrame:
    """Lines over surfaces at equal points per shortest wavelength, and in the limit, one row each.

    value and its standard `error`; in the limit also the `spread` of `contactsim.analysis.ensemble.ratio_limits`.
    """
    rows = []
    for name in QUANTITIES:
        found = ensemble.ratio_limits(per_wavelength(lines), per_wavelength(surfaces), name)
        on_grid = found[["ratio", "ratio_standard_error"]].rename(ratio="value", ratio_standard_error="error")
        limit = found.drop_vars(["ratio", "ratio_standard_error", "spread_standard_error", "points"])
        limit = limit.rename(limit="value", limit_standard_error="error")
        for part in (on_grid, limit):
            table = part.to_dataframe().reset_index().assign(quantity=name)
            counts = table.pop("points") if "points" in table else [np.inf] * len(table)
            rows.append(table.assign(grid=[_grid(count) for count in counts]))
    return pd.concat(rows, ignore_index=True)


def draw_limits(shown: pd.DataFrame, axes: Axes) -> None:
    """The limits of `ratios` against reduced pressure; bars: standard error and spread, added in squares."""
    limits = shown[shown.grid == "limit"]
    exponents = sorted(limits.hurst.unique())
    for (name, hurst), rows in limits.groupby(["quantity", "hurst"]):
        aside = 1 + 0.08 * (3 * list(QUANTITIES).index(name) + exponents.index(hurst) - 4)
        error = np.hypot(rows.error.fillna(0.0), rows.spread)
        look = style.hurst(hurst) | {"color": QUANTITIES[name], "elinewidth": 0.8, "capsize": 1.5, "linestyle": "none"}
        axes.errorbar(rows.reduced_pressure * aside, rows.value, error, **look)
