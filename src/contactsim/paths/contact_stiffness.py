"""The stiffness of a contact: that of a flat punch of its shape."""

from __future__ import annotations

import numpy as np

from contactsim.arguments import Positive, checked
from contactsim.contact.loading import LoadPath, load_step
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Body, Scene
from contactsim.contact.steps import LoadStep
from contactsim.grid import Array, Threads
from contactsim.solvers.base import Result, pressed_scene, solve
from contactsim.solvers.registry import default_solver
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.topography import Topography
from contactsim.traits import Trait

DEPTH = 1e3
"""Depth of the surface beside the contact, over the mean distance by which it is pulled down."""
THICK = 10.0
"""Compliance of a layer as a whole, over that to its longest wave, from which on its punch is given a load."""


@checked
def contact_stiffness(result: Result, *, tolerance: Positive = 1e-7, threads: Threads = 1) -> float:
    """Return how fast the mean pressure rises with the approach.

    A small further approach moves all points in contact alike, as a flat punch of the shape of the contact does. The
    stiffness is that of this punch, which the same solver presses.

    Parameters
    ----------
    result : Result
        A state in contact, from `contactsim.press`.
    tolerance : float
        Largest error of the displacement of the contact, over the displacement.
    threads : int
        Threads of the transforms.

    Returns
    -------
    float
        Stiffness for each length of a line or area of a surface, in the unit of pressure over that of length: infinite
        in full contact of a periodic half-space or a layer with ν = 0.5, whose mean displacement is zero, 0 without
        contact, NaN if the punch does not converge.

    Raises
    ------
    InputError
        For a result that did not converge or has no scene.
    """
    scene, contact = pressed_scene(result), result.contact
    if not contact.any():
        return 0.0
    if contact.all() and Trait.FREE not in scene.traits:  # all points move alike
        whole = float(scene.compliance(np.zeros(1))[0])
        return 1 / whole if whole else np.inf
    spacing = tuple(length / size for length, size in zip(scene.lengths, contact.shape, strict=True))
    if contact.all() and contact.ndim == 2:  # on flat heights alone nothing tells how deep a punch is
        contact = np.pad(contact, (0, 2))
    step = _choose_step(scene)
    pressed = _press_punch(scene, contact, spacing, step, tolerance, threads)
    while pressed.status.solved and (pressed.contact & ~contact).any():  # too large a load: what is beside it touches
        step = load_step(None, step.value / pressed.approach, "load")
        pressed = _press_punch(scene, contact, spacing, step, tolerance, threads)
    load = pressed.mean_pressure * contact.size / result.contact.size
    return load / pressed.approach if pressed.status.solved else np.nan


def _choose_step(scene: Scene) -> LoadStep:
    """Return an approach of one unit of length or, for a thick layer, a load by which the approach is one or more.

    A thick layer gives far more as a whole than to any wave, so that little of an approach would tell of the contact.
    """
    if Trait.LAYER in scene.traits:
        whole, wave = scene.compliance(np.array([0.0, 2 * np.pi / max(scene.lengths)]))
        if whole > THICK * wave:
            return load_step(None, 1 / whole, "load")
    return load_step(1.0, None, "load")


def _press_punch(
    scene: Scene, contact: Array, spacing: tuple[float, ...], step: LoadStep, tolerance: float, threads: int
) -> Result:
    """Return the result of pressing a flat punch that has the shape of a contact."""
    punch = _punch(scene, contact, spacing, step)
    heights = punch.upper.surface.heights(contact.shape[-1])
    problem, scale = pose_hard_wall(punch, step, heights, 1.0, threads)
    problem.tolerance = tolerance / scale.step
    return solve(default_solver(punch), problem, scale)


def _punch(scene: Scene, contact: Array, spacing: tuple[float, ...], step: LoadStep) -> Scene:
    """Return the scene of a flat punch that has the shape of a contact."""
    share = contact.mean()
    depth = DEPTH * (1 + share / max(1 - share, 0.5 / contact.size))
    surface = Topography(np.where(contact, 0.0, -depth), spacing)
    lower = Body(Flat.facing(surface), scene.lower.elasticity)
    path = LoadPath((step,))
    return Scene(lower, Body(surface, scene.upper.elasticity), scene.effects, path)
