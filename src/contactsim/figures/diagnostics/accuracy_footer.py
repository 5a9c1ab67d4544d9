"""Footer of the figure of accuracy versus cost: how the knobs were varied, and what is not on the curves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from contactsim.evaluation.work_precision.error_cost import ROUNDING
from contactsim.figures import style
from contactsim.figures.diagnostics import knobs

KNOB_NAMES = {"points": "grid points", "tangential_cutoff": "tangential cutoff"} | {
    name: name for name in ("tolerance", "increment", "members")
}

FEWEST = 2
"""Fewest errors, different in their first digits, that make a panel."""


def varied_knobs(table: pd.DataFrame) -> list[str]:
    """Return the knobs that were varied."""
    return [knob for knob in KNOB_NAMES if (table.knob == knob).any()]


def drawn_knobs(table: pd.DataFrame, quantity: str) -> list[str]:
    """Return the knobs that have a panel: the grid, and those with several different errors of a quantity."""
    errors = table[table.own & (table[quantity] > ROUNDING)].set_index("knob")[quantity]
    different = np.log10(errors).round(1).groupby("knob").nunique()
    return [knob for knob in varied_knobs(table) if knob == "points" or different.get(knob, 0) >= FEWEST]


def own_solver(table: pd.DataFrame) -> str:
    """Return the name of the study's own solver."""
    return style.solver_name(table.solver[table.own].iloc[0])


def footer_text(table: pd.DataFrame, plan: Mapping[str, Any]) -> str:
    """Return tier and timings, the other settings and the reference of each knob, and what is not on the curves."""
    settings, repeats = plan["settings"], plan["settings"]["repeats"]
    parts = [
        f"{plan['tier']} tier",
        f"{len(table)} settings, " + (f"best of up to {repeats} timings" if repeats > 1 else "each timed once"),
        *(_knob_text(knob, plan) for knob in varied_knobs(table) if knob in settings["settled"]),
    ]
    ensembles = table[table.knob == "members"]
    parts += [f"members varied at {points} points of the study" for points in ensembles.points.unique()]
    quantity = settings["quantities"][0]
    drawn = table[table.knob.isin(drawn_knobs(table, quantity))]
    parts += [*_undrawn_texts(table, quantity), *_margin_texts(drawn, quantity), *_ringless_texts(table, plan)]
    return " · ".join([*parts, *kept_texts(plan["kept"])])


def kept_texts(*dates_by_solver: Mapping[str, str]) -> list[str]:
    """Return a sentence on the solvers whose results the package contains, with the dates of measurement, or none."""
    solvers = sorted({style.solver_name(solver) for dates in dates_by_solver for solver in dates})
    measured = sorted({date for dates in dates_by_solver for date in dates.values()})
    text = f"baselines ({', '.join(solvers)}) are kept in the package, measured on {', '.join(measured)}"
    text += ", and their seconds are scaled by the time of a transform on this machine"
    return [text] if solvers else []


def _knob_text(knob: str, plan: Mapping[str, Any]) -> str:
    """Return the values of the other knobs while one was varied, and its reference."""
    settled, reference = (plan["settings"][part] for part in ("settled", "reference"))
    other_knobs = " and ".join(
        _value_text(plan, name, settled) for name in KNOB_NAMES if name in settled and name != knob
    )
    tight = f" at {_value_text(plan, 'tolerance', reference)}" if knob == "points" else ""
    return f"{knob} varied at {other_knobs}, reference {_value_text(plan, knob, reference)}{tight}"


def _value_text(plan: Mapping[str, Any], knob: str, values: Mapping[str, float]) -> str:
    """Return a knob and its value."""
    value = values[knob]
    if knob == "points":
        return f"{value} × {value} points" if plan["surface"] else f"{value} points"
    return f"{KNOB_NAMES[knob]} {value:g}{_unit_text(plan, knob)}"


def _unit_text(plan: Mapping[str, Any], knob: str) -> str:
    """Return the unit of a knob with a space before it, or nothing."""
    return f" {plan['units'][knob]}" if knob in plan["units"] else ""


def _undrawn_texts(table: pd.DataFrame, quantity: str) -> list[str]:
    """Return the largest error of each knob that has no panel."""
    texts = []
    for knob in varied_knobs(table):
        if knob not in drawn_knobs(table, quantity):
            errors = table[quantity][table.own & (table.knob == knob)]
            known = errors[np.isfinite(errors)]
            text = f"its error is at most {known.max():.1g}" if len(known) else "its error is not known"
            texts.append(f"{KNOB_NAMES[knob]} has no panel: {text}")
    return texts


def _margin_texts(table: pd.DataFrame, quantity: str) -> list[str]:
    """Return how many settings stand in the margins for errors of zero and of infinity."""
    margins = {
        "without error beyond rounding, at 0": table[quantity] <= ROUNDING,
        "where a solution has no value, at ∞": np.isinf(table[quantity]),
    }
    return [f"{text}: {settings.sum()}" for text, settings in margins.items() if settings.any()]


def _ringless_texts(table: pd.DataFrame, plan: Mapping[str, Any]) -> list[str]:
    """Return the values of tiers and thesis that are not on the curve of the study's own solver."""
    quantity, marks = plan["settings"]["quantities"][0], plan["marks"]
    missing = [
        f"{names}, with {KNOB_NAMES[knob]} {value:.7g}{_unit_text(plan, knob)}"
        for knob in drawn_knobs(table, quantity)
        for value, names in knobs.names_by_value(marks, knob).items()
        if knobs.marked_rows(table, quantity, knob, value).empty
    ]
    texts = [f"not on the curve of {own_solver(table)}, so without a ring: {'; '.join(missing)}"] if missing else []
    adaptive = [name for name, own in marks.items() if name != "thesis" and "increment" not in own]
    if adaptive and "increment" in drawn_knobs(table, quantity):
        texts.append(f"increments of their own, so without a ring: {', '.join(adaptive)}")
    return texts
