"""Preconditioner for stiffness plus the tangent of laws that act over a small part of a line.

Long waves, those below a fraction of the grid, are solved for exactly on a coarser grid: with C the compliance and D
the tangent, (K + D) w = r is w = C (r - D w), in which D is not zero on the process zone Z alone, so that

    (1 + C_ZZ D_Z) w_Z = (C r)_Z,   w = C (r - D w_Z),

one dense factorisation of the size of the zone. Short waves see the stiffness and a constant shift. A uniform mode
that is free (its stiffness zero, under load control) is given the stiffness of the longest wave.
"""

from __future__ import annotations

from functools import lru_cache

import ducc0
import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs

from contactsim.contact.cohesive import CohesiveProblem, Tangent, contract
from contactsim.grid import Array

RATIO, NODES = 8, 128
"""Points of the grid to one on which long waves are solved for, unless these would be fewer than so many."""
SHIFT, LEAST = 0.3, 0.01
"""Shift of short waves, over the laws' largest tangent; its least tangential part, over the normal one."""
ALIKE = 2.0
"""Ratio of largest tangential tangents up to which short waves are shifted alike."""
NEGLIGIBLE = 1e-3
"""Tangent, over the laws' largest, below which a point is outside the process zone."""
TURNS, FAINT = 2, 0.1
"""Steps of inverse iteration a state; size of a wave where the zone has not been yet, over its rms in the zone."""
SEEN = 160
"""Most entries of a zone whose growing displacements are looked for."""
MOST = 400
"""Entries of the zone beyond which its factorisation would cost more than it saves: the coarse grid gets coarser."""


