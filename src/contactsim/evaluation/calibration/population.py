"""Draw scenes of all kinds at random, to calibrate errors and to put them on trial.

Lengths are nm, pressures GPa. Every kind states its ranges where it draws; numbers between bounds that lie far apart
are uniform in their logarithm. A scene follows from seed, kind and number alone.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contactsim.contact.loading import LoadPath, approaches, pressures, sliding
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import FreeHalfSpace, HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.interface.attraction import DugdaleAttraction, ExponentialAttraction
from contactsim.interface.base import Law
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.interface.hard_wall import HardWall
from contactsim.interface.lattice import Lattice
from contactsim.reference import hard_wall
from contactsim.status import process_zone
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.surfaces.shapes import Cylinder, Sinusoid, Sphere

LENGTH = 1e4
"""Period of scenes at a hard wall, which has no length of its own."""
MODULUS = 70.0
"""Contact modulus of scenes with laws."""


class Draw:
    """Random numbers of one scene."""

    def __init__(self, seed: int, kind: str, count: int) -> None:
        self.rng = np.random.default_rng([seed, KIND_NAMES.index(kind), count])

    def wide(self, low: float, high: float) -> float:
        """Return a number between two bounds with four digits, uniform in its logarithm."""
        return float(f"{np.exp(self.rng.uniform(*np.log([low, high]))):.4g}")

    def even(self, low: float, high: float) -> float:
        """Return a number between two bounds with four digits."""
        return float(f"{self.rng.uniform(low, high):.4g}")

    def chance(self, share: float) -> bool:
        """Return True in a share of all cases."""
        return bool(self.rng.uniform() < share)

    def body(self, length: float, modulus: float = 1.0, layers: float = 0.5) -> Elasticity:
        """Return a half-space or, in a share of cases, a layer of 0.01 to 3 lengths; Poisson's ratio 0 to 0.5."""
        ratio = self.even(0.0, 0.5)
        return (
            Layer(modulus, ratio, self.wide(0.01, 3.0) * length) if self.chance(layers) else HalfSpace(modulus, ratio)
        )

    def rough(
        self, dimensions: int, waves: tuple[float, float], length: float = LENGTH, rms_height: float | None = None
    ) -> SelfAffine:
        """Return a self-affine surface: so many shortest waves a period, 1 to 6 longest, H from 0.1 to 0.95."""
        shortest = self.wide(*waves)
        longest = min(self.wide(1.0, 6.0), shortest / 3)
        return SelfAffine(
            length,
            self.even(0.1, 0.95),
            length / longest,
            length / shortest,
            rms_height=rms_height,
            rms_gradient=self.wide(0.02, 0.3) if rms_height is None else None,
            dimensions=dimensions,
            seed=int(self.rng.integers(2**31)),
        )

    def loads(self, low: float, high: float) -> LoadPath:
        """Return one to three mean pressures between two bounds."""
        return pressures(sorted({self.wide(low, high) for _ in range(self.rng.integers(1, 4))}))


def _rough_wall(draw: Draw, upper: SelfAffine | Body, lower: Elasticity | Body) -> Scene:
    """Return a rough surface of at least 0.02 slope under mean pressures of 0.002 to 0.5 GPa times its slope."""
    surface = upper.surface if isinstance(upper, Body) else upper
    slope = (surface.rms_gradient if isinstance(surface, SelfAffine) else None) or 0.02
    return Scene(lower, upper, HardWall(), draw.loads(2e-3 * slope, 0.5 * slope))


def _free_surface(draw: Draw) -> Scene:
    """Return a rough surface or a sphere that does not repeat."""
    if draw.chance(0.5):
        return _rough_wall(draw, draw.rough(2, (3, 10)), FreeHalfSpace(1.0))
    return _sphere_on(draw, FreeHalfSpace(1.0))


def _two_bodies(draw: Draw) -> Scene:
    """Return two bodies of which one or both are elastic: a rough line against a cylinder or another rough line."""
    upper = draw.rough(1, (8, 100))
    other = draw.rough(1, (8, 100)) if draw.chance(0.5) else Cylinder(LENGTH, draw.wide(2.0, 50.0) * LENGTH)
    lower = Body(other, draw.body(LENGTH, draw.wide(0.2, 5.0)))
    body = Body(upper, HalfSpace(draw.wide(0.2, 5.0))) if draw.chance(0.7) else upper
    return _rough_wall(draw, body, lower)


