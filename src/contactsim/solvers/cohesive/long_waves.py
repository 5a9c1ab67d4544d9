"""Long waves of a line or of a surface: those that a coarser grid of nodes can carry, below its shortest wave.

Where each point is a node, all waves are long: also the shortest can grow on its own, on soft bodies.

Coefficients and nodes are rows, as in `contactsim.contact.cohesive`.
"""

from __future__ import annotations

from functools import cached_property
from typing import Protocol

import numpy as np

from contactsim.grid import Array, Grid


class LongWaves(Protocol):
    """Long waves and the grid of nodes that carries them."""

    @property
    def low(self) -> slice | Array:
        """Places of the long waves among the coefficients of the grid."""
        ...

    @property
    def high(self) -> slice | Array:
        """Places of all other waves."""
        ...

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        ...

    @property
    def count(self) -> int:
        """Number of long waves."""
        ...

    def field(self, coefficients: Array) -> Array:
        """Return the values (rows, nodes) of long waves (rows, count)."""
        ...

    def coefficients(self, field: Array) -> Array:
        """Return the coefficients (rows, count) of values (rows, nodes)."""
        ...

    def differences(self, zone: Array) -> Array:
        """Return for each pair of nodes (zone, zone) the node as far from the first node as they are apart."""
        ...


class LineWaves:
    """Long waves of a line; parameters: its grid, and its points for each node."""

    def __init__(self, grid: Grid, ratio: int) -> None:
        self.nodes = grid.size // ratio_of_points(grid.size, ratio)
        self.count = grid.half_size if self.nodes == grid.size else min(self.nodes // 2, grid.half_size)
        self.low, self.high = slice(0, self.count), slice(self.count, None)
        self._grid = Grid((self.nodes,), grid.lengths)

    def field(self, coefficients: Array) -> Array:
        """Return the values (rows, nodes) of long waves (rows, count)."""
        wide = np.zeros((len(coefficients), self._grid.half_size), complex)
        wide[:, : self.count] = coefficients
        return self._grid.backward_rows(wide)

    def coefficients(self, field: Array) -> Array:
        """Return the coefficients (rows, count) of values (rows, nodes)."""
        return self._grid.forward_rows(field)[:, : self.count]

    def differences(self, zone: Array) -> Array:
        """Return for each pair of nodes (zone, zone) the node as far from the first node as they are apart."""
        return (zone[:, None] - zone) % self.nodes


class SurfaceWaves:
    """Long waves of a surface; parameters: its grid, and its points for each node, along a side."""

    def __init__(self, grid: Grid, ratio: int) -> None:
        shape = tuple(size // ratio_of_points(size, ratio) for size in grid.shape)
        self._grid, self.nodes = Grid(shape, grid.lengths), shape[0] * shape[1]
        across, along = np.fft.fftfreq(shape[0], 1 / shape[0]).astype(int), np.arange(shape[1] // 2 + 1)
        is_long = (2 * np.abs(across) < shape[0])[:, None] & (2 * along < shape[1]) | (shape == grid.shape)
        rows, columns = np.nonzero(is_long)
        self._own = np.ravel_multi_index((rows, columns), self._grid.half_shape)
        self.low = np.ravel_multi_index((across[rows] % grid.shape[0], columns), grid.half_shape)
        self.high = np.delete(np.arange(grid.half_size), self.low)
        self.count = self.low.size

    def field(self, coefficients: Array) -> Array:
        """Return the values (rows, nodes) of long waves (rows, count)."""
        wide = np.zeros((len(coefficients), self._grid.half_size), complex)
        wide[:, self._own] = coefficients
        return self._grid.backward_rows(wide)

    def coefficients(self, field: Array) -> Array:
        """Return the coefficients (rows, count) of values (rows, nodes)."""
        return self._grid.forward_rows(field)[:, self._own]

    def differences(self, zone: Array) -> Array:
        """Return for each pair of nodes (zone, zone) the node as far from the first node as they are apart."""
        ny, nx = self._grid.shape
        y, x = np.unravel_index(zone, self._grid.shape)
        wide = 2 * nx - 1  # differences are from 1 - n to n - 1: they are looked up, since remainders take long
        place = y * wide + x
        return self._apart[np.subtract.outer(place, place) + ((ny - 1) * wide + nx - 1)]

    @cached_property
    def _apart(self) -> Array:
        """Node of each difference of rows and columns, each from 1 - n to n - 1, in a row."""
        rows, columns = (np.arange(1 - size, size) % size for size in self._grid.shape)
        return (rows[:, None] * self._grid.shape[1] + columns).ravel()


WAVES: dict[int, type[LineWaves] | type[SurfaceWaves]] = {1: LineWaves, 2: SurfaceWaves}
"""Long waves by the number of dimensions of a grid."""


def ratio_of_points(size: int, ratio: int) -> int:
    """Return the points for each node along a side that has two nodes or more."""
    return min(ratio, size // 2)


def node_averages(values: Array, grid: Grid, ratio: int) -> Array:
    """Return the means of values (…, size) over the points about each node, (…, nodes)."""
    means = values.reshape(*values.shape[:-1], *grid.shape)
    for axis in range(-len(grid.shape), 0):
        means = _averages_along(means, axis, ratio_of_points(means.shape[axis], ratio))
    return means.reshape(*values.shape[:-1], -1)


def _averages_along(values: Array, axis: int, ratio: int) -> Array:
    """Return the means over `ratio` points about every ratio-th point along an axis."""
    moved = np.moveaxis(values, axis, -1)
    size = moved.shape[-1]
    cells = size // ratio
    shifted = np.concatenate((moved[..., size - ratio // 2 :], moved[..., : size - ratio // 2]), -1)
    means = shifted[..., : cells * ratio].reshape(*moved.shape[:-1], cells, ratio).mean(-1)
    return np.moveaxis(means, -1, axis)
