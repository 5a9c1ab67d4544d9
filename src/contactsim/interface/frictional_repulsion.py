"""Laws with repulsion of its own stiffness that have friction: without adhesion, and with a mixed-mode pull."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contactsim.arguments import Gap, Length, NotNegative, Stiffness, Work, checked
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.interface.cohesive_zone import CohesiveZone
from contactsim.interface.exponentials import MAX_SLIP
from contactsim.interface.repulsion import RepulsiveZone, StiffCohesiveZone
from contactsim.traits import Trait


@checked
@dataclass(frozen=True)
class FrictionalRepulsiveZone:
    """Repulsion without a pull, and friction in proportion to the pressure.

    The normal traction is that of `RepulsiveZone` and does not depend on the tangential gap. The tangential traction is

        T_t = μ p √(2e) (Δt/δt) exp(-Δt²/δt²)

    at a pressure p, at most μp. It depends on the tangential gap as Eq. 2.17 does, yet it is zero where the gap is
    open: Eq. 2.17 would hold surfaces together sideways that do not touch. There is no potential: ∂T_n/∂Δt is zero and
    ∂T_t/∂Δn is not.

    Parameters
    ----------
    work_of_separation
        Work φn > 0 of the law whose repulsion it is, N/m.
    friction_coefficient
        Largest tangential traction over the pressure, μ ≥ 0.
    normal_length, tangential_length
        Characteristic lengths δn and δt, nm.
    """

    work_of_separation: Work
    friction_coefficient: NotNegative = 0.0
    normal_length: Length = 1.0
    tangential_length: Length = 1.0
    reads = frozenset({"n", "t"})
    traits = frozenset({Trait.SMOOTH, Trait.NON_CONSERVATIVE})

    @cached_property
    def _wall(self) -> RepulsiveZone:
        """The law of the normal traction."""
        return self.without_slip()

    @property
    def exerts(self) -> frozenset[str]:
        """Normal traction, and tangential traction where the coefficient is not zero."""
        return frozenset({"n", "t"} if self.friction_coefficient else {"n"})

    @property
    def strength(self) -> float:
        """Largest traction φn/(e δn) of the law with its pull, GPa."""
        return self._wall.strength

    @property
    def stiffness(self) -> float:
        """Tangent φn/δn² where overlap begins, GPa/nm; friction begins there, with a tangent of zero."""
        return self._wall.stiffness

    @property
    def interaction_range(self) -> float:
        """Length over which the normal traction changes, nm."""
        return self.normal_length

    def traction(self, gap: Gap) -> Array:
        """Return the traction (1 or 2, n), GPa, at a gap (2, n), nm."""
        normal = self._wall.traction(gap[:1])[0]
        return np.stack((normal, -normal * self._ratio(gap[1])[0]))[: len(self.exerts)]

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (1 or 2, n), GPa, and its derivatives by both components (1 or 2, 2, n), GPa/nm."""
        (normal,), ((slope,),) = self._wall.tangent(gap[:1])
        ratio, ratio_slope = self._ratio(gap[1])
        derivative = np.stack(((slope, np.zeros_like(slope)), (-slope * ratio, -normal * ratio_slope)))
        return np.stack((normal, -normal * ratio))[: len(self.exerts)], derivative[: len(self.exerts)]

    def without_coupling(self) -> FrictionalRepulsiveZone:
        """Return the law itself: its normal traction does not depend on the tangential gap."""
        return self

    def without_slip(self) -> RepulsiveZone:
        """Return the law at zero tangential gap."""
        return RepulsiveZone(self.work_of_separation, self.normal_length)

    def without_friction(self) -> RepulsiveZone:
        """Return the law without friction."""
        return self.without_slip()

    def _ratio(self, tangential_gap: Gap) -> tuple[Array, Array]:
        """Return the tangential traction over the pressure, and its derivative, 1/nm."""
        slip = np.clip(tangential_gap / self.tangential_length, -MAX_SLIP, MAX_SLIP)
        size = self.friction_coefficient * np.sqrt(2 * np.e) * np.exp(-(slip**2))
        return size * slip, size * (1 - 2 * slip**2) / self.tangential_length


@checked
@dataclass(frozen=True)
class StiffMixedZone:
    """Mixed-mode cohesive zone whose repulsion keeps its stiffness as both works of separation fall.

    Where the gap is open the normal traction is that of Eq. 2.17. Under overlap it is k Δn exp(-Δn/δn), whatever the
    tangential gap is. The tangential traction is that of Eq. 2.17. As φn → 0 at a fixed ratio of works it becomes
    repulsion alone, without friction.

    Parameters
    ----------
    work_of_separation
        Normal work of separation φn > 0, N/m.
    contact_stiffness
        Stiffness k > 0 where overlap begins, GPa/nm.
    work_ratio
        Tangential over normal work of separation φt/φn ≥ 0.
    normal_length, tangential_length
        Characteristic lengths δn and δt, nm.
    """

    work_of_separation: Work
    contact_stiffness: Stiffness
    work_ratio: NotNegative = 0.0
    normal_length: Length = 1.0
    tangential_length: Length = 1.0
    reads = frozenset({"n", "t"})
    traits = frozenset({Trait.SMOOTH, Trait.NON_CONSERVATIVE})

    @cached_property
    def _open(self) -> CohesiveZone:
        """The law where the gap is open."""
        return CohesiveZone(self.work_of_separation, self.work_ratio, self.normal_length, self.tangential_length)

    @cached_property
    def _wall(self) -> RepulsiveZone:
        """The law of the normal traction under overlap."""
        return RepulsiveZone(self.contact_stiffness * self.normal_length**2, self.normal_length)

    @property
    def exerts(self) -> frozenset[str]:
        """Normal traction, and tangential traction if there is tangential work of separation."""
        return self._open.exerts

    @property
    def strength(self) -> float:
        """Largest pull φn/(e δn), GPa."""
        return self._open.strength

    @property
    def stiffness(self) -> float:
        """Largest one of the tangents about zero gap, GPa/nm."""
        return max(self.contact_stiffness, self._open.stiffness)

    @property
    def interaction_range(self) -> float:
        """Length over which the normal traction changes, nm."""
        return self.normal_length

    def traction(self, gap: Gap) -> Array:
        """Return the traction (1 or 2, n), GPa, at a gap (2, n), nm."""
        traction = self._open.traction(gap)
        traction[0] = np.where(gap[0] < 0, self._wall.traction(gap[:1])[0], traction[0])
        return traction

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (1 or 2, n), GPa, and its derivatives by both components (1 or 2, 2, n), GPa/nm."""
        traction, derivative = self._open.tangent(gap)
        wall, (slope,) = self._wall.tangent(gap[:1])
        overlaps = gap[0] < 0
        traction[0] = np.where(overlaps, wall[0], traction[0])
        derivative[0] = np.where(overlaps, np.concatenate((slope, np.zeros_like(slope))), derivative[0])
        return traction, derivative

    def without_coupling(self) -> StiffCohesiveZone:
        """Return the law whose normal traction does not depend on the tangential gap, where there is no friction."""
        if self.work_ratio:
            raise InputError("neglect", "coupling", "left out: no law of this wall has friction without it")
        return self.without_slip()

    def without_slip(self) -> StiffCohesiveZone:
        """Return the law at zero tangential gap."""
        return StiffCohesiveZone(self.work_of_separation, self.contact_stiffness, self.normal_length)

    def without_friction(self) -> StiffMixedZone:
        """Return the law without tangential work of separation."""
        return replace(self, work_ratio=0.0)
