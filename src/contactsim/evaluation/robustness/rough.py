"""Rough adhesive contacts that get harder: from severity 0 to 100, and what is right at each.

The rough line is a small one of Chapter 5. It is not its own mirror image: ridges that are would jump one by one, and
which of them is first would be a matter of rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.contact.loading import approaches
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.evaluation.robustness.path_cases import PathCase
from contactsim.grid import Array
from contactsim.interface.base import Law
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.surfaces.shapes import Flat

LENGTH, ROLLOFF, SHORTEST = 1280.0, 320.0, 20.0
"""Period, roll-off and shortest wavelength (nm): 64 waves, four points each on 256."""
POINTS, HEIGHT, HURST = 256, 2.5, 0.8
"""Points; rms height (nm) and Hurst exponent."""
MODULUS, RATIO, WORK = 70.0, 0.45, 10.5
"""Of Chapter 5: Young's modulus (GPa), Poisson's ratio, and the strong work of separation (N/m), φn* = 0.15."""


@dataclass(frozen=True)
class Ridges:
    """A self-affine line: waves of the amplitudes of Eq. 3.10 and of any phase.

    rms_height (nm) is met exactly.
    """

    rms_height: float = HEIGHT
    hurst_exponent: float = HURST
    length: float = LENGTH
    points = None

    @property
    def modes(self) -> int:
        """Waves in the period, at most."""
        return round(self.length / SHORTEST)

    @property
    def lengths(self) -> tuple[float, ...]:
        """The period, nm."""
        return (self.length,)

    def shape(self, points: int) -> tuple[int, ...]:
        """Shape of the heights."""
        return (points,)

    def check(self, points: int) -> None:
        """Any number will do that is even: hazards choose it."""

    def heights(self, points: int) -> Array:
        """Heights (points,), nm."""
        wave = np.arange(1, self.modes)
        phase = np.random.default_rng(5).uniform(0.0, 2 * np.pi, wave.size)
        size = np.maximum(wave * ROLLOFF / self.length, 1.0) ** (-(1 + 2 * self.hurst_exponent) / 2)
        size *= self.rms_height / np.sqrt(np.sum(size**2) / 2)
        return np.cos(2 * np.pi * np.outer(np.arange(points) / points, wave) + phase) @ size


def _pressed(law: Law, depths: list[float], ratio: float = RATIO, surface: Ridges | None = None) -> Scene:
    """A scene whose path goes to these approaches beyond first touch (nm)."""
    surface = surface or Ridges()
    touch = -float(surface.heights(POINTS).max())
    body = HalfSpace(MODULUS / (1 - ratio**2), ratio)
    path = approaches([touch + depth for depth in depths])
    return Scene(Body(Flat.facing(surface), body), Body(surface, None), (law,), path)


def _steps(begin: float, end: float, size: float = 0.25) -> list[float]:
    """Depths (nm) from one, exclusive, to another: small steps, as rough contacts jump again and again."""
    count = round((end - begin) / size)
    return [begin + (end - begin) * k / count for k in range(1, count + 1)]


def _case(scene: Scene, depth: float, parts: int) -> PathCase:
    """A path from 8 nm before its first step, the depth (nm) of which is beyond first touch; parts as `PathCase`."""
    return PathCase(scene, POINTS, begin=scene.path.steps[0].value - depth - 8.0, parts=parts, even=False)


def soft_wall(severity: float) -> PathCase:
    """On a rough line adhesion gets weaker, φn* from 0.15 to 1.5e-7, and with it the law's push: a soft wall."""
    return _case(_pressed(NormalCohesiveZone(WORK * 1e-6 ** (severity / 100)), _steps(-5.0, -1.5)), -4.75, 2)


def steep_ridges(severity: float) -> PathCase:
    """A rough line gets higher, its rms gradient from 0.2 to 10, far beyond small slopes: still an equilibrium."""
    surface = Ridges(HEIGHT * 50 ** (severity / 100))
    return _case(_pressed(NormalCohesiveZone(WORK), [-3.0, 0.0], surface=surface), -3.0, 0)


def jagged_line(severity: float) -> PathCase:
    """A rough line gets more jagged, H from 0.8 down to 0 at equal rms height: the branch is that of small steps."""
    surface = Ridges(hurst_exponent=HURST * (1 - severity / 100))
    return _case(_pressed(NormalCohesiveZone(WORK), _steps(-5.0, 0.0), surface=surface), -4.75, 2)


def rough_process_zone(severity: float) -> PathCase:
    """On a rough line the process zone shrinks from 30 to 1 grid spacings: what the grid can tell is solved."""
    law = NormalCohesiveZone(WORK * 30 ** (severity / 100) * 0.4)
    return _case(_pressed(law, [-3.0, -1.0]), -3.0, 0)


def one_large_step(severity: float) -> PathCase:
    """Rough bodies meet in ever fewer steps, from 0.25 nm to one of 4 nm: as in the smallest of them."""
    count = max(round(16 ** (1 - severity / 100)), 1)
    depths = [-5.0 + 4.0 * k / count for k in range(1, count + 1)]
    return _case(_pressed(NormalCohesiveZone(WORK), depths), depths[0], round(16 / count))


def frictionless_flow(severity: float) -> PathCase:
    """A rough compressible body, coupled but frictionless, pressed from -3 nm to touch: no energy, so it must flow."""
    depth = -3.0 + 3.0 * severity / 100
    return _case(_pressed(CohesiveZone(WORK), [-4.0, depth], 0.1), -4.0, 0)


ROUGH = (soft_wall, steep_ridges, jagged_line, rough_process_zone, one_large_step, frictionless_flow)
"""In the order of the map."""
