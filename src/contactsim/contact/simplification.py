"""Neglect of effects: scenes without a part that is present, but changes results little.

An effect that cancels exactly is left out of every scene; see `contactsim.contact.scene`. The error of neglecting one
that does not is measured by `contactsim.error_control.neglect`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import replace

from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import HalfSpace
from contactsim.interface.base import Effect, reads_slip
from contactsim.surfaces.self_affine import SelfAffine

SMOOTHING_RATIO = 2.0
"""Shortest wavelength of a smoothed surface over that of the surface: an octave."""


def without_friction(scene: Scene) -> Scene:
    """Return a scene without tangential work of separation."""
    return _replace_effects(scene, lambda effect: effect.without_friction() if reads_slip(effect) else effect)


def without_coupling(scene: Scene) -> Scene:
    """Return a scene whose normal traction does not depend on the tangential gap; friction remains as it is."""
    return _replace_effects(scene, lambda effect: effect.without_coupling() if reads_slip(effect) else effect)


def without_compressibility(scene: Scene) -> Scene:
    """Return a scene with a Poisson's ratio of 1/2 and the same contact moduli."""
    return _replace_bodies(scene, lambda solid: solid.incompressible())


def without_finite_height(scene: Scene) -> Scene:
    """Return a scene with half-spaces of the same materials in place of layers."""
    return _replace_bodies(scene, lambda solid: HalfSpace(solid.contact_modulus, solid.poisson_ratio))


def without_second_body(scene: Scene) -> Scene:
    """Return a scene whose stiffer body is rigid."""
    lower, upper = scene.lower.elasticity, scene.upper.elasticity
    if lower is None or upper is None:
        return scene
    if lower.contact_modulus > upper.contact_modulus:
        return replace(scene, lower=replace(scene.lower, elasticity=None))
    return replace(scene, upper=replace(scene.upper, elasticity=None))


def without_short_waves(scene: Scene) -> Scene:
    """Return a scene without the shortest octave of waves of a self-affine surface."""
    surface = scene.upper.surface
    if not isinstance(surface, SelfAffine):  # no other surface has a shortest wave
        return scene
    if surface.low_pass_cutoff is not None:
        return scene
    low_pass_cutoff = SMOOTHING_RATIO * surface.short_cutoff
    if low_pass_cutoff >= surface.long_cutoff:
        return scene
    return replace(scene, upper=replace(scene.upper, surface=replace(surface, low_pass_cutoff=low_pass_cutoff)))


SIMPLIFICATIONS: dict[str, Callable[[Scene], Scene]] = {
    "friction": without_friction,
    "coupling": without_coupling,
    "compressibility": without_compressibility,
    "height": without_finite_height,
    "second_body": without_second_body,
    "short_waves": without_short_waves,
}
"""Simplification by the name of the effect that it neglects; a scene without that effect is returned unchanged."""


def simplify(scene: Scene, effects: Collection[str]) -> Scene:
    """Return a scene without some effects.

    Parameters
    ----------
    scene
        The scene.
    effects
        Names of `SIMPLIFICATIONS`; their order does not matter.
    """
    for name, simplification in SIMPLIFICATIONS.items():
        if name in effects:
            scene = simplification(scene)
    return scene


def _replace_effects(scene: Scene, change: Callable[[Effect], Effect]) -> Scene:
    """Return a scene with each effect changed."""
    return replace(scene, effects=tuple(change(effect) for effect in scene.effects))


def _replace_bodies(scene: Scene, change: Callable[[Elasticity], Elasticity]) -> Scene:
    """Return a scene with the elasticity of each body changed that is not rigid."""

    def edit_body(body: Body) -> Body:
        """Return a body with its elasticity changed."""
        return body if body.elasticity is None else replace(body, elasticity=change(body.elasticity))

    return replace(scene, lower=edit_body(scene.lower), upper=edit_body(scene.upper))
