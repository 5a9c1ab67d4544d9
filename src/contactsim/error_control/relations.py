"""Relations between error, cost and a scene, measured once and read from a file.

Each relation is a power law in a few numbers that describe the scene, its `features`, with its scatter over the scenes
that it was fitted to. The grid may also enter by the number of its points in a process zone, on which an error then
depends exponentially: so does the barrier that a grid puts before the front of a slip.
`contactsim.evaluation.calibration.fit` fits them; none of the scenes that judge them took part.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from math import exp, log
from pathlib import Path
from typing import Any

import numpy as np
import yaml

FILE = Path(__file__).with_name("scaling.yaml")
ZONE_POINTS = "zone_points"
"""Feature that follows from the others: grid points in a process zone."""
MIN_ZONE_POINTS = 1.0
"""Fewest points in a process zone that a relation is solved for."""
MIN_POWER = 0.3
"""Powers of a knob below it count as none."""


@dataclass(frozen=True)
class Relation:
    """A power law in the features of a scene.

    Parameters
    ----------
    coefficients : mapping from str to float
        Factor of each feature; their sum is the logarithm of the value.
    spread : float
        Standard deviation of the logarithm over the scenes that were fitted.
    """

    coefficients: Mapping[str, float]
    spread: float

    def __call__(self, features: Mapping[str, float]) -> float:
        """Return the expected value."""
        return float(np.exp(sum(factor * _read_feature(name, features) for name, factor in self.coefficients.items())))

    def solve(self, knob: str, features: Mapping[str, float], value: float) -> float | None:
        """Return the logarithm of a knob at which a value is expected; None where it hardly depends on the knob."""
        name = ZONE_POINTS if knob == "grid" and ZONE_POINTS in self.coefficients else knob
        if name == knob and not self.coefficients.get(knob, 0.0) > MIN_POWER:
            return None
        rest = sum(factor * features[other] for other, factor in self.coefficients.items() if other != name)
        solution = (log(value) - rest) / self.coefficients[name]
        return solution if name == knob else -log(max(solution, MIN_ZONE_POINTS)) - features["zone"]


def _read_feature(name: str, features: Mapping[str, float]) -> float:
    """Return a feature, or the one that follows from others."""
    return exp(-features["grid"] - features["zone"]) if name == ZONE_POINTS else features[name]


@dataclass(frozen=True)
class Family:
    """Relations for one family of scenes.

    Parameters
    ----------
    errors : mapping
        Relative error by knob ("points", "tolerance", "increment") and quantity.
    resolved : mapping
        Relative error by quantity from how well a solution resolves its contacts; for hard walls alone.
    transforms : Relation
        Transforms of a load or of a path.
    warm_start : float
        Part of the transforms that is left where a coarse companion was solved before.
    seconds : mapping
        CPU seconds of a load or step, of a transform, and of a transform's points times their binary logarithm.
    ranges : mapping
        Least and largest value of each feature that was measured.
    """

    errors: Mapping[str, Mapping[str, Relation]]
    resolved: Mapping[str, Relation]
    transforms: Relation
    warm_start: float
    seconds: Mapping[str, float]
    ranges: Mapping[str, tuple[float, float]]

    def outside(self, features: Mapping[str, float]) -> list[str]:
        """Return the features beyond all that was measured."""
        return [name for name, (low, high) in self.ranges.items() if not low <= features[name] <= high]


@dataclass(frozen=True)
class ScalingRelations:
    """All families, and the seconds of a transform (the unit of time) on the machine that measured them."""

    unit: float
    families: Mapping[str, Family]


@cache
def scaling_relations() -> ScalingRelations:
    """Return the relations of the package."""
    return build_relations(read_data_file(FILE))


def read_data_file(file: Path) -> dict[str, Any]:
    """Return the mapping in a YAML file of the package."""
    return yaml.load(file.read_text(encoding="utf-8"), getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def build_relations(numbers: Mapping[str, Any]) -> ScalingRelations:
    """Return relations from the numbers of their file."""

    def relation(section: Mapping[str, Any]) -> Relation:
        """Return one relation."""
        return Relation(section["coefficients"], section["spread"])

    families = {
        name: Family(
            errors={
                knob: {quantity: relation(law) for quantity, law in laws.items()}
                for knob, laws in section["errors"].items()
            },
            resolved={quantity: relation(law) for quantity, law in section["resolved"].items()},
            transforms=relation(section["transforms"]),
            warm_start=section["warm_start"],
            seconds=section["seconds"],
            ranges={feature: tuple(ends) for feature, ends in section["ranges"].items()},
        )
        for name, section in numbers["families"].items()
    }
    return ScalingRelations(numbers["unit"], families)
