"""What accuracy costs, drawn: error across, cost up, one column a knob that was turned."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim import cost, dataset, precision
from contactsim.ensemble import converged
from contactsim.figures import style
from contactsim.figures.render import framed, move, save
from contactsim.precision import ROUNDING

LOOKS = {
    "active_set": ("o", style.WHOLE),
    "conjugate_gradients": ("o", style.WHOLE),
    "polonsky_keer": ("s", style.CONTACT),
    "tamaas": ("D", style.PAIRS),
    "verlet": ("^", "#8c6d31"),
}
KNOBS = {"points": "grid points", "tolerance": "tolerance", "members": "members"}
COSTS = {"work": "transforms × points", "seconds": "seconds, one thread"}
MARGIN, FOOT = 0.1, 0.33
"""Parts of a panel: the margin of errors that have no logarithm, and the foot with the names of the marks."""


def render(plan: Mapping, files: Mapping[str, str], targets: Mapping[str, str]) -> None:
    """Draw one case into its files.

    plan: of `contactsim.cost.figure_settings`; files: the jobs' datasets and costs in the plan's order, the study's
    dataset and costs; targets: png, pdf, csv and, for the comparison at equal error, equal_error.
    """
    settings, jobs = plan["settings"], plan["jobs"]
    data = {job: dataset.read(path) for job, path in zip(jobs, files["data"], strict=True)}
    times = {job: json.loads(Path(path).read_text()) for job, path in zip(jobs, files["costs"], strict=True)}
    study = dataset.read(files["study"]).sel(plan["selection"])
    table = precision.table(settings, data, study, plan["default"])
    alone = pd.read_csv(files["study_costs"]).query("not companion")
    chosen = alone
    for name, values in (plan["selection"] | {plan["load"]: settings["load"]}).items():
        chosen = chosen[among(chosen[name], values)]
    table["seconds"] = seconds(table, times, chosen.seconds.sum() / max(alone.member.nunique(), 1))
    quantity, columns = settings["quantities"][0], len(turned(table)) + 1
    layout = {"rows": 2, "widths": [1.0] * (columns - 1) + [1.4]}
    figure, panels = framed(settings | {"panels": columns}, footer_text(table, plan), **layout)
    equal = precision.compared(table, quantity, settings["levels"], COSTS)
    draw(table, equal, data[plan["default"]], np.reshape(panels, (2, columns)), quantity, plan["marks"])
    save(figure, table, targets)
    move(targets["equal_error"], lambda path: equal.to_csv(path, index=False))


def among(column: pd.Series, values: list) -> np.ndarray:
    """Which entries of a column are among the values; numbers to as many digits as text keeps."""
    if pd.api.types.is_numeric_dtype(column):
        return np.isclose(column.to_numpy()[:, None], values, rtol=1e-6, atol=0).any(axis=1)
    return column.isin(values).to_numpy()


def seconds(table: pd.DataFrame, times: Mapping[str, list[float]], member: float) -> pd.Series:
    """Seconds of every row: those of each solver's settings in their order, of an ensemble those of its members."""
    found = table.members * member
    for kind in set(times) - {cost.REFERENCE}:
        found[table.members.isna() & (table.solver == kind)] = times[kind]
    return found


def turned(table: pd.DataFrame) -> list[str]:
    """The knobs that were turned."""
    return [knob for knob in KNOBS if (table.knob == knob).any()]


def footer_text(table: pd.DataFrame, plan: Mapping) -> str:
    """Tier and timings, where each knob was turned, its reference, and what is not on the curves."""
    settings, quantity = plan["settings"], plan["settings"]["quantities"][0]
    points, tolerance = (settings["settled"][key] for key in cost.SETTING_KEYS)
    finest, tightest = (settings["reference"][key] for key in cost.SETTING_KEYS)
    repeats = settings["repeats"]
    grid, coarse = (f"{size} × {size} points" if plan["surface"] else f"{size} points" for size in (finest, points))
    parts = [
        f"{plan['tier']} tier",
        f"{len(table)} settings, " + (f"best of up to {repeats} timings" if repeats > 1 else "each timed once"),
        f"points turned at tolerance {tolerance:g}, reference {grid} at tolerance {tightest:g}",
        f"tolerance turned at {coarse}, reference tolerance {tightest:g}",
    ]
    ensembles = table[table.knob == "members"]
    parts += [f"members turned at {points} points of the study" for points in ensembles.points.unique()]
    ends = {"without error beyond rounding, at 0": table[quantity] <= ROUNDING}
    ends |= {"where a solution has no value, at ∞": np.isinf(table[quantity])}
    parts += [f"{text}: {found.sum()}" for text, found in ends.items() if found.any()]
    beyond = [
        f"{names}, with {KNOBS[knob]} {value:.7g}"
        for knob in turned(table)
        for value, names in named(plan["marks"], knob).items()
        if marked(table, quantity, knob, value).empty
    ]
    parts += [f"not on the curve of {own_solver(table)}, so without a ring: {'; '.join(beyond)}"] * bool(beyond)
    return " · ".join(parts)


