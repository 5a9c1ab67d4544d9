"""The error of the finest of some solutions, from what finer and finer grids change.

Errors are taken to fall with a power of the spacing. A change between two runs then tells an error of the finer one,
and of all runs that are finer still. The last two changes tell the power, within `ORDERS`; changes that hardly fall
have the lowest. Any two runs may agree by chance, so one change tells nothing. Of two or three the largest counts of
what they say of the final run, times a factor for how many there are: fewer say less. The factors are those by which
estimates cover 985 of 1000 true errors, one by one, of a wide population of scenes, with a margin
(`contactsim.evaluation.calibration`). No other number enters a statement of error.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from contactsim.grid import Array

ORDERS = np.linspace(0.5, 1.5, 21)
"""Powers of the spacing with which errors are taken to fall, from that of pressures at sharp edges to one below two, as
contacts of a few points are no smooth sums."""
FACTORS = {2: 3.1, 3: 1.3}
"""Coverage factors of two and of three changes: any two runs may agree by chance, so one change tells nothing."""


def tell_error(values: Sequence[Array], refinements: Sequence[float]) -> Array:
    """Return the error of the last of some values of a quantity, in its unit.

    Parameters
    ----------
    values : sequence of array, each of shape (m,)
        The quantity in two or more runs, the coarsest first: NaN where a run lacks it, infinite where it was not
        solved.
    refinements : sequence of float
        How many times finer each run is than the one before it; one fewer.

    Returns
    -------
    array, shape (m,)
        Infinite where fewer than three runs, counted from the last, have the quantity and were solved.
    """
    changes = told_changes(values, refinements)
    if len(changes) not in FACTORS:
        return np.full(np.shape(values[-1]), np.inf)
    return FACTORS[len(changes)] * np.max(changes, axis=0)


def told_changes(values: Sequence[Array], refinements: Sequence[float]) -> list[Array]:
    """Return what the last changes of a quantity say of the error of its last value, the latest first.

    Changes count back to the first run that lacks the quantity or was not solved; parameters as in `tell_error`.
    """
    changes, pairs = list[Array](), list(itertools.pairwise(values))[-max(FACTORS) :]
    for coarse, fine in reversed(pairs):
        with np.errstate(invalid="ignore"):
            change = np.abs(np.asarray(fine, float) - coarse)
        change = np.where(np.isnan(fine) & np.isnan(coarse), 0.0, change)
        change = np.where(np.isnan(change), np.inf, change)
        if changes and not np.isfinite(change).all():
            break
        changes.append(change)
    ratios = list(refinements)[: -len(changes) - 1 : -1]
    highest, finer = ORDERS[-1], 1.0
    told = [changes[0] / (ratios[0] ** _observed_order(changes, ratios, np.abs(values[-1])) - 1)]
    for change, ratio in zip(changes, ratios, strict=True):
        told.append(change / (ratio**highest - 1) / finer)
        finer *= ratio**highest
    return [np.maximum(told[0], told[1]), *told[2:]]


def _observed_order(changes: Sequence[Array], ratios: Sequence[float], sizes: Array) -> float:
    """Return the order that the last two changes tell, of all loads together; the highest where there is one alone."""
    if len(changes) == 1 or not np.isfinite(changes[0]).all():
        return float(ORDERS[-1])
    last, before = (np.sum(np.divide(change, sizes, out=change.copy(), where=sizes > 0)) for change in changes[:2])
    falls = ratios[0] ** ORDERS * (ratios[1] ** ORDERS - 1) / (ratios[0] ** ORDERS - 1)
    return float(np.interp(before / last, falls, ORDERS)) if last > 0 else float(ORDERS[-1])
