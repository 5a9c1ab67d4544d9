"""The table in the README and the picture, from the CSV."""

from __future__ import annotations

from pathlib import Path

import measure
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.markers import CARETUPBASE

from contactsim.figures import style
from contactsim.figures.layout import empty_figure

SOLVERS = {
    "active_set": ("active set", style.WHOLE),
    "polonsky_keer": ("Polonsky–Keer, ours", style.CONTACT),
    "tamaas": ("Polonsky–Keer, tamaas", style.PAIRS),
    "verlet": ("damped Verlet", "#8a6d3b"),
}
SWEEP_COLUMNS = {
    "transforms": ("transforms", ".0f"),
    "seconds": ("CPU s", ".2f"),
    "per_transforms": ("÷ transforms", ".2f"),
    "per_replay": ("÷ replay", ".2f"),
}
SIZE_MARKS = {14: ("o", ":"), 16: ("s", "--"), 18: ("D", "-")}
SHOWN = 0.8
FIGURE = {
    "size": [9.0, 4.2],
    "panels": 2,
    "title": "Line contacts: what a solution costs",
    "caption": f"(a) One load at H = {SHOWN:g}, to 0.001 grid steps; arrowheads: not solved in {measure.CAP} s. "
    "(b) Twelve loads, each from scratch with the active set, to two tolerances in grid steps; mean of the members.",
}
BEGIN, END = "<!-- tables: written by line_solvers.py -->", "<!-- end of tables -->"


def write(csv: Path, png: Path, readme: Path) -> None:
    """Put the tables between the marks of the README, and draw the picture."""
    rows = pd.read_csv(csv)
    insert(readme, BEGIN, f"{sweep_table(rows)}\n\n{compare_table(rows)}", END)
    draw(rows, png)


def insert(readme: Path, begin: str, tables: str, end: str) -> None:
    """Put tables between two marks of a README."""
    text = readme.read_text(encoding="utf-8") if readme.exists() else ""
    head, _, rest = text.partition(begin)
    readme.write_text(f"{head}{begin}\n\n{tables}\n\n{end}{rest.partition(end)[2]}", encoding="utf-8")


def markdown(header: list[str], lines: list[list[str]]) -> str:
    """A table with its first column to the left and the others to the right."""
    rules = [":--"] + ["--:"] * (len(header) - 1)
    return "\n".join(f"| {' | '.join(line)} |" for line in [header, rules, *lines])


def power(points: int) -> int:
    """Binary logarithm of a power of two."""
    return points.bit_length() - 1


def sweep_means(rows: pd.DataFrame) -> pd.DataFrame:
    """Means over members: rows (hurst_exponent, points), columns (quantity, tolerance)."""
    chosen = rows[rows.part == "sweep"]
    return chosen.pivot_table(list(SWEEP_COLUMNS), ["hurst_exponent", "points"], "tolerance")


def sweep_table(rows: pd.DataFrame) -> str:
    """One line a Hurst exponent and size; the columns of each tolerance side by side."""
    means = sweep_means(rows)
    tolerances = sorted(means.columns.levels[1], reverse=True)
    columns = [(name, tolerance) for tolerance in tolerances for name in SWEEP_COLUMNS]
    header = ["H", "points"] + [f"{SWEEP_COLUMNS[name][0]}, {tolerance:g}" for name, tolerance in columns]
    lines = [
        [
            f"{hurst_exponent:g}",
            f"2^{power(points)}",
            *(format(mean[column], SWEEP_COLUMNS[column[0]][1]) for column in columns),
        ]
        for (hurst_exponent, points), mean in means.iterrows()
    ]
    return markdown(header, lines)


def compare_table(rows: pd.DataFrame) -> str:
    """One line a size, load and solver."""
    header = ["H", "points", "p*", "solver", "relative area", "certificate", "transforms", "CPU s", "÷ active set"]
    lines, quickest = [], 0.0
    for row in compared(rows).itertuples():
        quickest = row.seconds if row.solver == "active_set" else quickest
        start = [
            f"{row.hurst_exponent:g}",
            f"2^{power(row.points)}",
            f"{row.reduced_pressure:g}",
            SOLVERS[row.solver][0],
        ]
        if pd.isna(row.area):
            lines.append([*start, row.status, "", "", f"> {row.seconds:g}", f"> {row.seconds / quickest:.3g}"])
            continue
        cost = [f"{row.transforms:.0f}", f"{row.seconds:.3g}", f"{row.per_active_set:.3g}"]
        unmet = "" if row.status == "CONVERGED" else f" ({row.status})"
        lines.append([*start, f"{row.area:.6f}", f"{row.certificate:.1e}{unmet}", *cost])
    return markdown(header, lines)


