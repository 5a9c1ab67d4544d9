"""One table of variables: unit, long name, and how figures and sentences call them.

The table is `variables.csv` beside this module. What aggregation derives from a variable has its name and a suffix.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import NamedTuple


class Variable(NamedTuple):
    """An entry of the table.

    unit: "1" for ratios; long_name: what it is, in a few words; symbol: a symbol or two words for an axis, in mathtext;
    phrase: the same for a sentence, in letters that need no mathtext.
    """

    unit: str
    long_name: str
    symbol: str = ""
    phrase: str = ""


TABLE = Path(__file__).with_name("variables.csv")


def read_table(table: Path) -> dict[str, dict[str, Variable]]:
    """Return the entries of a table of variables: results and settings."""
    entries: dict[str, dict[str, Variable]] = {"result": {}, "setting": {}}
    with table.open(encoding="utf-8", newline="") as file:
        for kind, name, *entry in list(csv.reader(file))[1:]:
            entries[kind][name] = Variable(*entry)
    return entries


RESULTS, SETTINGS = read_table(TABLE).values()
"""What a dataset may hold, and keys of a study that can be varied; options of a solver are not here and have unit 1."""
SECTIONS = re.compile("^(surface|body|counter_body|solver|increments|pairing|slide)_")
"""Section of a key at the beginning of the name of its dimension."""
LOADS = ("mean_pressure", "reduced_pressure", "contact_ratio")
"""By which loads on their own are prescribed; a study has one of them, and its dataset the dimension of that name."""
ERRORS = {
    "grid": "change on halving the grid",
    "increment": "what the increments of the path leave open",
    "approach": "jackknife error over the approaches that are fitted together",
    "tolerance": "change of the mean on solving more tightly",
    "neglect": "change on neglecting nothing",
    "estimated": "error as estimated from coarser runs",
}
"""Kinds of error beside the standard one, and what each is: of a quantity NAME that of a kind is NAME_KIND_error."""
GRID_ERROR, GRID_CHANGE = "_grid_error", "_grid_change"
"""Ends of the names of the change on halving the grid: its size, and finer minus coarser with its sign."""
GRID_CHANGE_SCATTER = f"{GRID_CHANGE}_standard_error"
"""End of the name of the standard error of that change, over the members that both grids have."""
SUFFIXES = {
    GRID_CHANGE_SCATTER: ": standard error over members of the change on halving the grid",
    "_difference_standard_error": ": standard error of the difference, member by member",
    "_difference": ": mean difference from a reference, member by member",
    "_limit_standard_error": ": standard error over members of the limit on finer grids",
    "_limit": ": mean over members, extrapolated to the limit on finer grids",
    "_order_standard_error": ": standard error over members of the order of convergence",
    "_order": ": order of convergence of the mean with the grid, as observed",
    "_spread": ": the limit on finer grids less that of first order",
    GRID_CHANGE: ": mean on the finer grid minus that on the coarser one",
    "_change_standard_error": ": standard error of the change, member by member",
    "_change": ": change from a reference, as a part of it",
    "_mean": ": mean over members",
    "_standard_error": ": standard error of the mean over members",
    **{f"_{kind}_error": f": {text}" for kind, text in ERRORS.items()},
    "_half_width": ": half-width of the 95 % confidence interval",
}
"""What aggregation adds to a variable's name, and to its long name."""


def base_name(name: str) -> tuple[str, str]:
    """Return a variable's name without the suffix of aggregation, and the suffix in words."""
    if name in RESULTS:
        return name, ""
    for suffix, text in SUFFIXES.items():
        if name.endswith(suffix):
            return name.removesuffix(suffix), text
    return name, ""


def find_variable(name: str) -> Variable:
    """Return the entry of a variable or of a varied key by its name in a dataset; an unknown name is an option."""
    setting = SECTIONS.sub("", name)
    return RESULTS.get(name) or SETTINGS.get(setting) or Variable("1", f"option {name}")


def dimension_name(key: str) -> str:
    """Return the name of the dimension along which a dotted key of a study is varied.

    It is the last part of the key, with its section before it where something else has that name.
    """
    section, _, last = key.rpartition(".")
    ambiguous = last in RESULTS or last == "kind" or section in ("counter_body", "increments")
    return f"{section}_{last}" if section and ambiguous else last
