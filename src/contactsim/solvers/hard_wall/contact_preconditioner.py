"""The preconditioner of conjugate gradients on the contact of a surface, Gᵀ(1 - B)G, without a transform of full size.

G is a factorised sparse approximate inverse of the compliance S on the contact: the row of a point solves S among it
and those of four preceding neighbours that are in contact, so there are 16 rows for all points (SIAM J. Matrix Anal.
Appl. 14, 45, doi:10.1137/0614004). It has short waves right and long ones too soft; B takes their excess away on cells
of 4 × 4 points, through transforms of that reduced size.

The neighbours are west, north-west, north and north-east; `code` holds which of them are in contact, as bits, and
column `code` of `table` (5, 16) the weights of the point itself and of these four, zero for those without contact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactsim.elasticity.fourier_operator import Compliance
from contactsim.grid import Array
from contactsim.solvers.hard_wall.kernels import WORD, Contact, Rows, compiled, run

CELL = 4
"""Points along a side of a cell on which long waves are corrected: a block of rows, and a word, are whole cells."""
NEIGHBOURS = ((0, -1), (-1, -1), (-1, 0), (-1, 1))
"""West, north-west, north and north-east: (row, column)."""


@compiled
def bits_of(west, north_west, north, north_east):
    """Return the neighbours in contact as the bits of one number."""
    return west | north_west << 1 | north << 2 | north_east << 3


@compiled
def weighted(table, bits, here, west, north_west, north, north_east):
    """Return a row of G times residuals."""
    near = table[0, bits] * here + table[1, bits] * west + table[2, bits] * north_west
    return near + table[3, bits] * north + table[4, bits] * north_east


@compiled
def factor_at(i, up, west, j, east, gap, level, contact, table, code, out):
    """Write G r and the code at a point, given the indices of its neighbours."""
    bits = bits_of(contact[i, west], contact[up, west], contact[up, j], contact[up, east])
    r, of_up = level - gap[i, j], level - gap[up, j]
    value = weighted(table, bits, r, level - gap[i, west], level - gap[up, west], of_up, level - gap[up, east])
    code[i, j] = bits
    out[i, j] = value if contact[i, j] else np.float32(0)


@compiled
def factor(low, high, nx, gap, level, contact, words, table, code, out, cells, sums):
    """Write out = G r, its sums over each cell, and the code of neighbours in contact."""
    ny = contact.shape[0]
    for i in range(low, high):
        up = i - 1 if i > 0 else ny - 1
        first, last = run(words, i, 0)
        while first < last:
            begin, end = WORD * first, min(WORD * last, nx)
            if begin == 0:
                factor_at(i, up, nx - 1, 0, 1, gap, level, contact, table, code, out)
            if end == nx:
                factor_at(i, up, nx - 2, nx - 1, 0, gap, level, contact, table, code, out)
            a, b = max(begin, 1), min(end, nx - 1)
            middle, left, above = gap[i, a:b], gap[i, a - 1 : b - 1], gap[up, a - 1 : b + 1]
            touches, on_left, on_top = contact[i, a:b], contact[i, a - 1 : b - 1], contact[up, a - 1 : b + 1]
            codes, result = code[i, a:b], out[i, a:b]
            for j in range(b - a):
                codes[j] = bits_of(on_left[j], on_top[j], on_top[j + 1], on_top[j + 2])
            for j in range(b - a):
                r, west = level - middle[j], level - left[j]
                value = weighted(table, codes[j], r, west, level - above[j], level - above[j + 1], level - above[j + 2])
                result[j] = value if touches[j] != 0 else np.float32(0)
            row = cells[i // CELL]
            for j in range(begin, end):
                row[j // CELL] += out[i, j]
            first, last = run(words, i, last)


@compiled
def less_smooth(i, nx, contact, words, field, smooth, out):
    """Write out = field - smooth along row i; zero without contact."""
    out[:] = 0
    first, last = run(words, i, 0)
    while first < last:
        for j in range(WORD * first, min(WORD * last, nx)):
            value = field[i, j] - smooth[i // CELL, j // CELL]
            out[j] = value if contact[i, j] != 0 else np.float32(0)
        first, last = run(words, i, last)


@compiled
def adjoint_at(i, down, west, j, east, table, code, here, below):
    """Return Gᵀ of the rows `here` and `below` at a point, given the indices of its neighbours."""
    value = table[0, code[i, j]] * here[j] + table[1, code[i, east]] * here[east]
    value += table[2, code[down, east]] * below[east] + table[3, code[down, j]] * below[j]
    return value + table[4, code[down, west]] * below[west]


@compiled
def adjoint(low, high, nx, gap, level, spread, theta, before, contact, words, table, code, field, smooth, out, sums):
    """Write out = Gᵀ(field - smooth); sums: out·r, out·(r before the last step), out."""
    ny = contact.shape[0]
    none = np.float32(0)
    now = 0.0
    then = 0.0
    total = 0.0
    here, below = np.empty(nx, np.float32), np.empty(nx, np.float32)
    less_smooth(low, nx, contact, words, field, smooth, below)
    for i in range(low, high):
        down = i + 1 if i < ny - 1 else 0
        here, below = below, here
        less_smooth(down, nx, contact, words, field, smooth, below)
        first, last = run(words, i, 0)
        while first < last:
            begin, end = WORD * first, min(WORD * last, nx)
            a, b = max(begin, 1), min(end, nx - 1)
            codes, codes_below, result = code[i, a : b + 1], code[down, a - 1 : b + 1], out[i, a:b]
            middle, beneath = here[a : b + 1], below[a - 1 : b + 1]
            for j in range(b - a):
                value = table[0, codes[j]] * middle[j] + table[1, codes[j + 1]] * middle[j + 1]
                value += table[2, codes_below[j + 2]] * beneath[j + 2] + table[3, codes_below[j + 1]] * beneath[j + 1]
                result[j] = value + table[4, codes_below[j]] * beneath[j]
            if begin == 0:
                out[i, 0] = adjoint_at(i, down, nx - 1, 0, 1, table, code, here, below)
            if end == nx:
                out[i, nx - 1] = adjoint_at(i, down, nx - 2, nx - 1, 0, table, code, here, below)
            touches, result = contact[i, begin:end], out[i, begin:end]
            opening, risen = gap[i, begin:end], spread[i, begin:end]
            for j in range(end - begin):
                value = result[j] if touches[j] != 0 else none
                result[j] = value
                now += value * (level - opening[j])
                then += value * (before - (opening[j] - theta * risen[j]))
                total += value
            first, last = run(words, i, last)
    sums[0] = now
    sums[1] = then
    sums[2] = total


class LastStep(NamedTuple):
    """The last step: change of the gap (ny, nx or more), part of it that was taken, and level of the gap before."""

    spread: Array
    theta: np.float32
    level: np.float32


class Preconditioner:
    """Gᵀ(1 - B)G on a contact set that changes.

    Parameters
    ----------
    compliance
        Compliance of the surface.
    wavelength
        Wavelength above which G alone would be too soft, in points.
    """

    def __init__(self, compliance: Compliance, wavelength: float) -> None:
        grid = compliance.grid
        self.counter = compliance.counter
        self.table = stencil(compliance)
        coarse = grid.coarser(tuple(max(-(-size // CELL), 2) for size in grid.shape))
        self.cells = np.zeros(coarse.shape, np.float32)
        symbol = np.abs(compliance.symbol[coarse.modes_of(grid)])
        ratio = np.divide(wavelength / np.pi, symbol, out=np.zeros_like(symbol), where=symbol > 0)
        excess = (1 - ratio / np.hypot(1, ratio)) / CELL**2
        self._excess = excess.astype(np.float32)
        self._grid = coarse
        self._code = np.zeros(grid.shape, np.uint8)

    def __call__(
        self,
        rows: Rows,
        *,
        gap: Array,
        level: np.float32,
        last: LastStep,
        contact: Contact,
        scratch: Array,
        out: Array,
    ) -> tuple[float, float, float]:
        """Precondition the residual level - gap.

        Parameters
        ----------
        rows
            Calls of kernels.
        gap, level
            Gap (ny, nx) and its level on the contact.
        last
            The last step.
        contact
            Contact set.
        scratch
            Memory (ny, nx or more) that is overwritten.
        out
            Preconditioned residual (ny, nx or more), written.

        Returns
        -------
        now, then, total
            Products of the preconditioned residual with the residual and with that before the last step, and its sum.
        """
        self.cells[:] = 0
        rows(factor, gap, level, *contact, self.table, self._code, scratch, self.cells)
        half = self._grid.forward(self.cells)
        half *= self._excess
        smooth = self._grid.backward(half, out=self.cells)
        self.counter.add(2, self.cells.size)
        now, then, total, *_ = rows(adjoint, gap, level, *last, *contact, self.table, self._code, scratch, smooth, out)
        return now, then, total


def stencil(compliance: Compliance, most: int = 64) -> Array:
    """Return the rows of G (5, 16): weights of a point and its four neighbours, by the bits of those in contact."""
    grid = compliance.grid
    steps = [max(size // most, 1) for size in grid.shape]
    sizes = [min(size, most) for size in grid.shape]
    row = np.fft.fftfreq(sizes[0], 1 / sizes[0]).astype(int) * steps[0]
    places = np.ix_(np.where(row < 0, row + grid.shape[0], row), np.arange(sizes[1] // 2 + 1) * steps[1])
    response = np.fft.irfft2(compliance.symbol[places], sizes)
    offsets = np.array([(0, 0), *NEIGHBOURS])
    apart = (offsets[:, None] - offsets) % sizes
    matrix = response[apart[..., 0], apart[..., 1]]
    table = np.zeros((5, 16), np.float32)
    for bits in range(16):
        among = [0, *(place + 1 for place in range(4) if bits >> place & 1)]
        weights = np.linalg.lstsq(matrix[np.ix_(among, among)], np.eye(len(among))[0])[0]
        table[among, bits] = weights / np.sqrt(max(weights[0], np.finfo(float).tiny))
    return table