class ZonePreconditioner:
    """Approximate inverse of K + D + shift, for coefficients (exerted, m)."""

    def __init__(
        self,
        problem: CohesiveProblem,
        tangent: Tangent,
        shift: float = 0.0,
        before: ZonePreconditioner | None = None,
    ) -> None:
        """before: one of the same shift and path, from which is taken over what does not depend on the tangent."""
        self._problem = problem
        rows, modes = problem.unknowns
        ratio = min(RATIO, max(problem.grid.size // NODES, 1))
        values = _averaged(tangent.values, ratio)
        while np.count_nonzero(self._acting(values)) * len(problem.shape) > MOST:
            ratio *= 2
            values = _averaged(tangent.values, ratio)
        self._nodes = values.shape[-1]
        self._low = min(self._nodes // 2, modes)
        self._sideways = np.abs(tangent.values[1:, 1:]).max(initial=LEAST * problem.law_stiffness)
        alike = before is not None and before._nodes == self._nodes
        if alike and 1 / ALIKE <= self._sideways / before._sideways <= ALIKE:
            self._high, self._sideways = before._high, before._sideways
        else:
            extra = shift + SHIFT * np.array([problem.law_stiffness, self._sideways][:rows])
            self._high = problem.stiffness.modes(slice(self._low, None)).inverse(extra)
        if alike:
            self._compliance, self._responses = before._compliance, before._responses
        else:
            self._compliance = problem.regularised_stiffness.modes(slice(0, self._low)).inverse(shift)
            self._responses = [self._response(row) for row in range(rows)]
        self._factor(values)

    def _acting(self, values: Array) -> Array:
        """Points where the tangent is not negligible, bool."""
        return np.abs(values).max(axis=(0, 1)) > NEGLIGIBLE * self._problem.law_stiffness

    def _field(self, coefficients: Array) -> Array:
        """Values (rows, nodes) on the coarse grid of long waves (rows, low), with the derived component."""
        derived = self._problem.slip_factor
        if derived is not None:
            coefficients = np.concatenate((coefficients, derived[: self._low] * coefficients))
        wide = np.zeros((len(coefficients), self._nodes // 2 + 1), complex)
        wide[:, : self._low] = coefficients
        return ducc0.fft.c2r(wide, axes=(1,), lastsize=self._nodes, forward=False)

    def _response(self, row: int) -> Array:
        """Displacement (read, nodes) under a unit of traction in one component at the first node."""
        unit = np.zeros((len(self._compliance.diagonal), self._low), complex)
        unit[row] = 1 / self._nodes
        return self._field(self._compliance.apply(unit))

    def _factor(self, values: Array) -> None:
        self._zone = np.flatnonzero(self._acting(values))
        self._values = values[..., self._zone]
        count, read = len(self._zone), len(self._problem.shape)
        if not count:
            return
        apart = (self._zone[:, None] - self._zone) % self._nodes
        matrix = np.zeros((read, count, read, count))
        for row, response in enumerate(self._responses):
            for to in range(read):
                kernel = response[to][apart]
                for by in range(read):
                    matrix[to, :, by] += kernel * self._values[row, by]
        square = matrix.reshape(read * count, -1)
        square[np.diag_indices(len(square))] += 1
        self._matrix = square
        self._lu = dgetrf(square)[:2]

    def softest(self, wave: Array | None) -> tuple[bool, Array | None]:
        """Whether K + D + shift may have negative eigenvalues, and a wave (read, nodes) to ask the next one with.

        An odd number of them is told by the sign of the determinant. Of an even number, as alike asperities have, the
        one nearest zero is found by inverse iteration from the wave of the state before, in which it was the next to
        cross: w' = (1 + C D)⁻¹ w, and w·w' is negative.
        """
        if not len(self._zone):
            return False, wave
        kept = _arbitrary(len(self._problem.shape), self._nodes).copy()
        factors, swaps = self._lu
        negative = np.count_nonzero(factors.diagonal() < 0) + np.count_nonzero(swaps != np.arange(len(swaps)))
        here = (kept if wave is None or wave.shape != kept.shape else wave)[:, self._zone].ravel()
        for _ in range(TURNS):
            here /= np.linalg.norm(here)
            after = dgetrs(*self._lu, here)[0]
            falls, here = here @ after < 0, after
        kept[:, self._zone] = (here * np.sqrt(len(here)) / np.linalg.norm(here)).reshape(len(kept), -1)
        return bool(negative % 2) or bool(falls), kept

    def growing(self) -> Array | None:
        """Displacement (exerted, m) that would grow by itself the most, as seen here; None if none would.

        With w an eigenvector of 1 + C D and its eigenvalue μ < 0, (K + D) w = μ K w. None too for more entries than
        `SEEN`, which would take long.
        """
        if not 0 < len(self._zone) * len(self._values) <= SEEN:
            return None
        values, vectors = np.linalg.eig(self._matrix)
        lowest = int(np.argmin(values.real))
        if values[lowest].real >= 0:
            return None
        wave = np.zeros(self._problem.unknowns, complex)
        wave[:, : self._low] = self._spread(vectors[:, lowest].real.reshape(self._values.shape[1], -1))
        return wave

    def _spread(self, held: Array) -> Array:
        """Displacement (exerted, low) under the tractions that displacements (read, zone) in the zone lead to."""
        pull = np.zeros((len(self._values), self._nodes))
        pull[:, self._zone] = contract(self._values, held)
        return self._compliance.apply(ducc0.fft.r2c(pull, axes=(1,), forward=True, inorm=2)[:, : self._low])

    def __call__(self, residual: Array) -> Array:
        """Displacement (exerted, m) for a residual of the same shape."""
        out = np.empty_like(residual)
        out[:, self._low :] = self._high.apply(residual[:, self._low :])
        long = self._compliance.apply(residual[:, : self._low])
        if len(self._zone):
            free = self._field(long)[:, self._zone]
            held = dgetrs(*self._lu, free.ravel())[0].reshape(free.shape)
            long -= self._spread(held)
            self._problem.tally.add(len(free) + len(residual), self._nodes)
        out[:, : self._low] = long
        return out


@lru_cache(maxsize=8)
def _arbitrary(rows: int, nodes: int) -> Array:
    """A faint wave (rows, nodes) of no symmetry."""
    return FAINT * np.cos(np.arange(rows * nodes) ** 2.0).reshape(rows, nodes)


def _averaged(values: Array, ratio: int) -> Array:
    """Means over `ratio` points about every ratio-th, at least two of them (…, n // ratio), of values (…, n)."""
    size = values.shape[-1]
    ratio = min(ratio, size // 2)
    cells = size // ratio
    shifted = np.concatenate((values[..., size - ratio // 2 :], values[..., : size - ratio // 2]), -1)
    return shifted[..., : cells * ratio].reshape(*values.shape[:-1], cells, ratio).mean(-1)
