"""The elastic layer on a rigid base."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from contactsim.arguments import Length, Modulus, Wavenumbers, checked
from contactsim.elasticity.base import PoissonRatio
from contactsim.elasticity.plane_strain import (
    MAX_DEPTH,
    bonded_denominator,
    bonded_shear_compliance,
    bonded_stiffness,
    sinh_less_argument,
)
from contactsim.elasticity.symbol import CoupledSymbol
from contactsim.grid import Array
from contactsim.traits import Trait

UNIFORM_LIMIT = 1e-60
"""|q|h below which a wave counts as a uniform displacement."""


@checked
@dataclass(frozen=True)
class Layer:
    """Elastic layer that is bonded to a rigid base.

    Parameters
    ----------
    contact_modulus : float
        Contact modulus E* = E/(1-ν²) of a half-space of the same material, GPa. Waves much shorter than the thickness
        meet this half-space.
    poisson_ratio : float
        Poisson's ratio ν, above -1 and at most 1/2.
    thickness : float
        Thickness h, nm.

    Raises
    ------
    InputError
        If a value is outside its range.

    Notes
    -----
    A uniform traction displaces the surface by h/C11, with C11 = E*(1-ν)²/(1-2ν), and along x by h/C44. At ν = 1/2 the
    layer keeps its volume, so that its mean normal displacement is zero.

    The normal compliance, with x = |q|h and k = 3-4ν, solves Navier's equations in plane strain for a bonded base and
    a surface without shear::

        S = 2/(E*|q|) [k (sinh 2x - 2x) + 2x (2-4ν)] / [k cosh 2x + (1+k²)/2 + 2x²].

    All terms have one sign at any ν. Only sinh 2x - 2x cancels, and has its series for 2x below 2. Numerator and
    denominator are multiplied by 2e^{-2x}, so that nothing overflows.
    """

    contact_modulus: Modulus
    poisson_ratio: PoissonRatio
    thickness: Length
    traits = frozenset({Trait.LAYER})
    couples = True

    @property
    def youngs_modulus(self) -> float:
        """Young's modulus E = (1-ν²) E*, GPa."""
        return self.contact_modulus * (1 - self.poisson_ratio**2)

    @property
    def base_depth(self) -> float:
        """Depth of the base, nm."""
        return self.thickness

    @property
    def shear_modulus(self) -> float:
        """Shear modulus μ = C44, GPa."""
        return self.contact_modulus * (1 - self.poisson_ratio) / 2

    def incompressible(self) -> Layer:
        """Return the layer with ν = 1/2 and the same contact modulus."""
        return replace(self, poisson_ratio=0.5)

    def compliance(self, wavenumber: Array) -> Array:
        """Return the normal compliance without surface shear (Eqs 2.11-2.13), nm/GPa, h/C11 at q = 0."""
        k, width = 3 - 4 * self.poisson_ratio, 1 - 2 * self.poisson_ratio
        twice = np.minimum(2 * self.thickness * wavenumber, MAX_DEPTH)
        decay = np.exp(-twice)
        bulk = k * sinh_less_argument(twice) / np.where(wavenumber > 0, wavenumber, 1.0)
        uniform = 8 * self.thickness * width * decay
        return 2 / self.contact_modulus * (bulk + uniform) / bonded_denominator(twice, decay, k)

    def coupled_compliance(self, wavenumber: Wavenumbers) -> CoupledSymbol:
        """Return the compliance (Eqs 2.11-2.13, inverted), nm/GPa; h/C11 and h/C44 at q = 0."""
        uniform, q = self._uniform_modes(wavenumber)
        shear = bonded_shear_compliance(q * self.thickness, self.poisson_ratio)
        along, across = shear / (self.shear_modulus * q)
        along = np.where(uniform, self.thickness / self.shear_modulus, along)
        return CoupledSymbol(np.stack([self.compliance(wavenumber), along]), np.where(uniform, 0.0, across))

    def coupled_stiffness(self, wavenumber: Wavenumbers) -> CoupledSymbol:
        """Return the stiffness (Eqs 2.11-2.13), GPa/nm; C11/h, or 0 at ν = 1/2, and C44/h at q = 0."""
        uniform, q = self._uniform_modes(wavenumber)
        waves = self.shear_modulus * q * bonded_stiffness(q * self.thickness, self.poisson_ratio)
        width = 1 - 2 * self.poisson_ratio
        uniaxial = self.contact_modulus * (1 - self.poisson_ratio) ** 2 / width if width else math.inf
        normal = uniaxial / self.thickness if math.isfinite(uniaxial) else 0.0
        springs = [normal, self.shear_modulus / self.thickness, 0.0]
        entries = np.where(uniform, np.reshape(springs, (3, 1)), waves)
        return CoupledSymbol(entries[:2], entries[2])

    def _uniform_modes(self, wavenumber: Array) -> tuple[Array, Array]:
        """Return which waves count as uniform, and the wavenumbers with 1/h in their place."""
        uniform = np.asarray(wavenumber) * self.thickness < UNIFORM_LIMIT
        return uniform, np.where(uniform, 1 / self.thickness, wavenumber)
