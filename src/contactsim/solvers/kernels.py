"""Loops over a surface in single precision, compiled: what conjugate gradients does between two transforms.

Every kernel works on the rows from `low` to `high` of arrays of shape (ny, nx or more), periodic in both directions,
and writes its results into `sums`, first what adds up, then largest values. `Rows` calls it block by block, on several
threads if asked to; the blocks depend on the grid alone and their sums are added in order, so that the result does not
depend on the number of threads.

contact is 1 where a point may carry pressure; the residual there is level - gap. It is padded with zeros to WORD
columns a word, and `words` is the same memory as whole words: those that are zero are passed over. What is read and
written is that of points in contact alone, but for `advance`, which looks at all. The factor G of the preconditioner
has four neighbours that come before a point: west, north-west, north, north-east; `code` holds which of them are in
contact, as bits, and row `code` of `table` (16, 5) the weights of the point itself and of these four.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numba
import numpy as np

from contactsim.grid import Array

BLOCK = 128
"""Rows of a block: a multiple of CELL."""
CELL = 4
"""Points along a side of a cell on which long waves are corrected."""
WORD = 8
"""Points whose contact is looked at in one go."""
SUMS, MOST = 4, 2
"""Numbers of a kernel's results: sums over all points, then largest values."""

compiled = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "arcp", "nsz"})


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
            kernel(*self.bounds[place], self.width, *arguments, sums[place])

        list((self._pool.map if self._pool else map)(block, range(len(self.bounds))))
        return np.concatenate((sums[:, :SUMS].sum(axis=0), sums[:, SUMS:].max(axis=0)))


