"""A study: one kind of scene, varied and repeated; from its settings to the runs that the workflow plans.

A run is one variant and one member of the ensemble, swept over all loads. Its settings hold every value that it
depends on and nothing else, so that two runs with equal settings are equal. Loads are sorted: their order cannot
matter, since each is solved on its own.
"""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from contactsim import dataset
from contactsim.build import points_of, scene_of
from contactsim.config import Key, choice, keys_of, listed, mapping, number, positive, read, text, whole
from contactsim.elasticity import ELASTICITIES
from contactsim.errors import SceneError
from contactsim.laws import EFFECTS
from contactsim.observables import KEPT
from contactsim.provenance import digest, source_digest, versions
from contactsim.solvers import SOLVERS, module_of, solver, solver_class, usual_kind
from contactsim.solvers.base import require
from contactsim.surface import SURFACES, Flat
from contactsim.traits import Trait

LOADS = ("mean_pressure", "reduced_pressure", "contact_ratio")
KINDS: dict[str, tuple[Mapping[str, object], Callable[[str], type]]] = {
    "surface": (SURFACES, SURFACES.__getitem__),
    "body": (ELASTICITIES, ELASTICITIES.__getitem__),
    "solver": (SOLVERS, solver_class),
}
"""Sections whose `kind` decides which keys they have: the kinds there are, and the class of each."""

STUDY_KEYS = {
    "title": Key(text, "a line of text"),
    "surface": Key(mapping, "a mapping with `kind` and that kind's keys"),
    "body": Key(mapping, "a mapping with `kind` and that kind's keys"),
    "effects": Key(listed(choice(EFFECTS)), f"a list from {sorted(EFFECTS)}"),
    "load": Key(mapping, f"a mapping with one of {', '.join(LOADS)} and its list of values"),
    "vary": Key(mapping, "a mapping from keys of this study to lists of values", {}),
    "points": Key(whole(2), "a whole number of grid points, 2 or more; left out for a measured surface", None),
    "surfaces_of": Key(text, "the name of a study of this chapter with the same random surfaces", None),
    "thesis_points": Key(whole(2), "grid points of the thesis, for the footer", None),
    "members": Key(whole(1), "a whole number, 1 or more", 1),
    "companion": Key(mapping, "a mapping with `points` and `members`", None),
    "tight": Key(mapping, "a mapping with `tolerance` and `members`", None),
    "solver": Key(mapping, "a mapping with `kind` and that solver's options", {}),
    "tolerance": Key(positive, "a positive number of grid steps"),
    "keep": Key(listed(choice(KEPT)), f"a list from {', '.join(KEPT)}", list(KEPT[:-1])),
    "fit_limits": Key(listed(positive), "a list of largest reduced pressures to fit Eq. 3.11 to", None),
}
COMPANION_KEYS = {
    "points": Key(whole(2), "a whole number of grid points, fewer than the study's"),
    "members": Key(whole(1), "a whole number, at most the study's members"),
}
TIGHT_KEYS = {
    "tolerance": Key(positive, "a positive number of grid steps, below the study's"),
    "members": COMPANION_KEYS["members"],
}


@dataclass(frozen=True)
class Run:
    """One job: settings and its place among the varied values.

    companion: whether it only measures an error, of the grid or, if tight, of the tolerance.
    """

    study: str
    variant: str
    member: int
    coordinates: dict[str, object]
    settings: dict
    companion: bool
    tight: bool = False

    @property
    def source(self) -> str:
        """Digest of what computes the run: the marching, the one solver it uses, and the libraries."""
        return digest(source_digest("contactsim.march", module_of(self.settings["solver"]["kind"])), versions())

    @property
    def digest(self) -> str:
        """Changes with the settings and with the code that computes the run."""
        return digest(self.settings, self.source)

    @property
    def stem(self) -> str:
        """Where the run's files lie below runs/ and costs/runs/, without their endings."""
        return f"{self.study}/{self.variant}/{self.member}"


