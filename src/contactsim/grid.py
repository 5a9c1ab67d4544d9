"""Periodic grids and their Fourier transforms, scaled so that the entry q = 0 is the mean.

A `TransformCounter` counts transforms, as the cost by which solvers are compared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from contactsim import fft
from contactsim.arguments import Only
from contactsim.errors import InputError, is_whole
from contactsim.threads import T, share_work

Array = NDArray[Any]
"""An array of any type and shape; docstrings say which."""

MAX_POINTS = 2**30
"""Most points of a grid: one field of them takes 8 GiB."""
MAX_THREADS = 1024
"""Most threads of a transform."""
Threads = Annotated[
    int, Only(f"a whole number, 1 to {MAX_THREADS}", lambda value: is_whole(value) and value <= MAX_THREADS)
]
SMALL_MEMORY = 2**28
"""Bytes that are taken without a look at what is free."""
PADDING = 8
"""Extra columns of a wide field: transforms are several times slower if rows start a power of two apart."""
BLOCK, SHARED_BLOCK = 2**20, 2**18
"""Points worked on at a time, in whole rows, to keep temporary arrays small: by default, and where threads share."""


def check_memory(points: int, shape: tuple[int, ...], fields: float = 1.0) -> None:
    """Raise an InputError for a grid, of `points` points along x, whose fields need more memory than is free."""
    needed = 8 * fields * math.prod(shape)
    if needed > SMALL_MEMORY and needed > (free := free_memory()):
        allowed = f"fewer: they need {needed / 2**30:.3g} GiB of memory, and {free / 2**30:.3g} GiB are free"
        raise InputError("points", points, allowed)


def free_memory() -> float:
    """Return the memory in bytes that can be used without swapping; infinite where the system does not tell."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        return next(1024.0 * int(line.split()[1]) for line in lines if line.startswith("MemAvailable"))
    except (OSError, StopIteration):
        return math.inf


