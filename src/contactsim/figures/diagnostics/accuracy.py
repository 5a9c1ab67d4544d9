"""Accuracy versus cost of one case: error across, cost up, one column for each knob that was varied."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim import dataset
from contactsim.analysis.ensemble import converged
from contactsim.evaluation.work_precision import error_cost
from contactsim.evaluation.work_precision.error_cost import ROUNDING
from contactsim.figures import style
from contactsim.figures.diagnostics import knobs
from contactsim.figures.diagnostics.accuracy_footer import KNOB_NAMES, drawn_knobs, footer_text, own_solver
from contactsim.figures.diagnostics.accuracy_results import read_results
from contactsim.figures.layout import empty_figure, save
from contactsim.files import write_atomically
from contactsim.variables import RESULTS

COSTS = {"work": "transforms × points", "seconds": "seconds, one thread"}
"""Columns of the costs, with their labels."""
LAST_COLUMN = 1.4
"""Width of the last column, over that of the others."""
LINE_LETTERS = 66
"""Letters in a line of the last column."""
DEFINITIONS = {"kappa_r": ("Eq. 3.8", style.CONTACT), "kappa_r_pairs": ("pairs in contact", style.PAIRS)}
"""Definitions of κ_r, with label and colour."""
UNMEASURED = "–"
"""Cell of a table where nothing was measured."""


@mpl.rc_context(style.RC_PARAMS)
def write_accuracy(plan: Mapping[str, Any], files: Mapping[str, Any], targets: Mapping[str, str]) -> None:
    """Plot one case and write its files.

    Parameters
    ----------
    plan : of `contactsim.evaluation.work_precision.case_config.case_figure_job`
    files : data and costs of the measured jobs, in the order of the plan; baselines, the package's tables; study and
        study_costs, of the study
    targets : png, pdf, svg, csv, and equal_error for the comparison at equal error
    """
    settings, results = plan["settings"], read_results(plan, files)
    study = dataset.load_dataset(files["study"]).sel(plan["selection"])
    table = error_cost.error_table(settings["quantities"], settings["load"], results.data, study, plan["default"])
    member = seconds_of_member(pd.read_csv(files["study_costs"]), plan["selection"] | plan["loads"])
    table = table.assign(seconds=seconds_of_rows(table, results.seconds, member))
    table = with_forecast(table, plan["expected"], results.transform_seconds)
    quantity = settings["quantities"][0]
    columns = len(drawn_knobs(table, quantity)) + 1
    layout = settings | {"panels": columns}
    widths = [1.0] * (columns - 1) + [LAST_COLUMN]
    figure, panels = empty_figure(layout, footer_text(table, plan), rows=2, widths=widths)
    equal = error_cost.compare_solvers(table, quantity, settings["levels"], COSTS)
    plot_accuracy(table, equal, results.data[plan["default"]], np.reshape(panels, (2, columns)), plan)
    save(figure, table, targets)
    write_atomically(targets["equal_error"], lambda path: equal.to_csv(path, index=False))


def with_forecast(table: pd.DataFrame, forecasts: Sequence[Sequence[str]], transform_seconds: float) -> pd.DataFrame:
    """Return the table with the forecast work and seconds of each setting of the study's own solver; else NaN.

    Parameters
    ----------
    table : of `contactsim.evaluation.work_precision.error_cost.error_table`
    forecasts : work and units of time of each setting of the study's own solver, in their order
    transform_seconds : unit of time on the machine that measured the seconds
    """
    columns = np.full((len(table), 2), np.nan)
    own = (table.own & (table.knob != "members")).to_numpy()
    columns[own] = np.reshape([float(value) for forecast in forecasts for value in forecast], (-1, 2))
    return table.assign(predicted_work=columns[:, 0], predicted_seconds=columns[:, 1] * transform_seconds)


def seconds_of_member(costs: pd.DataFrame, places: Mapping[str, list[Any]]) -> float:
    """Return the seconds that one member of a study takes, at some values of its dimensions.

    costs: of the study; runs that only measure an error do not count
    """
    alone = costs.query("not measures_error")
    part = alone
    for name, values in places.items():
        part = part[is_among(part[name], values)]
    return float(part.seconds.sum() / max(alone.member.nunique(), 1))


def is_among(column: pd.Series, values: list[Any]) -> np.ndarray:
    """Return which entries of a column are among the values; numbers to as many digits as text keeps."""
    if pd.api.types.is_numeric_dtype(column):
        return np.asarray(np.isclose(column.to_numpy()[:, None], values, rtol=1e-6, atol=0).any(axis=1))
    return column.isin(values).to_numpy()


def seconds_of_rows(table: pd.DataFrame, seconds: Mapping[str, Sequence[float]], member: float) -> pd.Series:
    """Return the seconds of every row: of each solver's settings in their order, of an ensemble those of its members.

    seconds: by solver; member: seconds of one member of the study
    """
    column = table.members * member
    for kind, values in seconds.items():
        column[table.members.isna() & (table.solver == kind)] = values
    return column


def plot_accuracy(
    table: pd.DataFrame, equal: pd.DataFrame, values: xr.Dataset, axes: np.ndarray, plan: Mapping[str, Any]
) -> None:
    """Plot all panels of one case.

    Parameters
    ----------
    table : one row a setting, with work, seconds and their forecasts
    equal : of `contactsim.evaluation.work_precision.error_cost.compare_solvers`
    values : dataset of the study's own solver
    axes : (2, drawn knobs + 1)
    plan : as of `write_accuracy`; the error of its first quantity is plotted
    """
    quantity = plan["settings"]["quantities"][0]
    titles = KNOB_NAMES | {knob: f"{KNOB_NAMES[knob]} ({unit})" for knob, unit in plan["units"].items()}
    titles |= {"points": f"{KNOB_NAMES['points']} a side"} if plan["surface"] else {}
    for row, (cost, label) in enumerate(COSTS.items()):
        for panel, knob in zip(axes[row], drawn_knobs(table, quantity), strict=False):
            part = table[table.knob == knob]
            knobs.plot_knob(panel, part, quantity, cost, knobs.names_by_value(plan["marks"], knob))
            _plot_forecast(panel, part[part.own], quantity, cost)
            panel.set_title(titles[knob] if row == 0 else "", fontsize=9)
            panel.set_xlabel(f"relative error of {RESULTS[quantity].symbol}" if row else "")
        axes[row, 0].set_ylabel(label)
    _plot_against_grid(axes[0, -1], values, quantity, titles["points"])
    _write_comparison(axes[1, -1], table, equal)
    _add_legend(axes)


def _add_legend(axes: np.ndarray) -> None:
    """Add the legend of all panels above them."""
    lines = {line.get_label(): line for panel in axes[0, :-1] for line in panel.lines}
    handles = [line for label, line in lines.items() if not label.startswith("_")]
    ring = {"marker": "o", "ms": 9, "mfc": "none", "color": style.EXACT, "label": "used by a tier or the thesis"}
    handles.append(Line2D([], [], ls="", **ring))
    axes[0, 0].figure.legend(handles=handles, loc="outside upper right", ncols=len(handles))


def _plot_forecast(axes: Axes, own: pd.DataFrame, quantity: str, cost: str) -> None:
    """Plot the forecast cost of the study's own solver against the errors found."""
    rows = own[(own[quantity] > ROUNDING) & np.isfinite(own[quantity]) & own[f"predicted_{cost}"].notna()]
    if len(rows):
        look = {"ls": ":", "marker": "+", "lw": 1.0, "ms": 5, "color": style.EXACT, "label": "forecast"}
        axes.plot(rows[quantity], rows[f"predicted_{cost}"], **look)


