"""What accuracy costs, drawn: error across, cost up, one column a knob."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from contactsim import cost, dataset
from contactsim.figures import style
from contactsim.figures.render import framed, move, save

SOLVERS = {
    "active_set": ("o", style.WHOLE),
    "polonsky_keer": ("s", style.CONTACT),
    "tamaas": ("D", style.PAIRS),
    "verlet": ("^", "#8c6d31"),
}
KNOBS = {"points": "grid points", "tolerance": "tolerance", "members": "members"}
COSTS = {"work": "transforms × points", "seconds": "seconds, one thread"}
ROUNDING = 1e-10
"""Errors below it are not drawn: both solutions have the same contact."""


def render(plan: Mapping, files: Mapping[str, str], targets: Mapping[str, str]) -> None:
    """Draw one case into its files.

    plan: of `contactsim.cost.figure_settings`; files: the jobs' datasets and costs in the plan's order, the study's
    dataset and costs; targets: png, pdf, csv and, for the comparison at equal error, equal_error.
    """
    settings, jobs = plan["settings"], plan["jobs"]
    data = {job: dataset.read(path) for job, path in zip(jobs, files["data"], strict=True)}
    table = cost.table(settings, data, dataset.read(files["study"]))
    seconds = [second for path in files["costs"][1:] for second in json.loads(Path(path).read_text())]
    alone = pd.read_csv(files["study_costs"]).query("not companion")
    load = plan["load"]
    chosen = alone[np.isclose(alone[load].to_numpy()[:, None], settings["load"], rtol=1e-6).any(axis=1)]
    members = table.members.dropna() * chosen.seconds.sum() / max(alone.member.nunique(), 1)
    table["seconds"] = [*seconds, *members]
    footer = f"{plan['tier']} tier · {len(table)} settings · best of up to {settings['repeats']} timings"
    figure, panels = framed(settings | {"panels": 4}, footer, rows=2)
    quantity = settings["quantities"][0]
    equal = cost.compared(table, quantity, settings["levels"], COSTS)
    draw(table, equal, data[cost.DEFAULT], np.reshape(panels, (2, 4)), quantity, plan["marks"])
    save(figure, table, targets)
    move(targets["equal_error"], lambda path: equal.to_csv(path, index=False))


def draw(
    table: pd.DataFrame,
    equal: pd.DataFrame,
    values: xr.Dataset,
    axes: np.ndarray,
    quantity: str,
    marks: Mapping[str, int],
) -> None:
    """All panels of one case.

    table: `cost.table` with a column of seconds; equal: `cost.compared`; values: the default solver's dataset; axes
    (2, 4); quantity: whose error is drawn; marks: grid points by what uses them.
    """
    for row, (measure, label) in enumerate(COSTS.items()):
        for column, (knob, title) in enumerate(KNOBS.items()):
            panel = axes[row, column]
            part = table[(table.knob == knob) & (table[quantity] > ROUNDING)]
            if part.empty:
                panel.axis("off")
                continue
            for kind, curve in part.groupby("solver"):
                _curve(panel, curve, quantity, measure, kind)
            if knob == "points":
                _front(panel, part, quantity, measure)
                _marks(panel, part[part.solver == cost.DEFAULT], quantity, measure, marks)
            panel.set(xscale="log", yscale="log", xlabel=f"relative error of {style.SYMBOLS[quantity]}")
            panel.set_ylabel(label if column == 0 else "")
            panel.set_title(title if row == 0 else "", fontsize=9)
            _decades(panel)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    axes[1, 3].legend(handles, labels, loc="lower left", ncols=2)
    _grid_dependence(axes[0, 3], values)
    _words(axes[1, 3], table, equal)


def _decades(axes: Axes) -> None:
    """At least a decade on both axes, and no labels between decades."""
    for axis, limits, put in (
        (axes.xaxis, axes.get_xlim(), axes.set_xlim),
        (axes.yaxis, axes.get_ylim(), axes.set_ylim),
    ):
        put(10.0 ** np.floor(np.log10(limits[0])), 10.0 ** np.ceil(np.log10(limits[1])))
        axis.set_major_locator(LogLocator(numticks=6))
        axis.set_minor_formatter(NullFormatter())


def _curve(axes: Axes, curve: pd.DataFrame, quantity: str, measure: str, kind: str) -> None:
    marker, color = SOLVERS.get(kind, ("x", "#777777"))
    good = curve.unconverged == 0
    look = {"marker": marker, "color": color, "markersize": 4, "linewidth": 1.0, "markerfacecolor": "white"}
    axes.plot(curve[quantity][good], curve[measure][good], label=kind.replace("_", " "), **look)
    axes.plot(curve[quantity][~good], curve[measure][~good], "x", color=color, markersize=7)


def _front(axes: Axes, part: pd.DataFrame, quantity: str, measure: str) -> None:
    """The settings that no other beats in both error and cost."""
    front = part[part.unconverged == 0].sort_values(measure)
    front = front[front[quantity] <= front[quantity].cummin()]
    axes.step(front[quantity], front[measure], where="pre", color="#bbbbbb", lw=4, alpha=0.5, zorder=0, label="front")


def _marks(axes: Axes, part: pd.DataFrame, quantity: str, measure: str, marks: Mapping[str, int]) -> None:
    for points in sorted(set(marks.values())):
        here = part[part.points == points]
        names = [name for name, at in marks.items() if at == points]
        axes.plot(here[quantity], here[measure], "o", markersize=9, markerfacecolor="none", color=style.EXACT)
        for x, y in zip(here[quantity], here[measure], strict=True):
            axes.annotate(", ".join(names), (x, y), (7, 3), textcoords="offset points", fontsize=6.5)


def _grid_dependence(axes: Axes, values: xr.Dataset) -> None:
    """κ_r by Eq. 3.8 and by pairs against the number of points, mean over members and loads."""
    part = values.isel(setting=np.flatnonzero(values.knob == "points"))
    shown = {"kappa_r": style.CONTACT, "kappa_r_bond": style.PAIRS}
    for name, color in ((name, color) for name, color in shown.items() if name in part):
        mean = part[name].mean([dim for dim in part[name].dims if dim not in ("setting", "hurst")])
        for value in part.hurst.values if "hurst" in part.dims else (None,):
            one, look = (mean, style.hurst(0.5)) if value is None else (mean.sel(hurst=value), style.hurst(value))
            axes.plot(part.points, one, color=color, **look)
    axes.set(xlabel="grid points", ylabel=style.SYMBOLS["kappa_r"])
    axes.set_xscale("log", base=2)
    colours = {"Eq. 3.8": style.CONTACT, "pairs in contact": style.PAIRS}
    keys = style.hurst_key(part.hurst.values) if "hurst" in part.dims else []
    axes.legend(handles=keys + style.key(colours, {}))


def _words(axes: Axes, table: pd.DataFrame, equal: pd.DataFrame) -> None:
    """Observed orders, and a table of cost at equal error over that of the default solver."""
    axes.axis("off")
    grids = table[(table.knob == "points") & (table.solver == cost.DEFAULT)]
    orders = [f"{style.SYMBOLS[name]} {cost.order(grids, name):.2f}" for name in style.SYMBOLS if name in table]
    text = f"observed order in points:\n{', '.join(orders)}\n\ncost at equal error over that of the\nactive set, "
    axes.text(0, 1, text + "transforms (seconds):", fontsize=7, va="top", linespacing=1.3)
    others = [kind for kind in SOLVERS if kind in set(equal.solver) - {cost.DEFAULT}]
    kept = equal[equal.solver != cost.DEFAULT].set_index(["knob", "error", "solver"])
    lines = [
        [f"{KNOBS[knob]}, {error:g}", *(_times(kept.loc[(knob, error, kind)]) for kind in others)]
        for knob, error in dict.fromkeys(kept.index.droplevel("solver"))
    ]
    if lines:
        header = ["knob, error", *(kind.replace("_", "\n") for kind in others)]
        shown = axes.table(lines, colLabels=header, bbox=(0, 0.2, 1, 0.52), cellLoc="center", edges="horizontal")
        shown.auto_set_font_size(False)
        shown.set_fontsize(6.5)
        shown.auto_set_column_width(range(len(header)))


def _times(ratios: pd.Series) -> str:
    """Times the default solver's cost, in transforms and in seconds; a dash where it was not measured."""
    return "–" if ratios.isna().any() else f"{ratios.work:.2g} ({ratios.seconds:.2g})"