def _waves(draw: Draw) -> Scene:
    """Return a sinusoid of 1 to 8 periods, a line or a surface, under 1 to 95 % of the load of full contact."""
    dimensions, periods = 1 + draw.chance(0.5), int(draw.rng.integers(1, 9))
    amplitude = draw.wide(1e-3, 0.05) * LENGTH / periods
    full = np.pi * amplitude * periods / LENGTH * np.sqrt(2) ** (dimensions - 1)
    return Scene(
        HalfSpace(1.0),
        Sinusoid(LENGTH, amplitude, periods, dimensions),
        HardWall(),
        draw.loads(0.01 * full, 0.95 * full),
    )


def _cylinder(draw: Draw) -> Scene:
    """Return a cylinder whose half-width by Hertz is 0.3 to 40 % of the period, on a half-space or a layer."""
    radius = draw.wide(0.3, 10.0) * LENGTH
    loads = hard_wall.cylinder_load(np.array([3e-3, 0.4]) * LENGTH, radius, 1.0) / LENGTH
    return Scene(draw.body(LENGTH), Cylinder(LENGTH, radius), HardWall(), draw.loads(*loads))


def _sphere_on(draw: Draw, body: Elasticity) -> Scene:
    """Return a sphere whose contact radius by Hertz is 4 to 40 % of the period."""
    radius = draw.wide(0.5, 10.0) * LENGTH
    loads = hard_wall.sphere_load(np.array([0.04, 0.4]) * LENGTH, radius, 1.0) / LENGTH**2
    return Scene(body, Sphere(LENGTH, radius), HardWall(), draw.loads(*loads))


def _adhesive_shape(draw: Draw, radii: tuple[float, float], tabor: tuple[float, float]) -> tuple[float, float, float]:
    """Return radius, work of separation of a law of 1 nm, and deepest approach, of 1 to 12 nm."""
    radius = draw.wide(*radii)
    work = draw.wide(*tabor) ** 1.5 * MODULUS / np.sqrt(radius)  # Tabor's parameter is (R φ² / E*² δ³)^(1/3)
    return radius, float(f"{work:.4g}"), draw.wide(1.0, 12.0)


def _period(draw: Draw, radius: float, work: float, deepest: float) -> float:
    """Return a period of 3 to 8 times the contact and the zone beside it."""
    zone = process_zone(MODULUS, work / np.e, 1.0)
    return draw.wide(3.0, 8.0) * 2 * (np.sqrt(2 * radius * deepest) + min(zone, radius / 4))


def _law(draw: Draw, work: float) -> Law:
    """Return a law of that work: normal alone, coupled with or without friction, or uncoupled."""
    laws = (
        NormalCohesiveZone(work, 1.0),
        CohesiveZone(work, 0.0),
        CohesiveZone(work, draw.even(0.1, 1.0), 1.0, draw.wide(0.5, 2.0)),
        UncoupledCohesiveZone(work, draw.even(0.1, 1.0)),
    )
    return laws[draw.rng.integers(len(laws))]


def _there_and_back(draw: Draw, deepest: float) -> LoadPath:
    """Return an approach to a depth and, in two cases of three, back to pull-off."""
    return approaches([-3.0, deepest, *([-12.0] if draw.chance(2 / 3) else [])], 0.5)


def _adhesive_cylinder(draw: Draw) -> Scene:
    """Return a cylinder of 0.5 to 50 µm with a cohesive law, Tabor's parameter 0.3 to 5, pressed and pulled off."""
    radius, work, deepest = _adhesive_shape(draw, (500.0, 5e4), (0.3, 5.0))
    length = _period(draw, radius, work, deepest)
    return Scene(draw.body(length, MODULUS), Cylinder(length, radius), _law(draw, work), _there_and_back(draw, deepest))


def _loaded_cylinder(draw: Draw) -> Scene:
    """Return a cylinder with a normal law under mean pressures, to 2 to 20 times the largest pull's and back."""
    radius, work, deepest = _adhesive_shape(draw, (500.0, 2e4), (0.3, 3.0))
    length = _period(draw, radius, work, deepest)
    most = float(hard_wall.cylinder_load(np.sqrt(radius * deepest), radius, MODULUS)) / length
    path = pressures([0.0, most, *([0.1 * most] if draw.chance(0.5) else [])], most / 12)
    return Scene(draw.body(length, MODULUS), Cylinder(length, radius), NormalCohesiveZone(work, 1.0), path)


