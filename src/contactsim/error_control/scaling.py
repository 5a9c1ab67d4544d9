"""Families of scenes with measured relations, and the features in which these relations are power laws.

At a hard wall the error of the grid follows the size of the contacts that it has to show; with cohesive laws it follows
the process zone and the contact. The error of a path follows its increments. Work and time follow the grid, the steps
and what acts. `contactsim.error_control.relations` has the relations.
"""

from __future__ import annotations

import itertools

import numpy as np

from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Scene
from contactsim.error_control.measured import MeasuredRoughness, is_measured, measure_roughness
from contactsim.errors import InputError
from contactsim.reference import hard_wall
from contactsim.status import process_zone
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.surfaces.shapes import Cylinder, Sphere
from contactsim.traits import Trait

LINE, SURFACE, PATH, ROUGH_PATH, SLIDE = FAMILIES = ("line", "surface", "path", "rough_path", "slide")
"""Families of scenes with relations: lines and surfaces under loads at a hard wall; asperities, and rough lines, along
a path of cohesive laws; asperities that slide."""
QUANTITIES = {
    LINE: ("relative_contact_area_subgrid",),
    SURFACE: ("relative_contact_area_subgrid",),
    PATH: ("pull_off_load_loading", "final_contact_length"),
    ROUGH_PATH: ("final_contact_length", "final_interacting_length"),
    SLIDE: ("static_friction",),
}
"""Quantities whose relative error counts where no others are named."""
COUNTED_AREA = "relative_contact_area"
GRID_ORDERS = {COUNTED_AREA: 1.0, "final_interacting_length": 1.0}
"""Orders in the grid spacing for quantities that count points; all others have the default."""
DEFAULT_GRID_ORDER = 2.0
TYPICAL_KAPPA = 1.75
"""Contact area over reduced pressure of a lightly loaded rough surface, about that of Persson and of Bush."""


def scene_family(scene: Scene) -> str:
    """Return the family of a scene.

    Raises
    ------
    InputError
        For a scene whose errors and costs were not measured.
    """
    return FAMILY_READERS[scene.kind](scene, _rough_surface(scene) is not None)


def _rough_surface(scene: Scene) -> SelfAffine | MeasuredRoughness | None:
    """Return the surface of a rough scene, measured heights by their roughness; None for a round one.

    Raises
    ------
    InputError
        For surfaces that were not measured.
    """
    if is_measured(scene):
        return measure_roughness(scene)
    surface = scene.upper.surface
    if isinstance(surface, SelfAffine):
        return surface
    if not isinstance(surface, Cylinder | Sphere):
        allowed = "a cylinder, a sphere, a self-affine surface or measured heights: the costs of others are not known"
        raise InputError("surface", type(surface).__name__, allowed)
    return None


def _radius(scene: Scene) -> float:
    """Return the radius (nm) of a round surface."""
    surface = scene.upper.surface
    if not isinstance(surface, Cylinder | Sphere):
        raise InputError("surface", type(surface).__name__, "a cylinder or sphere")
    return surface.radius


def _load_family(scene: Scene, rough: bool) -> str:
    """Return the family of loads at a hard wall."""
    if Trait.APPROACH in scene.traits:
        raise InputError("path", "approach", "loads: walls at given approaches were not measured")
    for step in scene.path.steps:
        if not step.value > 0:
            raise InputError("mean_pressure", step.value, "above zero: bodies that hardly touch were not measured")
    return SURFACE if Trait.SURFACE in scene.traits else LINE


def _path_family(scene: Scene, rough: bool) -> str:
    """Return the family of a path of cohesive laws."""
    if Trait.SURFACE in scene.traits:
        raise InputError(
            "surface", type(scene.upper.surface).__name__, "a line: smooth laws on surfaces have no relations"
        )
    if Trait.MEAN_PRESSURE in scene.traits:
        raise InputError("path", "mean_pressure", "approaches: paths under given loads were not measured")
    if scene.sliding and rough:
        surface = type(scene.upper.surface).__name__
        raise InputError("slide", surface, "a slide of a cylinder: rough ones were not measured")
    if scene.sliding:
        return SLIDE
    return ROUGH_PATH if rough else PATH


FAMILY_READERS = {ProblemKind.HARD_WALL: _load_family, ProblemKind.COHESIVE: _path_family}


