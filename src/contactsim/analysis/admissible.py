"""The fifth verdict: a statement that holds with one admissible reading of the text and fails with another."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from contactsim.analysis.uncertainty import NAN
from contactsim.analysis.verdict import DEPENDS, NOT_DECIDABLE, REPRODUCED

DEFAULT = "as judged"
"""Name of the reading of the claim itself."""
BANDS = ("verdict", "verdict_half", "verdict_double")
"""Entries of a row with a verdict, one for each width of the bands."""
CANDIDATE_COLUMNS = ("candidate", "claim", "verdict", "value", "margin", "admitted")
"""Columns of a table of sets of parameters that the text admits, each with its verdicts."""


@dataclass(frozen=True)
class Choice:
    """One admissible reading with its number, margin and verdicts; those of other bands may be unknown ("")."""

    choice: str
    verdict: str
    verdict_half: str = ""
    verdict_double: str = ""
    value: float = NAN
    ensemble_error: float = NAN
    grid_error: float = NAN
    margin: float = NAN

    @classmethod
    def of(cls, name: str, row: Mapping) -> Choice:
        """Return the reading that a row of verdicts describes; what the row does not hold is unknown."""
        entries = {key: row[key] for key in cls.__dataclass_fields__ if key in row}
        return cls(**(entries | {"choice": name}))


def holding_share(verdicts: Iterable[str]) -> tuple[int, float]:
    """Return the number of decided verdicts, and the share of them that are reproduced; NaN without any."""
    decided = [verdict for verdict in verdicts if verdict not in ("", NOT_DECIDABLE)]
    share = float(np.mean([verdict == REPRODUCED for verdict in decided])) if decided else NAN
    return len(decided), share


def joint_verdict(default: str, others: Iterable[str]) -> str:
    """Return the verdict over all readings: that of the default, unless the statement holds with some and fails with
    others.
    """
    _, share = holding_share([default, *others])
    return DEPENDS if 0 < share < 1 else default


def choice_entries(row: Mapping, choices: Sequence[Choice]) -> dict[str, object]:
    """Return the entries of a row of verdicts that its admissible readings change or add.

    Parameters
    ----------
    row
        Row of the claim with its default reading.
    choices
        The other readings; none leave the verdict as it is.
    """
    if not choices:
        return {"default_verdict": "", "choices_decided": NAN, "choices_share": NAN, "choices": ""}
    default = Choice.of(DEFAULT, row)
    decided, share = holding_share(choice.verdict for choice in (default, *choices))
    verdicts = {
        name: joint_verdict(str(row[name]), [getattr(choice, name) or choice.verdict for choice in choices])
        for name in BANDS
    }
    table = [asdict(choice) for choice in (default, *choices)]
    added = {"default_verdict": row["verdict"], "choices_decided": decided, "choices_share": share}
    return verdicts | added | {"choices": json.dumps(table)}


def read_candidates(file: Path) -> pd.DataFrame:
    """Return the verdicts of sets of parameters that the text admits, computed elsewhere; empty without the file."""
    if not file.exists():
        return pd.DataFrame(columns=list(CANDIDATE_COLUMNS))
    return pd.read_csv(file)[list(CANDIDATE_COLUMNS)]


def candidate_choices(candidates: pd.DataFrame, claim: str) -> list[Choice]:
    """Return the admitted candidates as readings of a claim; candidates: of `read_candidates`."""
    rows = candidates[(candidates.claim == claim) & candidates.admitted.astype(bool)]
    return [Choice.of(str(row["candidate"]), row) for row in rows.to_dict("records")]


def choices_table(claims: pd.DataFrame) -> pd.DataFrame:
    """Return one row for each claim and each of its admissible readings; claims: table of verdicts."""
    texts = claims.get("choices", pd.Series(dtype=str)).dropna()
    rows = [
        {"claim": claims.claim[place]} | entry for place, text in texts.items() if text for entry in json.loads(text)
    ]
    return pd.DataFrame(rows, columns=["claim", *Choice.__dataclass_fields__])
