"""Loops over a surface in single precision, compiled: steps of conjugate gradients, and how all such loops run.

Every kernel works on the rows from `low` to `high` of arrays of shape (ny, nx or more), periodic in both directions,
and writes its results into `sums`, first what adds up, then largest values. `Rows` calls it block by block, on several
threads if asked to; the blocks depend on the grid alone and their sums are added in order, so that what kernels give
does not depend on the number of threads. Transforms of surfaces, between them, differ in their last digits.

contact is 1 where a point may carry pressure; the residual there is level - gap. It is padded with zeros to WORD
columns a word, and `words` is the same memory as whole words. Loops go over runs of words that are not zero, without
a branch at single points, which edges of the contact would make expensive, so that they are done several at a time: a
point without contact has neither pressure nor change nor direction. Largest values are therefore kept column by column,
and a loop writes one array or two: for more, compilers do not look into whether they overlap, and do without.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numba
import numpy as np

from contactsim.grid import Array

BLOCK = 128
"""Rows of a block."""
WORD = 8
"""Points whose contact is looked at in one go."""
SUMS, MOST = 4, 2
"""Numbers of a kernel's results: sums over all points, then largest values."""

compiled = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "arcp", "nsz", "reassoc"})


def contact_of(where: Array) -> tuple[Array, Array]:
    """A contact set, bool (ny, nx), as bytes (ny, nx and padding) and as the words (ny, …) that share their memory."""
    ny, nx = where.shape
    words = np.zeros((ny, -(-nx // WORD)), np.uint64)
    contact = words.view(np.uint8)
    contact[:, :nx] = where
    return contact, words


class Rows:
    """Calls kernels over all rows."""

    def __init__(self, shape: tuple[int, int], threads: int) -> None:
        self.width = shape[1]
        self.bounds = [(low, min(low + BLOCK, shape[0])) for low in range(0, shape[0], BLOCK)]
        self._pool = ThreadPoolExecutor(threads) if threads > 1 and len(self.bounds) > 1 else None

    def __call__(self, kernel: Callable, *arguments: object) -> Array:
        """Sums over all rows, then largest values, shape (SUMS + MOST,)."""
        sums = np.zeros((len(self.bounds), SUMS + MOST))

        def block(place: int) -> None:
            """One block of rows, and its sums."""
            kernel(*self.bounds[place], self.width, *arguments, sums[place])

        list((self._pool.map if self._pool else map)(block, range(len(self.bounds))))
        return np.concatenate((sums[:, :SUMS].sum(axis=0), sums[:, SUMS:].max(axis=0)))


@compiled
def run(words, row, word):
    """The next run of words that are not zero: the first and the one after its last, both their number if none."""
    count = words.shape[1]
    while word < count and words[row, word] == 0:
        word += 1
    first = word
    while word < count and words[row, word] != 0:
        word += 1
    return first, word


@compiled
def trial(low, high, nx, contact, words, pressure, direction, length, shift, gap, level, change, fresh, beta, sums):
    """`direction` = fresh × change + beta × direction; change = max(p + length × direction - shift, 0) - p.

    sums: load of p + change, the number of points that carry it, change·r; largest part of a pressure taken away.
    """
    load = 0.0
    count = 0
    along = 0.0
    taken = np.zeros(nx)
    for i in range(low, high):
        first, last = run(words, i, 0)
        while first < last:
            begin, end = WORD * first, min(WORD * last, nx)
            touches, old, turned = contact[i, begin:end], pressure[i, begin:end], direction[i, begin:end]
            moved, opening, most = change[i, begin:end], gap[i, begin:end], taken[begin:end]
            for j in range(end - begin):
                turned[j] = fresh * moved[j] + beta * turned[j]
                value = old[j] + length * turned[j] - shift
                value = value if (value > 0) & (touches[j] != 0) else 0.0
                load += value
                count += value > 0
                moved[j] = value - old[j]
                along += moved[j] * (level - opening[j])
            for j in range(end - begin):
                part = -moved[j] / old[j] if old[j] > 0 else 0.0
                most[j] = part if part > most[j] else most[j]
            first, last = run(words, i, last)
    sums[0] = load
    sums[1] = count
    sums[2] = along
    sums[4] = min(taken.max(), 1.0)  # a change that takes away everything is rounded


@compiled
def work(low, high, nx, contact, words, change, spread, sums):
    """sums: change·spread, and spread, on the contact."""
    product = 0.0
    total = 0.0
    for i in range(low, high):
        first, last = run(words, i, 0)
        while first < last:
            begin, end = WORD * first, min(WORD * last, nx)
            touches, moved, risen = contact[i, begin:end], change[i, begin:end], spread[i, begin:end]
            for j in range(end - begin):
                product += moved[j] * risen[j]
                total += risen[j] if touches[j] != 0 else np.float32(0)
            first, last = run(words, i, last)
    sums[0] = product
    sums[1] = total


@compiled
def advance(low, high, nx, contact, words, pressure, change, gap, spread, theta, level, overlap, direction, sums):
    """Step: p += theta × change, gap += theta × spread; drop points that carry nothing, add those that overlap.

    level: the gap on the contact after the step; overlap: how far below it a point is added. sums: gap on the new
    contact, its points, points added, direction on the new contact; largest overlap, largest gap where pressure is.
    """
    total = 0.0
    count = 0
    added = 0
    along = 0.0
    none = np.float32(0)
    limit = level - overlap
    deepest = np.zeros(nx, np.float32)
    widest = np.zeros(nx, np.float32)
    for i in range(low, high):
        last = 0
        while last < words.shape[1]:
            begin = WORD * last
            first, last = run(words, i, last)
            end = min(WORD * first, nx)
            touches, opening, risen = contact[i, begin:end], gap[i, begin:end], spread[i, begin:end]
            below = 0
            for j in range(end - begin):
                opening[j] += theta * risen[j]
                below += opening[j] < limit
            for j in range(end - begin if below else 0):
                if opening[j] < limit:
                    touches[j] = 1
                    total += opening[j]
                    deepest[begin + j] = max(deepest[begin + j], level - opening[j])
            count += below
            added += below

            begin, end = end, min(WORD * last, nx)
            touches, opening, risen = contact[i, begin:end], gap[i, begin:end], spread[i, begin:end]
            old, moved, turned = pressure[i, begin:end], change[i, begin:end], direction[i, begin:end]
            deep, wide = deepest[begin:end], widest[begin:end]
            for j in range(end - begin):
                opening[j] += theta * risen[j]
            for j in range(end - begin):
                carries = old[j] + theta * moved[j]
                old[j] = 0.0 if carries < 1e-6 * old[j] else carries  # cut to zero, but for the rounding of the change
            for j in range(end - begin):
                before = touches[j] != 0
                joins = (not before) & (opening[j] < limit)
                inside = joins | (before & ((old[j] != 0) | (opening[j] <= level)))
                touches[j] = inside
                total += opening[j] if inside else none
                count += inside
                added += joins
            for j in range(end - begin):
                turned[j] = turned[j] if touches[j] != 0 else none
                moved[j] = moved[j] if touches[j] != 0 else none
                along += turned[j]
            for j in range(end - begin):
                over = level - opening[j] if touches[j] != 0 else none
                deep[j] = over if over > deep[j] else deep[j]
                apart = opening[j] - level if old[j] > 0 else none
                wide[j] = apart if apart > wide[j] else wide[j]
    sums[0] = total
    sums[1] = count
    sums[2] = added
    sums[3] = along
    sums[4] = deepest.max()
    sums[5] = widest.max()
