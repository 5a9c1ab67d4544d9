"""A scene: everything physical and nothing numerical.

Two bodies face each other, aligned on one periodic grid. Only the sum of their heights and the sum of their
compliances matter, so a rigid body is absent rather than stiff. Which components exist and what a solver must be able
to do (the traits) follow from what the scene lists. Bodies alike in all do not slip against each other, nor do
half-spaces that keep their volume: there a law that reads the tangential gap has none to read.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from functools import cached_property, reduce
from typing import TypeGuard

import numpy as np

from contactsim.contact.loading import LoadPath
from contactsim.elasticity.base import Elasticity
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.interface.base import Effect, Law, reads_slip
from contactsim.interface.pairing import ALIGNED, Pairing
from contactsim.surfaces.base import Surface
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait


class ProblemKind(Enum):
    """One of the two kinds of problem that a scene poses.

    They differ in their unknowns, solvers, paths and observables. `Scene.kind` is the one place that tells them apart;
    all else looks up what it needs by kind.
    """

    HARD_WALL = "hard_wall"
    """Gap and pressure are never negative, and one of them is zero at each point; each load has one solution."""
    COHESIVE = "cohesive"
    """Traction is a smooth function of the gap; states follow one another along a path."""


LAW_LENGTHS = 1e-9, 1e9
"""Smallest and largest length of a law, over the period."""
PULL_RANGE = 10.0
"""Gap, in a law's lengths, up to which a pull is looked for."""
DEEPEST_OVERLAP = 100.0
"""Overlap, in the laws' lengths, under which they bear any pressure that a scene may have."""
RIGID = None
"""Elasticity of a rigid body: absent, not stiff."""


@dataclass(frozen=True)
class Body:
    """A surface on an elastic solid.

    Parameters
    ----------
    surface : Surface
        Periodic heights.
    elasticity : Elasticity, optional
        The solid below the surface; `RIGID` by default.
    """

    surface: Surface
    elasticity: Elasticity | None = RIGID


