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

MAX_SPLITS = 100
"""Largest number of splits of an ensemble into halves."""
FEW_SPLITS = 12
"""The same for quantities that are computed from the members of each half one by one, which takes long."""


def half_splits(members: int, remainder: Array | None = None, most: int = MAX_SPLITS) -> list[tuple[Array, Array]]:
    """Return splits of an ensemble into two halves: the places of both among the members that are left.

    Parameters
    ----------
    members
        Number of members.
    remainder
        Members that are left of them, in ascending order; None for all.
    most
        Largest number of splits.

    Returns
    -------
    All splits if there are at most that many, else as many at random, always the same. If some members are not left,
    the halves are the same without them, so a number does not change because other halves are drawn. One member is not
    split: it is both halves.
    """
    remainder = np.arange(members) if remainder is None else remainder
    places = np.arange(len(remainder))
    if len(remainder) == 1:
        return [(places, places)]
    if math.comb(members, members // 2) <= most:
        first_halves = [np.array(half) for half in itertools.combinations(places, len(remainder) // 2)]
    else:
        random = np.random.default_rng(members)
        halves = [random.permutation(members)[: members // 2] for _ in range(most)]
        first_halves = [np.flatnonzero(np.isin(remainder, half)) for half in halves]
    return [(first, np.setdiff1d(places, first)) for first in first_halves]


def joint_splits(
    ensembles: Sequence[tuple[int, Array]], most: int = MAX_SPLITS
) -> Iterator[tuple[list[Array], list[Array]]]:
    """Yield splits of independent ensembles at once: the first halves of all, and the second ones.

    Callers use each half in both roles: to search in, and to measure.

    Parameters
    ----------
    ensembles
        Of each ensemble the number of members, and those that are left.
    most
        Largest number of splits.
    """
    splits = [half_splits(members, remainder, most) for members, remainder in ensembles]
    for number in range(max(map(len, splits))):
        first, second = zip(*(own[number % len(own)] for own in splits), strict=True)
        yield list(first), list(second)
