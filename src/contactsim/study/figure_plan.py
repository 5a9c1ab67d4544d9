"""Figures of the config, checked against the functions that draw them."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from contactsim.analysis.ensemble import widen_interval
from contactsim.code_digest import module_path
from contactsim.errors import InputError
from contactsim.study.claim_plan import read_selection
from contactsim.study.law_table import read_law
from contactsim.study.reading import Key, listed, mapping, number, positive, read, size, text, whole
from contactsim.study.study import Study
from contactsim.traits import Trait

MAX_ROWS = 50
"""Most rows of axes."""
PICTURE_ENDINGS = ("png", "pdf", "svg", "csv")
"""Endings of the files of every figure: pictures, and the numbers that they show."""
LEAST_WIDTH = 2.8
"""Inches that a panel needs for its labels and legend."""
FIELDS = "fields"
"""First argument of a figure's function that draws the fields of one load of a surface."""

FRAME = "frame"
"""Keyword argument of a figure's function that draws any one of the states with fields."""
MAX_FRAMES = 60
"""Most frames of a film at even steps."""

FIGURE_KEYS = {
    "study": Key(text, "the name of a study of this chapter, or left out with a `law`", None),
    "law": Key(mapping, "a mapping with `effect`, its options and the gaps drawn, instead of a study", None),
    "datasets": Key(listed(text), "names of further studies of this chapter", []),
    "title": Key(text, "a line of text"),
    "caption": Key(text, "text"),
    "size": Key(size, "width and height in inches"),
    "panels": Key(whole(1), "number of axes side by side", 1),
    "rows": Key(whole(1, MAX_ROWS), "number of rows of such axes", 1),
    "select": Key(mapping, "a mapping from a dimension to its least and largest value shown", {}),
    "reference": Key(mapping, "a mapping from names to values of the thesis", {}),
    "compare": Key(listed(text), "a list of columns of the figure's CSV", []),
    "module": Key(text, "a module of contactsim.figures with the figure's function, if not that of the chapter", None),
    "film": Key(mapping, "a mapping with frames and frames_per_second, for a film through states with fields", None),
}
FILM_KEYS = {
    "frames": Key(whole(2, MAX_FRAMES), f"a whole number from 2 to {MAX_FRAMES}, of frames at even steps"),
    "frames_per_second": Key(positive, "a positive number"),
}


@dataclass(frozen=True)
class Figure:
    """One figure: name, chapter, its settings as read, and apart from them what is not drawn.

    That is the module of its function, and the columns to compare.
    """

    name: str
    chapter: str
    settings: dict
    compare: list[str]
    module: str

    @property
    def endings(self) -> tuple[str, ...]:
        """Endings of its files."""
        return PICTURE_ENDINGS if self.settings["film"] is None else (*PICTURE_ENDINGS, "gif")

    @property
    def studies(self) -> list[str]:
        """Studies whose data it shows; none where it shows a law by itself."""
        return [study for study in (self.settings["study"], *self.settings["datasets"]) if study is not None]


def read_figure(name: str, section: object, file: Path, studies: dict[str, Study]) -> Figure:
    """Check a figure's section of a chapter's config against the chapter's studies and the function that draws it."""
    prefix = f"figures.{name}"
    settings = read(section, FIGURE_KEYS, file, prefix)
    if settings["size"][0] < LEAST_WIDTH * settings["panels"]:
        raise InputError(f"{prefix}.size", settings["size"], f"a width of at least {LEAST_WIDTH} inches a panel", file)
    if (settings["study"] is None) == (settings["law"] is None):
        both = {key: settings[key] for key in ("study", "law")}
        raise InputError(prefix, both, "exactly one of study and law", file)
    if settings["law"] is not None:
        settings["law"] = read_law(settings["law"], file, f"{prefix}.law")
    for key, named in (("study", [settings["study"]]), ("datasets", settings["datasets"])):
        for study in set(named) - {*studies, None}:
            raise InputError(f"{prefix}.{key}", study, f"one of {', '.join(studies)}", file)
    dims = [] if settings["study"] is None else studies[settings["study"]].dimensions
    settings["select"] = read_selection(settings["select"], dims, file, f"{prefix}.select")
    if settings["film"] is not None:
        settings["film"] = read(settings["film"], FILM_KEYS, file, f"{prefix}.film")
    own = settings["module"]
    if own is not None and not module_path(f"contactsim.figures.{own}" if own.isidentifier() else ""):
        raise InputError(f"{prefix}.module", own, "the name of a module of contactsim.figures", file)
    compare, module = settings.pop("compare"), f"contactsim.figures.{settings.pop('module') or file.stem}"
    figure = Figure(name, file.stem, settings, compare, module)
    _check_function(figure, studies, file, prefix)
    return figure


