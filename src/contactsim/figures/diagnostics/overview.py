"""All kinds of scene on one page: error against seconds, a panel a case, two lines a solver."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim import notation
from contactsim.evaluation.work_precision import error_cost
from contactsim.figures import style
from contactsim.figures.diagnostics.knobs import LOOKS
from contactsim.figures.layout import framed, save

COLUMNS = 3
LINES = {"points": "-", "tolerance": ":"}
"""Knobs whose curves are drawn: against a finer grid, and against the same grid solved tightly."""
LEAST = 1e-7
"""Errors below it are drawn there: they are rounding, or as good as that."""


def render(plan: Mapping, tables: Sequence[str], targets: Mapping[str, str]) -> None:
    """Draw all cases into their files.

    plan: settings, and title and quantity of each case; tables: the CSVs of their own figures, by name.
    """
    cases = {name: plan["cases"][name] for name in sorted(plan["cases"])}
    found = {name: pd.read_csv(path) for name, path in zip(cases, tables, strict=True)}
    rows = -(-len(cases) // COLUMNS)
    count = sum(len(_priced(table)) for table in found.values())
    figure, panels = framed(
        plan["settings"] | {"panels": COLUMNS}, f"{plan['tier']} tier · {count} settings", rows=rows
    )
    kept = []
    for panel, (name, table) in zip(panels, found.items(), strict=False):
        quantity = cases[name]["quantity"]
        draw(panel, _priced(table), quantity)
        panel.set_title(f"{cases[name]['title']}: {notation.SYMBOLS[quantity]}", fontsize=7.5)
        kept.append(_priced(table).assign(case=name, quantity=quantity, error=_priced(table)[quantity]))
    for panel in panels[len(found) :]:
        panel.axis("off")
    columns = ["case", "quantity", "solver", "knob", "error", "work", "seconds", "unconverged", "own"]
    save(figure, pd.concat(kept)[columns], targets)


def _priced(table: pd.DataFrame) -> pd.DataFrame:
    """Settings of the knobs that are drawn."""
    return table[table.knob.isin(LINES)]


def draw(axes: Axes, table: pd.DataFrame, quantity: str) -> None:
    """One case: for each solver a curve of grids and one of tolerances, whose errors are of two kinds."""
    good = error_cost.met(table, quantity)
    for kind, rows in good.groupby("solver", sort=False):
        marker, color = LOOKS.get(kind, ("v", "#777777"))
        for knob, line in LINES.items():
            curve = rows[rows.knob == knob].sort_values(quantity)
            look = {"color": color, "ls": line, "lw": 1.8 if rows.own.any() else 1.0, "marker": marker, "ms": 3}
            label = style.solver(kind) if knob == "points" else None
            axes.plot(np.maximum(curve[quantity], LEAST), curve.seconds, label=label, **look)
    axes.set(xscale="log", yscale="log", xlabel="relative error", ylabel="CPU seconds")
    axes.legend(fontsize=6, loc="best")
