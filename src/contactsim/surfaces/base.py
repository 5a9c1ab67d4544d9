"""The protocol of a surface, and the base of the surfaces that any number of points can sample."""

from __future__ import annotations

from typing import Annotated, Protocol

import numpy as np

from contactsim.arguments import Count, Only, checked
from contactsim.errors import InputError, is_whole
from contactsim.grid import Array, Grid


class Surface(Protocol):
    """Periodic heights along a line or over a plane.

    A finer grid samples the same surface. The largest height touches first.

    Attributes
    ----------
    lengths : tuple of float
        Period in each direction, x last, in nm.
    points : int or None
        Number of points along x of measured heights; None if any number of points can sample the surface.
    modes : int or None
        Highest number of waves in a period, in any direction; None if there is no limit.
    """

    @property
    def lengths(self) -> tuple[float, ...]:
        """Period in each direction, x last, nm."""
        ...

    @property
    def points(self) -> int | None:
        """Number of points along x of measured heights, else None."""
        ...

    @property
    def modes(self) -> int | None:
        """Highest number of waves in a period, or None."""
        ...

    def shape(self, points: Count) -> tuple[int, ...]:
        """Return the shape of the heights with `points` points along x."""
        ...

    def check(self, points: Count) -> None:
        """Raise an InputError if `points` points along x cannot sample the surface; computes no heights."""
        ...

    def heights(self, points: Count) -> Array:
        """Return the heights in nm at equal steps from 0, shape (points,) or (points along y, points)."""
        ...


Dimensions = Annotated[int, Only("1, a line, or 2, a surface", lambda value: is_whole(value) and value <= 2)]


@checked
class Smooth:
    """A surface that any number of points can sample, with the same period in each direction.

    `effective_short_cutoff` is the shortest wavelength in nm; infinite unless the surface is a sum of waves.
    """

    length: float
    dimensions: int
    points: int | None = None

    @property
    def modes(self) -> int | None:
        """Highest number of waves in a period, or None without a limit."""
        return None

    @property
    def effective_short_cutoff(self) -> float:
        """Shortest wavelength, nm."""
        return np.inf

    @property
    def lengths(self) -> tuple[float, ...]:
        """Period in each direction, nm."""
        return (self.length,) * self.dimensions

    def shape(self, points: Count) -> tuple[int, ...]:
        """Return the shape of the heights with `points` points along x."""
        return (points,) * len(self.lengths)

    def check(self, points: Count) -> None:
        """Raise an InputError for fewer than two points along x, or too few for the shortest wave."""
        Grid(self.shape(points), self.lengths)
        if self.modes is not None and points <= 2 * self.modes:
            raise InputError("points", points, f"more than {2 * self.modes}: two points per shortest wavelength")
