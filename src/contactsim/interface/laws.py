"""What acts at the interface, one small frozen class each.

Effects add: a scene lists them and the traction is their sum. The hard wall is the limit of infinite stiffness: not a
traction as a function of the gap but an inequality, whose pressure is an unknown. A law gives the traction at each
point from the gap there. Normal traction is positive where it pulls the bodies together; tangential traction is
positive where it opposes a positive tangential gap.

The mixed-mode law (Eq. 2.17) has no potential: the cross derivatives of its two tractions differ by

    (2 Δt/(δn δt²)) exp(-Δn/δn - Δt²/δt²) (φt - φn Δn/δn),

so nothing that minimises an energy can solve it. Its repulsion scales with the work of separation as well, so a work
that tends to zero is no contact, not a hard wall. Below OVERCLOSED characteristic lengths the dependence on Δn, whose
exponential would overflow at a bad first guess, is continued by its tangent; no solution of physical interest gets
there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from contactsim.errors import SceneError, is_number
from contactsim.grid import Array
from contactsim.traits import Trait

OVERCLOSED = 10.0
"""Overlap, in characteristic lengths, beyond which a law is continued by its tangent."""
SLIPPED = 30.0
"""Tangential gap, in characteristic lengths, beyond which exp(-y²), zero to all digits, is taken there."""


class Law(Protocol):
    """One effect given as traction against gap, point by point.

    reads, exerts: components of the gap it depends on and of the traction it exerts; strength (GPa) and stiffness
    (GPa/nm): the largest pull and the largest tangent, by which tolerances and steps are measured;
    interaction_range (nm): the length over which it changes, normal.
    """

    reads: frozenset[str]
    exerts: frozenset[str]
    traits: frozenset[Trait]
    strength: float
    stiffness: float
    interaction_range: float

    def traction(self, gap: Array) -> Array:
        """Traction (exerts, n), GPa, at a gap (reads, n), nm; rows in the order n, t."""
        ...

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Traction (exerts, n), GPa, and its derivatives (exerts, reads, n), GPa/nm."""
        ...

    def without_coupling(self) -> Law:
        """What it is where nothing slips: it neither reads nor exerts anything tangential."""
        ...

    def without_friction(self) -> Law:
        """The same without tangential work."""
        ...


@dataclass(frozen=True)
class HardWall:
    """Impenetrability (Section 2.3): gap ≥ 0, pressure ≥ 0, and one of them zero at each point."""

    reads = frozenset({"n"})
    exerts = frozenset({"n"})
    traits = frozenset({Trait.WALL})

    def without_coupling(self) -> HardWall:
        """Itself, as it reads the normal gap alone."""
        return self

    def without_friction(self) -> HardWall:
        """Itself, as it has none."""
        return self


