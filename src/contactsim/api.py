"""The front door from Python: press a profile against an elastic half-space."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from contactsim import loading
from contactsim.elasticity import HalfSpace
from contactsim.errors import SceneError
from contactsim.laws import HardWall
from contactsim.measured import Profile
from contactsim.scene import Body, Scene, pose
from contactsim.solvers import solver as named
from contactsim.solvers.base import Result, Solver, require, solve
from contactsim.surface import Flat, Sampled


def press(
    heights: ArrayLike,
    *,
    spacing: float,
    contact_modulus: float,
    mean_pressure: float | None = None,
    approach: float | None = None,
    tolerance: float = 1e-3,
    solver: str | Solver | None = None,
    threads: int = 1,
) -> Result:
    """Press a rigid periodic profile into an elastic half-space, without adhesion or friction.

    heights: (n,), n ≥ 2, of the rigid counter-body: the largest touches first. spacing: between points.
    contact_modulus: E*. Exactly one of mean_pressure (≥ 0) and approach: how far the profile's height zero has
    moved past the undeformed surface; first touch is at -max(heights), full contact at -mean(heights), which an
    approach must stay below. tolerance: of gap in contact and of overlap outside, in grid steps (the rms height
    difference of neighbouring points); close to full contact, and on flat tops at a light load, choose it well below
    the mean gap, and below p*, in such steps. solver: a name, or a solver with options of its own. Units are free but
    consistent: lengths in one, pressures in that of E*.

    Returns pressure (n,), never negative; gap (n,); contact (n,); relative_contact_area; approach; status; record
    with transforms and the certificate. A `SceneError` says what is wrong with the input.
    """
    if np.ma.is_masked(heights):
        raise SceneError("heights", heights, "finite numbers, none missing; these are masked in part")
    try:
        profile = Profile(np.asarray(heights), spacing, None)
    except SceneError:
        raise
    except ValueError as error:
        raise SceneError("heights", heights, "two or more real numbers, in 1D") from error
    surface = Sampled(profile)
    if (mean_pressure is None) == (approach is None):
        given = {"mean_pressure": mean_pressure, "approach": approach}
        raise SceneError("load", given, "exactly one of mean_pressure and approach")
    path = loading.press([mean_pressure]) if approach is None else loading.approach([approach])
    scene = Scene(Body(Flat.facing(surface), HalfSpace(contact_modulus)), Body(surface), (HardWall(),), path)
    method = named(solver) if isinstance(solver, str) else solver
    require(method, scene)
    return solve(method, *pose(scene, path.steps[0], profile.heights, tolerance, threads))
