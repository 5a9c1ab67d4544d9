"""Numbers of a state of cohesive laws on a line.

Loads are forces per unit thickness (N/m), compression positive (Eq. 4.2). Contact is `repulsive` where the normal gap
is negative, to a fraction of a node, or `interacting` where the traction exceeds a part of the laws' strength.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from contactsim.contact.wall import contact_gap
from contactsim.grid import Array

if TYPE_CHECKING:
    from contactsim.contact.cohesive import CohesiveProblem

INTERACTING = {
    "interacting_length_0_1": 1e-1,
    "interacting_length_0_01": 1e-2,
    "interacting_length_0_001": 1e-3,
    "interacting_length_1e_6": 1e-6,
}
"""Parts of the strength beyond which two surfaces interact."""
CRITERION = "interacting_length_0_01"
"""Criterion of Chapter 5, which says only that its threshold approaches zero."""
GRADIENTS = {
    "rms_gradient_interacting_0_1": "interacting_length_0_1",
    "rms_gradient_interacting": CRITERION,
    "rms_gradient_interacting_0_001": "interacting_length_0_001",
    "rms_gradient_interacting_1e_6": "interacting_length_1e_6",
}
"""Rms gradients over what interacts, and the criteria of contact that they belong to."""
AREAS = {"relative_repulsive_area": "contact_length", "relative_interacting_area": CRITERION}
"""Parts of the period, and the lengths that they come from."""
OPENINGS, PULLS = np.linspace(-3.0, 12.0, 61), np.linspace(-6.0, 1.0, 71)
"""Edges of histograms: gaps in the laws' length, normal tractions in their strength; the ends hold what lies beyond."""
SLIPPED = 0.3
"""Slip over the laws' length from which a node counts as slipped: the tangential factor of Eq. 5.2 is 0.91 there."""


def contact_length(gap: Array, spacing: float) -> float:
    """Return the length (nm) over which the normal gap (n,), nm, is negative; its ends lie between nodes."""
    after = np.concatenate((gap[1:], gap[:1]))
    inside, crossing = (gap < 0) & (after < 0), (gap < 0) != (after < 0)
    ends = np.minimum(gap, after)[crossing]
    return float(spacing * (np.count_nonzero(inside) + (ends / (ends - np.maximum(gap, after)[crossing])).sum()))


def state_observables(problem: CohesiveProblem, gap: Array, traction: Array) -> dict[str, float]:
    """Return the numbers of one state.

    Parameters
    ----------
    problem : CohesiveProblem
        The problem that it solves.
    gap : array, shape (components, n)
        Gap, nm.
    traction : array, shape (exerted, n)
        Traction, GPa.

    Returns
    -------
    dict
        line_load, its parts repulsive_load - adhesive_load, and friction_force, N/m; mean_pressure, max_pressure and
        max_tensile_traction, GPa; contact_length, lengths for `INTERACTING`, mean_gap and min_gap, nm. Over the laws'
        lengths: max_interpenetration, the deepest overlap, and slip, the largest
        tangential gap under repulsion (of springs, that to the nearest site). Over the contact by `CRITERION`:
        rms_slip, weighted by the normal traction, and slipped_share, the share of its nodes with a slip above
        `SLIPPED`.
    """
    spacing, length = problem.grid.spacing[0], problem.grid.lengths[0]
    size = np.abs(traction[0]) / problem.strength
    touching = contact_gap(problem, gap, traction)
    mean, pull = -float(traction[0].mean()), float(np.maximum(traction[0], 0.0).mean())
    smallest, pushed, pulled = float(gap[0].min()), -float(traction[0].min()), float(traction[0].max())
    numbers = {
        "line_load": mean * length,
        "repulsive_load": (mean + pull) * length,
        "adhesive_load": pull * length,
        "mean_pressure": mean,
        "mean_gap": float(gap[0].mean()),
        "contact_length": contact_length(touching, spacing),
        "min_gap": smallest,
        "max_pressure": max(pushed, 0.0),
        "max_tensile_traction": max(pulled, 0.0),
        "max_interpenetration": max(-smallest, 0.0) / problem.interaction_range,
    }
    numbers |= {name: float(spacing * np.count_nonzero(size > level)) for name, level in INTERACTING.items()}
    if len(gap) > 1:
        slip = np.abs(problem.offset(gap)) / problem.law.tangential_length
        numbers["slip"] = float(slip.max(where=touching < 0, initial=0.0))
        numbers |= slips(slip, size)
    for row in range(1, len(traction)):
        numbers["friction_force"] = float(traction[row].mean() * length)
    return numbers


def find_peaks(shape: Array) -> Array:
    """Return the peaks of a profile, bool (n,): the nodes where the undeformed gap is smaller than at both neighbours.

    shape: gap of the undeformed surfaces, (n,), nm
    """
    return (shape < np.roll(shape, 1)) & (shape < np.roll(shape, -1))


def touching_peaks(peaks: Array, size: Array) -> float:
    """Return the number of peaks in contact by `CRITERION`.

    Parameters
    ----------
    peaks
        True at the peaks of the profile, of `find_peaks`, (n,).
    size
        Size of the normal traction over the strength, (n,).
    """
    return float(np.count_nonzero(peaks & (size > INTERACTING[CRITERION])))


def slips(slip: Array, size: Array) -> dict[str, float]:
    """Return the rms slip and the slipped share of the contact, zero without contact.

    Parameters
    ----------
    slip
        Tangential gap over the law's length, (n,).
    size
        Size of the normal traction over the strength, (n,).
    """
    contact = size > INTERACTING[CRITERION]
    if not contact.any():
        return {"rms_slip": 0.0, "slipped_share": 0.0}
    rms = np.sqrt(np.average(slip[contact] ** 2, weights=size[contact]))
    return {"rms_slip": float(rms), "slipped_share": float(np.mean(slip[contact] > SLIPPED))}


def gradients(square: Array, problem: CohesiveProblem, gap: Array, traction: Array) -> dict[str, float]:
    """Return the rms gradient of the undeformed surface over the contact, by all criteria, and over all of it.

    Parameters
    ----------
    square : array, shape (n,)
        Local mean squares of the slopes at all points, of `contactsim.surfaces.statistics.local_squares`.
    problem, gap, traction
        As in `state_observables`.

    Returns
    -------
    dict
        NaN without contact.
    """
    size = np.abs(traction[0]) / problem.strength
    squares = {"rms_gradient_repulsive": square[contact_gap(problem, gap, traction) < 0]}
    squares |= {name: square[size > INTERACTING[criterion]] for name, criterion in GRADIENTS.items()}
    numbers = {name: float(np.sqrt(values.mean())) if values.size else np.nan for name, values in squares.items()}
    return numbers | {"rms_gradient": float(np.sqrt(square.mean()))}


def histograms(problem: CohesiveProblem, gap: Array, traction: Array) -> dict[str, Array]:
    """Return the share of the points by normal gap, bins of `OPENINGS`, and by normal traction, bins of `PULLS`."""
    kinds = {
        "normal_gap_share": (gap[0] / problem.interaction_range, OPENINGS),
        "normal_traction_share": (traction[0] / problem.strength, PULLS),
    }
    return {
        name: np.histogram(np.clip(values, edges[0], edges[-1]), edges)[0] / values.size
        for name, (values, edges) in kinds.items()
    }
