"""A study: one kind of scene, varied and repeated; from its settings to the runs that the workflow plans.

A run is one variant and one member of the ensemble, swept over all loads. Its settings hold every value that it
depends on and nothing else, so that two runs with equal settings are equal. Loads are sorted: their order cannot
matter, since each is solved on its own.
"""

from __future__ import annotations

import hashlib
import itertools
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from contactsim import dataset
from contactsim.contact.cohesive import check_tolerance
from contactsim.contact.simplification import SIMPLIFICATIONS
from contactsim.error_control.options import chosen
from contactsim.error_control.scaling import FILE
from contactsim.errors import SceneError
from contactsim.interface.registry import EFFECTS
from contactsim.provenance import computing_digest, digest
from contactsim.solvers.base import require
from contactsim.solvers.registry import make_solver, solver_module
from contactsim.study.keys import (
    BODIES,
    COMPANIONS,
    KINDS,
    MODULI,
    RIGID,
    STUDY_KEYS,
    acting,
    default_solver_kind,
    is_smooth,
    read_load,
    read_slide,
    settled,
    slide_part,
)
from contactsim.study.reading import Key, choice, keys_of, read
from contactsim.study.scenes import increments_of, points_of, scene_of

FOLLOWED = {"accuracy": "contactsim.error_control.control", "auto": "contactsim.error_control.neglect"}
"""Modules that compute a run beside those that any does, by the key that asks for it."""


