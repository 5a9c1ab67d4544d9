"""Scenes with measured heights: their coarser grids are parts of their points, and there is no finer one."""

from __future__ import annotations

from dataclasses import replace

from contactsim.contact.scene import Body, Scene
from contactsim.errors import InputError, Words
from contactsim.paths.options import Setup
from contactsim.surfaces.measured import MeasuredLine
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.topography import Topography

MIN_POINTS, STRIDES = 16, (4, 2)
"""Fewest measured points each way, and one in how many makes the coarser grids."""


def is_measured(scene: Scene) -> bool:
    """Return True where the heights of a body are measured, so that the grid is given."""
    return any(body.surface.points is not None for body in (scene.lower, scene.upper))


def thin_out(setup: Setup, stride: int) -> Setup:
    """Return a setup with every so many points, 1, 2 or 4, of the part of its measured heights that these divide."""
    scene = setup.scene
    bodies = [_thinned(body, stride) for body in (scene.lower, scene.upper)]
    measured = next(body.surface for body in bodies if isinstance(body.surface, Topography))
    lower, upper = (
        replace(body, surface=Flat.facing(measured)) if isinstance(body.surface, Flat) else body for body in bodies
    )
    try:
        thinned = Scene(lower, upper, scene.effects, scene.path, scene.pairing)
    except InputError as refused:  # the other surface keeps its length
        points = Words(f"heights on {setup.points} points")
        raise InputError("surface", points, "numbers of points that 4 divides, against another surface") from refused
    return replace(setup, scene=thinned).with_options(points=None)


def _thinned(body: Body, stride: int) -> Body:
    """Return a body with every so many points of its measured topography, or as it is."""
    surface = body.surface.topography if isinstance(body.surface, MeasuredLine) else body.surface
    return replace(body, surface=surface.thinned(stride)) if isinstance(surface, Topography) else body
