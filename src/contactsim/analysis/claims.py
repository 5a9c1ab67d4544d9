"""Judge the statements of the thesis by the rules of docs/judging.md: number, errors, verdict and margin.

A claim of the config names a quantity, its reduction to one number, and the band that the statement allows. It is
decided only where the number is at least `MIN_MARGIN` errors away from the edge of the band.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.analysis.conditions import find_condition
from contactsim.analysis.reductions import ORDERS, REDUCTIONS
from contactsim.analysis.uncertainty import (
    NAN,
    Estimate,
    estimate,
    estimate_steps,
    select,
    unknown_places,
)
from contactsim.analysis.wording import range_text

REPRODUCED, CONDITION = "reproduced", "reproduced with a condition"
NOT_REPRODUCED, NOT_DECIDABLE = "not reproduced", "not decidable"
FINDING = "finding"
"""In place of a verdict: a number that no sentence of the thesis states."""
MIN_MARGIN = 2.0
"""Least distance from the edge of a band, in errors, at which a claim is decided."""
SECOND_STUDY = {"relative_to": "over", "minus": "minus"}
"""Keys that name a second study, and the words of the comparison."""
SCALES = {"half": 0.5, "double": 2.0}
"""Factors of the band with which each verdict is given again."""
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
    second = "".join(f" in {claim['study']} {sign} {claim[key]}" for key, sign in SECOND_STUDY.items() if claim[key])
    return f"{claim['reduce']} of {claim['quantity']}{second}{''.join(inputs)}"


def neutral_value(claim: Mapping) -> float | None:
    """Return the value that the statement names, or that would mean no change; None where there is none."""
    if claim["neutral"] is not None:
        return float(claim["neutral"])
    if claim["expect"] is not None:
        return float(claim["expect"])
    if claim["reduce"] in ORDERS:
        return 0.0
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
    if not data:
        return vars(Verdict()) | vars(Estimate()) | row | {f"verdict_{name}": NOT_DECIDABLE for name in SCALES}
    selected = select(data, claim["select"])
    row["unknown"] = unknown_places(claim, selected)
    if claim["reduce"] in ORDERS:
        steps, errors = estimate_steps(claim, selected)
        result, worst = judge_steps(steps, errors)
        return vars(result) | vars(Estimate(worst)) | row | {f"verdict_{name}": result.verdict for name in SCALES}
    number = estimate(claim, selected)
    if claim["is_finding"]:
        return vars(Verdict(FINDING)) | vars(number) | row | {f"verdict_{name}": FINDING for name in SCALES}
    row |= {f"verdict_{name}": _decide(claim, selected, number, scale)["verdict"] for name, scale in SCALES.items()}
    return row | vars(number) | _decide(claim, selected, number)


def _decide(claim: Mapping, data: Sequence[xr.Dataset], number: Estimate, scale: float = 1.0) -> dict[str, object]:
    """Return verdict, margin and place of a claim, and the entries of its condition where there is one."""
    result = judge_number(claim, number, scale)
    row: dict[str, object] = dict(vars(result))
    if claim["grid"] == "either" and result.verdict != REPRODUCED:
        row |= _decide_on_thesis_grid(claim, data, result.verdict, scale)
    if row["verdict"] == NOT_REPRODUCED and "condition" not in row:
        row |= _decide_with_condition(claim, data, scale)
    return row


def _decide_on_thesis_grid(claim: Mapping, data: Sequence[xr.Dataset], verdict: str, scale: float) -> dict[str, object]:
    """Return the verdict on the thesis's own number of points, as a condition; empty where it decides nothing."""
    number = estimate(claim, data, on_thesis_grid=True)
    there = judge_number(claim, number, scale).verdict
    if there == REPRODUCED or (there == NOT_REPRODUCED and verdict == NOT_DECIDABLE):
        decided = CONDITION if there == REPRODUCED else NOT_REPRODUCED
        return {"verdict": decided} | _condition_entries("on the thesis's own grid", number, 1.0)
    return {}


def _decide_with_condition(claim: Mapping, data: Sequence[xr.Dataset], scale: float) -> dict[str, object]:
    """Return the verdict under the condition in which a claim holds; empty if there is none."""

    def holds(number: Estimate) -> bool:
        """Return True where the claim holds."""
        return judge_number(claim, number, scale).verdict == REPRODUCED

    condition = find_condition(claim, data, band(claim, scale), holds)
    if condition is None:
        return {}
    words = ", ".join(range_text(dim, *ends) for dim, ends in condition.block.items())
    return {"verdict": CONDITION} | _condition_entries(words, condition.number, condition.share)


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
    for name, claim in claims.items():
        studies = {key: claim[key] or "" for key in ("study", *SECOND_STUDY)}
        rows.append(
            {
                "claim": name,
                **{key: claim[key] for key in ("source", "statement")},
                "measure": comparison_text(claim),
                "expected": band_text(claim),
                **judge(claim, [data[study] for study in studies.values() if study]),
                "rationale": claim["rationale"],
                **studies,
            }
        )
    return pd.DataFrame(rows)
