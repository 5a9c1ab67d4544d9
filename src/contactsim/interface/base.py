"""Protocols of what acts at an interface: effects, laws, laws that read the slip, laws with an energy.

Effects add: a scene lists them, and the traction is their sum. A law gives the traction at each point from the gap at
that point. Normal traction is positive where it pulls the bodies together; tangential traction is positive where it
opposes a positive tangential gap. A new law is one class with these attributes and one line in `registry`.
"""

from __future__ import annotations

from typing import Protocol, TypeGuard, cast

import numpy as np

from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.traits import Trait

PULL_RANGE = 10.0
"""Gap, in a law's lengths, up to which a pull is looked for."""
DEEPEST_OVERLAP = 100.0
"""Overlap, in a law's lengths, under which it bears any pressure that a scene may have."""


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


def borne_pressure(law: Law) -> float:
    """Return the pressure (GPa) that a law bears without slip, under an overlap of 100 of its lengths."""
    gap = np.zeros((len(law.reads), 1))
    gap[0] = -DEEPEST_OVERLAP * law.interaction_range
    return -float(law.traction(gap)[0, 0])


def pulls(law: Law) -> bool:
    """Return True if a law pulls surfaces together somewhere within ten of its lengths, without slip."""
    gap = np.zeros((len(law.reads), 64))
    gap[0] = np.linspace(0.0, PULL_RANGE, 64) * law.interaction_range
    return bool((law.traction(gap)[0] > 0).any())


def has_peak(law: Law) -> bool:
    """Return True for laws that tell their `peak`: the gap (nm) up to which the traction rises, and then falls."""
    return all(getattr(part, "peak", None) is not None for part in _parts(law))


def rising_part(law: Law, gap: Array) -> tuple[Array, Array]:
    """Return the part of a law's traction that rises with the normal gap, and its derivative; see `Law.tangent`.

    The rest falls. The law, or each of those that it consists of, must tell its peak.
    """
    rising, slope = np.zeros(gap.shape), np.zeros((1, *gap.shape))
    for part in _parts(law):
        peak = part.peak  # type: ignore[attr-defined]
        traction, derivative = part.tangent(np.minimum(gap, peak))
        rising += traction
        slope += np.where(gap < peak, np.maximum(derivative, 0.0), 0.0)
    return rising, slope


def _parts(law: Law) -> tuple[Law, ...]:
    """Return the laws that a law is the sum of."""
    parts: tuple[Law, ...] = getattr(law, "laws", (law,))
    return parts
