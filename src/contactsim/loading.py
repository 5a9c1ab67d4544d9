"""What is done to a scene: a list of load steps.

A step prescribes the mean pressure (GPa) or the approach (nm). Approach is measured from the position in which the
undeformed mean plane of the elastic surface and height zero of the counter-body coincide; the approach of first touch
is then minus the largest height. Paths are joined with `>>`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.errors import SceneError
from contactsim.traits import Trait


@dataclass(frozen=True)
class LoadStep:
    """One state asked for: control is Trait.MEAN_PRESSURE (value in GPa) or Trait.APPROACH (value in nm)."""

    control: Trait
    value: float

    def __post_init__(self) -> None:
        pressure = self.control is Trait.MEAN_PRESSURE
        key = "mean_pressure" if pressure else "approach"
        if isinstance(self.value, bool | str) or not np.isfinite(self.value):
            raise SceneError(key, self.value, "a finite number")
        if pressure and self.value < 0:
            raise SceneError(key, self.value, "0 or more, in GPa: without adhesion nothing can pull")


@dataclass(frozen=True)
class LoadPath:
    """Load steps in the order in which they are visited."""

    steps: tuple[LoadStep, ...]

    def __rshift__(self, later: LoadPath) -> LoadPath:
        return LoadPath(self.steps + later.steps)

    @property
    def traits(self) -> frozenset[Trait]:
        """The kinds of control in use."""
        return frozenset(step.control for step in self.steps)


def press(mean_pressures: tuple[float, ...] | list[float]) -> LoadPath:
    """A path through mean pressures (GPa)."""
    return LoadPath(tuple(LoadStep(Trait.MEAN_PRESSURE, value) for value in mean_pressures))


def approach(approaches: tuple[float, ...] | list[float]) -> LoadPath:
    """A path through approaches (nm)."""
    return LoadPath(tuple(LoadStep(Trait.APPROACH, value) for value in approaches))
