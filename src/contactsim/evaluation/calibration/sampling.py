"""Draw scenes at random from stated ranges, for each family that the scaling relations cover."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from contactsim.error_control.knobs import MIN_PRESSING_INCREMENT
from contactsim.error_control.scaling import FAMILIES, LINE, PATH, ROUGH_PATH, SLIDE, SURFACE
from contactsim.errors import InputError
from contactsim.evaluation.figure_settings import FIGURE_KEYS, FigureSettings
from contactsim.study.reading import Key, interval, listed, mapping, positive, read, whole
from contactsim.study.run import Run
from contactsim.study.study import Study
from contactsim.study.tier_overrides import tiered

MAX_SCENES = 1000
"""Most scenes of a kind."""
DRAW_KEYS = {
    "seed": Key(whole(0), "a whole number, 0 or more"),
    "scenes": Key(whole(1, MAX_SCENES), "how many of each kind"),
}
KEYS = FIGURE_KEYS | {
    "calibration": Key(mapping, "a mapping with `seed` and `scenes`"),
    "trial": Key(mapping, "a mapping with `seed` and `scenes`"),
    "errors": Key(listed(positive), "a list of relative errors that are asked for"),
    "kinds": Key(mapping, f"a mapping from some of {', '.join(FAMILIES)} to ranges"),
}
RANGE = Key(interval, "a pair of numbers, the least and the largest")
SHARE = Key(positive, "share of cylinders or spheres")
PERIODS = {LINE: 8, SURFACE: 4, ROUGH_PATH: 8}
"""Roll-off wavelengths in a period."""
MIN_LOGARITHMIC_RATIO = 10.0
"""Ratio of two bounds from which on numbers between them are drawn by their logarithm."""
MAX_POINTS = 2**14
"""Grid points of a scene before a grid is chosen: enough for all its waves."""

Bounds = Sequence[float]
"""The least and the largest value of a quantity."""


def _draw_number(rng: np.random.Generator, bounds: Bounds) -> float:
    """Return a number between two bounds with four digits, uniform in its logarithm where they lie far apart."""
    low, high = bounds
    logarithmic = low > 0 and high / low >= MIN_LOGARITHMIC_RATIO
    value = np.exp(rng.uniform(*np.log(bounds))) if logarithmic else rng.uniform(low, high)
    return float(f"{value:.4g}")


def _draw_surface(family: str, hurst_exponent: Bounds, wavelength_ratio: Bounds, rng: np.random.Generator) -> dict:
    """Return the section of a self-affine surface."""
    length = 10240.0
    rolloff = length / PERIODS[family]
    surface = {
        "kind": "self_affine",
        "hurst_exponent": _draw_number(rng, hurst_exponent),
        "length": length,
        "long_cutoff": rolloff,
    }
    return surface | {
        "short_cutoff": rolloff / _draw_number(rng, wavelength_ratio),
        "amplitudes": "gaussian",
    }


@dataclass(frozen=True)
class WallRanges:
    """Ranges of loads at a hard wall, on a cylinder or sphere, a share of scenes, or on a rough surface."""

    hurst_exponent: Bounds
    wavelength_ratio: Bounds
    round: float
    contact_ratio: Bounds
    reduced_pressure: Bounds

    def draw(self, family: str, rng: np.random.Generator) -> dict:
        """Return the section of a study."""
        section = {"body": {"kind": "half_space", "contact_modulus": 1.0}, "effects": ["hard_wall"]}
        if rng.uniform() < self.round:
            radius = 1000.0
            shape = {LINE: "cylinder", SURFACE: "sphere"}[family]
            load = {"contact_ratio": [_draw_number(rng, self.contact_ratio)]}
            return section | {"surface": {"kind": shape, "radius": radius, "length": radius}, "load": load}
        surface = _draw_surface(family, self.hurst_exponent, self.wavelength_ratio, rng) | {"rms_gradient": 0.1}
        if family == SURFACE:
            surface["dimensions"] = 2
        return section | {"surface": surface, "load": {"reduced_pressure": [_draw_number(rng, self.reduced_pressure)]}}


@dataclass(frozen=True)
class LawRanges:
    """Ranges of a coupled law, of the elastic body and of the deepest approach."""

    FRICTIONLESS: ClassVar[float] = 1 / 3
    """Share of scenes without friction."""

    work_of_separation: Bounds
    poisson_ratio: Bounds
    work_ratio: Bounds
    approach: Bounds

    def draw_law(self, rng: np.random.Generator) -> tuple[dict, dict]:
        """Return the sections of the law and of the elastic body."""
        work, ratio = _draw_number(rng, self.work_of_separation), _draw_number(rng, self.work_ratio)
        ratio = 0.0 if rng.uniform() < self.FRICTIONLESS else ratio
        law = {"work_of_separation": work, "work_ratio": ratio, "normal_length": 1.0, "tangential_length": 1.0}
        elastic = {"youngs_modulus": 70.0, "poisson_ratio": _draw_number(rng, self.poisson_ratio)}
        return {"effects": ["cohesive_zone"], "cohesive_zone": law}, elastic


@dataclass(frozen=True)
class AsperityRanges(LawRanges):
    """Ranges of an adhesive cylinder on a layer."""

    radius: Bounds

    def draw(self, family: str, rng: np.random.Generator) -> dict:
        """Return the section of a study."""
        law, elastic = self.draw_law(rng)
        radius = _draw_number(rng, self.radius)
        surface = {"kind": "cylinder", "radius": radius, "length": 0.4 * radius}
        body = {"kind": "layer", "thickness": 0.2 * radius} | elastic
        path = {"approach": [-10.0, _draw_number(rng, self.approach)], "increment": 1.0}
        return law | {"surface": surface, "body": body, "path": path}


@dataclass(frozen=True)
class RoughRanges(LawRanges):
    """Ranges of an adhesive rough line on a half-space."""

    hurst_exponent: Bounds
    wavelength_ratio: Bounds

    def draw(self, family: str, rng: np.random.Generator) -> dict:
        """Return the section of a study."""
        law, elastic = self.draw_law(rng)
        surface = _draw_surface(family, self.hurst_exponent, self.wavelength_ratio, rng) | {"rms_height": 10.0}
        path = {"approach": [-7.0, _draw_number(rng, self.approach)], "increment": 1.0, "origin": "first_touch"}
        solver = {"kind": "newton", "flow_step": 1.0, "flow_budget": 400}
        body = {"kind": "half_space"} | elastic
        return law | {"surface": surface, "body": body, "path": path, "solver": solver}


@dataclass(frozen=True)
class SlideRanges(LawRanges):
    """Ranges of a cylinder with a layer that slides over a lattice, always with friction."""

    FRICTIONLESS: ClassVar[float] = 0.0

    radius: Bounds

    def draw(self, family: str, rng: np.random.Generator) -> dict:
        """Return the section of a study."""
        law, elastic = self.draw_law(rng)
        radius = _draw_number(rng, self.radius)
        path = {"approach": [-8.0, -4.0], "increment": MIN_PRESSING_INCREMENT}
        return law | {
            "surface": {"kind": "cylinder", "radius": radius, "length": 0.4 * radius},
            "body": {"kind": "rigid"},
            "counter_body": {"kind": "layer", "thickness": 0.4 * radius} | elastic,
            "pairing": {"kind": "lattice", "lattice_constant": 2.44140625, "tangential_cutoff": 5.0},
            "path": path,
            "slide": {"through": [0.0, 18.0], "increment": 0.5, "approach": _draw_number(rng, self.approach)},
        }


Ranges = WallRanges | AsperityRanges | RoughRanges | SlideRanges
FAMILY_RANGES: dict[str, type[Ranges]] = {
    LINE: WallRanges,
    SURFACE: WallRanges,
    PATH: AsperityRanges,
    ROUGH_PATH: RoughRanges,
    SLIDE: SlideRanges,
}
"""The ranges of each family."""
RANGES = {
    family: {entry.name: SHARE if entry.name == "round" else RANGE for entry in fields(ranges)}
    for family, ranges in FAMILY_RANGES.items()
}
"""The keys of ranges by family."""


@dataclass(frozen=True)
class Draws:
    """The seed of scenes, and how many there are of each family."""

    seed: int
    scenes: int


@dataclass(frozen=True)
class Trials(FigureSettings):
    """Scenes that calibrate the relations, scenes on trial, errors to request, and ranges by family."""

    calibration: Draws
    trial: Draws
    errors: Sequence[float]
    kinds: Mapping[str, Ranges]


def read_trials(folder: str | Path, over: dict, tier: str) -> Trials | None:
    """Return the settings of trials.yaml with a tier's changes; None without that file."""
    source = tiered(Path(folder) / "trials.yaml", over, tier)
    if source is None:
        return None
    section, file = source
    settings: dict[str, Any] = read(section, KEYS, file)
    for part in ("calibration", "trial"):
        settings[part] = Draws(**read(settings[part], DRAW_KEYS, file, part))
    for kind, ranges in settings["kinds"].items():
        if kind not in RANGES:
            raise InputError(f"kinds.{kind}", ranges, f"one of {', '.join(FAMILIES)}", file)
    kinds = {
        kind: FAMILY_RANGES[kind](**read(ranges, RANGES[kind], file, f"kinds.{kind}"))
        for kind, ranges in settings["kinds"].items()
    }
    return Trials(**settings | {"kinds": kinds})


def draw_scene(kind: str, ranges: Ranges, seed: int, count: int) -> Run:
    """Return the run of a scene drawn at random.

    Parameters
    ----------
    kind : str
        Family of the scene, of `contactsim.error_control.scaling.FAMILIES`.
    ranges : WallRanges, AsperityRanges, RoughRanges or SlideRanges
        Least and largest value of each quantity that is drawn.
    seed : int
        Seed of all scenes.
    count : int
        Number of the scene.
    """
    rng = np.random.default_rng(np.random.SeedSequence([seed, FAMILIES.index(kind), count]))
    section = ranges.draw(kind, rng)
    name = f"{kind}_{count}"
    shared = {"title": name, "points": MAX_POINTS, "tolerance": 1e-3}
    return Study.read(name, shared | section, "trials.yaml", seed).runs()[0]
