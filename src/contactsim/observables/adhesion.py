"""Numbers of a state of cohesive laws, and of a path through such states.

Loads on lines are forces per unit thickness (N/m), compression positive (Eq. 4.2). Contact is `repulsive` where the
normal gap is negative, to a fraction of a node, or `interacting` where the traction exceeds a part of the laws'
strength. A path is cut into loading and unloading where the approach turns first, and second.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.load_curve import CURVES, LoadCurve, curve_inputs, dimensions_of
from contactsim.status import is_solved

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
FINAL = {
    "final_contact_length": "contact_length",
    "final_interacting_length": CRITERION,
    "final_load": "line_load",
    "final_repulsive_load": "repulsive_load",
    "final_adhesive_load": "adhesive_load",
    "final_max_pressure": "max_pressure",
    "final_max_tensile_traction": "max_tensile_traction",
    "final_slip": "slip",
}
"""Numbers at the largest approach on a line, by the number of a state that they are."""
SURFACE_FINAL = {
    "final_contact_area": "contact_area",
    "final_interacting_area": "interacting_area_0_01",
    "final_force": "normal_force",
    "final_repulsive_force": "repulsive_force",
    "final_adhesive_force": "adhesive_force",
    "final_max_pressure": "max_pressure",
    "final_max_tensile_traction": "max_tensile_traction",
}
"""The same on a surface."""
FINALS = {1: FINAL, 2: SURFACE_FINAL}
"""By the number of dimensions."""
SLIPPED = 0.3
"""Slip over the laws' length from which a node counts as slipped: the tangential factor of Eq. 5.2 is 0.91 there."""
TURN_TOLERANCE = 1e-6
"""Changes of approach (nm) that do not turn a path."""
LEGS = ("loading", "unloading")
JUMPS = ("max_jump_loading", "max_jump_unloading")
"""Largest jumps of a path."""


def pull_off_names(word: str) -> tuple[str, ...]:
    """Return the names of the largest pulls and of their approaches; word: what the load is called there."""
    return tuple(f"pull_off_{quantity}_{leg}" for quantity in (word, "approach") for leg in LEGS)


SUMMARIES = {
    dimensions: (*pull_off_names(names.word), *JUMPS, *FINALS[dimensions]) for dimensions, names in CURVES.items()
}
"""Summary of a path by the number of dimensions; the slip only where a law reads the tangential gap."""
SUMMARY, SURFACE_SUMMARY = SUMMARIES.values()
"""On a line, and on a surface."""


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
    repulsive = gap[0] < 0
    mean, pull = -float(traction[0].mean()), float(np.maximum(traction[0], 0.0).mean())
    smallest, pushed, pulled = float(gap[0].min()), -float(traction[0].min()), float(traction[0].max())
    numbers = {
        "line_load": mean * length,
        "repulsive_load": (mean + pull) * length,
        "adhesive_load": pull * length,
        "mean_pressure": mean,
        "mean_gap": float(gap[0].mean()),
        "contact_length": contact_length(gap[0], spacing),
        "min_gap": smallest,
        "max_pressure": max(pushed, 0.0),
        "max_tensile_traction": max(pulled, 0.0),
        "max_interpenetration": max(-smallest, 0.0) / problem.interaction_range,
    }
    numbers |= {name: float(spacing * np.count_nonzero(size > level)) for name, level in INTERACTING.items()}
    if len(gap) > 1:
        slip = np.abs(problem.offset(gap)) / problem.law.tangential_length
        numbers["slip"] = float(slip.max(where=repulsive, initial=0.0))
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
    squares = {"rms_gradient_repulsive": square[gap[0] < 0]}
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


def pull_off(curve: LoadCurve, word: str = "load") -> dict[str, float]:
    """Return the largest pull and its approach (nm) on loading and on unloading, with their errors.

    Both sides of a jump count as states. A leg that begins or ends with its largest pull does not pass it. A leg that
    ends without a solution passes it, as under a load that pulls the bodies apart. The increments leave an
    `_increment_error`, of `LoadCurve.extreme_errors`.

    Parameters
    ----------
    curve
        Load against approach.
    word
        What the load is called in the names of the numbers.

    Returns
    -------
    dict
        NaN where a leg does not pass its largest pull.
    """
    numbers = {}
    for name, leg in zip(LEGS, legs(curve.approach), strict=True):
        part = curve.part(slice(max(leg.start - 1, 0), leg.stop))  # from the turn on
        pull = -part.load
        best = 0 if np.isnan(pull).all() else int(np.nanargmax(pull))
        is_passed = 0 < best < pull.size - 1 and pull[best] > 0
        values = float(pull[best]), float(part.approach[best])
        errors = part.extreme_errors(best) if is_passed else (np.nan, np.nan)
        for quantity, value, error in zip((word, "approach"), values, errors, strict=True):
            numbers[f"pull_off_{quantity}_{name}"] = value if is_passed else np.nan
            numbers[f"pull_off_{quantity}_{name}_increment_error"] = error
    return numbers


def legs(approach: Array) -> tuple[slice, slice]:
    """Return the steps of loading, while the approach (step,) grows, and of unloading, until it grows again."""
    changes = np.diff(approach)
    back = np.flatnonzero(changes < -TURN_TOLERANCE)
    turn = int(back[0]) + 1 if back.size else approach.size
    again = np.flatnonzero(changes[turn:] > TURN_TOLERANCE)
    return slice(0, turn), slice(turn, turn + int(again[0]) + 1 if again.size else approach.size)


def largest_jumps(approach: Array, jump: Array) -> dict[str, float]:
    """Return the largest jump (nm) on loading and on unloading; zero without a jump, NaN without such a leg."""
    parts = zip(LEGS, (jump[part] for part in legs(approach)), strict=True)
    return {f"max_jump_{name}": float(np.nanmax(part)) if np.isfinite(part).any() else np.nan for name, part in parts}


def summarise_load_curves(data: xr.Dataset) -> xr.Dataset:
    """Return a study of paths with their summaries (`SUMMARIES`); states that did not converge do not count."""
    dimensions = dimensions_of(data)
    word = CURVES[dimensions].word
    pulls = pull_off_names(word)
    names = (*pulls, *JUMPS, *(f"{name}_increment_error" for name in pulls))

    def per_path(approach: Array, load: Array, jump: Array, *folds: Array) -> tuple[float, ...]:
        """Return the summary of one path, in the order of `names`."""
        curve = LoadCurve.from_states(approach, load, jump, folds)
        numbers = pull_off(curve, word) | largest_jumps(approach, np.where(np.isnan(load), np.nan, jump))
        return tuple(numbers[name] for name in names)

    inputs, core = curve_inputs(data)
    converged = is_solved(data.status)
    columns = xr.apply_ufunc(
        per_path,
        *inputs,
        input_core_dims=core,
        output_core_dims=[[]] * len(names),
        vectorize=True,
    )
    last = data.approach.argmax("step")
    final = {name: data[of].where(converged).isel(step=last) for name, of in FINALS[dimensions].items() if of in data}
    return data.assign(dict(zip(names, columns, strict=True)) | final)
