"""What can come of a case: the outcome of one solver on it, what it took, and why."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Outcome(Enum):
    """What came of a case; the number is stored, the sentence explains it."""

    RIGHT = (0, "right: the exact answer is met")
    CERTIFIED = (1, "certified: the residual is met, no exact answer is known")
    REFUSED = (2, "refused, with a reason")
    FAILED = (3, "honest failure: the status says so")
    WRONG = (4, "wrong")
    NON_FINITE = (5, "not finite")


@dataclass(frozen=True)
class Verdict:
    """Outcome of one solver on one case, the work it took, and the reason of anything but success."""

    outcome: Outcome
    transforms: float
    reason: str = ""
