"""Families of hard cases: the worst outcome of the default solver at each severity."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap

from contactsim import dataset
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.figures.diagnostics.stability import COLOURS, WORDS, add_outcome_legend
from contactsim.solvers.registry import DEFAULT_SOLVERS

SHOWN: dict[Outcome, str] = {outcome: words for outcome, words in WORDS.items() if outcome is not Outcome.NON_FINITE}
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
    names = [name for name, _ in families if name in set(table.family)]
    severities = data.severity.values
    worst = table.pivot_table("outcome", "family", "severity", "max").loc[names, severities]
    unanswered = table[table.outcome.isin(WITHOUT_ANSWER)].groupby(["family", "severity"]).size().to_dict()
    colours = ListedColormap([COLOURS[outcome] for outcome in SHOWN])
    look: dict[str, Any] = {"cmap": colours, "vmin": -0.5, "vmax": len(SHOWN) - 0.5, "edgecolors": "white", "lw": 0.6}
    axes.pcolormesh(np.arange(severities.size + 1), np.arange(len(names) + 1), worst.values, **look)
    for (family, severity), count in unanswered.items():
        place = list(severities).index(severity) + 0.5, names.index(family) + 0.5
        axes.text(*place, str(count), fontsize=7, ha="center", va="center")
    sizes = table.groupby("family").hazard.nunique()
    axes.set_yticks(np.arange(len(names)) + 0.5, [f"{name}: {_hazards(int(sizes[name]))}" for name in names])
    ticks = np.unique(np.linspace(0, severities.size - 1, min(severities.size, TICKS)).round().astype(int))
    axes.set_xticks(ticks + 0.5, [f"{severities[place]:g}" for place in ticks])
    axes.set(ylim=(len(names), 0), xlabel="severity, from easy (0) to far beyond what is usual (100)")
    axes.tick_params(length=0, top=False, right=False)
    axes.spines[:].set_visible(False)
    wrong = int((table.outcome == Outcome.WRONG.value[0]).sum())
    axes.set_title(f"{len(table)} cases, {wrong} wrong", fontsize=11, loc="left", weight="bold")
    add_outcome_legend(axes, SHOWN, table.outcome.to_numpy())
    return table


def _hazards(count: int) -> str:
    """Return a number of hazards in words."""
    return f"{count} hazard{'s' * (count > 1)}"


def outcome_table(data: xr.Dataset, families: Mapping[str, Sequence[str]]) -> pd.DataFrame:
    """Return one row a case that the default solver of its kind takes: family, hazard, severity and outcome."""
    defaults = [name for name in data.solver.values if name in set(DEFAULT_SOLVERS.values())]
    table = data[["outcome", "applicable"]].sel(solver=defaults).to_dataframe().reset_index()
    applicable = table[table.applicable > 0]
    others = table[~table.hazard.isin(applicable.hazard)].drop_duplicates(["hazard", "severity"])  # for no solver
    family = {hazard: name for name, hazards in families.items() for hazard in hazards}
    rows = pd.concat([applicable, others], ignore_index=True)
    outcome = rows.outcome.clip(upper=Outcome.WRONG.value[0]).astype(int)
    columns = ["family", "hazard", "solver", "severity", "outcome"]
    return rows.assign(family=rows.hazard.map(family), outcome=outcome)[columns]


def footer(data: xr.Dataset) -> str:
    """Return the tier and the numbers of hazards and severities."""
    tier = dataset.settings_of(data)["tier"]
    return f"{tier} tier · {data.hazard.size} hazards, {data.severity.size} severities, the default solver of each"
