"""Compare the numbers that a figure shows at two tiers.

Key columns identify the rows of a table. Rows with the same keys in both tables are joined, and the numbers of their
other columns are compared, relative to the second tier.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from pandas.api.types import is_numeric_dtype

from contactsim.errors import InputError
from contactsim.grid import Array

SAME = 1e-6
"""Relative difference up to which two numbers of a key column are the same."""

FIT_DIMENSIONS = ("fitted", "weighting", "fit_limit")
"""Dimensions of the fits of `contactsim.analysis.fits`."""
BIN_DIMENSIONS = ("pressure_bin", "gap_bin", "area_bin")
"""Dimensions of distributions."""


def join_rows(first: pd.DataFrame, second: pd.DataFrame, keys: list[str]) -> pd.DataFrame:
    """Return the rows that both tables have.

    Parameters
    ----------
    first, second
        The tables.
    keys
        Columns that identify a row. Numbers that differ by less than `SAME` are the same key.

    Returns
    -------
    Table with the keys as index, and the columns below "first" and "second".

    Raises
    ------
    InputError
        If the keys do not identify the rows.
    """
    numeric = [key for key in keys if is_numeric_dtype(first[key]) and is_numeric_dtype(second[key])]
    second = second.assign(**{key: _snap(second[key].to_numpy(), first[key].unique()) for key in numeric})
    for table in (first, second):
        if not keys or table.duplicated(keys).any():
            raise InputError("key columns", keys, "columns that tell all rows apart")
    return pd.concat({"first": first.set_index(keys), "second": second.set_index(keys)}, axis=1, join="inner")


def _snap(values: Array, references: Array) -> Array:
    """Return the values, each replaced by the reference that is the same to rounding."""
    if references.size == 0:
        return values
    nearest = references[np.abs(values[:, None] - references).argmin(axis=1)]
    return np.where(np.abs(values - nearest) <= SAME * np.abs(nearest), nearest, values)


def differences(shared: pd.DataFrame, columns: list[str]) -> pd.DataFrame:
    """Return the relative differences of joined rows.

    Parameters
    ----------
    shared
        Rows as of `join_rows`.
    columns
        Columns to compare.

    Returns
    -------
    One row for each column: `column`, `rows` with a number in either tier, `largest` and `median` difference, and
    `at`, the keys of the largest difference. A number in one tier only differs infinitely.
    """
    rows = []
    for column in columns:
        pair = pd.DataFrame({tier: shared[tier, column] for tier in ("first", "second")}).dropna(how="all")
        changes = _relative_differences(pair["first"].to_numpy(), pair["second"].to_numpy())
        at = _row_text(pair.index, int(changes.argmax())) if changes.any() else ""
        largest, median = (changes.max(), np.median(changes)) if changes.size else (np.nan, np.nan)
        rows.append({"column": column, "rows": changes.size, "largest": largest, "median": median, "at": at})
    return pd.DataFrame(rows)


def _relative_differences(first: Array, second: Array) -> Array:
    """Return |first − second|/|second|; infinite if only one is a number or only the second is zero."""
    changes, size = np.abs(first - second), np.abs(second)
    changes[np.isnan(changes)] = np.inf
    relative = np.divide(changes, size, out=np.full(changes.shape, np.inf), where=size > 0)
    return np.where(changes == 0, 0.0, relative)


def _row_text(index: pd.Index, row: int) -> str:
    """Return the keys of a row in words, without keys that are the same in all rows."""
    levels = index.to_frame()
    return ", ".join(f"{key} {_value_text(levels[key].iloc[row])}" for key in levels if len(levels[key].unique()) > 1)


def _value_text(value: object) -> str:
    """Return a key's value in words."""
    return value if isinstance(value, str) else f"{value:g}"


def is_within(table: pd.DataFrame, limit: float) -> bool:
    """Return True if no column of a table of `differences` differs by more than the limit; False without rows."""
    return bool((table["largest"] <= limit).all())


def difference_text(tables: Mapping[str, pd.DataFrame | None], limit: float) -> str:
    """Return a text with the verdict on each figure, and below it one line for each of its columns."""
    columns = [column for table in tables.values() if table is not None for column in table["column"]]
    width = max(map(len, ["column", *columns]))
    lines = [f"  {'column':<{width}}   rows   largest    median  largest at"]
    for name, table in tables.items():
        if table is None:
            lines.append(f"{name}: not compared, its settings name no columns")
            continue
        lines.append(f"{name}: {'within' if is_within(table, limit) else 'beyond'} {100 * limit:g} %")
        for row in table.itertuples():
            share = f"{_percent(row.largest):>10}{_percent(row.median):>10}"
            lines.append(f"  {row.column:<{width}}  {row.rows:>5}{share}  {row.at}".rstrip())
    return "\n".join(lines) + "\n"


def _percent(share: float) -> str:
    """Return a share in per cent."""
    return "none" if np.isnan(share) else f"{100 * share:.3g} %"
