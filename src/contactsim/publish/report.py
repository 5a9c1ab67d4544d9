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
from contactsim.analysis.wording import dataset_summary, measure_text, printed, rounded_texts
from contactsim.figures import style
from contactsim.figures.sketch import plot_sketch
from contactsim.provenance import digest, source_digest, versions
from contactsim.publish import gallery
from contactsim.publish.gallery import VERDICTS, Entry, duration_text, figures_in_source
from contactsim.study.plan import Plan
from contactsim.study.scenes import build_setup

TEMPLATE, STAGES = Path(__file__).with_name("report.html"), Path(__file__).with_name("stages.svg")
SKETCH = (4.6, 2.9), 160
"""Size in inches and dots an inch of a sketch."""
COLOURS, FINE = 256, 2
"""Colours of a picture on the page, and how many of its pixels go into one of the page's."""
SECTION = 2000
"""Points that show a section of a surface."""
MARKS = dict(zip(VERDICTS, ("yes", "condition", "no", "open"), strict=True))
"""How a verdict is called in the style sheet."""
HIDDEN = ("name", "title", "tier", "seed")
"""Settings that a table of settings leaves out: they stand elsewhere."""


@dataclass(frozen=True)
class Picture:
    """A picture of the page: its bytes as a data URL, and its size on the page in pixels."""

    source: str
    width: int
    height: int


@dataclass(frozen=True)
class Shown:
    """A figure of the page: its entry, its picture, and the number of claims with each verdict."""

    entry: Entry
    picture: Picture
    verdicts: dict[str, int]


@dataclass(frozen=True)
class Solved:
    """A study of the page: title, summary of its dataset (`told`), cost, settings, and a sketch of its scene."""

    title: str
    told: str
    cost: str
    settings: dict[str, str]
    sketch: Picture


def report_settings(plan: Plan, others: Mapping[str, Mapping[str, Mapping]]) -> dict:
    """Return what the page depends on, beside the files that it shows.

    others: settings of the figures that belong to no chapter, by group and name
    """
    data = [gallery.gallery_settings(plan, {}), {study: plan.study_settings(study) for study in plan.studies}]
    shown = {group: {name: _titled(one) for name, one in figures.items()} for group, figures in others.items()}
    texts = [file.read_text(encoding="utf-8") for file in (TEMPLATE, STAGES)]
    source = digest(source_digest("contactsim.publish.report"), *texts)
    made = {"tier": plan.tier, "others": shown, "order": list(shown), "data": digest(data), "source": source}
    used = {name: metadata.version(name) for name in ("snakemake", "matplotlib", "pandas")}
    return made | {"versions": {"Python": platform.python_version()} | versions() | used}


def _titled(settings: Mapping) -> dict[str, str]:
    return {key: settings[key] for key in ("title", "caption")}


