"""Load paths: lists of the steps that are done to a scene.

A step prescribes the mean pressure (GPa) or the approach (nm). Approach is measured from the position in which the
undeformed mean plane of the elastic surface and height zero of the counter-body coincide; the approach of first touch
is then minus the largest height. A path may count from there instead. Surfaces that are pressed may then slide: such a
step prescribes how far the upper body has moved along x, and holds approach or pressure.

A path is a list of parts (`contactsim.contact.steps`). Paths are joined with `>>`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contactsim.arguments import Heights, Numbers, checked
from contactsim.contact.steps import LoadStep, PathPart, Slide, Sweep
from contactsim.errors import InputError, Words
from contactsim.grid import Array
from contactsim.traits import Trait

PARTS = LoadStep, Sweep, Slide
"""Kinds of parts of a path."""


@checked
@dataclass(frozen=True)
class LoadPath:
    """Load steps in the order in which they are visited.

    Parameters
    ----------
    parts : tuple of LoadStep, Sweep or Slide
        What the path consists of.
    from_touch : bool
        True where approaches count from first touch instead of the mean planes.
    """

    parts: tuple[PathPart, ...]
    from_touch: bool = False

    def __post_init__(self) -> None:
        if not self.parts:
            raise InputError("parts", self.parts, "one or more steps, sweeps and slides")
        sliding = [part.slides for part in self.parts]
        if sliding != sorted(sliding):
            raise InputError("path", Words("pressed after sliding"), "a path that presses first, then slides")

    @cached_property
    def steps(self) -> tuple[LoadStep, ...]:
        """All load steps in their order."""
        return tuple(step for part in self.parts for step in part.steps)

    def __rshift__(self, later: LoadPath) -> LoadPath:
        """Return this path followed by another."""
        if later.from_touch is not self.from_touch:
            raise InputError("from_touch", later.from_touch, "the same for all parts of a path")
        return LoadPath(self.parts + later.parts, self.from_touch)

    @property
    def slides(self) -> bool:
        """True where the path ends in a slide."""
        return any(part.slides for part in self.parts)

    @property
    def increment(self) -> float | None:
        """Increment of the slide or, without one, of the last sweep; None for single steps."""
        increments = [part.increment for part in self.parts if part.slides is self.slides and part.increment]
        return increments[-1] if increments else None

    @property
    def turning_points(self) -> tuple[float, ...]:
        """Turning points of the sweeps that press the surfaces."""
        return tuple(value for part in self.parts if not part.slides for value in part.turning_points)

    def with_increment(self, increment: float, pressing: float | None = None) -> LoadPath:
        """Return the same path in other increments.

        Parameters
        ----------
        increment : float
            Increment of the slide or, without one, of the sweeps.
        pressing : float, optional
            Increment of the sweeps before a slide; unchanged without it.
        """

        def edit_part(part: PathPart) -> PathPart:
            """Return a part with its increment."""
            if part.slides is self.slides:
                return part.with_increment(increment)
            return part if pressing is None else part.with_increment(pressing)

        return replace(self, parts=tuple(edit_part(part) for part in self.parts))

    def origin(self, heights: Heights) -> float:
        """Return the approach (nm), counted from the mean planes, at which those of the steps are zero."""
        return -float(heights.max()) if self.from_touch else 0.0

    def nearest(self, value: float) -> int:
        """Return the number of the first step that is nearest to a value.

        Near is within half of the longer increment beside that step. On a path that slides, only sliding steps count.

        Raises
        ------
        InputError
            Where the path passes no step that near.
        """
        values = self._values
        place = int(np.argmin(np.round(np.abs(values - value), 9)))
        beside = np.abs(values[max(place - 1, 0) : place + 2] - values[place])
        beside = beside[np.isfinite(beside)]
        if abs(values[place] - value) > beside.max(initial=0.0) / 2 + 1e-9:
            raise InputError("snapshots", value, f"values near steps of the path; the nearest is {values[place]:g}")
        return place

    @cached_property
    def _values(self) -> Array:
        """Value of each step; infinite for those before the slide of a path that slides."""
        last = self.steps[-1].control
        return np.array([step.value if step.control is last else np.inf for step in self.steps])

    @cached_property
    def traits(self) -> frozenset[Trait]:
        """Kinds of control in use."""
        return frozenset().union(*(part.controls for part in self.parts))

    @cached_property
    def mean_pressures(self) -> tuple[float, ...]:
        """Mean pressures (GPa) of the steps, the smallest and the largest among them; empty without any."""
        return tuple(value for part in self.parts for value in part.mean_pressures)


@checked
def pressures(
    values: Numbers, increment: float | None = None, *, labels: Sequence[str] = (), from_touch: bool = False
) -> LoadPath:
    """Return a path through mean pressures.

    Parameters
    ----------
    values : sequence of float
        Every mean pressure (GPa) of the path or, with an increment, its turning points, the first of which is no step.
    increment : float, optional
        Approximate difference (GPa) between steps.
    labels : sequence of str, optional
        Names of the steps in the log, without an increment.
    from_touch : bool
        True where the approaches of a later part count from first touch instead of the mean planes.
    """
    if increment is not None:
        return sweep(Trait.MEAN_PRESSURE, values, increment, from_touch)
    names = [labels] if isinstance(labels, str) or not isinstance(labels, Sequence) else list(labels)
    if names and len(names) != len(values):
        raise InputError("labels", labels, f"a name for each of the {len(values)} mean pressures, or none")
    pairs = zip(values, names or [""] * len(values), strict=True)
    return LoadPath(tuple(LoadStep(Trait.MEAN_PRESSURE, value, label) for value, label in pairs), from_touch)


@checked
def approaches(values: Numbers, increment: float | None = None, *, from_touch: bool = False) -> LoadPath:
    """Return a path through approaches.

    Parameters
    ----------
    values : sequence of float
        Every approach (nm) of the path or, with an increment, its turning points, the first of which is no step.
    increment : float, optional
        Approximate difference (nm) between steps.
    from_touch : bool
        True where approaches count from first touch instead of the mean planes.
    """
    if increment is not None:
        return sweep(Trait.APPROACH, values, increment, from_touch)
    return LoadPath(tuple(LoadStep(Trait.APPROACH, value) for value in values), from_touch)


@checked
def sliding(
    turning_points: Sequence[float],
    increment: float,
    *,
    approach: float | None = None,
    mean_pressure: float | None = None,
    from_touch: bool = False,
) -> LoadPath:
    """Return a path that slides along x under a held approach or mean pressure.

    Parameters
    ----------
    turning_points : sequence of float
        Two or more sliding distances (nm), the first included.
    increment : float
        Approximate distance (nm) between steps.
    approach, mean_pressure : float
        Approach (nm) or mean pressure (GPa) that is held; exactly one.
    from_touch : bool
        True where approaches count from first touch instead of the mean planes.
    """
    held = load_step(approach, mean_pressure, "held")
    return LoadPath((Slide(tuple(turning_points), increment, held),), from_touch)


def load_step(approach: float | None, mean_pressure: float | None, key: str) -> LoadStep:
    """Return the step of the one value that there is, an approach (nm) or a mean pressure (GPa).

    Raises
    ------
    InputError
        For both or neither; it names the key.
    """
    if approach is not None and mean_pressure is None:
        return LoadStep(Trait.APPROACH, approach)
    if mean_pressure is not None and approach is None:
        return LoadStep(Trait.MEAN_PRESSURE, mean_pressure)
    values = {"mean_pressure": mean_pressure, "approach": approach}
    raise InputError(key, values, "exactly one of mean_pressure and approach")


def sweep(control: Trait, turning_points: Sequence[float], increment: float, from_touch: bool = False) -> LoadPath:
    """Return a path through turning points of an approach or a mean pressure; see `Sweep`."""
    return LoadPath((Sweep(control, tuple(turning_points), increment),), from_touch)
