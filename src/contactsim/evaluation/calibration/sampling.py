"""Scenes drawn at random from stated ranges, of each kind that relations of accuracy and cost are known of."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from contactsim.error_control.options import MIN_PRESSING_INCREMENT
from contactsim.error_control.scaling import FAMILIES, LINE, PATH, ROUGH_PATH, SLIDE, SURFACE
from contactsim.errors import InputError
from contactsim.study.reading import Key, listed, mapping, pair, positive, read, size, text, tiered, whole
from contactsim.study.study import Run, Study

DRAW_KEYS = {"seed": Key(whole(0), "a whole number, 0 or more"), "scenes": Key(whole(1), "how many of each kind")}
KEYS = {
    "title": Key(text, "a line of text"),
    "caption": Key(text, "text"),
    "size": Key(size, "width and height in inches"),
    "calibration": Key(mapping, "a mapping with `seed` and `scenes`"),
    "trial": Key(mapping, "a mapping with `seed` and `scenes`"),
    "errors": Key(listed(positive), "a list of relative errors that are asked for"),
    "kinds": Key(mapping, f"a mapping from some of {', '.join(FAMILIES)} to ranges"),
}
RANGE = Key(pair, "a pair of numbers, the least and the largest")
ROUGH = dict.fromkeys(("hurst", "wavelength_ratio"), RANGE)
LAW = dict.fromkeys(("work_of_separation", "poisson_ratio", "work_ratio", "approach"), RANGE)
WALL = ROUGH | {
    "round": Key(positive, "share of cylinders or spheres"),
    "contact_ratio": RANGE,
    "reduced_pressure": RANGE,
}
RANGES = {
    LINE: WALL,
    SURFACE: WALL,
    PATH: LAW | {"radius": RANGE},
    ROUGH_PATH: LAW | ROUGH,
    SLIDE: LAW | {"radius": RANGE},
}
PERIODS = {LINE: 8, SURFACE: 4, ROUGH_PATH: 8}
"""Roll-off wavelengths in a period."""
DECADE = 10.0
FINE = 2**14
"""Points of a scene's grid as long as none is chosen: enough for all waves of any."""


def read_draws(folder: str | Path, over: dict, tier: str) -> dict | None:
    """Settings of trials.yaml, with what a tier changes; None without that file."""
    given = tiered(Path(folder) / "trials.yaml", over, tier)
    if given is None:
        return None
    section, file = given
    settings = read(section, KEYS, file)
    for part in ("calibration", "trial"):
        settings[part] = read(settings[part], DRAW_KEYS, file, part)
    for kind, section in settings["kinds"].items():
        if kind not in RANGES:
            raise InputError(f"kinds.{kind}", section, f"one of {', '.join(FAMILIES)}", file)
        settings["kinds"][kind] = read(section, RANGES[kind], file, f"kinds.{kind}")
    return settings


def draw(kind: str, ranges: Mapping[str, list[float]], seed: int, count: int) -> Run:
    """The run of one scene of a kind: number `count` of those that a seed leads to."""
    rng = np.random.default_rng(np.random.SeedSequence([seed, FAMILIES.index(kind), count]))
    section = {LINE: _wall, SURFACE: _wall, PATH: _asperity, ROUGH_PATH: _rough, SLIDE: _slide}[kind](kind, ranges, rng)
    name = f"{kind}_{count}"
    given = {"title": name, "points": FINE, "tolerance": 1e-3}
    return Study.read(name, given | section, "trials.yaml", seed).runs()[0]


def _within(rng: np.random.Generator, ends: list[float]) -> float:
    """A number between two, by its logarithm where they lie far apart; to four digits."""
    low, high = ends
    far = low > 0 and high / low >= DECADE
    value = np.exp(rng.uniform(*np.log(ends))) if far else rng.uniform(low, high)
    return float(f"{value:.4g}")


def _self_affine(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    length = 10240.0
    rolloff = length / PERIODS[kind]
    found = {
        "kind": "self_affine",
        "hurst": _within(rng, ranges["hurst"]),
        "length": length,
        "rolloff_wavelength": rolloff,
    }
    return found | {"shortest_wavelength": rolloff / _within(rng, ranges["wavelength_ratio"]), "amplitudes": "gaussian"}


def _wall(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    section = {"body": {"kind": "half_space", "contact_modulus": 1.0}, "effects": ["hard_wall"]}
    if rng.uniform() < ranges["round"]:
        radius = 1000.0
        shape = {LINE: "cylinder", SURFACE: "sphere"}[kind]
        load = {"contact_ratio": [_within(rng, ranges["contact_ratio"])]}
        return section | {"surface": {"kind": shape, "radius": radius, "length": radius}, "load": load}
    surface = _self_affine(kind, ranges, rng) | {"rms_gradient": 0.1}
    if kind == SURFACE:
        surface["dimensions"] = 2
    return section | {"surface": surface, "load": {"reduced_pressure": [_within(rng, ranges["reduced_pressure"])]}}


def _law(ranges: Mapping, rng: np.random.Generator, frictionless: float = 1 / 3) -> tuple[dict, dict]:
    """A coupled law, a share of them without friction; and Poisson's ratio."""
    work, ratio = _within(rng, ranges["work_of_separation"]), _within(rng, ranges["work_ratio"])
    ratio = 0.0 if rng.uniform() < frictionless else ratio
    law = {"work_of_separation": work, "work_ratio": ratio, "normal_length": 1.0, "tangential_length": 1.0}
    elastic = {"youngs_modulus": 70.0, "poisson_ratio": _within(rng, ranges["poisson_ratio"])}
    return {"effects": ["cohesive_zone"], "cohesive_zone": law}, elastic


def _asperity(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    law, elastic = _law(ranges, rng)
    radius = _within(rng, ranges["radius"])
    surface = {"kind": "cylinder", "radius": radius, "length": 0.4 * radius}
    body = {"kind": "layer", "thickness": 0.2 * radius} | elastic
    path = {"approach": [-10.0, _within(rng, ranges["approach"])], "increment": 1.0}
    return law | {"surface": surface, "body": body, "path": path}


def _rough(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    law, elastic = _law(ranges, rng)
    surface = _self_affine(kind, ranges, rng) | {"rms_height": 10.0}
    path = {"approach": [-7.0, _within(rng, ranges["approach"])], "increment": 1.0, "origin": "first_touch"}
    solver = {"kind": "newton", "flow_step": 1.0, "flow_budget": 400}
    body = {"kind": "half_space"} | elastic
    return law | {"surface": surface, "body": body, "path": path, "solver": solver}


def _slide(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    law, elastic = _law(ranges, rng, frictionless=0.0)
    radius = _within(rng, ranges["radius"])
    path = {"approach": [-8.0, -4.0], "increment": MIN_PRESSING_INCREMENT}
    return law | {
        "surface": {"kind": "cylinder", "radius": radius, "length": 0.4 * radius},
        "body": {"kind": "rigid"},
        "counter_body": {"kind": "layer", "thickness": 0.4 * radius} | elastic,
        "pairing": {"kind": "lattice", "lattice_constant": 2.44140625, "tangential_cutoff": 5.0},
        "path": path,
        "slide": {"through": [0.0, 18.0], "increment": 0.5, "approach": _within(rng, ranges["approach"])},
    }
