"""Gallery: all figures on one page, each with verdicts on statements about it, errors and costs.

A statement belongs to the figures and tables that its source names. Errors and costs are those of the datasets that a
figure shows; nothing here is typed twice.
"""

from __future__ import annotations

import html
import re
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from PIL import Image

from contactsim import dataset
from contactsim.analysis.admissible import choices_table
from contactsim.analysis.claims import SCALES
from contactsim.analysis.dataset_summary import error_texts
from contactsim.analysis.deciding import Effort, deciding_text
from contactsim.analysis.verdict import CONDITION, DEPENDS, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED
from contactsim.analysis.wording import printed
from contactsim.code_digest import source_digest
from contactsim.durations import duration_text
from contactsim.provenance import digest
from contactsim.publish.pictures import reduce_colours
from contactsim.study.plan import Plan

VERDICTS = (REPRODUCED, CONDITION, DEPENDS, NOT_REPRODUCED, NOT_DECIDABLE)
COLUMNS = 3
"""Pictures side by side."""
WIDTH = 1200
"""Width of a picture in pixels."""
FIGURE_LABELS = re.compile(r"(Fig|Table)s?\.? ((?:\d\.\d+[a-d]?(?:, | and )?)+)")
"""Figures and tables in the source of a statement."""


@dataclass(frozen=True)
class Entry:
    """One figure: name, title, caption, the studies whose data it shows, and the digest of all that they depend on."""

    name: str
    title: str
    caption: str
    studies: tuple[str, ...]
    data: str


def figure_entries(plan: Plan) -> dict[str, list[Entry]]:
    """Return the figures of each chapter in the order of the config."""
    entries: dict[str, list[Entry]] = {}
    for name, figure in plan.figures.items():
        data = plan.figure_settings(name)["data"]
        title, caption = printed(figure.settings["title"]), printed(figure.settings["caption"])
        entry = Entry(name, title, caption, tuple(figure.studies), data)
        entries.setdefault(figure.chapter, []).append(entry)
    return entries


def figures_in_source(source: str) -> set[str]:
    """Return the names of the figures and tables in the source of a claim."""
    labels = [
        (kind, number) for kind, numbers in FIGURE_LABELS.findall(source) for number in re.findall(r"\d\.\d+", numbers)
    ]
    return {f"{kind.lower()}_{number.replace('.', '_')}" for kind, number in labels}


def read_verdicts(folder: Path, chapters: Sequence[str]) -> pd.DataFrame:
    """Return all claims with their verdicts; the first column is the chapter."""
    tables = [pd.DataFrame(columns=["chapter", "source", "verdict"])]
    tables += [pd.read_csv(folder / "claims" / f"{chapter}.csv").assign(chapter=chapter) for chapter in chapters]
    claims = pd.concat(tables[1:] or tables, ignore_index=True)
    return claims[["chapter", *claims.columns.drop("chapter")]]


def decide_with(plan: Plan, folder: Path, claims: pd.DataFrame) -> pd.Series:
    """Return in words what would decide each claim that is not decidable, with its cost; empty for all others.

    plan, folder, claims: as in `gallery_table`.
    """
    texts = pd.Series("", claims.index)
    for place, row in claims[claims.verdict == NOT_DECIDABLE].iterrows():
        if study := row["deciding_study"]:
            costs = pd.read_csv(folder / "costs" / f"{plan.dataset_name(study)}.csv")
            texts[place] = deciding_text(row, Effort.of_costs(costs))
    return texts


def claims_of_figure(claims: pd.DataFrame, name: str) -> pd.DataFrame:
    """Return the claims whose source names a figure or table."""
    return claims[claims["source"].map(lambda source: name in figures_in_source(source)).astype(bool)]


def count_verdicts(claims: pd.DataFrame) -> dict[str, int]:
    """Return the number of claims with each verdict."""
    return {verdict: int((claims.verdict == verdict).sum()) for verdict in VERDICTS}


def gallery_table(plan: Plan, folder: Path, claims: pd.DataFrame, others: Mapping[str, str]) -> pd.DataFrame:
    """Return one row a figure: chapter, title, numbers of verdicts, errors, CPU seconds and digest of its data.

    Parameters
    ----------
    plan : of the tier
    folder : of the tier's results
    claims : all claims, of `read_verdicts`
    others : titles, by name, of the figures that belong to no chapter; they have no further columns

    Notes
    -----
    Errors are those of the first study of a figure.
    """
    rows = []
    for chapter, entries in figure_entries(plan).items():
        for entry in entries:
            paths = [plan.dataset_name(study) for study in entry.studies]
            errors = error_texts(dataset.load_dataset(folder / "datasets" / f"{paths[0]}.nc")) if paths else []
            seconds = sum(pd.read_csv(folder / "costs" / f"{path}.csv").seconds.sum() for path in paths)
            place = {"chapter": chapter, "figure": entry.name, "title": entry.title}
            counts = count_verdicts(claims_of_figure(claims, entry.name))
            rows.append(
                place | counts | {"errors": "; ".join(errors), "seconds": round(seconds, 1), "data": entry.data}
            )
    rows += [{"chapter": "", "figure": name, "title": title} for name, title in others.items()]
    return pd.DataFrame(rows)


