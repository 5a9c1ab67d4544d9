"""Families of hard cases: the worst outcome of the default solver at each severity."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from contactsim import dataset
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.figures import style
from contactsim.figures.diagnostics.stability import COLOURS
from contactsim.solvers.registry import DEFAULT_SOLVERS

WORDS = {
    Outcome.EXACT: "right: the exact answer",
    Outcome.CERTIFIED: "certified: right by its residual",
    Outcome.REFUSED: "refused with a reason",
    Outcome.FAILED: "failed and says so",
    Outcome.WRONG: "wrong",
}
"""What colours mean; an answer that is not finite is wrong."""
WITHOUT_ANSWER = [outcome.value[0] for outcome in (Outcome.REFUSED, Outcome.FAILED)]
"""Outcomes without an answer, whose number of cases is written."""
TICKS = 6
"""Largest number of labels along the severity."""


def robustness(data: xr.Dataset, axes: Axes, families: Sequence[tuple[str, Sequence[str]]]) -> pd.DataFrame:
    """Map the worst outcome of each family of hazards at each severity.

    Parameters
    ----------
    data : of `contactsim.evaluation.robustness.survey.merge_surveys`
    axes : to plot on
    families : name and hazards of each family
    """
    table = outcome_table(data, dict(families))
    shown = [name for name, _ in families if name in set(table.family)]
    severities = data.severity.values
    worst = table.pivot_table("outcome", "family", "severity", "max").loc[shown, severities]
    missed = table[table.outcome.isin(WITHOUT_ANSWER)].groupby(["family", "severity"]).size().to_dict()
    colours = ListedColormap([COLOURS[outcome] for outcome in WORDS])
    look: dict[str, Any] = {"cmap": colours, "vmin": -0.5, "vmax": len(WORDS) - 0.5, "edgecolors": "white", "lw": 0.6}
    axes.pcolormesh(np.arange(severities.size + 1), np.arange(len(shown) + 1), worst.values, **look)
    for (family, severity), count in missed.items():
        place = list(severities).index(severity) + 0.5, shown.index(family) + 0.5
        axes.text(*place, str(count), fontsize=7, ha="center", va="center")
    sizes = table.groupby("family").hazard.nunique()
    axes.set_yticks(np.arange(len(shown)) + 0.5, [f"{name} ({sizes[name]})" for name in shown])
    ticks = np.unique(np.linspace(0, severities.size - 1, min(severities.size, TICKS)).round().astype(int))
    axes.set_xticks(ticks + 0.5, [f"{severities[place]:g}" for place in ticks])
    axes.set(ylim=(len(shown), 0), xlabel="severity, from easy (0) to far beyond what is usual (100)")
    axes.tick_params(length=0, top=False, right=False)
    axes.spines[:].set_visible(False)
    wrong = int((table.outcome == Outcome.WRONG.value[0]).sum())
    axes.set_title(f"{len(table)} cases, {wrong} wrong", fontsize=11, loc="left", weight="bold")
    _add_legend(axes, table)
    return table


def outcome_table(data: xr.Dataset, families: Mapping[str, Sequence[str]]) -> pd.DataFrame:
    """Return one row a case that the default solver of its kind takes: family, hazard, severity and outcome."""
    kept = data.sel(solver=[name for name in data.solver.values if name in set(DEFAULT_SOLVERS.values())])
    table = kept[["outcome", "applicable"]].to_dataframe().reset_index()
    taken = table[table.applicable > 0]
    refused = table[~table.hazard.isin(taken.hazard)].drop_duplicates(["hazard", "severity"])  # a load for no solver
    family = {hazard: name for name, hazards in families.items() for hazard in hazards}
    rows = pd.concat([taken, refused], ignore_index=True)
    outcome = rows.outcome.clip(upper=Outcome.WRONG.value[0]).astype(int)
    return rows.assign(family=rows.hazard.map(family), outcome=outcome)[
        ["family", "hazard", "solver", "severity", "outcome"]
    ]


def _add_legend(axes: Axes, table: pd.DataFrame) -> None:
    """Add the outcomes with their numbers of cases."""
    handles = [
        Patch(
            facecolor=COLOURS[outcome],
            edgecolor=style.LIGHT_GREY,
            lw=0.4,
            label=f"{words}: {int((table.outcome == outcome.value[0]).sum())}",
        )
        for outcome, words in WORDS.items()
    ]
    axes.figure.legend(handles=handles, loc="outside upper right", ncols=3)


def footer(data: xr.Dataset) -> str:
    """Return the tier and the numbers of hazards and severities."""
    tier = dataset.settings_of(data)["tier"]
    return f"{tier} tier · {data.hazard.size} hazards, {data.severity.size} severities, the default solver of each"
