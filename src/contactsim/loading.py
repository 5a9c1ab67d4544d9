"""What is done to a scene: a list of load steps.

A step prescribes the mean pressure (GPa) or the approach (nm). Approach is measured from the position in which the
undeformed mean plane of the elastic surface and height zero of the counter-body coincide; the approach of first touch
is then minus the largest height. A path may count from there instead. Paths are joined with `>>`.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np

from contactsim.errors import SceneError, is_number
from contactsim.grid import Array
from contactsim.traits import Trait


@dataclass(frozen=True)
class LoadStep:
    """One state asked for: control is Trait.MEAN_PRESSURE (value in GPa) or Trait.APPROACH (value in nm).

    label: how whoever asked for it calls it, for the log.
    """

    control: Trait
    value: float
    label: str = ""

    def __post_init__(self) -> None:
        pressure = self.control is Trait.MEAN_PRESSURE
        key = "mean_pressure" if pressure else "approach"
        if not is_number(self.value):
            raise SceneError(key, self.value, "a finite number")

    @property
    def text(self) -> str:
        """The step in a few words."""
        return self.label or f"{self.control.name.lower()}={self.value:g}"


@dataclass(frozen=True)
class LoadPath:
    """Load steps in the order in which they are visited; from_touch: their approaches count from first touch."""

    steps: tuple[LoadStep, ...]
    from_touch: bool = False

    def __rshift__(self, later: LoadPath) -> LoadPath:
        if later.from_touch is not self.from_touch:
            raise SceneError("from_touch", later.from_touch, "the same for all parts of a path")
        return LoadPath(self.steps + later.steps, self.from_touch)

    def origin(self, heights: Array) -> float:
        """Approach (nm), from where the mean planes meet, at which those of the steps are zero."""
        return -float(heights.max()) if self.from_touch else 0.0

    def nearest(self, value: float) -> int:
        """Number of the first of the steps that are nearest to a value; SceneError if the path passes none that near.

        Near is within half of the longer increment beside that step.
        """
        values = np.array([step.value for step in self.steps])
        place = int(np.argmin(np.round(np.abs(values - value), 9)))
        beside = np.abs(np.diff(values[max(place - 1, 0) : place + 2]))
        if abs(values[place] - value) > beside.max(initial=0.0) / 2 + 1e-9:
            raise SceneError("snapshots", value, f"values near steps of the path; the nearest is {values[place]:g}")
        return place

    @property
    def traits(self) -> frozenset[Trait]:
        """The kinds of control in use."""
        return frozenset(step.control for step in self.steps)


def press(mean_pressures: Sequence[float], labels: Sequence[str] = ()) -> LoadPath:
    """A path through mean pressures (GPa), with a label for each if they have other names."""
    labels = labels or [""] * len(mean_pressures)
    pairs = zip(mean_pressures, labels, strict=True)
    return LoadPath(tuple(LoadStep(Trait.MEAN_PRESSURE, value, label) for value, label in pairs))


def approach(approaches: Sequence[float]) -> LoadPath:
    """A path through approaches (nm)."""
    return LoadPath(tuple(LoadStep(Trait.APPROACH, value) for value in approaches))


def leg(control: Trait, begin: float, end: float, increment: float) -> LoadPath:
    """From a value, exclusive, to another, inclusive, in equal increments of about that size."""
    count = max(round(abs(end - begin) / increment), 1)
    return LoadPath(tuple(LoadStep(control, begin + (end - begin) * k / count) for k in range(1, count + 1)))


def through(control: Trait, points: Sequence[float], increment: float, from_touch: bool = False) -> LoadPath:
    """Through turning points, the first of which is not a step itself, in equal increments of about that size."""
    legs = [leg(control, *ends, increment) for ends in itertools.pairwise(points)]
    return LoadPath(reduce(LoadPath.__rshift__, legs).steps, from_touch)
