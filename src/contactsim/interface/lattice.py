"""Springs between the sites of two lattices, so that contacts broken by sliding are made anew (Eqs 6.1-6.6).

A site of the upper surface that has moved by Δt pulls and pushes all sites of the rigid lower lattice within a cutoff,
each by the law between two sites. The sum repeats itself after a lattice constant, around the periodic cell as well.

The lattice is physical and is not the mesh. Where the mesh is finer or coarser, each of its points stands for sites
that face the lower lattice as the sites at that place do: one is opposite when nothing has moved. As in the thesis,
the traction of a law counts once for each spring (`weight` 1): with a lattice constant below the tangential length many
springs add up, and their tangential parts cancel. The cost is proportional to the number of points within the normal
cutoff times the number of sites within the tangential one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from contactsim.arguments import Gap, Heights, Length, NotNegative, Positive, checked
from contactsim.elasticity.base import Elasticity
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.interface.base import Law, potential
from contactsim.traits import Trait

MAX_SITES = 100000
"""Largest number of sites on each side within the tangential cutoff."""
PHASE_COUNT = 33
"""Positions over half a lattice constant at which the springs are summed to find their strength."""


@dataclass(frozen=True)
class LatticeInteraction:
    """The springs of every upper site, as one law of the gap to the site that was opposite in the beginning.

    Parameters
    ----------
    law
        The law of each spring.
    offsets
        Sites within the tangential cutoff, counted from the nearest one (sites,).
    lattice_constant
        Distance between sites, nm.
    max_gap
        Normal gap beyond which there is no spring, nm.
    weight
        Factor of each spring's traction.
    lower
        Heights of the rigid lower surface (n,), nm, positive towards the upper one; None if it is flat.
    length
        Period along x, nm.
    """

    law: Law
    offsets: Array = field(repr=False)
    lattice_constant: float
    max_gap: float
    weight: float
    lower: Array | None = field(repr=False)
    length: float

    @property
    def reads(self) -> frozenset[str]:
        """Components of the gap on which it depends."""
        return self.law.reads

    @property
    def exerts(self) -> frozenset[str]:
        """Components of the traction that it exerts."""
        return self.law.exerts

    @property
    def traits(self) -> frozenset[Trait]:
        """Traits that a solver must accept."""
        return self.law.traits

    @cached_property
    def _amplification(self) -> float:
        """Largest normal traction of all springs of a site, over that of one spring."""
        phases = np.linspace(0.0, 0.5, PHASE_COUNT)
        slips = self.lattice_constant * (phases - self.offsets[:, None]).ravel()
        reach = self.law.interaction_range
        for normal in (reach, -reach):  # a law without a pull has repulsion
            alone = self.law.traction(np.array([[normal], [0.0]]))[0, 0]
            if alone:
                break
        sums = (
            self.law.traction(np.stack((np.full_like(slips, normal), slips)))[0].reshape(len(self.offsets), -1).sum(0)
        )
        return self.weight * float((sums / alone).max())

    @property
    def strength(self) -> float:
        """Largest normal traction of all springs of a site, GPa."""
        return self._amplification * self.law.strength

    @property
    def stiffness(self) -> float:
        """Approximate largest tangent of all springs of a site, GPa/nm."""
        return self._amplification * self.law.stiffness

    @property
    def interaction_range(self) -> float:
        """Shortest length over which the traction changes, nm."""
        return min(self.law.interaction_range, self.law.tangential_length)

    @property
    def tangential_length(self) -> float:
        """Shortest length over which the traction changes with the tangential gap, nm."""
        return self.law.tangential_length

    def traction(self, gap: Gap) -> Array:
        """Return the traction (exerts, n), GPa, at a gap (reads, n), nm."""
        near, springs = self._spring_gaps(gap)
        return self._sum_springs(self.law.traction(springs), near, gap.shape[1])

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (exerts, n), GPa, and its derivatives (exerts, reads, n), GPa/nm."""
        near, springs = self._spring_gaps(gap)
        traction, derivative = self.law.tangent(springs)
        points = gap.shape[1]
        return self._sum_springs(traction, near, points), self._sum_springs(derivative, near, points)

    def energy(self, gap: Gap) -> Array:
        """Return the sum of the springs' potentials (n,), N/m; the law must have one."""
        near, springs = self._spring_gaps(gap)
        return self._sum_springs(potential(self.law, springs), near, gap.shape[1])

    def lower_traction(self, gap: Gap) -> Array:
        """Return the traction on the lower surface (exerts, n), GPa: at each site the opposite of its springs.

        Sites between points of the mesh are shared among these points by Fourier interpolation.
        """
        near, springs = self._spring_gaps(gap)
        tractions = self.weight * self.law.traction(springs).reshape(len(self.exerts), len(self.offsets), -1)
        sites = (self._nearest_site(gap)[near] + self.offsets[:, None]).astype(int)
        total = np.zeros((len(self.exerts), gap.shape[1]))
        for site in np.unique(sites):
            of_site = np.zeros_like(total)
            of_site[:, near] = (tractions * (sites == site)).sum(1)
            total -= self._shift(of_site, site)
        return total

    def _nearest_site(self, gap: Gap) -> Array:
        """Return the nearest site of the lower lattice (n,), counted from the one opposite in the beginning."""
        return np.rint(gap[1] / self.lattice_constant)

    def _spring_gaps(self, gap: Gap) -> tuple[Array, Array]:
        """Return the points that have springs (near,), and the gap of each spring (reads, sites × near)."""
        smallest = gap[0] if self.lower is None else gap[0] + self.lower - self.lower.max()
        near = np.flatnonzero(smallest <= self.max_gap)
        springs = np.empty((len(gap), len(self.offsets), near.size))
        first = self._nearest_site(gap)[near]
        springs[0] = gap[0, near]
        if self.lower is not None:
            springs[0] += self._added_gap(self.lower, near, first + self.offsets[:, None])
        springs[1] = gap[1, near] - self.lattice_constant * (first + self.offsets[:, None])
        return near, springs.reshape(len(gap), -1)

    def _sum_springs(self, values: Array, near: Array, points: int) -> Array:
        """Return the sum over the springs of each point (…, points) of values (…, sites × near)."""
        total = np.zeros((*values.shape[:-1], points))
        total[..., near] = self.weight * values.reshape(*values.shape[:-1], len(self.offsets), -1).sum(-2)
        return total

    def _added_gap(self, lower: Array, near: Array, sites: Array) -> Array:
        """Return by how much the gap to each site (sites, near) exceeds that to the first opposite one, nm."""
        added = np.empty(sites.shape)
        for site in np.unique(sites):
            rows, columns = np.nonzero(sites == site)
            added[rows, columns] = (lower - self._shift(lower, -site))[near[columns]]
        return added

    def _shift(self, values: Array, sites: float) -> Array:
        """Return values (…, n), shifted along x by some lattice constants."""
        steps = sites * self.lattice_constant / self.length * values.shape[-1]
        if abs(steps - round(steps)) < 1e-9 * max(abs(steps), 1.0):
            return np.roll(values, round(steps), -1)
        waves = np.arange(values.shape[-1] // 2 + 1)
        coefficients = np.fft.rfft(values) * np.exp(-2j * np.pi * waves * steps / values.shape[-1])
        return np.fft.irfft(coefficients, values.shape[-1])


@checked
@dataclass(frozen=True)
class Lattice:
    """Springs from each site of the upper surface to those of a rigid lattice below (Eqs 6.2-6.3).

    Parameters
    ----------
    lattice_constant
        Distance between sites, nm.
    tangential_cutoff
        Distance along x beyond which there is no spring, in tangential lengths of the law (thesis: 5). The nearest site
        is always included, and at most `MAX_SITES` on each side of it.
    normal_cutoff
        Normal gap beyond which there is no spring, in normal lengths of the law. The thesis has 10, where the law still
        jumps by 1e-3 of its strength.
    weight
        Factor of each spring's traction (thesis: 1).
    """

    lattice_constant: Length
    tangential_cutoff: NotNegative = 5.0
    normal_cutoff: Positive = 40.0
    weight: Positive = 1.0
    refuses = frozenset({Trait.SURFACE, Trait.WALL})

    def check(
        self, lower: Elasticity | None, upper: Elasticity | None, traits: frozenset[Trait], laws: tuple[Law, ...]
    ) -> None:
        """Raise an `InputError` unless the lower body is rigid, the contact a line, and laws depend on the slip."""
        if lower is not None:
            allowed = "a rigid lower body: sites that are displaced on both sides are not modelled"
            raise InputError("pairing", "lattice", allowed)
        if self.refuses & traits:
            raise InputError("pairing", "lattice", "aligned, or smooth laws on a line: springs are laws between sites")
        for law in laws:
            if "t" not in law.reads:
                raise InputError(
                    "effects", law, "laws that read the tangential gap, as springs to other sites have one"
                )

    def join(self, law: Law, lower: Heights, length: float) -> LatticeInteraction:
        """Return the springs as one law; see `Pairing.join`."""
        sites = math.ceil(self.tangential_cutoff * law.tangential_length / self.lattice_constant)
        if sites > MAX_SITES:
            allowed = f"one of at most {MAX_SITES} sites on each side, not {sites}"
            raise InputError("tangential_cutoff", self.tangential_cutoff, allowed)
        offsets = np.arange(-sites, sites + 1.0)
        heights = None if np.ptp(lower) == 0 else lower
        max_gap = self.normal_cutoff * law.interaction_range
        return LatticeInteraction(law, offsets, self.lattice_constant, max_gap, self.weight, heights, length)

    def offset(self, gap: Gap) -> Array:
        """Return the tangential gap (n,), nm, to the nearest site; gap: (2, n), nm."""
        return gap[1] - self.lattice_constant * np.rint(gap[1] / self.lattice_constant)
