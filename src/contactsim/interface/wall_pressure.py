"""The pressure of a hard wall beside smooth laws, as the method of multipliers corrects it.

A wall is no law: its pressure p is an unknown, bound by gap ≥ 0, p ≥ 0 and p g = 0. From an estimate of p the method
lets the wall push with max(p - k g, 0), which is a smooth law, and takes this push for the next estimate. Whatever the
stiffness k, the gap is zero in contact once p no longer changes; k only decides how fast that is.

References
----------
M. R. Hestenes, J. Optim. Theory Appl. 4, 303 (1969), doi:10.1007/BF00927673.
P. Alart and A. Curnier, Comput. Methods Appl. Mech. Eng. 92, 353 (1991), doi:10.1016/0045-7825(91)90022-X.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contactsim.grid import Array

BODY_RATIO, LAW_RATIO = 4.0, 3.0
"""Least stiffness by which overlap corrects the pressure, over the largest one of the bodies, and over that of the
laws, which pull the wall's springs apart. A larger one needs fewer corrections, and more iterations for each."""
EDGE_RATIO = 0.5
"""The same over the largest one of the bodies, for a spring that places the edge of contact between points."""


@dataclass(frozen=True)
class WallPressure:
    """Estimate of the pressure of a hard wall.

    Parameters
    ----------
    values
        Pressure, GPa, (n,); never negative.
    stiffness
        Pressure by which an overlap corrects it, GPa/nm.
    edge_stiffness
        Stiffness of the wall as a spring, which places the edge of contact between points, GPa/nm.
    """

    values: Array
    stiffness: float
    edge_stiffness: float

    @classmethod
    def zero(cls, points: int, body_stiffness: Array, law_stiffness: float) -> WallPressure:
        """Return no pressure on a number of points.

        body_stiffness, law_stiffness: of the bodies at each wavenumber and of the laws, GPa/nm
        """
        stiffest, of_laws = float(body_stiffness.max()), LAW_RATIO * law_stiffness
        return cls(np.zeros(points), max(BODY_RATIO * stiffest, of_laws), max(EDGE_RATIO * stiffest, of_laws))

    def push(self, gap: Array) -> Array:
        """Return the pressure (n,), GPa, with which the wall pushes at a gap (n,), nm."""
        return np.maximum(self.values - self.stiffness * gap, 0.0)

    def energy(self, gap: Array) -> Array:
        """Return the potential of the push (n,), N/m, at a gap (n,), nm."""
        energy: Array = (self.push(gap) ** 2 - self.values**2) / (2 * self.stiffness)
        return energy

    def corrected(self, gap: Array, stiffening: float = 1.0) -> WallPressure:
        """Return the next estimate, from the gap (n,), nm, at which the push was in equilibrium.

        stiffening: stiffness over that of this estimate
        """
        return replace(self, values=self.push(gap), stiffness=stiffening * self.stiffness)

    def largest_gap(self, gap: Array) -> float:
        """Return the largest size, or overlap, of a gap (n,), nm, where the wall pushes."""
        return float(np.abs(gap).max(where=self.push(gap) > 0, initial=0.0))
