"""Displacement of a half-space under a pressure that does not repeat: a sum over elements, by transforms.

The pressure is followed by as many zeros in each direction, so that no image of an element reaches another one. Of a
surface zeros are added to some rows, and to some columns, at a time: no field of twice the size is held. The operator
is without units: lengths are in the spacing along x, and E* is 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from contactsim import fft
from contactsim.elasticity.fourier_operator import Product
from contactsim.elasticity.free_response import rectangle_response, strip_response
from contactsim.grid import Array, Grid, TransformCounter, blocks

COLUMN_BLOCK = 2**18
"""Coefficients that are transformed along y at a time."""


@dataclass
class FreeLineOperator:
    """Displacement of a line.

    Parameters
    ----------
    grid : Grid
        Grid of the pressure.
    symbol : array
        Compliance of periodic pressures, which preconditioners take for that of these.
    counter : TransformCounter
        Counts the transforms, of twice the size.
    """

    grid: Grid
    symbol: Array
    counter: TransformCounter

    holds_mean = False

    @cached_property
    def _response(self) -> Array:
        """Coefficients of the response to an element of a line with the zeros."""
        size = padded_size(self.grid.shape[0])
        count = np.arange(size)
        distance = np.minimum(count, size - count)
        return np.asarray(fft.forward(strip_response(distance, self.grid.shape[0])).real)

    def hold_symbol(self) -> None:
        """Do nothing: the response is held."""

    def __call__(self, values: Array, out: Array | None = None) -> Array:
        """Return the displacement under a pressure (n,), also in `out`, which may be `values`."""
        size, whole = self.grid.shape[0], padded_size(self.grid.shape[0])
        padded = np.zeros(whole)
        padded[:size] = values
        half = fft.forward(padded, scaled=False)
        half *= self._response
        self.counter.add(4, self.grid.size)
        moved = fft.backward(half, whole)[:size]
        if out is None:
            return np.asarray(moved)
        out[...] = moved
        return out

    def coarser(self, shape: tuple[int, ...]) -> FreeLineOperator:
        """Return the operator on fewer points, in units of their spacing."""
        grid = self.grid.coarser(shape)
        symbol = self.symbol[grid.modes_of(self.grid)] * (shape[0] / self.grid.shape[0])
        return FreeLineOperator(grid, symbol, self.counter)

    def in_single_precision(self) -> Product:
        """Raise TypeError: lines need no single precision."""
        raise TypeError("a line has no product in single precision")


@dataclass
class FreeSurfaceOperator:
    """Displacement of a surface; parameters as those of `FreeLineOperator`, the symbol one that is read by rows."""

    grid: Grid
    symbol: Any
    counter: TransformCounter

    holds_mean = False

    @property
    def _padded(self) -> tuple[int, int]:
        """Points along y and x with the zeros."""
        ny, nx = map(padded_size, self.grid.shape)
        return ny, nx

    @cached_property
    def _response(self) -> Array:
        """Coefficients of the response to an element on the cell with the zeros, a quarter: (my/2 + 1, mx/2 + 1)."""
        (my, mx), (dy, dx) = self._padded, self.grid.spacing
        y, x = np.arange(my // 2 + 1) * (dy / dx), np.arange(mx // 2 + 1.0)
        response = np.empty((y.size, x.size))
        for low, high in blocks(response.shape):
            response[low:high] = rectangle_response(y[low:high], x, dy / dx)
        for axis in (1, 0):  # even in both directions: real coefficients, from half of the values
            fft.cosine_sums(response, axis, threads=self.grid.threads)
        response /= my * mx
        return response

    def hold_symbol(self) -> None:
        """Do nothing: the response is held."""

    def __call__(self, values: Array, out: Array | None = None) -> Array:
        """Return the displacement under a pressure (ny, nx), the first columns of `out` if there is one."""
        out = np.empty(self.grid.wide_shape) if out is None else out
        response = self._response  # made before the memory of the coefficients is taken
        self._apply(values, out, np.empty((self.grid.shape[0], response.shape[1]), complex))
        return out[:, : self.grid.shape[1]]

    def coarser(self, shape: tuple[int, ...]) -> FreeSurfaceOperator:
        """Return the operator on fewer points, in units of their spacing."""
        grid = self.grid.coarser(shape)
        return FreeSurfaceOperator(grid, self.symbol.scaled(grid, shape[1] / self.grid.shape[1]), self.counter)

    def in_single_precision(self) -> Product:
        """Return the product with fields in single precision; it has memory of its own for the coefficients."""
        half = np.empty((self.grid.shape[0], self._response.shape[1]), np.complex64)

        def product(field: Array, scratch: Array, out: Array) -> None:
            """Write the product; its coefficients are twice as many as the scratch can hold."""
            del scratch
            self._apply(field[:, : self.grid.shape[1]], out, half)

        return product

    def _apply(self, values: Array, out: Array, half: Array) -> None:
        """Write the displacement under a pressure to the first columns of out; half: memory for coefficients."""
        (ny, nx), (my, mx) = self.grid.shape, self._padded
        threads = self.grid.threads
        rows = list(blocks((ny, mx)))
        row_pad = np.zeros((max(high - low for low, high in rows), mx), values.dtype)
        for low, high in rows:
            row_pad[: high - low, :nx] = values[low:high]
            fft.forward(row_pad[: high - low], (1,), out=half[low:high], scaled=False, threads=threads)
        step = max(COLUMN_BLOCK // my, 8)
        for left in range(0, half.shape[1], step):
            part = half[:, left : left + step]
            padded = np.zeros((my, part.shape[1]), half.dtype)
            padded[:ny] = part
            fft.transform(padded, 0, scaled=False, threads=threads)
            response = self._response[:, left : left + step].astype(values.dtype)
            padded[: my // 2 + 1] *= response
            padded[my // 2 + 1 :] *= response[my // 2 - 1 : 0 : -1]
            fft.transform_back(padded, 0, threads=threads)
            part[...] = padded[:ny]
        for low, high in rows:
            back = row_pad[: high - low]
            fft.backward(half[low:high], mx, (1,), out=back, threads=threads)
            out[low:high, :nx] = back[:, :nx]
        self.counter.add(6, self.grid.size)


def padded_compliance(grid: Grid) -> tuple[Grid, Array]:
    """Return the grid of a surface with the zeros, and the compliance on it of bodies with an E* of 1 GPa, nm/GPa.

    Pressures on the heights, the first points in each direction, lead to displacements of these as without images.
    Elsewhere the displacements mean nothing.

    Parameters
    ----------
    grid
        Grid of the heights.
    """
    response = FreeSurfaceOperator(grid, None, TransformCounter(grid.size))._response
    my, mx = map(padded_size, grid.shape)
    lengths = tuple(size * step for size, step in zip((my, mx), grid.spacing, strict=True))
    whole = np.concatenate((response, response[my // 2 - 1 : 0 : -1])) * (my * mx * grid.spacing[-1])
    return Grid((my, mx), lengths, grid.threads), whole


def padded_size(size: int) -> int:
    """Return an even number of points, at least twice as many, on which transforms are fast."""
    padded = 2 * size
    while True:
        padded = fft.good_size(padded)
        if padded % 2 == 0:
            return padded
        padded += 1


def free_operator(grid: Grid, symbol: Any, counter: TransformCounter) -> FreeLineOperator | FreeSurfaceOperator:
    """Return the operator of a line or of a surface."""
    return (FreeLineOperator if len(grid.shape) == 1 else FreeSurfaceOperator)(grid, symbol, counter)
