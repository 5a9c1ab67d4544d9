"""Numbers of a state of cohesive laws on a surface; a force in nN is GPa nm², compression positive."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactsim.contact.wall import contact_gap
from contactsim.grid import Array
from contactsim.observables.adhesion import CRITERION, INTERACTING

if TYPE_CHECKING:
    from contactsim.contact.cohesive import CohesiveProblem

INTERACTING_AREA = "interacting_area_0_01"
"""Area over which the traction exceeds a hundredth of the strength, the criterion of Chapter 5."""


def negative_area(field: Array, spacing: tuple[float, ...]) -> float:
    """Return the area over which a periodic field (ny, nx) is negative; its edge lies between points.

    It is the mean of the areas by rows and by columns, on each of which the edge lies where a straight line between
    neighbours is zero. The error is of second order in the spacing.
    """
    lengths = [_negative_lengths(np.moveaxis(field, axis, -1)) for axis in (0, 1)]
    return float(np.mean(lengths) * np.prod(spacing))


def _negative_lengths(field: Array) -> float:
    """Return the length in steps over which a periodic field (rows, n) is negative along its rows, all together."""
    after = np.roll(field, -1, -1)
    low, high = np.minimum(field, after), np.maximum(field, after)
    share = np.divide(low, low - high, out=np.zeros_like(low), where=(low < 0) & (high >= 0))
    return float(np.count_nonzero(high < 0) + share.sum())


def surface_observables(problem: CohesiveProblem, gap: Array, traction: Array) -> dict[str, float]:
    """Return the numbers of one state on a surface.

    Parameters
    ----------
    problem : CohesiveProblem
        The problem that it solves.
    gap, traction : array, shape (1, n)
        Normal gap, nm, and traction, GPa, rows of all points of the heights.

    Returns
    -------
    dict
        normal_force, its parts repulsive_force - adhesive_force, nN; mean_pressure, max_pressure and
        max_tensile_traction, GPa; contact_area, where the gap is negative, and `INTERACTING_AREA`, nm², also over the
        area of the surface; mean_gap and min_gap, nm; max_interpenetration, the deepest overlap over the laws' length.
    """
    grid, pull = problem.heights, traction[0]
    area = float(np.prod(grid.lengths))
    mean, pulled = -float(pull.mean()), float(np.maximum(pull, 0.0).mean())
    smallest = float(gap[0].min())
    contact = negative_area(contact_gap(problem, gap, traction).reshape(grid.shape), grid.spacing)
    interacting = float(np.mean(np.abs(pull) > INTERACTING[CRITERION] * problem.strength))
    return {
        "normal_force": mean * area,
        "repulsive_force": (mean + pulled) * area,
        "adhesive_force": pulled * area,
        "mean_pressure": mean,
        "max_pressure": max(-float(pull.min()), 0.0),
        "max_tensile_traction": max(float(pull.max()), 0.0),
        "contact_area": contact,
        INTERACTING_AREA: interacting * area,
        "relative_repulsive_area": contact / area,
        "relative_interacting_area": interacting,
        "mean_gap": float(gap[0].mean()),
        "min_gap": smallest,
        "max_interpenetration": max(-smallest, 0.0) / problem.interaction_range,
    }
