"""The preconditioner on a contact set of a line: Eᵀ K E.

E continues the residual linearly across each open gap, K is the stiffness of the whole line, Eᵀ the adjoint. In the
gaps the surface is free, so a displacement continued smoothly needs hardly any pressure there: two to four iterations
gain a factor ten, at any fraction of contact, and at full contact the preconditioner is the exact inverse. Setting the
continuation to zero instead costs three to six times more. Constants are continued to constants, which K maps to zero,
so with a prescribed load every search direction keeps the load; with a prescribed approach the uniform mode gets its
own stiffness or, on a half-space, which has none, that of the longest wave.

A layer feels nothing beyond its thickness h: what is continued dies out within it, at a rate read off the stiffness of
the softest wave, which on a half-space is the longest one and gives no decay at all. The iterations then fall with h,
from those of the half-space to a third of them where h is below a hundredth of the longest waves. Only where an
incompressible layer is much thinner than the contacts are wide do they grow as h falls, to about three times those of
the half-space for few contacts and more for many: the volume that leaves a contact heaps up around it, which no
continuation of this kind shows.

K itself needs no transform of full length there: what a few neighbours cannot express of |q| is smooth, and is added
on blocks of eight points (`BlockStiffness`). The number of iterations stays the same and each one costs 2.25 transforms
in place of 4.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array, Operator


class Continuation:
    """E and Eᵀ: interpolation between the contact points on the circle, and its adjoint.

    Linear, and decaying from both ends of a gap where there is a rate of decay. Results of `extend`, and arguments of
    `restrict`, start at the first contact point instead of at x = 0; a translation-invariant operator between the two
    does not mind.
    """

    def __init__(self, contact: Array, decay: float = 0.0) -> None:
        """decay: rate at which what is continued dies out, per point."""
        self.index = np.flatnonzero(contact)
        gaps = np.diff(self.index, append=self.index[0] + contact.size)
        self._begin = np.cumsum(gaps) - gaps
        self._owner = np.repeat(np.arange(self.index.size), gaps)
        self._fraction = (np.arange(contact.size) - self._begin[self._owner]) / gaps[self._owner]
        self._envelope = None
        if decay * contact.size > 1e-8:  # or else it is 1 to rounding
            self._envelope = _decaying(self._fraction, decay * gaps, self._owner)

    def extend(self, values: Array, out: Array, scratch: Array) -> None:
        """From the contact points, shape (m,), to all points: `out`, shape (n,)."""
        np.take(np.roll(values, -1) - values, self._owner, out=scratch, mode="clip")
        scratch *= self._fraction
        np.take(values, self._owner, out=out, mode="clip")
        out += scratch
        if self._envelope is not None:
            out *= self._envelope

    def restrict(self, values: Array, scratch: Array | None = None) -> Array:
        """The adjoint: from all points, shape (n,), overwritten, to the contact points, shape (m,)."""
        if self._envelope is not None:
            values *= self._envelope
        return self.share(values, scratch)

    def share(self, values: Array, scratch: Array | None = None) -> Array:
        """The adjoint without the envelope, which keeps the sum."""
        right = np.add.reduceat(np.multiply(values, self._fraction, out=scratch), self._begin)
        return np.add.reduceat(values, self._begin) - right + np.roll(right, 1)


DECAY = 8.0
"""Rate at which a continuation dies out, per point, over the stiffness of the softest wave beyond the half-space's."""


def _decaying(fraction: Array, reach: Array, owner: Array) -> Array:
    """How a constant is continued across gaps of `reach` decay lengths, at a fraction of the way: 1 at both ends."""
    far = reach[owner]
    near = fraction * far
    np.exp(np.subtract(near, far, out=far), out=far)
    far += np.exp(np.negative(near, out=near), out=near)
    far /= np.take(1 + np.exp(-reach), owner, out=near, mode="clip")
    return far.astype(np.float32)  # digits enough, as E and Eᵀ use the same


def block_of(points: int) -> int:
    """Points of a block of the preconditioner's stiffness: 8, or 1 where the grid does not divide."""
    return 8 if points % 8 == 0 and points >= 512 else 1


class BlockStiffness:
    """Stiffness K for preconditioning: nearest neighbours, and the rest on blocks of points.

    Short waves have K = a + b|q|, with a = 0 unless a layer is as thin as the grid is wide, and
    |q| = π/2 - (4/π) Σ cos(jq)/j² over odd j (rad per point). Three terms are applied as differences; what they miss
    is smooth and is applied to means over blocks of eight points, through transforms of that reduced length. A grid
    that does not divide into blocks has K itself. decay: rate at which a continuation dies out, per point.
    """

    def __init__(self, compliance: Operator, uniform: bool) -> None:
        """uniform: whether the uniform mode is free, so that its stiffness is of no account."""
        grid = compliance.grid
        size = grid.size
        self.block = block_of(size)
        self.reach = (1, 3, 5) if self.block > 1 else ()
        coarse = grid.coarser((size // self.block,))
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
        if self.reach:
            shortest = 1 / compliance.symbol[-1]
            slope = (shortest - stiffness[-1]) / (np.pi - angle[-1])
            self._centre = shortest - slope * np.pi / 2
        self._weights = [-slope * 2 / np.pi / j**2 for j in self.reach]
        local = self._centre + 2 * sum(w * np.cos(j * angle) for w, j in zip(self._weights, self.reach, strict=True))
        self._rest = Operator(coarse, stiffness - local, compliance.tally)
        self._mean = np.full(self.block, 1 / self.block)
        self._pad = max(self.reach, default=1)
        self._padded = np.empty(size + 2 * self._pad)
        self.field = self._padded[self._pad : -self._pad]

    def __call__(self, out: Array, scratch: Array) -> Array:
        """Apply to `self.field`, into `out`; both and scratch of shape (n,)."""
        pad, size = self._pad, out.size
        self._padded[:pad] = self._padded[size : size + pad]
        self._padded[-pad:] = self._padded[pad : 2 * pad]
        blocks = self._rest(self.field.reshape(-1, self.block) @ self._mean)
        np.multiply(self.field, self._centre, out=out)
        for weight, j in zip(self._weights, self.reach, strict=True):
            left, right = self._padded[pad - j : pad - j + size], self._padded[pad + j : pad + j + size]
            np.add(left, right, out=scratch)
            scratch *= weight
            out += scratch
        out.reshape(-1, self.block)[...] += blocks[:, None]
        return out
