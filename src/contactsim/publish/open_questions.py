"""What stays open, in sentences: statements that are not decidable, and the cell of the probe."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from contactsim.analysis.candidate_shares import (
    DRAWN,
    SETS,
    holding_candidates,
    incompatible_pairs,
    statements_held,
)
from contactsim.analysis.verdict import NOT_DECIDABLE

MEASURES = {
    "the width w": {"width": 1},
    "h/w": {"thickness": 1, "width": -1},
    "h/l": {"thickness": 1, "lattice_constant": -1},
}
"""Measures of a cell in words, each with the exponents of its lengths."""


def undecided_text(claims: pd.DataFrame) -> Iterator[str]:
    """Yield a sentence that counts what is not decidable by what would decide it, where there is such a statement."""
    open_claims = claims[claims.verdict == NOT_DECIDABLE]
    if not len(open_claims):
        return
    is_line = open_claims.get("decided_over", pd.Series("", open_claims.index)) == "approaches"
    yield (
        f"Of the {len(open_claims)} statements that are not decidable, {(~is_line).sum()} want more members or a "
        f"finer grid, and {is_line.sum()} more onsets of sliding: a line through as few as the text has is not fixed.\n"
    )


def undetermined_text(candidates: pd.DataFrame) -> str:
    """Return what the statements tell about the cell, and what they do not; candidates: verdicts in all of them."""
    drawn = candidates[candidates.candidate.astype(str).str.fullmatch(DRAWN) & candidates[SETS[0]].astype(bool)]
    held = [holding_candidates(drawn, claim, SETS[0]) for claim in drawn.claim.unique()]
    held = [part for part in held if part.decided]
    in_all, in_none = sum(part.share == 1 for part in held), sum(part.share == 0 for part in held)
    cells = statements_held(drawn)
    best = cells.loc[cells.share.idxmax()]
    trends = [f"{_correlation(cells, powers):+.2f} with {words}" for words, powers in MEASURES.items()]
    pairs = [f"`{row.first}` and `{row.second}`" for row in incompatible_pairs(drawn).itertuples()]
    never = f" Each of two statements holds in some cells, and both in none: {_joined(pairs)}." if pairs else ""
    return (
        f"**The cell of the probe stays undetermined.** Of the {len(held)} statements that are decided in some of the "
        f"{len(cells)} cells, {in_all} hold in all cells that decide them and {in_none} in none, so that they tell "
        f"nothing about the cell; {len(held) - in_all - in_none} hold in some. No cell has all of them: at best "
        f"{best.holding} of {best.decided} hold. The share that holds goes with no length alone; over the cells its "
        f"correlation is {_joined(trends)} (logarithms).{never}\n"
    )


def _correlation(cells: pd.DataFrame, powers: dict[str, int]) -> float:
    """Return the correlation of the share that holds with the logarithm of a measure of the cell."""
    measure = sum(power * np.log(cells[name]) for name, power in powers.items())
    return float(np.corrcoef(measure, cells.share)[0, 1])


def _joined(parts: Sequence[str]) -> str:
    """Return several parts as a list in a sentence."""
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)
