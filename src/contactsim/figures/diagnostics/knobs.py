"""One knob turned, drawn: error across, cost up, a curve for each solver, rings where a tier or the thesis is."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from contactsim.evaluation.work_precision import error_cost
from contactsim.evaluation.work_precision.error_cost import ROUNDING
from contactsim.figures import style

LOOKS = {
    "active_set": ("o", style.WHOLE),
    "conjugate_gradients": ("o", style.WHOLE),
    "newton": ("o", style.WHOLE),
    "polonsky_keer": ("s", style.CONTACT),
    "mass_weighted_verlet": ("s", style.CONTACT),
    "tamaas": ("D", style.PAIRS),
    "energy_minimisation": ("D", style.PAIRS),
    "verlet": ("^", "#8c6d31"),
    "damped_verlet": ("^", "#8c6d31"),
}
MARGIN, FOOT, NEAR = 0.1, 0.33, 0.05
"""Parts of a panel: the margin of errors that have no logarithm, the foot with the names of the marks, and the
width of a line of these."""


def named(marks: Mapping[str, Mapping[str, float]], knob: str) -> dict[float, str]:
    """What uses each value of a knob: tiers and the thesis."""
    places = {name: own[knob] for name, own in marks.items() if knob in own}
    tiers = [name for name in marks if name != "thesis"]
    found = {}
    for value in sorted(set(places.values())):
        names = [name for name, at in places.items() if at == value]
        every = len(tiers) > 1 and set(tiers) <= set(names)
        found[value] = ", ".join(["all tiers", *(name for name in names if name not in tiers)] if every else names)
    return found


def marked(table: pd.DataFrame, quantity: str, knob: str, value: float) -> pd.DataFrame:
    """The setting of the study's own solver that has this value of a knob, if it is on the curve."""
    good = error_cost.met(table, quantity)
    return good[(good.knob == knob) & good.own & np.isclose(good[knob], value, rtol=1e-9)]


def panel(axes: Axes, part: pd.DataFrame, quantity: str, measure: str, marks: Mapping[float, str]) -> None:
    """One knob's curves of cost against error; errors without a logarithm in the margins."""
    errors, (knob,) = part[quantity], part.knob.unique()
    low, high = style.limits(errors[(errors > ROUNDING) & np.isfinite(errors)])
    margin = (high / low) ** MARGIN
    part = part.assign(at=errors.mask(errors <= ROUNDING, low / margin**0.5).mask(np.isinf(errors), high * margin**0.5))
    axes.set(xscale="log", yscale="log")
    edges = [low, high]
    for place, (text, shown) in enumerate((("0", (errors <= ROUNDING).any()), ("∞", np.isinf(errors).any()))):
        if shown:
            inner, edges[place] = edges[place], edges[place] * margin ** (2 * place - 1)
            axes.axvspan(inner, edges[place], color="#efefef", lw=0, zorder=0)
            middle = (inner * edges[place]) ** 0.5
            axes.text(middle, -0.025, text, transform=axes.get_xaxis_transform(), ha="center", va="top")
    axes.set_xlim(edges)
    style.ticks(axes.xaxis, low, high)
    _front(axes, part, quantity, measure)
    for kind, curve in part.groupby("solver", sort=False):
        _curve(axes, curve, quantity, measure, kind)
    least, most = part[measure].min() / 1.5, part[measure].max() * 1.5
    places = {value: marked(part, quantity, knob, value) for value in marks}
    least /= (most / least) ** (FOOT / (1 - FOOT)) if any(len(here) for here in places.values()) else 1.0
    axes.set_ylim(least, most)
    style.ticks(axes.yaxis, least, most)
    rings = [
        (x, y, marks[value]) for value, here in places.items() for x, y in zip(here["at"], here[measure], strict=True)
    ]
    _rings(axes, rings)


def _curve(axes: Axes, curve: pd.DataFrame, quantity: str, measure: str, kind: str) -> None:
    """A solver's curve; settings without error beside it, those that failed as crosses."""
    marker, color = LOOKS.get(kind, ("v", "#777777"))
    good = curve.index.isin(error_cost.met(curve, quantity).index)
    shown = good & (curve[quantity] > ROUNDING)
    look = {"marker": marker, "color": color, "markersize": 4, "linewidth": 1.0, "markerfacecolor": "white"}
    axes.plot(curve["at"][shown], curve[measure][shown], label=style.solver(kind), **look)
    axes.plot(curve["at"][good & ~shown], curve[measure][good & ~shown], **look | {"linewidth": 0.0})
    axes.plot(curve["at"][~good], curve[measure][~good], "x", color=color, markersize=7)


def _front(axes: Axes, part: pd.DataFrame, quantity: str, measure: str) -> None:
    """The least cost at which an error is met, by any solver."""
    if len(part.solver.unique()) > 1:
        front = error_cost.front(part, quantity, measure)
        look = {"color": "#bbbbbb", "lw": 4, "alpha": 0.5, "zorder": 0.5, "label": "least cost"}
        axes.step(front["at"], front[measure], where="pre", **look)


def _rings(axes: Axes, rings: list[tuple[float, float, str]]) -> None:
    """Rings (x, y, name), and their names below all curves; those of rings close to each other are lines of one."""
    for x, y, _ in rings:
        axes.plot([x], [y], "o", markersize=9, markerfacecolor="none", color=style.EXACT)
        axes.plot([x, x], [axes.get_ylim()[0], y], color=style.EXACT, lw=0.5, ls=(0, (2, 3)), zorder=0.6)
    line, names = NEAR * float(np.diff(np.log(axes.get_xlim()))[0]), []
    for x, _, name in sorted(rings):
        own = name.replace(", ", ",\n", 1).split("\n") if len(name) > 16 else [name]
        close = bool(names) and np.log(x / names[-1][0]) < line * len(names[-1][1])
        names.append((x, [*names.pop()[1], *own] if close else own))
    look = {"rotation": 90, "fontsize": 6.5, "va": "bottom", "textcoords": "offset points"}
    for x, lines in names:
        axes.annotate("\n".join(lines), (x, 0), (1.5, 4), axes.get_xaxis_transform(), **look)
