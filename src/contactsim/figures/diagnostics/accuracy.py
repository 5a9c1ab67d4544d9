"""What accuracy costs, drawn: error across, cost up, one column a knob that was turned."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim import dataset, notation
from contactsim.analysis.ensemble import converged
from contactsim.error_control.forecast import transform_seconds
from contactsim.evaluation.work_precision import error_cost
from contactsim.evaluation.work_precision.cases import REFERENCE
from contactsim.evaluation.work_precision.error_cost import ROUNDING
from contactsim.figures import style
from contactsim.figures.diagnostics import knobs
from contactsim.figures.layout import framed, save
from contactsim.files import write_atomically
from contactsim.variables import VARIABLES

KNOBS = {"points": "grid points", "tangential_cutoff": "tangential cutoff"} | {
    name: name for name in ("tolerance", "increment", "members")
}
LETTERS = 66
"""About how many the last column has room for in a line."""
COSTS = {"work": "transforms × points", "seconds": "seconds, one thread"}


def render(plan: Mapping, files: Mapping[str, str], targets: Mapping[str, str]) -> None:
    """Draw one case into its files.

    plan: of `contactsim.evaluation.work_precision.case_config.figure_settings`; files: the jobs' datasets and costs in
    the plan's order, the study's
    dataset and costs; targets: png, pdf, csv and, for the comparison at equal error, equal_error.
    """
    settings, jobs = plan["settings"], plan["jobs"]
    data = {job: dataset.load_dataset(path) for job, path in zip(jobs, files["data"], strict=True)}
    times = {job: json.loads(Path(path).read_text()) for job, path in zip(jobs, files["costs"], strict=True)}
    study = dataset.load_dataset(files["study"]).sel(plan["selection"])
    table = error_cost.table(settings, data, study, plan["default"])
    alone = pd.read_csv(files["study_costs"]).query("not measures_error")
    chosen = alone
    for name, values in (plan["selection"] | plan["loads"]).items():
        chosen = chosen[among(chosen[name], values)]
    table["seconds"] = seconds(table, times, chosen.seconds.sum() / max(alone.member.nunique(), 1))
    table = foreseen(table, plan["expected"])
    quantity, columns = settings["quantities"][0], len(turned(table)) + 1
    layout = {"rows": 2, "widths": [1.0] * (columns - 1) + [1.4]}
    figure, panels = framed(settings | {"panels": columns}, footer_text(table, plan), **layout)
    equal = error_cost.compared(table, quantity, settings["levels"], COSTS)
    draw(table, equal, data[plan["default"]], np.reshape(panels, (2, columns)), plan)
    save(figure, table, targets)
    write_atomically(targets["equal_error"], lambda path: equal.to_csv(path, index=False))


def foreseen(table: pd.DataFrame, expected: list) -> pd.DataFrame:
    """The table with the work and seconds that each setting of the study's own solver was forecast to take.

    expected: work and units of time, setting by setting; NaN of all else.
    """
    found = np.full((len(table), 2), np.nan)
    own = (table.own & (table.knob != "members")).to_numpy()
    found[own] = np.reshape([float(value) for one in expected for value in one], (-1, 2))
    return table.assign(predicted_work=found[:, 0], predicted_seconds=found[:, 1] * transform_seconds())


def among(column: pd.Series, values: list) -> np.ndarray:
    """Which entries of a column are among the values; numbers to as many digits as text keeps."""
    if pd.api.types.is_numeric_dtype(column):
        return np.isclose(column.to_numpy()[:, None], values, rtol=1e-6, atol=0).any(axis=1)
    return column.isin(values).to_numpy()


def seconds(table: pd.DataFrame, times: Mapping[str, list[float]], member: float) -> pd.Series:
    """Seconds of every row: those of each solver's settings in their order, of an ensemble those of its members."""
    found = table.members * member
    for kind in set(times) - {REFERENCE}:
        found[table.members.isna() & (table.solver == kind)] = times[kind]
    return found


def turned(table: pd.DataFrame) -> list[str]:
    """The knobs that were turned."""
    return [knob for knob in KNOBS if (table.knob == knob).any()]


