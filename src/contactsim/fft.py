"""Fast Fourier transforms: the one module that knows the library that makes them.

Forward transforms divide by the number of points, so that the entry q = 0 is the mean, unless `scaled` is False;
backward ones do not. `axes` are all axes by default; `out` receives the result and may be the input of `transform`.
"""

from __future__ import annotations

from typing import Any

import ducc0
from numpy.typing import NDArray

Field = NDArray[Any]
Axes = tuple[int, ...] | None


def forward(
    field: Field, axes: Axes = None, *, out: Field | None = None, scaled: bool = True, threads: int = 1
) -> Field:
    """Return the coefficients of a real field, of which the last axis has half and one more."""
    return ducc0.fft.r2c(field, axes=axes, forward=True, inorm=2 * scaled, out=out, nthreads=threads)


def backward(
    coefficients: Field,
    size: int,
    axes: Axes = None,
    *,
    out: Field | None = None,
    may_overwrite: bool = False,
    threads: int = 1,
) -> Field:
    """Return the real field, with `size` points along the last axis, that has these coefficients.

    The coefficients are lost if they may be overwritten.
    """
    options = {"nthreads": threads, "allow_overwriting_input": may_overwrite}
    return ducc0.fft.c2r(coefficients, axes=axes, lastsize=size, forward=False, out=out, **options)


def transform(values: Field, axis: int, *, scaled: bool = True, threads: int = 1) -> None:
    """Transform complex values along an axis, in place."""
    ducc0.fft.c2c(values, axes=(axis,), forward=True, inorm=2 * scaled, out=values, nthreads=threads)


def transform_back(values: Field, axis: int, *, threads: int = 1) -> None:
    """Transform complex coefficients back along an axis, in place."""
    ducc0.fft.c2c(values, axes=(axis,), forward=False, out=values, nthreads=threads)


def cosine_sums(values: Field, axis: int, *, threads: int = 1) -> None:
    """Replace the first half of even values by that of their coefficients along an axis, not scaled."""
    ducc0.fft.dct(values, type=1, axes=(axis,), out=values, nthreads=threads)


def good_size(least: int) -> int:
    """Return a number of points, at least so many, on which transforms of real fields are fast."""
    return int(ducc0.fft.good_size(least, True))
