"""What is read off a solution: functions on arrays.

Contact area follows one of three named criteria; the hard wall has `touching`, points with positive pressure. Counting
them puts each edge half a step beyond the last of them, but on average it lies only 0.31 steps beyond, so the count is
too large, at first order. `relative_contact_area_subgrid` places the edge by the gap, which at the smooth edge of a
contact without adhesion opens as distance^(3/2): gap^(2/3) at the first two open points leads straight back to it.
Next to an edge the solution on a grid is not the continuous one but, the pressures being those of points and the
response that of the half-space, universal: by where the edge lies between two points. So is the small correction.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from contactsim.grid import Array
from contactsim.surfaces.statistics import rms_gradient, rms_gradient_pairs

KEPT = ("contact", "pressure", "profile", "fields")
"""What a run may keep beside its numbers; all but the last by default."""


def touching(pressure: Array) -> Array:
    """Points in contact at a hard wall: positive pressure, bool of the same shape (Chapter 3)."""
    return pressure > 0


EDGES = (-0.19, 0.81)
"""Between which steps beyond the last point in contact a straight edge along the grid lies."""
EDGE_FIT = (1.333, -0.522)
"""Straight back to v steps, the edge of Westergaard's wave lies at 1.333 v - 0.522 v², to 0.01 (4096 points)."""


def relative_contact_area_subgrid(pressure: Array, gap: Array) -> float:
    """Relative contact area at a hard wall with its edges placed between points.

    pressure, gap: (n,) or (ny, nx) of a converged solution, periodic, in any units; calibrated on a half-space. An edge
    with one open point beyond it counts at the mean of `EDGES`. Over a surface, each edge is placed along both axes,
    weighted by the squares of the slope of pressure², the direction of its normal. Errors, where several points are in
    contact across a patch: 0.01 steps an edge of a line; of the radius of a sphere 0.003 steps at 26 points, of second
    order, where counting is 0.13 steps out. A solution's tolerance of 1e-3 grid steps adds up to 0.04 steps, one of
    1e-4 0.01.
    """
    contact, flat = touching(pressure), (pressure.ravel(), gap.ravel())
    area = float(np.count_nonzero(contact))
    for axis in range(pressure.ndim):
        for side in (-1, 1):
            edge = np.flatnonzero(contact & ~np.roll(contact, side, axis))
            area += float(
                np.sum(_share(edge, axis, flat[0], contact.shape) * _beyond(edge, axis, side, flat, contact.shape))
            )
    return area / pressure.size


def _beside(places: Array, steps: int, axis: int, shape: tuple[int, ...]) -> Array:
    """Flat indices of the points some steps along an axis from others, periodic."""
    stride = int(np.prod(shape[axis + 1 :], dtype=int))
    along = places // stride % shape[axis]
    return places + ((along + steps) % shape[axis] - along) * stride


def _beyond(edge: Array, axis: int, side: int, fields: tuple[Array, Array], shape: tuple[int, ...]) -> Array:
    """By how many steps more than half a step an edge lies beyond the last points in contact; flat indices (m,)."""
    pressure, gap = fields
    first, second = (_beside(edge, -steps * side, axis, shape) for steps in (1, 2))
    near, far = (np.maximum(gap[places], 0.0) ** (2 / 3) for places in (first, second))
    known = (far > near) & ~touching(pressure[second])
    back = 1 - np.divide(near, far - near, out=np.zeros_like(near), where=known)
    beyond = np.where(known, EDGE_FIT[0] * back + EDGE_FIT[1] * back**2, np.mean(EDGES))
    return np.clip(beyond, *EDGES) - 0.5


def _share(edge: Array, axis: int, pressure: Array, shape: tuple[int, ...]) -> Array:
    """How much of the edge at points in contact counts along an axis: its normal's part, squared; flat indices (m,)."""
    steep = np.array([_steepness(edge, other, pressure, shape) for other in range(len(shape))]) ** 2
    total = steep.sum(0)
    return np.divide(steep[axis], total, out=np.full(edge.shape, 1 / len(shape)), where=total > 0)


def _steepness(places: Array, axis: int, pressure: Array, shape: tuple[int, ...]) -> Array:
    """The larger of the differences of pressure² to both neighbours along an axis, of those in contact."""
    here = pressure[places] ** 2
    beside = [pressure[_beside(places, steps, axis, shape)] for steps in (-1, 1)]
    return np.maximum(*(np.where(touching(other), np.abs(other**2 - here), 0.0) for other in beside))


def contact_edges(contact: Array) -> int:
    """Pairs of neighbours on the periodic grid of which one is in contact; bool (n,) or (ny, nx)."""
    return sum(int(np.count_nonzero(contact ^ np.roll(contact, 1, axis))) for axis in range(contact.ndim))


def wall_observables(heights: Array, spacing: Sequence[float], pressure: Array, gap: Array) -> dict[str, float]:
    """Numbers of one hard-wall state; heights, pressure, gap: (n,) or (ny, nx) in nm, GPa, nm; spacings nm.

    relative_contact_area, of points, and with edges between points; contact_edges; rms_gradient_contact (Eqs 3.8–3.9)
    and rms_gradient_contact_pairs (pairs with both ends in
    contact), NaN where there is none; mean_gap, nm; mean_pressure, GPa.
    """
    contact = touching(pressure)
    return {
        "relative_contact_area": float(contact.mean()),
        "relative_contact_area_subgrid": relative_contact_area_subgrid(pressure, gap),
        "contact_edges": contact_edges(contact),
        "rms_gradient_contact": rms_gradient(heights, spacing, contact),
        "rms_gradient_contact_pairs": rms_gradient_pairs(heights, spacing, contact),
        "mean_gap": float(gap.mean()),
        "mean_pressure": float(pressure.mean()),
    }


def proportionality(area: Array, pressure: Array, gradient: Array, contact_modulus: float) -> Array:
    """κ = a_rel ḡ E*/p (Eqs 3.1 and 3.3): with the gradient over all of the surface κ, over the contact κ_r.

    Broadcasts; NaN where the pressure is zero.
    """
    return np.where(pressure > 0, area * gradient * contact_modulus / np.where(pressure > 0, pressure, 1.0), np.nan)