def gallery_page(rows: pd.DataFrame) -> str:
    """Return the gallery as Markdown: pictures side by side, below each its verdicts, errors and run time.

    rows: of `gallery_table`; the small pictures lie beside the page.
    """
    cells = [_cell(row) for row in rows.to_dict("records")]
    lines = [cells[place : place + COLUMNS] for place in range(0, len(cells), COLUMNS)]
    return "\n".join(["<table>", *(f"<tr>{''.join(line)}</tr>" for line in lines), "</table>"]) + "\n"


def counts_markdown(claims: pd.DataFrame) -> str:
    """Return the numbers of verdicts by chapter, and with half and double bands, as a Markdown table.

    claims: of `read_verdicts`
    """
    lines = [f"| chapter | {' | '.join(VERDICTS)} |", "|---" * (len(VERDICTS) + 1) + "|"]
    for chapter, part in [*claims.groupby("chapter"), ("all", claims)]:
        cells = map(str, count_verdicts(part).values())
        lines.append(f"| {str(chapter).removeprefix('ch')} | {' | '.join(cells)} |")
    for name in SCALES:
        counts = count_verdicts(claims.assign(verdict=claims.get(f"verdict_{name}", claims.verdict)))
        lines.append(f"| all, {name} bands | {' | '.join(map(str, counts.values()))} |")
    return "\n".join(lines) + "\n"


def _cell(row: Mapping) -> str:
    """Return the cell of a figure."""
    name, title = row["figure"], html.escape(" ".join(row["title"].split()))
    counts = [f"{row[verdict]:.0f} {verdict}" for verdict in VERDICTS if row[verdict] > 0]
    lines = ["; ".join(counts)] * bool(counts)
    lines += [html.escape(str(row["errors"]))] * (isinstance(row["errors"], str) and row["errors"] != "")
    lines += [f"{duration_text(row['seconds'])} of CPU time"] if row["seconds"] > 0 else []
    picture = f'<a href="{name}.png"><img src="{name}.png" width="260" alt="{title}"></a>'
    width = f"{100 // COLUMNS}%"
    return f'<td width="{width}" valign="top">{picture}<br><b>{title}</b><br><sub>{"<br>".join(lines)}</sub></td>'


def gallery_settings(plan: Plan, others: Mapping[str, str]) -> dict:
    """Return the settings that the gallery depends on beside its files; others: as in `gallery_table`."""
    data = [plan.figure_settings(name) for name in plan.figures]
    data += [plan.claims_settings(chapter) for chapter in plan.claims]
    source = source_digest("contactsim.publish.gallery")
    return {"tier": plan.tier, "others": dict(others), "source": source, "data": digest(data)}


def write_gallery(plan: Plan, folder: Path, target: Path, others: Mapping[str, str]) -> None:
    """Write small pictures of all figures, the tables of figures and verdicts, and the page of figures to a folder.

    folder: of the tier's results; others: as in `gallery_table`.
    """
    shutil.rmtree(target, ignore_errors=True)  # a figure that is gone leaves no picture
    target.mkdir(parents=True)
    claims = read_verdicts(folder, list(plan.claims))
    claims = claims.assign(decided_with=decide_with(plan, folder, claims))
    rows = gallery_table(plan, folder, claims, others)
    for name in rows.figure:
        write_thumbnail(folder / "figures" / f"{name}.png", target / f"{name}.png")
    claims.to_csv(target / "verdicts.csv", index=False)
    choices_table(claims).to_csv(target / "choices.csv", index=False)
    (target / "gallery.md").write_text(gallery_page(rows), encoding="utf-8")
    (target / "counts.md").write_text(counts_markdown(claims), encoding="utf-8")
    rows.to_csv(target / "gallery.csv", index=False)  # last: with it the gallery is whole


def write_thumbnail(source: Path, target: Path, width: int = WIDTH) -> None:
    """Write a picture scaled to a width in pixels, in few colours."""
    with Image.open(source) as picture:
        height = round(picture.height * width / picture.width)
        scaled = picture.convert("RGB").resize((width, height), Image.Resampling.LANCZOS)
        reduce_colours(scaled, picture).save(target, optimize=True)
