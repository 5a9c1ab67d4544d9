"""One knob varied: error across, cost up, a curve for each solver, rings at the values of the tiers and the thesis."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim.evaluation.work_precision import error_cost
from contactsim.evaluation.work_precision.error_cost import ROUNDING
from contactsim.figures import style

SOLVER_LOOKS = {
    "active_set": ("o", style.WHOLE),
    "conjugate_gradients": ("o", style.WHOLE),
    "newton": ("o", style.WHOLE),
    "polonsky_keer": ("s", style.CONTACT),
    "mass_weighted_verlet": ("s", style.CONTACT),
    "tamaas": ("D", style.PAIRS),
    "energy_minimisation": ("D", style.PAIRS),
    "verlet": ("^", style.BROWN),
    "damped_verlet": ("^", style.BROWN),
}
"""Marker and colour of each solver."""
OTHER_LOOK = ("v", style.GREY)
MARGIN, FOOT, LINE_WIDTH = 0.1, 0.33, 0.05
"""Parts of a panel: the margin of errors without a logarithm, the foot with the names of the rings, and the width of a
line of these names."""
LONG_NAME = 16
"""Letters above which the name of a ring is broken."""


def names_by_value(marks: Mapping[str, Mapping[str, float]], knob: str) -> dict[float, str]:
    """Return the tiers, and the thesis, that use each value of a knob, as text."""
    values = {name: own[knob] for name, own in marks.items() if knob in own}
    tiers = [name for name in marks if name != "thesis"]
    texts = {}
    for value in sorted(set(values.values())):
        names = [name for name, own in values.items() if own == value]
        if len(tiers) > 1 and set(tiers) <= set(names):
            names = ["all tiers", *(name for name in names if name not in tiers)]
        texts[value] = ", ".join(names)
    return texts


def marked_rows(table: pd.DataFrame, quantity: str, knob: str, value: float) -> pd.DataFrame:
    """Return the settings of the study's own solver at a value of a knob whose error is known."""
    good = error_cost.converged_rows(table, quantity)
    return good[(good.knob == knob) & good.own & np.isclose(good[knob], value, rtol=1e-9)]


def plot_knob(axes: Axes, part: pd.DataFrame, quantity: str, cost: str, names: Mapping[float, str]) -> None:
    """Plot the cost against the error for one knob, on logarithmic axes.

    Parameters
    ----------
    axes : to plot on
    part : settings of the knob, of `contactsim.evaluation.work_precision.error_cost.error_table`
    quantity : whose error is plotted; an error of zero or infinity stands in a margin
    cost : column of the cost
    names : of the rings, by value of the knob
    """
    (knob,) = part.knob.unique()
    part = _with_places(axes, part, quantity)
    _plot_least_cost(axes, part, quantity, cost)
    for kind, curve in part.groupby("solver", sort=False):
        _plot_solver(axes, curve, quantity, cost, str(kind))
    rings = [
        (row["at"], row[cost], name)
        for value, name in names.items()
        for _, row in marked_rows(part, quantity, knob, value).iterrows()
    ]
    low, high = part[cost].min() / 1.5, part[cost].max() * 1.5
    low /= (high / low) ** (FOOT / (1 - FOOT)) if rings else 1.0
    axes.set_ylim(low, high)
    style.set_log_ticks(axes.yaxis, low, high)
    _plot_rings(axes, rings)


def _with_places(axes: Axes, part: pd.DataFrame, quantity: str) -> pd.DataFrame:
    """Set the horizontal axis with its margins; return the table with the horizontal places as column `at`."""
    errors = part[quantity]
    low, high = style.log_range(errors[(errors > ROUNDING) & np.isfinite(errors)])
    margin = (high / low) ** MARGIN
    zero, infinite = errors <= ROUNDING, np.isinf(errors)
    axes.set(xscale="log", yscale="log")
    edges = [low, high]
    for side, (label, has_points) in enumerate((("0", zero.any()), ("∞", infinite.any()))):
        if has_points:
            inner, edges[side] = edges[side], edges[side] * margin ** (2 * side - 1)
            axes.axvspan(inner, edges[side], color="#efefef", lw=0, zorder=0)
            middle = (inner * edges[side]) ** 0.5
            axes.text(middle, 0.98, label, transform=axes.get_xaxis_transform(), ha="center", va="top")
    axes.set_xlim(edges)
    style.set_log_ticks(axes.xaxis, low, high)
    return part.assign(at=errors.mask(zero, low / margin**0.5).mask(infinite, high * margin**0.5))


def _plot_solver(axes: Axes, curve: pd.DataFrame, quantity: str, cost: str, kind: str) -> None:
    """Plot the curve of a solver; settings without error stand beside it, failed ones are crosses."""
    marker, colour = SOLVER_LOOKS.get(kind, OTHER_LOOK)
    good = curve.index.isin(error_cost.converged_rows(curve, quantity).index)
    on_curve = good & (curve[quantity] > ROUNDING)
    look = {"marker": marker, "color": colour, "markersize": 4, "linewidth": 1.0, "markerfacecolor": "white"}
    axes.plot(curve["at"][on_curve], curve[cost][on_curve], label=style.solver_name(kind), **look)
    axes.plot(curve["at"][good & ~on_curve], curve[cost][good & ~on_curve], **look | {"linewidth": 0.0})
    axes.plot(curve["at"][~good], curve[cost][~good], "x", color=colour, markersize=7)


def _plot_least_cost(axes: Axes, part: pd.DataFrame, quantity: str, cost: str) -> None:
    """Plot the least cost at which an error is met by any of several solvers."""
    if len(part.solver.unique()) > 1:
        front = error_cost.pareto_front(part, quantity, cost)
        look: dict[str, Any] = {"color": "#bbbbbb", "lw": 4, "alpha": 0.5, "zorder": 0.5, "label": "least cost"}
        axes.step(front["at"], front[cost], where="pre", **look)


def _plot_rings(axes: Axes, rings: list[tuple[float, float, str]]) -> None:
    """Plot rings (x, y, name), with their names below all curves; names of neighbours share one text."""
    for x, y, _ in rings:
        axes.plot([x], [y], "o", markersize=9, markerfacecolor="none", color=style.EXACT)
        axes.plot([x, x], [axes.get_ylim()[0], y], color=style.EXACT, lw=0.5, ls=(0, (2, 3)), zorder=0.6)
    line_width = LINE_WIDTH * float(np.diff(np.log(axes.get_xlim()))[0])
    texts: list[tuple[float, list[str]]] = []
    for x, _, name in sorted(rings):
        lines = name.replace(", ", ",\n", 1).split("\n") if len(name) > LONG_NAME else [name]
        close = bool(texts) and np.log(x / texts[-1][0]) < line_width * len(texts[-1][1])
        texts.append((x, [*texts.pop()[1], *lines] if close else lines))
    look: dict[str, Any] = {"rotation": 90, "fontsize": 6.5, "va": "bottom", "textcoords": "offset points"}
    for x, lines in texts:
        axes.annotate("\n".join(lines), (x, 0), (1.5, 4), axes.get_xaxis_transform(), **look)
