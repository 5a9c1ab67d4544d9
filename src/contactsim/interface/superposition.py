"""Several laws at one interface are one law: the sum of their tractions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from contactsim.grid import Array
from contactsim.interface.base import Law, potential
from contactsim.traits import Trait


@dataclass(frozen=True)
class Superposition:
    """Several laws as one: it reads and exerts what any of them does, and is as strong and stiff as all together."""

    laws: tuple[Law, ...]

    @cached_property
    def reads(self) -> frozenset[str]:
        """Components of the gap on which any of the laws depends."""
        return reduce(frozenset.union, (law.reads for law in self.laws))

    @cached_property
    def exerts(self) -> frozenset[str]:
        """Components of the traction that any of the laws exerts."""
        return reduce(frozenset.union, (law.exerts for law in self.laws))

    @cached_property
    def traits(self) -> frozenset[Trait]:
        """Traits that a solver must accept."""
        return reduce(frozenset.union, (law.traits for law in self.laws))

    @cached_property
    def strength(self) -> float:
        """Sum of the strengths, GPa."""
        return sum(law.strength for law in self.laws)

    @cached_property
    def stiffness(self) -> float:
        """Sum of the largest tangents, GPa/nm."""
        return sum(law.stiffness for law in self.laws)

    @cached_property
    def interaction_range(self) -> float:
        """Shortest length over which one of the laws changes with the normal gap, nm."""
        return min(law.interaction_range for law in self.laws)

    @cached_property
    def tangential_length(self) -> float:
        """Shortest length over which one of the laws changes with the tangential gap, nm."""
        return min(law.tangential_length for law in self.laws)

    def traction(self, gap: Array) -> Array:
        """Return the traction (exerts, n), GPa, at a gap (reads, n), nm."""
        total = np.zeros((len(self.exerts), gap.shape[1]))
        for law in self.laws:
            total[: len(law.exerts)] += law.traction(gap[: len(law.reads)])
        return total

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Return the traction (exerts, n), GPa, and its derivatives (exerts, reads, n), GPa/nm."""
        total = np.zeros((len(self.exerts), gap.shape[1]))
        derivatives = np.zeros((len(self.exerts), *gap.shape))
        for law in self.laws:
            rows, columns = len(law.exerts), len(law.reads)
            traction, derivative = law.tangent(gap[:columns])
            total[:rows] += traction
            derivatives[:rows, :columns] += derivative
        return total, derivatives

    def energy(self, gap: Array) -> Array:
        """Return the sum of the potentials (n,), N/m; each of the laws must have one."""
        return sum((potential(law, gap[: len(law.reads)]) for law in self.laws), np.zeros(gap.shape[1]))


def superpose(laws: tuple[Law, ...]) -> Law:
    """Return one law that acts as all of them together."""
    return laws[0] if len(laws) == 1 else Superposition(laws)