@compiled
def factor(low, high, nx, gap, level, contact, words, table, code, out, cells, sums):
    """`out` = G r; cells: sums of out over each cell; code: which neighbours are in contact."""
    ny = contact.shape[0]
    for i in range(low, high):
        up = i - 1 if i > 0 else ny - 1
        for word in range(words.shape[1]):
            if words[i, word] == 0:
                continue
            for j in range(WORD * word, min(WORD * word + WORD, nx)):
                if not contact[i, j]:
                    continue
                west = j - 1 if j > 0 else nx - 1
                east = j + 1 if j < nx - 1 else 0
                bits = contact[i, west] | contact[up, west] << 1 | contact[up, j] << 2 | contact[up, east] << 3
                code[i, j] = bits
                value = table[bits, 0] * (level - gap[i, j])
                if bits & 1:
                    value += table[bits, 1] * (level - gap[i, west])
                if bits & 2:
                    value += table[bits, 2] * (level - gap[up, west])
                if bits & 4:
                    value += table[bits, 3] * (level - gap[up, j])
                if bits & 8:
                    value += table[bits, 4] * (level - gap[up, east])
                out[i, j] = value
                cells[i // CELL, j // CELL] += value


@compiled
def adjoint(low, high, nx, gap, level, spread, theta, before, contact, words, table, code, field, smooth, out, sums):
    """`out` = Gᵀ(field - smooth); sums: out·r, out·(r before the last step), out."""
    ny = contact.shape[0]
    now = 0.0
    then = 0.0
    total = 0.0
    for i in range(low, high):
        down = i + 1 if i < ny - 1 else 0
        here = i // CELL
        below = down // CELL
        for word in range(words.shape[1]):
            if words[i, word] == 0:
                continue
            for j in range(WORD * word, min(WORD * word + WORD, nx)):
                if not contact[i, j]:
                    continue
                west = j - 1 if j > 0 else nx - 1
                east = j + 1 if j < nx - 1 else 0
                value = table[code[i, j], 0] * (field[i, j] - smooth[here, j // CELL])
                if contact[i, east]:
                    value += table[code[i, east], 1] * (field[i, east] - smooth[here, east // CELL])
                if contact[down, east]:
                    value += table[code[down, east], 2] * (field[down, east] - smooth[below, east // CELL])
                if contact[down, j]:
                    value += table[code[down, j], 3] * (field[down, j] - smooth[below, j // CELL])
                if contact[down, west]:
                    value += table[code[down, west], 4] * (field[down, west] - smooth[below, west // CELL])
                out[i, j] = value
                now += value * (level - gap[i, j])
                then += value * (before - (gap[i, j] - theta * spread[i, j]))
                total += value
    sums[0] = now
    sums[1] = then
    sums[2] = total


@compiled
def turn(low, high, nx, contact, words, corrected, beta, direction, pressure, length, shift, sums):
    """`direction` = corrected + beta × direction; sums: load of max(p + length × direction - shift, 0), its points."""
    load = 0.0
    count = 0
    for i in range(low, high):
        for word in range(words.shape[1]):
            if words[i, word] == 0:
                continue
            for j in range(WORD * word, min(WORD * word + WORD, nx)):
                if contact[i, j]:
                    direction[i, j] = corrected[i, j] + beta * direction[i, j]
                    value = pressure[i, j] + length * direction[i, j] - shift
                    if value > 0:
                        load += value
                        count += 1
    sums[0] = load
    sums[1] = count


@compiled
def carried(low, high, nx, contact, words, pressure, direction, length, shift, sums):
    """sums: load of max(p + length × direction - shift, 0), and the number of points that carry it."""
    load = 0.0
    count = 0
    for i in range(low, high):
        for word in range(words.shape[1]):
            if words[i, word] == 0:
                continue
            for j in range(WORD * word, min(WORD * word + WORD, nx)):
                if contact[i, j]:
                    value = pressure[i, j] + length * direction[i, j] - shift
                    if value > 0:
                        load += value
                        count += 1
    sums[0] = load
    sums[1] = count


@compiled
def trial(low, high, nx, contact, words, pressure, direction, length, shift, gap, level, change, sums):
    """`change` = max(p + length × direction - shift, 0) - p; sums: change·r; largest part of a pressure taken away."""
    along = 0.0
    taken = 0.0
    for i in range(low, high):
        for word in range(words.shape[1]):
            if words[i, word] == 0:
                continue
            for j in range(WORD * word, min(WORD * word + WORD, nx)):
                if contact[i, j]:
                    value = pressure[i, j] + length * direction[i, j] - shift
                    value = max(value, 0.0)
                    change[i, j] = value - pressure[i, j]
                    if value < pressure[i, j] * (1 - taken):
                        taken = 1 - value / pressure[i, j]
                    along += change[i, j] * (level - gap[i, j])
    sums[0] = along
    sums[4] = taken


@compiled
def work(low, high, nx, contact, words, change, spread, sums):
    """sums: change·spread, and spread, on the contact."""
    product = 0.0
    total = 0.0
    for i in range(low, high):
        for word in range(words.shape[1]):
            if words[i, word] == 0:
                continue
            for j in range(WORD * word, min(WORD * word + WORD, nx)):
                if contact[i, j]:
                    product += change[i, j] * spread[i, j]
                    total += spread[i, j]
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
    deepest = 0.0
    widest = 0.0
    along = 0.0
    limit = level - overlap
    for i in range(low, high):
        for word in range(words.shape[1]):
            first = WORD * word
            last = min(first + WORD, nx)
            if words[i, word] == 0:
                near = False
                for j in range(first, last):
                    value = gap[i, j] + theta * spread[i, j]
                    gap[i, j] = value
                    near |= value < limit
                if not near:
                    continue
                for j in range(first, last):
                    if gap[i, j] < limit:
                        contact[i, j] = 1
                        added += 1
                        total += gap[i, j]
                        count += 1
                        deepest = max(deepest, level - gap[i, j])
                continue
            for j in range(first, last):
                value = gap[i, j] + theta * spread[i, j]
                gap[i, j] = value
                if contact[i, j]:
                    carries = pressure[i, j] + theta * change[i, j]
                    if carries < 1e-6 * pressure[i, j]:  # cut to zero, but for the rounding of the change
                        carries = 0.0
                    pressure[i, j] = carries
                    if carries == 0.0 and value > level:
                        contact[i, j] = 0
                        direction[i, j] = 0
                        change[i, j] = 0
                        continue
                    if carries > 0:
                        widest = max(widest, value - level)
                    along += direction[i, j]
                elif value < limit:
                    contact[i, j] = 1
                    added += 1
                else:
                    continue
                total += value
                count += 1
                deepest = max(deepest, level - value)
    sums[0] = total
    sums[1] = count
    sums[2] = added
    sums[3] = along
    sums[4] = deepest
    sums[5] = widest


@compiled
def between(before, left, right, after, part):
    """A signed field `part` of the way from left to right: cubic among one sign, else linear in the signed square."""
    if part == 0.0:
        return left
    if (before > 0) == (left > 0) == (right > 0) == (after > 0):
        a = -part * (part - 1) * (part - 2) / 6
        b = (part + 1) * (part - 1) * (part - 2) / 2
        c = -(part + 1) * part * (part - 2) / 2
        d = (part + 1) * part * (part - 1) / 6
        return a * before + b * left + c * right + d * after
    square = (1 - part) * left * abs(left) + part * right * abs(right)
    return np.sqrt(square) if square > 0 else -np.sqrt(-square)


@compiled
def along_x(signed, row, line):
    """One row of a signed field, periodic, on the points of a longer line."""
    mx, nx = signed.shape[1], line.size
    for j in range(nx):
        at = j * mx // nx
        west = at - 1 if at > 0 else mx - 1
        east = at + 1 if at < mx - 1 else 0
        far = east + 1 if east < mx - 1 else 0
        part = (j * mx - at * nx) / nx
        line[j] = between(signed[row, west], signed[row, at], signed[row, east], signed[row, far], part)


@compiled
def refine(low, high, nx, signed, out, sums):
    """A signed field (my, mx) on the points of a finer grid out (ny, nx), first along x, then along y; clipped at 0."""
    ny = out.shape[0]
    my = signed.shape[0]
    lines = np.empty((4, nx))
    held = np.full(4, -1)
    for i in range(low, high):
        first = i * my // ny
        for k in range(4):
            row = (first - 1 + k) % my
            slot = (first + 3 + k) % 4
            if held[slot] != row:
                along_x(signed, row, lines[slot])
                held[slot] = row
        before = (first + 3) % 4
        left = first % 4
        right = (first + 1) % 4
        after = (first + 2) % 4
        part = (i * my - first * ny) / ny
        for j in range(nx):
            out[i, j] = max(between(lines[before, j], lines[left, j], lines[right, j], lines[after, j], part), 0.0)
