"""Laws that separate repulsion from adhesion: repulsion alone, with friction, and repulsion of its own stiffness.

The repulsion of Eq. 5.3 is proportional to the work of separation: weak adhesion is also a soft wall. `RepulsiveZone`
is this wall without the pull; `FrictionalRepulsiveZone` adds friction, so that contacts without adhesion may stick.
`StiffCohesiveZone` keeps the stiffness of its wall, whatever the work of separation.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy as np

from contactsim.grid import Array
from contactsim.interface.base import check_positive
from contactsim.interface.cohesive_zone import NormalCohesiveZone
from contactsim.interface.exponentials import MAX_SLIP
from contactsim.traits import Trait


@dataclass(frozen=True)
class RepulsiveZone:
    """Eq. 5.3 without its pull: the normal traction under overlap, and zero where the gap is open.

    The tangent jumps from φn/δn² to zero at zero gap. Strength, stiffness and range are those of the law with its pull,
    so that tolerances and criteria of contact mean the same traction.

    Parameters
    ----------
    work_of_separation
        Work φn > 0 of the law whose repulsion it is, N/m.
    normal_length
        Characteristic length δn, nm.
    """

    work_of_separation: float
    normal_length: float = 1.0
    reads = frozenset({"n"})
    exerts = frozenset({"n"})
    traits = frozenset({Trait.SMOOTH})
    tangential_length = inf

    def __post_init__(self) -> None:
        check_positive("N/m", work_of_separation=self.work_of_separation)
        check_positive("nm", normal_length=self.normal_length)

    @cached_property
    def _whole(self) -> NormalCohesiveZone:
        """The law with its pull."""
        return NormalCohesiveZone(self.work_of_separation, self.normal_length)

    @property
    def strength(self) -> float:
        """Largest traction φn/(e δn) of the law with its pull, GPa."""
        return self._whole.strength

    @property
    def stiffness(self) -> float:
        """Tangent φn/δn² where overlap begins, GPa/nm."""
        return self._whole.stiffness

    @property
    def interaction_range(self) -> float:
        """Length over which the traction changes, nm."""
        return self.normal_length

    def traction(self, gap: Array) -> Array:
        """Return the traction (1, n), GPa, at a gap (1, n), nm."""
        return np.where(gap < 0, self._whole.traction(gap), 0.0)

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Return the traction (1, n), GPa, and its derivative (1, 1, n), GPa/nm."""
        traction, derivative = self._whole.tangent(gap)
        return np.where(gap < 0, traction, 0.0), np.where(gap < 0, derivative, 0.0)

    def energy(self, gap: Array) -> Array:
        """Return the potential φn - φn (1 + Δn/δn) exp(-Δn/δn) under overlap, else zero, (n,), N/m."""
        return np.where(gap[0] < 0, self.work_of_separation + self._whole.energy(gap), 0.0)


