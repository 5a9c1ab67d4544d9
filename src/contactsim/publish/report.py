"""Report of a tier on one HTML page: verdicts, figures, accuracy versus cost, robustness and effects.

A template is filled with the results: claims with their verdicts, pictures, grids and errors of the datasets, and costs
of the runs. Pictures and scripts are part of the file, so it can be sent and opened anywhere.
"""

from __future__ import annotations

import math
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

import jinja2
import pandas as pd
from markupsafe import Markup

from contactsim.analysis.rounding import NUMBERS, number_cells, number_text
from contactsim.analysis.verdict import FINDING, NOT_DECIDABLE
from contactsim.analysis.wording import beside_text, choices_text, measure_text, printed
from contactsim.code_digest import source_digest
from contactsim.evaluation.figure_settings import FigureSettings
from contactsim.provenance import digest, versions
from contactsim.publish import gallery
from contactsim.publish.gallery import VERDICTS, Entry, figures_in_source
from contactsim.publish.page_pictures import Picture, figure_picture, film_picture
from contactsim.publish.page_studies import PageStudy, page_study
from contactsim.study.figure_plan import PICTURE_ENDINGS
from contactsim.study.plan import Plan

PAGE = Path(__file__).with_name("page")
"""Folder of the template and of what it takes in."""
TEMPLATE = "report.html"
SCRIPTS = "vendor/panzoom.min.js", "vendor/sortable.min.js", "vendor/sortable.a11y.min.js", "report.js"
ASSETS = "report.css", "stages.svg", *SCRIPTS
WISHES = {"accuracy": "What accuracy costs", "stability": "How hard cases end", "effects": "What an effect costs"}
"""Groups of figures whose first stands on the front page, and the words beside it."""
MARKS = dict(zip(VERDICTS, ("yes", "condition", "depends", "no", "open"), strict=True))
"""Classes of the verdicts in the style sheet."""
FILE_WORDS = {"png": "PNG", "pdf": "PDF", "svg": "SVG", "csv": "numbers (CSV)", "gif": "film (GIF)"}
"""Words for the files of a figure, by their endings."""
ROW_MARKS = MARKS | {FINDING: "finding"}
"""Classes of the rows of statements and findings."""


@dataclass(frozen=True)
class PageFigure:
    """A figure of the page: its entry, picture, number of claims with each verdict, endings of its files, and film."""

    entry: Entry
    picture: Picture
    verdicts: dict[str, int]
    endings: tuple[str, ...]
    film: Picture | None


def report_settings(plan: Plan, others: Mapping[str, Mapping[str, FigureSettings]]) -> dict:
    """Return the settings that the page depends on beside its files.

    others: settings of the figures that belong to no chapter, by group and name
    """
    data = [gallery.gallery_settings(plan, {}), {study: plan.study_settings(study) for study in plan.studies}]
    titles = {group: {name: _titled(figure) for name, figure in figures.items()} for group, figures in others.items()}
    source = digest(source_digest("contactsim.publish.report"), *map(_asset, (TEMPLATE, *ASSETS)))
    settings = {
        "tier": plan.tier,
        "others": titles,
        "order": {group: list(figures) for group, figures in titles.items()},
        "data": digest(data),
        "source": source,
    }
    tools = {name: metadata.version(name) for name in ("snakemake", "matplotlib", "pandas")}
    return settings | {"versions": {"Python": platform.python_version()} | versions() | tools}


def _titled(figure: FigureSettings) -> dict[str, str]:
    """Return title and caption of a figure."""
    return {"title": printed(figure.title), "caption": printed(figure.caption)}


def collect_results(plan: Plan, settings: Mapping, folder: Path) -> dict:
    """Return the contents of the page.

    Parameters
    ----------
    plan : of the tier
    settings : of `report_settings`
    folder : of the tier's results
    """
    claims = gallery.read_verdicts(folder, list(plan.claims))
    statements, chapters = _statements(claims, plan), _chapters(plan, folder, claims)
    studies, others = {name: page_study(plan, folder, name) for name in plan.studies}, _others(settings, folder)
    return {
        "tier": plan.tier,
        "seed": plan.seed,
        "data": settings["data"],
        "marks": MARKS,
        "row_marks": ROW_MARKS,
        "counts": _counts(claims),
        "statements": statements,
        "chapters": chapters,
        "studies": studies,
        "own": {_chapter(chapter): _studies_of(plan, chapter) for chapter in plan.chapters.values()},
        "others": others,
        "wishes": WISHES,
        "endings": PICTURE_ENDINGS,
        "file_words": FILE_WORDS,
        "entries": _search_entries(statements, chapters, studies, others),
        "versions": settings["versions"],
    }


