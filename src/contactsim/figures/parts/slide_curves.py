"""Labels and panels of slides: force and contact against the sliding distance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke

from contactsim.analysis.scales import LawScales
from contactsim.analysis.slide_tables import FIRST_APPROACH, slide_table, stages
from contactsim.figures import style
from contactsim.grid import Array

SLIDE = r"$\bar U_x=U_x/w$"
SLIDE_NM = r"$U_x$ (nm)"
FORCE = r"$\bar F=F/(wE)$"
BOTH_FORCES = r"$\bar F$, $\bar L$"
AREA = r"contact $\bar A=A/w$"
POSITION = "$x/w$ of the undeformed probe"
STAGES = "ABCDE"
STAGE_SPACING = 6
"""Distance of cases along the axis of stages, in stages."""


def approach_label(approach: float) -> str:
    """Return the label of an approach (nm), over δ0."""
    return rf"$\bar\delta={approach / FIRST_APPROACH:g}$"


def work_ratio_label(data: xr.Dataset) -> str:
    """Return the label of the ratio of works of a study."""
    return rf"$\varphi_t/\varphi_n={LawScales.of(data).work_ratio:g}$"


def plot_forces(axes: Axes, x: pd.Series, table: pd.DataFrame, width: float) -> None:
    """Plot tangential and normal force of a slide."""
    axes.plot(x, table.force, color=style.CONTACT, lw=width, label=r"$\bar F$")
    axes.plot(x, table.load, color=style.CONTACT, lw=width, ls="--", label=r"$\bar L$")
    axes.axhline(0.0, **style.ZERO)
    axes.set_ylabel(BOTH_FORCES)


def plot_gap(axes: Axes, x: Any, gap: Any, width: float, alpha: float | None = None) -> None:
    """Plot a gap, filled where it is closed."""
    axes.plot(x, gap, color=style.EXACT, lw=width, label="_gap")
    fill = {"color": style.CONTACT} | ({} if alpha is None else {"alpha": alpha, "lw": 0})
    axes.fill_between(x, gap, 0.0, where=gap < 0, **fill)


def plot_stages(
    path_axes: Axes, stage_axes: Axes, data: xr.Dataset, label: str, colour: str, case: int
) -> pd.DataFrame:
    """Plot the contact of one slide with its stages on one panel, where the contact is at each stage on another.

    case: number of the slide, from 0; returns one row a stage
    """
    table = slide_table(data)
    places = stages(data, table)
    path_axes.plot(table.relative_slide, table.area, color=colour, lw=1.1, label=label)
    points = table.iloc[places]
    names = dict(zip(STAGES, places, strict=True))
    mark_stages(path_axes, table.relative_slide, table.area, names, colour, f"_{label}, A to E")
    for number, (stage, point) in enumerate(zip(STAGES, points.itertuples(), strict=True)):
        x = number + STAGE_SPACING * case
        if not point.area > 0:
            stage_axes.text(x, 0.0, "no contact", rotation=90, color=colour, fontsize=7, ha="center", va="center")
        look = {"color": colour, "lw": 5, "solid_capstyle": "butt", "label": f"{label}, {stage}"}
        stage_axes.plot([x, x], [point.trailing, point.leading], **look)
    ends = [STAGE_SPACING * case - 0.5, STAGE_SPACING * case + 4.5]
    for words in ("trailing", "leading"):
        look = {"color": colour, "lw": 0.6, "ls": ":", "label": f"{label}, {words} edge before sliding"}
        stage_axes.plot(ends, [table[words].iloc[0]] * 2, **look)
    columns = ["slide", "area", "force", "trailing", "leading"]
    return points[columns].reset_index(drop=True).assign(stage=list(STAGES))


def passed_stages(data: xr.Dataset, table: pd.DataFrame) -> dict[str, int]:
    """Return the states A to E of a slide by their letters; none of a slide that has not reached its first slip.

    data, table: of `contactsim.analysis.slide_tables.slide_table`
    """
    slips = data.event_sliding_distance.dropna("event")
    if not slips.size or float(slips[0]) > table.slide.iloc[-1]:
        return {}
    return dict(zip(STAGES, stages(data, table), strict=True))


def mark_stages(
    axes: Axes, x: pd.Series, y: pd.Series, places: Mapping[str, int], colour: str, label: str = "_A to E"
) -> None:
    """Mark states of a curve with their letters; places: states by their letters."""
    states = list(places.values())
    look = style.marker_look(colour, size=3.5) | {"ls": "none", "label": label}
    axes.plot(x.iloc[states], y.iloc[states], **look)
    offsets = _letter_offsets(y.iloc[list(places.values())].tolist()) if places else []
    for (name, state), offset in zip(places.items(), offsets, strict=True):
        text = {"color": colour, "fontsize": 7, "path_effects": [withStroke(linewidth=2, foreground="white")]}
        axes.annotate(name, (x.iloc[state], y.iloc[state]), offset, textcoords="offset points", **text)


def _letter_offsets(values: list[float]) -> list[tuple[int, int]]:
    """Return where the letters of the stages A to E stand off a curve, points; values: of the curve there."""
    beside = (-8, 3) if values[2] > values[0] else (2, 3)
    around_slip = [(2, 3), (2, -9)] if values[3] > values[4] else [(2, -9), (2, 3)]
    return [beside, beside, (-9, -3), *around_slip]


def add_arrows(axes: Axes, x: Array, y: Array, colour: str) -> None:
    """Add arrows along a path to and fro, one in each direction where it is half way through its range."""
    middle = (x.min() + x.max()) / 2
    rises = np.diff(x) > 0
    for forwards in (True, False):
        passes = np.flatnonzero((rises == forwards) & ((x[:-1] - middle) * (x[1:] - middle) <= 0))
        if passes.size:
            start = int(passes[-1])
            tip, tail = ((x[place], y[place]) for place in (start + 1, start))
            axes.annotate("", tip, tail, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 0.9})


def label_stages(axes: Axes, cases: Sequence[str]) -> None:
    """Label the panel of the stages of some slides, and each slide with its name."""
    count = len(cases)
    ticks = [number + STAGE_SPACING * case for case in range(count) for number in range(len(STAGES))]
    axes.set_xticks(ticks, list(STAGES) * count)
    style.add_headroom(axes, 0.08)
    for number, case in enumerate(cases):
        place = (2 + STAGE_SPACING * number, 0.95)
        axes.text(*place, case, transform=axes.get_xaxis_transform(), fontsize=8, ha="center")
    axes.tick_params(axis="x", top=False)
    axes.set(ylabel="contact, $x/w$ of the undeformed probe")
    axes.text(0.02, 0.02, "trailing", transform=axes.transAxes, fontsize=7)
    axes.text(0.02, 0.89, "leading", transform=axes.transAxes, fontsize=7)
