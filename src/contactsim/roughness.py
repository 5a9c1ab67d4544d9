"""Statistics of height profiles, over all of a surface or over the part in contact.

Root-mean-square height, gradient and curvature by finite differences on the periodic grid, and the power spectrum.
Eq. 3.8 gives a contact point the mean of its two squared slopes, one of which leads out of the contact at an edge of
a patch: the statistic then depends on the grid. `rms_gradient_bonds` counts only the slopes between two points that
are both in contact; in the limit of a fine grid the two agree, on real grids the second is there already.
"""

from __future__ import annotations

import numpy as np

from contactsim.errors import SceneError
from contactsim.grid import Array, Grid


def rms_height(heights: Array, where: Array | None = None) -> float:
    """Root-mean-square deviation from the mean height, shape (n,), in the unit of heights."""
    chosen = heights if where is None else heights[where]
    return float(np.std(chosen)) if chosen.size else float("nan")


def slopes(heights: Array, spacing: float) -> Array:
    """Slope from each point to its right neighbour, periodic, shape (n,), dimensionless."""
    return (np.roll(heights, -1) - heights) / spacing


def rms_gradient(heights: Array, spacing: float, where: Array | None = None) -> float:
    """Root-mean-square gradient over the points in `where`, default all (Eqs 3.8 and 3.9).

    heights: (n,) and spacing in one unit; where: bool (n,). NaN if `where` is empty.
    """
    right = slopes(heights, spacing) ** 2
    local = 0.5 * (right + np.roll(right, 1))
    chosen = local if where is None else local[where]
    return float(np.sqrt(chosen.mean())) if chosen.size else float("nan")


def rms_gradient_bonds(heights: Array, spacing: float, where: Array) -> float:
    """Root-mean-square slope over neighbouring pairs with both ends in `where`; NaN without such a pair.

    heights: (n,) and spacing in one unit; where: bool (n,).
    """
    both = where & np.roll(where, -1)
    return float(np.sqrt(np.mean(slopes(heights, spacing)[both] ** 2))) if both.any() else float("nan")


def rms_curvature(heights: Array, spacing: float, where: Array | None = None) -> float:
    """Root-mean-square second difference, shape (n,) to a number in 1/unit of spacing; NaN if `where` is empty."""
    second = (np.roll(heights, -1) - 2 * heights + np.roll(heights, 1)) / spacing**2
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
