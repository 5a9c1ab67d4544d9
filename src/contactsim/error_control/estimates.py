"""Estimate the error of a run from a coarser one and from what relations and its own states tell."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contactsim.error_control.knobs import EXPECTED, GRID, grid_features
from contactsim.error_control.options import expect_error
from contactsim.error_control.relations import Family
from contactsim.error_control.solution import Solution, relative_difference
from contactsim.grid import Array

DIFFERENCE_WEIGHT = 0.7
"""Part of a difference that counts: the coarser run is often too coarse to be of any order, and makes it large."""
SLIDE_ORDER = 1.5
"""Largest power of the spacing with which errors of a slide are taken to fall. On few points for a contact or a process
zone they fall by no fixed power."""
MIN_EDGE_SHARE = 1e-9
"""Least part of a contact that counts as its edge."""


def estimate_errors(
    fine: Solution, coarser: Sequence[Solution], family: Family, names: Sequence[str]
) -> dict[str, Array]:
    """Return relative errors of a run by quantity.

    The larger counts of what its knobs are expected to leave and its difference from the last coarser run, which
    shrinks as the relations say that errors do between the two. What the states of a slide tell of its increments comes
    on top, and all coarser runs that have the quantity count: any two slides may agree by chance.
    """
    errors = {}
    for name in names:
        expected, increment_error = expected_errors(fine, family, name), fine.increment_errors.get(name)
        if increment_error is None:
            expected_before = expected_errors(coarser[-1], family, name)
            part = DIFFERENCE_WEIGHT * expected / np.maximum(expected_before - expected, expected)
            errors[name] = np.maximum(part * relative_difference(fine, coarser[-1], name), expected)
        else:
            with_quantity = [run for run in coarser if np.isfinite(run.values[name]).all()] or coarser
            changes = [relative_difference(fine, run, name) * _slide_part(fine, run) for run in with_quantity]
            errors[name] = np.maximum(np.max(changes, axis=0), expected) + increment_error
    return errors


def _slide_part(fine: Solution, coarse: Solution) -> float:
    """Return the part of the difference of two slides that the finer grid leaves; 1 for the same grid."""
    shrinkage = (fine.points / coarse.points) ** SLIDE_ORDER
    return 1 / (shrinkage - 1) if shrinkage > 1 else 1.0


def expected_errors(run: Solution, family: Family, name: str) -> Array:
    """Return the relative error that the grid leaves, and the increments where no state tells it.

    Where the contacts of a solution have been seen, it is the geometric mean of what is known of such scenes and of
    what follows from how well the contacts are resolved.
    """
    if name in family.resolved:
        places = grid_features(run.setup.scene, run.points)
        seen = [
            numbers | {"resolved": math.log(max(share, MIN_EDGE_SHARE))}
            for numbers, share in zip(places, run.resolved, strict=True)
        ]
        return np.array(
            [math.sqrt(family.resolved[name](numbers) * family.errors["points"][name](numbers)) for numbers in seen]
        )
    knobs = GRID if name in run.increment_errors else EXPECTED
    return np.array([expect_error(run.setup, family, name, knobs)])


def describe_errors(errors: dict[str, Array], wanted: float) -> str:
    """Return the estimated errors in words."""
    return ", ".join(f"{name} to {values.max():.2g} of {wanted:g}" for name, values in errors.items())
