"""Shares of the candidates in which a statement holds, with their errors, and statements that never hold together."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from contactsim.analysis.verdict import NOT_DECIDABLE, REPRODUCED

FILE = Path(__file__).with_name("candidates.csv")
"""The candidates of Chapter 6 with their verdicts, measured by `snakemake export_candidates`."""
SETS = ("admitted", "admitted_by_signs", "apart")
"""Columns that say whether a candidate belongs to a set; the last one is of those apart from their replicas."""
DRAWN = r"c\d+"
"""Names of the candidates that are drawn; the cells of studies have other names, and enter no share."""


@dataclass(frozen=True)
class HoldingShare:
    """Number of candidates in which a statement is decided, and in which it holds."""

    decided: int
    holding: int

    @property
    def share(self) -> float:
        """Share of the decided candidates in which it holds; NaN without any."""
        return self.holding / self.decided if self.decided else math.nan

    @property
    def error(self) -> float:
        """Binomial standard error of the share, by (k + 1)/(n + 2), so that it is not zero at the ends."""
        if not self.decided:
            return math.nan
        expected = (self.holding + 1) / (self.decided + 2)
        return math.sqrt(expected * (1 - expected) / self.decided)


def drawn_candidates(candidates: pd.DataFrame, claim: str, group: str) -> pd.DataFrame:
    """Return the rows of a claim in the drawn candidates of a set; arguments as of `holding_candidates`."""
    rows = candidates[(candidates.claim == claim) & candidates[group].astype(bool)]
    return rows[rows.candidate.astype(str).str.fullmatch(DRAWN).astype(bool)]


def holding_candidates(candidates: pd.DataFrame, claim: str, group: str) -> HoldingShare:
    """Return in how many drawn candidates of a set a statement holds.

    Parameters
    ----------
    candidates
        Verdicts in all candidates, one row for each candidate and claim.
    claim
        Name of the statement.
    group
        One of `SETS`.
    """
    verdicts = drawn_candidates(candidates, claim, group).verdict
    return HoldingShare(int((verdicts != NOT_DECIDABLE).sum()), int((verdicts == REPRODUCED).sum()))


def shares_table(candidates: pd.DataFrame) -> pd.DataFrame:
    """Return one row for each claim: decided, holding, share and error for each of `SETS`."""
    rows = []
    for claim in candidates.claim.unique():
        row: dict[str, object] = {"claim": claim}
        for group in SETS:
            share = holding_candidates(candidates, claim, group)
            numbers = {"decided": share.decided, "holding": share.holding, "share": share.share, "error": share.error}
            row |= {f"{group}_{name}": value for name, value in numbers.items()}
        rows.append(row)
    return pd.DataFrame(rows)


def _verdicts(candidates: pd.DataFrame) -> pd.DataFrame:
    """Return the verdicts with one row for each candidate and one column for each claim."""
    return candidates.set_index(["candidate", "claim"]).verdict.unstack("claim")  # noqa: PD010 (texts)


def holds_together(candidates: pd.DataFrame) -> pd.DataFrame:
    """Return in how many candidates two claims hold together, for all pairs; the diagonal counts single claims."""
    names = list(candidates.claim.unique())
    holds = (_verdicts(candidates) == REPRODUCED)[names].astype(int)
    return holds.T @ holds


def incompatible_pairs(candidates: pd.DataFrame) -> pd.DataFrame:
    """Return the pairs of claims that each hold in some candidate, and together in none, admitted or not.

    Columns: first, second, and the number of candidates in which both are decided (more than zero).
    """
    verdicts = _verdicts(candidates)
    holds, decided = verdicts == REPRODUCED, (verdicts != NOT_DECIDABLE) & verdicts.notna()
    names = [claim for claim in candidates.claim.unique() if holds[claim].any()]
    rows = [
        {"first": first, "second": second, "decided": int((decided[first] & decided[second]).sum())}
        for first, second in itertools.combinations(names, 2)
        if not (holds[first] & holds[second]).any()
    ]
    table = pd.DataFrame(rows, columns=["first", "second", "decided"])
    return table[table.decided > 0].reset_index(drop=True)


def statements_held(candidates: pd.DataFrame) -> pd.DataFrame:
    """Return one row for each candidate: cell, sets, numbers of decided statements and of those that hold."""
    marks = candidates.assign(decided=candidates.verdict != NOT_DECIDABLE, holding=candidates.verdict == REPRODUCED)
    cell = ["width", "thickness", "lattice_constant", *SETS]
    table = marks.groupby("candidate", sort=False).agg(
        dict.fromkeys(cell, "first") | {"decided": "sum", "holding": "sum"}
    )
    return table.reset_index().assign(share=lambda rows: rows.holding / rows.decided.where(rows.decided > 0))
