"""Contact area and gradient at a hard wall, freed of the error of first order that the grid leaves at edges.

A point counts as in contact if its pressure is positive. Counting such points puts the edge of a contact half a step
beyond the last of them, which is too far on average. The excess is proportional to the number of pairs of neighbours of
which one is in contact. The factor follows from the discrete elasticity, if edges have all directions alike.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array
from contactsim.observables.contact import contact_edges

EDGE_EXCESS = {1: 0.19, 2: 0.101}
"""Mean area, in cells of the grid, that counting adds for each pair of neighbours of which one is in contact.

By the number of dimensions. A line: half a step less the mean distance of an edge beyond the last point in contact. A
surface: 0.1014 ± 0.0008 over 600 spheres with contact radii of 5 to 40 points at random places
(benchmarks/edge_excess.py). An edge that does not depend on the elasticity, straight and at a random angle, would have
(π - 1 + ln 2)/24 = 0.1181: Yastrebov, Anciaux, Molinari, Tribol. Int. 114, 161 (2017),
doi:10.1016/j.triboint.2017.04.023.
"""


def corrected_area(contact: Array) -> float:
    """Return the relative contact area without the mean excess of its edges; contact: bool (n,) or (ny, nx)."""
    return (np.count_nonzero(contact) - EDGE_EXCESS[contact.ndim] * contact_edges(contact)) / contact.size


def edge_points(contact: Array) -> Array:
    """Return the points in contact with a neighbour that is not, bool of the same shape, periodic."""
    inside = contact.copy()
    for axis in range(contact.ndim):
        inside &= np.roll(contact, 1, axis) & np.roll(contact, -1, axis)
    return contact & ~inside


def gradient_within(squared_gradient: Array, contact: Array, area: float) -> float:
    """Return the rms gradient over a contact whose edges lie between points; NaN without contact.

    Parameters
    ----------
    squared_gradient : array, shape (n,) or (ny, nx)
        At each point.
    contact : bool array of the same shape
        Points in contact.
    area : float
        Relative contact area. What it lacks of the counted area is taken from the points at the edges, in equal parts.
    """
    edge = edge_points(contact)
    lost = (np.count_nonzero(contact) - area * contact.size) / max(int(np.count_nonzero(edge)), 1)
    total = squared_gradient[contact].sum() - lost * squared_gradient[edge].sum()
    return float(np.sqrt(total / (area * contact.size))) if area > 0 and total >= 0 else float("nan")
