"""A quantity on finer and finer grids: tables of means, changes and limits, of one ensemble and of two."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from contactsim import dataset
from contactsim.analysis import ensemble

QUANTITIES = ("kappa", "kappa_corrected", "kappa_r", "kappa_r_corrected")
"""Quantities of the tables: κ and κ_r, each as in the thesis and corrected."""
IN_LIMIT = "limit"
"""Entry of the column `grid` for the limit of fine grids."""


def per_wavelength(data: xr.Dataset) -> xr.Dataset:
    """Return a dataset of rough contacts with its grids, `points`, counted per shortest wavelength."""
    surface = dataset.settings_of(data)["surface"]
    data = data if "points" in data.dims else data.drop_vars("points").expand_dims(points=[int(data.points)])
    return data.assign_coords(points=data.points * surface["short_cutoff"] / surface["length"])


def on_both_grids(data: xr.Dataset, finer: xr.Dataset) -> xr.Dataset:
    """Return the quantities of the members on the grids of two studies of the same surfaces; NaN where not solved.

    finer: of some of the members, Hurst exponents and loads.
    """
    coarse, fine = (per_wavelength(part)[[*QUANTITIES, "status"]] for part in (data, finer))
    fine = fine.reindex({dim: coarse[dim] for dim in ("hurst_exponent", "member", "reduced_pressure")})
    return xr.concat([coarse, fine], "points").drop_duplicates("points").sortby("points")


def grid_table(data: xr.Dataset, finer: xr.Dataset) -> pd.DataFrame:
    """Return each quantity on each grid and in the limit, one row each.

    Parameters
    ----------
    data : an ensemble on several grids
    finer : some of its members on a finer grid

    Returns
    -------
    table : quantity, hurst_exponent, reduced_pressure and grid, and the columns

        - value: the mean; on the grid of `finer`, the mean on the finest grid of `data` and the change from there,
          member by member
        - above_common, above_finest: difference from the finest grid of `data`, and from the finest of both
        - in the limit also spread and order, of `contactsim.analysis.grid_convergence`
    """
    grids, common = on_both_grids(data, finer), per_wavelength(data)
    parts = []
    for name in QUANTITIES:
        means = _grid_means(grids, common, name)
        parts.append(means.to_dataframe().reset_index().assign(quantity=name))
        if f"{name}_limit" in common:
            limit = _limit(common, name, means.value.isel(points=-1, drop=True))
            parts.append(limit.to_dataframe().reset_index().assign(quantity=name, points=np.inf))
    table = pd.concat(parts, ignore_index=True).dropna(subset="value")
    table["grid"] = [grid_name(count) for count in table.pop("points")]
    first = ["quantity", "hurst_exponent", "reduced_pressure", "grid"]
    return table[[*first, *(column for column in table if column not in first)]]


def _grid_means(grids: xr.Dataset, common: xr.Dataset, name: str) -> xr.Dataset:
    """Return the means of a quantity on each grid, and how far they lie above two grids."""
    settled = float(common.points[-1])
    changes = {}
    for column, points in (("above_common", settled), ("above_finest", float(grids.points[-1]))):
        change = ensemble.difference(grids, name, "points", points)
        changes[column], changes[f"{column}_standard_error"] = change.values()
    means = common[f"{name}_mean"].sel(points=settled, drop=True) + changes["above_common"]
    errors = common[f"{name}_standard_error"].reindex(points=grids.points)
    return xr.Dataset({"value": means, "standard_error": errors, **changes})


def _limit(common: xr.Dataset, name: str, finest: xr.DataArray) -> xr.Dataset:
    """Return a quantity in the limit of fine grids, and how far it lies above the mean on the finest grid."""
    kinds = {"value": "limit", "standard_error": "limit_standard_error", "spread": "spread", "order": "order"}
    kinds["order_standard_error"] = "order_standard_error"
    limit = xr.Dataset({column: common[f"{name}_{kind}"] for column, kind in kinds.items()})
    return limit.assign(above_finest=limit.value - finest)


def ratio_table(lines: xr.Dataset, surfaces: xr.Dataset) -> pd.DataFrame:
    """Return quantities of lines over those of surfaces, at equal points per shortest wavelength and in the limit.

    Columns: quantity, hurst_exponent, reduced_pressure, grid, value and its standard `error`; in the limit also the
    `spread` of `contactsim.analysis.ensemble.ratio_limits`.
    """
    parts = []
    for name in QUANTITIES:
        ratios = ensemble.ratio_limits(per_wavelength(lines), per_wavelength(surfaces), name)
        on_grid = ratios[["ratio", "ratio_standard_error"]].rename(ratio="value", ratio_standard_error="error")
        limit = ratios.drop_vars(["ratio", "ratio_standard_error", "spread_standard_error", "points"])
        limit = limit.rename(limit="value", limit_standard_error="error")
        for part in (on_grid, limit):
            table = part.to_dataframe().reset_index().assign(quantity=name)
            counts = table.pop("points") if "points" in table else [np.inf] * len(table)
            parts.append(table.assign(grid=[grid_name(count) for count in counts]))
    return pd.concat(parts, ignore_index=True)


def change_texts(table: pd.DataFrame, quantity: str, grid: str) -> list[str]:
    """Return the differences of a quantity on one grid from finer grids and the limit, and the observed orders.

    table: of `grid_table`; grid: one of its entries.
    """
    rows = table[table.quantity == quantity].set_index(["hurst_exponent", "reduced_pressure", "grid"])
    here = rows.xs(grid, level="grid")
    finest = grid_name(grid_counts(rows.index.get_level_values("grid"))[-1])
    settled = rows[rows.above_common == 0].index.get_level_values("grid")[0]
    nothing = pd.Series([], dtype=float)
    limits = here.value - rows.xs(IN_LIMIT, level="grid").value if IN_LIMIT in rows.index.levels[2] else nothing
    texts = []
    for place, changes in (
        (settled, here.above_common),
        (finest, here.above_finest if finest != settled else nothing),
        ("the limit", limits),
    ):
        changes = changes.dropna()
        if len(changes):
            texts.append(f"from {place} to {grid}: {changes.min():+.3f} to {changes.max():+.3f}")
    if rows.order.notna().any():
        texts.append(f"order observed: {rows.order.min():.1f} to {rows.order.max():.1f}")
    return texts


def grid_name(count: float) -> str:
    """Return the name of a grid with so many points per shortest wavelength; of infinitely many, the limit."""
    return f"{count:g} points" if np.isfinite(count) else IN_LIMIT


def grid_count(name: str) -> float:
    """Return the points per shortest wavelength of a grid's name; infinity for the limit."""
    return np.inf if name == IN_LIMIT else float(name.removesuffix(" points"))


def grid_counts(names: pd.Series | pd.Index) -> list[float]:
    """Return the points per shortest wavelength of all grids but the limit, ascending."""
    return sorted({grid_count(name) for name in names} - {np.inf})
