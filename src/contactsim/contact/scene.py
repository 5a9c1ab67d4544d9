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

from contactsim.arguments import Count, checked
from contactsim.contact.loading import LoadPath
from contactsim.contact.problem_kind import ProblemKind
from contactsim.elasticity.base import Elasticity
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.interface.base import DEEPEST_OVERLAP, Effect, Law, borne_pressure, pulls, reads_slip
from contactsim.interface.pairing import ALIGNED, Pairing
from contactsim.surfaces.base import Surface
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait

RIGID = None
"""Elasticity of a rigid body: absent, not stiff."""
LAW_LENGTHS = 1e-9, 1e9
"""Smallest and largest length of a law, over the period."""


@checked
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


@checked
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
        upper_body = upper if isinstance(upper, Body) else Body(upper)
        lower_body = lower if isinstance(lower, Body) else Body(Flat.facing(upper_body.surface), lower)
        acting = tuple(effects) if isinstance(effects, Sequence) else (effects,)
        values = {"lower": lower_body, "upper": upper_body, "effects": acting, "path": path, "pairing": pairing}
        for name, value in values.items():
            object.__setattr__(self, name, value)  # a frozen dataclass
        for check in (_check_effects, _check_bodies, _check_loads):
            check(self)

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

    def heights(self, points: Count) -> Array:
        """Return the sum of both surfaces' heights (n,) or (ny, nx), nm, each positive towards the other.

        `points` is the number of points along x.
        """
        return self.upper.surface.heights(points) + self.lower.surface.heights(points)


def _is_law(effect: Effect) -> TypeGuard[Law]:
    """Return True if an effect is a smooth function of the gap."""
    return Trait.SMOOTH in effect.traits


def _check_effects(scene: Scene) -> None:
    """Raise InputError for effects that are missing, that no overlap resists, or whose lengths are out of range."""
    if not scene.effects:
        raise InputError("effects", scene.effects, "at least one, which resists overlap")
    if scene.kind is ProblemKind.COHESIVE:
        walls = [effect for effect in scene.effects if Trait.WALL in effect.traits]
        if not walls and sum(map(borne_pressure, scene.acting_laws)) <= 0:
            raise InputError("effects", scene.effects, "also one that resists overlap, such as a hard wall")
        if walls and "t" in scene.components:
            raise InputError("effects", scene.effects, "laws of the normal gap alone beside a hard wall")
        if len(walls) > 1:
            raise InputError("effects", scene.effects, "one hard wall")
        for hardness in (getattr(wall, "hardness", None) for wall in walls):
            if hardness is not None:
                allowed = "left out: yielding is not computed where laws act beside the wall"
                raise InputError("hardness", hardness, allowed)
    for law in scene.laws:
        for name in ("normal_length", "tangential_length"):
            length = getattr(law, name, scene.length)
            if not (LAW_LENGTHS[0] <= length / scene.length <= LAW_LENGTHS[1] or length == math.inf):
                ends = " to ".join(f"{end * scene.length:g}" for end in LAW_LENGTHS)
                raise InputError(name, length, f"{ends} nm, for a period of {scene.length:g} nm")


def _check_bodies(scene: Scene) -> None:
    """Raise InputError for bodies that do not give way, do not fit each other, or move as is not solved."""
    if not scene.elasticities:
        raise InputError("elasticity", None, "an elastic body: at least one of the two must give way")
    if len({Trait.FREE in body.traits for body in scene.elasticities}) > 1:
        raise InputError("elasticity", "FreeHalfSpace", "two free half-spaces, or two bodies that repeat")
    is_line, moves_along = len(scene.lengths) == 1, "t" in scene.components
    if scene.kind is ProblemKind.COHESIVE and not scene.repeats and is_line:
        raise InputError("elasticity", "FreeHalfSpace", "HalfSpace or Layer under smooth laws on a line")
    if moves_along and not is_line:
        allowed = "those of the normal gap alone: tangential displacements of surfaces are not modelled"
        raise InputError("effects", scene.effects, allowed)
    for side, body in (("lower", scene.lower), ("upper", scene.upper)):
        if moves_along and body.elasticity is not None and body.elasticity.poisson_ratio is None:
            allowed = f"a number above -1 and at most 0.5, of the {side} body: it moves along x"
            raise InputError("poisson_ratio", None, allowed)
    if scene.sliding and not moves_along:
        raise InputError("effects", scene.effects, "one that reads the tangential gap: else nothing slides")
    scene.pairing.check(scene.lower.elasticity, scene.upper.elasticity, scene.traits, scene.laws)
    lengths = scene.lower.surface.lengths, scene.upper.surface.lengths
    if len(lengths[0]) != len(lengths[1]) or not all(
        math.isclose(*pair, rel_tol=1e-9) for pair in zip(*lengths, strict=True)
    ):
        raise InputError("length", lengths, "the same periods for both surfaces")


def _check_loads(scene: Scene) -> None:
    """Raise InputError for a mean pressure that nothing balances, or only a very deep overlap of the laws."""
    loads = scene.path.mean_pressures
    if not loads:
        return
    if scene.kind is ProblemKind.HARD_WALL:
        if min(loads) < 0:
            raise InputError("mean_pressure", min(loads), "0 or more, in GPa: without adhesion nothing can pull")
        return
    if not scene.repeats:
        allowed = "left out for approaches: smooth laws on a free half-space follow approaches alone"
        raise InputError("mean_pressure", loads[0], allowed)
    if min(loads) < 0 and not any(map(pulls, scene.acting_laws)):
        raise InputError("mean_pressure", min(loads), "0 or more, in GPa: these laws do not pull")
    bearable = math.inf if Trait.ADHESIVE_WALL in scene.traits else sum(map(borne_pressure, scene.acting_laws))
    if max(loads) > bearable:
        allowed = f"at most {bearable:.3g} GPa, which the laws bear when they overlap by {DEEPEST_OVERLAP:g} lengths"
        raise InputError("mean_pressure", max(loads), allowed)
