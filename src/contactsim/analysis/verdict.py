"""The verdict on a number: the band that a statement allows, the margin in errors, and the place in the band."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from contactsim.analysis.comparison import SECOND_STUDY, Comparison
from contactsim.analysis.reductions import ORDERS, REDUCTIONS
from contactsim.analysis.uncertainty import MIN_MARGIN, NAN, Estimate, estimate_steps

REPRODUCED, CONDITION = "reproduced", "reproduced with a condition"
NOT_REPRODUCED, NOT_DECIDABLE = "not reproduced", "not decidable"
DEPENDS = "depends on what the text leaves open"
"""The statement holds with one admissible reading and fails with another; see `contactsim.analysis.admissible`."""
FINDING = "finding"
"""In place of a verdict: a number that no sentence of the thesis states."""


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


def neutral_value(claim: Mapping) -> float | None:
    """Return the value that the statement names, or that would mean no change; None where there is none."""
    if claim["neutral"] is not None:
        return float(claim["neutral"])
    if claim["expect"] is not None:
        return float(claim["expect"])
    reduction = REDUCTIONS[claim["reduce"]]
    if reduction.neutral is not None:
        return reduction.neutral
    return next((second.no_change for key, second in SECOND_STUDY.items() if claim[key] is not None), None)


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
    margin = distance / error if error > 0 else np.inf  # a band does not hold its edges: a known 0 does not grow
    neutral = neutral_value(claim)
    width = NAN if neutral is None or edge == neutral else abs(edge - neutral)
    place = NAN if neutral is None else abs(number.value - neutral) / width
    if margin < MIN_MARGIN:
        return Verdict(NOT_DECIDABLE, margin, place)
    return Verdict(REPRODUCED if low < number.value < high else NOT_REPRODUCED, margin, place)


def judge_order(comparison: Comparison) -> tuple[Verdict, float]:
    """Return the verdict on an order, and its worst step in errors."""
    return judge_steps(*(estimate_steps(number, comparison) for number in (comparison.steps, comparison.end_to_end)))


def judge_steps(
    steps: tuple[np.ndarray, np.ndarray], end_to_end: tuple[np.ndarray, np.ndarray]
) -> tuple[Verdict, float]:
    """Return the verdict on an order, and its worst step in errors.

    An order holds if the quantity changes from end to end in the claimed sense, by `MIN_MARGIN` errors, and no step has
    the other sign by as many. The margin is that of the change from end to end, or of the step of the wrong sign.

    Parameters
    ----------
    steps, end_to_end
        Changes, positive in the claimed sense, and their errors.
    """
    if not all(np.isfinite(part).all() for part in (*steps, *end_to_end)):
        return Verdict(), NAN
    worst, whole = float(_in_errors(*steps).min()), float(_in_errors(*end_to_end).min())
    if worst <= -MIN_MARGIN:
        return Verdict(NOT_REPRODUCED, -worst), worst
    if abs(whole) < MIN_MARGIN:
        return Verdict(NOT_DECIDABLE, abs(whole)), worst
    return Verdict(REPRODUCED if whole > 0 else NOT_REPRODUCED, abs(whole)), worst


def _in_errors(changes: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Return changes over their errors; zero where nothing changes."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(changes == 0, 0.0, changes / errors)
