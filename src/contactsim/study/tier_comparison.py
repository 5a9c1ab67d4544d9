"""Compare the figures of two tiers by their CSV files, which are read as they are: `make` brings them up to date."""

from __future__ import annotations

import pandas as pd

from contactsim.analysis.table_comparison import BIN_DIMENSIONS, FIT_DIMENSIONS, differences, join_rows
from contactsim.errors import InputError, Words
from contactsim.study.plan import Plan


def compare_tiers(first: Plan, second: Plan) -> dict[str, pd.DataFrame | None]:
    """Return the differences of each figure of two tiers; None for a figure that lists nothing to compare.

    Raises
    ------
    InputError
        If a file is missing, or lacks a column that the figure compares.
    """
    return {
        name: _compare_figure(first, second, name) if figure.compare else None
        for name, figure in second.figures.items()
    }


def _compare_figure(first: Plan, second: Plan, name: str) -> pd.DataFrame:
    """Return the differences of one figure; its key columns are dimensions of its studies and columns of words."""
    figure = second.figures[name]
    tables = [_read_numbers(plan, name) for plan in (first, second)]
    own = (dim for study in figure.studies for dim in second.studies[study].dimensions)
    dims = (*FIT_DIMENSIONS, *BIN_DIMENSIONS, *own)
    candidates = dict.fromkeys((*dims, *tables[0].select_dtypes(exclude="number")))
    keys = [key for key in candidates if all(key in table for table in tables)]
    for plan, table in zip((first, second), tables, strict=True):
        numeric = list(table.drop(columns=keys).select_dtypes("number"))
        for column in figure.compare:
            if column not in numeric:
                allowed = f"one of {', '.join(numeric)}; {_remedy(plan, name)}"
                raise InputError(f"figures.{name}.compare", column, allowed, _path(plan, name))
    try:
        return differences(join_rows(tables[0], tables[1], keys), figure.compare)
    except InputError as error:
        raise error.located(f"{_path(first, name)} and {_path(second, name)}", f"figures.{name}") from error


def _path(plan: Plan, name: str) -> str:
    """Return the path of a figure's numbers."""
    return f"{plan.results}/figures/{name}.csv"


def _remedy(plan: Plan, name: str) -> str:
    """Return the command that makes a figure's numbers."""
    return f"`make {name} TIER={plan.tier}` makes the file"


def _read_numbers(plan: Plan, name: str) -> pd.DataFrame:
    """Return the numbers that a figure shows, without the points that it draws from them."""
    try:
        table = pd.read_csv(_path(plan, name))
    except FileNotFoundError as error:
        allowed = f"a file that is there; {_remedy(plan, name)}"
        raise InputError(f"figures.{name}", Words("no file"), allowed, _path(plan, name)) from error
    if "point" not in table:
        return table
    numbers = table[table.point.isna()]
    words = [column for column in numbers.select_dtypes(exclude="number") if numbers[column].isna().all()]
    return numbers.drop(columns=words)  # those of the points