def footer_text(table: pd.DataFrame, plan: Mapping) -> str:
    """Tier and timings, where each knob was turned, its reference, and what is not on the curves."""
    settings, quantity = plan["settings"], plan["settings"]["quantities"][0]
    repeats = settings["repeats"]
    parts = [
        f"{plan['tier']} tier",
        f"{len(table)} settings, " + (f"best of up to {repeats} timings" if repeats > 1 else "each timed once"),
        *(_turned_text(knob, plan) for knob in turned(table) if knob in settings["settled"]),
    ]
    ensembles = table[table.knob == "members"]
    parts += [f"members turned at {points} points of the study" for points in ensembles.points.unique()]
    ends = {"without error beyond rounding, at 0": table[quantity] <= ROUNDING}
    ends |= {"where a solution has no value, at ∞": np.isinf(table[quantity])}
    parts += [f"{text}: {found.sum()}" for text, found in ends.items() if found.any()]
    beyond = [
        f"{names}, with {KNOBS[knob]} {value:.7g}{_unit(plan, knob)}"
        for knob in turned(table)
        for value, names in knobs.named(plan["marks"], knob).items()
        if knobs.marked(table, quantity, knob, value).empty
    ]
    parts += [f"not on the curve of {own_solver(table)}, so without a ring: {'; '.join(beyond)}"] * bool(beyond)
    adaptive = [name for name, own in plan["marks"].items() if name != "thesis" and "increment" not in own]
    adapts = "increment" in turned(table) and bool(adaptive)
    parts += [f"increments of their own, so without a ring: {', '.join(adaptive)}"] * adapts
    return " · ".join(parts)


def _turned_text(knob: str, plan: Mapping) -> str:
    """Where the other knobs stood while one was turned, and its reference."""
    settled, reference = (plan["settings"][part] for part in ("settled", "reference"))

    def words(name: str, values: Mapping[str, float]) -> str:
        """A knob and its value."""
        value = values[name]
        if name == "points":
            return f"{value} × {value} points" if plan["surface"] else f"{value} points"
        return f"{name} {value:g}{_unit(plan, name)}"

    others = " and ".join(words(name, settled) for name in KNOBS if name in settled and name != knob)
    tight = f" at {words('tolerance', reference)}" if knob == "points" else ""
    return f"{knob} turned at {others}, reference {words(knob, reference)}{tight}"


def _unit(plan: Mapping, knob: str) -> str:
    return f" {plan['units'][knob]}" if knob in plan["units"] else ""


def own_solver(table: pd.DataFrame) -> str:
    """Name of the study's own solver."""
    return style.solver(table.solver[table.own].iloc[0])


def draw(table: pd.DataFrame, equal: pd.DataFrame, values: xr.Dataset, axes: np.ndarray, plan: Mapping) -> None:
    """All panels of one case.

    table: `precision.table` with a column of seconds; equal: `precision.compared`; values: the dataset of the study's
    own solver; axes (2, knobs turned + 1); plan: as of `render`, the error of its first quantity is drawn.
    """
    quantity = plan["settings"]["quantities"][0]
    titles = KNOBS | {knob: f"{KNOBS[knob]} ({unit})" for knob, unit in plan["units"].items()}
    titles |= {"points": f"{KNOBS['points']} a side"} if plan["surface"] else {}
    for row, (measure, label) in enumerate(COSTS.items()):
        for panel, knob in zip(axes[row], turned(table), strict=False):
            knobs.panel(panel, table[table.knob == knob], quantity, measure, knobs.named(plan["marks"], knob))
            _forecast(panel, table[(table.knob == knob) & table.own], quantity, measure)
            panel.set_title(titles[knob] if row == 0 else "", fontsize=9)
            panel.set_xlabel(f"relative error of {notation.SYMBOLS[quantity]}" if row else "")
        axes[row, 0].set_ylabel(label)
    _grid_dependence(axes[0, -1], values, quantity, titles["points"])
    _words(axes[1, -1], table, equal)
    keys = {line.get_label(): line for panel in axes[0, :-1] for line in panel.lines}
    keys = {label: line for label, line in keys.items() if not label.startswith("_")}
    ring = Line2D([], [], ls="", marker="o", ms=9, mfc="none", color=style.EXACT, label="used by a tier or the thesis")
    axes[0, 0].figure.legend(handles=[*keys.values(), ring], loc="outside upper right", ncols=len(keys) + 1)


def _forecast(axes: Axes, own: pd.DataFrame, quantity: str, measure: str) -> None:
    """What the study's own solver was forecast to take, where its errors are found."""
    shown = own[(own[quantity] > ROUNDING) & np.isfinite(own[quantity]) & own[f"predicted_{measure}"].notna()]
    if len(shown):
        look = {"ls": ":", "marker": "+", "lw": 1.0, "ms": 5, "color": style.EXACT, "label": "forecast"}
        axes.plot(shown[quantity], shown[f"predicted_{measure}"], **look)