@dataclass(frozen=True)
class FrictionalRepulsiveZone:
    """Repulsion without a pull, and friction in proportion to the pressure.

    The normal traction is that of `RepulsiveZone` and does not depend on the tangential gap. The tangential traction is

        T_t = μ p √(2e) (Δt/δt) exp(-Δt²/δt²)

    at a pressure p, at most μp. It depends on the tangential gap as Eq. 2.17 does, yet it is zero where the gap is open:
    Eq. 2.17 would hold surfaces together sideways that do not touch. There is no potential: ∂T_n/∂Δt is zero and
    ∂T_t/∂Δn is not.

    Parameters
    ----------
    work_of_separation
        Work φn > 0 of the law whose repulsion it is, N/m.
    friction_coefficient
        Largest tangential traction over the pressure, μ > 0.
    normal_length, tangential_length
        Characteristic lengths δn and δt, nm.
    """

    work_of_separation: float
    friction_coefficient: float
    normal_length: float = 1.0
    tangential_length: float = 1.0
    reads = frozenset({"n", "t"})
    exerts = frozenset({"n", "t"})
    traits = frozenset({Trait.SMOOTH, Trait.NON_CONSERVATIVE})

    def __post_init__(self) -> None:
        check_positive("N/m", work_of_separation=self.work_of_separation)
        check_positive("1", friction_coefficient=self.friction_coefficient)
        check_positive("nm", normal_length=self.normal_length, tangential_length=self.tangential_length)

    @cached_property
    def _wall(self) -> RepulsiveZone:
        """The law of the normal traction."""
        return self.without_slip()

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

    def traction(self, gap: Array) -> Array:
        """Return the traction (2, n), GPa, at a gap (2, n), nm."""
        normal = self._wall.traction(gap[:1])[0]
        return np.stack((normal, -normal * self._ratio(gap[1])[0]))

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Return the traction (2, n), GPa, and its derivatives by both components (2, 2, n), GPa/nm."""
        (normal,), ((slope,),) = self._wall.tangent(gap[:1])
        ratio, ratio_slope = self._ratio(gap[1])
        derivative = np.stack(((slope, np.zeros_like(slope)), (-slope * ratio, -normal * ratio_slope)))
        return np.stack((normal, -normal * ratio)), derivative

    def without_coupling(self) -> FrictionalRepulsiveZone:
        """Return the law itself."""
        return self

    def without_slip(self) -> RepulsiveZone:
        """Return the law at zero tangential gap."""
        return RepulsiveZone(self.work_of_separation, self.normal_length)

    def without_friction(self) -> RepulsiveZone:
        """Return the law without friction."""
        return self.without_slip()

    def _ratio(self, tangential_gap: Array) -> tuple[Array, Array]:
        """Return the tangential traction over the pressure, and its derivative, 1/nm."""
        slip = np.clip(tangential_gap / self.tangential_length, -MAX_SLIP, MAX_SLIP)
        size = self.friction_coefficient * np.sqrt(2 * np.e) * np.exp(-(slip**2))
        return size * slip, size * (1 - 2 * slip**2) / self.tangential_length


@dataclass(frozen=True)
class StiffCohesiveZone:
    """Cohesive zone whose repulsion keeps its stiffness as the work of separation falls.

    The traction is k Δn exp(-Δn/δn) under overlap and φn Δn/δn² exp(-Δn/δn) where the gap is open: continuous at zero
    gap, with a tangent that jumps from k to φn/δn². With k = φn/δn² it is Eq. 5.3. As φn → 0 it becomes repulsion
    alone, a `RepulsiveZone` of work k δn²; as k grows as well, the hard wall without adhesion of Chapter 3.

    Parameters
    ----------
    work_of_separation
        Work of separation φn > 0, N/m.
    contact_stiffness
        Stiffness k > 0 where overlap begins, GPa/nm.
    normal_length
        Characteristic length δn, nm.
    """

    work_of_separation: float
    contact_stiffness: float
    normal_length: float = 1.0
    reads = frozenset({"n"})
    exerts = frozenset({"n"})
    traits = frozenset({Trait.SMOOTH})
    tangential_length = inf

    def __post_init__(self) -> None:
        check_positive("N/m", work_of_separation=self.work_of_separation)
        check_positive("GPa/nm", contact_stiffness=self.contact_stiffness)
        check_positive("nm", normal_length=self.normal_length)

    @cached_property
    def _pull(self) -> NormalCohesiveZone:
        """The law where the gap is open."""
        return NormalCohesiveZone(self.work_of_separation, self.normal_length)

    @cached_property
    def _wall(self) -> RepulsiveZone:
        """The law under overlap."""
        return RepulsiveZone(self.contact_stiffness * self.normal_length**2, self.normal_length)

    @property
    def strength(self) -> float:
        """Largest pull φn/(e δn), GPa."""
        return self._pull.strength

    @property
    def stiffness(self) -> float:
        """Larger one of the tangents on both sides of zero gap, GPa/nm."""
        return max(self.contact_stiffness, self._pull.stiffness)

    @property
    def interaction_range(self) -> float:
        """Length over which the traction changes, nm."""
        return self.normal_length

    def traction(self, gap: Array) -> Array:
        """Return the traction (1, n), GPa, at a gap (1, n), nm."""
        return np.where(gap < 0, self._wall.traction(gap), self._pull.traction(gap))

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Return the traction (1, n), GPa, and its derivative (1, 1, n), GPa/nm; that of the pull at zero gap."""
        parts = zip(self._wall.tangent(gap), self._pull.tangent(gap), strict=True)
        traction, derivative = (np.where(gap < 0, wall, pull) for wall, pull in parts)
        return traction, derivative

    def energy(self, gap: Array) -> Array:
        """Return the potential (n,), N/m, at a gap (1, n), nm; -φn at zero gap."""
        return self._wall.energy(gap) + self._pull.energy(np.maximum(gap, 0.0))
