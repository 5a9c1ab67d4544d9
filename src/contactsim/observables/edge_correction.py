"""Contact area and gradient at a hard wall, freed of the error of first order that the grid leaves at edges.

A point counts as in contact if its pressure is positive. Counting such points puts the edge of a contact half a step
beyond the last of them, which is too far on average. The excess is proportional to the number of pairs of neighbours of
which one is in contact. The factor follows from the discrete elasticity, if edges have all directions alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

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


def corrected_area(contact: Array, periodic: bool = True) -> float:
    """Return the relative contact area without the mean excess of its edges; parameters as of `contact_edges`."""
    return (np.count_nonzero(contact) - EDGE_EXCESS[contact.ndim] * contact_edges(contact, periodic)) / contact.size


def edge_points(contact: Array, periodic: bool = True) -> Array:
    """Return the points in contact with a neighbour that is not, bool of the same shape; see `contact_edges`."""
    around = np.pad(contact, 1, "wrap") if periodic else np.pad(contact, 1, constant_values=True)
    inside = contact.copy()
    for axis in range(contact.ndim):
        for shift in (0, 2):
            window = [slice(1, -1)] * contact.ndim
            window[axis] = slice(shift, shift + contact.shape[axis])
            inside &= around[tuple(window)]
    return contact & ~inside


@dataclass(frozen=True)
class ContactGradient:
    """Squared gradient summed over a contact and over its edges, whose points have a neighbour that is not in contact.

    Attributes
    ----------
    size
        Points of the grid.
    points, edge_points
        Points in contact, and of these at its edges.
    total, edge_total
        Sums of the squared gradient over both.
    """

    size: int
    points: int
    edge_points: int
    total: float
    edge_total: float

    @classmethod
    def of(
        cls, squared_gradient: Iterable[tuple[slice, Array]], contact: Array, periodic: bool = True
    ) -> ContactGradient:
        """Return the sums over a contact, bool (n,) or (ny, nx), of a squared gradient that comes by blocks of rows."""
        edge, columns = edge_points(contact, periodic), contact.shape[-1]
        inside, at_edge = contact.reshape(-1, columns), edge.reshape(-1, columns)
        sums = [(values[inside[rows]].sum(), values[at_edge[rows]].sum()) for rows, values in squared_gradient]
        total, edge_total = (math.fsum(part) for part in zip(*sums, strict=True))
        return cls(contact.size, int(np.count_nonzero(contact)), int(np.count_nonzero(edge)), total, edge_total)

    def within(self, area: float) -> float:
        """Return the rms gradient over a contact whose edges lie between points; NaN without contact.

        area: relative contact area. What it lacks of the counted area is taken from the points at the edges, in equal
        parts.
        """
        lost = (self.points - area * self.size) / max(self.edge_points, 1)
        total = self.total - lost * self.edge_total
        return float(np.sqrt(total / (area * self.size))) if area > 0 and total >= 0 else float("nan")
