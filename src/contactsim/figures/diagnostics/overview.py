"""Accuracy versus cost of all kinds of scene on one page: one panel a case, two curves a solver."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim.evaluation.work_precision import error_cost
from contactsim.figures import style
from contactsim.figures.diagnostics.accuracy_footer import kept_texts
from contactsim.figures.diagnostics.knobs import OTHER_LOOK, SOLVER_LOOKS
from contactsim.figures.layout import empty_figure, save
from contactsim.variables import RESULTS

PANELS_IN_ROW = 3
KNOB_LINES = {"points": "-", "tolerance": ":"}
"""Lines of the knobs that are shown: error against a finer grid, and against the same grid with a small tolerance."""
SMALLEST_ERROR = 1e-7
"""Smaller errors, which are rounding, are plotted here."""
COLUMNS = ["case", "quantity", "solver", "knob", "error", "work", "seconds", "unconverged", "own"]


@mpl.rc_context(style.RC_PARAMS)
def write_overview(plan: Mapping[str, Any], paths: Sequence[str], targets: Mapping[str, str]) -> None:
    """Plot all cases and write the files.

    Parameters
    ----------
    plan : tier, settings of the figure, title and quantity of each case, and kept solvers of each case
    paths : of the CSV files of the cases' own figures, in the order of their names
    targets : png, pdf, svg and csv
    """
    cases = {name: plan["cases"][name] for name in sorted(plan["cases"])}
    tables = {name: pd.read_csv(path) for name, path in zip(cases, paths, strict=True)}
    tables = {name: table[table.knob.isin(KNOB_LINES)] for name, table in tables.items()}
    footer = [f"{plan['tier']} tier", f"{sum(map(len, tables.values()))} settings", *kept_texts(*plan["kept"].values())]
    layout = plan["settings"] | {"panels": PANELS_IN_ROW}
    figure, panels = empty_figure(layout, " · ".join(footer), rows=-(-len(cases) // PANELS_IN_ROW))
    parts = []
    for panel, (name, table) in zip(panels, tables.items(), strict=False):
        quantity = cases[name]["quantity"]
        plot_case(panel, table, quantity)
        panel.set_title(f"{cases[name]['title']}: {RESULTS[quantity].symbol}", fontsize=7.5)
        parts.append(table.assign(case=name, quantity=quantity, error=table[quantity]))
    for panel in panels[len(tables) :]:
        panel.axis("off")
    save(figure, pd.concat(parts)[COLUMNS], targets)


def plot_case(axes: Axes, table: pd.DataFrame, quantity: str) -> None:
    """Plot seconds against the error of a quantity: for each solver a curve of grids and one of tolerances."""
    good = error_cost.converged_rows(table, quantity)
    for kind, rows in good.groupby("solver", sort=False):
        marker, colour = SOLVER_LOOKS.get(str(kind), OTHER_LOOK)
        width = 1.8 if rows.own.any() else 1.0
        for knob, line in KNOB_LINES.items():
            curve = rows[rows.knob == knob].sort_values(quantity)
            look = {"color": colour, "ls": line, "lw": width, "marker": marker, "ms": 3}
            label = style.solver_name(str(kind)) if knob == "points" else None
            axes.plot(np.maximum(curve[quantity], SMALLEST_ERROR), curve.seconds, label=label, **look)
    axes.set(xscale="log", yscale="log", xlabel="relative error", ylabel="CPU seconds")
    axes.legend(fontsize=6, loc="best")
