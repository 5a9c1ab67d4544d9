"""The verdicts of a chapter as files: CSV, and a table drawn with wrapped text and coloured verdicts."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure

from contactsim import dataset, variables
from contactsim.analysis import ensemble
from contactsim.analysis.claims import CONDITION, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED, judge_claims
from contactsim.analysis.reductions import LIMIT
from contactsim.figures import style
from contactsim.figures.layout import LINE_INCHES, save
from contactsim.notation import READ

COLOURS = {REPRODUCED: "#cfe8d5", CONDITION: "#e9efc4", NOT_REPRODUCED: "#f3cfcb", NOT_DECIDABLE: "#e4e4e4"}
COLUMNS = {
    "source": ("thesis", 1.3),
    "statement": ("statement", 2.6),
    "measure": ("what is compared", 1.65),
    "expected": ("expected", 0.85),
    "value": ("found", 0.65),
    "ensemble_error": ("ensemble\nerror", 0.75),
    "grid_error": ("grid\nerror", 0.65),
    "verdict": ("verdict; on a condition: found\n± ensemble error ± grid error", 1.85),
    "rationale": ("why this band", 2.85),
}
"""Head and width in inches of each column."""
CHARACTERS = 18
"""Characters of the table's font in an inch."""
PADDING = 0.07
TINY = 1e-9
"""Numbers below it have more zeros than a cell of the table."""


def render_claims(plan: Mapping, paths: Mapping[str, str], targets: Mapping[str, str]) -> None:
    """Judge the claims of a chapter and write them.

    plan: `Plan.claims_settings`; paths: the datasets by study; targets: csv, png and pdf.
    """
    data = {study: dataset.load_dataset(path) for study, path in paths.items()}
    rows = judge_claims(dict(plan["claims"]), data)
    number = plan["chapter"].removeprefix("ch")
    figure = drawn(rows, f"Chapter {number}: what it states, and what was found", made_text(data))
    save(figure, rows, targets)


def drawn(rows: pd.DataFrame, title: str, footer: str) -> Figure:
    """The table: a head, one row a claim as high as its longest cell, and a footer."""
    table = [{name: head for name, (head, _) in COLUMNS.items()}, *map(_cells, rows.to_dict("records"))]
    widths = [width for _, width in COLUMNS.values()]
    left = np.cumsum([0.1, *widths])
    heights = [(max(cell.count("\n") for cell in row.values()) + 1) * LINE_INCHES + PADDING for row in table]
    made = textwrap.wrap(footer, int(left[-1] * 22))
    total = 0.35 + sum(heights) + (len(made) + 1) * LINE_INCHES
    figure = Figure(figsize=(left[-1] + 0.1, total))
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, left[-1] + 0.1), ylim=(total, 0))
    axes.axis("off")
    axes.text(left[0], 0.22, title, fontsize=9.5)
    top = 0.35
    for row, height, colour in zip(table, heights, ["#ffffff", *rows.verdict.map(COLOURS)], strict=True):
        for x, width, (name, cell) in zip(left, widths, row.items(), strict=False):
            if name == "verdict":
                axes.fill_between([x, x + width], top, top + height, color=colour, lw=0)
            axes.text(x + 0.04, top + PADDING / 2, cell, fontsize=7, va="top", linespacing=1.1)
        top += height
        axes.plot(left[[0, -1]], [top, top], color="#bbbbbb", lw=0.6)
    axes.text(left[0], top + LINE_INCHES / 2, "\n".join(made), fontsize=6, color="#777777", va="top")
    return figure


def _cells(row: dict) -> dict[str, str]:
    """The text of each cell; under a condition, what was found there follows the verdict."""
    texts = {name: row[name] for name in ("source", "statement", "expected", "rationale", "verdict")}
    texts["measure"] = compared(row["measure"])
    numbers = ("value", "ensemble_error", "grid_error")
    texts |= dict(zip(numbers, rounded(*(row[name] for name in numbers)), strict=True))
    if row["condition"]:
        found = rounded(*(row[f"condition_{name}"] for name in numbers))
        texts["verdict"] += f": {row['condition']}; there " + "\N{NO-BREAK SPACE}±\N{NO-BREAK SPACE}".join(found)
    cells = {name: text.replace("κ_r", "κᵣ").replace("p_r*", "pᵣ*") for name, text in texts.items()}
    return {name: textwrap.fill(cells[name], int(width * CHARACTERS)) for name, (_, width) in COLUMNS.items()}


def compared(measure: str) -> str:
    """What a statement is compared by, with symbols for the names of quantities."""
    return " ".join(symbol(word).replace("_", " ") for word in measure.split())


def symbol(name: str) -> str:
    """A name of the config in symbols; other words as they are."""
    errors = {f"_{kind}_error": f"{kind.replace('_', ' ')} error of " for kind in variables.ERRORS}
    for suffix, words in (errors | {LIMIT: "limit of "}).items():
        if name.endswith(suffix):
            return words + symbol(name.removesuffix(suffix))
    return READ.get(name, name)


def rounded(value: float, *errors: float) -> list[str]:
    """A value and its errors: errors to two digits, the value to the place of the smallest that is not zero.

    Without an error the value has four digits; a dash stands for what is unknown. What rounding leaves of a zero, and
    anything else as small, is written with a power of ten.
    """
    if 0 < abs(value) < TINY:
        return [f"{number:.1e}" if np.isfinite(number) else "–" for number in (value, *errors)]
    places = {error: _places(error, 2) for error in errors if np.isfinite(error) and error > 0}
    finest = places[min(places)] if places else _places(value, 4)
    texts = [f"{value:.{finest}f}" if np.isfinite(value) else "–"]
    return texts + [f"{error:.{places.get(error, 0)}f}" if np.isfinite(error) else "–" for error in errors]


def _places(value: float, digits: int) -> int:
    """Decimals that show so many significant digits."""
    return max(0, digits - 1 - int(f"{abs(value):.{digits - 1}e}".split("e")[1])) if np.isfinite(value) else 0


def made_text(data: Mapping[str, xr.Dataset]) -> str:
    """Tier, and of each dataset its grid, members and unconverged solutions; what the errors are."""
    settings = {study: dataset.settings_of(one) for study, one in data.items()}
    parts = [f"{tier} tier" for tier in sorted({one["tier"] for one in settings.values()})]
    for study, one in data.items():
        lost, total = ensemble.unconverged(one)
        members = f"{one.member.size} members" if one.member.size > 1 else "1 member"
        points = style.points_text(settings[study], *one.points.values.ravel())
        parts.append(f"{study}: {points}, {members}, {lost} of {total} solutions unconverged and left out")
    parts.append("errors to two digits; ensemble error: one standard error over members")
    parts.append("grid error: change on halving the points, and what the increments of a path leave open")
    parts.append("not decidable: an edge of the band is nearer than both errors in quadrature")
    return " · ".join(parts)
