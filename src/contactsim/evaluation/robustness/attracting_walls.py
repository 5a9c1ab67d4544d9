"""Paths along a hard wall that attracts, on surfaces, that get harder: from severity 0 to 100."""

from __future__ import annotations

from contactsim.contact.loading import LoadPath, approaches
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.evaluation.robustness.wall_path_cases import WallPathCase
from contactsim.interface.attraction import ExponentialAttraction
from contactsim.interface.hard_wall import HardWall
from contactsim.reference.adhesive_sphere import maugis_parameter
from contactsim.surfaces.base import Surface
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.surfaces.shapes import Flat, Sphere

MODULUS, RATIO, RADIUS, LENGTH = 1.0, 0.3, 1000.0, 600.0
"""Contact modulus, GPa, Poisson's ratio, and radius and period of a sphere, nm."""
SIDE, POINTS = 128.0, 16
"""Period of a rough surface, nm, and points along a side of all cases."""


def _pressed(law: ExponentialAttraction, path: LoadPath, surface: Surface, body: Elasticity | None = None) -> Scene:
    lower = Body(Flat.facing(surface), body or HalfSpace(MODULUS, RATIO))
    return Scene(lower, Body(surface), (HardWall(), law), path)


def _rough(height: float) -> SelfAffine:
    """A rough surface of some rms height (nm), with four points to the shortest wavelength."""
    return SelfAffine(SIDE, 0.8, SIDE / 2, SIDE / 4, rms_height=height, dimensions=2, seed=3)


def attracting_wall_sphere(severity: float) -> WallPathCase:
    """Maugis's parameter of a sphere at a hard wall rises from 0.1, where DMT holds, to 1: pressed, and pulled off."""
    strength = 0.1 * 10 ** (severity / 100) / maugis_parameter(1.0, RADIUS, MODULUS, 1.0)
    law = ExponentialAttraction(1.0, 1.0 / strength)
    return WallPathCase(_pressed(law, approaches([2.0, -30.0]), Sphere(radius=RADIUS, length=LENGTH)), POINTS, parts=8)


def attracting_wall_range(severity: float) -> WallPathCase:
    """The attraction of a hard wall on a rough surface gets shorter, from 2 to 0.2 nm, at equal strength."""
    length, surface = 2 * 10 ** (-severity / 100), _rough(3.0)
    touch = -float(surface.heights(POINTS).max())
    path = approaches([touch + length * place for place in (0.0, 1.0, 2.0)])
    law = ExponentialAttraction(0.02 * length, length)
    return WallPathCase(_pressed(law, path, surface), POINTS, parts=4, begin=touch - length)


def attracting_wall_strength(severity: float) -> WallPathCase:
    """The attraction of a hard wall gets weaker beside the same pressures, to a hundredth of its strength."""
    surface = _rough(3.0)
    touch = -float(surface.heights(POINTS).max())
    law = ExponentialAttraction(0.02 * 10 ** (-severity / 50))
    path = approaches([touch + place for place in (0.0, 1.0, 2.0)])
    return WallPathCase(_pressed(law, path, surface), POINTS, parts=4, begin=touch - 1.0)


def attracting_wall_fill(severity: float) -> WallPathCase:
    """A rough surface is pressed deeper into a thin layer at a wall that attracts, until nearly all of it is closed."""
    law, body = ExponentialAttraction(0.02), Layer(MODULUS, RATIO, SIDE / 8)
    path = approaches([-2.0, 4.0 * severity / 100])
    return WallPathCase(_pressed(law, path, _rough(2.0), body), POINTS, parts=4, begin=-4.0)


ATTRACTING_WALLS = (attracting_wall_sphere, attracting_wall_range, attracting_wall_strength, attracting_wall_fill)
"""In the order of the map."""
