"""Relations between the work of a run and its scene, measured once and read from a file; they tell no error.

Each is a power law in numbers that tell the work. `contactsim.evaluation.calibration.fit` fits them.
"""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

import numpy as np

from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Scene
from contactsim.error_control.grids import (
    expected_points,
    round_grid,
    shortest_range,
    shortest_wave,
    total_strength,
)
from contactsim.error_control.measured import is_measured
from contactsim.errors import InputError
from contactsim.grid import Grid
from contactsim.paths.options import Setup
from contactsim.paths.requested import Requested
from contactsim.status import process_zone
from contactsim.surfaces.open_statistics import rms_gradient_open
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.traits import Trait

FILE = Path(__file__).with_name("scaling.json")
FAMILIES = (
    *("wall_line", "rough_wall_line", "wall_surface", "rough_wall_surface"),
    *("path_line", "rough_path_line", "path_surface", "slide"),
)
"""Families of runs, each with its own relations: loads at a hard wall and paths of cohesive laws, by dimension, smooth
and rough; and slides."""
TYPICAL_KAPPA = 1.75
"""Contact area over reduced pressure of a lightly loaded rough surface, about that of Persson and of Bush."""
LEAST = 1e-4
"""Least expected contact area."""
TYPICAL_ERROR = 0.1
"""Error for which a grid shows the slopes of a surface well enough for its work."""


@dataclass(frozen=True)
class Family:
    """Relations for one family of runs.

    Parameters
    ----------
    transforms : mapping from str to float
        Factor of each feature; their sum is the logarithm of the transforms of a load or of a path.
    units : mapping
        Time of a load or step, of a transform, and of a transform's points times their binary logarithm, in that of one
        transform of 4096 points.
    ranges : mapping
        Least and largest value of each feature that was measured.
    """

    transforms: Mapping[str, float]
    units: Mapping[str, float]
    ranges: Mapping[str, tuple[float, float]]

    def work(self, features: Mapping[str, float]) -> float:
        """Return the expected transforms of a load or of a path."""
        return float(np.exp(sum(factor * features[name] for name, factor in self.transforms.items())))

    def outside(self, features: Mapping[str, float]) -> list[str]:
        """Return the features beyond all that was measured."""
        return [name for name, (low, high) in self.ranges.items() if not low <= features[name] <= high]


@cache
def cost_relations() -> dict[str, Family]:
    """Return the relations of all families."""
    families = json.loads(FILE.read_text(encoding="utf-8"))
    return {name: Family(**section) for name, section in families.items()}


def run_family(scene: Scene) -> str:
    """Return the family of a scene."""
    if scene.sliding:
        return "slide"
    kind = "wall" if scene.kind is ProblemKind.HARD_WALL else "path"
    name = f"{kind}_{'line' if len(scene.lengths) == 1 else 'surface'}"
    rough = is_measured(scene) or any(isinstance(body.surface, SelfAffine) for body in (scene.lower, scene.upper))
    return f"rough_{name}" if rough and f"rough_{name}" in FAMILIES else name


@lru_cache(maxsize=8)
def _rms_gradient(scene: Scene, points: int) -> float:
    """Return the rms gradient of the heights of a scene on a coarse grid."""
    heights = scene.heights(points)
    return float(rms_gradient_open(heights, Grid(heights.shape, scene.lengths).spacing))


def features(setup: Setup) -> list[dict[str, float]]:
    """Return numbers without units, most of them logarithms, that tell the work of each load or of a path."""
    scene, size = setup.scene, setup.size
    tolerance = math.log(setup.options.tolerance)
    numbers = {
        "one": 1.0,
        "size": math.log(size),
        "waves": math.log(max(scene.length / shortest_wave(scene), 1.0)),
        "tolerance": tolerance,
        "free": float(not scene.repeats),
        "layers": float(any(Trait.LAYER in body.traits for body in scene.elasticities)),
    }
    if scene.kind is ProblemKind.HARD_WALL:
        if Trait.APPROACH in scene.traits:
            raise InputError("path", "approach", "loads: the costs of walls at given approaches were not measured")
        enough = setup.points if is_measured(scene) else round_grid(expected_points(scene, TYPICAL_ERROR))
        gradient = _rms_gradient(scene, min(setup.points, enough))
        unit = max(scene.contact_modulus * gradient, 1e-300)  # GPa, of reduced pressures
        areas = [np.clip(TYPICAL_KAPPA * abs(step.value) / unit, LEAST, 1.0) for step in scene.path.steps]
        return [numbers | {"area": math.log(area)} for area in areas]
    if math.isfinite(scene.pairing.lattice_constant):
        raise InputError("pairing", "lattice", "facing points: the costs of lattices were not measured")
    zone = process_zone(scene.contact_modulus, total_strength(scene), shortest_range(scene))
    values = [step.value for step in scene.path.steps]
    travel = sum(abs(after - before) for before, after in itertools.pairwise(values))
    by_load = scene.path.steps[-1].control is Trait.MEAN_PRESSURE
    numbers |= {
        "steps": math.log(len(values)),
        "span": 0.0 if by_load else math.log1p(travel / shortest_range(scene)),
        "load": float(by_load),
        "zone": math.log(zone * setup.points / scene.length),
        "strength": math.log(total_strength(scene) / scene.contact_modulus),
        "coupled": float("t" in scene.components),
        "friction": float("t" in scene.exerted),
        "walled": float(Trait.WALL in scene.traits),
        "every": float(isinstance(setup.options.increments, Requested | None)),
    }
    return [numbers]
