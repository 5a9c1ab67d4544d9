"""Protocols of what acts at an interface: effects, laws, laws that read the slip, laws with an energy.

Effects add: a scene lists them, and the traction is their sum. A law gives the traction at each point from the gap at
that point. Normal traction is positive where it pulls the bodies together; tangential traction is positive where it
opposes a positive tangential gap. A new law is one class with these attributes and one line in `registry`.
"""

from __future__ import annotations

from typing import Protocol, TypeGuard, cast

from contactsim.errors import POSITIVE, InputError, is_positive
from contactsim.grid import Array
from contactsim.traits import Trait


class Effect(Protocol):
    """Something that acts at the interface: a law, or the inequality of a hard wall."""

    @property
    def reads(self) -> frozenset[str]:
        """Components of the gap on which it depends: of `n` and `t`."""

    @property
    def exerts(self) -> frozenset[str]:
        """Components of the traction that it exerts."""

    @property
    def traits(self) -> frozenset[Trait]:
        """Traits that a solver must accept."""


class Law(Effect, Protocol):
    """An effect that gives the traction as a smooth function of the gap."""

    @property
    def strength(self) -> float:
        """Largest normal traction, GPa: tolerances are measured in it."""

    @property
    def stiffness(self) -> float:
        """Largest tangent without overlap, GPa/nm: steps are measured in it."""

    @property
    def interaction_range(self) -> float:
        """Shortest length over which the traction changes with the normal gap, nm."""

    @property
    def tangential_length(self) -> float:
        """Shortest length over which the traction changes with the tangential gap, nm; infinite if it does not."""

    def traction(self, gap: Array) -> Array:
        """Return the traction (exerts, n), GPa, at a gap (reads, n), nm; rows in the order n, t."""

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Return the traction (exerts, n), GPa, and its derivatives (exerts, reads, n), GPa/nm."""


class TangentialLaw(Law, Protocol):
    """A law that reads the tangential gap."""

    def without_coupling(self) -> Law:
        """Return the law whose normal traction does not depend on the tangential gap; friction remains as it is."""

    def without_slip(self) -> Law:
        """Return the law where the surfaces do not slip: it neither reads nor exerts anything tangential."""

    def without_friction(self) -> Law:
        """Return the law without tangential work of separation."""


class ConservativeLaw(Law, Protocol):
    """A law whose traction is the derivative of a potential."""

    def energy(self, gap: Array) -> Array:
        """Return the potential (n,), N/m, at a gap (reads, n), nm; zero where the surfaces are far apart."""


def reads_slip(effect: Effect) -> TypeGuard[TangentialLaw]:
    """Return True if an effect reads the tangential gap."""
    return "t" in effect.reads


def potential(law: Law, gap: Array) -> Array:
    """Return the potential (n,), N/m, of a law that has one, at a gap (reads, n), nm.

    Raises
    ------
    InputError
        If the law has no potential.
    """
    if Trait.NON_CONSERVATIVE in law.traits:
        raise InputError("effects", law, "laws with a potential, where an energy is asked for")
    return cast(ConservativeLaw, law).energy(gap)


def check_positive(unit: str, **values: float) -> None:
    """Refuse parameters of a law that are not positive, finite numbers; the unit is quoted."""
    for name, value in values.items():
        if not is_positive(value):
            raise InputError(name, value, f"{POSITIVE}, in {unit}")
