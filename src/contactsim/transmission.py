"""What a contact transmits: its stiffness, and the current or heat that flows through it."""

from __future__ import annotations

import numpy as np

from contactsim.contact.loading import LoadPath, load_step
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Body, Scene
from contactsim.errors import POSITIVE, InputError, is_positive
from contactsim.grid import Array
from contactsim.solvers.base import Result, solve
from contactsim.solvers.registry import default_solver
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.topography import Topography
from contactsim.traits import Trait

DEPTH = 1e3
"""Depth of the surface beside the contact, over the mean distance by which it is pulled down."""


def contact_stiffness(result: Result, *, tolerance: float = 1e-7, threads: int = 1) -> float:
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
        in full contact of a periodic half-space, 0 without contact, NaN if the punch does not converge.

    Raises
    ------
    InputError
        For a result that did not converge or has no scene.
    """
    if not isinstance(result, Result) or result.scene is None or not result.status.solved:
        raise InputError("result", result, "a converged result of `contactsim.press`")
    contact = result.contact
    if not contact.any():
        return 0.0
    if contact.all() and Trait.HALF_SPACE in result.scene.traits:
        return np.inf
    punch = _punch(result.scene, contact)
    step = punch.path.steps[0]
    heights = punch.upper.surface.heights(contact.shape[-1])
    problem, scale = pose_hard_wall(punch, step, heights, 1.0, threads)
    problem.tolerance = tolerance / scale.step
    pressed = solve(default_solver(punch), problem, scale)
    return pressed.mean_pressure if pressed.status.solved else np.nan


def _punch(scene: Scene, contact: Array) -> Scene:
    """Return the scene of a flat punch that has the shape of a contact and approaches by one unit of length."""
    share = contact.mean()
    depth = DEPTH * (1 + share / max(1 - share, 0.5 / contact.size))
    spacing = tuple(length / size for length, size in zip(scene.lengths, contact.shape, strict=True))
    surface = Topography(np.where(contact, 0.0, -depth), spacing)
    lower = Body(Flat.facing(surface), scene.lower.elasticity)
    path = LoadPath((load_step(1.0, None, "load"),))
    return Scene(lower, Body(surface, scene.upper.elasticity), scene.effects, path)


def conductance(stiffness: float, contact_modulus: float, conductivities: tuple[float, float]) -> float:
    """Return the current or heat that flows through a contact for each difference far away, by Barber's relation.

    Stiffness and conductance are alike: both solve the same problem on the points in contact.

    Parameters
    ----------
    stiffness : float
        Contact stiffness for each length or area.
    contact_modulus : float
        E* of the pair.
    conductivities : (float, float)
        Electrical or thermal conductivities of both bodies; infinite for a perfect conductor.

    Returns
    -------
    float
        2 stiffness / (E* (1/c₁ + 1/c₂)), for each length or area; in units of conductivity over length.

    References
    ----------
    J. R. Barber, Proc. R. Soc. Lond. A 459, 53 (2003).
    """
    if not is_positive(contact_modulus):
        raise InputError("contact_modulus", contact_modulus, POSITIVE)
    pair = tuple(conductivities) if isinstance(conductivities, tuple | list) else ()
    if len(pair) != 2 or not all(is_positive(value) or value == np.inf for value in pair) or min(pair) == np.inf:
        raise InputError("conductivities", conductivities, "a pair of positive numbers, at most one of them infinite")
    return float(2 * stiffness / (contact_modulus * (1 / pair[0] + 1 / pair[1])))
