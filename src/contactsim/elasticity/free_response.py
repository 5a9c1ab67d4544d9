"""Response of a half-space to the pressure on single elements, without periodic images.

On a grid a pressure is uniform over each element: a strip around a point of a line, a rectangle around a point of a
surface (A. E. H. Love, Phil. Trans. R. Soc. A 228, 377 (1929), doi:10.1098/rsta.1929.0009). Sums over elements are
products of Fourier coefficients on a cell of twice the size, in which an element and its images act on disjoint halves.
Lengths are in the spacing along x, responses in spacing/E*.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from contactsim.grid import Array, Grid

FAR = 500.0
"""Distance, in elements, beyond which a rectangle acts by its moments: differences of large terms would lose digits."""


def strip_response(distance: Array, reference: float) -> Array:
    """Return the displacement at distances from a strip of width 1 under unit pressure.

    Parameters
    ----------
    distance
        Distances (n,), of any sign.
    reference
        Distance at which a line load moves nothing: the displacement of lines has no zero of its own.
    """
    ends = np.abs(np.add.outer((0.5, -0.5), np.abs(distance)))
    right, left = ends * (np.log(np.where(ends > 0, ends, 1.0) / reference) - 1)
    return np.asarray(-2 / np.pi * (right - np.where(np.abs(distance) < 0.5, -left, left)))


def rectangle_response(y: Array, x: Array, height: float) -> Array:
    """Return the displacement at points relative to the centre of a rectangle under unit pressure.

    Parameters
    ----------
    y, x
        Places (m,) and (n,), 0 or more.
    height
        Length along y of the rectangle; that along x is 1.

    Returns
    -------
    array, shape (m, n)
        Displacement.
    """
    near_y, near_x = (int(np.count_nonzero(places <= FAR * size)) for places, size in ((y, height), (x, 1.0)))
    response = _by_moments(y, x, height)
    near = y[:near_y], x[:near_x]
    response[:near_y, :near_x] = sum(
        sign * _corner(near[0] + along_y * height / 2, near[1] + along_x / 2)
        for sign, along_y, along_x in ((1, 1, 1), (-1, 1, -1), (-1, -1, 1), (1, -1, -1))
    )
    return response / np.pi


def _corner(y: Array, x: Array) -> Array:
    """Return the double integral of 1/r from the origin to points (m, n)."""
    rows, columns = y[:, None], x[None, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.where(columns != 0, columns * np.arcsinh(rows / np.abs(columns)), 0.0)
        across = np.where(rows != 0, rows * np.arcsinh(columns / np.abs(rows)), 0.0)
    return np.asarray(along + across)


def _by_moments(y: Array, x: Array, height: float) -> Array:
    """Return the integral of 1/r over a rectangle far away, by its area and its second moments, (m, n)."""
    square_y, square_x = y[:, None] ** 2, x[None, :] ** 2
    square = np.maximum(square_y + square_x, 1.0)
    second = height**2 * (2 * square_y - square_x) + 2 * square_x - square_y
    return np.asarray(height / np.sqrt(square) * (1 + second / (24 * square**2)))


@dataclass(frozen=True)
class FreeSymbol:
    """Fourier coefficients of the response of a surface without periodic images, on a cell of twice its size.

    Parameters
    ----------
    grid : Grid
        Grid of the cell.
    factor : float
        Factor of all of them.
    uniform : float, optional
        Coefficient at q = 0 in place of its own.
    """

    grid: Grid
    factor: float = 1.0
    uniform: float | None = None

    @cached_property
    def values(self) -> Array:
        """Coefficients of half of the rows, the others being the same in reverse, (my, mx)."""
        (ny, nx), (dy, dx) = self.grid.shape, self.grid.spacing
        response = rectangle_response(np.arange(ny // 2 + 1) * (dy / dx), np.arange(nx // 2 + 1), dy / dx)
        rows, columns = (np.minimum(np.arange(n), n - np.arange(n)) for n in (ny, nx))
        along = np.fft.rfft(response[:, columns], axis=1).real
        values: Array = np.fft.rfft(along[rows], axis=0).real * self.factor
        if self.uniform is not None:
            values[0, 0] = self.uniform
        return values

    def __getitem__(self, places: tuple[Array, Array]) -> Array:
        """Return the values at rows and columns of the coefficients, which are broadcast."""
        row, column = places
        return np.asarray(self.values[np.minimum(row, self.grid.shape[0] - row), column])

    def rows(self, low: int, high: int) -> Array:
        """Return the values at the rows from `low` to before `high`."""
        row = np.arange(low, high)
        return self.values[np.minimum(row, self.grid.shape[0] - row)]

    def folded(self, kind: type = float) -> list[tuple[slice, Array]]:
        """Return slices of rows with their values: half of the rows, and the same in reverse."""
        count = self.grid.shape[0]
        half = count // 2 + 1
        values: Array = self.values.astype(kind)
        return [(slice(half), values), (slice(half, None), values[count - half : 0 : -1])]

    def scaled(self, grid: Grid, factor: float) -> FreeSymbol:
        """Return the symbol times a factor on a grid of the same cell, in the unit of this one."""
        return replace(self, grid=grid, factor=self.factor * factor * grid.spacing[1] / self.grid.spacing[1])


def free_symbol(grid: Grid) -> tuple[Any, float, bool]:
    """Return the Fourier coefficients of the response on a cell of twice the size.

    Returns
    -------
    symbol, uniform, positive
        Coefficients of a line, an array (m,), or of a surface; that at q = 0; and that all act alike on pressures.
    """
    if len(grid.shape) == 2:
        symbol = FreeSymbol(grid)
        return symbol, float(symbol.values[0, 0]), True
    count = np.arange(grid.shape[0])
    distance = np.minimum(count, grid.shape[0] - count)
    line = np.fft.rfft(strip_response(distance, reference=grid.shape[0] / 2)).real
    return line, float(line[0]), True


def largest_response(grid: Grid) -> float:
    """Return the displacement in the middle of an element under unit pressure."""
    origin = np.zeros(1)
    if len(grid.shape) == 2:
        return float(rectangle_response(origin, origin, grid.spacing[0] / grid.spacing[1])[0, 0])
    return float(strip_response(origin, reference=grid.shape[0] / 2)[0])
