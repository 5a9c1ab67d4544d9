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
LEAST_PART = 0.25
"""Least part of a difference from a companion that the grid of a slide is taken to leave. On few points for a contact
or a process zone its error falls by no fixed power of the spacing."""
MIN_EDGE_SHARE = 1e-9
"""Least part of a contact that counts as its edge."""


def estimate_errors(fine: Solution, coarse: Solution, family: Family, names: Sequence[str]) -> dict[str, Array]:
    """Return relative errors of a run by quantity.

    The larger counts of what its knobs are expected to leave and its difference from a coarser run, which shrinks as
    the relations say that errors do between the two. What the states of a run tell of its increments comes on top.
    """
    errors = {}
    for name in names:
        expected, expected_before = expected_errors(fine, family, name), expected_errors(coarse, family, name)
        part = DIFFERENCE_WEIGHT * expected / np.maximum(expected_before - expected, expected)
        if name in fine.increment_errors:
            part = np.maximum(part, LEAST_PART)
        changes = part * relative_difference(fine, coarse, name)
        errors[name] = np.maximum(changes, expected) + fine.increment_errors.get(name, 0.0)
    return errors


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
