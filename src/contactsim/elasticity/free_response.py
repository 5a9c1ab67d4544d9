"""Response of a half-space to the pressure on single elements, without periodic images.

On a grid a pressure is uniform over each element: a strip around a point of a line, a rectangle around a point of a
surface (A. E. H. Love, Phil. Trans. R. Soc. A 228, 377 (1929), doi:10.1098/rsta.1929.0009). Lengths are in the spacing
along x, responses in spacing/E*.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array

FAR_DISTANCE = 500.0
"""Distance over the longer side beyond which a rectangle acts by its moments, since differences would lose digits."""


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
    far = FAR_DISTANCE * max(height, 1.0)
    near_y, near_x = (int(np.count_nonzero(places <= far)) for places in (y, x))
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
