"""Loops over a surface in single precision, compiled: steps of conjugate gradients, and how all such loops run.

Every kernel works on the rows from `low` to `high` of arrays of shape (ny, nx or more), periodic in both directions. It
writes its results into `sums`: first numbers that add up, then largest values. `Rows` calls it block by block, on
several threads if asked to. The blocks depend on the grid alone and their sums are added in order, so that results of
kernels do not depend on the number of threads; those of transforms between them differ in their last digits.

contact is 1 where a point may carry pressure; the residual there is level - gap. It is padded with zeros to WORD
columns a word, and `words` is the same memory as whole words. Loops go over runs of words that are not zero. They have
no branch at single points, which would be expensive at edges of the contact, so that several points are computed at a
time: a point without contact has neither pressure nor change nor direction. For the same reason largest values are
collected column by column, and a loop writes one array or two: with more, compilers do not check for overlap and do not
vectorise.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numba
import numpy as np

from contactsim.grid import Array
from contactsim.threads import share_work

BLOCK = 128
"""Rows of a block."""
WORD = 8
"""Points whose contact is read at a time."""
SUMS, MAXIMA = 4, 2
"""Numbers of a kernel's results: sums over all points, then largest values."""

compiled = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "arcp", "nsz", "reassoc"})


class Contact(NamedTuple):
    """A contact set as bytes (ny, nx and padding), and as the words (ny, …) that share their memory."""

    points: Array
    words: Array


def contact_of(where: Array) -> Contact:
    """Return a contact set, bool (ny, nx), in the form that kernels read."""
    ny, nx = where.shape
    words = np.zeros((ny, -(-nx // WORD)), np.uint64)
    contact = words.view(np.uint8)
    contact[:, :nx] = where
    return Contact(contact, words)


class Rows:
    """Calls of kernels over all rows of a grid (ny, nx)."""

    def __init__(self, shape: tuple[int, ...], threads: int) -> None:
        self.width = shape[1]
        self.bounds = [(low, min(low + BLOCK, shape[0])) for low in range(0, shape[0], BLOCK)]
        self._threads = threads

    def __call__(self, kernel: Callable[..., None], *arguments: object) -> Array:
        """Return the sums over all rows, then the largest values, shape (SUMS + MAXIMA,)."""
        sums = np.zeros((len(self.bounds), SUMS + MAXIMA))

        def block(place: int) -> None:
            """Run the kernel over one block of rows."""
            kernel(*self.bounds[place], self.width, *arguments, sums[place])

        share_work(block, len(self.bounds), self._threads)
        return np.concatenate((sums[:, :SUMS].sum(axis=0), sums[:, SUMS:].max(axis=0)))


@compiled
def run(words, row, word):
    """Return the first word, and the one after the last, of the next run that is not zero; both are the end if none."""
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

    sums: load of p + change, number of points that carry it, change·r; then the largest part of a pressure removed.
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
    """Sum change·spread, and spread, over the contact."""
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
    """P += theta × change, gap += theta × spread; remove points that carry nothing, add points that overlap.

    level: gap on the contact after the step; overlap: distance below it at which a point is added. sums: gap on the new
    contact, its points, points added, direction on the new contact; then the largest overlap, and the largest gap under
    pressure.
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


class Trial(NamedTuple):
    """A trial step: its load, points that carry it, change·residual, and the largest part of a pressure removed."""

    load: float
    points: float
    product: float
    removed: float


class Rise(NamedTuple):
    """A change of the gap: its product with that of the pressure, and its sum over the contact."""

    product: float
    gap: float


class Advance(NamedTuple):
    """A step taken: sum of the gap, points, points added and sum of the direction, on the new contact; two largest.

    overlap, opening: largest overlap, and largest gap where there is pressure.
    """

    gap: float
    points: float
    added: float
    direction: float
    overlap: float
    opening: float


def try_step(
    rows: Rows,
    *,
    contact: Contact,
    pressure: Array,
    direction: Array,
    length: float,
    shift: float,
    gap: Array,
    level: np.float32,
    change: Array,
    fresh: np.float32,
    beta: np.float32,
) -> Trial:
    """Turn the direction and write the change of the pressure along it; see `trial`."""
    load, points, product, _, removed, _ = rows(
        trial, *contact, pressure, direction, length, shift, gap, level, change, fresh, beta
    )
    return Trial(load, points, product, removed)


def work_of(rows: Rows, *, contact: Contact, change: Array, spread: Array) -> Rise:
    """Return the work of a change of the pressure along that of the gap; see `work`."""
    return Rise(*rows(work, *contact, change, spread)[:2])


def advance_step(
    rows: Rows,
    *,
    contact: Contact,
    pressure: Array,
    change: Array,
    gap: Array,
    spread: Array,
    theta: np.float32,
    level: np.float32,
    overlap: np.float32,
    direction: Array,
) -> Advance:
    """Take a step and update the contact; see `advance`."""
    return Advance(*rows(advance, *contact, pressure, change, gap, spread, theta, level, overlap, direction))
