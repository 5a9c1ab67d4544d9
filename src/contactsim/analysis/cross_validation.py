"""Measure extremes of noisy means without the bias that noise gives them.

The largest of several noisy means minus the smallest is positive even where nothing varies. Its mean is zero if the
places of the extremes come from one half of an ensemble and their values from the other.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

import numpy as np

from contactsim.grid import Array

MAX_SPLITS = 12
"""Largest number of splits of an ensemble into halves."""


def half_splits(members: int) -> list[tuple[Array, Array]]:
    """Return splits of an ensemble into two halves: the indices of both.

    Parameters
    ----------
    members
        Number of members.

    Returns
    -------
    All splits if there are at most `MAX_SPLITS`, else as many at random, always the same. One member is not split: it
    is both halves.
    """
    if members == 1:
        return [(np.zeros(1, int), np.zeros(1, int))]
    halves = members // 2
    if math.comb(members, halves) <= MAX_SPLITS:
        first_halves = [np.array(half) for half in itertools.combinations(range(members), halves)]
    else:
        random = np.random.default_rng(members)
        first_halves = [random.permutation(members)[:halves] for _ in range(MAX_SPLITS)]
    return [(first, np.setdiff1d(np.arange(members), first)) for first in first_halves]


def joint_splits(sizes: Sequence[int]) -> Iterator[tuple[list[Array], list[Array]]]:
    """Yield splits of independent ensembles at once: the first halves of all, and the second ones.

    Callers use each half in both roles: to search in, and to measure.

    Parameters
    ----------
    sizes
        Number of members of each ensemble.
    """
    splits = [half_splits(size) for size in sizes]
    for number in range(max(map(len, splits))):
        first, second = zip(*(own[number % len(own)] for own in splits), strict=True)
        yield list(first), list(second)
