"""Heights to press with, along a line or over a surface: what any surface does, and the smooth ones.

A surface is a small frozen description; `heights(points)` samples it on a periodic grid. The largest height touches
first. A finer grid samples the same surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from contactsim.errors import InputError, is_number
from contactsim.grid import Array, Grid


class Surface(Protocol):
    """Periodic heights along a line or over a plane.

    lengths: period in each direction, x last, nm; points: along x, of what comes sampled, None where any number will
    do; modes: in waves a period, no Fourier mode has more in any direction, None where there is no highest.
    """

    lengths: tuple[float, ...]
    points: int | None
    modes: int | None

    def shape(self, points: int) -> tuple[int, ...]:
        """Shape of the heights on `points` along x."""
        ...

    def check(self, points: int) -> None:
        """Refuse a number of points along x that cannot sample it; cheap."""
        ...

    def heights(self, points: int) -> Array:
        """Heights at equispaced positions from 0, `points` along x, shape (points,) or (points along y, points), nm."""
        ...


def check_length(length: float) -> None:
    """Refuse a period that is not positive and finite."""
    if not (np.isfinite(length) and length > 0):
        raise InputError("length", length, "a positive, finite period in nm")


def check_dimensions(dimensions: int) -> None:
    """Refuse anything but lines and surfaces."""
    if dimensions not in (1, 2):
        raise InputError("dimensions", dimensions, "1, a line, or 2, a surface")


class Smooth:
    """A surface of one period that any number of points samples."""

    length: float
    dimensions: int
    points = None
    modes = None
    effective_short_cutoff = np.inf

    @property
    def lengths(self) -> tuple[float, ...]:
        """Period in each direction, nm."""
        return (self.length,) * self.dimensions

    def shape(self, points: int) -> tuple[int, ...]:
        """Shape of the heights on `points` along x."""
        return (points,) * len(self.lengths)

    def check(self, points: int) -> None:
        """Refuse fewer than two points along x, and those that miss the shortest wave."""
        Grid((points,), (self.lengths[-1],))
        if self.modes is not None and points <= 2 * self.modes:
            raise InputError("points", points, f"more than {2 * self.modes}: two points per shortest wavelength")


@dataclass(frozen=True)
class Flat(Smooth):
    """A plane at `height` (nm); width: its period along y, None for a line."""

    length: float
    height: float = 0.0
    width: float | None = None

    def __post_init__(self) -> None:
        for period in self.lengths:
            check_length(period)

    @classmethod
    def facing(cls, surface: Surface) -> Flat:
        """The plane at height zero with the periods of a surface."""
        *width, length = surface.lengths
        return cls(length, 0.0, *width)

    @property
    def lengths(self) -> tuple[float, ...]:
        """Period in each direction, nm."""
        return (self.length,) if self.width is None else (self.width, self.length)

    def heights(self, points: int) -> Array:
        """The constant height, shape (points,) or, since y does not matter, (1, points), nm."""
        return np.full((1,) * (len(self.lengths) - 1) + (points,), float(self.height))


@dataclass(frozen=True)
class _Round(Smooth):
    """Paraboloid -ρ²/2R in the middle of the period; radius, length in nm."""

    length: float
    radius: float

    def __post_init__(self) -> None:
        check_length(self.length)
        if not (np.isfinite(self.radius) and self.radius > 0):
            raise InputError("radius", self.radius, "a positive, finite number in nm")

    def heights(self, points: int) -> Array:
        """Heights -ρ²/2R, at most 0, shape (points,) or (points, points), nm."""
        square = (Grid((points,), (self.length,)).positions() - self.length / 2) ** 2
        total = square if self.dimensions == 1 else square[:, None] + square
        return -total / (2 * self.radius)


class Cylinder(_Round):
    """Parabolic cylinder (Eq. 3.2, drawn downwards) along a line; radius, length in nm."""

    dimensions = 1


class Sphere(_Round):
    """Paraboloid of revolution (Eq. 3.2, drawn downwards): Hertz's sphere; radius, length in nm."""

    dimensions = 2


@dataclass(frozen=True)
class Sinusoid(Smooth):
    """Westergaard's wave, amplitude × cos(2π periods x / length); in two dimensions times the same wave along y."""

    length: float
    amplitude: float
    periods: int = 1
    dimensions: int = 1

    def __post_init__(self) -> None:
        check_length(self.length)
        check_dimensions(self.dimensions)
        if not (np.isfinite(self.amplitude) and self.amplitude > 0):
            raise InputError("amplitude", self.amplitude, "a positive, finite number in nm")
        if not (is_number(self.periods) and self.periods >= 1 and self.periods == int(self.periods)):
            raise InputError("periods", self.periods, "a whole number, 1 or more")

    def heights(self, points: int) -> Array:
        """Heights of the wave, a crest at the origin, shape (points,) or (points, points), nm."""
        wave = np.cos(2 * np.pi * (np.arange(points) * self.periods % points / points))
        return self.amplitude * (wave if self.dimensions == 1 else wave[:, None] * wave)
