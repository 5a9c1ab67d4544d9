"""Judge the statements on the probe in every candidate, and say which candidates are admitted."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict

import numpy as np
import pandas as pd
import xarray as xr

from contactsim import dataset
from contactsim.analysis.cases import join_cases
from contactsim.analysis.comparison import SECOND_STUDY, Comparison
from contactsim.analysis.reductions import ORDERS
from contactsim.analysis.uncertainty import estimate
from contactsim.analysis.verdict import judge_number, judge_order
from contactsim.evaluation.identification.admission import AdmissionNumbers, Limits, admit, has_signs_of_text
from contactsim.evaluation.identification.sampling import Candidate
from contactsim.evaluation.identification.simulation import DOUBLED
from contactsim.status import is_solved

BAND_SCALES = {"verdict": 1.0, "verdict_half": 0.5, "verdict_double": 2.0}
"""Factor of the band of each verdict."""
DIGITS = 4
"""Significant digits of a number in the table."""


def judge_statement(claim: Mapping, data: Mapping[str, xr.Dataset]) -> dict[str, object]:
    """Return value, margin and verdicts of a statement in a candidate; of several cases the worst.

    claim: settings; data: dataset of each interface
    """
    cases = {claim["case"]: claim, **(claim["cases"] or {})}
    return join_cases({name: _judge_case(case, data) for name, case in cases.items()})


def _judge_case(claim: Mapping, data: Mapping[str, xr.Dataset]) -> dict[str, object]:
    """Return value, margin and verdicts of one case, without a search for conditions."""
    studies = [data[claim[key]] for key in ("study", *SECOND_STUDY) if claim[key]]
    comparison = Comparison(claim, studies).select(claim["select"])
    if claim["reduce"] in ORDERS:
        result, worst = judge_order(comparison)
        return {"value": worst, "margin": result.margin, **dict.fromkeys(BAND_SCALES, result.verdict)}
    number = estimate(comparison)
    verdicts = {name: judge_number(claim, number, scale).verdict for name, scale in BAND_SCALES.items()}
    return {"value": number.value, "margin": judge_number(claim, number).margin, **verdicts}


def admission_entries(data: Mapping[str, xr.Dataset], strong: str, limits: Limits) -> dict[str, object]:
    """Return the numbers and rules that admit a candidate, and its number of states without a solution."""
    numbers = AdmissionNumbers.of(data[strong], data[DOUBLED])
    sets = {
        "sound": numbers.is_sound(limits),
        "isolated": numbers.is_isolated(limits),
        "signs": has_signs_of_text(data[strong], limits),
    }
    unsolved = sum(int(_unsolved(part).sum()) for part in data.values())
    return asdict(numbers) | {"unsolved": unsolved} | sets


def _unsolved(data: xr.Dataset) -> np.ndarray:
    """Return True for the states of a slide that have no solution; a slide that has ended has no more states."""
    return (data.status.notnull() & ~is_solved(data.status)).values  # noqa: PD004 (of xarray)


def judge_candidate(
    candidate: Candidate, data: Mapping[str, xr.Dataset], claims: Mapping[str, Mapping], strong: str, limits: Limits
) -> list[dict[str, object]]:
    """Return one row for each statement in a candidate.

    Parameters
    ----------
    candidate
        The cell.
    data
        Dataset of each interface, and of the strong one in twice the period.
    claims
        Settings of the statements by name.
    strong
        Name of the strong interface.
    limits
        What admits a candidate.
    """
    shared = asdict(candidate) | admission_entries(data, strong, limits)
    shared["candidate"] = shared.pop("name")
    rows = []
    for name, claim in claims.items():
        judged = judge_statement(claim, data)
        rows.append(shared | {"claim": name} | {key: judged[key] for key in ("value", "margin", *BAND_SCALES)})
    return rows


def judge_files(job: Mapping, files: Sequence[str]) -> pd.DataFrame:
    """Return the table of all candidates.

    job: of `settings.judgement_job`; files: datasets of the candidates, one after the other in the order of `job`
    """
    claims, limits = dict(job["claims"]), Limits(**job["limits"])
    names = [*job["interfaces"], DOUBLED]
    rows = []
    for place, settings in enumerate(job["candidates"]):
        paths = files[place * len(names) : (place + 1) * len(names)]
        data = dict(zip(names, map(dataset.load_dataset, paths), strict=True))
        rows += judge_candidate(Candidate(**settings), data, claims, names[0], limits)
    return admit(candidates_table(rows), limits.min_isolated)


def table_text(table: pd.DataFrame, count: int) -> str:
    """Return a table as CSV below a comment that says how many of the candidates it holds; count: of all candidates."""
    head = f"# The first {table.candidate.nunique()} of {count} candidates of config/identification.yaml\n"
    return head + table.to_csv(index=False)


def candidates_table(rows: Sequence[Mapping[str, object]]) -> pd.DataFrame:
    """Return the rows of all candidates as a table, its numbers rounded; the candidate and its cell come first."""
    table = pd.DataFrame(list(rows))
    for name in table.select_dtypes("float"):
        if name not in ("width", "thickness", "lattice_constant"):
            table[name] = table[name].map(_rounded)
    return table[["candidate", *table.columns.drop("candidate")]]


def _rounded(value: float) -> float:
    """Return a number with `DIGITS` significant digits."""
    return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else value