def _plot_against_grid(axes: Axes, values: xr.Dataset, quantity: str, xlabel: str) -> None:
    """Plot the mean over all solutions against the grid: κ_r by each definition, or the quantity of the case.

    There is a curve for each Hurst exponent.
    """
    part = values.isel(setting=np.flatnonzero(values.knob == "points"))
    definitions = {name: look for name, look in DEFINITIONS.items() if name in part} or {quantity: ("", style.CONTACT)}
    for name, (_, colour) in definitions.items():
        solved = converged(part[name], part)
        mean = solved.mean([dim for dim in solved.dims if dim not in ("setting", "hurst_exponent")], skipna=False)
        if "hurst_exponent" not in mean.dims:
            mean = mean.expand_dims(hurst_exponent=[0.2])
        for hurst_exponent in mean.hurst_exponent.values:
            axes.plot(
                part.points, mean.sel(hurst_exponent=hurst_exponent), color=colour, **style.hurst_look(hurst_exponent)
            )
    first = next(iter(definitions))
    unit = RESULTS[first].unit
    axes.set(xlabel=xlabel, ylabel=RESULTS[first].symbol + (f" ({unit})" if unit != "1" else ""))
    axes.set_xscale("log", base=2)
    axes.yaxis.get_major_formatter().set_useOffset(False)
    handles = style.hurst_handles(part.hurst_exponent.values) if "hurst_exponent" in part.dims else []
    labels = dict(definitions.values()) if first in DEFINITIONS else {}
    axes.legend(handles=handles + style.colour_handles(labels))