def _attracting_wall(draw: Draw) -> Scene:
    """Return a cylinder or a rough line on a hard wall that attracts, exponentially or by a constant traction."""
    radius, work, deepest = _adhesive_shape(draw, (500.0, 2e4), (0.2, 2.0))
    length = _period(draw, radius, work, deepest)
    law = ExponentialAttraction(work, 1.0) if draw.chance(0.5) else DugdaleAttraction(work, 1.0, draw.even(0.2, 1.0))
    if draw.chance(0.3):
        rough = draw.rough(1, (6, 40), length, rms_height=draw.wide(0.5, 5.0))
        return Scene(HalfSpace(MODULUS), rough, (HardWall(), law), approaches([-2.0, deepest], 0.5, from_touch=True))
    return Scene(
        draw.body(length, MODULUS), Cylinder(length, radius), (HardWall(), law), _there_and_back(draw, deepest)
    )


def _adhesive_line(draw: Draw) -> Scene:
    """Return a rough line with a cohesive law, 2 to 20 nm rough, approached by 2 to 15 nm from first touch."""
    length = draw.wide(2000.0, 2e4)
    surface = draw.rough(1, (8, 60), length, rms_height=draw.wide(2.0, 20.0))
    path = approaches([-5.0, draw.even(2.0, 15.0), *([-8.0] if draw.chance(1 / 3) else [])], 1.0, from_touch=True)
    return Scene(draw.body(length, MODULUS, 0.3), surface, _law(draw, draw.wide(0.3, 8.0)), path)


def _adhesive_surface(draw: Draw) -> Scene:
    """Return a sphere or a rough surface with a normal law, pressed and in half of the cases pulled off."""
    if draw.chance(0.7):
        radius, work, deepest = _adhesive_shape(draw, (200.0, 3000.0), (0.3, 1.5))
        length = 0.7 * _period(draw, radius, work, deepest)
        return Scene(
            HalfSpace(MODULUS), Sphere(length, radius), NormalCohesiveZone(work, 1.0), _there_and_back(draw, deepest)
        )
    length = draw.wide(300.0, 1000.0)
    surface = draw.rough(2, (3, 6), length, rms_height=draw.wide(0.5, 3.0))
    path = approaches([-3.0, draw.even(1.0, 5.0)], 0.5, from_touch=True)
    return Scene(HalfSpace(MODULUS), surface, NormalCohesiveZone(draw.wide(0.5, 5.0), 1.0), path)


def _slide(draw: Draw) -> Scene:
    """Return a cylinder with friction that is pressed and slides, in a quarter of the cases over a lattice."""
    radius, depth = draw.wide(2000.0, 5e4), draw.even(-1.0, 8.0)
    law = CohesiveZone(draw.wide(0.3, 5.0), draw.even(0.1, 1.0), 1.0, draw.wide(0.5, 2.0))
    body = (
        HalfSpace(MODULUS, 0.3)
        if draw.chance(0.4)
        else Layer(MODULUS, draw.even(0.1, 0.5), draw.wide(0.05, 1.0) * radius)
    )
    path = approaches([-2.0, depth], 0.5) >> sliding([0.0, 40.0], 0.5, approach=depth)
    cylinder = Cylinder(radius * draw.wide(0.3, 2.0), radius)
    if draw.chance(0.25):
        sites = Lattice(cylinder.length / round(cylinder.length / draw.even(1.5, 4.0)), 5.0)
        return Scene(None, Body(cylinder, body), law, path, sites)
    return Scene(body, cylinder, law, path)


KINDS: dict[str, Callable[[Draw], Scene]] = {
    "rough_line": lambda draw: _rough_wall(draw, draw.rough(1, (8, 500)), HalfSpace(1.0)),
    "line_on_a_layer": lambda draw: _rough_wall(draw, draw.rough(1, (8, 300)), draw.body(LENGTH, layers=1.0)),
    "rough_surface": lambda draw: _rough_wall(draw, draw.rough(2, (4, 20)), draw.body(LENGTH)),
    "free_surface": _free_surface,
    "two_bodies": _two_bodies,
    "waves": _waves,
    "cylinder": _cylinder,
    "sphere": lambda draw: _sphere_on(draw, draw.body(LENGTH)),
    "adhesive_cylinder": _adhesive_cylinder,
    "cylinder_under_load": _loaded_cylinder,
    "attracting_wall": _attracting_wall,
    "rough_adhesive_line": _adhesive_line,
    "adhesive_surface": _adhesive_surface,
    "slide": _slide,
}
"""How scenes of each kind are drawn. Rough lines have 8 to 500 waves, on layers 8 to 300, surfaces 4 to 20 each way."""
KIND_NAMES = tuple(KINDS)


def draw_scene(seed: int, kind: str, count: int) -> Scene:
    """Return a scene by its seed, kind, of `KINDS`, and number."""
    return KINDS[kind](Draw(seed, kind, count))
