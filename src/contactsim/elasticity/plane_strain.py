"""Compliance and stiffness of the surface of a bonded layer for a wave, without units (Eqs 2.9-2.13).

Fields vary as e^{iqx}, q > 0, in plane strain; z points up and tractions act on the body from outside. Functions take
x = qh and Poisson's ratio ν up to exactly 1/2. Compliance is in units of 1/(μq), stiffness in units of μq. Rows and
columns are normal, then along x. A 2×2 symbol is [[nn, i·nt], [-i·nt, tt]] with three real entries.

With k = 3-4ν, r = 1/k, ω = 1-r = 2(1-2ν)r, which is exact near ν = 1/2, and

    A = k (sinh 2x - 2x) + 4(1-2ν) x        B = k sinh 2x + 2x        C = (1-2ν) k sinh²x - x²
    D = k cosh 2x + (1+k²)/2 + 2x²          f = sinh²x - r²x²

the surface of a layer on a rigid base has

    compliance  [(1-ν)A, (1-ν)B,  C] / D              for nn, tt, nt,
    stiffness   [(1-ν)B, (1-ν)A, -C] · 2/(k² f)       for nn, tt, nt.

The half-space is the limit of large x. Eqs 2.12 as printed are the same stiffness in units of C11|q|, with two
corrections: M13 and M24 are real, and M14 = M23 has no minus. They cancel at small x, are infinity times zero at
ν = 1/2, and overflow at x above 355. Here sinh x - x and x cosh x - sinh x have series,
f = (sinh x - x)(sinh x + x) + ω(1+r)x² has no cancellation, and everything is multiplied by e^{-2x}.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array

MAX_DEPTH = 1500.0
"""Largest 2|q|h: e^{-2|q|h} is zero in floating point there, and larger arguments give the same."""


def sinh_less_argument(y: Array) -> Array:
    """Return 2e^{-y} (sinh y - y) for y ≥ 0, to rounding."""
    series: Array | float = 1.0
    square = np.minimum(y, 2.0) ** 2
    for n in range(23, 4, -2):
        series = 1 + square / (n * (n - 1)) * series
    return np.where(y < 2, y**3 / 3 * np.exp(-y) * series, -np.expm1(-2 * y) - 2 * y * np.exp(-y))


def cosh_less_sinh(y: Array) -> Array:
    """Return 2e^{-y} (y cosh y - sinh y) for y ≥ 0, to rounding."""
    series: Array | float = 1.0
    square = np.minimum(y, 2.0) ** 2
    for n in range(11, 0, -1):
        series = 1 + square / (2 * n * (2 * n + 3)) * series
    return np.where(y < 2, 2 * y**3 / 3 * np.exp(-y) * series, y * (1 + np.exp(-2 * y)) + np.expm1(-2 * y))


def bonded_denominator(twice: Array, decay: Array, k: float) -> Array:
    """Return 2e^{-2x} D from 2x, e^{-2x} and k."""
    return k * (1 + decay**2) + (1 + k**2 + twice**2) * decay


def determinant(x: Array, ratio: float) -> Array:
    """Return 4e^{-2x} f, the determinant of the layer's stiffness but for a factor."""
    r, omega = _r_and_omega(ratio)
    return sinh_less_argument(x) * (2 * x * np.exp(-x) - np.expm1(-2 * x)) + 4 * omega * (1 + r) * x**2 * np.exp(-2 * x)


def bonded_shear_compliance(x: Array, ratio: float) -> Array:
    """Return the entries tt and nt of the compliance of a bonded layer, shape (2, …x), in 1/(μq)."""
    twice, decay, k = _terms(x, ratio)
    below = bonded_denominator(twice, decay, k)
    return np.stack([(1 - ratio) * _shear_entry(twice, decay, k), _coupling_entry(twice, decay, ratio)]) / below


def bonded_stiffness(x: Array, ratio: float) -> Array:
    """Return the entries nn, tt, nt of the stiffness of a bonded layer, shape (3, …x), in μq, for x above 1e-60.

    Errors are below 1e-15 √(nn·tt).
    """
    twice, decay, k = _terms(x, ratio)
    scale = 4 / (k**2 * determinant(twice / 2, ratio))
    normal = k * sinh_less_argument(twice) + 4 * (1 - 2 * ratio) * twice * decay
    entries = (1 - ratio) * _shear_entry(twice, decay, k), (1 - ratio) * normal, -_coupling_entry(twice, decay, ratio)
    return scale * np.stack(entries)


def _r_and_omega(ratio: float) -> tuple[float, float]:
    """Return r and ω."""
    k = 3 - 4 * ratio
    return 1 / k, 2 * (1 - 2 * ratio) / k


def _terms(x: Array, ratio: float) -> tuple[Array, Array, float]:
    """Return 2x, at most `MAX_DEPTH`, e^{-2x} and k."""
    twice = np.minimum(2 * x, MAX_DEPTH)
    return twice, np.exp(-twice), 3 - 4 * ratio


def _shear_entry(twice: Array, decay: Array, k: float) -> Array:
    """Return 2e^{-2x} B."""
    return 2 * twice * decay - k * np.expm1(-2 * twice)


def _coupling_entry(twice: Array, decay: Array, ratio: float) -> Array:
    """Return 2e^{-2x} C."""
    return (0.5 - ratio) * (3 - 4 * ratio) * np.expm1(-twice) ** 2 - twice**2 * decay / 2
