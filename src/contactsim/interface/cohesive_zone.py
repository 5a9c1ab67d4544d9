"""Cohesive zones: adhesion and friction as smooth functions of the gap.

The mixed-mode law (Eq. 2.17) has no potential: the cross derivatives of its two tractions differ by

    (2 Δt/(δn δt²)) exp(-Δn/δn - Δt²/δt²) (φt - φn Δn/δn),

so no method that minimises an energy can solve it. Its repulsion is proportional to the work of separation as well: if
this work tends to zero, the bodies do not touch at all, and a hard wall is not recovered.

Section 4.3.2 removes the coupling by "removing the dependency on the tangential component" from the normal traction
alone. So without its coupling the law has T_n of Eq. 4.1, and T_t of Eq. 2.17 keeps its dependence on Δn, by which
shear needs surfaces that are close. In the thesis such contacts are frictionless and only T_n is left.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated

import numpy as np

from contactsim.arguments import Gap, Length, NotNegative, Only, Work, checked
from contactsim.errors import POSITIVE, is_positive
from contactsim.grid import Array
from contactsim.interface.exponentials import MAX_OVERLAP, MAX_SLIP, decay, pull
from contactsim.interface.normal_law import NormalLaw
from contactsim.traits import Trait


@checked
@dataclass(frozen=True)
class CohesiveZone:
    """Mixed-mode cohesive zone (Eq. 2.17).

    With a work ratio of zero it is frictionless: it exerts no shear, yet its normal traction reads the tangential gap.

    Parameters
    ----------
    work_of_separation
        Normal work of separation φn > 0, N/m.
    work_ratio
        Tangential over normal work of separation φt/φn ≥ 0 (Eq. 2.16).
    normal_length, tangential_length
        Characteristic lengths δn and δt, nm.

    References
    ----------
    J. P. McGarry et al., Journal of the Mechanics and Physics of Solids 63 (2014).
    """

    work_of_separation: Work
    work_ratio: NotNegative = 0.0
    normal_length: Length = 1.0
    tangential_length: Length = 1.0
    reads = frozenset({"n", "t"})
    traits = frozenset({Trait.SMOOTH, Trait.NON_CONSERVATIVE})

    @property
    def tangential_work(self) -> float:
        """Tangential work of separation φt, N/m."""
        return self.work_ratio * self.work_of_separation

    @property
    def exerts(self) -> frozenset[str]:
        """Normal traction, and tangential traction if there is tangential work of separation."""
        return frozenset({"n", "t"} if self.tangential_work else {"n"})

    @property
    def strength(self) -> float:
        """Largest normal traction φn/(e δn) (Eq. 2.18), GPa."""
        return float(self.work_of_separation / self.normal_length / np.e)

    @property
    def stiffness(self) -> float:
        """Larger one of the two tangents at zero gap, GPa/nm."""
        return max(
            self.work_of_separation / self.normal_length**2, 2 * self.tangential_work / self.tangential_length**2
        )

    @property
    def interaction_range(self) -> float:
        """Length over which the normal traction changes, nm."""
        return self.normal_length

    def traction(self, gap: Gap) -> Array:
        """Return the traction (1 or 2, n), GPa, at a gap (2, n), nm."""
        normal, tangential = self._without_units(gap)
        shear = np.exp(-(tangential**2))
        normal_traction = self.work_of_separation / self.normal_length * pull(normal)[0] * shear
        if not self.tangential_work:
            return normal_traction[None]
        size = 2 * self.tangential_work / self.tangential_length
        return np.stack((normal_traction, size * tangential * decay(normal)[0] * shear))

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (1 or 2, n), GPa, and its derivatives by both components (1 or 2, 2, n), GPa/nm."""
        normal, tangential = self._without_units(gap)
        shear = np.exp(-(tangential**2))
        value, slope = pull(normal)
        size = self.work_of_separation / self.normal_length
        traction = np.empty((len(self.exerts), gap.shape[1]))
        derivative = np.empty((len(self.exerts), *gap.shape))
        traction[0] = size * value * shear
        derivative[0, 0] = size / self.normal_length * slope * shear
        derivative[0, 1] = -2 / self.tangential_length * tangential * traction[0]
        if self.tangential_work:
            value, slope = decay(normal)
            size = 2 * self.tangential_work / self.tangential_length
            traction[1] = size * tangential * value * shear
            derivative[1, 0] = size / self.normal_length * tangential * slope * shear
            derivative[1, 1] = size / self.tangential_length * (1 - 2 * tangential**2) * value * shear
        return traction, derivative

    def without_coupling(self) -> UncoupledCohesiveZone | NormalCohesiveZone:
        """Return the law whose normal traction does not depend on the tangential gap; friction remains as it is."""
        if not self.tangential_work:
            return self.without_slip()
        return UncoupledCohesiveZone(
            self.work_of_separation, self.work_ratio, self.normal_length, self.tangential_length
        )

    def without_slip(self) -> NormalCohesiveZone:
        """Return the law at zero tangential gap."""
        return NormalCohesiveZone(self.work_of_separation, self.normal_length)

    def without_friction(self) -> CohesiveZone:
        """Return the law without tangential work of separation."""
        return replace(self, work_ratio=0.0)

    def _without_units(self, gap: Gap) -> tuple[Array, Array]:
        """Return both components of the gap over their lengths."""
        return gap[0] / self.normal_length, np.clip(gap[1] / self.tangential_length, -MAX_SLIP, MAX_SLIP)