def blocks(shape: tuple[int, ...], points: int = BLOCK) -> Iterator[tuple[int, int]]:
    """Yield the first row of each block of rows and the row after its last; a line is one row."""
    rows = math.prod(shape[:-1])
    size = max(points // shape[-1], 1)
    return ((low, min(low + size, rows)) for low in range(0, rows, size))


def map_blocks(work: Callable[[int, int], T], shape: tuple[int, ...], threads: int) -> list[T]:
    """Return the results of a function of the first row of each block and the row after its last, on some threads."""
    places = list(blocks(shape, SHARED_BLOCK))
    return share_work(lambda number: work(*places[number]), len(places), threads)


@dataclass(frozen=True)
class Grid:
    """Equispaced periodic grid along one or two directions.

    Parameters
    ----------
    shape : tuple of int
        Points in each direction.
    lengths : tuple of float
        Period in each direction, nm.
    threads : int
        Threads that a transform may use.

    Raises
    ------
    InputError
        If there are fewer than 2 points in a direction, or a period is not positive and finite.
    """

    shape: tuple[int, ...]
    lengths: tuple[float, ...]
    threads: int = 1

    def __post_init__(self) -> None:
        if any(not isinstance(n, int | np.integer) or n < 2 for n in self.shape):
            raise InputError("points", self.shape, "at least 2 points in each direction")
        if math.prod(map(int, self.shape)) > MAX_POINTS:
            raise InputError("points", max(self.shape), f"at most {MAX_POINTS} points of the whole grid")
        if any(not (np.isfinite(length) and length > 0) for length in self.lengths):
            raise InputError("length", self.lengths, "a positive, finite period in nm")
        if (
            isinstance(self.threads, bool)
            or not isinstance(self.threads, int | np.integer)
            or not 1 <= self.threads <= MAX_THREADS
        ):
            raise InputError("threads", self.threads, f"a whole number, 1 to {MAX_THREADS}")

    @cached_property
    def size(self) -> int:
        """Number of points of the grid."""
        return math.prod(self.shape)

    @property
    def spacing(self) -> tuple[float, ...]:
        """Distance between neighbouring points in each direction, nm."""
        return tuple(length / n for length, n in zip(self.lengths, self.shape, strict=True))

    @property
    def half_shape(self) -> tuple[int, ...]:
        """Shape of the coefficients of a real field."""
        return (*self.shape[:-1], self.shape[-1] // 2 + 1)

    @property
    def wide_shape(self) -> tuple[int, ...]:
        """Shape of a real field with extra columns, so that the same memory can hold its coefficients."""
        return (*self.shape[:-1], self.shape[-1] + PADDING + self.shape[-1] % 2)

    def low_modes(self, highest: int) -> tuple[Array, ...]:
        """Return the index of the coefficients of modes up to `highest` in each direction.

        The order is that of the coefficients on a grid with these modes alone.
        """
        along = np.arange(highest + 1)
        across = np.concatenate((along, -along[:0:-1]))
        return np.ix_(*[across] * (len(self.shape) - 1), along)

    def modes_of(self, finer: Grid) -> tuple[Array, ...]:
        """Return the index of this grid's modes among those of a finer grid with the same periods."""
        across = [np.fft.fftfreq(n, 1 / n).astype(int) for n in self.shape[:-1]]
        rows = [np.where(k < 0, k + n, k) for k, n in zip(across, finer.shape[:-1], strict=True)]
        return np.ix_(*rows, np.arange(self.half_shape[-1]))

    def positions(self, axis: int = 0) -> Array:
        """Return the coordinates along one direction, shape (n,), nm, from 0 to one spacing below the period."""
        return np.arange(self.shape[axis]) * self.spacing[axis]

    @property
    def wavenumber(self) -> Array:
        """Angular wavenumber |q| of each coefficient, shape `half_shape`, rad/nm."""
        return self.of_wavenumber(lambda q: q)

    def of_wavenumber(self, function: Callable[[Array], Array]) -> Array:
        """Return a function of the angular wavenumber |q| (rad/nm) at each coefficient, shape `half_shape`."""
        if len(self.shape) == 1:
            return function(np.fft.rfftfreq(self.shape[0], self.spacing[0] / (2 * np.pi)))
        values = np.empty(self.half_shape)
        for low, high in blocks(self.shape):
            values[low:high] = function(self.wavenumber_at(*np.ogrid[low:high, : self.half_shape[1]]))
        return values

    def wavenumber_at(self, rows: Array, columns: Array) -> Array:
        """Return |q| (rad/nm) of the coefficients of a surface at some rows and columns, which are broadcast."""
        last = np.fft.rfftfreq(self.shape[1], self.spacing[1] / (2 * np.pi))
        first = np.fft.fftfreq(self.shape[0], self.spacing[0] / (2 * np.pi))
        return np.sqrt(first[rows] ** 2 + last[columns] ** 2)

    def forward(self, field: Array, out: Array | None = None) -> Array:
        """Return the Fourier coefficients of a real field over all axes; the entry q = 0 is the mean.

        Parameters
        ----------
        field : array, shape `shape`
            Values on the grid.
        out : complex array, shape `half_shape`, optional
            Receives the result.
        """
        return fft.forward(field, out=out, threads=self.threads)

    def backward(self, coefficients: Array, out: Array | None = None) -> Array:
        """Return the real field, shape `shape`, that has these coefficients; the inverse of `forward`."""
        return fft.backward(coefficients, self.shape[-1], out=out, threads=self.threads)

    @cached_property
    def half_size(self) -> int:
        """Number of coefficients of a real field."""
        return math.prod(self.half_shape)

    def forward_rows(self, fields: Array) -> Array:
        """Return the coefficients (rows, half_size) of real fields (rows, size), each in the order of the grid."""
        axes = tuple(range(1, 1 + len(self.shape)))
        shaped = fields.reshape(len(fields), *self.shape)
        half = fft.forward(shaped, axes, threads=self.threads)
        return half.reshape(len(fields), -1)

    def backward_rows(self, coefficients: Array) -> Array:
        """Return the real fields (rows, size) that have these coefficients; the inverse of `forward_rows`."""
        axes = tuple(range(1, 1 + len(self.shape)))
        shaped = coefficients.reshape(len(coefficients), *self.half_shape)
        fields = fft.backward(shaped, self.shape[-1], axes, threads=self.threads)
        return fields.reshape(len(coefficients), -1)

    @cached_property
    def mode_weights(self) -> Array:
        """Number of times that each coefficient counts in a mean over the period, (half_size,): 1 or 2."""
        weights = np.full(self.half_shape, 2.0)
        weights[..., 0] = 1.0
        if self.shape[-1] % 2 == 0:
            weights[..., -1] = 1.0
        return weights.ravel()

    def coarser(self, shape: tuple[int, ...]) -> Grid:
        """Return a grid with the same periods and fewer points."""
        return Grid(shape, self.lengths, self.threads)


FACTOR_COST, CALL_COST = 0.07, 2e5
"""Time of a dense matrix's factors, for each unknown cubed, and of the work beside a transform, in that of a transform,
for its points times their log2."""


class OutOfWorkError(Exception):
    """The work that was granted is spent."""


@dataclass
class TransformCounter:
    """Number of real transforms so far.

    A transform on a coarser grid counts as the ratio of its points to `finest`, the points of the finest grid. What is
    granted pays for dense matrices too, in the transforms that take as long.
    """

    finest: int
    transforms: float = 0.0
    _dense: float = 0.0
    _limit: float = math.inf

    def add(self, count: int, size: int) -> None:
        """Count `count` transforms on a grid of `size` points; raise OutOfWorkError beyond the number granted."""
        self.transforms += count * size / self.finest
        if self.spent > self._limit:
            raise OutOfWorkError

    def add_factors(self, unknowns: int) -> None:
        """Add the factors of a dense matrix with that many unknowns to what is spent, not to the transforms."""
        self._dense += FACTOR_COST * unknowns**3 / (self.finest * math.log2(self.finest + 1) + CALL_COST)

    @property
    def spent(self) -> float:
        """Transforms, and those that take as long as all dense matrices."""
        return self.transforms + self._dense

    @contextmanager
    def granted(self, transforms: float) -> Iterator[None]:
        """Grant a number of transforms to what is done within."""
        self._limit = self.spent + transforms
        try:
            yield
        finally:
            self._limit = math.inf
