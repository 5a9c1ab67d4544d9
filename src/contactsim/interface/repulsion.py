"""Laws that separate repulsion from adhesion: repulsion alone, and repulsion of its own stiffness.

The repulsion of Eq. 5.3 is proportional to the work of separation: weak adhesion is also a soft wall. `RepulsiveZone`
is this wall without the pull. `StiffCohesiveZone` keeps the stiffness of its wall, whatever the work of separation.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy as np

from contactsim.arguments import Gap, Length, Stiffness, Work, checked
from contactsim.grid import Array
from contactsim.interface.cohesive_zone import NormalCohesiveZone
from contactsim.interface.normal_law import NormalLaw
from contactsim.traits import Trait


@checked
@dataclass(frozen=True)
class RepulsiveZone(NormalLaw):
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

    @cached_property
    def _whole(self) -> NormalCohesiveZone:
        """The law with its pull."""
        return NormalCohesiveZone(self.work_of_separation, self.normal_length)

    @property
    def peak(self) -> float:
        """Gap up to which the traction rises, nm."""
        return 0.0

    @property
    def strength(self) -> float:
        """Largest traction φn/(e δn) of the law with its pull, GPa."""
        return self._whole.strength

    def traction(self, gap: Gap) -> Array:
        """Return the traction (1, n), GPa, at a gap (1, n), nm."""
        return np.where(gap < 0, self._whole.traction(gap), 0.0)

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (1, n), GPa, and its derivative (1, 1, n), GPa/nm."""
        traction, derivative = self._whole.tangent(gap)
        return np.where(gap < 0, traction, 0.0), np.where(gap < 0, derivative, 0.0)

    def energy(self, gap: Gap) -> Array:
        """Return the potential φn - φn (1 + Δn/δn) exp(-Δn/δn) under overlap, else zero, (n,), N/m."""
        return np.where(gap[0] < 0, self.work_of_separation + self._whole.energy(gap), 0.0)


@checked
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

    work_of_separation: Work
    contact_stiffness: Stiffness
    normal_length: Length = 1.0
    reads = frozenset({"n"})
    exerts = frozenset({"n"})
    traits = frozenset({Trait.SMOOTH})
    tangential_length = inf

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
    def peak(self) -> float:
        """Gap up to which the traction rises, nm."""
        return self.normal_length

    @property
    def stiffness(self) -> float:
        """Larger one of the tangents on both sides of zero gap, GPa/nm."""
        return max(self.contact_stiffness, self._pull.stiffness)

    @property
    def interaction_range(self) -> float:
        """Length over which the traction changes, nm."""
        return self.normal_length

    def traction(self, gap: Gap) -> Array:
        """Return the traction (1, n), GPa, at a gap (1, n), nm."""
        return np.where(gap < 0, self._wall.traction(gap), self._pull.traction(gap))

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (1, n), GPa, and its derivative (1, 1, n), GPa/nm; that of the pull at zero gap."""
        parts = zip(self._wall.tangent(gap), self._pull.tangent(gap), strict=True)
        traction, derivative = (np.where(gap < 0, wall, pull) for wall, pull in parts)
        return traction, derivative

    def energy(self, gap: Gap) -> Array:
        """Return the potential (n,), N/m, at a gap (1, n), nm; -φn at zero gap."""
        return self._wall.energy(gap) + self._pull.energy(np.maximum(gap, 0.0))
