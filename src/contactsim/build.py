"""From the settings of a run to the scene that it simulates."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from contactsim import analytic, loading
from contactsim.elasticity import ELASTICITIES, Elasticity
from contactsim.errors import SceneError
from contactsim.follow import INCREMENTS, Increments
from contactsim.grid import Grid
from contactsim.laws import EFFECTS
from contactsim.leaving_out import left_out
from contactsim.loading import LoadPath
from contactsim.roughness import rms_gradient
from contactsim.scene import Body, Scene
from contactsim.surface import SURFACES, Flat, SelfAffine, Surface, generator
from contactsim.traits import Trait


def scene_of(settings: dict) -> Scene:
    """The scene of a run: a flat elastic body below, the surface above, rigid or not, taken through all loads.

    Without the effects that the study leaves out.
    """
    surface = dict(settings["surface"])
    kind = SURFACES[surface.pop("kind")]
    if kind is SelfAffine:
        surface["rng"] = generator(settings["seed"], settings["study"], surface["hurst"], settings["member"])
    upper = kind(**surface)
    elasticity = elastic(settings["body"])
    counter = None if settings.get("counter_body") is None else elastic(settings["counter_body"])
    effects = tuple(EFFECTS[name](**settings.get(name, {})) for name in settings["effects"])
    path = load_path(settings, upper, elasticity)
    scene = Scene(Body(Flat.facing(upper), elasticity), Body(upper, counter), effects, path)
    return left_out(scene, settings.get("leave_out", ()))


def elastic(settings: dict) -> Elasticity:
    """A body from its settings, by contact modulus E* or, with a Poisson's ratio ν, by Young's modulus E = (1-ν²)E*."""
    given = {name: value for name, value in settings.items() if name not in ("kind", "youngs_modulus")}
    young = settings.get("youngs_modulus")
    if (young is None) == (given.get("contact_modulus") is None):
        both = {name: settings.get(name) for name in ("contact_modulus", "youngs_modulus")}
        raise SceneError("contact_modulus", both, "exactly one of contact_modulus and youngs_modulus")
    if young is not None:
        ratio = given.get("poisson_ratio")
        if ratio is None:
            raise SceneError("poisson_ratio", None, "a number, where Young's modulus is given")
        if not young > 0:
            raise SceneError("youngs_modulus", young, "a positive, finite number in GPa")
        given["contact_modulus"] = young / (1 - ratio**2)
    return ELASTICITIES[settings["kind"]](**given)


def increments_of(settings: dict) -> Increments:
    """How the path of a run with smooth laws is walked."""
    given = dict(settings["increments"])
    return INCREMENTS[given.pop("kind")](**given)


def points_of(settings: dict, surface: Surface) -> int:
    """Number of grid points: the study's, or that of a measured surface."""
    points = settings["points"] or surface.points
    if points is None:
        raise SceneError("points", None, "a whole number: only a measured surface comes with its own")
    return points


def load_path(settings: dict, surface: Surface, elasticity: Elasticity) -> LoadPath:
    """The steps of a path as they are; else mean pressures from the loads as the study gives them.

    reduced_pressure: times E* and the rms gradient, of self-affine heights that of the band-limited profile, of others
    that of their differences on the grid; contact_ratio: what a cylinder needs for a half-width, or a sphere for a
    contact radius, of that part of its radius on a half-space (Eq. 3.5).
    """
    contact_modulus = elasticity.contact_modulus
    if "control" in settings["load"]:
        load = settings["load"]
        return _path(load["control"], tuple(load["through"]), load["increment"], load.get("origin") == "first_touch")
    name, values = settings["load"]["name"], np.array(settings["load"]["values"])
    labels = [f"{name}={value:g}" for value in values]
    if name == "reduced_pressure":
        if isinstance(surface, SelfAffine):
            gradient = surface.gradient
        else:
            points = points_of(settings, surface)
            heights = surface.heights(points)
            gradient = rms_gradient(heights, Grid(heights.shape, surface.lengths).spacing)
        if not gradient > 0:
            raise SceneError("load", name, "mean_pressure: this surface is flat")
        values = values * contact_modulus * gradient
    elif name == "contact_ratio":
        radius = settings["surface"].get("radius")
        if radius is None:
            raise SceneError("load", name, "mean_pressure or reduced_pressure: this surface has no radius")
        if Trait.HALF_SPACE not in elasticity.traits:
            raise SceneError("load", name, "mean_pressure or reduced_pressure: Eq. 3.5 holds on a half-space")
        load = {1: analytic.cylinder_load, 2: analytic.sphere_load}[len(surface.lengths)]
        values = load(values * radius, radius, contact_modulus) / np.prod(surface.lengths)
    return loading.press([float(value) for value in values], labels)


@lru_cache(maxsize=8)
def _path(control: str, points: tuple[float, ...], increment: float, from_touch: bool) -> LoadPath:
    """The same for all variants of a study, of which there may be many."""
    return loading.through(Trait[control.upper()], points, increment, from_touch)