def own_solver(table: pd.DataFrame) -> str:
    """Name of the study's own solver."""
    return style.SOLVERS[table.solver[table.own].iloc[0]]


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
    good = precision.met(table, quantity)
    return good[(good.knob == knob) & good.own & np.isclose(good[knob], value, rtol=1e-9)]


def draw(
    table: pd.DataFrame,
    equal: pd.DataFrame,
    values: xr.Dataset,
    axes: np.ndarray,
    quantity: str,
    marks: Mapping[str, Mapping[str, float]],
) -> None:
    """All panels of one case.

    table: `precision.table` with a column of seconds; equal: `precision.compared`; values: the dataset of the study's
    own solver; axes (2, knobs turned + 1); quantity: whose error is drawn; marks: by name, its value of each knob.
    """
    titles = KNOBS | ({"points": "grid points a side"} if "points_y" in values else {})
    for row, (measure, label) in enumerate(COSTS.items()):
        for panel, knob in zip(axes[row], turned(table), strict=False):
            _panel(panel, table[table.knob == knob], quantity, measure, named(marks, knob))
            panel.set_title(titles[knob] if row == 0 else "", fontsize=9)
            panel.set_xlabel(f"relative error of {style.SYMBOLS[quantity]}" if row else "")
        axes[row, 0].set_ylabel(label)
    _grid_dependence(axes[0, -1], values)
    _words(axes[1, -1], table, equal)
    keys = {line.get_label(): line for panel in axes[0, :-1] for line in panel.lines}
    keys = {label: line for label, line in keys.items() if not label.startswith("_")}
    ring = Line2D([], [], ls="", marker="o", ms=9, mfc="none", color=style.EXACT, label="used by a tier or the thesis")
    axes[0, 0].figure.legend(handles=[*keys.values(), ring], loc="outside upper right", ncols=len(keys) + 1)


def _panel(axes: Axes, part: pd.DataFrame, quantity: str, measure: str, marks: Mapping[float, str]) -> None:
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
    for value, here in places.items():
        for x, y in zip(here["at"], here[measure], strict=True):
            _mark(axes, x, y, marks[value])


def _curve(axes: Axes, curve: pd.DataFrame, quantity: str, measure: str, kind: str) -> None:
    """A solver's curve; settings without error beside it, those that failed as crosses."""
    marker, color = LOOKS.get(kind, ("v", "#777777"))
    good = curve.index.isin(precision.met(curve, quantity).index)
    shown = good & (curve[quantity] > ROUNDING)
    look = {"marker": marker, "color": color, "markersize": 4, "linewidth": 1.0, "markerfacecolor": "white"}
    axes.plot(curve["at"][shown], curve[measure][shown], label=style.SOLVERS.get(kind, kind), **look)
    axes.plot(curve["at"][good & ~shown], curve[measure][good & ~shown], **look | {"linewidth": 0.0})
    axes.plot(curve["at"][~good], curve[measure][~good], "x", color=color, markersize=7)


def _front(axes: Axes, part: pd.DataFrame, quantity: str, measure: str) -> None:
    """The least cost at which an error is met, by any solver."""
    if len(part.solver.unique()) > 1:
        front = precision.front(part, quantity, measure)
        look = {"color": "#bbbbbb", "lw": 4, "alpha": 0.5, "zorder": 0.5, "label": "least cost"}
        axes.step(front["at"], front[measure], where="pre", **look)


