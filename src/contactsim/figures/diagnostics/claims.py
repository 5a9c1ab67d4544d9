"""Files of the claims of a chapter: CSV, and a table with wrapped text and coloured verdicts."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactsim import dataset
from contactsim.analysis.dataset_summary import sample_texts
from contactsim.analysis.rounding import NUMBERS, number_cells, short_number
from contactsim.analysis.verdict import CONDITION, DEPENDS, FINDING, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED
from contactsim.analysis.wording import beside_text, choices_text, measure_text, printed
from contactsim.figures import style
from contactsim.figures.layout import FOOTER_LETTERS, LINE_HEIGHT, save

COLOURS = {
    REPRODUCED: "#cfe8d5",
    CONDITION: "#e9efc4",
    DEPENDS: "#f6e6c2",
    NOT_REPRODUCED: "#f3cfcb",
    NOT_DECIDABLE: "#e4e4e4",
    FINDING: "#eef2f8",
}
COLUMNS = {
    "source": ("thesis", 1.3),
    "statement": ("statement", 2.6),
    "measure": ("what is compared", 1.65),
    "expected": ("expected", 0.85),
    "value": ("found", 0.65),
    "ensemble_error": ("ensemble\nerror", 0.75),
    "grid_error": ("grid\nerror", 0.65),
    "margin": ("margin,\nin errors", 0.6),
    "place": ("place in\nthe band", 0.6),
    "verdict": ("verdict; on a condition: found\n± ensemble error ± grid error", 1.85),
    "rationale": ("why this band", 2.85),
}
"""Head of each column, and its width in inches."""
CELL_LETTERS = 18
"""Letters of the table in an inch."""
PADDING = 0.07
"""Space in a cell above and below its text together, inches."""
TITLE_HEIGHT = 0.35
PLUS_MINUS = "\N{NO-BREAK SPACE}±\N{NO-BREAK SPACE}"


@mpl.rc_context(style.RC_PARAMS)
def write_claims(
    verdicts: pd.DataFrame, chapter: str, data: Mapping[str, xr.Dataset], targets: Mapping[str, str]
) -> None:
    """Write the claims of a chapter with their verdicts.

    Parameters
    ----------
    verdicts : one row a claim, of `contactsim.analysis.claims.verdicts`
    chapter : its name, such as "ch3"
    data : the datasets of the studies by name
    targets : paths of the files: csv, png, pdf and svg
    """
    title = f"Chapter {chapter.removeprefix('ch')}: what it states, and what was found"
    save(claims_figure(verdicts, title, footer_text(verdicts, data)), verdicts, targets)


def claims_figure(verdicts: pd.DataFrame, title: str, footer: str) -> Figure:
    """Return the table: a head, one row a claim as high as its longest cell, and a footer."""
    table = [{name: head for name, (head, _) in COLUMNS.items()}, *map(_cells, verdicts.to_dict("records"))]
    width = 0.1 + sum(width for _, width in COLUMNS.values())
    heights = [(max(cell.count("\n") for cell in row.values()) + 1) * LINE_HEIGHT + PADDING for row in table]
    footer_lines = textwrap.wrap(footer, int(width * FOOTER_LETTERS))
    total = TITLE_HEIGHT + sum(heights) + (len(footer_lines) + 1) * LINE_HEIGHT
    figure = Figure(figsize=(width + 0.1, total))
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width + 0.1), ylim=(total, 0))
    axes.axis("off")
    axes.text(0.1, 0.22, title, fontsize=9.5)
    top = TITLE_HEIGHT
    for row, height, colour in zip(table, heights, ["#ffffff", *verdicts.verdict.map(COLOURS)], strict=True):
        _draw_row(axes, row, top, height, colour)
        top += height
        axes.plot([0.1, width], [top, top], color="#bbbbbb", lw=0.6)
    axes.text(0.1, top + LINE_HEIGHT / 2, "\n".join(footer_lines), fontsize=6, color=style.GREY, va="top")
    return figure


def _draw_row(axes: Axes, row: Mapping[str, str], top: float, height: float, colour: str) -> None:
    """Draw the cells of one row, that of the verdict on its colour."""
    edges = np.cumsum([0.1, *(width for _, width in COLUMNS.values())])
    for x, (_, width), (name, cell) in zip(edges, COLUMNS.values(), row.items(), strict=False):
        if name == "verdict":
            axes.fill_between([x, x + width], top, top + height, color=colour, lw=0)
        axes.text(x + 0.04, top + PADDING / 2, cell, fontsize=7, va="top", linespacing=1.1)


def _cells(row: Mapping[Any, Any]) -> dict[str, str]:
    """Return the text of each cell; a condition and the value under it follow the verdict."""
    texts = {name: row[name] for name in ("source", "statement", "expected", "rationale", "verdict")}
    texts["measure"] = measure_text(row["measure"])
    texts |= dict(zip(NUMBERS, number_cells(row), strict=True))
    if row["condition"]:
        values = number_cells(row, "condition_")
        texts["verdict"] += (
            f": {row['condition']}, {row['condition_share']:.0%} of all; there {PLUS_MINUS.join(values)}"
        )
    if beside := beside_text(row):
        texts["verdict"] += f"; beside it {beside}"
    if readings := choices_text(row):
        texts["verdict"] += f": {readings}"
    if row["unknown"]:
        texts["verdict"] += f": unknown is {row['unknown']}"
    texts |= {name: short_number(row[name]) for name in ("margin", "place")}
    widths = {name: int(width * CELL_LETTERS) for name, (_, width) in COLUMNS.items()}
    return {name: textwrap.fill(printed(texts[name]), width) for name, width in widths.items()}


def footer_text(verdicts: pd.DataFrame, data: Mapping[str, xr.Dataset]) -> str:
    """Return the tier, the sample of each dataset, the meaning of the errors, and how much the bands decide."""
    tiers = sorted({dataset.settings_of(part)["tier"] for part in data.values()})
    parts = [f"{tier} tier" for tier in tiers]
    parts += [f"{study}: {', '.join(sample_texts(part))}" for study, part in data.items()]
    parts.append("numbers to two digits of both errors together; ensemble error: one standard error over members")
    parts.append("grid error: change on halving the points, and what the increments of a path leave open")
    parts.append("margin: distance to the edge of the band over both errors in quadrature; below 2 not decidable")
    parts.append("place in the band: 0 at the value stated, or where nothing changes; 1 at the edge")
    return " · ".join([*parts, *band_texts(verdicts)])


def band_texts(verdicts: pd.DataFrame) -> list[str]:
    """Return how many claims are reproduced, on a condition or not, with half, whole and double bands."""
    columns = {"half": "verdict_half", "these": "verdict", "double": "verdict_double"}
    counts = {name: int(verdicts[column].isin([REPRODUCED, CONDITION]).sum()) for name, column in columns.items()}
    return [
        f"reproduced, also on a condition: {', '.join(f'{count} with {name} bands' for name, count in counts.items())}"
    ]