@dataclass(frozen=True)
class CohesiveZone:
    """Mixed-mode cohesive zone (Eq. 2.17), after McGarry et al., J. Mech. Phys. Solids 63 (2014).

    work_of_separation φn > 0 in N/m; work_ratio c = φt/φn ≥ 0 (Eq. 2.16); normal_length δn, tangential_length δt in nm.
    At c = 0 it is frictionless: it exerts no shear, yet its normal traction reads the tangential gap.
    """

    work_of_separation: float
    work_ratio: float = 0.0
    normal_length: float = 1.0
    tangential_length: float = 1.0
    reads = frozenset({"n", "t"})

    def __post_init__(self) -> None:
        _check_positive(self, "work_of_separation", "normal_length", "tangential_length")
        if not (is_number(self.work_ratio) and self.work_ratio >= 0):
            raise SceneError("work_ratio", self.work_ratio, "0 or a positive number")

    @property
    def tangential_work(self) -> float:
        """Tangential work of separation φt, N/m."""
        return self.work_ratio * self.work_of_separation

    @property
    def exerts(self) -> frozenset[str]:
        """Normal traction, and tangential traction where there is work to be done."""
        return frozenset({"n", "t"} if self.tangential_work else {"n"})

    @property
    def traits(self) -> frozenset[Trait]:
        """A smooth law without a potential."""
        return frozenset({Trait.SMOOTH, Trait.NON_CONSERVATIVE})

    @property
    def strength(self) -> float:
        """Largest normal traction φn/(e δn) (Eq. 2.18), GPa."""
        return self.work_of_separation / self.normal_length / np.e

    @property
    def stiffness(self) -> float:
        """Largest tangent of the two at zero gap, GPa/nm."""
        return max(
            self.work_of_separation / self.normal_length**2, 2 * self.tangential_work / self.tangential_length**2
        )

    @property
    def interaction_range(self) -> float:
        """Length over which the normal traction changes, nm."""
        return self.normal_length

    def traction(self, gap: Array) -> Array:
        """Traction (1 or 2, n), GPa, at a gap (2, n), nm."""
        normal, tangential = self._without_units(gap)
        shear = np.exp(-(tangential**2))
        pull = self.work_of_separation / self.normal_length * _pull(normal)[0] * shear
        if not self.tangential_work:
            return pull[None]
        size = 2 * self.tangential_work / self.tangential_length
        return np.stack((pull, size * tangential * _decay(normal)[0] * shear))

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Traction (1 or 2, n), GPa, and its derivatives by both components (1 or 2, 2, n), GPa/nm."""
        normal, tangential = self._without_units(gap)
        shear = np.exp(-(tangential**2))
        pull, slope = _pull(normal)
        size = self.work_of_separation / self.normal_length
        traction = np.empty((len(self.exerts), gap.shape[1]))
        derivative = np.empty((len(self.exerts), *gap.shape))
        traction[0] = size * pull * shear
        derivative[0, 0] = size / self.normal_length * slope * shear
        derivative[0, 1] = -2 / self.tangential_length * tangential * traction[0]
        if self.tangential_work:
            decay, slope = _decay(normal)
            size = 2 * self.tangential_work / self.tangential_length
            traction[1] = size * tangential * decay * shear
            derivative[1, 0] = size / self.normal_length * tangential * slope * shear
            derivative[1, 1] = size / self.tangential_length * (1 - 2 * tangential**2) * decay * shear
        return traction, derivative

    def without_coupling(self) -> NormalCohesiveZone:
        """What it is where there is no tangential gap."""
        return NormalCohesiveZone(self.work_of_separation, self.normal_length)

    def without_friction(self) -> CohesiveZone:
        """The same without tangential work."""
        return replace(self, work_ratio=0.0)

    def _without_units(self, gap: Array) -> tuple[Array, Array]:
        """Both components of the gap over their lengths."""
        return gap[0] / self.normal_length, np.clip(gap[1] / self.tangential_length, -SLIPPED, SLIPPED)


@dataclass(frozen=True)
class NormalCohesiveZone:
    """Cohesive zone of the normal gap alone, uncoupled (Eq. 4.1).

    work_of_separation φn > 0 in N/m, normal_length δn in nm. It has a potential.
    """

    work_of_separation: float
    normal_length: float = 1.0
    reads = frozenset({"n"})
    exerts = frozenset({"n"})
    traits = frozenset({Trait.SMOOTH})

    def __post_init__(self) -> None:
        _check_positive(self, "work_of_separation", "normal_length")

    @property
    def strength(self) -> float:
        """Largest traction φn/(e δn), GPa."""
        return self.work_of_separation / self.normal_length / np.e

    @property
    def stiffness(self) -> float:
        """Tangent at zero gap φn/δn², GPa/nm."""
        return self.work_of_separation / self.normal_length**2

    @property
    def interaction_range(self) -> float:
        """Length over which the traction changes, nm."""
        return self.normal_length

    def traction(self, gap: Array) -> Array:
        """Traction (1, n), GPa, at a gap (1, n), nm."""
        return self.work_of_separation / self.normal_length * _pull(gap / self.normal_length)[0]

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Traction (1, n), GPa, and its derivative (1, 1, n), GPa/nm."""
        pull, slope = _pull(gap / self.normal_length)
        return self.work_of_separation / self.normal_length * pull, self.stiffness * slope[None]

    def without_coupling(self) -> NormalCohesiveZone:
        """Itself, as it reads the normal gap alone."""
        return self

    def without_friction(self) -> NormalCohesiveZone:
        """Itself, as it has none."""
        return self

    def energy(self, gap: Array) -> Array:
        """Potential of the traction (n,), N/m, zero far apart: -φn (1 + Δn/δn) exp(-Δn/δn)."""
        normal = gap[0] / self.normal_length
        inside = np.maximum(normal, -OVERCLOSED)
        beyond = normal - inside
        pull, slope = _pull(inside)
        return self.work_of_separation * (beyond * (pull + beyond * slope / 2) - (1 + inside) * np.exp(-inside))


def _decay(normal: Array) -> tuple[Array, Array]:
    """exp(-y), below -OVERCLOSED its tangent there; and its derivative."""
    inside = np.maximum(normal, -OVERCLOSED)
    decay = np.exp(-inside)
    return decay * (1 + (inside - normal)), -decay


def _pull(normal: Array) -> tuple[Array, Array]:
    """Traction y exp(-y), below -OVERCLOSED its tangent there; and its derivative."""
    inside = np.maximum(normal, -OVERCLOSED)
    decay = np.exp(-inside)
    slope = (1 - inside) * decay
    return inside * decay + (normal - inside) * slope, slope


def _check_positive(law: object, *names: str) -> None:
    for name in names:
        value = getattr(law, name)
        if not (is_number(value) and value > 0):
            unit = "N/m" if name == "work_of_separation" else "nm"
            raise SceneError(name, value, f"a positive, finite number in {unit}")


EFFECTS = {"hard_wall": HardWall, "cohesive_zone": CohesiveZone, "normal_cohesive_zone": NormalCohesiveZone}
