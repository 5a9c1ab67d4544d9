"""Parts of a load path: single steps, sweeps through turning points, and slides.

A step prescribes the mean pressure (GPa) or the approach (nm); while sliding, it prescribes how far the upper body has
moved along x, and holds approach or pressure. A sweep and a slide keep their increment, so that the same path can be
followed in longer or shorter increments.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated, Protocol

from contactsim.arguments import Only, Positive, checked
from contactsim.errors import NUMBER, InputError, is_number
from contactsim.traits import Trait

MAX_STEPS = 1_000_000
"""Most steps between two turning points."""


class PathPart(Protocol):
    """A part of a load path."""

    @property
    def steps(self) -> tuple[LoadStep, ...]:
        """Load steps in their order."""
        ...

    @property
    def increment(self) -> float | None:
        """Increment (GPa or nm) between steps; None for a single step."""
        ...

    @property
    def turning_points(self) -> tuple[float, ...]:
        """Values between which the steps lie; empty for a single step."""
        ...

    @property
    def slides(self) -> bool:
        """True where the part moves the surfaces along each other."""
        ...

    @property
    def controls(self) -> frozenset[Trait]:
        """Kinds of control of its steps."""
        ...

    @property
    def mean_pressures(self) -> tuple[float, ...]:
        """Mean pressures (GPa) of its steps, the smallest and the largest among them; empty without any."""
        ...

    def with_increment(self, increment: float) -> PathPart:
        """Return the same part in increments of about that size."""
        ...


@dataclass(frozen=True)
class LoadStep:
    """One load step.

    Parameters
    ----------
    control : Trait
        `Trait.MEAN_PRESSURE`, `Trait.APPROACH` or `Trait.SLIDE`.
    value : float
        Mean pressure in GPa, approach or sliding distance in nm.
    label : str
        Name of the step in the log.
    held : LoadStep, optional
        Approach or mean pressure that is kept while sliding.
    """

    control: Trait
    value: float
    label: str = ""
    held: LoadStep | None = None

    def __post_init__(self) -> None:
        if not is_number(self.value):
            raise InputError(self.control.name.lower(), self.value, NUMBER)
        if not isinstance(self.label, str):
            raise InputError("labels", self.label, "text")
        if (self.held is not None) != (self.control is Trait.SLIDE):
            raise InputError("held", self.held, "an approach or a mean pressure while sliding, and only then")

    @property
    def normal(self) -> LoadStep:
        """Step that prescribes the approach or the mean pressure."""
        return self.held or self

    @property
    def steps(self) -> tuple[LoadStep, ...]:
        """The step itself: a single step is a part of a path."""
        return (self,)

    @property
    def increment(self) -> None:
        """None: a single step has no increment."""
        return None

    @property
    def turning_points(self) -> tuple[float, ...]:
        """Empty: a single step has no turning points."""
        return ()

    @property
    def slides(self) -> bool:
        """True for a step of a slide."""
        return self.control is Trait.SLIDE

    @property
    def controls(self) -> frozenset[Trait]:
        """Its kind of control, and that of what it holds."""
        return frozenset({self.control, self.normal.control})

    @property
    def mean_pressures(self) -> tuple[float, ...]:
        """The mean pressure (GPa) that it prescribes or holds; empty without one."""
        return (self.normal.value,) if self.normal.control is Trait.MEAN_PRESSURE else ()

    def with_increment(self, increment: float) -> LoadStep:
        """Return the step itself."""
        return self

    @property
    def sliding_distance(self) -> float:
        """Distance (nm) that the upper body has moved along x."""
        return self.value if self.held else 0.0

    @property
    def text(self) -> str:
        """Label, or control and value."""
        return self.label or f"{self.control.name.lower()}={self.value:g}"


TurningPoints = Annotated[tuple[float, ...], Only("a list of two or more numbers", lambda values: len(values) > 1)]
Steps = Annotated[Sequence[LoadStep], Only("one or more load steps", bool)]


@checked
@dataclass(frozen=True)
class Sweep:
    """Approaches or mean pressures through turning points, in equal increments.

    Parameters
    ----------
    control : Trait
        `Trait.MEAN_PRESSURE` (GPa) or `Trait.APPROACH` (nm).
    turning_points : tuple of float
        Two or more values; the first is not a step itself.
    increment : float
        Approximate difference between steps.
    """

    control: Trait
    turning_points: TurningPoints
    increment: Positive
    slides = False

    @property
    def steps(self) -> tuple[LoadStep, ...]:
        """Load steps in their order."""
        return _sweep_steps(self.control, self.turning_points, self.increment)

    @property
    def controls(self) -> frozenset[Trait]:
        """Its kind of control."""
        return frozenset({self.control})

    @property
    def mean_pressures(self) -> tuple[float, ...]:
        """Mean pressures (GPa) of the first step and of those that turn; empty under approaches."""
        if self.control is not Trait.MEAN_PRESSURE:
            return ()
        begin, *turns = self.turning_points
        return (_leg(begin, turns[0], self.increment)[0], *turns)

    def with_increment(self, increment: float) -> Sweep:
        """Return the same sweep in increments of about that size."""
        return replace(self, increment=increment)


@checked
@dataclass(frozen=True)
class Slide:
    """Sliding distances along x through turning points, in equal increments.

    Parameters
    ----------
    turning_points : tuple of float
        Two or more distances (nm), the first included.
    increment : float
        Approximate distance between steps (nm).
    held : LoadStep
        Approach or mean pressure under which the surfaces slide.
    """

    turning_points: TurningPoints
    increment: Positive
    held: LoadStep
    slides = True

    @property
    def steps(self) -> tuple[LoadStep, ...]:
        """Load steps in their order."""
        return _slide_steps(self.turning_points, self.increment, self.held)

    @property
    def controls(self) -> frozenset[Trait]:
        """A slide, and the kind of control of what it holds."""
        return frozenset({Trait.SLIDE, self.held.control})

    @property
    def mean_pressures(self) -> tuple[float, ...]:
        """The mean pressure (GPa) that is held; empty for a held approach."""
        return self.held.mean_pressures

    def with_increment(self, increment: float) -> Slide:
        """Return the same slide in increments of about that size."""
        return replace(self, increment=increment)


@lru_cache(maxsize=64)
def _sweep_steps(control: Trait, turning_points: tuple[float, ...], increment: float) -> tuple[LoadStep, ...]:
    """Steps of a sweep; cached, as many variants of a study share them."""
    return tuple(
        LoadStep(control, value) for ends in itertools.pairwise(turning_points) for value in _leg(*ends, increment)
    )


@lru_cache(maxsize=64)
def _slide_steps(turning_points: tuple[float, ...], increment: float, held: LoadStep) -> tuple[LoadStep, ...]:
    """Steps of a slide; cached, as many variants of a study share them."""
    legs = [_leg(*ends, increment) for ends in itertools.pairwise(turning_points)]
    return tuple(LoadStep(Trait.SLIDE, value, held=held) for value in [turning_points[0], *itertools.chain(*legs)])


def _leg(begin: float, end: float, increment: float) -> list[float]:
    """Return values from one, exclusive, to another, inclusive, in equal increments of about that size."""
    count = max(round(abs(end - begin) / increment), 1)
    if count > MAX_STEPS:
        raise InputError("increment", increment, f"one of at most {MAX_STEPS} steps from {begin:g} to {end:g}")
    return [begin + (end - begin) * k / count for k in range(1, count + 1)]
