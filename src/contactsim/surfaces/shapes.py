"""Smooth shapes: a plane, a cylinder, a sphere and a sinusoid, periodic and sampled by any number of points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.errors import NUMBER, POSITIVE, InputError, is_number, is_positive, is_whole, keep_floats
from contactsim.grid import Array, Grid
from contactsim.surfaces.base import Smooth, Surface, check_dimensions, check_length


@dataclass(frozen=True)
class Flat(Smooth):
    """A plane, or in one dimension a straight line.

    Parameters
    ----------
    length : float
        Period along x, in nm.
    height : float
        Height, in nm.
    width : float, optional
        Period along y, in nm; without it the plane is a line.
    """

    length: float
    height: float = 0.0
    width: float | None = None

    def __post_init__(self) -> None:
        for period in self.lengths:
            check_length(period)
        if not is_number(self.height):
            raise InputError("height", self.height, f"{NUMBER}, in nm")
        keep_floats(self)

    @classmethod
    def facing(cls, surface: Surface) -> Flat:
        """Return the plane at height zero with the periods of a surface."""
        *width, length = surface.lengths
        return cls(length, 0.0, *width)

    @property
    def modes(self) -> int:
        """No waves."""
        return 0

    @property
    def lengths(self) -> tuple[float, ...]:
        """Period in each direction, nm."""
        return (self.length,) if self.width is None else (self.width, self.length)

    def heights(self, points: int) -> Array:
        """Return the constant height in nm, shape (points,) or, since it does not depend on y, (1, points)."""
        return np.full((1,) * (len(self.lengths) - 1) + (points,), float(self.height))


MIN_RADIUS = 1e-6
"""Smallest radius, over the period: the foot of a sharper shape is too deep to be told from its crest."""


@dataclass(frozen=True)
class _Round(Smooth):
    """Heights -ρ²/2R, ρ the distance from the middle of the period."""

    length: float
    radius: float

    def __post_init__(self) -> None:
        check_length(self.length)
        if not is_positive(self.radius):
            raise InputError("radius", self.radius, f"{POSITIVE}, in nm")
        if self.radius < MIN_RADIUS * self.length:
            raise InputError("radius", self.radius, f"at least {MIN_RADIUS:g} of the period, {self.length:g} nm")
        keep_floats(self)

    def heights(self, points: int) -> Array:
        """Return the heights -ρ²/2R in nm, at most 0, shape (points,) or (points, points)."""
        square = (Grid((points,), (self.length,)).positions() - self.length / 2) ** 2
        total = square if self.dimensions == 1 else square[:, None] + square
        return -total / (2 * self.radius)


class Cylinder(_Round):
    """Parabolic cylinder, -x²/2R from its crest (Eq. 3.2).

    Parameters
    ----------
    length : float
        Period, in nm.
    radius : float
        Radius of curvature R, in nm.
    """

    dimensions = 1


class Sphere(_Round):
    """Paraboloid of revolution, -ρ²/2R from its top (Eq. 3.2): Hertz's sphere.

    Parameters
    ----------
    length : float
        Period, in nm.
    radius : float
        Radius of curvature R, in nm.
    """

    dimensions = 2


@dataclass(frozen=True)
class Sinusoid(Smooth):
    """Westergaard's wave, amplitude × cos(2π periods x / length); in two dimensions times the same wave along y.

    Parameters
    ----------
    length : float
        Period of the heights, in nm.
    amplitude : float
        Amplitude, in nm.
    periods : int
        Number of waves in the period.
    dimensions : int
        1 for a line, 2 for a surface.
    """

    length: float
    amplitude: float
    periods: int = 1
    dimensions: int = 1

    def __post_init__(self) -> None:
        check_length(self.length)
        check_dimensions(self.dimensions)
        if not is_positive(self.amplitude):
            raise InputError("amplitude", self.amplitude, f"{POSITIVE}, in nm")
        if not is_whole(self.periods):
            raise InputError("periods", self.periods, "a whole number, 1 or more")
        keep_floats(self)

    @property
    def modes(self) -> int:
        """Number of waves in a period."""
        return self.periods

    def heights(self, points: int) -> Array:
        """Return the heights in nm, a crest at the origin, shape (points,) or (points, points)."""
        wave = np.cos(2 * np.pi * (np.arange(points) * self.periods % points / points))
        return self.amplitude * (wave if self.dimensions == 1 else wave[:, None] * wave)
