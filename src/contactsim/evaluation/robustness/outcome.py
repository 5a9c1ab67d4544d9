"""The outcome of one solver on one case, the work it took, and the reason."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Outcome(Enum):
    """The outcome of a solver on a case: the number is stored, the sentence explains it."""

    EXACT = (0, "exact: the exact answer is met")
    CERTIFIED = (1, "certified: the residual is met, no exact answer is known")
    REFUSED = (2, "refused, with a reason")
    FAILED = (3, "honest failure: the status says so")
    WRONG = (4, "wrong")
    NON_FINITE = (5, "not finite")


@dataclass(frozen=True)
class Verdict:
    """Outcome of one solver on one case, the work it took, and the reason where it did not solve the case."""

    outcome: Outcome
    transforms: float
    reason: str = ""
