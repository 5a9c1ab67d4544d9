"""Pages on the verdicts: all statements by chapter with causes of failures, and what changed since an earlier state."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from pathlib import Path

import pandas as pd

from contactsim.analysis.admissible import choices_table, read_candidates
from contactsim.analysis.candidate_shares import FILE
from contactsim.analysis.causes import FAILING, UNKNOWN
from contactsim.analysis.quantities import SECOND_ESTIMATORS
from contactsim.analysis.rounding import ABSENT, is_order, number_text, short_number
from contactsim.analysis.verdict import FINDING, NOT_DECIDABLE
from contactsim.analysis.wording import candidates_text, extreme_text, measure_text, printed, readings_text
from contactsim.publish.gallery import counts_markdown
from contactsim.publish.markdown import plain_words, table
from contactsim.publish.open_questions import undecided_text, undetermined_text

HEADS = ("statement", "reading", "allowed", "value ± errors", "verdict", "margin", "place", "half; double band")
ESTIMATOR_HEADS = ("statement", "as in the thesis", "verdict (margin)", "corrected", "verdict (margin)", "counted")
EDGE_NOTE, EDGE_WIDTH = "at the edge of the band", 0.1
"""Note at a verdict whose place is near 1, and how near."""
INTRODUCTION = """# Verdicts on the statements of the thesis

Each row is a sentence of the thesis, held against our own data; [the rules](judging.md)
stand on a page of their own, and [all numbers](gallery/verdicts.csv) in a table. The
data are those of the standard tier: `make all`, `make gallery` and `python docs/renew.py` make this page again.

- *Statement*: with its place in the thesis, and its name in the table and in `config/`.
- *Reading*: the number that we compute for the sentence, and the study that gives it: `make rough_line` makes the
  data of the study `rough_line`, whose settings stand in `config/`. Of several cases the worst one counts; it is named.
- *Allowed*: the band of values that agree with the sentence, and why that band.
- *Value ± errors*: the number, its ensemble error (one standard error over random surfaces) and that of grid,
  increments, jumps and approaches together, rounded to two digits of both. *None*: there is no such error; *not
  known*: there is one, and nobody knows it; *exact*: a formula. For an order the worst step over its error. Under the
  least or largest of single values stands where it lies, and the share of all loads and variants in the band.
- *Margin*: the distance to the edge of the band in errors. Below 2 there is no verdict: *not decidable*.
- *Place*: 0 at the value stated, 1 at the edge of the band. Near 1 the choice of the band decides; the verdict says so.
- *Half; double band*: the verdicts with bands of half and of twice the width, where one differs.
- *Reproduced with a condition*: it fails on the whole selection and holds on the part that is named.
- *Depends on what the text leaves open*: it holds with one admissible reading of the text and fails with another.

Statements that fail stand again under the table, with the cause as far as it is known.
"""
ESTIMATORS = """### Chapter {}: both estimators

