"""Tables of κ and κ_r without the first-order error of the grid, to be cited."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim.analysis.comparison import Comparison
from contactsim.analysis.more_members import with_more_members
from contactsim.analysis.rounding import rounded_texts
from contactsim.analysis.uncertainty import Estimate, estimate
from contactsim.dataset import load_dataset
from contactsim.study.claim_plan import read_claim
from contactsim.study.plan import Plan

FACTORS = {"kappa_corrected": "κ", "kappa_r_corrected": "κ_r"}
"""Quantities of the table, and their symbols."""
LARGEST_PRESSURE = 0.1
"""Largest p* of the thesis."""


def factor_estimate(plan: Plan, study: str, data: xr.Dataset, quantity: str, place: dict[str, float]) -> Estimate:
    """Return a factor at one load and Hurst exponent with its errors, found as those of statements are."""
    select = {dim: [value, value] for dim, value in place.items()}
    texts = dict.fromkeys(("source", "statement", "rationale"), "")
    section = texts | {"study": study, "quantity": quantity, "reduce": "mean", "select": select}
    claim = read_claim(quantity, section, __file__, plan.studies, "findings").settings
    return estimate(Comparison(claim, [data]).select(claim["select"]))


def factor_table(plan: Plan, folder: Path, study: str, more: Sequence[str] = ()) -> str:
    """Return κ and κ_r of an ensemble as a Markdown table: mean ± ensemble error ± grid error.

    Parameters
    ----------
    plan
        Plan of the tier.
    folder
        Folder of the tier's results.
    study
        Name of a study of random surfaces at reduced pressures.
    more
        Names of studies with more members of these surfaces on fewer points, whose means are moved to the finest grid
        at the loads that all have; the one with fewest members first.
    """
    fine, *others = (load_dataset(folder / "datasets" / f"{plan.dataset_name(name)}.nc") for name in (study, *more))
    joined = with_more_members(fine, others)
    pressures = [float(pressure) for pressure in fine.reduced_pressure if pressure <= LARGEST_PRESSURE]
    sources = [joined if pressure in joined.reduced_pressure else fine for pressure in pressures]
    exponents = [float(value) for value in fine.hurst_exponent]
    columns = []
    for name in FACTORS:
        for hurst in exponents:
            estimates = [
                factor_estimate(plan, study, source, name, {"hurst_exponent": hurst, "reduced_pressure": pressure})
                for source, pressure in zip(sources, pressures, strict=True)
            ]
            columns.append(pool_grid_errors(estimates))
    heads = [f"{symbol}, H = {hurst:g}" for symbol in FACTORS.values() for hurst in exponents]
    lines = [f"| p* | members | {' | '.join(heads)} |", "|---" * (len(heads) + 2) + "|"]
    for pressure, source, row in zip(pressures, sources, zip(*columns, strict=True), strict=True):
        texts = [rounded_texts(number.value, number.ensemble_error, number.grid_error) for number in row]
        cells = " | ".join(" ± ".join(cell) for cell in texts)
        lines.append(f"| {pressure:g} | {source.member.size} | {cells} |")
    return "\n".join(lines) + "\n"


def pool_grid_errors(estimates: Sequence[Estimate]) -> list[Estimate]:
    """Return the estimates at rising loads, each with the root mean square of the grid errors at it and beside it.

    A change on halving the points may be small by chance where its sign turns.
    """
    errors = np.array([estimate.grid_error for estimate in estimates])
    windows = [errors[max(place - 1, 0) : place + 2] for place in range(len(errors))]
    return [
        replace(estimate, grid_error=float(np.sqrt(np.mean(window**2))))
        for estimate, window in zip(estimates, windows, strict=True)
    ]
