"""Exponential functions of the gap that cohesive zones consist of, continued by their tangents under deep overlap.

Gaps are in characteristic lengths. Below an overlap of MAX_OVERLAP the dependence on the normal gap is continued by its
tangent, because the exponential would overflow at a bad first guess. No solution of physical interest gets there.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array

MAX_OVERLAP = 10.0
"""Overlap, in characteristic lengths, beyond which a law is continued by its tangent."""
MAX_SLIP = 30.0
"""Tangential gap y, in characteristic lengths, beyond which exp(-y²) is zero to all digits: y is cut there."""


def decay(normal: Array) -> tuple[Array, Array]:
    """Return exp(-y), continued by its tangent below -MAX_OVERLAP, and its derivative."""
    inside = np.maximum(normal, -MAX_OVERLAP)
    value = np.exp(-inside)
    return value * (1 + (inside - normal)), -value


def pull(normal: Array) -> tuple[Array, Array]:
    """Return y exp(-y), continued by its tangent below -MAX_OVERLAP, and its derivative."""
    inside = np.maximum(normal, -MAX_OVERLAP)
    value = np.exp(-inside)
    slope = (1 - inside) * value
    return inside * value + (normal - inside) * slope, slope
