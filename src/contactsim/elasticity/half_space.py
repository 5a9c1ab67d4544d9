"""The semi-infinite elastic body, under tractions that repeat periodically or not at all."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from contactsim.arguments import Modulus, Wavenumbers, checked
from contactsim.elasticity.base import PoissonRatio, known_poisson_ratio
from contactsim.elasticity.symbol import CoupledSymbol
from contactsim.grid import Array
from contactsim.traits import Trait


@checked
@dataclass(frozen=True)
class HalfSpace:
    """Semi-infinite elastic body (the limit of Eq. 2.11 for a large thickness).

    Its uniform mode is free: the mean displacement is zero by convention, so its compliance and its stiffness at q = 0
    are both zero.

    Parameters
    ----------
    contact_modulus : float
        Contact modulus E* = E/(1-ν²), GPa.
    poisson_ratio : float, optional
        Poisson's ratio ν, above -1 and at most 1/2. It is needed for displacements along x and for fields below the
        surface.

    Raises
    ------
    InputError
        If a value is outside its range.
    """

    contact_modulus: Modulus
    poisson_ratio: PoissonRatio | None = None
    traits = frozenset({Trait.HALF_SPACE})
    base_depth = math.inf

    @property
    def youngs_modulus(self) -> float | None:
        """Young's modulus E = (1-ν²) E*, GPa; None without Poisson's ratio."""
        return None if self.poisson_ratio is None else self.contact_modulus * (1 - self.poisson_ratio**2)

    @property
    def couples(self) -> bool:
        """True if a normal traction moves the surface along x: at every ν but 1/2."""
        return self.poisson_ratio != 0.5

    def incompressible(self) -> HalfSpace:
        """Return the body with ν = 1/2 and the same contact modulus; itself where ν is unknown."""
        return self if self.poisson_ratio is None else replace(self, poisson_ratio=0.5)

    def compliance(self, wavenumber: Array) -> Array:
        """Return the normal compliance 2/(E*|q|), nm/GPa, 0 at q = 0."""
        safe = np.where(wavenumber > 0, wavenumber, np.inf)
        return np.asarray(2.0 / (self.contact_modulus * safe))

    def coupled_compliance(self, wavenumber: Wavenumbers) -> CoupledSymbol:
        """Return the compliance [[1-ν, i(½-ν)], [-i(½-ν), 1-ν]]/(μq), nm/GPa, 0 at q = 0."""
        normal = self.compliance(wavenumber)
        ratio = known_poisson_ratio(self)
        return CoupledSymbol(np.stack([normal, normal]), (0.5 - ratio) / (1 - ratio) * normal)

    def coupled_stiffness(self, wavenumber: Wavenumbers) -> CoupledSymbol:
        """Return the stiffness μq/(3-4ν) [[4(1-ν), -2i(1-2ν)], [2i(1-2ν), 4(1-ν)]], GPa/nm."""
        ratio = known_poisson_ratio(self)
        entry = self.contact_modulus * (1 - ratio) / (3 - 4 * ratio) * np.asarray(wavenumber)
        return CoupledSymbol(2 * (1 - ratio) * np.stack([entry, entry]), (2 * ratio - 1) * entry)


@checked
@dataclass(frozen=True)
class FreeHalfSpace(HalfSpace):
    """Semi-infinite elastic body that is loaded on the area of the heights alone: nothing repeats beyond it.

    Far away its displacement is zero. On a line, where displacements fall with the logarithm of the distance, that of a
    line load is zero at a distance of the length of the heights, by convention. Parameters as those of `HalfSpace`.
    """

    traits = frozenset({Trait.FREE})
