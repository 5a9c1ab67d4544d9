"""Two tiers side by side: how far the numbers that a figure shows differ.

The rows of a figure's CSV are told apart by those of its columns that are dimensions of the study's dataset or of its
fits, or hold words; rows that both tiers have are joined by them. The columns compared are those that the figure's
`compare` lists.
Differences are relative to the second tier. The files are read as they lie: `make` brings them up to date.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from pandas.api.types import is_numeric_dtype

from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.study.plan import Plan

SAME = 1e-6
"""Relative difference up to which two numbers of a key column are the same."""

FIT_DIMENSIONS = ("fitted", "weighting", "fit_limit")
"""Dimensions of what `contactsim.analysis.fits.fits` returns."""


def joined(a: pd.DataFrame, b: pd.DataFrame, keys: list[str]) -> pd.DataFrame:
    """The rows that both have, with the keys as index; columns of `a` below "first", of `b` below "second"."""
    numeric = [key for key in keys if is_numeric_dtype(a[key]) and is_numeric_dtype(b[key])]
    b = b.assign(**{key: _snapped(b[key].to_numpy(), a[key].unique()) for key in numeric})
    for part in (a, b):
        if not keys or part.duplicated(keys).any():
            raise SceneError("key columns", keys, "columns that tell all rows apart")
    return pd.concat({"first": a.set_index(keys), "second": b.set_index(keys)}, axis=1, join="inner")


def _snapped(values: Array, known: Array) -> Array:
    """Values, each replaced by the known one that is the same."""
    if known.size == 0:
        return values
    nearest = known[np.abs(values[:, None] - known).argmin(axis=1)]
    return np.where(np.abs(values - nearest) <= SAME * np.abs(nearest), nearest, values)


def differences(shared: pd.DataFrame, columns: list[str]) -> pd.DataFrame:
    """Relative differences of joined rows, one row a column: column, rows, largest, median, at.

    rows: how many have a number in either tier; a number in only one differs infinitely. at: where the largest is, by
    the keys that vary; empty where there is no difference.
    """
    found = []
    for column in columns:
        pair = pd.DataFrame({tier: shared[tier, column] for tier in ("first", "second")}).dropna(how="all")
        apart = _relative(pair["first"].to_numpy(), pair["second"].to_numpy())
        at = _place(pair.index, int(apart.argmax())) if apart.any() else ""
        largest, median = (apart.max(), np.median(apart)) if apart.size else (np.nan, np.nan)
        found.append({"column": column, "rows": apart.size, "largest": largest, "median": median, "at": at})
    return pd.DataFrame(found)


def _relative(first: Array, second: Array) -> Array:
    """|first − second| over |second|; infinite where only one is a number, or where only the second is zero."""
    apart, size = np.abs(first - second), np.abs(second)
    apart[np.isnan(apart)] = np.inf
    unlike = np.divide(apart, size, out=np.full(apart.shape, np.inf), where=size > 0)
    return np.where(apart == 0, 0.0, unlike)


def _place(index: pd.Index, row: int) -> str:
    """A row's keys in words, without those that are the same in all rows."""
    levels = index.to_frame()
    return ", ".join(f"{key} {_short(levels[key].iloc[row])}" for key in levels if len(levels[key].unique()) > 1)


def _short(value: object) -> str:
    return value if isinstance(value, str) else f"{value:g}"


def compared(first: Plan, second: Plan) -> dict[str, pd.DataFrame | None]:
    """Differences of each figure of two tiers; None for one that lists nothing to compare."""
    return {name: _figure(first, second, name) if figure.compare else None for name, figure in second.figures.items()}


def _figure(first: Plan, second: Plan, name: str) -> pd.DataFrame:
    figure = second.figures[name]
    a, b = (_numbers(plan, name) for plan in (first, second))
    places = (*FIT_DIMENSIONS, *(dim for study in figure.studies for dim in second.studies[study].dimensions))
    keys = [place for place in (*places, *a.select_dtypes(exclude="number")) if place in a and place in b]
    keys = list(dict.fromkeys(keys))
    for plan, table in ((first, a), (second, b)):
        known = list(table.drop(columns=keys).select_dtypes("number"))
        for column in figure.compare:
            if column not in known:
                allowed = f"one of {', '.join(known)}; {_remedy(plan, name)}"
                raise SceneError(f"figures.{name}.compare", column, allowed, _path(plan, name))
    try:
        return differences(joined(a, b, keys), figure.compare)
    except SceneError as error:
        raise error.within(f"{_path(first, name)} and {_path(second, name)}", f"figures.{name}") from error


def _path(plan: Plan, name: str) -> str:
    return f"{plan.results}/figures/{name}.csv"


def _remedy(plan: Plan, name: str) -> str:
    return f"`make {name} TIER={plan.tier}` makes the file"


def _numbers(plan: Plan, name: str) -> pd.DataFrame:
    """The numbers that a figure shows."""
    try:
        return pd.read_csv(_path(plan, name))
    except FileNotFoundError as error:
        allowed = f"a file that is there; {_remedy(plan, name)}"
        raise SceneError(f"figures.{name}", "no file", allowed, _path(plan, name)) from error


def is_within(found: pd.DataFrame, limit: float) -> bool:
    """Whether no column differs by more than the limit anywhere; without a shared row nothing is known to be."""
    return bool((found["largest"] <= limit).all())


def summary(found: Mapping[str, pd.DataFrame | None], limit: float) -> str:
    """Each figure with its verdict, and below it one line for each of its columns."""
    columns = [column for table in found.values() if table is not None for column in table["column"]]
    width = max(map(len, ["column", *columns]))
    lines = [f"  {'column':<{width}}   rows   largest    median  largest at"]
    for name, table in found.items():
        if table is None:
            lines.append(f"{name}: not compared")
            continue
        lines.append(f"{name}: {'within' if is_within(table, limit) else 'beyond'} {100 * limit:g} %")
        for row in table.itertuples():
            share = f"{_percent(row.largest):>10}{_percent(row.median):>10}"
            lines.append(f"  {row.column:<{width}}  {row.rows:>5}{share}  {row.at}".rstrip())
    return "\n".join(lines) + "\n"


def _percent(share: float) -> str:
    return "none" if np.isnan(share) else f"{100 * share:.3g} %"
