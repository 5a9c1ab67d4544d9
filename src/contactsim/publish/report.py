"""Report of a tier on one HTML page: verdicts, figures, accuracy versus cost, robustness and effects.

A template is filled with the results: claims with their verdicts, pictures, grids and errors of the datasets, and costs
of the runs. Pictures are part of the file, so it can be sent and opened anywhere.
"""

from __future__ import annotations

import base64
import io
import json
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

import jinja2
import matplotlib as mpl
import pandas as pd
import xarray as xr
from markupsafe import Markup
from matplotlib.figure import Figure
from PIL import Image

from contactsim import dataset
from contactsim.analysis.dataset_summary import dataset_summary
from contactsim.analysis.rounding import number_cells, number_text
from contactsim.analysis.verdict import FINDING
from contactsim.analysis.wording import beside_text, choices_text, measure_text, printed
from contactsim.code_digest.modules import source_digest
from contactsim.evaluation.figure_settings import FigureSettings
from contactsim.figures import style
from contactsim.figures.sketch import plot_sketch
from contactsim.provenance import digest, versions
from contactsim.publish import gallery
from contactsim.publish.gallery import VERDICTS, Entry, duration_text, figures_in_source
from contactsim.publish.pictures import reduce_colours
from contactsim.study.plan import Plan
from contactsim.study.scenes import build_setup

TEMPLATE, STAGES = Path(__file__).with_name("report.html"), Path(__file__).with_name("stages.svg")
SKETCH = (4.6, 2.9), 160
"""Size in inches and dots an inch of a sketch."""
PIXEL_RATIO = 2
"""Pixels of a picture for each pixel of the page, along one side."""
SECTION_POINTS = 2000
"""Points of a drawn section of a surface."""
MARKS = dict(zip(VERDICTS, ("yes", "condition", "depends", "no", "open"), strict=True))
"""Classes of the verdicts in the style sheet."""
ROW_MARKS = MARKS | {FINDING: "finding"}
"""Classes of the rows of statements and findings."""
HIDDEN_SETTINGS = ("name", "title", "tier", "seed")
"""Settings that stand elsewhere on the page."""


@dataclass(frozen=True)
class Picture:
    """A picture of the page: its bytes as a data URL, and its size on the page in pixels."""

    source: str
    width: int
    height: int


@dataclass(frozen=True)
class PageFigure:
    """A figure of the page: its entry, its picture, and the number of claims with each verdict."""

    entry: Entry
    picture: Picture
    verdicts: dict[str, int]


@dataclass(frozen=True)
class PageStudy:
    """A study of the page: title, summary of its dataset, cost, settings, and a sketch of its scene."""

    title: str
    summary: str
    cost: str
    settings: dict[str, str]
    sketch: Picture


def report_settings(plan: Plan, others: Mapping[str, Mapping[str, FigureSettings]]) -> dict:
    """Return the settings that the page depends on beside its files.

    others: settings of the figures that belong to no chapter, by group and name
    """
    data = [gallery.gallery_settings(plan, {}), {study: plan.study_settings(study) for study in plan.studies}]
    titles = {group: {name: _titled(figure) for name, figure in figures.items()} for group, figures in others.items()}
    texts = [file.read_text(encoding="utf-8") for file in (TEMPLATE, STAGES)]
    source = digest(source_digest("contactsim.publish.report"), *texts)
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
    return {"title": figure.title, "caption": figure.caption}


def collect_results(plan: Plan, settings: Mapping, folder: Path) -> dict:
    """Return the contents of the page.

    Parameters
    ----------
    plan : of the tier
    settings : of `report_settings`
    folder : of the tier's results
    """
    claims = gallery.read_verdicts(folder, list(plan.claims))
    return {
        "tier": plan.tier,
        "seed": plan.seed,
        "data": settings["data"],
        "marks": MARKS,
        "row_marks": ROW_MARKS,
        "counts": _counts(claims),
        "statements": _statements(claims, plan),
        "chapters": _chapters(plan, folder, claims),
        "studies": {name: _study(plan, folder, name) for name in plan.studies},
        "own": {_chapter(chapter): _studies_of(plan, chapter) for chapter in plan.chapters.values()},
        "others": _others(settings, folder),
        "versions": settings["versions"],
    }


