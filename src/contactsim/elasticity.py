"""How far a surface gives way under a sinusoidal load.

A linear elastic body is diagonal in Fourier space: pressure of wavenumber q moves its surface by compliance(q) times
the pressure. Two bodies in series add their compliances; a rigid body is absent. On a half-space the uniform mode is
free (the mean displacement is zero by convention), so its compliance and stiffness at q = 0 are both zero.
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


@dataclass(frozen=True)
class HalfSpace:
    """Semi-infinite elastic body with contact modulus E* = E/(1-ν²), GPa (scalar limit of Eq. 2.11)."""

    contact_modulus: float
    traits = frozenset({Trait.HALF_SPACE})

    def __post_init__(self) -> None:
        if not (is_number(self.contact_modulus) and self.contact_modulus > 0):
            raise SceneError("contact_modulus", self.contact_modulus, "a positive, finite number in GPa")

    def compliance(self, wavenumber: Array) -> Array:
        """Normal compliance 2/(E*|q|), 0 at q = 0, nm/GPa."""
        safe = np.where(wavenumber > 0, wavenumber, np.inf)
        return 2.0 / (self.contact_modulus * safe)


ELASTICITIES = {"half_space": HalfSpace}
