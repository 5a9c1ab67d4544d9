"""Pages on the verdicts: all statements by chapter with causes of failures, and what changed since an earlier state."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from contactsim.analysis.admissible import choices_table
from contactsim.analysis.causes import FAILING, UNKNOWN
from contactsim.analysis.verdict import FINDING
from contactsim.analysis.wording import choices_text, measure_text, printed, rounded_texts
from contactsim.publish.gallery import counts_markdown

NUMBERS = ("value", "ensemble_error", "grid_error")
HEADS = ("statement", "reading", "allowed", "value ± errors", "verdict", "margin", "place")
LARGE = 99
"""Margins above it are not told apart."""
ABSENT = "–"
INTRODUCTION = """# Verdicts on the statements of the thesis

Each row is a sentence of the thesis, held against our own data; [the rules](judging.md)
stand on a page of their own.

- *Reading*: the number that we compute for the sentence. *Allowed*: the band of values that agree with it.
- *Value ± errors*: the number, its ensemble error (one standard error over random surfaces) and its grid error.
  A dash: none, or not known. For statements of order the number is the worst step over its error.
- *Margin*: the distance to the edge of the band in errors. Below 2 there is no verdict: *not decidable*.
- *Place*: 0 at the value stated, 1 at the edge of the band. Near 1 our choice of the band decides.
- *Reproduced with a condition*: it fails on the whole selection and holds on the part named under the table.
- *Depends on what the text leaves open*: it holds with one admissible reading of the text and fails with another.

Statements that fail stand again under the table, with the cause as far as it is known.
"""


def verdict_page(claims: pd.DataFrame) -> str:
    """Return all statements as a Markdown page: counts, a table and causes by chapter, findings, open choices.

    claims: table of verdicts with a column of chapters, of `contactsim.publish.gallery.read_verdicts`
    """
    statements = claims[claims.verdict != FINDING]
    parts = [INTRODUCTION, counts_markdown(claims)]
    for chapter, rows in statements.groupby("chapter", sort=True):
        parts.append(f"## Chapter {str(chapter).removeprefix('ch')}\n")
        parts.append(_table(HEADS, map(_statement_cells, rows.to_dict("records"))))
        parts += [_failure_text(row) for row in rows[rows.verdict.isin(FAILING)].to_dict("records")]
    findings = claims[claims.verdict == FINDING].to_dict("records")
    if findings:
        cells = ((_text(row, "statement"), measure_text(_text(row, "measure")), _number_text(row)) for row in findings)
        parts += ["## Findings\n", "Numbers that no sentence of the thesis states.\n"]
        parts.append(_table(("number", "reading", "value ± errors"), cells))
    choices = choices_table(claims)
    if len(choices):
        readings = map(_choice_cells, choices.to_dict("records"))
        parts += [
            "## What the text leaves open\n",
            _table(("statement", "choice", "value ± errors", "verdict"), readings),
        ]
    return "\n".join(parts)


def changes_page(before: pd.DataFrame, claims: pd.DataFrame, reasons: pd.DataFrame) -> str:
    """Return a Markdown page with each statement's verdict before and now, and why it changed.

    Parameters
    ----------
    before
        Earlier verdicts: claim and verdict.
    claims
        Table of verdicts.
    reasons
        What changed a verdict, by claim; several rows of a claim are joined.
    """
    earlier, now = before.set_index("claim").verdict, claims.set_index("claim").verdict
    texts = reasons.groupby("claim", sort=False).reason.agg("; ".join)
    names = [*now.index, *earlier.index.difference(now.index, sort=False)]
    rows = [(name, earlier.get(name, ABSENT), now.get(name, ABSENT), texts.get(name, "")) for name in names]
    changed = [(*row[:3], row[3] or "reason not yet given") for row in rows if ABSENT != row[1] != row[2]]
    new = [(row[0], row[2]) for row in rows if row[1] == ABSENT]
    same = [row[:2] for row in rows if row[1] == row[2]]
    introduction = (
        "# Verdicts before and now\n\nBefore: one error decided, the number of the grid was taken as it was, and "
        "unknown states were dropped. Now: the rules of [how statements are judged](judging.md). A dash: no such "
        f"statement any more. Of {len(rows) - len(new)} statements and findings {len(changed)} have another verdict or "
        f"are gone; {len(new)} are new.\n"
    )
    parts = [introduction, "## Changed\n", _table(("statement", "before", "now", "what changed it"), changed)]
    parts += ["## New\n", "Sentences that nothing judged before, and findings.\n", _table(("statement", "now"), new)]
    return "\n".join([*parts, "## As before\n", _table(("statement", "verdict"), same)])


def write_verdict_pages(folder: Path) -> None:
    """Write both pages into the folder of documents, from the tables of verdicts and of changes in it."""
    claims = pd.read_csv(folder / "gallery/verdicts.csv")
    before, reasons = (pd.read_csv(folder / f"verdict_{name}.csv") for name in ("before", "reasons"))
    (folder / "verdicts.md").write_text(verdict_page(claims), encoding="utf-8")
    (folder / "verdict_changes.md").write_text(changes_page(before, claims, reasons), encoding="utf-8")


def _statement_cells(row: Mapping) -> tuple[str, ...]:
    """Return the cells of a statement."""
    margin, place = (row.get(name, np.nan) for name in ("margin", "place"))
    return (
        printed(_text(row, "statement")),
        measure_text(_text(row, "measure")),
        _text(row, "expected"),
        _number_text(row),
        row["verdict"],
        ABSENT if np.isnan(margin) else f"{margin:.2g}" if margin < LARGE else f"> {LARGE}",
        ABSENT if np.isnan(place) else f"{place:.2g}",
    )


def _choice_cells(row: Mapping) -> tuple[str, ...]:
    """Return the cells of an admissible reading."""
    return row["claim"], row["choice"], _number_text(row), row["verdict"]


def _failure_text(row: Mapping) -> str:
    """Return the paragraph on a statement that fails: condition, readings, unknown states, and its cause."""
    parts = [f"**{printed(_text(row, 'statement'))}** {row['verdict'].capitalize()}"]
    if condition := _text(row, "condition"):
        parts.append(f"holds for {condition} ({row['condition_share']:.0%} of all)")
    parts += [text for text in (choices_text(row),) if text]
    if unknown := _text(row, "unknown"):
        parts.append(f"unknown: {unknown}")
    cause = _text(row, "cause") or UNKNOWN
    return f"{'; '.join(parts)}. {cause[0].upper()}{cause[1:].rstrip('.')}.\n"


def _number_text(row: Mapping) -> str:
    """Return a number with its errors, rounded to them."""
    if np.isnan(row["value"]):
        return ABSENT
    return " ± ".join(rounded_texts(*(float(row[name]) for name in NUMBERS)))


def _text(row: Mapping, name: str) -> str:
    """Return the text of an entry; nothing where there is none."""
    value = row.get(name)
    return value if isinstance(value, str) else ""


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines) + "\n"
