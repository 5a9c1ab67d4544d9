"""A study: one kind of scene, varied and repeated; from its settings to the runs that the workflow plans.

A run is one variant and one member of the ensemble, swept over all loads. Its settings hold every value that it
depends on and nothing else, so that two runs with equal settings are equal. Loads are sorted: their order cannot
matter, since each is solved on its own.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from contactsim import analytic, loading
from contactsim.config import (
    Key,
    choice,
    keys_of,
    listed,
    mapping,
    number,
    overlaid,
    positive,
    read,
    text,
    whole,
)
from contactsim.elasticity import ELASTICITIES
from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.laws import EFFECTS
from contactsim.loading import LoadPath
from contactsim.provenance import digest, source_digest
from contactsim.roughness import rms_gradient
from contactsim.scene import Body, Scene
from contactsim.solvers import SOLVERS, module_of, solver
from contactsim.solvers.base import require
from contactsim.surface import SURFACES, Flat, SelfAffine, Surface, generator

LOADS = ("mean_pressure", "reduced_pressure", "contact_ratio")
STUDY_KEYS = {
    "title": Key(text, "a line of text"),
    "surface": Key(mapping, "a mapping with `kind` and that kind's keys"),
    "body": Key(mapping, "a mapping with `kind` and that kind's keys"),
    "effects": Key(listed(choice(EFFECTS)), f"a list from {sorted(EFFECTS)}"),
    "load": Key(mapping, f"a mapping with one of {list(LOADS)} and its list of values"),
    "vary": Key(mapping, "a mapping from keys of this study to lists of values", {}),
    "points": Key(whole(2), "a whole number of grid points, 2 or more; left out for a measured surface", None),
    "thesis_points": Key(whole(2), "grid points of the thesis, for the footer", None),
    "members": Key(whole(1), "a whole number, 1 or more", 1),
    "companion": Key(mapping, "a mapping with `points` and `members`", None),
    "solver": Key(mapping, "a mapping with `name` and that solver's options", {"name": "active_set"}),
    "tolerance": Key(positive, "a positive number of grid steps"),
    "fit_limits": Key(listed(positive), "a list of largest reduced pressures to fit Eq. 3.11 to", None),
}
COMPANION_KEYS = {
    "points": Key(whole(2), "a whole number of grid points, fewer than the study's"),
    "members": Key(whole(1), "a whole number, at most the study's members"),
}


@dataclass(frozen=True)
class Run:
    """One job: settings, its place among the varied values, and whether it only measures the grid error."""

    study: str
    variant: str
    member: int
    coordinates: dict[str, object]
    settings: dict
    companion: bool

    @property
    def digest(self) -> str:
        """Changes with the settings and with the code that computes the run."""
        return digest(self.settings, self.source)

    @property
    def source(self) -> str:
        """Digest of the modules that compute the run: the marching, and the one solver it uses."""
        return run_source(self.settings["solver"]["name"])


def run_source(name: str) -> str:
    """Digest of the modules that a run with the solver of this name executes."""
    return source_digest("contactsim.march", module_of(name))


@dataclass(frozen=True)
class Study:
    """A study as read: its name, settings, the file they stand in, and the seed of all random numbers."""

    name: str
    settings: dict
    file: str
    seed: int

    @classmethod
    def read(cls, name: str, section: dict, file: str, seed: int) -> Study:
        """Check a section of a chapter's config, down to the scenes of every variant."""
        prefix = f"studies.{name}"
        settings = read(section, STUDY_KEYS, file, prefix)
        study = cls(name, settings | {"load": _load(settings["load"], file, f"{prefix}.load")}, file, seed)
        companion = settings["companion"]
        if companion is not None:
            read(companion, COMPANION_KEYS, file, f"{prefix}.companion")
            if companion["members"] > settings["members"]:
                raise SceneError(f"{prefix}.companion.members", companion["members"], "at most members", file)
        for run in study.runs():
            if run.member == 0:
                try:
                    scene = scene_of(run.settings)
                    require(solver(**run.settings["solver"]), scene)
                    scene.heights(run.settings["points"])
                except SceneError as error:
                    raise error.within(file, prefix) from error
        return study

    def runs(self) -> list[Run]:
        """Every job of the study, in order: variants, then members; companions last."""
        base = {"members": self.settings["members"], "points": self.settings["points"], "companion": False}
        kinds = [base]
        if self.settings["companion"] is not None:
            kinds.append(self.settings["companion"] | {"companion": True})
        varied = self.settings["vary"]
        names = sorted(varied)
        combinations = list(itertools.product(*(self._values(name) for name in names)))
        return [
            self._run(dict(zip(names, values, strict=True)), member, kind["points"], kind["companion"])
            for kind in kinds
            for values in combinations
            for member in range(kind["members"])
        ]

    def _values(self, name: str) -> list:
        values = self.settings["vary"][name]
        if not isinstance(values, list) or not values or len(set(map(repr, values))) < len(values):
            key = f"studies.{self.name}.vary.{name}"
            raise SceneError(key, values, "a list with at least one entry, none twice", self.file)
        return values

    def _run(self, varied: dict, member: int, points: int | None, companion: bool) -> Run:
        parts = {name: self.settings[name] for name in ("surface", "body", "effects", "load", "solver", "tolerance")}
        for name, value in varied.items():
            head, _, tail = name.partition(".")
            if head not in parts or not isinstance(parts[head], dict) or tail not in parts[head]:
                known = [
                    f"{h}.{t}" for h in ("surface", "body", "solver") for t in parts[h] if t not in ("kind", "name")
                ]
                raise SceneError(
                    f"studies.{self.name}.vary", name, f"a key of this study: {', '.join(known)}", self.file
                )
            parts = overlaid(parts, {head: {tail: value}})
        checked = self._checked(parts)
        identity = {"study": self.name, "member": member, "seed": self.seed}
        settings = identity | checked | {"points": points or self._surface(checked).points}
        coordinates = {name.rpartition(".")[2]: value for name, value in sorted(varied.items())}
        variant = digest(varied, settings["points"] if companion else None)[:8]
        return Run(self.name, variant, member, coordinates, settings, companion)

    def _checked(self, parts: dict) -> dict:
        prefix = f"studies.{self.name}"
        checked = dict(parts)
        for section, name, known, left_out in (
            ("surface", "kind", SURFACES, ("rng",)),
            ("body", "kind", ELASTICITIES, ()),
        ):
            chosen = read_kind(parts[section], name, known, left_out, self.file, f"{prefix}.{section}")
            checked[section] = chosen
        read(
            {"name": parts["solver"].get("name")},
            {"name": Key(choice(SOLVERS), f"one of {sorted(SOLVERS)}")},
            self.file,
            f"{prefix}.solver",
        )
        keys = {"name": Key(text, "")} | keys_of(type(solver(parts["solver"]["name"])))
        given = read(parts["solver"], keys, self.file, f"{prefix}.solver")
        checked["solver"] = {key: given[key] for key in parts["solver"]}
        return checked

    def _surface(self, checked: dict) -> Surface:
        try:
            return surface_of(checked["surface"], generator(0))
        except SceneError as error:
            raise error.within(self.file, f"studies.{self.name}.surface") from error