def _check_function(figure: Figure, studies: dict[str, Study], file: Path, prefix: str) -> None:
    """Refuse a figure without a function, or whose function wants other datasets or other values of the thesis."""
    name, settings, functions = figure.name, figure.settings, _functions(figure.module)
    if name not in functions:
        raise InputError(prefix, name, f"a function of {figure.module}: {', '.join(functions)}", file)
    parameters = [argument.arg for argument in functions[name].args[:-1]]  # the last are the axes
    datasets = [settings["study"] or "a law", *settings["datasets"]]
    if len(datasets) != len(parameters):
        allowed = f"so many that with {datasets[0]} they are those that the function draws: {', '.join(parameters)}"
        raise InputError(f"{prefix}.datasets", settings["datasets"], allowed, file)
    if parameters[0] == FIELDS and settings["study"] is None:
        raise InputError(f"{prefix}.law", settings["law"], "a study, whose fields the function draws", file)
    if parameters[0] == FIELDS:
        _check_map(settings, studies[settings["study"]], file, prefix)
    keywords = [argument.arg for argument in functions[name].kwonlyargs]
    if settings["film"] is not None:
        _check_film(figure, keywords, studies, file, f"{prefix}.film")
    keys = {word: Key(number, "a value of the thesis, a number") for word in keywords if word != FRAME}
    read(settings["reference"], keys, file, f"{prefix}.reference")


def _check_film(figure: Figure, keywords: list[str], studies: dict[str, Study], file: Path, prefix: str) -> None:
    """Refuse a film whose figure draws no chosen state, of more than one path, and of too few states with fields."""
    film = figure.settings["film"]
    if FRAME not in keywords or figure.settings["study"] is None:
        allowed = f"left out, but for a function with the keyword `{FRAME}`, of a study"
        raise InputError(prefix, film, allowed, file)
    study = studies[figure.settings["study"]]
    if study.settings["vary"] or study.settings["members"] > 1:
        raise InputError(prefix, film, f"left out, for {study.name} varies something or has several members", file)
    loads = study.settings["load"].get("values") if FIELDS in study.settings["keep"] else None
    states = len(study.settings["snapshots"] or loads or ())
    if states < film["frames"]:
        more = "add `snapshots`, or loads and keep `fields`"
        allowed = f"at most {states}, the states of {study.name} with fields: {more}"
        raise InputError(f"{prefix}.frames", film["frames"], allowed, file)


def _check_map(settings: dict, study: Study, file: Path, prefix: str) -> None:
    """Refuse a map of what has no fields, of a line, and of more than one load of one member."""
    first, load = study.runs()[0], study.settings["load"]
    if FIELDS not in study.settings["keep"] or Trait.SURFACE not in first.setup.scene.traits:
        raise InputError(f"{prefix}.study", study.name, "a study of surfaces, not lines, that keeps `fields`", file)
    places: list[dict[str, Any]] = [
        run.coordinates | {"member": run.member} for run in study.runs() if not run.measures_error
    ]
    places = [place | {load["name"]: value} for place in places for value in load["values"]]
    for dim, (least, largest) in settings["select"].items():
        low, high = widen_interval(least, largest)
        places = [place for place in places if low <= place[dim] <= high]
    if len(places) != 1:
        allowed = f"what leaves one load of one member to draw; this leaves {len(places)}"
        raise InputError(f"{prefix}.select", settings["select"], allowed, file)


@cache
def _functions(module: str) -> dict[str, ast.arguments]:
    """Return the public functions of a module with their arguments; it is parsed, since imports take a second."""
    path = module_path(module)
    tree = ast.parse(path.read_text(encoding="utf-8")) if path else ast.Module([], [])
    public = [node for node in tree.body if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")]
    return {node.name: node.args for node in public}
