"""All kinds of scene on one page: error against seconds, a panel a case, a line a solver."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim import precision
from contactsim.figures import style
from contactsim.figures.knobs import LOOKS
from contactsim.figures.render import framed, save

COLUMNS = 3
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
        panel.set_title(f"{cases[name]['title']}: {style.SYMBOLS[quantity]}", fontsize=7.5)
        kept.append(_priced(table).assign(case=name, quantity=quantity, error=_priced(table)[quantity]))
    for panel in panels[len(found) :]:
        panel.axis("off")
    columns = ["case", "quantity", "solver", "knob", "error", "work", "seconds", "unconverged", "own"]
    save(figure, pd.concat(kept)[columns], targets)


def _priced(table: pd.DataFrame) -> pd.DataFrame:
    """Settings of one member: an ensemble's error is of another kind."""
    return table[table.knob != "members"]


def draw(axes: Axes, table: pd.DataFrame, quantity: str) -> None:
    """One case: every setting as a dot, and of each solver the least time at which an error is met."""
    good = precision.met(table, quantity)
    for kind, rows in good.groupby("solver", sort=False):
        marker, color = LOOKS.get(kind, ("v", "#777777"))
        own = bool(rows.own.any())
        axes.plot(
            np.maximum(rows[quantity], LEAST), rows.seconds, ls="", marker=marker, color=color, ms=2.5, alpha=0.45
        )
        front = precision.front(rows, quantity, "seconds")
        label = style.SOLVERS.get(kind, kind)
        look = {"color": color, "lw": 2.0 if own else 1.0, "label": label, "where": "pre"}
        axes.step(np.maximum(front[quantity], LEAST), front.seconds, **look)
    axes.set(xscale="log", yscale="log", xlabel="relative error", ylabel="CPU seconds")
    axes.legend(fontsize=6, loc="best")
