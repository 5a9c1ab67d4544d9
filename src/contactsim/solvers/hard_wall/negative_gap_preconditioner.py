"""The preconditioner on a contact set of a line: Eᵀ K E.

E extends the residual linearly across each open gap, K is the stiffness of the whole line, Eᵀ the adjoint of E. The
surface is free in the gaps, so a displacement that is extended smoothly needs hardly any pressure there: two to four
iterations gain a factor of ten at any fraction of contact, and at full contact the preconditioner is the exact inverse.
An extension by zero costs three to six times more iterations. Constants are extended to constants, which K maps to
zero, so under a prescribed load every search direction keeps the load. Under a prescribed approach the uniform mode has
its own stiffness or, on a half-space, where it has none, that of the longest wave.

A layer feels nothing beyond its thickness h. The extension decays within it, at a rate that follows from the stiffness
of the softest wave; on a half-space this is the longest wave, and there is no decay. The number of iterations then
falls with h, to a third of that of the half-space where h is below a hundredth of the longest wavelength. There is one
exception: if an incompressible layer is much thinner than the contacts are wide, the number grows as h falls, to about
three times that of the half-space for few contacts and more for many. The volume that leaves a contact is heaped up
around it, which no extension of this kind describes.

K needs no transform of full length: the part of |q| that a few neighbours cannot express is smooth, and is added on
blocks of eight points (`BlockStiffness`). The number of iterations stays the same, and each costs 2.25 transforms in
place of 4.
"""

from __future__ import annotations

import numpy as np

from contactsim.elasticity.fourier_operator import Compliance, FourierOperator
from contactsim.grid import Array

DECAY = 8.0
"""Rate of decay of an extension, per point, over the stiffness of the softest wave beyond the half-space's."""


class NegativeGapPreconditioner:
    """Approximate inverse of the compliance on a contact set.

    Parameters
    ----------
    index
        Indices of the contact points (m,); at least one.
    stiffness
        Stiffness of the whole line.
    """

    def __init__(self, index: Array, stiffness: BlockStiffness) -> None:
        self._extension = GapExtension(index, stiffness.field.size, stiffness.decay)
        self._stiffness, self._first = stiffness, index[0]

    def __call__(self, residual: Array, work: Array, scratch: Array) -> Array:
        """Return the preconditioned residual (m,) of one (m,); work and scratch (n,) are overwritten."""
        self._extension.extend(residual, self._stiffness.field, scratch)
        return self._extension.restrict(self._stiffness(work, scratch), scratch)

    def gather(self, pressure: Array) -> Array:
        """Return a pressure (n,) on the contact points (m,): what others carry goes to their neighbours in contact."""
        return self._extension.share(np.roll(pressure, -self._first))


class GapExtension:
    """E and Eᵀ: interpolation between the contact points on the periodic line, and its adjoint.

    Linear, with a decay from both ends of a gap if the rate is not zero. Results of `extend`, and arguments of
    `restrict`, start at the first contact point instead of at x = 0; a translation-invariant operator between the two
    does not change.

    Parameters
    ----------
    index
        Indices of the contact points (m,); at least one.
    size
        Points of the line.
    decay
        Rate of decay per point.
    """

    def __init__(self, index: Array, size: int, decay: float = 0.0) -> None:
        gaps = np.diff(index, append=index[0] + size)
        self._begin = np.cumsum(gaps) - gaps
        self._owner = np.repeat(np.arange(index.size), gaps)
        self._fraction = (np.arange(size) - self._begin[self._owner]) / gaps[self._owner]
        self._envelope = None
        if decay * size > 1e-8:  # else the envelope is 1 to rounding
            self._envelope = _decay_factor(self._fraction, decay * gaps, self._owner)

    def extend(self, values: Array, out: Array, scratch: Array) -> None:
        """Extend values at the contact points (m,) to all points, into `out` (n,)."""
        np.take(np.roll(values, -1) - values, self._owner, out=scratch, mode="clip")
        scratch *= self._fraction
        np.take(values, self._owner, out=out, mode="clip")
        out += scratch
        if self._envelope is not None:
            out *= self._envelope

    def restrict(self, values: Array, scratch: Array | None = None) -> Array:
        """Return the adjoint of `extend` at the contact points (m,), of values at all points (n,), overwritten."""
        if self._envelope is not None:
            values *= self._envelope
        return self.share(values, scratch)

    def share(self, values: Array, scratch: Array | None = None) -> Array:
        """Return the adjoint without decay, which keeps the sum."""
        right = np.add.reduceat(np.multiply(values, self._fraction, out=scratch), self._begin)
        return np.add.reduceat(values, self._begin) - right + np.roll(right, 1)


