"""Effects left out of a scene because they are asked to be; what that costs in error is measured.

What cancels is left out anyway: see `contactsim.contact.scene`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import reduce

from contactsim.contact.scene import Scene
from contactsim.elasticity.solids import Elasticity, HalfSpace
from contactsim.surfaces.self_affine import SelfAffine

OCTAVE = 2.0

Change = Callable[[object], object]


def _of_laws(scene: Scene, change: Change) -> Scene:
    return replace(scene, effects=tuple(change(effect) for effect in scene.effects))


def _of_bodies(scene: Scene, change: Change) -> Scene:
    bodies = {side: getattr(scene, side) for side in ("lower", "upper")}
    return replace(
        scene,
        **{
            side: replace(body, elasticity=change(body.elasticity))
            for side, body in bodies.items()
            if body.elasticity is not None
        },
    )


def _deep(body: Elasticity) -> Elasticity:
    return HalfSpace(body.contact_modulus, body.poisson_ratio)


def _smoothed(scene: Scene) -> Scene:
    surface = scene.upper.surface
    if not isinstance(surface, SelfAffine) or surface.smoothed is not None:
        return scene
    smoothed = OCTAVE * surface.shortest_wavelength
    if smoothed >= surface.rolloff_wavelength:
        return scene
    return replace(scene, upper=replace(scene.upper, surface=replace(surface, smoothed=smoothed)))


def _one_body(scene: Scene) -> Scene:
    lower, upper = scene.lower.elasticity, scene.upper.elasticity
    if lower is None or upper is None:
        return scene
    side = "lower" if lower.contact_modulus > upper.contact_modulus else "upper"
    return replace(scene, **{side: replace(getattr(scene, side), elasticity=None)})


def _incompressible(body: Elasticity) -> Elasticity:
    return body if body.poisson_ratio is None else replace(body, poisson_ratio=0.5)


LEFT_OUT: dict[str, Callable[[Scene], Scene]] = {
    "friction": lambda scene: _of_laws(scene, lambda effect: effect.without_friction()),
    "coupling": lambda scene: _of_laws(scene, lambda effect: effect.without_coupling()),
    "compressibility": lambda scene: _of_bodies(scene, _incompressible),
    "height": lambda scene: _of_bodies(scene, _deep),
    "second_body": _one_body,
    "short_waves": _smoothed,
}
"""What can be left out: tangential work; that normal traction feels the tangential gap, and friction with it; the
compressibility of bodies, at the same E*; their finite height, by half-spaces of the same materials; the elasticity of
the stiffer of two bodies; the shortest octave of a self-affine surface's waves."""


def left_out(scene: Scene, names: Sequence[str]) -> Scene:
    """A scene without some effects, in whatever order they are named; one that it does not have changes nothing."""
    return reduce(lambda one, name: LEFT_OUT[name](one) if name in names else one, LEFT_OUT, scene)
