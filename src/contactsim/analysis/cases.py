"""A statement about several cases: it holds if it holds in each, so the worst verdict counts, and it counts once."""

from __future__ import annotations

import math
from collections.abc import Mapping

from contactsim.analysis.admissible import BANDS
from contactsim.analysis.verdict import CONDITION, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED

WORST_FIRST = (NOT_REPRODUCED, NOT_DECIDABLE, CONDITION, REPRODUCED)
"""Verdicts on single cases, from the one that decides over all others on."""


def join_cases(rows: Mapping[str, Mapping[str, object]]) -> dict[str, object]:
    """Return the row of the worst case, with the worst verdict at each width of the bands.

    Parameters
    ----------
    rows
        Number, errors and verdict of each case by its name.

    Returns
    -------
    The row of the worst case, with `cases`: the verdicts on all of them in words, and `deciding_case`: the name of the
    worst. Both are empty for a single one.
    """
    worst = min(rows, key=lambda name: _badness(rows[name]))
    verdicts = {band: min((str(row[band]) for row in rows.values()), key=_rank) for band in BANDS}
    words = [f"{name}: {row['verdict']} ({row['value']:.3g})" for name, row in rows.items()]
    several = len(rows) > 1
    return {
        **rows[worst],
        **verdicts,
        "cases": "; ".join(words) if several else "",
        "deciding_case": worst if several else "",
    }


def _rank(verdict: str) -> int:
    """Return the place of a verdict, the worst first; a finding has none."""
    return WORST_FIRST.index(verdict) if verdict in WORST_FIRST else len(WORST_FIRST)


def _badness(row: Mapping) -> tuple[int, float]:
    """Return the order of rows, the worst first: by verdict, then by how sure the failure or unsure the success is."""
    margin = 0.0 if math.isnan(row["margin"]) else float(row["margin"])
    return _rank(row["verdict"]), -margin if row["verdict"] == NOT_REPRODUCED else margin
