"""Contact area and gradients of a hard-wall solution, as functions of arrays.

Contact area follows one of three named criteria; the hard wall has `touching`, points with positive pressure. Counting
them puts each edge half a step beyond the last of them, but on average it lies only 0.31 steps beyond, so the count is
too large, at first order. `relative_contact_area_subgrid` places the edge by the gap, which at the smooth edge of a
contact without adhesion opens as distance^(3/2): gap^(2/3) at the first two open points leads straight back to it.
Next to an edge the solution on a grid is not the continuous one but, the pressures being those of points and the
response that of the half-space, universal: by where the edge lies between two points. So is the small correction.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array

DEFAULT_KEPT = ("contact", "pressure", "profile")
"""What a run keeps of a solution beside its numbers, unless it is told otherwise."""
KEPT_ONCE = "profile"
"""What of these is the same for all loads."""
KEPT = (*DEFAULT_KEPT, "fields", "distributions", "patches", "stiffness")
"""All that it can keep; the stiffness of the contact costs one to three further solutions."""


def touching(pressure: Array) -> Array:
    """Return the points in contact at a hard wall: positive pressure, bool of the same shape (Chapter 3)."""
    return pressure > 0


def yielding_share(pressure: Array, hardness: float) -> float:
    """Return the share of the contact whose pressure exceeds a hardness; NaN without contact."""
    contact = touching(pressure)
    return float((pressure[contact] > hardness).mean()) if contact.any() else float("nan")


EDGES = (-0.19, 0.81)
"""Least and largest distance, in steps, of a straight edge along the grid beyond the last point in contact."""
EDGE_FIT = (1.333, -0.522)
"""Where a straight line leads v steps back, the edge of Westergaard's wave lies at 1.333 v - 0.522 v², to 0.01."""


def relative_contact_area_subgrid(pressure: Array, gap: Array, periodic: bool = True) -> float:
    """Return the relative contact area at a hard wall with its edges placed between points.

    Parameters
    ----------
    pressure, gap : array, shape (n,) or (ny, nx)
        A converged solution, in any units; the edges are calibrated on a half-space.
    periodic : bool
        Whether the heights repeat; where they do not, a contact that reaches their end has no edge there.

    Notes
    -----
    An edge with one open point beyond it counts at the mean of `EDGES`. On a surface each edge is placed along both
    axes, weighted by the squares of the slope of pressure², the direction of its normal. Where several points are in
    contact across a patch, the error is 0.01 steps for an edge of a line; for the radius of a sphere of 26 points it is
    0.003 steps, of second order, against 0.13 steps by counting. A tolerance of 1e-3 grid steps adds up to 0.04 steps,
    one of 1e-4 adds 0.01.
    """
    contact, flat = touching(pressure), (pressure.ravel(), gap.ravel())
    area = float(np.count_nonzero(contact))
    for axis in range(pressure.ndim):
        for side in (-1, 1):
            edge = np.flatnonzero(contact & ~np.roll(contact, side, axis))
            beyond = _beyond(edge, axis, side, flat, contact.shape)
            if not periodic:
                edge, beyond = _within_ends(edge, beyond, axis, side, contact.shape)
            area += float(np.sum(_share(edge, axis, flat[0], contact.shape) * beyond))
    return area / pressure.size


def _beside(places: Array, steps: int, axis: int, shape: tuple[int, ...]) -> Array:
    """Return the flat indices of the points some steps along an axis from others, periodic."""
    stride = int(np.prod(shape[axis + 1 :], dtype=int))
    along = places // stride % shape[axis]
    return places + ((along + steps) % shape[axis] - along) * stride


def _beyond(edge: Array, axis: int, side: int, fields: tuple[Array, Array], shape: tuple[int, ...]) -> Array:
    """Return the steps, less a half, by which an edge lies beyond the last points in contact; flat indices (m,)."""
    pressure, gap = fields
    first, second = (_beside(edge, -steps * side, axis, shape) for steps in (1, 2))
    near, far = (np.maximum(gap[places], 0.0) ** (2 / 3) for places in (first, second))
    is_regular = (far > near) & ~touching(pressure[second])
    back = 1 - np.divide(near, far - near, out=np.zeros_like(near), where=is_regular)
    beyond = np.where(is_regular, EDGE_FIT[0] * back + EDGE_FIT[1] * back**2, np.mean(EDGES))
    return np.clip(beyond, *EDGES) - 0.5


def _within_ends(edge: Array, beyond: Array, axis: int, side: int, shape: tuple[int, ...]) -> tuple[Array, Array]:
    """Return the edges that do not lie at the end of the heights; one step before it an edge counts at the mean."""
    along = edge // int(np.prod(shape[axis + 1 :], dtype=int)) % shape[axis]
    left = along if side > 0 else shape[axis] - 1 - along  # steps to the end
    beyond = np.where(left == 1, np.mean(EDGES) - 0.5, beyond)
    return edge[left > 0], beyond[left > 0]


def _share(edge: Array, axis: int, pressure: Array, shape: tuple[int, ...]) -> Array:
    """Return the weight of the edge at points in contact along an axis: its normal's part, squared; flat (m,)."""
    steep = np.array([_steepness(edge, other, pressure, shape) for other in range(len(shape))]) ** 2
    total = steep.sum(0)
    return np.divide(steep[axis], total, out=np.full(edge.shape, 1 / len(shape)), where=total > 0)


def _steepness(places: Array, axis: int, pressure: Array, shape: tuple[int, ...]) -> Array:
    """Return the larger difference of pressure² to the neighbours in contact along an axis."""
    here = pressure[places] ** 2
    beside = [pressure[_beside(places, steps, axis, shape)] for steps in (-1, 1)]
    return np.maximum(*(np.where(touching(other), np.abs(other**2 - here), 0.0) for other in beside))


def contact_edges(contact: Array, periodic: bool = True) -> int:
    """Return the number of pairs of neighbours with one point in contact.

    Parameters
    ----------
    contact : array of bool, shape (n,) or (ny, nx)
        Points in contact.
    periodic : bool
        Whether the first and the last points are neighbours.
    """
    pairs = (
        contact ^ np.roll(contact, 1, axis) if periodic else np.diff(contact, axis=axis) for axis in range(contact.ndim)
    )
    return sum(int(np.count_nonzero(pair)) for pair in pairs)
