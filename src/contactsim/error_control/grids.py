"""Grids that an accuracy may lead to: short transforms, enough points for the surface, and not too many in all."""

from __future__ import annotations

import math

from contactsim.contact.scene import Scene
from contactsim.errors import InputError

GRID_FACTORS = (8, 9, 10, 12, 15)
"""Points of a grid are one of these times a power of two: short transforms, and blocks of eight."""
MIN_POINTS = 16
"""Least points of a grid; a run has twice as many, as its coarse companion has fewer."""
MAX_POINTS = 2**28
"""Most points of a grid that a wanted error may lead to."""
MIN_SIDE = 8
"""Least points along the shorter side of a surface."""
POINTS_PER_WAVE = 2.5
"""Least points for each shortest wavelength."""


def round_grid(points: float) -> int:
    """Return the smallest grid with that many points that has short transforms."""
    exponent = max(math.ceil(math.log2(max(points, MIN_POINTS) / GRID_FACTORS[-1])), 0)
    sizes = [factor * 2**power for factor in GRID_FACTORS for power in range(exponent + 2)]
    return min(size for size in sizes if size >= max(points, MIN_POINTS))


def choose_grid(scene: Scene, points: float, error: float) -> int:
    """Return a grid of about that many points which resolves the surface.

    Raises
    ------
    InputError
        Where it has more than `MAX_POINTS` points in all; `error` is named as the cause.
    """
    surface = scene.upper.surface
    oblong = MIN_SIDE * scene.length / min(scene.lengths)
    points = max(points, oblong, POINTS_PER_WAVE * scene.length / shortest_wave(scene))
    if not math.prod(surface.shape(round_grid(min(points, MAX_POINTS)))) <= MAX_POINTS or points > MAX_POINTS:
        raise InputError("accuracy", error, f"an error for which {MAX_POINTS:.2g} grid points are enough")
    return round_grid(points)


def shortest_wave(scene: Scene) -> float:
    """Return the shortest wavelength (nm) of both surfaces; infinite where there are no waves."""
    modes = max(body.surface.modes or 0 for body in (scene.lower, scene.upper))
    return scene.length / modes if modes else math.inf
