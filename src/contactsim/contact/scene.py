"""A scene: everything physical and nothing numerical.

Two bodies face each other, aligned on one periodic grid. Only the sum of their heights and the sum of their
compliances matter, so a rigid body is absent rather than stiff. Which components exist and what a solver must be able
to do (the traits) follow from what the scene lists. Bodies alike in all do not slip against each other, nor do
half-spaces that keep their volume: there a law that reads the tangential gap has none to read.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, reduce
from typing import TypeGuard

import numpy as np

from contactsim.contact.loading import LoadPath
from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene_checks import check_effects, check_scene
from contactsim.elasticity.base import Elasticity
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.interface.base import Effect, Law, reads_slip
from contactsim.interface.pairing import ALIGNED, Pairing
from contactsim.surfaces.base import Surface
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait

RIGID = None
"""Elasticity of a rigid body: absent, not stiff."""


def _has(part: object, method: str) -> bool:
    """Return True for an object with a method; a class has none, as brackets have been forgotten."""
    return hasattr(part, method) and not isinstance(part, type)


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

    def __post_init__(self) -> None:
        if not _has(self.surface, "heights"):
            raise InputError("surface", self.surface, "a surface, such as a Cylinder or a Topography")
        if not (self.elasticity is RIGID or _has(self.elasticity, "compliance")):
            raise InputError("elasticity", self.elasticity, "an elasticity, such as a HalfSpace, or None: rigid")


@dataclass(frozen=True, init=False)
class Scene:
    """Two bodies, the effects at their interface, and the load path.

    Parameters
    ----------
    lower : Body, Elasticity or None
        Lower body; an elasticity stands for a flat body, None for a rigid flat one.
    upper : Body or Surface
        Upper body; a surface stands for a rigid body.
    effects : Effect or sequence of Effect
        A hard wall, laws whose tractions add, or both.
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
        lower: Body | Elasticity | None,
        upper: Body | Surface,
        effects: Effect | Sequence[Effect],
        path: LoadPath,
        pairing: Pairing = ALIGNED,
    ) -> None:
        if not (lower is RIGID or isinstance(lower, Body) or _has(lower, "compliance")):
            raise InputError("lower", lower, "a Body or, for a flat one, its elasticity")
        if not (isinstance(upper, Body) or _has(upper, "heights")):
            raise InputError("upper", upper, "a Body or, for a rigid one, its surface")
        upper_body = upper if isinstance(upper, Body) else Body(upper)
        lower_body = lower if isinstance(lower, Body) else Body(Flat.facing(upper_body.surface), lower)
        acting = tuple(effects) if isinstance(effects, (tuple, list)) else (effects,)
        check_effects(acting)
        values = {"lower": lower_body, "upper": upper_body, "effects": acting, "path": path, "pairing": pairing}
        for name, value in values.items():
            object.__setattr__(self, name, value)  # a frozen dataclass
        check_scene(self)

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
        traits = frozenset({dimension}).union(self.path.traits, *parts)
        return traits - {Trait.WALL} | {Trait.ADHESIVE_WALL} if {Trait.WALL, Trait.SMOOTH} <= traits else traits

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