def collect_results(plan: Plan, settings: Mapping, folder: Path) -> dict:
    """Return all that the page shows.

    Parameters
    ----------
    plan : of the tier
    settings : of `report_settings`
    folder : of the tier's results
    """
    every = gallery.read_verdicts(folder, list(plan.claims))
    return {
        "tier": plan.tier,
        "seed": plan.seed,
        "data": settings["data"],
        "marks": MARKS,
        "counts": _counts(every),
        "statements": _statements(every, plan),
        "chapters": _chapters(plan, folder, every),
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
    return f"Chapter {name.removeprefix('ch')}"


def _studies_of(plan: Plan, chapter: str) -> list[str]:
    return [study for study, own in plan.chapters.items() if own == chapter]


def _counts(every: pd.DataFrame) -> dict[str, dict[str, int]]:
    """Return the number of claims with each verdict, by chapter and in all."""
    if every.empty:
        return {}
    parts = {_chapter(chapter): own for chapter, own in every.groupby("chapter")} | {"all": every}
    return {name: gallery.count_verdicts(own) for name, own in parts.items()}


def _statements(every: pd.DataFrame, plan: Plan) -> list[dict]:
    """Return the rows of the claims, with rounded numbers, figures and studies."""
    rows = []
    for row in every.to_dict("records"):
        numbers = ("value", "ensemble_error", "grid_error")
        texts = {key: "" if isinstance(value, float) else value for key, value in row.items()}
        texts |= dict(zip(("found", "ensemble", "grid"), rounded_texts(*(row[name] for name in numbers)), strict=True))
        texts["measure"] = measure_text(texts["measure"])
        if texts["condition"]:
            texts["there"] = " ± ".join(rounded_texts(*(row[f"condition_{name}"] for name in numbers)))
        texts["figures"] = sorted(figures_in_source(row["source"]) & set(plan.figures))
        texts["studies"] = plan.claims[row["chapter"]][row["claim"]].studies
        texts["statement"] = printed(texts["statement"])
        rows.append(texts)
    return rows


def _chapters(plan: Plan, folder: Path, every: pd.DataFrame) -> dict[str, list[Shown]]:
    """Return the figures of each chapter."""
    found = {}
    for chapter, entries in gallery.figure_entries(plan).items():
        shown = []
        for entry in entries:
            verdicts = gallery.count_verdicts(gallery.claims_of_figure(every, entry.name))
            shown.append(Shown(entry, _picture(folder, entry.name), verdicts))
        found[_chapter(chapter)] = shown
    return found


def _study(plan: Plan, folder: Path, name: str) -> Solved:
    """Return what the page shows of a study."""
    data = dataset.load_dataset(folder / "datasets" / f"{plan.dataset_name(name)}.nc")
    costs = pd.read_csv(folder / "costs" / f"{plan.dataset_name(name)}.csv")
    drawn_scene = _sketch(plan.studies[name].runs()[0].settings)
    return Solved(data.attrs["title"], dataset_summary(data, costs), _cost(costs), _settings(data), drawn_scene)


def _cost(costs: pd.DataFrame) -> str:
    runs, transforms, memory = costs.run.nunique(), costs.transforms.sum(), costs.memory_mib.max()
    time = duration_text(costs.seconds.sum())
    return f"{runs} runs, {transforms:.3g} transforms, {time} of CPU time, at most {memory:.0f} MiB"


def _settings(data: xr.Dataset) -> dict[str, str]:
    """Return the settings of a dataset as text, without empty ones; long lists of loads are shortened."""
    found = dataset.settings_of(data)
    if len(found["load"]["values"]) > 20:
        values = found["load"]["values"]
        found["load"] |= {"values": f"{len(values)} from {values[0]:g} to {values[-1]:g}"}
    kept = {key: value for key, value in found.items() if key not in HIDDEN and value not in (None, {}, [])}
    return {key: json.dumps(value, ensure_ascii=False).replace('"', "") for key, value in sorted(kept.items())}


@mpl.rc_context(style.RC_PARAMS)
def _sketch(run: dict) -> Picture:
    """Return the sketch of a run's scene."""
    size, dots = SKETCH
    figure, file = Figure(figsize=size, layout="constrained"), io.BytesIO()
    setup = build_setup(run)
    scene = setup.scene
    surface = scene.upper.surface
    enough = max(SECTION, 2 * (surface.modes or 0) + 2)  # of a large surface one section is drawn
    points = setup.points
    plot_sketch(scene, points if surface.points else min(points, enough), figure.subplots())
    figure.savefig(file, format="png", dpi=dots)
    return _embedded(file)


def _picture(folder: Path, name: str) -> Picture:
    return _embedded(folder / "figures" / f"{name}.png")


def _embedded(source: Path | io.BytesIO) -> Picture:
    """Return a picture for the page, reduced to few colours."""
    file = io.BytesIO()
    with Image.open(source) as picture:
        few = picture.convert("RGB").quantize(COLOURS, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
        few.save(file, format="png")
        width, height = picture.width // FINE, picture.height // FINE
    return Picture("data:image/png;base64," + base64.b64encode(file.getvalue()).decode(), width, height)


def _others(settings: Mapping, folder: Path) -> dict[str, list[dict]]:
    """Return the figures that belong to no chapter, by group."""
    groups = {group: settings["others"][group] for group in settings["order"]}
    return {
        group: [{"name": name, "picture": _picture(folder, name), **figures[name]} for name in sorted(figures)]
        for group, figures in groups.items()
        if figures
    }