def compared(rows: pd.DataFrame) -> pd.DataFrame:
    """The single loads, in the order of the table."""
    chosen = rows[rows.part == "compare"]
    order = {name: place for place, name in enumerate(SOLVERS)}
    chosen = chosen.assign(place=chosen.solver.map(order), downwards=-chosen.hurst_exponent)
    return chosen.sort_values(["downwards", "points", "reduced_pressure", "place"])


def draw(rows: pd.DataFrame, path: Path) -> None:
    """(a) Time of single loads; (b) transforms of all loads against the size of the grid."""
    footer = "surfaces of rough_line in config/ch3.yaml · one thread · what finished is certified by recomputation"
    figure, (left, right) = empty_figure(FIGURE, footer)
    draw_loads(left, compared(rows[rows.hurst_exponent == SHOWN]))
    draw_sweeps(right, sweep_means(rows))
    style.add_letters((left, right))
    figure.savefig(path)


def draw_loads(axes: Axes, rows: pd.DataFrame) -> None:
    """CPU seconds against reduced pressure: colours are solvers, marks are sizes; arrowheads were stopped."""
    for (name, points), group in rows.groupby(["solver", "points"]):
        colour, solved = SOLVERS[name][1], (group.status == "CONVERGED").to_numpy()
        marked = {"color": colour, "markevery": list(solved.nonzero()[0])}
        axes.plot(group.reduced_pressure, group.seconds, **marked, **size_look(points))
        axes.plot(
            group.reduced_pressure[~solved],
            group.seconds[~solved],
            marker=CARETUPBASE,
            ls="",
            color=colour,
            markersize=8,
        )
    axes.axhline(measure.CAP, color="#999999", linewidth=0.7, zorder=0)
    axes.text(rows.reduced_pressure.min(), measure.CAP, f"{measure.CAP} s", fontsize=7, color="#666666", va="bottom")
    axes.set(xscale="log", yscale="log", xlabel="reduced pressure $p^*$", ylabel="CPU seconds, one load")
    axes.set_ylim(top=1e4)  # room for the legend
    for name in SOLVERS:
        if name in set(rows.solver):
            axes.plot([], [], color=SOLVERS[name][1], label=SOLVERS[name][0])
    for points in sorted(set(rows.points)):
        axes.plot([], [], color=style.EXACT, label=f"$2^{{{power(points)}}}$ points", **size_look(points))
    axes.legend(loc="upper left", ncols=2)


def size_look(points: int) -> dict[str, object]:
    """Marker and line of a size."""
    mark, line = SIZE_MARKS[power(points)]
    return {"marker": mark, "linestyle": line, "markersize": 4, "markerfacecolor": "white", "linewidth": 1.0}


def draw_sweeps(axes: Axes, means: pd.DataFrame) -> None:
    """Transforms against size: marks are Hurst exponents, colours are tolerances."""
    colours = dict(zip(sorted(means.columns.levels[1], reverse=True), (style.WHOLE, style.CONTACT), strict=True))
    for hurst_exponent, group in means.transforms.groupby("hurst_exponent"):
        for tolerance, colour in colours.items():
            axes.plot(
                group.index.get_level_values("points"),
                group[tolerance],
                color=colour,
                **style.hurst_look(hurst_exponent),
            )
    colours = {f"tolerance {tolerance:g} steps": colour for tolerance, colour in colours.items()}
    exponents = style.hurst_handles(sorted(set(means.index.get_level_values("hurst_exponent"))))
    axes.legend(loc="lower right", handles=style.colour_handles(colours) + exponents)
    axes.set_xscale("log", base=2)
    axes.set(ylim=(0, 2700), xlabel="points", ylabel="transforms of the finest grid, all 12 loads")
