"""What accuracy costs, as relations that were measured once and are read from a file.

Errors of the grid follow the size of what it has to show: at a hard wall the contacts, under smooth laws the process
zone and the contact; errors of a path follow its increments. Work and time follow grid,
steps and what acts. Each relation is a power law in a few numbers that say what kind of scene it is, `features`, with
its scatter over the scenes that it was fitted to, none of which it is judged on.
`contactsim.evaluation.calibration.fit` fits them.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from contactsim import reference
from contactsim.contact.scene import Scene
from contactsim.errors import SceneError
from contactsim.status import process_zone
from contactsim.study.reading import load_yaml
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.surfaces.shapes import Cylinder, Sphere
from contactsim.traits import Trait

FILE = Path(__file__).with_name("scaling.yaml")
LINE, SURFACE, PATH, ROUGH_PATH, SLIDE = KINDS = ("line", "surface", "path", "rough_path", "slide")
"""Scenes that relations are known of: lines and surfaces under loads, against a hard wall; asperities, and rough lines,
along a path by smooth laws; asperities that slide."""
MEASURES = {
    LINE: ("relative_contact_area_subgrid",),
    SURFACE: ("relative_contact_area_subgrid",),
    PATH: ("pull_off_load_loading", "final_contact_length"),
    ROUGH_PATH: ("final_contact_length", "final_interacting_length"),
    SLIDE: ("static_friction",),
}
"""The quantities whose relative error is asked for where nothing else is said."""
COUNTED = "relative_contact_area"
ORDERS = {COUNTED: 1.0, "final_interacting_length": 1.0}
"""Orders in the grid spacing of errors of what counts points; of all others it is two."""
SECOND = 2.0


@dataclass(frozen=True)
class Relation:
    """A power law: exp of a sum of coefficients times features; spread: standard deviation of its logarithm."""

    coefficients: Mapping[str, float]
    spread: float

    def __call__(self, features: Mapping[str, float], deviations: float = 0.0) -> float:
        """What is expected, or what lies some standard deviations above it."""
        total = sum(factor * features[name] for name, factor in self.coefficients.items())
        return float(np.exp(total + deviations * self.spread))


@dataclass(frozen=True)
class Kind:
    """What is known of one kind of scene.

    errors: by knob and quantity, from features; resolved: by quantity, errors from how well a solution shows its
    contacts, which is known of a wall once it is solved; transforms: of a load, or of a path; begun: part of them that
    is left where a companion was solved before; seconds: those of a load or step, of a transform, and of a transform's
    points times log2 of them; ranges: of the features that were seen.
    """

    errors: Mapping[str, Mapping[str, Relation]]
    resolved: Mapping[str, Relation]
    transforms: Relation
    begun: float
    seconds: Mapping[str, float]
    ranges: Mapping[str, tuple[float, float]]

    def outside(self, features: Mapping[str, float]) -> list[str]:
        """Features beyond all that was measured."""
        return [name for name, (low, high) in self.ranges.items() if not low <= features[name] <= high]


@dataclass(frozen=True)
class Relations:
    """All kinds, and what the transform that is the unit of time took on the machine that they were measured on."""

    unit: float
    kinds: Mapping[str, Kind]


@cache
def relations() -> Relations:
    """The relations of the package."""
    return as_relations(load_yaml(FILE))


def as_relations(told: Mapping) -> Relations:
    """Relations from the numbers of their file."""

    def one(section: Mapping) -> Relation:
        """One relation."""
        return Relation(section["coefficients"], section["spread"])

    kinds = {
        name: Kind(
            {knob: {of: one(law) for of, law in laws.items()} for knob, laws in kind["errors"].items()},
            {of: one(law) for of, law in kind["resolved"].items()},
            one(kind["transforms"]),
            kind["begun"],
            kind["seconds"],
            {feature: tuple(ends) for feature, ends in kind["ranges"].items()},
        )
        for name, kind in told["kinds"].items()
    }
    return Relations(told["unit"], kinds)


def kind_of(scene: Scene) -> str:
    """Which of `KINDS` a scene is; SceneError for one of which nothing was measured."""
    surface, traits = scene.upper.surface, scene.traits
    rough = isinstance(surface, SelfAffine)
    if not (rough or isinstance(surface, Cylinder | Sphere)):
        allowed = "a cylinder, sphere or self-affine surface: others were not measured"
        raise SceneError("surface", type(surface).__name__, allowed)
    if Trait.WALL in traits:
        if Trait.APPROACH in traits:
            raise SceneError("path", "approach", "loads: walls at given approaches were not measured")
        return SURFACE if Trait.SURFACE in traits else LINE
    if Trait.MEAN_PRESSURE in traits:
        raise SceneError("path", "mean_pressure", "approaches: paths under given loads were not measured")
    if scene.sliding:
        if rough:
            raise SceneError("slide", type(surface).__name__, "a slide of a cylinder: rough ones were not measured")
        return SLIDE
    return ROUGH_PATH if rough else PATH


def reach_of(scene: Scene) -> float:
    """The length over which a scene's smooth laws change, nm: the shortest of theirs."""
    return min(effect.interaction_range for effect in scene.effects if Trait.SMOOTH in effect.traits)