@checked
@dataclass(frozen=True)
class NormalCohesiveZone(NormalLaw):
    """Cohesive zone of the normal gap alone (Eq. 4.1). It has a potential.

    Parameters
    ----------
    work_of_separation
        Work of separation φn > 0, N/m.
    normal_length
        Characteristic length δn, nm.
    """

    @property
    def strength(self) -> float:
        """Largest traction φn/(e δn), GPa."""
        return float(self.work_of_separation / self.normal_length / np.e)

    @property
    def peak(self) -> float:
        """Gap up to which the traction rises, nm."""
        return self.normal_length

    def traction(self, gap: Gap) -> Array:
        """Return the traction (1, n), GPa, at a gap (1, n), nm."""
        return self.work_of_separation / self.normal_length * pull(gap / self.normal_length)[0]

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (1, n), GPa, and its derivative (1, 1, n), GPa/nm."""
        value, slope = pull(gap / self.normal_length)
        return self.work_of_separation / self.normal_length * value, self.stiffness * slope[None]

    def energy(self, gap: Gap) -> Array:
        """Return the potential -φn (1 + Δn/δn) exp(-Δn/δn) of shape (n,), N/m, at a gap (1, n), nm."""
        normal = gap[0] / self.normal_length
        inside = np.maximum(normal, -MAX_OVERLAP)
        beyond = normal - inside
        value, slope = pull(inside)
        return self.work_of_separation * (beyond * (value + beyond * slope / 2) - (1 + inside) * np.exp(-inside))


@checked
@dataclass(frozen=True)
class UncoupledCohesiveZone:
    """Cohesive zone with friction whose normal traction does not depend on the tangential gap (Eqs 4.1 and 2.17).

    The normal traction is that of Eq. 4.1, the tangential one that of Eq. 2.17, which decays with the normal gap. So it
    has no potential: ∂T_n/∂Δt is zero and ∂T_t/∂Δn is not.

    Parameters
    ----------
    work_of_separation
        Normal work of separation φn > 0, N/m.
    work_ratio
        Tangential over normal work of separation φt/φn > 0; without friction the law is `NormalCohesiveZone`.
    normal_length, tangential_length
        Characteristic lengths δn and δt, nm.
    """

    work_of_separation: Work
    work_ratio: Annotated[float, Only(f"{POSITIVE}; without friction, normal_cohesive_zone", is_positive)]
    normal_length: Length = 1.0
    tangential_length: Length = 1.0
    reads = frozenset({"n", "t"})
    exerts = frozenset({"n", "t"})
    traits = frozenset({Trait.SMOOTH, Trait.NON_CONSERVATIVE})

    @cached_property
    def _normal(self) -> NormalCohesiveZone:
        """Law of the normal traction."""
        return self.without_slip()

    @cached_property
    def _coupled(self) -> CohesiveZone:
        """Law of the tangential traction."""
        return CohesiveZone(self.work_of_separation, self.work_ratio, self.normal_length, self.tangential_length)

    @property
    def strength(self) -> float:
        """Largest normal traction φn/(e δn), GPa."""
        return self._normal.strength

    @property
    def stiffness(self) -> float:
        """Larger one of the two tangents at zero gap, GPa/nm."""
        return self._coupled.stiffness

    @property
    def interaction_range(self) -> float:
        """Length over which the normal traction changes, nm."""
        return self.normal_length

    def traction(self, gap: Gap) -> Array:
        """Return the traction (2, n), GPa, at a gap (2, n), nm."""
        traction = self._coupled.traction(gap)
        traction[:1] = self._normal.traction(gap[:1])
        return traction

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (2, n), GPa, and its derivatives by both components (2, 2, n), GPa/nm."""
        traction, derivative = self._coupled.tangent(gap)
        traction[:1], derivative[:1, :1] = self._normal.tangent(gap[:1])
        derivative[0, 1] = 0.0
        return traction, derivative

    def without_coupling(self) -> UncoupledCohesiveZone:
        """Return the law itself."""
        return self

    def without_slip(self) -> NormalCohesiveZone:
        """Return the law at zero tangential gap."""
        return NormalCohesiveZone(self.work_of_separation, self.normal_length)

    def without_friction(self) -> NormalCohesiveZone:
        """Return the law without tangential work of separation."""
        return self.without_slip()
