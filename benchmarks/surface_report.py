"""The table of surfaces in the README and its picture, from the CSV."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.markers import CARETUPBASE
from measure import CAP
from report import insert, markdown

from contactsim.figures import style
from contactsim.figures.layout import empty_figure

SOLVERS = {
    "ours": ("conjugate gradients, ours", style.WHOLE),
    "aspher": ("aspher, nested", style.CONTACT),
    "tamaas": ("Polonsky–Keer, tamaas", style.PAIRS),
}
FIGURE = {
    "size": [9.0, 6.8],
    "panels": 3,
    "title": "Surface contacts: what a solution costs",
    "caption": f"CPU time of one load, to 1e-6 grid steps, over that of a real transform of the heights by scipy; "
    f"arrowheads: not solved in {CAP} s.",
}
BEGIN, END = "<!-- tables: written by surface_solvers.py -->", "<!-- end of tables of surfaces -->"
COLUMNS = ("H", "points", "p*", "solver", "relative area", "certificate", "transforms", "CPU s", "÷ one transform")
COLUMNS += ("÷ ours", "contact differs at", "of these undecided")


def write(csv: Path, png: Path, readme: Path) -> None:
    """Put the table between the marks of the README, and draw the picture."""
    rows = pd.read_csv(csv)
    rows = rows[rows.part == "pair"].sort_values(["points", "hurst_exponent", "reduced_pressure", "solver"])
    insert(readme, BEGIN, table(rows), END)
    draw(rows, png)


def table(rows: pd.DataFrame) -> str:
    """A line for ours, measured beside the first peer, and one for each peer."""
    lines = []
    for (points, hurst_exponent, pressure), group in rows.groupby(["points", "hurst_exponent", "reduced_pressure"]):
        start = [f"{hurst_exponent:g}", f"{points}²", f"{pressure:g}"]
        own = group.dropna(subset="own_seconds").head(1)
        for row in own.itertuples():
            cost = row.own_transforms, row.own_seconds, row.own_per_transform
            lines.append([*start, "ours", *found(row.own_area, row.own_certificate, *cost), "", "", ""])
        for row in group.itertuples():
            name = row.solver if pd.isna(row.settings) else f"{row.solver}, {row.settings}"
            if pd.isna(row.area):
                least = row.seconds / own.own_seconds.iloc[0] if len(own) else float("nan")
                lines.append([*start, name, row.status, "", "", f"> {row.seconds:g}", "", f"> {least:.3g}", "", ""])
                continue
            cells = found(row.area, row.certificate, row.transforms, row.seconds, row.per_transform)
            sets = f"{row.differing:.0f}", f"{row.undecided:.0f}"
            lines.append([*start, name, *cells, f"{row.ratio:.3g}", *sets])
    return markdown(list(COLUMNS), lines)


def found(area: float, certificate: float, transforms: float, seconds: float, per_transform: float) -> list[str]:
    """What a solution is and costs, as cells of the table."""
    return [f"{area:.6f}", f"{certificate:.1e}", f"{transforms:.0f}", f"{seconds:.3g}", f"{per_transform:.0f}"]


def draw(rows: pd.DataFrame, path: Path) -> None:
    """A panel for each size, and the legend in the last place."""
    footer = "surfaces of rough_surface in config/ch3.yaml · one thread · what finished is certified by recomputation"
    sizes = sorted(set(rows.points))
    figure, places = empty_figure(FIGURE, footer, rows=len(sizes) // FIGURE["panels"] + 1)
    panels, rest = places[: len(sizes)], places[len(sizes) :]
    for axes, points in zip(panels, sizes, strict=True):
        loads(axes, rows[rows.points == points])
        axes.set_ylabel("CPU time, in transforms of the heights")
        axes.set_title(f"{points} × {points} points", fontsize=9)
        axes.label_outer()
    for axes in panels[-FIGURE["panels"] :]:  # no panel below
        axes.tick_params(labelbottom=True)
        axes.set_xlabel("reduced pressure $p^*$")
    style.add_letters(panels)
    limits = np.array([[axes.get_xlim(), axes.get_ylim()] for axes in panels])
    for axes in panels:
        axes.set(xlim=(limits[:, 0].min(), limits[:, 0].max()), ylim=(limits[:, 1].min(), limits[:, 1].max()))
    for axes in rest:
        axes.axis("off")
    colours = dict(SOLVERS[name] for name in ("ours", *sorted(set(rows.solver))))
    handles = style.colour_handles(colours) + style.hurst_handles(sorted(set(rows.hurst_exponent)))
    rest[-1].legend(loc="center", handles=handles)
    figure.savefig(path)


def loads(axes: Axes, rows: pd.DataFrame) -> None:
    """Cost against reduced pressure: colours are solvers, marks are Hurst exponents."""
    for hurst_exponent, group in rows.groupby("hurst_exponent"):
        own = group.groupby("reduced_pressure").agg({"own_per_transform": "median", "transform_seconds": "median"})
        axes.plot(own.index, own.own_per_transform, color=SOLVERS["ours"][1], **style.hurst_look(hurst_exponent))
        for name, part in group.groupby("solver"):
            colour, solved = SOLVERS[name][1], part.area.notna()
            axes.plot(
                part.reduced_pressure[solved],
                part.per_transform[solved],
                color=colour,
                **style.hurst_look(hurst_exponent),
            )
            cut = part[~solved]
            least = cut.seconds / own.transform_seconds.reindex(cut.reduced_pressure).to_numpy()
            axes.plot(cut.reduced_pressure, least, marker=CARETUPBASE, ls="", color=colour, markersize=8)
    axes.set(xscale="log", yscale="log")