def _mark(axes: Axes, x: float, y: float, name: str) -> None:
    """A ring, and its name below all curves."""
    axes.plot([x], [y], "o", markersize=9, markerfacecolor="none", color=style.EXACT)
    axes.plot([x, x], [axes.get_ylim()[0], y], color=style.EXACT, lw=0.5, ls=(0, (2, 3)), zorder=0.6)
    text = name.replace(", ", ",\n", 1) if len(name) > 16 else name
    look = {"rotation": 90, "fontsize": 6.5, "va": "bottom", "textcoords": "offset points"}
    axes.annotate(text, (x, 0), (1.5, 4), axes.get_xaxis_transform(), **look)


def _grid_dependence(axes: Axes, values: xr.Dataset) -> None:
    """κ_r by Eq. 3.8 and by pairs against the number of points, mean over members and loads."""
    part = values.isel(setting=np.flatnonzero(values.knob == "points"))
    shown = {"kappa_r": style.CONTACT, "kappa_r_bond": style.PAIRS}
    for name, color in ((name, color) for name, color in shown.items() if name in part):
        known = converged(part[name], part)
        mean = known.mean([dim for dim in known.dims if dim not in ("setting", "hurst")], skipna=False)
        for value in part.hurst.values if "hurst" in part.dims else (None,):
            look = style.hurst(0.2 if value is None else value)
            axes.plot(part.points, mean if value is None else mean.sel(hurst=value), color=color, **look)
    axes.set(xlabel="grid points a side" if "points_y" in values else "grid points", ylabel=style.SYMBOLS["kappa_r"])
    axes.set_xscale("log", base=2)
    colours = {"Eq. 3.8": style.CONTACT, "pairs in contact": style.PAIRS}
    keys = style.hurst_key(part.hurst.values) if "hurst" in part.dims else []
    axes.legend(handles=keys + style.key(colours, {}))


def _words(axes: Axes, table: pd.DataFrame, equal: pd.DataFrame) -> None:
    """Observed orders, and a table of cost at equal error over that of the study's own solver."""
    axes.axis("off")
    grids = table[(table.knob == "points") & table.own]
    orders = [f"{style.SYMBOLS[name]} {precision.order(grids, name):.2f}" for name in style.SYMBOLS if name in table]
    text = (
        f"Observed order in grid points: {', '.join(orders)}\n\nCost at equal error over that of {own_solver(table)},"
    )
    axes.text(0, 1, f"{text}\nin transforms × points (in seconds)", fontsize=7, va="top", linespacing=1.3)
    own = set(table.solver[table.own])
    others = [kind for kind in style.SOLVERS if kind in set(equal.solver) - own]
    lines = list(_lines(equal[~equal.solver.isin(own)], others))
    if lines:
        header = ["", "error", *(style.SOLVERS[kind].replace("–", "–\n") for kind in others)]
        widths = [0.24, 0.13, *[0.63 / len(others)] * len(others)]
        shown = axes.table(lines, colLabels=header, bbox=(0, 0, 1, 0.74), colWidths=widths, edges="horizontal")
        shown.auto_set_font_size(False)
        shown.set_fontsize(7)
        for (row, column), cell in shown.get_celld().items():
            cell.set(height=1.7 if row == 0 else 1.0, linewidth=0.5, edgecolor="#999999")
            cell.get_text().set_horizontalalignment("left" if column == 0 else "center")
            cell.PAD = 0.0 if column == 0 else cell.PAD


def _lines(equal: pd.DataFrame, others: Iterable[str]) -> Iterable[list[str]]:
    """The table's lines: knob where it changes, error, and each solver's cost."""
    kept, before = equal.set_index(["knob", "error", "solver"]), None
    for knob, error in dict.fromkeys(kept.index.droplevel("solver")):
        costs = [times(kept.loc[(knob, error, kind)]) if (knob, error, kind) in kept.index else "–" for kind in others]
        yield ["" if knob == before else KNOBS[knob], f"{error:g}", *costs]
        before = knob


def times(ratios: pd.Series) -> str:
    """Times the cost of the study's own solver, in transforms and in seconds; a dash where it was not measured."""
    return "–" if ratios.isna().any() else f"{_two_digits(ratios.work)} ({_two_digits(ratios.seconds)})"


def _two_digits(value: float) -> str:
    return f"{float(f'{value:.1e}'):.0f}" if value >= 9.95 else f"{value:#.2g}"
