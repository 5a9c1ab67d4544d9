"""What laws of the normal gap alone have in common."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from contactsim.arguments import Length, Work
from contactsim.traits import Trait


@dataclass(frozen=True)
class NormalLaw:
    """A work of separation and a length, and what follows from them.

    Parameters
    ----------
    work_of_separation
        Work of separation φn > 0, N/m.
    normal_length
        Characteristic length δn, nm.
    """

    work_of_separation: Work
    normal_length: Length = 1.0
    reads = frozenset({"n"})
    exerts = frozenset({"n"})
    traits = frozenset({Trait.SMOOTH})
    tangential_length = inf

    @property
    def stiffness(self) -> float:
        """Size of the tangent φn/δn² at zero gap, GPa/nm."""
        return self.work_of_separation / self.normal_length**2

    @property
    def interaction_range(self) -> float:
        """Length over which the traction changes, nm."""
        return self.normal_length
