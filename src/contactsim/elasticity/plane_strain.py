"""How the surfaces of an elastic layer answer a wave, normally and along x at once (Eqs 2.9-2.13), without units.

Fields vary as e^{iqx}, q > 0, in plane strain, z points up and tractions act on the body from outside. The functions
take x = qh and Poisson's ratio ν up to exactly 1/2. Stiffness is in units of μq, compliance in those of 1/(μq), rows
and columns are normal, then along x. A 2×2 symbol is [[nn, i·nt], [-i·nt, tt]], each of the three real.

With k = 3-4ν, r = 1/k, ω = 1-r = 2(1-2ν)r, which is exact where ν is near 1/2, and

    A = k (sinh 2x - 2x) + 4(1-2ν) x        B = k sinh 2x + 2x        C = (1-2ν) k sinh²x - x²
    D = k cosh 2x + (1+k²)/2 + 2x²          f = sinh²x - r²x²         g = sinh²x - x²

the surface of a layer bonded to a rigid base has, as the inverse of a 2×2 matrix is its adjugate over its determinant,

    compliance  [(1-ν)A, (1-ν)B,  C] / D              for nn, tt, nt,
    stiffness   [(1-ν)B, (1-ν)A, -C] · 2/(k² f)       for nn, tt, nt,

and of a layer whose other face is free the compliance is [(1-ν)(½ sinh 2x + x), (1-ν)(½ sinh 2x - x),
(½-ν) sinh²x + x²/2] / g. The half-space is their limit. Eqs 2.12 as printed are the same stiffness in units of C11|q|,
but M13 and M24 are real, M14 = M23 without the minus, and they cancel where x is small, are infinity times zero where
ν = 1/2, and overflow where x is above 355. Here sinh x - x and x cosh x - sinh x have series,
f = (sinh x - x)(sinh x + x) + ω(1+r)x² has no cancellation, and everything is multiplied by e^{-2x}. The tests
integrate Navier's equations, with sixty digits.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array

DEEP = 1500.0
"""2|q|h from which on e^{-2|q|h} is zero in floating point: larger arguments give the same."""


def sinh_less_argument(y: Array) -> Array:
    """2e^{-y} (sinh y - y) for y ≥ 0, to rounding."""
    series, square = 1.0, np.minimum(y, 2.0) ** 2
    for n in range(23, 4, -2):
        series = 1 + square / (n * (n - 1)) * series
    return np.where(y < 2, y**3 / 3 * np.exp(-y) * series, -np.expm1(-2 * y) - 2 * y * np.exp(-y))


def cosh_less_sinh(y: Array) -> Array:
    """2e^{-y} (y cosh y - sinh y) for y ≥ 0, to rounding."""
    series, square = 1.0, np.minimum(y, 2.0) ** 2
    for n in range(11, 0, -1):
        series = 1 + square / (2 * n * (2 * n + 3)) * series
    return np.where(y < 2, 2 * y**3 / 3 * np.exp(-y) * series, y * (1 + np.exp(-2 * y)) + np.expm1(-2 * y))


def bonded_denominator(twice: Array, decay: Array, k: float) -> Array:
    """2e^{-2x} D at 2x and e^{-2x}."""
    return k * (1 + decay**2) + (1 + k**2 + twice**2) * decay


def determinant(x: Array, ratio: float) -> Array:
    """4e^{-2x} f; at ν = 1/2 also 4e^{-2x} g of any ν."""
    r, omega = _r_and_omega(ratio)
    return sinh_less_argument(x) * (2 * x * np.exp(-x) - np.expm1(-2 * x)) + 4 * omega * (1 + r) * x**2 * np.exp(-2 * x)


def bonded_shear(x: Array, ratio: float) -> Array:
    """Entries tt and nt of the compliance of a layer bonded to a rigid base, (2, …x), in 1/(μq)."""
    twice, decay, k = _terms(x, ratio)
    below = bonded_denominator(twice, decay, k)
    return np.stack([(1 - ratio) * _along(twice, decay, k), _across(twice, decay, ratio)]) / below


def bonded_stiffness(x: Array, ratio: float) -> Array:
    """Entries nn, tt, nt of the stiffness of a layer bonded to a rigid base, (3, …x), in μq; to 1e-15 √(nn·tt).

    x above 1e-60.
    """
    twice, decay, k = _terms(x, ratio)
    scale = 4 / (k**2 * determinant(twice / 2, ratio))
    normal = k * sinh_less_argument(twice) + 4 * (1 - 2 * ratio) * twice * decay
    entries = (1 - ratio) * _along(twice, decay, k), (1 - ratio) * normal, -_across(twice, decay, ratio)
    return scale * np.stack(entries)


def free_compliance(x: Array, ratio: float) -> Array:
    """Entries nn, tt, nt of the compliance of a layer whose other face is free, (3, …x), in 1/(μq).

    x above 1e-60.
    """
    twice, decay, _ = _terms(x, ratio)
    entries = (
        (1 - ratio) * (2 * twice * decay - np.expm1(-2 * twice)),
        (1 - ratio) * sinh_less_argument(twice),
        (0.5 - ratio) * np.expm1(-twice) ** 2 + twice**2 * decay / 2,
    )
    return np.stack(entries) / determinant(twice / 2, 0.5)


def both_faces(x: Array, ratio: float) -> Array:
    """Stiffness of both faces (Eqs 2.11-2.12, mended), in μq, complex, shape (4, 4, …x).

    Order: normal and along x of the upper face, normal and along x of the lower face. Hermitian. x above 1e-60.
    """
    normal, along, across = bonded_stiffness(x, ratio)
    y = np.minimum(x, DEEP / 2)
    r, omega = _r_and_omega(ratio)
    even, odd = 1 + np.exp(-2 * y), -np.expm1(-2 * y)
    scale = 2 * (1 + r) * np.exp(-y) / determinant(y, ratio)
    whole = np.zeros((4, 4, *np.shape(x)), complex)
    for face, sign in ((0, 1j), (2, -1j)):
        whole[face, face], whole[face + 1, face + 1] = normal, along
        whole[face, face + 1], whole[face + 1, face] = sign * across, -sign * across
    whole[0, 2] = whole[2, 0] = -scale * (r * y * even + odd)
    whole[1, 3] = whole[3, 1] = scale * (cosh_less_sinh(y) - omega * y * even)
    whole[0, 3] = whole[1, 2] = 1j * scale * r * y * odd
    whole[2, 1] = whole[3, 0] = -whole[0, 3]
    return whole


def _r_and_omega(ratio: float) -> tuple[float, float]:
    k = 3 - 4 * ratio
    return 1 / k, 2 * (1 - 2 * ratio) / k


def _terms(x: Array, ratio: float) -> tuple[Array, Array, float]:
    """2x, no deeper than matters, e^{-2x} and k."""
    twice = np.minimum(2 * x, DEEP)
    return twice, np.exp(-twice), 3 - 4 * ratio


def _along(twice: Array, decay: Array, k: float) -> Array:
    """2e^{-2x} B."""
    return 2 * twice * decay - k * np.expm1(-2 * twice)


def _across(twice: Array, decay: Array, ratio: float) -> Array:
    """2e^{-2x} C."""
    return (0.5 - ratio) * (3 - 4 * ratio) * np.expm1(-twice) ** 2 - twice**2 * decay / 2
