"""Heights that a measurement lacks, filled in from those around them or as pits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactsim.errors import InputError, Words
from contactsim.grid import Array

MAX_SHARE = 0.5
"""Largest share of the points that may be filled."""


def fill_missing(heights: Array, way: str, file: object = None) -> tuple[Array, float]:
    """Return heights without gaps, and the share of the points that were filled.

    Parameters
    ----------
    heights : array, shape (n,) or (ny, nx)
        Heights; NaN where there is none.
    way : {"linear", "nearest", "lowest"}
        - "linear": between the points around a hole; beyond the last ones as "nearest".
        - "nearest": as the nearest point.
        - "lowest": as the lowest point of all, so that what was not seen is not touched.
    file : optional
        Where they come from, for messages.

    Raises
    ------
    InputError
        For another way, or more than half of the points missing.
    """
    if not isinstance(way, str) or way not in WAYS:
        raise InputError("fill", way, f"one of {', '.join(WAYS)}", file)
    missing = ~np.isfinite(heights)
    share = float(missing.mean())
    if share > MAX_SHARE:
        problem = f"{missing.sum()} of {missing.size} points missing or not finite"
        raise InputError("heights", Words(problem), f"at most {MAX_SHARE:.0%} missing, to be filled", file)
    filled = np.where(missing, np.nan, heights)
    if share:
        filled[missing] = WAYS[way](filled, missing)
    return filled, share


def _lowest(heights: Array, missing: NDArray[np.bool_]) -> Array:
    """Return the lowest height for each missing one."""
    return np.full(int(missing.sum()), np.nanmin(heights))


def _nearest(heights: Array, missing: NDArray[np.bool_]) -> Array:
    """Return the height of the nearest point for each missing one."""
    from scipy.ndimage import distance_transform_edt  # takes longer to import than a file to read

    places: Any = distance_transform_edt(missing, return_distances=False, return_indices=True)
    return heights[tuple(places)][missing]


def _linear(heights: Array, missing: NDArray[np.bool_]) -> Array:
    """Return heights interpolated between the points around each hole."""
    if heights.ndim == 1:
        known = np.flatnonzero(~missing)
        return np.interp(np.flatnonzero(missing), known, heights[known])
    from scipy.interpolate import LinearNDInterpolator
    from scipy.ndimage import binary_dilation
    from scipy.spatial import QhullError

    around, nearest = binary_dilation(missing, np.ones((3, 3))) & ~missing, _nearest(heights, missing)
    try:
        values = LinearNDInterpolator(np.argwhere(around), heights[around])(np.argwhere(missing))
    except QhullError:  # beyond a single row of points there is nothing to interpolate between
        return nearest
    return np.where(np.isnan(values), nearest, values)


WAYS: Mapping[str, Callable[[Array, NDArray[np.bool_]], Array]] = {
    "linear": _linear,
    "nearest": _nearest,
    "lowest": _lowest,
}
"""Ways to fill heights that are missing."""
REMEDY = f"; or `fill` as one of {', '.join(WAYS)}"
"""What may be done about missing points, in a message."""
