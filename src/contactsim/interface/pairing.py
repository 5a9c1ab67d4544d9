"""Which site faces which: aligned, or windowed, by springs between two lattices (Eqs 6.1-6.6).

Aligned, each point of one surface faces the same point of the other for ever. Lattice, a site of the upper surface
that has moved by Δt pulls and pushes all sites of the rigid lower lattice within a window, each by the law between the
two: the sum repeats itself after a lattice constant l, so that contacts broken by sliding are made anew, around the
periodic cell as well.

The lattice is physical and not the mesh. Where the mesh is finer or coarser, each of its points stands for sites that
face the lower lattice as the sites there do: opposite when nothing has moved. A law's traction counts once for each
spring, as in the thesis (`weight` 1): with l below the tangential length many add up, and their tangential parts
cancel. Springs cost time in proportion to points in normal range times sites in the window.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from contactsim.elasticity.solids import Elasticity
from contactsim.errors import SceneError, is_number
from contactsim.grid import Array
from contactsim.interface.laws import Law
from contactsim.interface.superposition import Superposition
from contactsim.traits import Trait

MOST = 100000
"""Most sites on each side of a window."""
PHASES = 33
"""Positions over half a lattice constant among which the strongest is looked for."""


@dataclass(frozen=True)
class LatticeInteraction:
    """A law between sites within a window, as one law of the gap to the site opposite when nothing has moved.

    law: of each spring; offsets: of the sites from the nearest one, in lattice constants (sites,); spacing: lattice
    constant, nm; depth: normal gap (nm) beyond which there is no spring; lower: heights of the rigid lower surface
    (n,), nm, positive towards the upper one, None where it is flat; length: period, nm.
    """

    law: Law | Superposition
    offsets: Array = field(repr=False)
    spacing: float
    normal_cutoff: float
    weight: float
    lower: Array | None = field(repr=False)
    length: float

    @property
    def reads(self) -> frozenset[str]:
        """Components of the gap that it depends on."""
        return self.law.reads

    @property
    def exerts(self) -> frozenset[str]:
        """Components of the traction that it exerts."""
        return self.law.exerts

    @property
    def traits(self) -> frozenset[Trait]:
        """What a solver must accept."""
        return self.law.traits

    @cached_property
    def _crowd(self) -> float:
        """How many springs pull as one, where most do, times the weight."""
        phases = np.linspace(0.0, 0.5, PHASES)
        gap = np.full((len(self.reads), PHASES * len(self.offsets)), self.law.interaction_range)
        gap[1:] = self.spacing * (phases - self.offsets[:, None]).ravel()
        alone = self.law.traction(np.array([[self.law.interaction_range], [0.0]])[: len(self.reads)])[0, 0]
        sums = self.law.traction(gap)[0].reshape(len(self.offsets), -1).sum(0)
        return self.weight * float(sums.max() / alone)

    @property
    def strength(self) -> float:
        """Largest normal traction of all springs of a site, GPa."""
        return self._crowd * self.law.strength

    @property
    def stiffness(self) -> float:
        """About the largest tangent, GPa/nm."""
        return self._crowd * self.law.stiffness

    @property
    def interaction_range(self) -> float:
        """Shortest length over which it changes, nm."""
        return min(self.law.interaction_range, getattr(self.law, "tangential_length", math.inf))

    @property
    def tangential_length(self) -> float:
        """Shortest tangential length, nm."""
        return self.law.tangential_length

    def facing(self, gap: Array) -> Array:
        """Which site of the lower lattice, counted from the one opposite without a slide, is nearest: (n,)."""
        return np.rint(gap[1] / self.spacing) if len(gap) > 1 else np.zeros(gap.shape[1])

    def offset(self, gap: Array) -> Array:
        """Tangential gap (n,), nm, to the nearest site; gap: (2, n)."""
        return gap[1] - self.spacing * self.facing(gap)

    def traction(self, gap: Array) -> Array:
        """Traction (exerts, n), GPa, at a gap (reads, n), nm."""
        near, each = self._each(gap)
        return self._summed(self.law.traction(each), near, gap.shape[1])

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Traction (exerts, n), GPa, and its derivatives (exerts, reads, n), GPa/nm."""
        near, each = self._each(gap)
        parts = self.law.tangent(each)
        return tuple(self._summed(part, near, gap.shape[1]) for part in parts)

    def energy(self, gap: Array) -> Array:
        """Sum of the springs' potentials (n,), N/m, of laws that have one."""
        near, each = self._each(gap)
        return self._summed(self.law.energy(each), near, gap.shape[1])

    def reaction(self, gap: Array) -> Array:
        """What the lower surface feels (exerts, n), GPa, on the mesh: at each site the opposite of its springs.

        Sites between points of the mesh are shared among these by Fourier's interpolation.
        """
        near, each = self._each(gap)
        pulls = self.weight * self.law.traction(each).reshape(len(self.exerts), len(self.offsets), -1)
        sites = (self.facing(gap)[near] + self.offsets[:, None]).astype(int)
        felt = np.zeros((len(self.exerts), gap.shape[1]))
        for site in np.unique(sites):
            here = np.zeros_like(felt)
            here[:, near] = (pulls * (sites == site)).sum(1)
            felt -= self._moved(here, site)
        return felt

    def _each(self, gap: Array) -> tuple[Array, Array]:
        """Points with springs (near,), and the gap of each of these (reads, sites × near)."""
        lowest = gap[0] if self.lower is None else gap[0] + self.lower - self.lower.max()
        near = np.flatnonzero(lowest <= self.normal_cutoff)
        each = np.empty((len(gap), len(self.offsets), near.size))
        first = self.facing(gap)[near]
        each[0] = gap[0, near]
        if self.lower is not None:
            each[0] += self._opened(near, first + self.offsets[:, None])
        each[1:] = gap[1:, None, near] - self.spacing * (first + self.offsets[:, None])
        return near, each.reshape(len(gap), -1)

    def _summed(self, parts: Array, near: Array, points: int) -> Array:
        """Sum over the springs of each point: (…, points) of (…, sites × near)."""
        out = np.zeros((*parts.shape[:-1], points))
        out[..., near] = self.weight * parts.reshape(*parts.shape[:-1], len(self.offsets), -1).sum(-2)
        return out

    def _opened(self, near: Array, sites: Array) -> Array:
        """By how much (nm) the gap to each site (sites, near) is wider than to the one opposite without a slide."""
        opened = np.empty(sites.shape)
        for site in np.unique(sites):
            rows, columns = np.nonzero(sites == site)
            here = near[columns]
            opened[rows, columns] = (self.lower - self._moved(self.lower, -site))[here]
        return opened

    def _moved(self, values: Array, sites: float) -> Array:
        """Values (…, n) along x by some lattice constants."""
        steps = sites * self.spacing / self.length * values.shape[-1]
        if abs(steps - round(steps)) < 1e-9 * max(abs(steps), 1.0):
            return np.roll(values, round(steps), -1)
        waves = np.arange(values.shape[-1] // 2 + 1)
        turned = np.fft.rfft(values) * np.exp(-2j * np.pi * waves * steps / values.shape[-1])
        return np.fft.irfft(turned, values.shape[-1])


class Pairing(Protocol):
    """How points of two surfaces are joined."""

    def check(self, lower: Elasticity | None, upper: Elasticity | None, traits: frozenset[Trait]) -> None:
        """SceneError for bodies and laws that cannot be joined so."""
        ...

    def joined(self, law: Law | Superposition, lower: Array, length: float) -> Law | Superposition | LatticeInteraction:
        """The law between the surfaces; lower: heights of the lower one (n,), length: period, nm."""
        ...


@dataclass(frozen=True)
class Aligned:
    """Each point faces the one that was opposite in the beginning."""

    def check(self, lower: Elasticity | None, upper: Elasticity | None, traits: frozenset[Trait]) -> None:
        """Any scene can be joined so."""

    def joined(self, law: Law | Superposition, lower: Array, length: float) -> Law | Superposition:
        """The law itself."""
        return law


@dataclass(frozen=True)
class Lattice:
    """Springs from each site of the upper surface to those of a rigid lattice below, within cutoffs (Eqs 6.2-6.3).

    lattice_constant: l, nm; tangential_cutoff: in the law's tangential length (thesis 5); normal_cutoff: in its normal
    length, beyond which there is none (thesis 10, at which the law still jumps by 1e-3 of its strength); weight: of
    each spring, 1 in the thesis. The window holds the nearest site and whole numbers of further ones, at most `MOST`.
    """

    lattice_constant: float
    tangential_cutoff: float = 5.0
    normal_cutoff: float = 40.0
    weight: float = 1.0

    def __post_init__(self) -> None:
        units = {
            "lattice_constant": "nm",
            "tangential_cutoff": "tangential lengths",
            "normal_cutoff": "normal lengths",
            "weight": "parts",
        }
        for name, unit in units.items():
            value = getattr(self, name)
            least = "0 or more" if name == "tangential_cutoff" else "above 0"
            if not (is_number(value) and (value >= 0 if name == "tangential_cutoff" else value > 0)):
                raise SceneError(name, value, f"a finite number {least}, in {unit}")

    def check(self, lower: Elasticity | None, upper: Elasticity | None, traits: frozenset[Trait]) -> None:
        """SceneError unless the lower body is rigid, the contact a line and the laws smooth."""
        if lower is not None:
            allowed = "a rigid lower body: sites that are displaced on both sides are not modelled"
            raise SceneError("pairing", "lattice", allowed)
        if not {Trait.LINE, Trait.SMOOTH} <= traits or Trait.WALL in traits:
            raise SceneError("pairing", "lattice", "aligned, or smooth laws on a line: springs are laws between sites")

    def joined(self, law: Law | Superposition, lower: Array, length: float) -> LatticeInteraction:
        """The springs as one law."""
        beyond = math.ceil(
            self.tangential_cutoff * getattr(law, "tangential_length", law.interaction_range) / self.lattice_constant
        )
        if beyond > MOST:
            raise SceneError(
                "tangential_cutoff", self.tangential_cutoff, f"one of at most {MOST} sites on each side, not {beyond}"
            )
        offsets = np.arange(-beyond, beyond + 1.0)
        heights = None if np.ptp(lower) == 0 else lower
        return LatticeInteraction(
            law,
            offsets,
            self.lattice_constant,
            self.normal_cutoff * law.interaction_range,
            self.weight,
            heights,
            length,
        )


ALIGNED = Aligned()
PAIRINGS = {"aligned": Aligned, "lattice": Lattice}
