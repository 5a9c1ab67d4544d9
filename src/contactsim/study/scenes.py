"""From the settings of a run to the scene that it simulates."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from contactsim import reference
from contactsim.contact import loading
from contactsim.contact.loading import LoadPath, LoadStep
from contactsim.contact.scene import Body, Scene
from contactsim.contact.simplification import simplify
from contactsim.elasticity.solids import ELASTICITIES, Elasticity
from contactsim.errors import SceneError
from contactsim.grid import Grid
from contactsim.interface.pairing import Aligned, Pairing
from contactsim.interface.registry import EFFECTS, PAIRINGS
from contactsim.paths.increments import INCREMENTS, Increments
from contactsim.study.keys import RIGID
from contactsim.surfaces.measured import SURFACES
from contactsim.surfaces.self_affine import SelfAffine, generator
from contactsim.surfaces.shapes import Flat, Surface
from contactsim.surfaces.statistics import rms_gradient
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
    elasticity, counter = elastic(settings["body"]), elastic(settings.get("counter_body"))
    if elasticity is None and counter is None:
        raise SceneError("counter_body", None, "an elastic body, as the one below is rigid")
    effects = tuple(EFFECTS[name](**settings.get(name, {})) for name in settings["effects"])
    path = load_path(settings, upper, [one for one in (elasticity, counter) if one is not None])
    bodies = Body(Flat.facing(upper), elasticity), Body(upper, counter)
    scene = Scene(*bodies, effects, path, paired(settings.get("pairing")))
    return simplify(scene, settings.get("leave_out", ()))


def paired(settings: dict | None) -> Pairing:
    """How the surfaces are joined: aligned, where nothing is said."""
    given = dict(settings or {})
    return PAIRINGS[given.pop("kind")](**given) if given else Aligned()


def elastic(settings: dict | None) -> Elasticity | None:
    """A body from its settings, by contact modulus E* or, with a Poisson's ratio ν, by Young's modulus E = (1-ν²)E*.

    None for one that is rigid.
    """
    if settings is None or settings["kind"] == RIGID:
        return None
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


def load_path(settings: dict, surface: Surface, elasticities: Sequence[Elasticity]) -> LoadPath:
    """The steps of a path as they are; else mean pressures from the loads as the study gives them.

    reduced_pressure: times E*, of two bodies that of the pair, and the rms gradient, of self-affine heights that of
    the band-limited profile, of others that of their differences on the grid; contact_ratio: what a cylinder needs for
    a half-width, or a sphere for a contact radius, of that part of its radius on a half-space (Eq. 3.5).
    """
    if "control" in settings["load"]:
        load, slide = settings["load"], settings.get("slide")
        described = load["control"], tuple(load["through"]), load["increment"], load.get("origin") == "first_touch"
        if slide is None:
            return _path(*described)
        return _sliding(*described, tuple(slide["through"]), slide["increment"], *_held(slide))
    moduli = [one.contact_modulus for one in elasticities]
    contact_modulus = moduli[0] if len(moduli) == 1 else 1 / sum(1 / modulus for modulus in moduli)
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
        if any(Trait.HALF_SPACE not in one.traits for one in elasticities):
            raise SceneError("load", name, "mean_pressure or reduced_pressure: Eq. 3.5 holds on a half-space")
        load = {1: reference.cylinder_load, 2: reference.sphere_load}[len(surface.lengths)]
        values = load(values * radius, radius, contact_modulus) / np.prod(surface.lengths)
    return loading.pressures([float(value) for value in values], labels=labels)


@lru_cache(maxsize=8)
def _path(control: str, points: tuple[float, ...], increment: float, from_touch: bool) -> LoadPath:
    """The same for all variants of a study, of which there may be many."""
    return loading.sweep(Trait[control.upper()], points, increment, from_touch)


def _held(slide: dict) -> tuple[str, float]:
    """What is held while sliding, and at which value."""
    return next((name, slide[name]) for name in ("approach", "mean_pressure") if name in slide)


@lru_cache(maxsize=64)
def _sliding(
    control: str,
    points: tuple[float, ...],
    increment: float,
    from_touch: bool,
    slides: tuple[float, ...],
    slide_increment: float,
    held: str,
    value: float,
) -> LoadPath:
    """A path that presses, then slides: under its own control it goes on to what is held, else by one step."""
    kind = Trait[held.upper()]
    further = (value,) if held == control and points[-1] != value else ()
    path = loading.sweep(Trait[control.upper()], (*points, *further), increment, from_touch)
    if held != control:
        path = path >> LoadPath((LoadStep(kind, value),), from_touch)
    return path >> LoadPath((loading.Slide(slides, slide_increment, LoadStep(kind, value)),), from_touch)
