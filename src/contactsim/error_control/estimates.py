"""The error of the finest of some solutions, from what finer and finer grids change.

A change between two runs tells an error of the finer one: errors are taken to fall with a power `ORDER` of the spacing.
It tells one of all runs that are finer still. Any two runs may agree by chance, so one change tells nothing; of two or
three the root of the sum of squares is taken, times a factor for how many they are: fewer say less. The factors are
those by which estimates cover 99 of 100 true errors, one by one, of a wide population of scenes, with a margin
(`contactsim.evaluation.calibration`). No other number is fitted.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from contactsim.contact.problem_kind import ProblemKind
from contactsim.grid import Array

ORDER = 1.5
"""Power of the spacing with which errors are taken to fall. Most fall with 0.8 to 2; those of contacts of a few points
scatter, and an observed order tells more of their scatter than of them."""
FACTORS = {2: 5.0, 3: 2.2}
"""Coverage factors of two and of three changes."""
TOLERANCE_SHARES = {ProblemKind.HARD_WALL: 0.1, ProblemKind.COHESIVE: 1.0}
"""Least relative error that is told, over the tolerance: what the solver may leave."""


def tell_error(values: Sequence[Array], refinements: Sequence[float], least: float | Array = 0.0) -> Array:
    """Return the error of the last of some values of a quantity, in its unit.

    Parameters
    ----------
    values : sequence of array, each of shape (m,)
        The quantity in two or more runs, the coarsest first: NaN where a run lacks it, infinite where it was not
        solved.
    refinements : sequence of float
        How many times finer each run is than the one before it; one fewer.
    least : float or array, shape (m,)
        Error that is left even if all runs agree, as by the tolerance or by counting points.

    Returns
    -------
    array, shape (m,)
        Infinite where fewer than three runs, counted from the last, have the quantity and were solved; zero where the
        last three lack it.
    """
    changes, lacks = told_changes(values, refinements), np.isnan(values[-1])
    if len(changes) not in FACTORS:
        return np.full(np.shape(values[-1]), np.inf)
    error = np.fmax(FACTORS[len(changes)] * np.linalg.norm(changes, axis=0), least)
    return np.where(lacks & np.isfinite(error), 0.0, error)


def told_changes(values: Sequence[Array], refinements: Sequence[float]) -> list[Array]:
    """Return what the last changes of a quantity say of the error of its last value, the latest first.

    Changes count back to the first run that lacks the quantity or was not solved; parameters as in `tell_error`.
    """
    told, shrinks = list[Array](), 1.0
    steps = list(zip(itertools.pairwise(values), refinements, strict=True))[-max(FACTORS) :]
    for (coarse, fine), ratio in reversed(steps):
        with np.errstate(invalid="ignore"):
            change = np.abs(np.asarray(fine, float) - coarse)
        change = np.where(np.isnan(fine) & np.isnan(coarse), 0.0, change)
        change = np.where(np.isnan(change), np.inf, change)
        if told and not np.isfinite(change).all():
            break
        told.append(change / (ratio**ORDER - 1) / shrinks)
        shrinks *= ratio**ORDER
    return told