def read_kind(section: dict, name: str, known: dict, left_out: tuple[str, ...], file: str, prefix: str) -> dict:
    """A section whose `kind` decides which keys it has; returns it with the defaults filled in."""
    kind = Key(choice(known), f"one of {sorted(known)}")
    chosen = read({name: section[name]} if name in section else {}, {name: kind}, file, prefix)[name]
    return read(section, {name: kind} | keys_of(known[chosen], left_out), file, prefix)


def _load(section: dict, file: str, prefix: str) -> dict:
    values = Key(listed(number), "a list of numbers, none twice", None)
    given = {name: value for name, value in read(section, dict.fromkeys(LOADS, values), file, prefix).items() if value}
    if len(given) != 1:
        raise SceneError(prefix, section, f"exactly one of {', '.join(LOADS)}", file)
    ((name, numbers),) = given.items()
    if min(numbers) <= 0:
        raise SceneError(f"{prefix}.{name}", min(numbers), "numbers above 0", file)
    return {"name": name, "values": sorted(numbers)}


def surface_of(section: dict, rng: np.random.Generator) -> Surface:
    """The surface that a section describes."""
    kind = SURFACES[section["kind"]]
    options = {key: value for key, value in section.items() if key != "kind"}
    return kind(**options, rng=rng) if kind is SelfAffine else kind(**options)


def scene_of(settings: dict) -> Scene:
    """The scene of a run: a flat elastic body below, the rigid surface above, pressed through all loads."""
    surface = settings["surface"]
    rng = generator(settings["seed"], settings["study"], surface.get("hurst"), settings["member"])
    upper = Body(surface_of(surface, rng))
    body = settings["body"]
    elasticity = ELASTICITIES[body["kind"]](**{key: value for key, value in body.items() if key != "kind"})
    effects = tuple(EFFECTS[name]() for name in settings["effects"])
    lower = Body(Flat(upper.surface.length), elasticity)
    return Scene(lower, upper, effects, load_path(settings, upper.surface, elasticity.contact_modulus))


def load_path(settings: dict, surface: Surface, contact_modulus: float) -> LoadPath:
    """Mean pressures from the loads as the study gives them.

    reduced_pressure: times E* and the rms gradient, the one prescribed or else that of the heights; contact_ratio:
    what a cylinder needs for a half-width of that part of its radius (Eq. 3.5).
    """
    name, values = settings["load"]["name"], np.array(settings["load"]["values"])
    return loading.press([float(value) for value in _pressures(name, values, settings, surface, contact_modulus)])


def _pressures(name: str, values: Array, settings: dict, surface: Surface, contact_modulus: float) -> Array:
    if name == "reduced_pressure":
        points = settings["points"]
        gradient = settings["surface"].get("rms_gradient")
        return values * contact_modulus * (gradient or rms_gradient(surface.heights(points), surface.length / points))
    if name == "contact_ratio":
        if "radius" not in settings["surface"]:
            raise SceneError("load", name, "mean_pressure or reduced_pressure: this surface has no radius")
        radius = surface.radius
        return analytic.cylinder_load(values * radius, radius, contact_modulus) / surface.length
    return values