def _write_comparison(axes: Axes, table: pd.DataFrame, equal: pd.DataFrame) -> None:
    """Write the observed orders, and a table of the cost at equal error over that of the study's own solver."""
    axes.axis("off")
    grids = table[(table.knob == "points") & table.own]
    orders = [
        f"{variable.symbol} {error_cost.convergence_order(grids, name):.2f}"
        for name, variable in RESULTS.items()
        if variable.symbol and name in table
    ]
    text = wrapped_list("Observed order in grid points: ", orders)
    others = equal[~equal.solver.isin(table.solver[table.own])]
    order = [*style.SOLVER_NAMES, *sorted(set(others.solver) - set(style.SOLVER_NAMES))]
    solvers = [kind for kind in order if kind in set(others.solver)]
    rows = list(comparison_rows(others, solvers))
    if rows:
        text += f"\n\nCost at equal error over that of {own_solver(table)},\nin transforms × points (in seconds)"
    axes.text(0, 1, text, fontsize=7, va="top", linespacing=1.3)
    if rows:
        heads = [style.solver_name(kind).replace("–", "–\n").replace(" ", "\n") for kind in solvers]
        _draw_comparison(axes, rows, ["", "error", *heads])


def _draw_comparison(axes: Axes, rows: list[list[str]], heads: list[str]) -> None:
    """Draw the table of costs below the text."""
    solvers = len(heads) - 2
    widths = [0.24, 0.13, *[0.63 / solvers] * solvers]
    table = axes.table(rows, colLabels=heads, bbox=(0, 0, 1, 0.74), colWidths=widths, edges="horizontal")
    table.auto_set_font_size(False)
    table.set_fontsize(7)
    for (row, column), cell in table.get_celld().items():
        cell.set(height=1.7 if row == 0 else 1.0, linewidth=0.5, edgecolor=style.LIGHT_GREY)
        cell.get_text().set_horizontalalignment("left" if column == 0 else "center")
        cell.PAD = 0.0 if column == 0 else cell.PAD


def wrapped_list(text: str, entries: Iterable[str]) -> str:
    """Return a text and a list of entries, broken into lines for the last column; a symbol counts as two letters."""
    lines = [text]
    for entry in entries:
        if len(re.sub(r"\$.*?\$", "κr", lines[-1] + entry)) > LINE_LETTERS:
            lines.append("")
        lines[-1] += f"{entry}, "
    return "\n".join(line.rstrip() for line in lines).rstrip(",")


def comparison_rows(equal: pd.DataFrame, solvers: Sequence[str]) -> Iterator[list[str]]:
    """Yield the rows of the table that hold a cost: the knob where it changes, the error, the cost of each solver."""
    costs, previous = equal.set_index(["knob", "error", "solver"]), None
    for knob, error in dict.fromkeys(costs.index.droplevel("solver")):
        keys = [(knob, error, kind) for kind in solvers]
        texts = [cost_text(costs.loc[key]) if key in costs.index else UNMEASURED for key in keys]
        if set(texts) != {UNMEASURED}:
            yield ["" if knob == previous else KNOB_NAMES[knob], f"{error:g}", *texts]
            previous = knob


def cost_text(ratios: pd.Series) -> str:
    """Return the cost over that of the study's own solver, in work and in seconds; a dash if it was not measured."""
    if ratios.isna().any():
        return UNMEASURED
    work, seconds = (
        f"{float(f'{ratio:.1e}'):.0f}" if ratio >= 9.95 else f"{ratio:#.2g}" for ratio in (ratios.work, ratios.seconds)
    )
    return f"{work} ({seconds})"
