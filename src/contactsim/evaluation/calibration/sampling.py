"""Draw scenes at random from stated ranges, for each family that the scaling relations cover."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from contactsim.error_control.knobs import MIN_PRESSING_INCREMENT
from contactsim.error_control.scaling import FAMILIES, LINE, PATH, ROUGH_PATH, SLIDE, SURFACE
from contactsim.errors import InputError
from contactsim.study.reading import Key, listed, mapping, pair, positive, read, size, text, tiered, whole
from contactsim.study.run import Run
from contactsim.study.study import Study

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
ROUGH = dict.fromkeys(("hurst_exponent", "wavelength_ratio"), RANGE)
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
MIN_LOGARITHMIC_RATIO = 10.0
"""Ratio of two bounds from which on numbers between them are drawn by their logarithm."""
MAX_POINTS = 2**14
"""Grid points of a scene before a grid is chosen: enough for all its waves."""


def read_trials(folder: str | Path, over: dict, tier: str) -> dict | None:
    """Return the settings of trials.yaml with a tier's changes; None without that file."""
    source = tiered(Path(folder) / "trials.yaml", over, tier)
    if source is None:
        return None
    section, file = source
    settings = read(section, KEYS, file)
    for part in ("calibration", "trial"):
        settings[part] = read(settings[part], DRAW_KEYS, file, part)
    for kind, section in settings["kinds"].items():
        if kind not in RANGES:
            raise InputError(f"kinds.{kind}", section, f"one of {', '.join(FAMILIES)}", file)
        settings["kinds"][kind] = read(section, RANGES[kind], file, f"kinds.{kind}")
    return settings


def draw_scene(kind: str, ranges: Mapping[str, list[float]], seed: int, count: int) -> Run:
    """Return the run of a scene drawn at random.

    Parameters
    ----------
    kind : str
        Family of the scene, of `contactsim.error_control.scaling.FAMILIES`.
    ranges : mapping
        Least and largest value of each quantity that is drawn.
    seed : int
        Seed of all scenes.
    count : int
        Number of the scene.
    """
    rng = np.random.default_rng(np.random.SeedSequence([seed, FAMILIES.index(kind), count]))
    section = SECTIONS[kind](kind, ranges, rng)
    name = f"{kind}_{count}"
    shared = {"title": name, "points": MAX_POINTS, "tolerance": 1e-3}
    return Study.read(name, shared | section, "trials.yaml", seed).runs()[0]


def _draw_number(rng: np.random.Generator, bounds: list[float]) -> float:
    """Return a number between two bounds with four digits, uniform in its logarithm where they lie far apart."""
    low, high = bounds
    logarithmic = low > 0 and high / low >= MIN_LOGARITHMIC_RATIO
    value = np.exp(rng.uniform(*np.log(bounds))) if logarithmic else rng.uniform(low, high)
    return float(f"{value:.4g}")


def _draw_surface(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    """Return the section of a self-affine surface."""
    length = 10240.0
    rolloff = length / PERIODS[kind]
    surface = {
        "kind": "self_affine",
        "hurst_exponent": _draw_number(rng, ranges["hurst_exponent"]),
        "length": length,
        "long_cutoff": rolloff,
    }
    return surface | {
        "short_cutoff": rolloff / _draw_number(rng, ranges["wavelength_ratio"]),
        "amplitudes": "gaussian",
    }


def _hard_wall_section(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    """Return a load at a hard wall, on a cylinder or sphere or on a rough surface."""
    section = {"body": {"kind": "half_space", "contact_modulus": 1.0}, "effects": ["hard_wall"]}
    if rng.uniform() < ranges["round"]:
        radius = 1000.0
        shape = {LINE: "cylinder", SURFACE: "sphere"}[kind]
        load = {"contact_ratio": [_draw_number(rng, ranges["contact_ratio"])]}
        return section | {"surface": {"kind": shape, "radius": radius, "length": radius}, "load": load}
    surface = _draw_surface(kind, ranges, rng) | {"rms_gradient": 0.1}
    if kind == SURFACE:
        surface["dimensions"] = 2
    return section | {"surface": surface, "load": {"reduced_pressure": [_draw_number(rng, ranges["reduced_pressure"])]}}


def _draw_law(ranges: Mapping, rng: np.random.Generator, frictionless: float = 1 / 3) -> tuple[dict, dict]:
    """Return the sections of a coupled law, for a share of scenes without friction, and of the elastic body."""
    work, ratio = _draw_number(rng, ranges["work_of_separation"]), _draw_number(rng, ranges["work_ratio"])
    ratio = 0.0 if rng.uniform() < frictionless else ratio
    law = {"work_of_separation": work, "work_ratio": ratio, "normal_length": 1.0, "tangential_length": 1.0}
    elastic = {"youngs_modulus": 70.0, "poisson_ratio": _draw_number(rng, ranges["poisson_ratio"])}
    return {"effects": ["cohesive_zone"], "cohesive_zone": law}, elastic


def _asperity_section(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    """Return a path of an adhesive cylinder on a layer."""
    law, elastic = _draw_law(ranges, rng)
    radius = _draw_number(rng, ranges["radius"])
    surface = {"kind": "cylinder", "radius": radius, "length": 0.4 * radius}
    body = {"kind": "layer", "thickness": 0.2 * radius} | elastic
    path = {"approach": [-10.0, _draw_number(rng, ranges["approach"])], "increment": 1.0}
    return law | {"surface": surface, "body": body, "path": path}


def _rough_section(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    """Return a path of an adhesive rough line on a half-space."""
    law, elastic = _draw_law(ranges, rng)
    surface = _draw_surface(kind, ranges, rng) | {"rms_height": 10.0}
    path = {"approach": [-7.0, _draw_number(rng, ranges["approach"])], "increment": 1.0, "origin": "first_touch"}
    solver = {"kind": "newton", "flow_step": 1.0, "flow_budget": 400}
    body = {"kind": "half_space"} | elastic
    return law | {"surface": surface, "body": body, "path": path, "solver": solver}


def _slide_section(kind: str, ranges: Mapping, rng: np.random.Generator) -> dict:
    """Return a cylinder with a layer that slides over a lattice."""
    law, elastic = _draw_law(ranges, rng, frictionless=0.0)
    radius = _draw_number(rng, ranges["radius"])
    path = {"approach": [-8.0, -4.0], "increment": MIN_PRESSING_INCREMENT}
    return law | {
        "surface": {"kind": "cylinder", "radius": radius, "length": 0.4 * radius},
        "body": {"kind": "rigid"},
        "counter_body": {"kind": "layer", "thickness": 0.4 * radius} | elastic,
        "pairing": {"kind": "lattice", "lattice_constant": 2.44140625, "tangential_cutoff": 5.0},
        "path": path,
        "slide": {"through": [0.0, 18.0], "increment": 0.5, "approach": _draw_number(rng, ranges["approach"])},
    }


SECTIONS: dict[str, Callable[[str, Mapping, np.random.Generator], dict]] = {
    LINE: _hard_wall_section,
    SURFACE: _hard_wall_section,
    PATH: _asperity_section,
    ROUGH_PATH: _rough_section,
    SLIDE: _slide_section,
}
"""The function that draws a study's section, by family."""