@dataclass(frozen=True)
class Study:
    """A study as read: its name, settings, the file they stand in, and the seed of all random numbers."""

    name: str
    settings: dict
    file: str
    seed: int

    @classmethod
    def read(cls, name: str, section: object, file: object, seed: int) -> Study:
        """Check a section of a chapter's config, down to the scene of every variant."""
        prefix = f"studies.{name}"
        settings = read(section, STUDY_KEYS, file, prefix)
        settings["load"] = _load(settings["load"], file, f"{prefix}.load")
        if settings["points"] is not None and "points" in settings["vary"]:
            raise SceneError(f"{prefix}.points", settings["points"], "left out, for points are varied", file)
        settings["solver"] = {"kind": _usual(settings["surface"])} | settings["solver"]
        for part, keys, knob in (("companion", COMPANION_KEYS, "points"), ("tight", TIGHT_KEYS, "tolerance")):
            if settings[part] is None:
                continue
            settings[part] = read(settings[part], keys, file, f"{prefix}.{part}")
            if knob in settings["vary"]:
                raise SceneError(f"{prefix}.{part}", settings[part], f"left out, for {knob} are varied", file)
            if settings[part]["members"] > settings["members"]:
                allowed = f"at most {settings['members']}, the study's members"
                raise SceneError(f"{prefix}.{part}.members", settings[part]["members"], allowed, file)
            if settings[knob] is None or settings[part][knob] >= settings[knob]:
                allowed = f"below the study's {knob}, {settings[knob]}"
                raise SceneError(f"{prefix}.{part}.{knob}", settings[part][knob], allowed, file)
        study = cls(name, settings, str(file), seed)
        for run in study.runs():
            if run.member == 0:
                study._check(run)
        study._check_fits()
        return study

    def _check_fits(self) -> None:
        """Fits need two loads below the limit, and Hurst exponents alone to be varied."""
        load, limits = self.settings["load"], self.settings["fit_limits"]
        if limits is None:
            return
        if self.dimensions != ["hurst", "member", "reduced_pressure"]:
            allowed = "none, unless surface.hurst alone is varied and the load is a reduced_pressure"
            raise SceneError(f"studies.{self.name}.fit_limits", limits, allowed, self.file)
        if min(limits) < load["values"][min(1, len(load["values"]) - 1)]:
            allowed = "limits with two loads or more below them"
            raise SceneError(f"studies.{self.name}.fit_limits", min(limits), allowed, self.file)

    @property
    def dimensions(self) -> list[str]:
        """Dimensions of the study's dataset."""
        varied = [dataset.dimension(name) for name in self.settings["vary"]]
        return [*varied, "member", self.settings["load"]["name"]]

    def runs(self) -> list[Run]:
        """Every job of the study, in order: variants, then members; companions last."""
        names = sorted(self.settings["vary"])
        variants = [
            dict(zip(names, values, strict=True))
            for values in itertools.product(*(self._values(name) for name in names))
        ]
        changes = [({}, self.settings["members"])]
        for part, knob in (("companion", "points"), ("tight", "tolerance")):
            if self.settings[part] is not None:
                changes.append(({knob: self.settings[part][knob]}, self.settings[part]["members"]))
        return [
            self._run(varied, member, change)
            for change, members in changes
            for varied in variants
            for member in range(members)
        ]

    def _values(self, name: str) -> list:
        values, key = self.settings["vary"][name], f"studies.{self.name}.vary.{name}"
        if (
            not isinstance(values, list)
            or not values
            or any(value in values[:place] for place, value in enumerate(values))
        ):
            raise SceneError(key, values, "a list with at least one entry, none twice", self.file)
        for value in values:
            if isinstance(value, list | dict):
                raise SceneError(key, value, "single values, which a dimension can have", self.file)
        return values

    def _run(self, varied: dict, member: int, change: dict) -> Run:
        """The run of one variant and member; change: points or tolerance of a run that measures their error."""
        parts = {name: self._part(name, self.settings[name]) for name in KINDS}
        sections, grid = {name: self.settings[name] for name in KINDS}, {"points": self.settings["points"]}
        for name, value in varied.items():
            if name == "points":
                grid = read({name: value}, {name: STUDY_KEYS[name]}, self.file, f"studies.{self.name}.vary")
                continue
            head, _, tail = str(name).partition(".")
            if tail not in parts.get(head, ()):
                known = ", ".join(f"{part}.{key}" for part in KINDS for key in parts[part] if key != "kind")
                allowed = f"a key of this study: points, {known}"
                raise SceneError(f"studies.{self.name}.vary", name, allowed, self.file)
            sections[head] = sections[head] | {tail: value}
        parts = {name: self._part(name, section) for name, section in sections.items()}
        shared = {name: self.settings[name] for name in ("effects", "load", "tolerance", "keep")} | grid | change
        drawn = {"study": self.settings["surfaces_of"] or self.name, "member": member, "seed": self.seed}
        settings = drawn | shared | parts
        if "file" in parts["surface"]:
            settings["file_digest"] = self._file_digest(parts["surface"]["file"])
        coordinates = {dataset.dimension(name): value for name, value in varied.items()}
        variant = digest(varied, *change.values() or [None])[:8]
        return Run(self.name, variant, member, coordinates, settings, bool(change), "tolerance" in change)

    def _part(self, name: str, section: dict) -> dict:
        """A section whose `kind` decides which keys it has, with the defaults filled in."""
        known, class_of = KINDS[name]
        prefix = f"studies.{self.name}.{name}"
        kind = Key(choice(known), f"one of {', '.join(sorted(known))}")
        given = {"kind": section["kind"]} if "kind" in section else {}
        chosen = read(given, {"kind": kind}, self.file, prefix)["kind"]
        return read(section, {"kind": kind} | keys_of(class_of(chosen)), self.file, prefix)

    def _file_digest(self, path: str) -> str:
        """Digest of a measured surface's file, so that a changed file is pressed anew."""
        try:
            return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]
        except OSError as error:
            allowed = f"a file that can be read; looked for at {Path(path).resolve()}"
            raise SceneError(f"studies.{self.name}.surface.file", path, allowed, self.file) from error

    def _check(self, run: Run) -> None:
        """Build the run's scene once, so that nothing impossible is found out by a job."""
        try:
            scene = scene_of(run.settings)
            require(solver(**run.settings["solver"]), scene)
            scene.upper.surface.check(points_of(run.settings, scene.upper.surface))
        except SceneError as error:
            section = next((f".{name}" for name in KINDS if error.key in run.settings[name]), "")
            raise error.within(self.file, f"studies.{self.name}{section}") from error


def _usual(surface: dict) -> str:
    """The kind of solver for a surface's dimension; a surface that is wrong is refused later."""
    kind = SURFACES.get(str(surface.get("kind")), Flat)
    dimensions = surface.get("dimensions", getattr(kind, "dimensions", 1))
    return usual_kind(frozenset({Trait.SURFACE if dimensions == 2 else Trait.LINE}))


def _load(section: dict, file: object, prefix: str) -> dict:
    values = Key(listed(number), "a list of numbers, none twice", None)
    given = {name: value for name, value in read(section, dict.fromkeys(LOADS, values), file, prefix).items() if value}
    if len(given) != 1:
        raise SceneError(prefix, section, f"exactly one of {', '.join(LOADS)}", file)
    ((name, numbers),) = given.items()
    if min(numbers) <= 0:
        raise SceneError(f"{prefix}.{name}", min(numbers), "numbers above 0", file)
    return {"name": name, "values": sorted(numbers)}
