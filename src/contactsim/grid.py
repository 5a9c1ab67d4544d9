"""Periodic grids and what is diagonal on them.

Elasticity is diagonal in Fourier space, so a grid offers real transforms and an `Operator` that multiplies by a
symbol. Transforms are scaled such that the q = 0 entry is the mean. Every application is entered in a `Tally`,
in units of one real transform on the finest grid, which is the price that all solvers are compared by.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

import ducc0
import numpy as np

from contactsim.errors import InputError

Array = np.ndarray

PADDING = 8
"""Extra columns: transforms of rows that lie a power of two apart are several times slower."""
BLOCK = 2**20
"""Points, in whole rows, that are worked on at a time where temporary arrays would outgrow the fields themselves."""


def blocks(shape: tuple[int, ...]) -> Iterator[tuple[int, int]]:
    """First row and the one after the last of each block of rows; a line is one row."""
    rows = math.prod(shape[:-1])
    size = max(BLOCK // shape[-1], 1)
    return ((low, min(low + size, rows)) for low in range(0, rows, size))


@dataclass(frozen=True)
class Grid:
    """Equispaced periodic grid: points per direction, period per direction (nm), FFT threads."""

    shape: tuple[int, ...]
    lengths: tuple[float, ...]
    threads: int = 1

    def __post_init__(self) -> None:
        if any(not isinstance(n, int | np.integer) or n < 2 for n in self.shape):
            raise InputError("points", self.shape, "at least 2 points in each direction")
        if any(not (np.isfinite(length) and length > 0) for length in self.lengths):
            raise InputError("length", self.lengths, "a positive, finite period in nm")
        if isinstance(self.threads, bool) or not isinstance(self.threads, int | np.integer) or self.threads < 1:
            raise InputError("threads", self.threads, "a whole number, 1 or more")

    @cached_property
    def size(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    @property
    def spacing(self) -> tuple[float, ...]:
        """Distance between neighbouring points in each direction (nm)."""
        return tuple(length / n for length, n in zip(self.lengths, self.shape, strict=True))

    @property
    def half_shape(self) -> tuple[int, ...]:
        """Shape of the coefficients of a real transform."""
        return (*self.shape[:-1], self.shape[-1] // 2 + 1)

    @property
    def wide_shape(self) -> tuple[int, ...]:
        """Shape of a real field with columns enough for its own transform: the same memory holds either."""
        return (*self.shape[:-1], self.shape[-1] + PADDING + self.shape[-1] % 2)

    def low_modes(self, highest: int) -> tuple[Array, ...]:
        """Index of the coefficients of modes up to `highest` in each direction, in the order of a transform of them."""
        along = np.arange(highest + 1)
        across = np.concatenate((along, -along[:0:-1]))
        return np.ix_(*[across] * (len(self.shape) - 1), along)

    def modes_of(self, finer: Grid) -> tuple[Array, ...]:
        """Index of this grid's modes among those of a finer grid over the same periods."""
        across = [np.fft.fftfreq(n, 1 / n).astype(int) for n in self.shape[:-1]]
        rows = [np.where(k < 0, k + n, k) for k, n in zip(across, finer.shape[:-1], strict=True)]
        return np.ix_(*rows, np.arange(self.half_shape[-1]))

    def positions(self, axis: int = 0) -> Array:
        """Coordinates along one direction, shape (n,), nm, from 0 to just below the period."""
        return np.arange(self.shape[axis]) * self.spacing[axis]

    @property
    def wavenumber(self) -> Array:
        """Angular wavenumber |q| of each coefficient of the real transform (rad/nm)."""
        return self.of_wavenumber(lambda q: q)

    def of_wavenumber(self, function: Callable[[Array], Array]) -> Array:
        """A function of the angular wavenumber |q| (rad/nm) at each coefficient of the real transform."""
        last = np.fft.rfftfreq(self.shape[-1], self.spacing[-1] / (2 * np.pi))
        if len(self.shape) == 1:
            return function(last)
        first = np.fft.fftfreq(self.shape[0], self.spacing[0] / (2 * np.pi))[:, None]
        values = np.empty(self.half_shape)
        for low, high in blocks(self.shape):
            values[low:high] = function(np.sqrt(first[low:high] ** 2 + last**2))
        return values

    def forward(self, field: Array, out: Array | None = None) -> Array:
        """Real to half-complex transform over all axes, scaled so that the q = 0 entry is the mean."""
        return ducc0.fft.r2c(field, forward=True, inorm=2, nthreads=self.threads, out=out)

    def backward(self, coefficients: Array, out: Array | None = None) -> Array:
        """Inverse of `forward`."""
        return ducc0.fft.c2r(coefficients, lastsize=self.shape[-1], forward=False, nthreads=self.threads, out=out)

    def coarser(self, shape: tuple[int, ...]) -> Grid:
        """The same period on fewer points."""
        return Grid(shape, self.lengths, self.threads)


@dataclass
class Tally:
    """Work done so far: real transforms, in equivalents of one on a grid of `finest` points."""

    finest: int
    transforms: float = 0.0

    def add(self, count: int, size: int) -> None:
        """Enter `count` transforms on a grid of `size` points."""
        self.transforms += count * size / self.finest


@dataclass
class Operator:
    """Multiplication by a symbol of the wavevector: two transforms an application, counted.

    symbol: one factor for each coefficient of the real transform. A line's coefficients have memory of their own, those
    of a surface, of which there is room for few fields, take the place of the result.
    """

    grid: Grid
    symbol: Array
    tally: Tally
    _half: Array | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._half = np.empty(self.symbol.shape, complex) if self.symbol.ndim == 1 else None

    def __call__(self, values: Array, out: Array | None = None) -> Array:
        """Apply to a real field of the grid's shape.

        `out` receives the result: on a line it may be `values`; on a surface it is of the grid's `wide_shape`, and what
        is returned are its first columns.
        """
        self.tally.add(2, self.grid.size)
        if self._half is None:
            return self._in_place(values, np.empty(self.grid.wide_shape) if out is None else out)
        half = self.grid.forward(values, out=self._half)
        half *= self.symbol
        overwrite = {"forward": False, "nthreads": self.grid.threads, "allow_overwriting_input": True}
        return ducc0.fft.c2r(half, lastsize=self.grid.shape[-1], out=out, **overwrite)

    def _in_place(self, values: Array, wide: Array) -> Array:
        columns, rows = self.grid.shape[-1], list(blocks(self.grid.shape))
        result, half = wide[:, :columns], wide.view(complex)[:, : columns // 2 + 1]
        along, across = ({"axes": (axis,), "nthreads": self.grid.threads} for axis in (1, 0))
        for low, high in rows:
            half[low:high] = ducc0.fft.r2c(values[low:high], inorm=2, **along)
        ducc0.fft.c2c(half, inorm=2, out=half, **across)
        half *= self.symbol
        ducc0.fft.c2c(half, forward=False, out=half, **across)
        for low, high in rows:
            result[low:high] = ducc0.fft.c2r(half[low:high], lastsize=columns, forward=False, **along)
        return result
