"""The squared gradient of a surface at each point, by blocks of rows: on large surfaces memory is short.

The slopes are those of the waves where the highest number of waves is known. Only these waves are transformed along y.
Without a limit they are central differences, which are exact for a parabola.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from contactsim import fft
from contactsim.grid import Array, Grid, blocks

Block = tuple[slice, Array]
"""Some rows of a surface, and a field there; a line is one row."""


def squared_gradient(heights: Array, lengths: Sequence[float], modes: int | None = None) -> Array:
    """Return the squared gradient at each point, over a surface the sum of both squared slopes; shape of `heights`.

    Parameters
    ----------
    heights : array, shape (n,) or (ny, nx)
        Periodic heights.
    lengths : sequence of float
        Period in each direction, in the unit of heights.
    modes : int, optional
        Highest number of waves in a period.
    """
    total = np.empty((heights.size // heights.shape[-1], heights.shape[-1]))
    for rows, values in squared_gradient_blocks(heights, lengths, modes):
        total[rows] = values
    return total.reshape(heights.shape)


def squared_gradient_blocks(heights: Array, lengths: Sequence[float], modes: int | None = None) -> Iterator[Block]:
    """Yield the squared gradient block by block; parameters as of `squared_gradient`."""
    grid = Grid(heights.shape, tuple(lengths))
    rows = heights.reshape(-1, heights.shape[-1])
    slopes = _Differences(rows, grid) if modes is None else _Waves(rows, grid, modes)
    for low, high in blocks(rows.shape):
        yield slice(low, high), slopes.rows(low, high)


class _Differences:
    """Squared gradient by central differences; heights (rows, nx)."""

    def __init__(self, heights: Array, grid: Grid) -> None:
        self._heights, self._spacing = heights, grid.spacing

    def rows(self, low: int, high: int) -> Array:
        """Return the squared gradient of the rows from `low` to before `high`."""
        strip = np.take(self._heights, np.arange(low - 1, high + 1), axis=0, mode="wrap")
        here = strip[1:-1]
        total = np.square((np.roll(here, -1, 1) - np.roll(here, 1, 1)) / (2 * self._spacing[-1]))
        if len(self._spacing) == 2:
            total += np.square((strip[2:] - strip[:-2]) / (2 * self._spacing[0]))
        return total


class _Waves:
    """Squared gradient of waves, of which there are at most `modes` in a period; heights (rows, nx)."""

    def __init__(self, heights: Array, grid: Grid, modes: int) -> None:
        rows, self._points = heights.shape
        part = np.empty((rows, modes + 1), complex)
        for low, high in blocks(heights.shape):
            part[low:high] = fft.forward(heights[low:high], (1,))[:, : modes + 1]
        self._slopes = [part]
        if len(grid.shape) == 2:
            across = np.arange(rows)[:, None]
            across[across > rows // 2] -= rows
            fft.transform(part, 0)
            part[np.abs(across[:, 0]) > modes] = 0
            self._slopes.append(2j * np.pi / grid.lengths[0] * across * part)
            for coefficients in self._slopes:
                fft.transform_back(coefficients, 0)
        part *= 2j * np.pi / grid.lengths[-1] * np.arange(modes + 1)

    def rows(self, low: int, high: int) -> Array:
        """Return the squared gradient of the rows from `low` to before `high`."""
        half = np.zeros((high - low, self._points // 2 + 1), complex)
        total = np.zeros((high - low, self._points))
        for coefficients in self._slopes:
            half[:, : coefficients.shape[1]] = coefficients[low:high]
            slope = fft.backward(half, self._points, (1,))
            total += np.square(slope, out=slope)
        return total
