"""Causes of verdicts that are not plainly "reproduced": their kinds, and their text in a table of verdicts."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from contactsim.analysis.verdict import CONDITION, DEPENDS, NOT_DECIDABLE, NOT_REPRODUCED

KINDS = (
    "physics",
    "grid of the thesis",
    "estimator",
    "choice of the thesis",
    "contradiction in the text",
    "our choice",
)
"""Kinds of causes."""
FAILING = (NOT_REPRODUCED, CONDITION, DEPENDS, NOT_DECIDABLE)
"""Verdicts that have a cause."""
UNKNOWN = "cause not yet known"


@dataclass(frozen=True)
class Cause:
    """Cause of a failure: its kind, one of `KINDS`, and a short text with the number that shows it."""

    kind: str
    text: str

    def __str__(self) -> str:
        """Return kind and text as one sentence."""
        return f"{self.kind.capitalize()}: {' '.join(self.text.split())}"


def cause_text(cause: Cause | None, verdict: str) -> str:
    """Return the cause as it is printed with a verdict: nothing with one that does not fail."""
    if verdict not in FAILING:
        return ""
    return UNKNOWN if cause is None else str(cause)


def claims_without_cause(claims: pd.DataFrame) -> list[str]:
    """Return the names of failing claims whose cause is not known; claims: table of verdicts."""
    causes = claims["cause"] if "cause" in claims else pd.Series("", claims.index)
    unknown = causes.fillna("").isin(["", UNKNOWN])
    return claims.claim[claims.verdict.isin(FAILING) & unknown].tolist()
