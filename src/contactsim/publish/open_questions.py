"""What stays open, in sentences: statements that are not decidable, and the cell of the probe."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from contactsim.analysis.candidate_shares import DRAWN, SETS, incompatible_pairs, shares_table, statements_held
from contactsim.analysis.cell_rules import measure_logarithm
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
    shares = shares_table(drawn)[f"{SETS[0]}_share"].dropna()
    in_all, in_none = int((shares == 1).sum()), int((shares == 0).sum())
    cells = statements_held(drawn)
    best = cells.loc[cells.share.idxmax()]
    trends = [
        f"{np.corrcoef(measure_logarithm(cells, exponents), cells.share)[0, 1]:+.2f} with {words}"
        for words, exponents in MEASURES.items()
    ]
    pairs = [f"`{row.first}` and `{row.second}`" for row in incompatible_pairs(drawn).itertuples()]
    apart = f" Statements that each hold in some cells, and together in none: {'; '.join(pairs)}." if pairs else ""
    return (
        f"**The cell of the probe stays undetermined.** Of the {len(shares)} statements that are decided in some of "
        f"the {len(cells)} cells, {in_all} hold in all cells that decide them and {in_none} in none, so that they tell "
        f"nothing about the cell; {len(shares) - in_all - in_none} hold in some. No cell has all of them: at best "
        f"{best.holding} of {best.decided} hold. The share that holds goes with no length alone; over the cells its "
        f"correlation with the logarithm of a length or a ratio is {', '.join(trends)}.{apart}\n"
    )