def page_text(results: Mapping) -> str:
    """Return the page as HTML; results: of `collect_results`."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    page = environment.from_string(TEMPLATE.read_text(encoding="utf-8"))
    return page.render(results, stages=Markup(STAGES.read_text(encoding="utf-8")))


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
    """Return the rows of the claims, with rounded numbers, figures and studies."""
    rows = []
    for row in claims.to_dict("records"):
        texts = {key: "" if isinstance(value, float) else value for key, value in row.items()}
        texts |= dict(zip(("found", "ensemble", "grid"), number_cells(row), strict=True))
        texts["measure"] = measure_text(texts["measure"])
        if texts["condition"]:
            texts["there"] = number_text(row, "condition_")
        texts["readings"] = choices_text(row)
        texts["second_row"] = beside_text(row)
        texts["figures"] = sorted(figures_in_source(row["source"]) & set(plan.figures))
        texts["studies"] = plan.claims[row["chapter"]][row["claim"]].studies
        texts["statement"] = printed(texts["statement"])
        rows.append(texts)
    return rows


def _chapters(plan: Plan, folder: Path, claims: pd.DataFrame) -> dict[str, list[PageFigure]]:
    """Return the figures of each chapter."""
    chapters = {}
    for chapter, entries in gallery.figure_entries(plan).items():
        figures = []
        for entry in entries:
            verdicts = gallery.count_verdicts(gallery.claims_of_figure(claims, entry.name))
            figures.append(PageFigure(entry, _picture(folder, entry.name), verdicts))
        chapters[_chapter(chapter)] = figures
    return chapters


def _study(plan: Plan, folder: Path, name: str) -> PageStudy:
    """Return the part of the page about a study."""
    data = dataset.load_dataset(folder / "datasets" / f"{plan.dataset_name(name)}.nc")
    costs = pd.read_csv(folder / "costs" / f"{plan.dataset_name(name)}.csv")
    drawn_scene = _sketch(plan.studies[name].runs()[0].settings)
    return PageStudy(data.attrs["title"], dataset_summary(data, costs), _cost(costs), _settings(data), drawn_scene)


def _cost(costs: pd.DataFrame) -> str:
    """Return the cost of a study in words."""
    runs, transforms, memory = costs.run.nunique(), costs.transforms.sum(), costs.memory_mib.max()
    time = duration_text(costs.seconds.sum())
    return f"{runs} runs, {transforms:.3g} transforms, {time} of CPU time, at most {memory:.0f} MiB"


def _settings(data: xr.Dataset) -> dict[str, str]:
    """Return the settings of a dataset as text, without empty ones; long lists of loads are shortened."""
    settings = dataset.settings_of(data)
    if len(settings["load"]["values"]) > 20:
        values = settings["load"]["values"]
        settings["load"] |= {"values": f"{len(values)} from {values[0]:g} to {values[-1]:g}"}
    shown_settings = {
        key: value for key, value in settings.items() if key not in HIDDEN_SETTINGS and value not in (None, {}, [])
    }
    return {
        key: json.dumps(value, ensure_ascii=False).replace('"', "") for key, value in sorted(shown_settings.items())
    }


@mpl.rc_context(style.RC_PARAMS)
def _sketch(run: dict) -> Picture:
    """Return the sketch of a run's scene."""
    size, dots = SKETCH
    figure, file = Figure(figsize=size, layout="constrained"), io.BytesIO()
    setup = build_setup(run)
    scene = setup.scene
    surface = scene.upper.surface
    enough = max(SECTION_POINTS, 2 * (surface.modes or 0) + 2)  # of a large surface one section is drawn
    points = setup.points
    plot_sketch(scene, points if surface.points else min(points, enough), figure.subplots())
    figure.savefig(file, format="png", dpi=dots)
    return _embedded(file)


def _picture(folder: Path, name: str) -> Picture:
    """Return the picture of a figure."""
    return _embedded(folder / "figures" / f"{name}.png")


def _embedded(source: Path | io.BytesIO) -> Picture:
    """Return a picture for the page, reduced to few colours."""
    file = io.BytesIO()
    with Image.open(source) as picture:
        reduce_colours(picture.convert("RGB"), picture).save(file, format="png")
        width, height = picture.width // PIXEL_RATIO, picture.height // PIXEL_RATIO
    return Picture("data:image/png;base64," + base64.b64encode(file.getvalue()).decode(), width, height)


def _others(settings: Mapping, folder: Path) -> dict[str, list[dict]]:
    """Return the figures that belong to no chapter, by group."""
    return {
        group: [{"name": name, "picture": _picture(folder, name), **settings["others"][group][name]} for name in names]
        for group, names in settings["order"].items()
        if names
    }