def _decay_factor(fraction: Array, widths: Array, owner: Array) -> Array:
    """Return the extension of 1 across gaps of some widths, in decay lengths, at a fraction of the way."""
    far = widths[owner]
    near = fraction * far
    np.exp(np.subtract(near, far, out=far), out=far)
    far += np.exp(np.negative(near, out=near), out=near)
    far /= np.take(1 + np.exp(-widths), owner, out=near, mode="clip")
    return far.astype(np.float32)  # precise enough, as E and Eᵀ use the same


def block_size(points: int) -> int:
    """Return the points of a block of the stiffness: 8, or 1 if the grid is small or does not divide."""
    return 8 if points % 8 == 0 and points >= 512 else 1


class BlockStiffness:
    """Stiffness K for preconditioning: nearest neighbours, and the rest on blocks of points.

    Short waves have K = a + b|q|, with a = 0 unless a layer is as thin as the grid is wide, and
    |q| = π/2 - (4/π) Σ cos(jq)/j² over odd j (rad per point). Three terms are applied as differences; what they miss
    is smooth and is applied to means over blocks of eight points, through transforms of that reduced length. A grid
    that does not divide into blocks has K itself. `field` is its argument; `decay` is the rate, per point, at which an
    extension should decay.

    Parameters
    ----------
    compliance
        Compliance of the line.
    uniform
        Whether the uniform mode is free, so that its stiffness does not matter.
    """

    def __init__(self, compliance: Compliance, uniform: bool) -> None:
        grid = compliance.grid
        size = grid.size
        self._block = block_size(size)
        self._neighbours = (1, 3, 5) if self._block > 1 else ()
        coarse = grid.coarser((size // self._block,))
        stiffness = np.zeros(coarse.size // 2 + 1)
        stiffness[1:] = 1 / compliance.symbol[1 : coarse.size // 2 + 1]
        softest = max(1 / compliance.symbol[1:].max() - np.pi / size, 0.0)  # beyond the half-space's longest wave
        self.decay = DECAY * softest
        if uniform:
            stiffness[0] = softest
        else:
            stiffness[0] = 1 / compliance.symbol[0] if compliance.symbol[0] > 0 else stiffness[1]
        angle = 2 * np.pi * np.arange(stiffness.size) / size
        slope, self._centre = 0.0, 0.0
        if self._neighbours:
            shortest = 1 / compliance.symbol[-1]
            slope = (shortest - stiffness[-1]) / (np.pi - angle[-1])
            self._centre = shortest - slope * np.pi / 2
        self._weights = [-slope * 2 / np.pi / j**2 for j in self._neighbours]
        local = self._centre + 2 * sum(
            w * np.cos(j * angle) for w, j in zip(self._weights, self._neighbours, strict=True)
        )
        self._rest = FourierOperator(coarse, stiffness - local, compliance.counter)
        self._mean = np.full(self._block, 1 / self._block)
        self._pad = max(self._neighbours, default=1)
        self._padded = np.empty(size + 2 * self._pad)
        self.field = self._padded[self._pad : -self._pad]

    def __call__(self, out: Array, scratch: Array) -> Array:
        """Apply K to `self.field`, into `out`; all and scratch have shape (n,)."""
        pad, size = self._pad, out.size
        self._padded[:pad] = self._padded[size : size + pad]
        self._padded[-pad:] = self._padded[pad : 2 * pad]
        blocks = self._rest(self.field.reshape(-1, self._block) @ self._mean)
        np.multiply(self.field, self._centre, out=out)
        for weight, j in zip(self._weights, self._neighbours, strict=True):
            left, right = self._padded[pad - j : pad - j + size], self._padded[pad + j : pad + j + size]
            np.add(left, right, out=scratch)
            scratch *= weight
            out += scratch
        out.reshape(-1, self._block)[...] += blocks[:, None]
        return out
