"""Refuse scenes whose bodies, effects and paths do not go together."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from contactsim.contact.problem_kind import ProblemKind
from contactsim.errors import InputError
from contactsim.interface.base import Law
from contactsim.traits import Trait

if TYPE_CHECKING:
    from contactsim.contact.scene import Scene

LAW_LENGTHS = 1e-9, 1e9
"""Smallest and largest length of a law, over the period."""
PULL_RANGE = 10.0
"""Gap, in a law's lengths, up to which a pull is looked for."""
DEEPEST_OVERLAP = 100.0
"""Overlap, in the laws' lengths, under which they bear any pressure that a scene may have."""


def check_effects(effects: tuple[object, ...]) -> None:
    """Raise InputError for an effect that is none, or a class of effects without its parameters."""
    for effect in effects:
        if isinstance(effect, type) or not all(hasattr(effect, name) for name in ("reads", "exerts", "traits")):
            raise InputError("effects", effect, "effects such as HardWall() or NormalCohesiveZone(1.0)")


def check_scene(scene: Scene) -> None:
    """Raise InputError for bodies, effects and paths that do not go together."""
    for check in CHECKS:
        check(scene)


def _check_parts(scene: Scene) -> None:
    """Raise InputError for bodies, effects or loads that are missing or impossible."""
    if not scene.elasticities:
        raise InputError("elasticity", None, "an elastic body: at least one of the two must give way")
    if len({Trait.FREE in body.traits for body in scene.elasticities}) > 1:
        raise InputError("elasticity", "FreeHalfSpace", "two free half-spaces, or two bodies that repeat")
    if not scene.effects:
        raise InputError("effects", scene.effects, "at least one, which resists overlap")
    if scene.kind is ProblemKind.COHESIVE:
        _check_resistance(scene)
        if not scene.repeats:
            _check_free_laws(scene)
    for pressure in scene.path.mean_pressures if scene.kind is ProblemKind.HARD_WALL else ():
        if pressure < 0:
            raise InputError("mean_pressure", pressure, "0 or more, in GPa: without adhesion nothing can pull")


def _check_resistance(scene: Scene) -> None:
    """Raise InputError for laws that no overlap resists, and for what a hard wall beside laws does not have."""
    walls = [effect for effect in scene.effects if Trait.WALL in effect.traits]
    if not walls and _bearable(scene) <= 0:
        raise InputError("effects", scene.effects, "also one that resists overlap, such as a hard wall")
    if walls and "t" in scene.components:
        raise InputError("effects", scene.effects, "laws of the normal gap alone beside a hard wall")
    if len(walls) > 1:
        raise InputError("effects", scene.effects, "one hard wall")
    for wall in walls:
        hardness = getattr(wall, "hardness", None)
        if hardness is not None:
            raise InputError("hardness", hardness, "left out: yielding is not computed where laws act beside the wall")


def _check_free_laws(scene: Scene) -> None:
    """Raise InputError for smooth laws on a free half-space that are not solved there."""
    if len(scene.lengths) == 1:
        raise InputError("elasticity", "FreeHalfSpace", "HalfSpace or Layer under smooth laws on a line")
    if scene.path.mean_pressures:
        allowed = "left out for approaches: smooth laws on a free half-space follow approaches alone"
        raise InputError("mean_pressure", scene.path.mean_pressures[0], allowed)


def _check_sliding(scene: Scene) -> None:
    """Raise InputError for tangential displacements that nothing determines, and for those of surfaces."""
    if "t" in scene.components and len(scene.lengths) > 1:
        allowed = "those of the normal gap alone: tangential displacements of surfaces are not modelled"
        raise InputError("effects", scene.effects, allowed)
    for side, body in (("lower", scene.lower), ("upper", scene.upper)):
        elasticity = body.elasticity
        if "t" in scene.components and elasticity is not None and elasticity.poisson_ratio is None:
            allowed = f"a number above -1 and at most 0.5, of the {side} body: it moves along x"
            raise InputError("poisson_ratio", None, allowed)
    if scene.sliding and "t" not in scene.components:
        raise InputError("effects", scene.effects, "one that reads the tangential gap: else nothing slides")


def _check_surfaces(scene: Scene) -> None:
    """Raise InputError for surfaces that the pairing cannot join, or of different periods."""
    scene.pairing.check(scene.lower.elasticity, scene.upper.elasticity, scene.traits, scene.laws)
    lengths = scene.lower.surface.lengths, scene.upper.surface.lengths
    if len(lengths[0]) != len(lengths[1]) or not all(map(_are_equal, *lengths)):
        raise InputError("length", lengths, "the same periods for both surfaces")


def _check_lengths(scene: Scene) -> None:
    """Raise InputError for a law's length that rounding would hide beside the period, or the period beside it."""
    for law in scene.laws:
        for name in ("normal_length", "tangential_length"):
            length = getattr(law, name, scene.length)
            if not (LAW_LENGTHS[0] <= length / scene.length <= LAW_LENGTHS[1] or length == math.inf):
                ends = " to ".join(f"{end * scene.length:g}" for end in LAW_LENGTHS)
                raise InputError(name, length, f"{ends} nm, for a period of {scene.length:g} nm")


def _check_loads(scene: Scene) -> None:
    """Raise InputError for a mean pressure that the laws cannot bear, or under a very deep overlap alone."""
    loads = scene.path.mean_pressures
    if scene.kind is not ProblemKind.COHESIVE or not loads:
        return
    if min(loads) < 0 and not any(map(_pulls, scene.acting_laws)):
        raise InputError("mean_pressure", min(loads), "0 or more, in GPa: these laws do not pull")
    bearable = math.inf if Trait.ADHESIVE_WALL in scene.traits else _bearable(scene)
    if max(loads) > bearable:
        allowed = f"at most {bearable:.3g} GPa, which the laws bear when they overlap by {DEEPEST_OVERLAP:g} lengths"
        raise InputError("mean_pressure", max(loads), allowed)


def _are_equal(length: float, other: float) -> bool:
    """Return True for lengths that differ by rounding alone."""
    return math.isclose(length, other, rel_tol=1e-9)


def _bearable(scene: Scene) -> float:
    """Return the mean pressure (GPa) that the laws bear under a very deep overlap."""
    return sum(_repulsion(law, DEEPEST_OVERLAP * law.interaction_range) for law in scene.acting_laws)


def _repulsion(law: Law, overlap: float) -> float:
    """Return the normal traction (GPa) with which a law resists an overlap (nm) without slip."""
    gap = np.zeros((len(law.reads), 1))
    gap[0] = -overlap
    return -float(law.traction(gap)[0, 0])


def _pulls(law: Law) -> bool:
    """Return True if a law pulls surfaces together somewhere within a few of its lengths, without slip."""
    gaps = np.linspace(0.0, PULL_RANGE, 64) * law.interaction_range
    return bool((law.traction(np.stack([gaps, *np.zeros((len(law.reads) - 1, 64))]))[0] > 0).any())


CHECKS = (_check_parts, _check_sliding, _check_surfaces, _check_lengths, _check_loads)
"""In the order in which they are made: later ones need what earlier ones found."""