def _grid_dependence(axes: Axes, values: xr.Dataset, quantity: str, across: str) -> None:
    """κ_r by Eq. 3.8 and by pairs, or else the quantity drawn, against the number of points: mean over all solutions.

    Hurst exponents are kept apart.
    """
    part = values.isel(setting=np.flatnonzero(values.knob == "points"))
    definitions = {"kappa_r": ("Eq. 3.8", style.CONTACT), "kappa_r_pairs": ("pairs in contact", style.PAIRS)}
    definitions = {name: look for name, look in definitions.items() if name in part}
    for name, (_, color) in (definitions or {quantity: ("", style.CONTACT)}).items():
        known = converged(part[name], part)
        mean = known.mean([dim for dim in known.dims if dim not in ("setting", "hurst")], skipna=False)
        for value in part.hurst.values if "hurst" in part.dims else (None,):
            look = style.hurst(0.2 if value is None else value)
            axes.plot(part.points, mean if value is None else mean.sel(hurst=value), color=color, **look)
    first = next(iter(definitions), quantity)
    unit = VARIABLES[first][0]
    axes.set(xlabel=across, ylabel=notation.SYMBOLS[first] + (f" ({unit})" if unit != "1" else ""))
    axes.set_xscale("log", base=2)
    axes.yaxis.get_major_formatter().set_useOffset(False)
    keys = style.hurst_key(part.hurst.values) if "hurst" in part.dims else []
    axes.legend(handles=keys + style.key(dict(definitions.values()), {}))


def _words(axes: Axes, table: pd.DataFrame, equal: pd.DataFrame) -> None:
    """Observed orders, and a table of cost at equal error over that of the study's own solver."""
    axes.axis("off")
    grids = table[(table.knob == "points") & table.own]
    orders = [
        f"{symbol} {error_cost.order(grids, name):.2f}" for name, symbol in notation.SYMBOLS.items() if name in table
    ]
    orders = _filled("Observed order in grid points: ", orders)
    text = f"{orders}\n\nCost at equal error over that of {own_solver(table)},"
    axes.text(0, 1, f"{text}\nin transforms × points (in seconds)", fontsize=7, va="top", linespacing=1.3)
    own = set(table.solver[table.own])
    known = [*style.SOLVERS, *sorted(set(equal.solver) - set(style.SOLVERS))]
    others = [kind for kind in known if kind in set(equal.solver) - own]
    lines = list(_lines(equal[~equal.solver.isin(own)], others))
    if lines:
        header = ["", "error", *(style.solver(kind).replace("–", "–\n").replace(" ", "\n") for kind in others)]
        widths = [0.24, 0.13, *[0.63 / len(others)] * len(others)]
        shown = axes.table(lines, colLabels=header, bbox=(0, 0, 1, 0.74), colWidths=widths, edges="horizontal")
        shown.auto_set_font_size(False)
        shown.set_fontsize(7)
        for (row, column), cell in shown.get_celld().items():
            cell.set(height=1.7 if row == 0 else 1.0, linewidth=0.5, edgecolor="#999999")
            cell.get_text().set_horizontalalignment("left" if column == 0 else "center")
            cell.PAD = 0.0 if column == 0 else cell.PAD


def _filled(text: str, entries: Iterable[str]) -> str:
    """A text and entries after it, commas between them, in lines that the last column has room for."""
    lines = [text]
    for entry in entries:
        if len(re.sub(r"\$.*?\$", "κr", lines[-1] + entry)) > LETTERS:
            lines.append("")
        lines[-1] += f"{entry}, "
    return "\n".join(line.rstrip() for line in lines).rstrip(",")


def _lines(equal: pd.DataFrame, others: Iterable[str]) -> Iterable[list[str]]:
    """The table's lines: knob where it changes, error, and each solver's cost."""
    kept, before = equal.set_index(["knob", "error", "solver"]), None
    for knob, error in dict.fromkeys(kept.index.droplevel("solver")):
        costs = [times(kept.loc[(knob, error, kind)]) if (knob, error, kind) in kept.index else "–" for kind in others]
        yield ["" if knob == before else KNOBS[knob], f"{error:g}", *costs]
        before = knob


def times(ratios: pd.Series) -> str:
    """Times the cost of the study's own solver, in transforms and in seconds; a dash where it was not measured."""
    if ratios.isna().any():
        return "–"
    both = [f"{float(f'{one:.1e}'):.0f}" if one >= 9.95 else f"{one:#.2g}" for one in (ratios.work, ratios.seconds)]
    return f"{both[0]} ({both[1]})"
