"""Pairing of the points of two surfaces: the protocol, and the pairing of points that stay aligned."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Protocol

from contactsim.arguments import Gap, Heights, checked
from contactsim.elasticity.base import Elasticity
from contactsim.grid import Array
from contactsim.interface.base import Law
from contactsim.traits import Trait


class Pairing(Protocol):
    """A rule by which points of two surfaces act on each other."""

    @property
    def lattice_constant(self) -> float:
        """Distance along x after which the interaction repeats itself, nm; infinite if it never does."""

    def check(
        self, lower: Elasticity | None, upper: Elasticity | None, traits: frozenset[Trait], laws: tuple[Law, ...]
    ) -> None:
        """Raise an `InputError` for bodies (None is rigid) or effects that cannot be paired so."""

    def join(self, law: Law, lower: Heights, length: float) -> Law:
        """Return the law between two surfaces.

        Parameters
        ----------
        law
            The law between two points.
        lower
            Heights of the lower surface (n,), nm, positive towards the upper one.
        length
            Period along x, nm.
        """

    def offset(self, gap: Gap) -> Array:
        """Return the tangential gap (n,), nm, between points that face each other; gap: (2, n), nm."""


@checked
@dataclass(frozen=True)
class Aligned:
    """Each point faces the point that was opposite in the beginning."""

    lattice_constant = inf

    def check(
        self, lower: Elasticity | None, upper: Elasticity | None, traits: frozenset[Trait], laws: tuple[Law, ...]
    ) -> None:
        """Accept every scene."""

    def join(self, law: Law, lower: Heights, length: float) -> Law:
        """Return the law itself."""
        return law

    def offset(self, gap: Gap) -> Array:
        """Return the tangential gap itself (n,), nm."""
        return gap[1]


ALIGNED = Aligned()
