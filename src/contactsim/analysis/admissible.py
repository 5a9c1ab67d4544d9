"""The fifth verdict: a statement that holds with one admissible reading of the text and fails with another."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from contactsim.analysis.candidate_shares import SETS, holding_candidates
from contactsim.analysis.uncertainty import NAN
from contactsim.analysis.verdict import DEPENDS, NOT_DECIDABLE, REPRODUCED

DEFAULT = "as judged"
"""Name of the reading of the claim itself."""
BANDS = ("verdict", "verdict_half", "verdict_double")
"""Entries of a row with a verdict, one for each width of the bands."""
CANDIDATE_COLUMNS = ("candidate", "claim", *BANDS, "value", "margin", *SETS)
"""Columns that a table of sets of parameters needs, each with its verdicts."""


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


def choice_entries(row: Mapping, choices: Sequence[Choice], candidates: Sequence[Choice] = ()) -> dict[str, object]:
    """Return the entries of a row of verdicts that its admissible readings and sets of parameters change or add.

    Parameters
    ----------
    row
        Row of the claim with its default reading.
    choices
        The other readings; none leave the verdict as it is.
    candidates
        Admitted sets of parameters. They enter the verdict, and not the share of the readings.
    """
    if not choices and not candidates:
        return {"default_verdict": "", "choices_decided": NAN, "choices_share": NAN, "choices": ""}
    others = (*choices, *candidates)
    verdicts = {
        name: joint_verdict(str(row[name]), [getattr(choice, name) or choice.verdict for choice in others])
        for name in BANDS
    }
    added = verdicts | {"default_verdict": row["verdict"]}
    if not choices:
        return added | {"choices_decided": NAN, "choices_share": NAN, "choices": ""}
    default = Choice.of(DEFAULT, row)
    decided, share = holding_share(choice.verdict for choice in (default, *choices))
    table = [asdict(choice) for choice in (default, *choices)]
    return added | {"choices_decided": decided, "choices_share": share, "choices": json.dumps(table)}


def read_candidates(file: str | Path | None) -> pd.DataFrame:
    """Return the verdicts of sets of parameters that the text leaves open; empty without a file."""
    return pd.DataFrame(columns=list(CANDIDATE_COLUMNS)) if file is None else pd.read_csv(file, comment="#")


def candidate_choices(candidates: pd.DataFrame, claim: str) -> list[Choice]:
    """Return the admitted candidates as readings of a claim; candidates: of `read_candidates`."""
    rows = candidates[(candidates.claim == claim) & candidates[SETS[0]].astype(bool)]
    return [Choice.of(str(row["candidate"]), row) for row in rows.to_dict("records")]


def candidate_entries(candidates: pd.DataFrame, claim: str) -> dict[str, object]:
    """Return the shares of the candidates of each set in which a claim holds, with their errors; NaN without any."""
    entries: dict[str, object] = {}
    for group in SETS:
        held = holding_candidates(candidates, claim, group)
        numbers = {"decided": held.decided or NAN, "share": held.share, "error": held.error}
        entries |= {f"{group}_{name}": number for name, number in numbers.items()}
    return entries


def choices_table(claims: pd.DataFrame) -> pd.DataFrame:
    """Return one row for each claim and each of its admissible readings; claims: table of verdicts."""
    texts = claims.get("choices", pd.Series(dtype=str)).dropna()
    rows = [
        {"claim": claims.claim[place]} | entry for place, text in texts.items() if text for entry in json.loads(text)
    ]
    return pd.DataFrame(rows, columns=["claim", *Choice.__dataclass_fields__])