def strength_of(scene: Scene) -> float:
    """The strength of a scene's smooth laws together, GPa."""
    return sum(effect.strength for effect in scene.effects if Trait.SMOOTH in effect.traits)


def features(scene: Scene) -> list[dict[str, float]]:
    """What a scene is like, in numbers without units that do not depend on its grid: of each load, or of its path."""
    kind, surface = kind_of(scene), scene.upper.surface
    bodies = scene.elasticities
    found = {"one": 1.0, "rough": 0.0, "hurst": 0.0, "bandwidth": 0.0, "bodies": float(len(bodies))}
    found["layers"] = float(sum(Trait.HALF_SPACE not in body.traits for body in bodies))
    if isinstance(surface, SelfAffine):
        bandwidth = np.log(surface.rolloff_wavelength / surface.finest)
        found |= {"rough": 1.0, "hurst": surface.hurst, "bandwidth": float(bandwidth)}
    if kind in (LINE, SURFACE):
        return [found | _pressed(scene, step.value) for step in scene.path.steps]
    reach, strength = reach_of(scene), strength_of(scene)
    deepest = max(step.value for step in scene.path.steps if step.held is None)
    zone, size = process_zone(scene.contact_modulus, strength, reach), contact_scale(scene)
    found |= {
        "deep": float(np.log(max(deepest, reach) / reach)),
        "steps": float(np.log(len(scene.path.steps))),
        "span": float(np.log(sum(_lengths(scene)) / reach)),
        "zone": float(np.log(size / zone)),
        "strength": float(np.log(strength / scene.contact_modulus)),
        "coupled": float("t" in scene.components),
        "friction": float("t" in scene.exerted),
    }
    return [found]


def _lengths(scene: Scene) -> list[float]:
    """By how much a path changes, step by step; nm."""
    values = [step.value for step in scene.path.steps]
    return [abs(after - before) for before, after in itertools.pairwise(values)] or [1.0]


def _pressed(scene: Scene, pressure: float) -> dict[str, float]:
    """A load's features: logarithms of the reduced pressure and of the area that is expected."""
    surface = scene.upper.surface
    if isinstance(surface, SelfAffine):
        reduced = pressure / (scene.contact_modulus * surface.gradient)
        area = min(1.75 * reduced, 1.0)
    else:
        size = contact_scale(scene, pressure)
        area = min(2 * size, surface.length) / surface.length
        area = area if len(scene.lengths) == 1 else np.pi / 4 * area**2
        reduced = area
    return {"pressure": float(np.log(reduced)), "area": float(np.log(area))}


def contact_scale(scene: Scene, pressure: float = 0.0) -> float:
    """A length, nm, that contacts are measured by: the shortest wavelength, or the half-width or radius of a round one.

    pressure: mean pressure, GPa, on a hard wall; along a path the half-width at the deepest approach is meant.
    """
    surface = scene.upper.surface
    if isinstance(surface, SelfAffine):
        return surface.finest
    if Trait.WALL not in scene.traits:
        deepest = max(step.value for step in scene.path.steps if step.held is None)
        return float(np.sqrt(surface.radius * max(deepest, reach_of(scene))))
    load = pressure * float(np.prod(scene.lengths))
    if len(scene.lengths) == 1:
        return float(np.sqrt(load / reference.cylinder_load(1.0, surface.radius, scene.contact_modulus)))
    return float(np.cbrt(load / reference.sphere_load(1.0, surface.radius, scene.contact_modulus)))
