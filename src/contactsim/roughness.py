"""Statistics of height profiles, over all of a surface or over the part in contact.

Root-mean-square height, gradient and curvature by finite differences on the periodic grid, and the power spectrum.
Eq. 3.8 gives a contact point the mean of its two squared slopes, one of which leads out of the contact at an edge of
a patch: the statistic then depends on the grid. `rms_gradient_bonds` counts only the slopes between two points that
are both in contact; in the limit of a fine grid the two agree, on real grids the second is there already.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from contactsim.errors import SceneError
from contactsim.grid import Array, Grid


def rms_height(heights: Array, where: Array | None = None) -> float:
    """Root-mean-square deviation from the mean height, any shape, in the unit of heights."""
    chosen = heights if where is None else heights[where]
    return float(np.std(chosen)) if chosen.size else float("nan")


def slopes(heights: Array, spacing: float | Sequence[float]) -> Iterator[tuple[int, Array]]:
    """Each axis with the slopes from each point to its next neighbour along it, periodic, dimensionless.

    heights: (n,) or (ny, nx); spacing: one for all directions or one each, in the unit of heights.
    """
    for axis, step in enumerate(np.broadcast_to(spacing, heights.ndim)):
        yield axis, (np.roll(heights, -1, axis) - heights) / step


def rms_gradient(heights: Array, spacing: float | Sequence[float], where: Array | None = None) -> float:
    """Root-mean-square gradient over the points in `where`, default all (Eqs 3.8 and 3.9).

    Over a surface the mean squares along both axes are added: this reading of Eq. 3.8 gives c/(R√2) for a sphere, as
    Table 3.1 has it, and the text's κ_r; half of that sum would not. heights: (n,) or (ny, nx) and spacing (one, or one
    each direction) in one unit; where: bool of the same shape. NaN if `where` is empty.
    """
    total = 0.0
    for axis, right in slopes(heights, spacing):
        np.square(right, out=right)
        local = 0.5 * (right + np.roll(right, 1, axis))
        chosen = local if where is None else local[where]
        total += chosen.mean() if chosen.size else np.nan
    return float(np.sqrt(total))


def rms_gradient_bonds(heights: Array, spacing: float | Sequence[float], where: Array) -> float:
    """Root-mean-square slope over neighbouring pairs with both ends in `where`; NaN without such a pair.

    Over a surface the mean squares of the pairs along each axis are added. heights: (n,) or (ny, nx) and spacing (one,
    or one each direction) in one unit; where: bool of the same shape.
    """
    total = 0.0
    for axis, right in slopes(heights, spacing):
        both = where & np.roll(where, -1, axis)
        total += np.mean(right[both] ** 2) if both.any() else np.nan
    return float(np.sqrt(total))


def rms_curvature(heights: Array, spacing: float | Sequence[float], where: Array | None = None) -> float:
    """Root-mean-square curvature, over a surface of the mean of both directions, in 1/unit of spacing.

    heights: (n,) or (ny, nx); spacing: one, or one each direction; NaN if `where` is empty.
    """
    second = np.zeros(heights.shape)
    for axis, step in enumerate(np.broadcast_to(spacing, heights.ndim)):
        bent = np.roll(heights, -1, axis) - 2 * heights + np.roll(heights, 1, axis)
        second += bent / (step**2 * heights.ndim)
    chosen = second if where is None else second[where]
    return float(np.sqrt(np.mean(chosen**2))) if chosen.size else float("nan")


def spectrum(heights: Array, length: float) -> tuple[Array, Array]:
    """Two-sided power spectral density C(q) of a periodic profile, so that ∫C dq over all q is the variance.

    heights: (n,), nm; length: period, nm. Returns q > 0 (rad/nm) and C (nm³), each of shape (n // 2,). At the Nyquist
    wavenumber of an even grid the coefficient holds both signs of q and is halved.
    """
    if np.ndim(heights) != 1:
        raise SceneError("heights", heights, "one dimension")
    grid = Grid((len(heights),), (length,))
    power = np.abs(grid.forward(np.ascontiguousarray(heights, float))) ** 2 * length / (2 * np.pi)
    if len(heights) % 2 == 0:
        power[-1] /= 2
    return grid.wavenumber[1:], power[1:]
