"""What is done to a scene: a list of load steps.

A step prescribes the mean pressure (GPa) or the approach (nm). Approach is measured from the position in which the
undeformed mean plane of the elastic surface and height zero of the counter-body coincide; the approach of first touch
is then minus the largest height. A path may count from there instead. Surfaces that are pressed may then slide: such a
step prescribes how far the upper body has moved along x, and holds approach or pressure. Paths are joined with `>>`.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from contactsim.errors import SceneError, is_number
from contactsim.grid import Array
from contactsim.traits import Trait

MOST = 1_000_000
"""Steps of a leg that no one means."""


@dataclass(frozen=True)
class LoadStep:
    """One state asked for: control is Trait.MEAN_PRESSURE (value in GPa), Trait.APPROACH or Trait.SLIDE (nm).

    label: how whoever asked for it calls it, for the log; held: while sliding, the approach or pressure that is kept.
    """

    control: Trait
    value: float
    label: str = ""
    held: LoadStep | None = None

    def __post_init__(self) -> None:
        if not is_number(self.value):
            raise SceneError(self.control.name.lower(), self.value, "a finite number")
        if (self.held is not None) != (self.control is Trait.SLIDE):
            raise SceneError("held", self.held, "an approach or a mean pressure while sliding, and only then")

    @property
    def normal(self) -> LoadStep:
        """What is prescribed normal to the surfaces."""
        return self.held or self

    @property
    def slid(self) -> float:
        """How far (nm) the upper body has moved along x."""
        return self.value if self.held else 0.0

    @property
    def text(self) -> str:
        """The step in a few words."""
        return self.label or f"{self.control.name.lower()}={self.value:g}"


@dataclass(frozen=True)
class LoadPath:
    """Load steps in the order in which they are visited; from_touch: their approaches count from first touch."""

    steps: tuple[LoadStep, ...]
    from_touch: bool = False

    def __post_init__(self) -> None:
        sliding = [step.control is Trait.SLIDE for step in self.steps]
        if sliding != sorted(sliding):
            raise SceneError("path", "pressed after sliding", "a path that presses first, then slides")

    def __rshift__(self, later: LoadPath) -> LoadPath:
        if later.from_touch is not self.from_touch:
            raise SceneError("from_touch", later.from_touch, "the same for all parts of a path")
        return LoadPath(self.steps + later.steps, self.from_touch)

    def origin(self, heights: Array) -> float:
        """Approach (nm), from where the mean planes meet, at which those of the steps are zero."""
        return -float(heights.max()) if self.from_touch else 0.0

    def nearest(self, value: float) -> int:
        """Number of the first of the steps that are nearest to a value; SceneError if the path passes none that near.

        Near is within half of the longer increment beside that step. Of a path that slides, steps that slide count.
        """
        values = self._values
        place = int(np.argmin(np.round(np.abs(values - value), 9)))
        beside = np.abs(values[max(place - 1, 0) : place + 2] - values[place])
        beside = beside[np.isfinite(beside)]
        if abs(values[place] - value) > beside.max(initial=0.0) / 2 + 1e-9:
            raise SceneError("snapshots", value, f"values near steps of the path; the nearest is {values[place]:g}")
        return place

    @cached_property
    def _values(self) -> Array:
        """Of each step; infinite of those before the slide of a path that slides."""
        last = self.steps[-1].control
        return np.array([step.value if step.control is last else np.inf for step in self.steps])

    @cached_property
    def traits(self) -> frozenset[Trait]:
        """The kinds of control in use."""
        return frozenset(kind for step in self.steps for kind in (step.control, step.normal.control))


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
    if count > MOST:
        raise SceneError("increment", increment, f"one of at most {MOST} steps from {begin:g} to {end:g}")
    return LoadPath(tuple(LoadStep(control, begin + (end - begin) * k / count) for k in range(1, count + 1)))


def through(control: Trait, points: Sequence[float], increment: float, from_touch: bool = False) -> LoadPath:
    """Through turning points, the first of which is not a step itself, in equal increments of about that size."""
    legs = [leg(control, *ends, increment) for ends in itertools.pairwise(points)]
    return LoadPath(reduce(LoadPath.__rshift__, legs).steps, from_touch)


def slide(points: Sequence[float], increment: float, held: LoadStep, from_touch: bool = False) -> LoadPath:
    """Along x through turning points (nm), the first included, in equal increments of about that size.

    held: the approach or mean pressure under which the surfaces slide.
    """
    values = [points[0], *(step.value for step in through(Trait.APPROACH, points, increment).steps)]
    return LoadPath(tuple(LoadStep(Trait.SLIDE, value, held=held) for value in values), from_touch)
