"""Judge the statements of the thesis by the rules of docs/judging.md: number, errors, verdict and margin.

A claim of the config names a quantity, its reduction to one number, and the band that the statement allows. It is
decided only where the number is far enough from the edge of the band, see `contactsim.analysis.verdict`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import pandas as pd
import xarray as xr

from contactsim.analysis.admissible import Choice, candidate_choices, candidate_entries, choice_entries, read_candidates
from contactsim.analysis.carried import carried_name
from contactsim.analysis.cases import join_cases
from contactsim.analysis.causes import FAILING, Cause, cause_text
from contactsim.analysis.cell_rules import cell_texts
from contactsim.analysis.claim_data import data_text
from contactsim.analysis.comparison import SECOND_STUDY, Comparison
from contactsim.analysis.conditions import ConditionSearch
from contactsim.analysis.extremes import NO_EXTREME, describe_extreme
from contactsim.analysis.formulas import FORMULAS
from contactsim.analysis.more_members import TRANSFERRED_FROM, Studies
from contactsim.analysis.quantities import SECOND_ESTIMATORS
from contactsim.analysis.reductions import ORDERS
from contactsim.analysis.uncertainty import NAN, Estimate, estimate, is_on_thesis_grid
from contactsim.analysis.unknown_places import unknown_places
from contactsim.analysis.verdict import (
    CONDITION,
    FINDING,
    NOT_REPRODUCED,
    REPRODUCED,
    Verdict,
    band,
    band_text,
    judge_number,
    judge_order,
)
from contactsim.analysis.wording import range_text

SCALES = {"half": 0.5, "double": 2.0}
"""Factors of the band with which each verdict is given again."""
FIELD_DIMENSIONS = ("x", "y", "normal_gap_bin", "normal_traction_bin")
"""Dimensions of fields and histograms, which no claim reads and which would be copied again and again."""
NO_ROW_BESIDE: Mapping[str, object] = {
    "beside_verdict": "",
    **dict.fromkeys(("beside_value", "beside_ensemble_error", "beside_grid_error", "beside_margin"), NAN),
}
"""Entries of a claim without a second row."""
CONDITION_NUMBERS = ("condition_value", "condition_ensemble_error", "condition_grid_error", "condition_share")


def comparison_text(claim: Mapping) -> str:
    """Return what is compared, in the names of the config."""
    if claim["study"] is None:
        return "" if claim["formula"] is None else f"exact number: {claim['formula'].replace('_', ' ')}"
    inputs = [f" {name} {claim[name]}" for name in ("against", "along", "across") if claim[name] is not None]
    second = "".join(
        f" in {claim['study']} {compared.word} {claim[key]}" for key, compared in SECOND_STUDY.items() if claim[key]
    )
    cases = f", worst of {1 + len(claim['cases'])} cases" if claim["cases"] else ""
    return f"{claim['reduce']} of {claim['quantity']}{second}{''.join(inputs)}{cases}"


def judge(claim: Mapping, data: Sequence[xr.Dataset]) -> dict[str, object]:
    """Return the number, errors and verdict of a claim, and those of its condition where there is one.

    Parameters
    ----------
    claim
        Settings of the claim.
    data
        Datasets of its studies: none, one, or two for a comparison.
    """
    row: dict[str, object] = {"condition": "", "unknown": ""} | dict.fromkeys(CONDITION_NUMBERS, NAN) | dict(NO_EXTREME)
    row |= dict(NO_ROW_BESIDE) if claim["beside"] is None else judge_beside(claim, data)
    if claim["formula"] is not None:
        return row | _judge_formula(claim)
    if not data:
        return row | _entries([Verdict()] * 3, Estimate())
    comparison = Comparison(claim, data).select(claim["select"])
    row |= {"unknown": unknown_places(comparison)} | describe_extreme(claim, comparison)
    if claim["reduce"] in ORDERS:
        result, number = _judge_order(comparison)
        return row | _entries([result] * 3, number)
    number = estimate(comparison)
    if claim["is_finding"]:
        return row | _entries([Verdict(FINDING)] * 3, number)
    search = ConditionSearch(comparison)
    decisions = [_decide(claim, number, scale, search) for scale in (1.0, *SCALES.values())]
    return row | _entries([result for result, _ in decisions], number) | decisions[0][1]


def counted_row(claim: Mapping, data: Sequence[xr.Dataset]) -> Mapping:
    """Return the claim with the row that counts as its quantity, and the other one beside it.

    A number that the thesis states is compared on the thesis's own grid. Counted on another, it is carried there.
    """
    if claim["grid"] == "thesis" and claim["beside"] and not all(map(is_on_thesis_grid, data)):
        return {**claim, "quantity": carried_name(claim["quantity"]), "grid": None}
    return claim


def judge_beside(claim: Mapping, data: Sequence[xr.Dataset]) -> dict[str, object]:
    """Return number, errors, verdict and margin of a claim's second row, which is not counted.

    Its quantity is that of `beside`. On the thesis's own grid a quantity that is not corrected has no grid error.
    """
    is_thesis_row = claim["beside"] not in SECOND_ESTIMATORS and all(map(is_on_thesis_grid, data))
    row = {**claim, "quantity": claim["beside"], "grid": "thesis" if is_thesis_row else None}
    comparison = Comparison(row, data).select(claim["select"])
    if claim["reduce"] in ORDERS:
        result, number = _judge_order(comparison)
    else:
        number = estimate(comparison)
        result = judge_number(claim, number)
    return {f"beside_{name}": value for name, value in (vars(number) | vars(result)).items() if name != "place"}


def _judge_formula(claim: Mapping) -> dict[str, object]:
    """Return the entries of a claim that an equation answers: its number has no error."""
    number = Estimate(FORMULAS[claim["formula"]](), 0.0, 0.0)
    if claim["is_finding"]:
        return _entries([Verdict(FINDING)] * 3, number)
    return _entries([judge_number(claim, number, scale) for scale in (1.0, *SCALES.values())], number)


def _judge_order(comparison: Comparison) -> tuple[Verdict, Estimate]:
    """Return the verdict on an order, and its worst step in errors in place of a number."""
    result, worst = judge_order(comparison)
    return result, Estimate(worst)


def _entries(results: Sequence[Verdict], number: Estimate) -> dict[str, object]:
    """Return the entries of a row: a verdict, its margin and its number, and the verdicts with other bands."""
    others = {f"verdict_{name}": other.verdict for name, other in zip(SCALES, results[1:], strict=True)}
    return vars(results[0]) | vars(number) | others


def _decide(
    claim: Mapping, number: Estimate, scale: float, search: ConditionSearch
) -> tuple[Verdict, dict[str, object]]:
    """Return the verdict on a number with a scaled band, and the entries of the condition under which it holds."""

    def holds(candidate: Estimate) -> bool:
        """Return True where the claim holds."""
        return judge_number(claim, candidate, scale).verdict == REPRODUCED

    result = judge_number(claim, number, scale)
    if result.verdict != NOT_REPRODUCED:
        return result, {}
    condition = search.find(band(claim, scale), holds)
    if condition is None:
        return result, {}
    words = ", ".join(range_text(dim, *ends) for dim, ends in condition.block.items())
    return replace(result, verdict=CONDITION), _condition_entries(words, condition.number, condition.share)


def _condition_entries(words: str, number: Estimate, share: float) -> dict[str, object]:
    """Return the entries of a row that describe a condition."""
    numbers = {f"condition_{name}": value for name, value in vars(number).items()}
    return {"condition": words, "condition_share": share} | numbers


def judge_choices(claim: Mapping, studies: Studies) -> list[Choice]:
    """Return the verdicts with the admissible readings of a claim beside the default."""
    choices = []
    for name, settings in (claim["admissible"] or {}).items():
        choices.append(Choice.of(name, judge_cases(settings, studies)))
    return choices


def judge_cases(claim: Mapping, studies: Studies) -> dict[str, object]:
    """Return the row of a claim that holds if it holds in all its cases."""
    rows = {}
    for name, settings in {claim["case"]: claim, **(claim["cases"] or {})}.items():
        studied = studies.of(settings)
        counted = counted_row(settings, studied)
        measure = comparison_text({**counted, "cases": claim["cases"]})
        words = {"measure": measure, "expected": band_text(counted), "beside": counted["beside"] or ""}
        words |= {"deciding_study": settings["study"] or ""}
        members = studied[0].sizes.get("member", 1) if studied else 1
        words |= {"data": data_text(counted, studied), "decided_over": _decided_over(counted, studied)}
        rows[name] = words | judge(counted, studied) | {"members": members}
    return join_cases(rows)


def _decided_over(claim: Mapping, data: Sequence[xr.Dataset]) -> str:
    """Return "approaches" for a number of a line through the onsets at several, "grids" for transferred numbers."""
    if any(TRANSFERRED_FROM in study.attrs for study in data):
        return "grids"
    return "approaches" if any(f"{claim['quantity']}_approach_error" in study for study in data) else ""


def cause_numbers(cause: Cause, studies: Studies) -> dict[str, float]:
    """Return the numbers that a cause defines."""
    numbers = {}
    for name, settings in cause.numbers.items():
        comparison = Comparison(settings, studies.of(settings)).select(settings["select"])
        numbers[name] = NAN if comparison.is_empty else comparison.unbiased_number(comparison.data)
    return numbers


def judge_claims(
    claims: Mapping[str, Mapping], data: Mapping[str, xr.Dataset], candidates: pd.DataFrame | None = None
) -> pd.DataFrame:
    """Return a table with one row for each claim of a chapter.

    Parameters
    ----------
    claims
        Settings of each claim.
    data
        Dataset of each study.
    candidates
        Verdicts of sets of parameters that the text admits, of `contactsim.analysis.admissible.read_candidates`.
    """
    studies = Studies({name: part.drop_dims(FIELD_DIMENSIONS, errors="ignore") for name, part in data.items()})
    rows, candidates = [], read_candidates(None) if candidates is None else candidates
    for name, settings in claims.items():
        choices = judge_choices(settings, studies)
        row = judge_cases(settings, studies)
        row |= choice_entries(row, choices, candidate_choices(candidates, name)) | candidate_entries(candidates, name)
        cause = None if settings["cause"] is None else Cause(**settings["cause"])
        cells = cell_texts(candidates, name, cause.cell) if cause else {}
        numbers = cause_numbers(cause, studies) if cause and row["verdict"] in FAILING else {}
        rows.append(
            {
                "claim": name,
                **{key: settings[key] for key in ("source", "statement")},
                **row,
                "cause": cause_text(cause, row, cells, numbers),
                "rationale": settings["rationale"],
                **{key: settings[key] or "" for key in ("study", *SECOND_STUDY)},
            }
        )
    return pd.DataFrame(rows)