def shortest_range(scene: Scene) -> float:
    """Return the shortest length (nm) over which the cohesive laws of a scene change."""
    return min(law.interaction_range for law in scene.laws)


def total_strength(scene: Scene) -> float:
    """Return the strength (GPa) of all cohesive laws of a scene together."""
    return sum(law.strength for law in scene.laws)


def features(scene: Scene) -> list[dict[str, float]]:
    """Return numbers without units that describe a scene, whatever its grid: for each load, or for its path."""
    family, surface = scene_family(scene), _rough_surface(scene)
    bodies = scene.elasticities
    numbers = {"one": 1.0, "rough": 0.0, "hurst_exponent": 0.0, "bandwidth": 0.0, "bodies": float(len(bodies))}
    numbers["layers"] = float(sum(Trait.LAYER in body.traits for body in bodies))
    if surface is not None:
        bandwidth = np.log(surface.long_cutoff / surface.effective_short_cutoff)
        numbers |= {"rough": 1.0, "hurst_exponent": surface.hurst_exponent, "bandwidth": float(bandwidth)}
    if family in (LINE, SURFACE):
        return [numbers | _load_features(scene, step.value) for step in scene.path.steps]
    return [numbers | _path_features(scene)]


def _path_features(scene: Scene) -> dict[str, float]:
    """Return the features of a path of cohesive laws."""
    length, strength = shortest_range(scene), total_strength(scene)
    deepest = _deepest_approach(scene)
    zone, size = process_zone(scene.contact_modulus, strength, length), contact_scale(scene)
    values = [step.value for step in scene.path.steps]
    increments = [abs(after - before) for before, after in itertools.pairwise(values)] or [1.0]
    return {
        "deep": float(np.log(max(deepest, length) / length)),
        "steps": float(np.log(len(values))),
        "span": float(np.log(sum(increments) / length)),
        "zone": float(np.log(size / zone)),
        "strength": float(np.log(strength / scene.contact_modulus)),
        "coupled": float("t" in scene.components),
        "friction": float("t" in scene.exerted),
    }


def _load_features(scene: Scene, pressure: float) -> dict[str, float]:
    """Return the features of a load: logarithms of the reduced pressure and of the expected contact area."""
    surface = _rough_surface(scene)
    if surface is not None:
        reduced = pressure / (scene.contact_modulus * surface.profile_rms_gradient)
        area = min(TYPICAL_KAPPA * reduced, 1.0)
    else:
        size = contact_scale(scene, pressure)
        area = min(2 * size, scene.length) / scene.length
        area = area if len(scene.lengths) == 1 else np.pi / 4 * area**2
        reduced = area
    return {"pressure": float(np.log(reduced)), "area": float(np.log(area))}


def contact_scale(scene: Scene, pressure: float = 0.0) -> float:
    """Return the length (nm) that contacts are measured by.

    It is the shortest wavelength of a rough surface, and the half-width or radius of the contact of a round one:
    by Hertz at a mean pressure (GPa) on a hard wall, at the deepest approach along a path.
    """
    surface = _rough_surface(scene)
    if surface is not None:
        return surface.effective_short_cutoff
    return ROUND_SCALES[scene.kind](scene, pressure)


def _hertz_scale(scene: Scene, pressure: float) -> float:
    """Return the half-width or radius of the contact of a round surface at a mean pressure (GPa) on a hard wall."""
    radius = _radius(scene)
    load = pressure * float(np.prod(scene.lengths))
    if len(scene.lengths) == 1:
        return float(np.sqrt(load / hard_wall.cylinder_load(1.0, radius, scene.contact_modulus)))
    return float(np.cbrt(load / hard_wall.sphere_load(1.0, radius, scene.contact_modulus)))


def _indentation_scale(scene: Scene, pressure: float) -> float:
    """Return the half-width of a round surface at the deepest approach of a path."""
    return float(np.sqrt(_radius(scene) * max(_deepest_approach(scene), shortest_range(scene))))


ROUND_SCALES = {ProblemKind.HARD_WALL: _hertz_scale, ProblemKind.COHESIVE: _indentation_scale}


def _deepest_approach(scene: Scene) -> float:
    """Return the largest approach (nm) before any slide."""
    return max(step.value for step in scene.path.steps if step.held is None)
