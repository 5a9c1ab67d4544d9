"""The grid step: the typical height difference of neighbouring points, the unit of length of hard-wall problems."""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array

SAMPLE_SIZE = 2**16
"""Points from which the grid step of a surface is estimated, unless it has fewer than twice as many."""
GOLDEN_FRACTION = 0x9E3779B97F4A7C15
"""Golden fraction of 2^64: its multiples by 1, 3, 6, 10, … are spread without any period."""
MIN_DIFFERENCE = 1e-9
"""Height differences below it, over the rms of all, do not count in the grid step."""


def grid_step(heights: Array) -> float:
    """Return the typical height difference of neighbouring points on a periodic grid.

    Parameters
    ----------
    heights
        Heights (n,) or (ny, nx) in any unit of length.

    Returns
    -------
    float
        In the unit of the heights: the median of all differences that are not zero, over 0.6745, and at most their rms.
        For Gaussian heights both are equal. The rms alone would be large for a single pit, which the contact never
        feels, and make every tolerance loose.
    """
    scale = max(abs(float(heights.max())), abs(float(heights.min())))
    if not scale:
        return 0.0
    differences = _differences(heights, scale)
    np.abs(differences, out=differences)
    rms = float(np.sqrt(np.vdot(differences, differences) / differences.size))
    nonzero = differences[differences > MIN_DIFFERENCE * rms]
    del differences
    return float(scale * min(rms, np.median(nonzero, overwrite_input=True) / 0.6745)) if nonzero.size else 0.0


def _differences(heights: Array, scale: float) -> Array:
    """Return the differences of heights over scale to the preceding neighbour, a row for each direction, x first.

    Of many points a scattered sample is used: whole rows, or points in a regular order, could all lie at the same place
    of a periodic texture and miss its edges.
    """
    if heights.ndim == 1 or heights.size < 2 * SAMPLE_SIZE:
        here = heights / scale
        differences = np.empty((heights.ndim, *here.shape))
        for row, axis in zip(range(heights.ndim), (-1, 0), strict=False):
            np.subtract(here, np.roll(here, 1, axis), out=differences[row])
        return differences
    count = np.arange(1, SAMPLE_SIZE + 1, dtype=np.uint64)
    place = (count * (count + 1) // 2 * GOLDEN_FRACTION >> 32) * heights.size >> 32
    y, x = np.divmod(place.astype(np.int64), heights.shape[1])
    here = heights[y, x] / scale
    return np.stack([here - heights[y, x - 1] / scale, here - heights[y - 1, x] / scale])
