"""Statistics of heights that do not repeat: at the ends only what lies inside counts.

Each function is that of `contactsim.surfaces.statistics` without `_open` in its name, which goes on at the other end.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from contactsim.grid import Array


def rms_gradient_open(heights: Array, spacing: Sequence[float], where: Array | None = None) -> float:
    """Return the root-mean-square gradient over the points in `where`; over all pairs of neighbours without it.

    A point counts with the mean of its two squared slopes, at an end with the one that it has. NaN if `where` is empty.

    Parameters
    ----------
    heights : array, shape (n,) or (ny, nx)
        Heights.
    spacing : sequence of float
        Distance between points in each direction, in the unit of heights.
    where : array of bool, optional
        Points, of the same shape.
    """
    if where is None:
        return float(np.sqrt(sum(np.mean(square) for square in _squares(heights, spacing))))
    if not where.any():
        return float("nan")
    return float(np.sqrt(np.mean(local_squares_open(heights, spacing)[where])))


def _squares(heights: Array, spacing: Sequence[float]) -> list[Array]:
    """Return the squared slopes between neighbours along each axis."""
    return [(np.diff(heights, axis=axis) / step) ** 2 for axis, step in enumerate(spacing)]


def local_squares_open(heights: Array, spacing: Sequence[float]) -> Array:
    """Return the mean of the two squared slopes at each point, over a surface their sum along both axes."""
    squares = (_at_points(square, axis) for axis, square in enumerate(_squares(heights, spacing)))
    return np.asarray(sum(squares))


def _at_points(values: Array, axis: int) -> Array:
    """Return the mean of the values between a point and its neighbours along an axis, at an end the one there is."""
    padded = np.concatenate([values.take([0], axis), values, values.take([-1], axis)], axis)
    size = padded.shape[axis]
    return 0.5 * (padded.take(range(size - 1), axis) + padded.take(range(1, size), axis))


def rms_gradient_pairs_open(heights: Array, spacing: Sequence[float], where: Array) -> float:
    """Return the root-mean-square slope over neighbouring pairs with both ends in `where`; NaN without such a pair.

    Parameters as of `rms_gradient_open`; over a surface the mean squares of the pairs along each axis are added.
    """
    means = []
    for axis, step in enumerate(spacing):
        size = where.shape[axis]
        both = where.take(range(size - 1), axis) & where.take(range(1, size), axis)
        slopes = (np.diff(heights, axis=axis) / step)[both]
        means.append(np.mean(slopes**2) if slopes.size else np.nan)
    return float(np.sqrt(sum(means)))


def rms_curvature_open(heights: Array, spacing: Sequence[float]) -> float:
    """Return the root-mean-square curvature of the points inside, over a surface of the mean of both directions."""
    total = sum(second_differences(heights, axis, step) for axis, step in enumerate(spacing))
    return float(np.sqrt(np.mean(np.square(total / heights.ndim)))) if np.size(total) else float("nan")


def second_differences(heights: Array, axis: int, step: float) -> Array:
    """Return the second derivatives along an axis at the points inside, by differences."""
    inside = [slice(1, -1)] * heights.ndim
    inside[axis] = slice(None)
    return np.diff(heights, 2, axis=axis)[tuple(inside)] / step**2


def squared_gradient_open(heights: Array, spacing: Sequence[float]) -> Array:
    """Return the squared gradient at each point, by differences of second order at the ends too."""
    total = np.zeros(heights.shape)
    for axis, step in enumerate(spacing):
        size = heights.shape[axis]
        total += np.gradient(heights, step, axis=axis, edge_order=2 if size > 2 else 1) ** 2
    return total
