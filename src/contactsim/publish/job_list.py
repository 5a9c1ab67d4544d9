"""The jobs behind results: a row for each result that stands behind others, from the seals of the workflow."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path

import pandas as pd

from contactsim.seals import read_seals, seal_path


def list_jobs(results: Path, places: Iterable[str]) -> pd.DataFrame:
    """Return a row for each sealed result at the places, and for each result from which these were made.

    Parameters
    ----------
    results : Path
        Folder of a tier's results.
    places : iterable of str
        Places below this folder.

    Returns
    -------
    Table with the columns `result`, its place, in alphabetical order; `rule`, which made it; `made_from`, the digest of
    settings and code; `inputs`, the places of the results that its job read, with spaces between them; `sha256`; and
    `ended`, when the job ended: in UTC, ISO 8601. A seal is written at the end of its job, so its time is that of the
    file.
    """
    seals, _ = read_seals(results)
    waiting, behind = list(places), set()
    while waiting:
        place = waiting.pop()
        if place in seals and place not in behind:
            behind.add(place)
            waiting.extend(seals[place].inputs)
    rows = [
        {
            "result": place,
            "rule": seals[place].rule,
            "made_from": seals[place].made_from,
            "inputs": " ".join(seals[place].inputs),
            "sha256": seals[place].outputs[place],
            "ended": _written(seal_path(results, place)),
        }
        for place in sorted(behind)
    ]
    return pd.DataFrame(rows)


def _written(path: Path) -> str:
    """Return when a file was written, to the second."""
    return datetime.fromtimestamp(int(path.stat().st_mtime), UTC).isoformat()
