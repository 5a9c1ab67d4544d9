"""Judge the statements of the thesis by the rules of docs/judging.md: number, errors, verdict and margin.

A claim of the config names a quantity, its reduction to one number, and the band that the statement allows. It is
decided only where the number is at least `MIN_MARGIN` errors away from the edge of the band.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.analysis.comparison import SECOND_STUDY, Comparison
from contactsim.analysis.conditions import find_condition
from contactsim.analysis.quantities import SECOND_ESTIMATORS
from contactsim.analysis.reductions import ORDERS, REDUCTIONS
from contactsim.analysis.uncertainty import (
    NAN,
    Estimate,
    estimate,
    estimate_on_thesis_grid,
    estimate_steps,
    is_on_thesis_grid,
)
from contactsim.analysis.wording import range_text

REPRODUCED, CONDITION = "reproduced", "reproduced with a condition"
NOT_REPRODUCED, NOT_DECIDABLE = "not reproduced", "not decidable"
FINDING = "finding"
"""In place of a verdict: a number that no sentence of the thesis states."""
MIN_MARGIN = 2.0
"""Least distance from the edge of a band, in errors, at which a claim is decided."""
SCALES = {"half": 0.5, "double": 2.0}
"""Factors of the band with which each verdict is given again."""
BESIDE_NUMBERS = ("beside_value", "beside_ensemble_error", "beside_grid_error", "beside_margin")
UNKNOWN_BESIDE: dict[str, object] = dict.fromkeys(BESIDE_NUMBERS, NAN)
CONDITION_NUMBERS = ("condition_value", "condition_ensemble_error", "condition_grid_error", "condition_share")


@dataclass(frozen=True)
class Verdict:
    """A verdict and how sure it is.

    Attributes
    ----------
    verdict
        Reproduced, not reproduced or not decidable.
    margin
        Distance from the number to the nearest edge of the band, in errors.
    place
        Distance from the neutral value over that of the edge; NaN without a neutral value or a width.
    """

    verdict: str = NOT_DECIDABLE
    margin: float = NAN
    place: float = NAN


def comparison_text(claim: Mapping) -> str:
    """Return what is compared, in the names of the config."""
    if claim["study"] is None:
        return ""
    inputs = [f" {name} {claim[name]}" for name in ("against", "along", "across") if claim[name] is not None]
    second = "".join(
        f" in {claim['study']} {word} {claim[key]}" for key, (word, _) in SECOND_STUDY.items() if claim[key]
    )
    return f"{claim['reduce']} of {claim['quantity']}{second}{''.join(inputs)}"


def neutral_value(claim: Mapping) -> float | None:
    """Return the value that the statement names, or that would mean no change; None where there is none."""
    if claim["neutral"] is not None:
        return float(claim["neutral"])
    if claim["expect"] is not None:
        return float(claim["expect"])
    reduction = REDUCTIONS[claim["reduce"]]
    if reduction.neutral is not None:
        return reduction.neutral
    return 1.0 if claim["relative_to"] is not None else 0.0 if claim["minus"] is not None else None


def band(claim: Mapping, scale: float = 1.0) -> tuple[float, float]:
    """Return the smallest and the largest value that the statement allows.

    Parameters
    ----------
    claim
        Settings of the claim.
    scale
        Factor of the distances from the neutral value to the edges.
    """
    if claim["expect"] is not None:
        return claim["expect"] - scale * claim["tolerance"], claim["expect"] + scale * claim["tolerance"]
    neutral = neutral_value(claim)

    def edge(key: str, missing: float) -> float:
        """Return the edge that a key gives."""
        if claim[key] is None:
            return missing
        return float(claim[key]) if neutral is None else neutral + scale * (claim[key] - neutral)

    return edge("at_least", -np.inf), edge("at_most", np.inf)


def band_text(claim: Mapping) -> str:
    """Return the band in words."""
    if claim["expect"] is not None:
        return f"{claim['expect']:g} ± {claim['tolerance']:g}"
    if claim["reduce"] in ORDERS:
        return "each step; found: the worst in its errors"
    signs = (("at_least", "≥"), ("at_most", "≤"))
    return " ".join(f"{sign} {claim[key]:g}" for key, sign in signs if claim[key] is not None)


def judge_number(claim: Mapping, number: Estimate, scale: float = 1.0) -> Verdict:
    """Return the verdict on a number, with the band scaled about its neutral value."""
    low, high = band(claim, scale)
    edge = low if abs(number.value - low) < abs(number.value - high) else high
    distance, error = abs(number.value - edge), number.error
    if not np.isfinite([distance, error]).all():
        return Verdict()
    margin = distance / error if error > 0 else np.inf if distance > 0 else 0.0
    neutral = neutral_value(claim)
    width = NAN if neutral is None or edge == neutral else abs(edge - neutral)
    place = NAN if neutral is None else abs(number.value - neutral) / width
    if margin < MIN_MARGIN:
        return Verdict(NOT_DECIDABLE, margin, place)
    return Verdict(REPRODUCED if low < number.value < high else NOT_REPRODUCED, margin, place)


def judge_steps(steps: np.ndarray, errors: np.ndarray) -> tuple[Verdict, float]:
    """Return the verdict on the steps of an order, positive in the claimed sense, and the worst step in its errors.

    A step of the wrong sign counts beyond `MIN_MARGIN` errors. Without a step of a sign the order is not decidable.
    """
    if not np.isfinite([steps, errors]).all():
        return Verdict(), NAN
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = np.where(steps == 0, 0.0, steps / errors)
    worst, best = float(ratios.min()), float(ratios.max())
    if worst <= -MIN_MARGIN:
        return Verdict(NOT_REPRODUCED, -worst), worst
    return Verdict(REPRODUCED if best >= MIN_MARGIN else NOT_DECIDABLE, best), worst


def judge(claim: Mapping, data: Sequence[xr.Dataset]) -> dict[str, object]:
    """Return the number, errors and verdict of a claim, and those of its condition where there is one.

    Parameters
    ----------
    claim
        Settings of the claim.
    data
        Datasets of its studies: none, one, or two for a comparison.
    """
    row: dict[str, object] = {"condition": "", "unknown": ""} | dict.fromkeys(CONDITION_NUMBERS, NAN)
    row.update(judge_beside(claim, data) if claim["beside"] else {"beside_verdict": ""} | UNKNOWN_BESIDE)
    if not data:
        return row | _entries([Verdict()] * 3, Estimate())
    comparison = Comparison(claim, data).select(claim["select"])
    row["unknown"] = comparison.unknown_places()
    if claim["reduce"] in ORDERS:
        result, worst = judge_steps(*estimate_steps(comparison))
        return row | _entries([result] * 3, Estimate(worst))
    number = estimate(comparison)
    if claim["is_finding"]:
        return row | _entries([Verdict(FINDING)] * 3, number)
    on_thesis_grid = estimate_on_thesis_grid(comparison) if claim["grid"] == "either" else None
    decisions = [_decide(comparison, number, on_thesis_grid, scale) for scale in (1.0, *SCALES.values())]
    return row | _entries([result for result, _ in decisions], number) | decisions[0][1]


def choose_row(claim: Mapping, data: Sequence[xr.Dataset]) -> Mapping:
    """Return the claim with the row that counts as its quantity.

    A number that the thesis states is compared on the thesis's own grid, or with the corrected quantity on another.
    """
    if claim["grid"] == "thesis" and claim["beside"] and not all(map(is_on_thesis_grid, data)):
        return {**claim, "quantity": claim["beside"], "beside": claim["quantity"], "grid": None}
    return claim


def judge_beside(claim: Mapping, data: Sequence[xr.Dataset]) -> dict[str, object]:
    """Return the number of a claim's second row, with the quantity that `beside` names, and its verdict; not counted.

    On the thesis's own grid a quantity that is not corrected has no grid error.
    """
    comparison = Comparison({**claim, "quantity": claim["beside"]}, data).select(claim["select"])
    if claim["reduce"] in ORDERS:
        result, worst = judge_steps(*estimate_steps(comparison))
        number = Estimate(worst)
    else:
        number = estimate_on_thesis_grid(comparison)
        if claim["beside"] in SECOND_ESTIMATORS or np.isnan(number.grid_error):
            number = estimate(Comparison({**comparison.claim, "grid": None}, comparison.data))
        result = judge_number(claim, number)
    values = (number.value, number.ensemble_error, number.grid_error, result.margin)
    return {"beside_verdict": result.verdict} | dict(zip(BESIDE_NUMBERS, values, strict=True))


def _entries(results: Sequence[Verdict], number: Estimate) -> dict[str, object]:
    """Return the entries of a row: a verdict, its margin and its number, and the verdicts with other bands."""
    others = {f"verdict_{name}": other.verdict for name, other in zip(SCALES, results[1:], strict=True)}
    return vars(results[0]) | vars(number) | others


def _decide(
    comparison: Comparison, number: Estimate, on_thesis_grid: Estimate | None, scale: float
) -> tuple[Verdict, dict[str, object]]:
    """Return the verdict on a number with a scaled band, and the entries of the condition under which it holds."""
    claim = comparison.claim

    def holds(candidate: Estimate) -> bool:
        """Return True where the claim holds."""
        return judge_number(claim, candidate, scale).verdict == REPRODUCED

    result = judge_number(claim, number, scale)
    if on_thesis_grid is not None and result.verdict != REPRODUCED:
        there = judge_number(claim, on_thesis_grid, scale).verdict
        if there == REPRODUCED or (there == NOT_REPRODUCED and result.verdict == NOT_DECIDABLE):
            decided = CONDITION if there == REPRODUCED else NOT_REPRODUCED
            return replace(result, verdict=decided), _condition_entries("on the thesis's own grid", on_thesis_grid, 1.0)
    if result.verdict != NOT_REPRODUCED:
        return result, {}
    condition = find_condition(comparison, band(claim, scale), holds)
    if condition is None:
        return result, {}
    words = ", ".join(range_text(dim, *ends) for dim, ends in condition.block.items())
    return replace(result, verdict=CONDITION), _condition_entries(words, condition.number, condition.share)


def _condition_entries(words: str, number: Estimate, share: float) -> dict[str, object]:
    """Return the entries of a row that describe a condition."""
    numbers = {f"condition_{name}": value for name, value in vars(number).items()}
    return {"condition": words, "condition_share": share} | numbers


def judge_claims(claims: Mapping[str, Mapping], data: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Return a table with one row for each claim of a chapter.

    Parameters
    ----------
    claims
        Settings of each claim.
    data
        Dataset of each study.
    """
    rows = []
    for name, settings in claims.items():
        studies = {key: settings[key] or "" for key in ("study", *SECOND_STUDY)}
        studied = [data[study] for study in studies.values() if study]
        claim = choose_row(settings, studied)
        rows.append(
            {
                "claim": name,
                **{key: claim[key] for key in ("source", "statement")},
                "measure": comparison_text(claim),
                "expected": band_text(claim),
                "beside": claim["beside"] or "",
                **judge(claim, studied),
                "rationale": claim["rationale"],
                **studies,
            }
        )
    return pd.DataFrame(rows)
