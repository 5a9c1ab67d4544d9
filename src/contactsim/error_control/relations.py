"""Relations between error, cost and a scene, measured once and read from a file.

Each relation is a power law in a few numbers that describe the scene, its `features`, with its scatter over the scenes
that it was fitted to. `contactsim.evaluation.calibration.fit` fits them; none of the scenes that judge them took part.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

FILE = Path(__file__).with_name("scaling.yaml")


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

    def __call__(self, features: Mapping[str, float], deviations: float = 0.0) -> float:
        """Return the expected value, or one that lies some standard deviations above it."""
        total = sum(factor * features[name] for name, factor in self.coefficients.items())
        return float(np.exp(total + deviations * self.spread))


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
