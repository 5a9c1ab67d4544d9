"""Grids that an accuracy may lead to: short transforms, enough points for the scene, and not too many in all."""

from __future__ import annotations

import math

from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Scene
from contactsim.errors import InputError
from contactsim.reference import hard_wall
from contactsim.status import process_zone
from contactsim.surfaces.shapes import Cylinder, Sphere
from contactsim.traits import Trait

GRID_FACTORS = (8, 9, 10, 12, 15)
"""Points of a grid are one of these times a power of two: short transforms, and blocks of eight."""
MIN_POINTS = 16
"""Least points of a grid."""
MAX_POINTS = 2**28
"""Most points of a grid that a wanted error may lead to."""
MIN_SIDE = 8
"""Least points along the shorter side of a surface."""
POINTS_PER_WAVE = 2.5
"""Least points for each shortest wavelength."""
POINTS_PER_CONTACT, POINTS_PER_ZONE = 1.0, 0.4
"""Points of the coarsest grid for the half-width of a round contact, and for the process zone of cohesive laws."""
FINE_WAVE, FINE_CONTACT, FINE_ZONE, FINE_ERROR = 16.0, 4.0, 1.4, 0.01
"""The same of the grid that most scenes need for an error of `FINE_ERROR`; it grows with its root."""
MAX_COARSE = {1: 4096, 2: 64}
"""Most points along x of the coarsest grid for the sake of a contact or a process zone, by dimension."""


def round_grid(points: float) -> int:
    """Return the smallest grid with that many points that has short transforms."""
    exponent = max(math.ceil(math.log2(max(points, MIN_POINTS) / GRID_FACTORS[-1])), 0)
    sizes = [factor * 2**power for factor in GRID_FACTORS for power in range(exponent + 2)]
    return min(size for size in sizes if size >= max(points, MIN_POINTS))


def choose_grid(scene: Scene, points: float, error: float) -> int:
    """Return a grid of about that many points which resolves the surface; InputError beyond `MAX_POINTS` in all."""
    surface = scene.upper.surface
    oblong = MIN_SIDE * scene.length / min(scene.lengths)
    points = max(points, oblong, POINTS_PER_WAVE * scene.length / shortest_wave(scene))
    if not math.prod(surface.shape(round_grid(min(points, MAX_POINTS)))) <= MAX_POINTS or points > MAX_POINTS:
        raise InputError("accuracy", error, f"an error for which {MAX_POINTS:.2g} grid points are enough")
    return round_grid(points)


def coarsest_points(scene: Scene) -> float:
    """Return the points along x from which on a grid shows the waves, contacts and process zones of a scene."""
    return _points(scene, POINTS_PER_WAVE, POINTS_PER_CONTACT, POINTS_PER_ZONE, MAX_COARSE[len(scene.lengths)])


def expected_points(scene: Scene, error: float) -> float:
    """Return the points along x that most scenes of the kind need for a relative error."""
    finer = math.sqrt(FINE_ERROR / error)
    return _points(scene, FINE_WAVE * finer, FINE_CONTACT * finer, FINE_ZONE * finer, math.inf)


def _points(scene: Scene, per_wave: float, per_contact: float, per_zone: float, most: float) -> float:
    """Return the points along x with so many for each shortest length of a scene; most: but for its waves."""
    surface, others = scene.upper.surface, [float(MIN_POINTS)]
    loads = [step.value for step in scene.path.steps if step.control is Trait.MEAN_PRESSURE and step.value > 0]
    if scene.kind is ProblemKind.COHESIVE:
        zone = process_zone(scene.contact_modulus, total_strength(scene), shortest_range(scene))
        others.append(per_zone * scene.length / zone)
        if isinstance(surface, Cylinder | Sphere):
            others.append(per_contact * scene.length / math.sqrt(surface.radius * shortest_range(scene)))
    elif isinstance(surface, Cylinder | Sphere) and loads:
        load = min(loads) * math.prod(scene.lengths)
        if len(scene.lengths) == 1:
            half_width = math.sqrt(load / hard_wall.cylinder_load(1.0, surface.radius, scene.contact_modulus))
        else:
            half_width = math.cbrt(load / hard_wall.sphere_load(1.0, surface.radius, scene.contact_modulus))
        others.append(per_contact * scene.length / half_width)
    return max(min(max(others), most), per_wave * scene.length / shortest_wave(scene))


def shortest_wave(scene: Scene) -> float:
    """Return the shortest wavelength (nm) of both surfaces; infinite where there are no waves."""
    modes = max(body.surface.modes or 0 for body in (scene.lower, scene.upper))
    return scene.length / modes if modes else math.inf


def shortest_range(scene: Scene) -> float:
    """Return the shortest length (nm) over which the cohesive laws of a scene change."""
    return min(law.interaction_range for law in scene.laws)


def total_strength(scene: Scene) -> float:
    """Return the strength (GPa) of all cohesive laws of a scene together."""
    return sum(law.strength for law in scene.laws)
