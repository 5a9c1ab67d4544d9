"""Multiplication of Fourier coefficients by a symbol, as elasticity does: an operator that is diagonal there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Protocol

import numpy as np

from contactsim import fft
from contactsim.grid import Array, Grid, TransformCounter, blocks, map_blocks


@dataclass(frozen=True)
class RadialSymbol:
    """Function of |q| at the coefficients of a surface; it is computed where it is read, so that no array is held.

    Parameters
    ----------
    grid : Grid
        Grid of the surface.
    function : callable
        Function of |q| (rad/nm).
    uniform : float
        Value at q = 0.
    """

    grid: Grid
    function: Callable[[Array], Array]
    uniform: float

    def __getitem__(self, places: tuple[Array, Array]) -> Array:
        """Return the values at rows and columns of the coefficients, which are broadcast."""
        values = self.function(self.grid.wavenumber_at(*places))
        values[np.logical_and(*(place == 0 for place in places))] = self.uniform
        return values

    def rows(self, low: int, high: int) -> Array:
        """Return the values at the rows from `low` to before `high`."""
        row, column = np.ogrid[low:high, : self.grid.half_shape[1]]
        return self[row, column]

    def folded(self, kind: type = float) -> list[tuple[slice, Array]]:
        """Return slices of rows with their values: half of the rows, and the same in reverse, as |q| is the same."""
        count = self.grid.shape[0]
        half = count // 2 + 1
        values: Array = np.empty((half, self.grid.half_shape[1]), kind)

        def fill(low: int, high: int) -> None:
            """Compute the values at some rows."""
            values[low:high] = self.rows(low, high)

        map_blocks(fill, (half, self.grid.shape[1]), self.grid.threads)
        return [(slice(half), values), (slice(half, None), values[count - half : 0 : -1])]

    def scaled(self, grid: Grid, factor: float) -> RadialSymbol:
        """Return the symbol times a factor on a grid with the same periods."""
        return RadialSymbol(grid, lambda q: self.function(q) * factor, self.uniform * factor)


class Product(Protocol):
    """The product of a surface's compliance with a field in single precision."""

    def __call__(self, field: Array, scratch: Array, out: Array) -> None:
        """Write the product; all (ny, nx and padding), and `scratch` is overwritten."""


class Compliance(Protocol):
    """A compliance as solvers need it: without units, the spacing along x and E* being 1."""

    grid: Grid
    symbol: Any
    counter: TransformCounter

    @property
    def holds_mean(self) -> bool:
        """True if the mean displacement does not follow the mean pressure."""

    def hold_symbol(self) -> None:
        """Hold in memory what every application needs."""

    def __call__(self, values: Array, out: Array | None = None) -> Array:
        """Return the displacement under a pressure; see `FourierOperator`."""

    def coarser(self, shape: tuple[int, ...]) -> Compliance:
        """Return the compliance on fewer points, in units of their spacing."""

    def in_single_precision(self) -> Product:
        """Return its product with fields of a surface in single precision."""


@dataclass
class FourierOperator:
    """Multiplication of the Fourier coefficients of a field by a symbol.

    One application costs two transforms. On a line the coefficients have memory of their own; on a surface, where
    memory is short, they are computed in the memory of the result.

    Parameters
    ----------
    grid : Grid
        Grid of the field.
    symbol : array, shape `grid.half_shape`, or RadialSymbol
        Factor of each coefficient; of a surface one that is computed by rows.
    counter : TransformCounter
        Counts the transforms.
    """

    grid: Grid
    symbol: Any
    counter: TransformCounter
    _half: Array | None = field(init=False, repr=False)
    _held: list[tuple[slice, Array]] = field(init=False, repr=False, default_factory=list)

    def __post_init__(self) -> None:
        self._half = np.empty(self.grid.half_shape, complex) if len(self.grid.shape) == 1 else None

    @property
    def holds_mean(self) -> bool:
        """True if the uniform mode has no compliance."""
        return bool((self.symbol[0] if len(self.grid.shape) == 1 else self.symbol.uniform) == 0)

    def hold_symbol(self) -> None:
        """Hold the symbol of a surface in memory, for methods that apply the operator in each iteration."""
        if self._half is None and not self._held:
            self._held = self.symbol.folded()

    def __call__(self, values: Array, out: Array | None = None) -> Array:
        """Apply the operator to a real field.

        Parameters
        ----------
        values : array, shape `grid.shape`
            The field.
        out : array, optional
            Receives the result. On a line it has the shape of `values` and may be `values`; on a surface it has the
            grid's `wide_shape`.

        Returns
        -------
        array, shape `grid.shape`
            The result; on a surface the first columns of `out`.
        """
        self.counter.add(2, self.grid.size)
        if self._half is None:
            return self._in_place(values, np.empty(self.grid.wide_shape) if out is None else out)
        half = self.grid.forward(values, out=self._half)
        half *= self.symbol
        return fft.backward(half, self.grid.shape[-1], out=out, may_overwrite=True, threads=self.grid.threads)

    def coarser(self, shape: tuple[int, ...]) -> FourierOperator:
        """Return the operator on fewer points, in units of their spacing."""
        grid, ratio = self.grid.coarser(shape), shape[-1] / self.grid.shape[-1]
        on_line = len(shape) == 1
        symbol = self.symbol[grid.modes_of(self.grid)] * ratio if on_line else self.symbol.scaled(grid, ratio)
        return FourierOperator(grid, symbol, self.counter)

    def in_single_precision(self) -> Product:
        """Return the product with fields of a surface in single precision; coefficients are in the scratch."""
        symbol, columns = self.symbol.folded(np.float32), self.grid.shape[1]

        def product(field: Array, scratch: Array, out: Array) -> None:
            """Write the product."""
            half = scratch.view(np.complex64)[:, : columns // 2 + 1]
            self.grid.forward(field[:, :columns], out=half)
            self._multiply(half, symbol)
            fft.backward(half, columns, out=out[:, :columns], may_overwrite=True, threads=self.grid.threads)
            self.counter.add(2, self.grid.size)

        return product

    def _in_place(self, values: Array, wide: Array) -> Array:
        columns, rows = self.grid.shape[-1], list(blocks(self.grid.shape))
        result, half = wide[:, :columns], wide.view(complex)[:, : columns // 2 + 1]
        threads = self.grid.threads
        for low, high in rows:
            half[low:high] = fft.forward(values[low:high], (1,), threads=threads)
        fft.transform(half, 0, threads=threads)
        if self._held:
            self._multiply(half, self._held)
        else:
            map_blocks(partial(self._multiply_rows, half), self.grid.shape, self.grid.threads)
        fft.transform_back(half, 0, threads=threads)
        for low, high in rows:
            result[low:high] = fft.backward(half[low:high], columns, (1,), threads=threads)
        return result

    def _multiply_rows(self, half: Array, low: int, high: int) -> None:
        """Multiply coefficients by the symbol at some rows, in place."""
        half[low:high] *= self.symbol.rows(low, high)

    def _multiply(self, half: Array, symbol: list[tuple[slice, Array]]) -> None:
        """Multiply coefficients by a symbol that is held by slices of rows, in place."""
        for rows, values in symbol:
            map_blocks(partial(_multiply_block, half[rows], values), values.shape, self.grid.threads)


def _multiply_block(field: Array, factor: Array, low: int, high: int) -> None:
    """Multiply a field by a factor at some rows, in place."""
    field[low:high] *= factor[low:high]