@dataclass(frozen=True, init=False)
class Scene:
    """Two bodies, the effects at their interface, and the load path.

    Parameters
    ----------
    lower : Body or Elasticity
        Lower body; an elasticity stands for a flat body.
    upper : Body or Surface
        Upper body; a surface stands for a rigid body.
    effects : Effect or tuple of Effect
        A hard wall, or laws whose tractions add.
    path : LoadPath
        Load steps.
    pairing : Pairing
        Which points of the two surfaces interact; facing points by default.

    Raises
    ------
    InputError
        For bodies, effects and paths that do not go together.
    """

    lower: Body
    upper: Body
    effects: tuple[Effect, ...]
    path: LoadPath
    pairing: Pairing = ALIGNED

    def __init__(
        self,
        lower: Body | Elasticity,
        upper: Body | Surface,
        effects: Effect | tuple[Effect, ...],
        path: LoadPath,
        pairing: Pairing = ALIGNED,
    ) -> None:
        upper_body = upper if isinstance(upper, Body) else Body(upper)
        lower_body = lower if isinstance(lower, Body) else Body(Flat.facing(upper_body.surface), lower)
        acting = effects if isinstance(effects, tuple) else (effects,)
        values = {"lower": lower_body, "upper": upper_body, "effects": acting, "path": path, "pairing": pairing}
        for name, value in values.items():
            object.__setattr__(self, name, value)  # a frozen dataclass
        self._check_parts()
        self._check_sliding()
        self._check_surfaces()
        self._check_lengths()
        self._check_loads()

    def _check_parts(self) -> None:
        """Raise InputError for bodies, effects or loads that are missing or impossible."""
        if not self.elasticities:
            raise InputError("elasticity", None, "an elastic body: at least one of the two must give way")
        if len({Trait.FREE in body.traits for body in self.elasticities}) > 1:
            raise InputError("elasticity", "FreeHalfSpace", "two free half-spaces, or two bodies that repeat")
        if not self.effects:
            raise InputError("effects", self.effects, "at least one, which resists overlap")
        if self.kind is ProblemKind.COHESIVE and not self.repeats:
            self._check_free_laws()
        for pressure in self.path.mean_pressures if self.kind is ProblemKind.HARD_WALL else ():
            if pressure < 0:
                raise InputError("mean_pressure", pressure, "0 or more, in GPa: without adhesion nothing can pull")

    def _check_free_laws(self) -> None:
        """Raise InputError for smooth laws on a free half-space that are not solved there."""
        if len(self.lengths) == 1:
            raise InputError("elasticity", "FreeHalfSpace", "HalfSpace or Layer under smooth laws on a line")
        if self.path.mean_pressures:
            allowed = "left out for approaches: smooth laws on a free half-space follow approaches alone"
            raise InputError("mean_pressure", self.path.mean_pressures[0], allowed)

    def _check_sliding(self) -> None:
        """Raise InputError for tangential displacements that nothing determines, and for those of surfaces."""
        if "t" in self.components and len(self.lengths) > 1:
            allowed = "those of the normal gap alone: tangential displacements of surfaces are not modelled"
            raise InputError("effects", self.effects, allowed)
        for side, body in (("lower", self.lower), ("upper", self.upper)):
            elasticity = body.elasticity
            if "t" in self.components and elasticity is not None and elasticity.poisson_ratio is None:
                allowed = f"a number above -1 and at most 0.5, of the {side} body: it moves along x"
                raise InputError("poisson_ratio", None, allowed)
        if self.sliding and "t" not in self.components:
            raise InputError("effects", self.effects, "one that reads the tangential gap: else nothing slides")

    def _check_surfaces(self) -> None:
        """Raise InputError for surfaces that the pairing cannot join, or of different periods."""
        self.pairing.check(self.lower.elasticity, self.upper.elasticity, self.traits, self.laws)
        lengths = self.lower.surface.lengths, self.upper.surface.lengths
        if len(lengths[0]) != len(lengths[1]) or not all(map(_are_equal, *lengths)):
            raise InputError("length", lengths, "the same periods for both surfaces")

    def _check_lengths(self) -> None:
        """Raise InputError for a law's length that rounding would hide beside the period, or the period beside it."""
        for law in self.laws:
            for name in ("normal_length", "tangential_length"):
                length = getattr(law, name, self.length)
                if not (LAW_LENGTHS[0] <= length / self.length <= LAW_LENGTHS[1] or length == math.inf):
                    ends = " to ".join(f"{end * self.length:g}" for end in LAW_LENGTHS)
                    raise InputError(name, length, f"{ends} nm, for a period of {self.length:g} nm")

    def _check_loads(self) -> None:
        """Raise InputError for a mean pressure that the laws cannot bear, or under a very deep overlap alone."""
        loads = self.path.mean_pressures
        if self.kind is not ProblemKind.COHESIVE or not loads:
            return
        if min(loads) < 0 and not any(map(_pulls, self.acting_laws)):
            raise InputError("mean_pressure", min(loads), "0 or more, in GPa: these laws do not pull")
        bearable = sum(_repulsion(law, DEEPEST_OVERLAP * law.interaction_range) for law in self.acting_laws)
        if max(loads) > bearable:
            allowed = (
                f"at most {bearable:.3g} GPa, which the laws bear when they overlap by {DEEPEST_OVERLAP:g} lengths"
            )
            raise InputError("mean_pressure", max(loads), allowed)

    @property
    def elasticities(self) -> tuple[Elasticity, ...]:
        """The bodies that give way."""
        return tuple(body.elasticity for body in (self.lower, self.upper) if body.elasticity is not None)

    @property
    def sliding(self) -> bool:
        """True where the bodies are moved along each other."""
        return self.path.slides

    @cached_property
    def slips(self) -> bool:
        """True where points interact at a tangential distance: on a lattice, in a slide, or moved by normal tractions.

        Normal tractions on like bodies move none, nor do those on bodies of ν = 1/2.
        """
        if self.sliding or math.isfinite(self.pairing.lattice_constant):
            return True
        alike = self.lower.elasticity == self.upper.elasticity
        return not alike and any(body.couples for body in self.elasticities)

    @cached_property
    def acting(self) -> tuple[Effect, ...]:
        """The effects as they act: where nothing slips, exactly, laws without all that is tangential."""
        if self.slips:
            return self.effects
        return tuple(effect.without_slip() if reads_slip(effect) else effect for effect in self.effects)

    @property
    def laws(self) -> tuple[Law, ...]:
        """Effects that are smooth functions of the gap."""
        return tuple(effect for effect in self.effects if _is_law(effect))

    @property
    def acting_laws(self) -> tuple[Law, ...]:
        """The same of the effects as they act."""
        return tuple(effect for effect in self.acting if _is_law(effect))

    @cached_property
    def components(self) -> tuple[str, ...]:
        """Displacement components that exist: those that an effect reads or exerts."""
        used = reduce(frozenset.union, (effect.reads | effect.exerts for effect in self.acting))
        return tuple(component for component in ("n", "t") if component in used)

    @cached_property
    def exerted(self) -> tuple[str, ...]:
        """Components in which an effect exerts traction: the unknowns; those only read are derived from them."""
        used = reduce(frozenset.union, (effect.exerts for effect in self.acting))
        return tuple(component for component in ("n", "t") if component in used)

    @cached_property
    def traits(self) -> frozenset[Trait]:
        """Traits that a solver must accept: the union over effects, bodies, path and dimension."""
        parts = [effect.traits for effect in self.acting] + [body.traits for body in self.elasticities]
        dimension = {1: Trait.LINE, 2: Trait.SURFACE}[len(self.lengths)]
        return frozenset({dimension}).union(self.path.traits, *parts)

    @cached_property
    def kind(self) -> ProblemKind:
        """Kind of problem that the scene poses."""
        return ProblemKind.COHESIVE if self.acting_laws else ProblemKind.HARD_WALL

    @property
    def repeats(self) -> bool:
        """True where contact and displacement go on at the other end of the heights: on all but free half-spaces."""
        return Trait.FREE not in self.traits

    @property
    def lengths(self) -> tuple[float, ...]:
        """Period in each direction, x last (nm)."""
        return self.upper.surface.lengths

    @property
    def length(self) -> float:
        """Period along x (nm)."""
        return self.lengths[-1]

    @property
    def contact_modulus(self) -> float:
        """Contact modulus of the pair, 1/E* = Σ 1/E_i* (GPa)."""
        return 1.0 / sum(1.0 / body.contact_modulus for body in self.elasticities)

    def compliance(self, wavenumber: Array) -> Array:
        """Return the sum of the bodies' compliances at each |q| (rad/nm), nm/GPa."""
        total: Array = np.zeros(np.shape(wavenumber))
        return sum((body.compliance(wavenumber) for body in self.elasticities), start=total)

    @property
    def modes(self) -> int | None:
        """Highest number of waves in a period of both surfaces together; None if there is no limit."""
        modes = self.lower.surface.modes, self.upper.surface.modes
        return None if None in modes else max(count for count in modes if count is not None)

    def heights(self, points: int) -> Array:
        """Return the sum of both surfaces' heights (n,) or (ny, nx), nm, each positive towards the other.

        `points` is the number of points along x.
        """
        return self.upper.surface.heights(points) + self.lower.surface.heights(points)


def _is_law(effect: Effect) -> TypeGuard[Law]:
    """Return True if an effect is a smooth function of the gap."""
    return Trait.SMOOTH in effect.traits


def _are_equal(length: float, other: float) -> bool:
    """Return True for lengths that differ by rounding alone."""
    return math.isclose(length, other, rel_tol=1e-9)


def _repulsion(law: Law, overlap: float) -> float:
    """Return the normal traction (GPa) with which a law resists an overlap (nm) without slip."""
    gap = np.zeros((len(law.reads), 1))
    gap[0] = -overlap
    return -float(law.traction(gap)[0, 0])


def _pulls(law: Law) -> bool:
    """Return True if a law pulls surfaces together somewhere within a few of its lengths, without slip."""
    gaps = np.linspace(0.0, PULL_RANGE, 64) * law.interaction_range
    return bool((law.traction(np.stack([gaps, *np.zeros((len(law.reads) - 1, 64))]))[0] > 0).any())