Counted points and the gradient of Eq. 3.8, as in the thesis, and the corrected area and gradient.
"""


def verdict_page(claims: pd.DataFrame) -> str:
    """Return all statements as a Markdown page: counts, tables and causes by chapter, findings, open choices.

    claims: table of verdicts with a column of chapters, of `contactsim.publish.gallery.read_verdicts`
    """
    parts = [INTRODUCTION, counts_markdown(claims), *undecided_text(claims)]
    for chapter, rows in claims[claims.verdict != FINDING].groupby("chapter", sort=True):
        parts += _chapter_parts(str(chapter).removeprefix("ch"), rows)
    findings = claims[claims.verdict == FINDING].to_dict("records")
    if findings:
        parts += ["## Findings\n", "Numbers that no sentence of the thesis states.\n"]
        parts.append(table(("number", "reading", "value ± errors"), map(_finding_cells, findings)))
    if choices := list(_choice_rows(claims)):
        heads = ("statement", "choice", "value ± errors", "verdict", "margin")
        parts += ["## What the text leaves open\n", undetermined_text(read_candidates(FILE)), table(heads, choices)]
    return "\n".join(parts)


def changes_page(before: pd.DataFrame, claims: pd.DataFrame, reasons: pd.DataFrame) -> str:
    """Return a Markdown page with each statement's verdict before and now, and why it changed.

    Parameters
    ----------
    before
        Earlier verdicts: claim, verdict, and the statement of a claim that is gone.
    claims
        Table of verdicts.
    reasons
        What changed a verdict, by claim; several rows of a claim are joined.
    """
    earlier, now = before.set_index("claim").verdict, claims.set_index("claim").verdict
    texts = reasons.groupby("claim", sort=False).reason.agg("; ".join)
    statements = before.set_index("claim").get("statement", pd.Series(dtype=str)).dropna().to_dict()
    statements |= claims.set_index("claim").statement.map(lambda text: printed(plain_words(text))).to_dict()
    names = [*now.index, *earlier.index.difference(now.index, sort=False)]
    margins = claims.set_index("claim").margin.map(short_number)
    rows = [
        (
            statements.get(name, name),
            earlier.get(name, ABSENT),
            now.get(name, ABSENT),
            margins.get(name, ABSENT),
            texts.get(name, "reason not yet given"),
        )
        for name in names
    ]
    changed = [row for row in rows if ABSENT != row[1] != row[2]]
    new = [(row[0], *row[2:4]) for row in rows if row[1] == ABSENT]
    same = [(*row[:2], row[3]) for row in rows if row[1] == row[2]]
    introduction = (
        "# Verdicts before and now\n\nBefore: one error decided, the number of the grid was taken as it was, and "
        "unknown states were dropped. Now: the rules of [how statements are judged](judging.md). A dash: no such "
        "statement any more, or a finding, which has no margin. Margins are in errors. "
        f"Of {len(rows) - len(new)} statements and findings {len(changed)} have another verdict or "
        f"are gone; {len(new)} are new.\n"
    )
    heads = ("statement", "before", "now", "margin", "what changed it")
    parts = [introduction, "## Changed\n", table(heads, changed), "## New\n"]
    parts += ["Sentences that nothing judged before, and findings.\n", table(("statement", "now", "margin"), new)]
    return "\n".join([*parts, "## As before\n", table(("statement", "verdict", "margin"), same)])


def write_verdict_pages(folder: Path) -> None:
    """Write both pages into the folder of documents, from the tables of verdicts and of changes in it."""
    claims = pd.read_csv(folder / "gallery/verdicts.csv")
    before, reasons = (pd.read_csv(folder / f"verdict_{name}.csv") for name in ("before", "reasons"))
    (folder / "verdicts.md").write_text(verdict_page(claims), encoding="utf-8")
    (folder / "verdict_changes.md").write_text(changes_page(before, claims, reasons), encoding="utf-8")


def _chapter_parts(number: str, rows: pd.DataFrame) -> list[str]:
    """Return the parts of a chapter: its statements, those of two estimators, and blocks on those that fail."""
    parts = [f"## Chapter {number}\n", table(HEADS, map(_statement_cells, rows.to_dict("records")))]
    if estimators := [_estimator_cells(row) for row in rows.to_dict("records") if _text(row, "beside")]:
        parts += [ESTIMATORS.format(number), table(ESTIMATOR_HEADS, estimators)]
    if failing := rows[rows.verdict.isin(FAILING)].to_dict("records"):
        parts += [f"### Chapter {number}: what fails, depends or is not decidable\n", *map(_failure_text, failing)]
    return parts


def _statement_cells(row: Mapping) -> tuple[str, ...]:
    """Return the cells of a statement."""
    return (
        _statement_text(row),
        _with_note(_reading_text(row), _text(row, "data")),
        _with_note(_band_text(row), _band_reason(row)),
        _with_note(number_text(row), extreme_text(row)),
        _with_note(row["verdict"], EDGE_NOTE if _is_at_edge(row) else ""),
        *(short_number(float(row.get(name, float("nan")))) for name in ("margin", "place")),
        _other_bands_text(row),
    )


def _estimator_cells(row: Mapping) -> tuple[str, ...]:
    """Return the cells of a statement with two estimators; the one that is beside is not counted."""
    rows = ("beside_", "") if _text(row, "beside") not in SECOND_ESTIMATORS else ("", "beside_")
    cells = [(number_text(row, prefix), _verdict_text(row, prefix)) for prefix in rows]
    counted = ("as in the thesis", "corrected")[rows.index("")]
    return (printed(_text(row, "statement")), *itertools.chain(*cells), counted)


def _finding_cells(row: Mapping) -> tuple[str, ...]:
    """Return the cells of a finding."""
    return _statement_text(row), _reading_text(row), number_text(row)


def _choice_rows(claims: pd.DataFrame) -> Iterable[tuple[str, ...]]:
    """Yield the cells of all admissible readings; the statement stands with the first of its own."""
    by_name = claims.set_index("claim")
    for name, rows in choices_table(claims).groupby("claim", sort=False):
        statement = printed(plain_words(str(by_name.statement[name])))
        for row in rows.to_dict("records"):
            number = number_text(row | {"measure": by_name.measure[name]})
            yield statement, plain_words(row["choice"]), number, row["verdict"], short_number(float(row["margin"]))
            statement = ""


def _failure_text(row: Mapping) -> str:
    """Return the block on a statement that fails: where it holds, cases, readings, other bands, and its cause."""
    lines = [f"Found {number_text(row)}, allowed {_band_text(row)}; margin {short_number(float(row['margin']))}."]
    if condition := _text(row, "condition"):
        there = "" if is_order(row) else f": {number_text(row, 'condition_')}"
        lines.append(f"Holds for {condition} ({row['condition_share']:.0%} of all){there}.")
    lines += [f"{label}: {_text(row, name)}." for name, label in TEXTS.items() if _text(row, name)]
    default = _text(row, "default_verdict")
    readings = [text for text in (readings_text(row), candidates_text(row)) if text]
    lines += [f"{text[0].upper()}{text[1:]}." for text in readings]
    lines += [f"By the reading of the claim itself: {default}."] * (default not in ("", row["verdict"]))
    if bands := _other_bands_text(row):
        lines.append(f"With half the band; with double: {bands}.")
    cause = printed(_text(row, "cause") or UNKNOWN)
    lines.append(f"{cause[0].upper()}{cause[1:].rstrip('.')}.")
    head = f"**{printed(_text(row, 'statement'))}** {row['verdict'].capitalize()} ({_text(row, 'source')})."
    return "\n".join([head, "", *(f"- {line}" for line in lines), ""])


TEXTS = {
    "cases": "Cases",
    "deciding_case": "The case that decides",
    "unknown": "Unknown",
    "decided_with": "What would decide",
}
"""Texts of a row that stand in its block, with what they are called there."""


def _statement_text(row: Mapping) -> str:
    """Return a statement with its place in the thesis and its name."""
    place, name = _text(row, "source"), _text(row, "claim")
    return _with_note(printed(_text(row, "statement")), f"{place} · `{name}`" if name else place)


def _is_at_edge(row: Mapping) -> bool:
    """Return True if a decided number lies so near the edge of its band that another band would decide otherwise."""
    return row["verdict"] != NOT_DECIDABLE and abs(float(row.get("place", float("nan"))) - 1) <= EDGE_WIDTH


def _reading_text(row: Mapping) -> str:
    """Return what is computed for a statement, and the case that decides where there are several."""
    case = _text(row, "deciding_case")
    return measure_text(_text(row, "measure")) + (f": {case}" if case else "")


def _band_text(row: Mapping) -> str:
    """Return the band of a statement."""
    return "each step" if is_order(row) else _text(row, "expected")


def _band_reason(row: Mapping) -> str:
    """Return the reason for a band, whole: it says what was known when the band was set."""
    return printed(_text(row, "rationale"))


def _verdict_text(row: Mapping, prefix: str) -> str:
    """Return the verdict of one of both estimators with its margin."""
    return f"{_text(row, f'{prefix}verdict')} ({short_number(float(row[f'{prefix}margin']))})"


def _other_bands_text(row: Mapping) -> str:
    """Return the verdicts with half and double bands; nothing where both are that of the whole band."""
    verdicts = [_text(row, f"verdict_{name}") for name in ("half", "double")]
    return "" if set(verdicts) <= {row["verdict"], ""} else "; ".join(verdicts)


def _with_note(text: str, note: str) -> str:
    """Return the text of a cell with a note in small letters under it."""
    return f"{text}<br><sub>{note}</sub>" if note else text


def _text(row: Mapping, name: str) -> str:
    """Return the words of an entry; nothing where there is none."""
    value = row.get(name)
    return plain_words(value) if isinstance(value, str) else ""
