"""How far a surface gives way under a sinusoidal load.

A linear elastic body is diagonal in Fourier space: pressure of wavenumber q moves its surface by compliance(q) times
the pressure. Two bodies in series add their compliances; a rigid body is absent. On a half-space the uniform mode is
free (the mean displacement is zero by convention), so its compliance and stiffness at q = 0 are both zero. A layer of
thickness h on a rigid base gives way uniformly too, by h/C11 with C11 = E*(1-ν)²/(1-2ν); one of ν = 1/2 keeps its
volume, so its mean displacement is not free but zero.

The layer's compliance, with x = |q|h and k = 3-4ν, solves Navier's equations in plane strain for a bonded base and a
surface without shear:

    S = 2/(E*|q|) [k (sinh 2x - 2x) + 2x (2-4ν)] / [k cosh 2x + (1+k²)/2 + 2x²].

Numerator and denominator are sums of terms of one sign at any ν, so nothing cancels but sinh 2x - 2x, which has its
series where x is below 1. Multiplied by 2e^{-2x} nothing overflows, and the half-space follows mode by mode where
e^{-2x} is negligible. The tests integrate Navier's equations independently, with sixty digits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from contactsim.errors import SceneError, is_number
from contactsim.grid import Array
from contactsim.traits import Trait


class Elasticity(Protocol):
    """An elastic body seen from its surface, frictionless: normal displacement against normal pressure."""

    contact_modulus: float
    traits: frozenset[Trait]

    def compliance(self, wavenumber: Array) -> Array:
        """Displacement per pressure at each |q| (rad/nm), nm/GPa."""
        ...


def _check_modulus(contact_modulus: float) -> None:
    if not (is_number(contact_modulus) and contact_modulus > 0):
        raise SceneError("contact_modulus", contact_modulus, "a positive, finite number in GPa")


@dataclass(frozen=True)
class HalfSpace:
    """Semi-infinite elastic body with contact modulus E* = E/(1-ν²), GPa (scalar limit of Eq. 2.11)."""

    contact_modulus: float
    traits = frozenset({Trait.HALF_SPACE})

    def __post_init__(self) -> None:
        _check_modulus(self.contact_modulus)

    def compliance(self, wavenumber: Array) -> Array:
        """Normal compliance 2/(E*|q|), 0 at q = 0, nm/GPa."""
        safe = np.where(wavenumber > 0, wavenumber, np.inf)
        return 2.0 / (self.contact_modulus * safe)


@dataclass(frozen=True)
class Layer:
    """Layer bonded to a rigid base: thickness h (nm), contact modulus E* = E/(1-ν²) (GPa), Poisson's ratio ν up to 1/2.

    E* is the half-space's of the same material, which the layer becomes for waves much shorter than h.
    """

    contact_modulus: float
    poisson_ratio: float
    thickness: float
    traits = frozenset({Trait.LAYER})

    def __post_init__(self) -> None:
        _check_modulus(self.contact_modulus)
        if not (is_number(self.poisson_ratio) and -1 < self.poisson_ratio <= 0.5):
            raise SceneError("poisson_ratio", self.poisson_ratio, "a number above -1 and at most 0.5")
        if not (is_number(self.thickness) and self.thickness > 0):
            raise SceneError("thickness", self.thickness, "a positive, finite number in nm")

    def compliance(self, wavenumber: Array) -> Array:
        """Normal compliance of the bonded layer without surface shear (Eqs 2.11-2.13), h/C11 at q = 0, nm/GPa."""
        k, width = 3 - 4 * self.poisson_ratio, 1 - 2 * self.poisson_ratio
        twice = np.minimum(2 * self.thickness * wavenumber, DEEP)
        decay = np.exp(-twice)
        bulk = k * _scaled_sinh_less_argument(twice) / np.where(wavenumber > 0, wavenumber, 1.0)
        uniform = 8 * self.thickness * width * decay
        return 2 / self.contact_modulus * (bulk + uniform) / (k * (1 + decay**2) + (1 + k**2 + twice**2) * decay)


DEEP = 1500.0
"""2|q|h from which on e^{-2|q|h} is zero in floating point: larger arguments give the same."""


def _scaled_sinh_less_argument(y: Array) -> Array:
    """2e^{-y} (sinh y - y) for y ≥ 0, to rounding."""
    series, square = 1.0, np.minimum(y, 2.0) ** 2
    for n in range(23, 4, -2):
        series = 1 + square / (n * (n - 1)) * series
    return np.where(y < 2, y**3 / 3 * np.exp(-y) * series, -np.expm1(-2 * y) - 2 * y * np.exp(-y))


ELASTICITIES = {"half_space": HalfSpace, "layer": Layer}