@dataclass(frozen=True)
class Run:
    """One job: settings and its place among the varied values.

    error: what it only measures, of `schema.COMPANIONS`; empty for the study's own runs.
    """

    study: str
    variant: str
    member: int
    coordinates: dict[str, object]
    settings: dict
    error: str = ""

    @property
    def companion(self) -> bool:
        """Whether it only measures an error."""
        return bool(self.error)

    @cached_property
    def source(self) -> str:
        """Digest of what computes the run: the marching, the one solver it uses, and the libraries."""
        follows = ["contactsim.study.execute"]
        follows += [module for key, module in FOLLOWED.items() if key in self.settings]
        code = computing_digest(*follows, solver_module(self.settings["solver"]["kind"]))
        measured = [FILE.read_text(encoding="utf-8")] if "accuracy" in self.settings else []
        return digest(code, *measured)

    @cached_property
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
        settings = settled(section, settings | acting(settings, file, prefix), file, prefix)
        settings["load"] = read_load(settings, file, prefix)
        settings["slide"] = read_slide(settings, file, prefix)
        if settings["points"] is not None and "points" in settings["vary"]:
            raise SceneError(f"{prefix}.points", settings["points"], "left out, for points are varied", file)
        settings["solver"] = {"kind": default_solver_kind(settings)} | settings["solver"]
        _refuse_unused(section, settings, file, prefix)
        for part in COMPANIONS:
            if settings[part] is not None:
                settings[part] = _companion(part, settings, file, prefix)
        study = cls(name, settings, str(file), seed)
        for run in study.runs():
            if run.member == 0:
                study._check(run)
        study._check_left_out()
        study._check_fits()
        return study

    def _check_left_out(self) -> None:
        """What is left out must be an effect of one variant at least."""
        names = self.settings["leave_out"]
        whole = [scene_of(run.settings | {"leave_out": []}) for run in self.runs() if names and run.member == 0]
        for name in names:
            if all(SIMPLIFICATIONS[name](scene) == scene for scene in whole):
                raise SceneError(f"studies.{self.name}.leave_out", name, "effects that the study has", self.file)

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
        return list(self._runs)

    @cached_property
    def _runs(self) -> list[Run]:
        names = sorted(self.settings["vary"])
        variants = [
            dict(zip(names, values, strict=True))
            for values in itertools.product(*(self._values(name) for name in names))
        ]
        changes = [("", {}, self.settings["members"])]
        for part, (knob, error, _) in COMPANIONS.items():
            if self.settings[part] is not None:
                value = self.settings[part].get(knob, [])  # with nothing left out
                changes.append((error, {knob: value}, self.settings[part]["members"]))
        return [
            self._run(varied, member, change, error)
            for error, change, members in changes
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

    def _run(self, varied: dict, member: int, change: dict, error: str) -> Run:
        """The run of one variant and member; change: what a run that measures an error does otherwise."""
        sections = {name: self.settings[name] for name in self._sections()}
        parts = {name: self._part(name, section) for name, section in sections.items()}
        grid = {"points": self.settings["points"]}
        for name, value in varied.items():
            if name == "points":
                grid = read({name: value}, {name: STUDY_KEYS[name]}, self.file, f"studies.{self.name}.vary")
                continue
            head, _, tail = str(name).partition(".")
            if tail not in parts.get(head, ()):
                known = ", ".join(f"{part}.{key}" for part in parts for key in parts[part] if key != "kind")
                allowed = f"a key of this study: points, {known}"
                raise SceneError(f"studies.{self.name}.vary", name, allowed, self.file)
            sections[head] = sections[head] | {tail: value}
        parts = {name: self._part(name, section) for name, section in sections.items()}
        smooth = is_smooth(self.settings)
        kept = "snapshots" if smooth else "keep"
        shared = (
            {name: self.settings[name] for name in ("effects", "load", "tolerance", "leave_out", kept)} | grid | change
        )
        if smooth:
            shared["keep_fields"] = member < (self.settings["snapshot_members"] or self.settings["members"])
        drawn = {"study": self.settings["surfaces_of"] or self.name, "member": member, "seed": self.seed}
        if "through" in shared["load"]:  # says all, and is short
            shared["load"] = {key: value for key, value in shared["load"].items() if key != "values"}
        settings = drawn | shared | parts
        if not settings["leave_out"]:
            del settings["leave_out"]  # as if it were not thought of
        if self.settings["auto"] is not None and error != COMPANIONS["whole"][1]:
            settings["auto"] = self.settings["auto"]
        if "file" in parts["surface"]:
            settings["file_digest"] = self._file_digest(parts["surface"]["file"])
        if self.settings["accuracy"] is not None:
            settings = self._chosen(settings)
        coordinates = {dataset.dimension(name): value for name, value in varied.items()}
        variant = digest(varied, *change.values() or [None])[:8]
        return Run(self.name, variant, member, coordinates, settings, error)

    def _chosen(self, settings: dict) -> dict:
        """A run's settings with the grid, tolerance and increments that it begins with for the accuracy asked for."""
        asked = self.settings["accuracy"]
        try:
            return chosen(settings, **asked) | {"accuracy": asked}
        except SceneError as error:
            raise error.within(self.file, f"studies.{self.name}") from error

    def _sections(self) -> list[str]:
        """Names of the sections that this study's runs depend on."""
        path = ["increments"] if is_smooth(self.settings) else []
        others = [name for name in ("counter_body", "pairing", "slide") if self.settings[name] is not None]
        laws = [name for name in self.settings["effects"] if name in self.settings]
        return ["surface", "body", *others, "solver", *path, *laws]

    def _part(self, name: str, section: dict) -> dict:
        """A section with the defaults filled in; its keys are those of its `kind`, or of the effect it is named for."""
        prefix = f"studies.{self.name}.{name}"
        if name in EFFECTS:
            return read(section, keys_of(EFFECTS[name]), self.file, prefix)
        if name == "slide":
            return slide_part(section, self.file, prefix)
        known, class_of = KINDS[name]
        kind = Key(choice(known), f"one of {', '.join(sorted(known))}")
        given = {"kind": section["kind"]} if "kind" in section else {}
        chosen = read(given, {"kind": kind}, self.file, prefix)["kind"]
        moduli = MODULI if name in BODIES and chosen != RIGID else {}
        keys = {"kind": kind} | keys_of(class_of(chosen)) | moduli
        return {
            key: value for key, value in read(section, keys, self.file, prefix).items() if key not in MODULI or value
        }

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
            method, points = make_solver(**run.settings["solver"]), points_of(run.settings, scene.upper.surface)
            require(method, scene)
            scene.upper.surface.check(points)
            if is_smooth(run.settings):
                check_tolerance(run.settings["tolerance"])
                increments_of(run.settings).check(points, scene.path.steps, method)
                for value in run.settings["snapshots"] or ():
                    scene.path.nearest(value)
        except SceneError as error:
            section = next((f".{name}" for name in self._sections() if error.key in run.settings[name]), "")
            raise error.within(self.file, f"studies.{self.name}{section}") from error


def _companion(part: str, settings: dict, file: object, prefix: str) -> dict:
    """What a study says of runs that measure an error."""
    knob, _, keys = COMPANIONS[part]
    given = read(settings[part], keys, file, f"{prefix}.{part}")
    if knob in settings["vary"]:
        raise SceneError(f"{prefix}.{part}", settings[part], f"left out, for {knob} are varied", file)
    if given["members"] > settings["members"]:
        allowed = f"at most {settings['members']}, the study's members"
        raise SceneError(f"{prefix}.{part}.members", given["members"], allowed, file)
    if knob not in keys and not (settings[knob] or settings["auto"]):
        raise SceneError(f"{prefix}.{part}", given, f"none, for the study has no {knob}", file)
    if knob in keys and (settings[knob] is None or given[knob] >= settings[knob]):
        allowed = f"below the study's {knob}, {settings[knob]}"
        raise SceneError(f"{prefix}.{part}.{knob}", given[knob], allowed, file)
    return given


def _refuse_unused(section: dict, settings: dict, file: object, prefix: str) -> None:
    """SceneError for what a study's effects have no use for: the section of another, or how a path is walked."""
    kinds = ("keep",), ("increments", "snapshots", "snapshot_members")
    others = [name for name in sorted(set(settings) & set(EFFECTS) - set(settings["effects"])) if settings[name]]
    for key in [*others, *(key for key in kinds[not is_smooth(settings)] if section.get(key) is not None)]:
        what = "section" if key in EFFECTS else "key"
        allowed = f"no such {what}, as effects are {', '.join(settings['effects'])}"
        raise SceneError(f"{prefix}.{key}", settings[key], allowed, file)
