"""Smooth shapes: a plane, a cylinder, a sphere and a sinusoid, periodic and sampled by any number of points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.arguments import Count, Length, checked
from contactsim.errors import InputError
from contactsim.grid import Array, Grid, check_memory
from contactsim.surfaces.base import Dimensions, Smooth, Surface


@checked
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

    length: Length
    height: float = 0.0
    width: Length | None = None

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

    def heights(self, points: Count) -> Array:
        """Return the constant height in nm, shape (points,) or, since it does not depend on y, (1, points)."""
        check_memory(points, (points,))
        return np.full((1,) * (len(self.lengths) - 1) + (points,), float(self.height))


MIN_RADIUS = 1e-6
"""Smallest radius, over the period: the foot of a sharper shape is too deep to be told from its crest."""


@checked
@dataclass(frozen=True)
class _Round(Smooth):
    """Heights -ρ²/2R, ρ the distance from the middle of the period."""

    length: Length
    radius: Length

    def __post_init__(self) -> None:
        if self.radius < MIN_RADIUS * self.length:
            raise InputError("radius", self.radius, f"at least {MIN_RADIUS:g} of the period, {self.length:g} nm")

    def heights(self, points: Count) -> Array:
        """Return the heights -ρ²/2R in nm, at most 0, shape (points,) or (points, points)."""
        check_memory(points, self.shape(points))
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


@checked
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

    length: Length
    amplitude: Length
    periods: Count = 1
    dimensions: Dimensions = 1

    @property
    def modes(self) -> int:
        """Number of waves in a period."""
        return self.periods

    def heights(self, points: Count) -> Array:
        """Return the heights in nm, a crest at the origin, shape (points,) or (points, points)."""
        check_memory(points, self.shape(points))
        wave = np.cos(2 * np.pi * (np.arange(points) * self.periods % points / points))
        return self.amplitude * (wave if self.dimensions == 1 else wave[:, None] * wave)