def page_text(results: Mapping) -> str:
    """Return the page as HTML; results: of `collect_results`."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    assets = {name: Markup(_asset(name)) for name in ASSETS}
    return environment.from_string(_asset(TEMPLATE)).render(results, assets=assets, scripts=SCRIPTS)


def _asset(name: str) -> str:
    """Return the text of a file that the page is made of."""
    return (PAGE / name).read_text(encoding="utf-8")


def _chapter(name: str) -> str:
    """Return the title of a chapter."""
    return f"Chapter {name.removeprefix('ch')}"


def _studies_of(plan: Plan, chapter: str) -> list[str]:
    """Return the studies of a chapter."""
    return [study for study, chapter_of_study in plan.chapters.items() if chapter_of_study == chapter]


def _counts(claims: pd.DataFrame) -> dict[str, dict[str, int]]:
    """Return the number of claims with each verdict, by chapter and in all."""
    if claims.empty:
        return {}
    parts = {_chapter(chapter): part for chapter, part in claims.groupby("chapter")} | {"all": claims}
    return {name: gallery.count_verdicts(part) for name, part in parts.items()}


def _statements(claims: pd.DataFrame, plan: Plan) -> list[dict]:
    """Return the rows of the claims, with rounded numbers, figures, studies and the place on the page."""
    rows = []
    for row in claims.to_dict("records"):
        texts = {key: "" if isinstance(value, float) else value for key, value in row.items()}
        texts |= {name: row[name] for name in NUMBERS if math.isfinite(row[name])}
        texts["unknown"] = row["verdict"] == NOT_DECIDABLE and not math.isfinite(row["value"])
        texts["place"] = f"{row['chapter']}-{row['claim']}"
        texts |= dict(zip(("found", "ensemble", "grid"), number_cells(row), strict=True))
        texts["measure"] = measure_text(texts["measure"])
        if texts["condition"]:
            texts["there"] = number_text(row, "condition_")
        texts["readings"] = choices_text(row)
        texts["second_row"] = beside_text(row)
        texts["figures"] = sorted(figures_in_source(row["source"]) & set(plan.figures))
        texts["studies"] = plan.claims[row["chapter"]][row["claim"]].studies
        texts["typed"], texts["statement"] = texts["statement"], printed(texts["statement"])
        rows.append(texts)
    return rows


def _chapters(plan: Plan, folder: Path, claims: pd.DataFrame) -> dict[str, list[PageFigure]]:
    """Return the figures of each chapter."""
    chapters = {}
    for chapter, entries in gallery.figure_entries(plan).items():
        figures = []
        for entry in entries:
            verdicts = gallery.count_verdicts(gallery.claims_of_figure(claims, entry.name))
            picture, endings = figure_picture(folder, entry.name), plan.figures[entry.name].endings
            film = film_picture(folder, entry.name) if "gif" in endings else None
            figures.append(PageFigure(entry, picture, verdicts, endings, film))
        chapters[_chapter(chapter)] = figures
    return chapters


def _others(settings: Mapping, folder: Path) -> dict[str, list[dict]]:
    """Return the figures that belong to no chapter, by group."""
    return {
        group: [
            {"name": name, "picture": figure_picture(folder, name), **settings["others"][group][name]} for name in names
        ]
        for group, names in settings["order"].items()
        if names
    }


def _search_entries(
    statements: list[dict],
    chapters: Mapping[str, list[PageFigure]],
    studies: Mapping[str, PageStudy],
    others: Mapping[str, list[dict]],
) -> list[dict[str, str]]:
    """Return what can be searched: kind, title, further text and place on the page."""
    figures = [figure.entry for figures_of_chapter in chapters.values() for figure in figures_of_chapter]
    entries = [_search_entry("figure", entry.title, f"{entry.name} {entry.caption}", entry.name) for entry in figures]
    for group in others.values():
        for figure in group:
            words = f"{figure['name']} {figure['caption']}"
            entries.append(_search_entry("figure", figure["title"], words, figure["name"]))
    for row in statements:
        kind, words = (
            f"statement, {row['source']}: {row['verdict']}",
            f"{row['source']} {row['verdict']} {row['measure']}",
        )
        entries.append(_search_entry(kind, row["statement"], f"{words} {row['typed']}", row["place"]))
    return entries + [_search_entry("study", study.title, name, f"study-{name}") for name, study in studies.items()]


def _search_entry(kind: str, title: str, more: str, place: str) -> dict[str, str]:
    """Return what the search knows of a part of the page."""
    return {"kind": kind, "title": title, "more": more, "place": place}
