"""Build the scene and the options of a run from its settings: the one place where YAML becomes objects."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from functools import lru_cache

import numpy as np

from contactsim.contact.loading import LoadPath, pressures, sweep
from contactsim.contact.scene import Body, Scene
from contactsim.contact.simplification import simplify
from contactsim.contact.steps import LoadStep, Slide
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.registry import make_elasticity
from contactsim.errors import InputError
from contactsim.grid import Grid
from contactsim.interface.pairing import ALIGNED, Pairing
from contactsim.interface.registry import EFFECTS, PAIRINGS
from contactsim.observables.contact import KEPT_ONCE
from contactsim.paths.increments import INCREMENTS
from contactsim.paths.options import Accuracy, RunOptions, Setup
from contactsim.provenance import canonical
from contactsim.reference import hard_wall
from contactsim.solvers.registry import configure_solver
from contactsim.study.keys import BODIES, RIGID
from contactsim.study.kinds import study_kind
from contactsim.surfaces.base import Surface
from contactsim.surfaces.height_statistics import STATISTICS
from contactsim.surfaces.registry import SURFACES
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait


def build_setup(settings: Mapping, threads: int = 1) -> Setup:
    """Return the scene and the options of a run.

    Parameters
    ----------
    settings : mapping
        Settings of a `contactsim.study.run.Run`, checked and complete.
    threads : int
        Threads of the transforms.
    """
    accuracy = settings.get("accuracy")
    options = RunOptions(
        points=settings["points"],
        tolerance=settings["tolerance"],
        solver=configure_solver(**settings["solver"]),
        threads=threads,
        accuracy=None if accuracy is None else Accuracy(accuracy["error"], tuple(accuracy["quantities"])),
        **study_kind(settings).options(settings),
    )
    return Setup(build_scene(settings), options)


def settings_of_single_loads(settings: Mapping) -> dict | None:
    """Return what each load of a run depends on besides its value; None for a path, whose states depend on each other.

    It does not depend on the other loads, nor on what is kept once for all of them.
    """
    if "values" not in settings["load"]:
        return None
    kept = [name for name in settings["keep"] if name != KEPT_ONCE]
    return {**settings, "load": settings["load"]["name"], "keep": kept}


def build_scene(settings: Mapping) -> Scene:
    """Return the scene of a run, without the effects that it neglects.

    A flat body lies below, the surface above; either may be rigid.
    """
    surface = _build_surface(settings)
    lower, upper = (_build_elasticity(settings.get(name), name) for name in BODIES)
    if lower is None and upper is None:
        raise InputError("counter_body", None, "an elastic body, as the one below is rigid")
    effects = tuple(EFFECTS[name](**settings.get(name, {})) for name in settings["effects"])
    bodies = Body(Flat.facing(surface), lower), Body(surface, upper)
    elasticities = [body for body in (lower, upper) if body is not None]
    path = _build_path(settings, surface, elasticities)
    scene = Scene(*bodies, effects, path, _build_pairing(settings.get("pairing")))
    return simplify(scene, settings.get("neglect", ()))


def _build_surface(settings: Mapping) -> Surface:
    """Return the surface of a run."""
    section = dict(settings["surface"])
    kind = SURFACES[section.pop("kind")]
    if kind is SelfAffine:
        seed = realisation_seed(settings["seed"], settings["study"], section["hurst_exponent"], settings["member"])
        return _self_affine_surface(canonical(section), seed)
    return _other_surface(kind, canonical(section), settings.get("file_digest"))


@lru_cache(maxsize=16)
def _other_surface(kind: Callable[..., Surface], section: str, file_digest: str | None) -> Surface:
    """Return any other surface; a file of measured heights is read once as long as its digest is the same."""
    return kind(**json.loads(section))


@lru_cache(maxsize=16)
def _self_affine_surface(section: str, seed: tuple[int, ...]) -> SelfAffine:
    """Return a self-affine surface; the same object for all runs on it, so that its waves are drawn once."""
    return SelfAffine(**json.loads(section), seed=seed)


def _build_pairing(section: Mapping | None) -> Pairing:
    """Return how the surfaces are joined; aligned without a section."""
    if section is None:
        return ALIGNED
    options = dict(section)
    return PAIRINGS[options.pop("kind")](**options)


def _build_elasticity(section: Mapping | None, name: str) -> Elasticity | None:
    """Return a body; None for a rigid one, and without a section; name: of the section, for messages."""
    try:
        return None if section is None or section["kind"] == RIGID else make_elasticity(**section)
    except InputError as error:
        raise error.located(None, name) from error


def _build_path(settings: Mapping, surface: Surface, elasticities: list[Elasticity]) -> LoadPath:
    """Return the load path of a run: swept, swept and slid, or single loads."""
    load, slide = settings["load"], settings.get("slide")
    if "control" not in load:
        return _build_loads(settings, surface, elasticities)
    from_touch = load.get("origin") == "first_touch"
    control, points = Trait[load["control"].upper()], tuple(load["through"])
    if slide is None:
        return _swept_path(control, points, load["increment"], from_touch)
    return _sliding_path(
        control, points, load["increment"], from_touch, tuple(slide["through"]), slide["increment"], _held_step(slide)
    )


def _build_loads(settings: Mapping, surface: Surface, elasticities: list[Elasticity]) -> LoadPath:
    """Return single mean pressures from the loads as a study gives them.

    A reduced pressure is multiplied by E*, of two bodies that of the pair, and by the rms gradient: of the
    band-limited profile for self-affine heights, of the differences on the grid for others. A contact ratio is the
    half-width of the contact of a cylinder, or the contact radius of a sphere, over its radius (Eq. 3.5).
    """
    moduli = [body.contact_modulus for body in elasticities]
    contact_modulus = moduli[0] if len(moduli) == 1 else 1 / sum(1 / modulus for modulus in moduli)
    name, values = settings["load"]["name"], np.array(settings["load"]["values"])
    labels = [f"{name}={value:g}" for value in values]
    if name == "reduced_pressure":
        repeats = not any(Trait.FREE in body.traits for body in elasticities)
        gradient = _rms_gradient(surface, settings["points"], repeats)
        if not gradient > 0:
            raise InputError("load", name, "mean_pressure: this surface is flat")
        values = values * contact_modulus * gradient
    elif name == "contact_ratio":
        radius = settings["surface"].get("radius")
        if radius is None:
            raise InputError("load", name, "mean_pressure or reduced_pressure: this surface has no radius")
        if any(Trait.LAYER in body.traits for body in elasticities):
            raise InputError("load", name, "mean_pressure or reduced_pressure: Eq. 3.5 holds on a half-space")
        load = {1: hard_wall.cylinder_load, 2: hard_wall.sphere_load}[len(surface.lengths)]
        values = load(values * radius, radius, contact_modulus) / np.prod(surface.lengths)
    return pressures([float(value) for value in values], labels=labels)


def _rms_gradient(surface: Surface, points: int | None, repeats: bool) -> float:
    """Return the rms gradient that reduced pressures are counted by; repeats: whether the heights do."""
    if isinstance(surface, SelfAffine):
        return surface.profile_rms_gradient
    points = points or surface.points
    if points is None:
        raise InputError("points", None, "a whole number: only a measured surface comes with its own")
    heights = surface.heights(points)
    return STATISTICS[repeats].rms_gradient(heights, Grid(heights.shape, surface.lengths).spacing)


@lru_cache(maxsize=8)
def _swept_path(control: Trait, points: tuple[float, ...], increment: float, from_touch: bool) -> LoadPath:
    """Return a swept path; the same object for all variants of a study, of which there may be many."""
    return sweep(control, points, increment, from_touch)


@lru_cache(maxsize=64)
def _sliding_path(
    control: Trait,
    points: tuple[float, ...],
    increment: float,
    from_touch: bool,
    distances: tuple[float, ...],
    slide_increment: float,
    held: LoadStep,
) -> LoadPath:
    """Return a path that presses, then slides.

    Under the control of the slide it presses on to the value that is held; under the other it changes over in one step.
    """
    further = (held.value,) if held.control is control and points[-1] != held.value else ()
    path = sweep(control, (*points, *further), increment, from_touch)
    if held.control is not control:
        path = path >> LoadPath((held,), from_touch)
    return path >> LoadPath((Slide(distances, slide_increment, held),), from_touch)


def _held_step(slide: Mapping) -> LoadStep:
    """Return the approach or the mean pressure that is held while sliding."""
    name = next(name for name in ("approach", "mean_pressure") if name in slide)
    return LoadStep(Trait[name.upper()], slide[name])


def updated_settings(settings: Mapping, setup: Setup) -> dict:
    """Return the settings of a run with the grid, tolerance and increments of a setup in their place."""
    options, path = setup.options, setup.scene.path
    settings = dict(settings) | {"points": options.points, "tolerance": options.tolerance}
    if options.increments is not None:
        kind = next(name for name, kind in INCREMENTS.items() if type(options.increments) is kind)
        settings["increments"] = {"kind": kind} | vars(options.increments)
    sections = [name for name in ("load", "slide") if "increment" in (settings.get(name) or {})]
    for name, part in zip(sections, (part for part in path.parts if part.increment is not None), strict=True):
        settings[name] = settings[name] | {"increment": part.increment}
    return settings
