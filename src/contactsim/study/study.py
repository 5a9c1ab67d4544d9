"""Studies: one kind of scene, varied and repeated; from settings to the runs that the workflow plans.

A run is one variant and one member of the ensemble, swept over all loads. Its settings hold every value that it
depends on and nothing else, so two runs with equal settings are equal. Loads are sorted: their order cannot matter,
since each is solved on its own.
"""

from __future__ import annotations

import hashlib
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, cast

from contactsim.contact.simplification import SIMPLIFICATIONS
from contactsim.error_control.options import choose_options
from contactsim.errors import InputError
from contactsim.paths.driver import path_driver
from contactsim.provenance import digest
from contactsim.solvers.base import Solver, check_solver
from contactsim.solvers.registry import check_installed
from contactsim.study.keys import ERROR_RUNS, STUDY_KEYS
from contactsim.study.kinds import study_kind
from contactsim.study.places import data_file
from contactsim.study.reading import mapping, read
from contactsim.study.run import Run
from contactsim.study.scenes import build_scene, build_setup, updated_settings
from contactsim.study.sections import (
    default_solver_kind,
    read_accuracy,
    read_effects,
    read_error_run,
    read_load,
    read_slide,
    refuse_unused,
)
from contactsim.study.study_sections import StudySections
from contactsim.variables import dimension_name

MAX_RUNS = 10_000
"""Most runs of a study."""


