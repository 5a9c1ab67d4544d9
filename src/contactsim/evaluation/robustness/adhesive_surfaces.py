"""Paths of smooth adhesive laws on surfaces that get harder: from severity 0 to 100, and what is right at each."""

from __future__ import annotations

import numpy as np

from contactsim.contact.loading import LoadPath, approaches
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.evaluation.robustness.surface_path_cases import SurfacePathCase
from contactsim.interface.cohesive_zone import NormalCohesiveZone
from contactsim.reference.adhesive_sphere import maugis_parameter
from contactsim.surfaces.base import Surface
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.surfaces.shapes import Flat, Sphere
from contactsim.surfaces.topography import Topography

MODULUS, RATIO, RADIUS, LENGTH, POINTS = 1.0, 0.3, 1000.0, 600.0, 32
"""Contact modulus, GPa, Poisson's ratio, radius and period of a sphere, nm, and points along a side."""
SPACING = LENGTH / POINTS
SIDE, ROUGH_POINTS = 256.0, 32
"""Period of a rough surface, nm, and its points along a side."""


def _pressed(law: NormalCohesiveZone, path: LoadPath, surface: Surface, body: Elasticity | None = None) -> Scene:
    return Scene(Body(Flat.facing(surface), body or HalfSpace(MODULUS, RATIO)), Body(surface), (law,), path)


def _rough(height: float) -> SelfAffine:
    """A rough surface of some rms height (nm), with four points to the shortest wavelength."""
    return SelfAffine(SIDE, 0.8, SIDE / 2, SIDE / 8, rms_height=height, dimensions=2, seed=3)


def soft_sphere(severity: float) -> SurfacePathCase:
    """Maugis's parameter of a sphere rises from 0.1, where DMT holds, to 3: pressed, and pulled off in one step."""
    size = 0.1 * 30 ** (severity / 100)
    strength = size / maugis_parameter(1.0, RADIUS, MODULUS, 1.0)
    law = NormalCohesiveZone(1.0, 1.0 / (np.e * strength))
    return SurfacePathCase(_pressed(law, approaches([2.0, -30.0]), Sphere(radius=RADIUS, length=LENGTH)), parts=24)


def unresolved_zone(severity: float) -> SurfacePathCase:
    """Grid spacings per process zone of a sphere rise from 0.2 to 4: what the grid can tell is solved."""
    work = np.e**2 * MODULUS / SPACING * 0.2 * 20 ** (severity / 100)
    return SurfacePathCase(_pressed(NormalCohesiveZone(work), approaches([2.0]), Sphere(radius=RADIUS, length=LENGTH)))


def short_ranged_surface(severity: float) -> SurfacePathCase:
    """The law on a rough surface gets shorter, δn from 1 to 0.1 nm, at equal strength; steps shorten with it."""
    length = 10 ** (-severity / 100)
    law, surface = NormalCohesiveZone(0.02 * np.e * length, length), _rough(3.0)
    touch = -float(surface.heights(ROUGH_POINTS).max())
    path = approaches([touch + length * place for place in (-4.0, 0.0, 4.0)])
    return SurfacePathCase(_pressed(law, path, surface), ROUGH_POINTS, parts=4, begin=touch - 8.0 * length)


def steep_surface(severity: float) -> SurfacePathCase:
    """The rms height of a rough surface rises from 0.3 to 30 nm, and its slopes with it."""
    surface = _rough(0.3 * 100 ** (severity / 100))
    touch = -float(surface.heights(ROUGH_POINTS).max())
    path = approaches([touch, touch + 4.0])
    return SurfacePathCase(_pressed(NormalCohesiveZone(0.1), path, surface), ROUGH_POINTS, parts=6, begin=touch - 8.0)


def snap_in(severity: float) -> SurfacePathCase:
    """One step takes a sphere from apart to 1, then 30 lengths of the law beyond touch."""
    path = approaches([2.0 * 30 ** (severity / 100)])
    return SurfacePathCase(_pressed(NormalCohesiveZone(0.3, 2.0), path, Sphere(radius=RADIUS, length=LENGTH)))


def oblong_cell(severity: float) -> SurfacePathCase:
    """The cell of a sphere gets narrower, from 1 to 1/16 of its length, with as many points: neighbours touch."""
    width = LENGTH / 16 ** (severity / 100)
    y, x = (np.arange(POINTS) / POINTS - 0.5) * width, (np.arange(POINTS) / POINTS - 0.5) * LENGTH
    heights = -(y[:, None] ** 2 + x**2) / (2 * RADIUS)
    surface = Topography(heights, (width / POINTS, LENGTH / POINTS))
    return SurfacePathCase(_pressed(NormalCohesiveZone(0.3, 2.0), approaches([-4.0, 2.0]), surface))


def adhesive_fill(severity: float) -> SurfacePathCase:
    """A rough surface is pressed deeper into a thin layer, until half of its area is closed, then nearly all."""
    law, body = NormalCohesiveZone(0.5), Layer(MODULUS, RATIO, SIDE / 8)
    path = approaches([-4.0, 5.0 * severity / 100])
    return SurfacePathCase(_pressed(law, path, _rough(2.0), body), ROUGH_POINTS, parts=8)


ADHESIVE_SURFACES = (
    soft_sphere,
    unresolved_zone,
    short_ranged_surface,
    steep_surface,
    snap_in,
    oblong_cell,
    adhesive_fill,
)
"""In the order of the map."""