@dataclass(frozen=True)
class Study:
    """A study as read from the config.

    Parameters
    ----------
    name : str
        Name in the config.
    settings : dict
        Settings with all defaults filled in.
    file : object
        File that they stand in, for messages.
    seed : int
        Seed of all random numbers.
    data_folders : list of str, optional
        Folders from which measured heights may be read beside the present one; any without it.
    """

    name: str
    settings: dict
    file: object
    seed: int
    data_folders: Sequence[str] | None = None

    @classmethod
    def read(
        cls, name: str, section: object, file: object, seed: int, data_folders: Sequence[str] | None = None
    ) -> Study:
        """Check a section of a chapter's config, down to the scene of every variant."""
        prefix = f"studies.{name}"
        settings, own = read(section, STUDY_KEYS, file, prefix), mapping(section)
        settings = read_accuracy(own, settings | read_effects(settings, file, prefix), file, prefix)
        settings["load"] = read_load(settings, file, prefix)
        settings["slide"] = read_slide(settings, file, prefix)
        if settings["points"] is not None and "points" in settings["vary"]:
            raise InputError(f"{prefix}.points", settings["points"], "left out, for points are varied", file)
        settings["solver"] = {"kind": default_solver_kind(settings)} | settings["solver"]
        refuse_unused(own, settings, file, prefix)
        for part in ERROR_RUNS:
            if settings[part] is not None:
                settings[part] = read_error_run(part, settings, file, prefix)
        study = cls(name, settings, file, seed, data_folders)
        study._check_size()
        for run in study.runs():
            if run.member == 0:
                study._check(run)
        study._check_neglect()
        study._check_fits()
        return study

    def _check_size(self) -> None:
        """Raise InputError for more runs than a study may have, before any is built."""
        variants = math.prod(len(self._values(name)) for name in self.settings["vary"])
        if variants * self.settings["members"] > MAX_RUNS:
            allowed = f"at most {MAX_RUNS} runs in all, and there are {variants} variants"
            raise InputError(f"studies.{self.name}.members", self.settings["members"], allowed, self.file)

    def _check_neglect(self) -> None:
        """Raise InputError where no variant has an effect that is to be neglected."""
        names = self.settings["neglect"]
        scenes = [build_scene(run.settings | {"neglect": []}) for run in self.runs() if names and run.member == 0]
        for name in names:
            if all(SIMPLIFICATIONS[name](scene) == scene for scene in scenes):
                raise InputError(f"studies.{self.name}.neglect", name, "effects that the study has", self.file)

    def _check_fits(self) -> None:
        """Raise InputError for fits without two loads below the limit, or with more varied than Hurst exponents."""
        load, limits = self.settings["load"], self.settings["fit_limits"]
        if limits is None:
            return
        if self.dimensions != ["hurst_exponent", "member", "reduced_pressure"]:
            allowed = "none, unless surface.hurst_exponent alone is varied and the load is a reduced_pressure"
            raise InputError(f"studies.{self.name}.fit_limits", limits, allowed, self.file)
        if min(limits) < load["values"][min(1, len(load["values"]) - 1)]:
            allowed = "limits with two loads or more below them"
            raise InputError(f"studies.{self.name}.fit_limits", min(limits), allowed, self.file)

    @property
    def dimensions(self) -> list[str]:
        """Dimensions of the study's dataset."""
        varied = [dimension_name(name) for name in self.settings["vary"]]
        return [*varied, "member", self.settings["load"]["name"]]

    @property
    def surfaces_of(self) -> str:
        """Name of the study whose random surfaces this one has: its own, or another."""
        return str(self.settings["same_surfaces_as"] or self.name)

    def runs(self) -> list[Run]:
        """Every job of the study, in order: variants, then members; runs that measure an error last."""
        return list(self._runs)

    @cached_property
    def _runs(self) -> list[Run]:
        names = sorted(self.settings["vary"])
        variants = [
            dict(zip(names, values, strict=True))
            for values in itertools.product(*(self._values(name) for name in names))
        ]
        changes: list[tuple[str, dict[str, object], int]] = [("", {}, self.settings["members"])]
        for part, (knob, error, _) in ERROR_RUNS.items():
            if self.settings[part] is not None:
                value = self.settings[part].get(knob, [])  # with nothing left out
                changes.append((error, {knob: value}, self.settings[part]["members"]))
        return [
            self._run(varied, member, change, error)
            for error, change, members in changes
            for varied in variants
            for member in range(members)
        ]

    @cached_property
    def _sections(self) -> StudySections:
        """Sections that the runs depend on."""
        return StudySections(self.name, self.settings, self.file)

    def _values(self, name: str) -> list:
        values, key = self.settings["vary"][name], f"studies.{self.name}.vary.{name}"
        if (
            not isinstance(values, list)
            or not values
            or any(value in values[:place] for place, value in enumerate(values))
        ):
            raise InputError(key, values, "a list with at least one entry, none twice", self.file)
        for value in values:
            if isinstance(value, list | dict):
                raise InputError(key, value, "single values, which a dimension can have", self.file)
        return values

    def _run(self, varied: dict, member: int, change: dict, error: str) -> Run:
        """Return the run of one variant and member; change: what a run that measures an error does otherwise."""
        parts, points = self._sections.of_variant(varied)
        kind = study_kind(self.settings)
        settings: dict[str, Any] = {"study": self.surfaces_of, "member": member, "seed": self.seed}
        settings |= {name: self.settings[name] for name in ("effects", "load", "tolerance", "neglect")}
        settings |= kind.run_settings(self.settings, member) | {"points": points} | change | parts
        if "through" in settings["load"]:  # says all, and is short
            settings["load"] = {key: value for key, value in settings["load"].items() if key != "values"}
        if not settings["neglect"]:
            del settings["neglect"]  # a study that neglects nothing has the runs of one that does not mention it
        if self.settings["auto"] is not None and error != ERROR_RUNS["full_model"][1]:
            settings["auto"] = self.settings["auto"]
        if "file" in parts["surface"]:
            settings["file_digest"] = self._file_digest(parts["surface"]["file"])
        if self.settings["accuracy"] is not None:
            settings = self._with_accuracy(settings)
        coordinates = {dimension_name(name): value for name, value in varied.items()}
        variant = digest(varied, *change.values() or [None])[:8]
        return Run(self.name, variant, member, coordinates, settings, error)

    def _with_accuracy(self, settings: dict) -> dict:
        """Return a run's settings with the grid, tolerance and increments that it begins with for its accuracy."""
        accuracy = self.settings["accuracy"]
        try:
            setup = choose_options(build_setup(settings), accuracy["error"], accuracy["quantities"])
        except InputError as error:
            raise error.located(self.file, f"studies.{self.name}") from error
        return updated_settings(settings, setup) | {"accuracy": accuracy}

    def _file_digest(self, path: str) -> str:
        """Digest of a measured surface's file, so that a changed file is pressed anew."""
        try:
            place = Path(path) if self.data_folders is None else data_file(path, self.data_folders)
            if not place.is_file():
                raise ValueError(f"looked for at {place.resolve()}")
            with place.open("rb") as content:
                return hashlib.file_digest(content, "sha256").hexdigest()[:16]
        except (OSError, ValueError) as error:
            allowed = f"a file that can be read ({error})"
            raise InputError(f"studies.{self.name}.surface.file", path, allowed, self.file) from error

    def _check(self, run: Run) -> None:
        """Build the run's scene, so that nothing impossible is found out by a job."""
        try:
            scene = run.setup.scene
            check_installed(run.settings["solver"]["kind"])
            check_solver(cast(Solver, run.setup.options.solver), scene)
            scene.upper.surface.check(run.setup.points)
            path_driver(scene.kind).check(run.setup)
        except InputError as error:
            section = next((f".{name}" for name in self._sections.names if error.key in run.settings[name]), "")
            raise error.located(self.file, f"studies.{self.name}{section}") from error
