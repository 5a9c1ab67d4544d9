"""The front door from Python: press a profile against an elastic half-space or layer."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from contactsim import loading
from contactsim.elasticity import Elasticity, HalfSpace, Layer
from contactsim.errors import SceneError
from contactsim.laws import HardWall
from contactsim.measured import Profile
from contactsim.scene import Body, Scene
from contactsim.solvers import solver as named
from contactsim.solvers import usual
from contactsim.solvers.base import Result, Solver, require, solve
from contactsim.surface import Flat
from contactsim.surfaces import Sampled
from contactsim.topography import Topography
from contactsim.wall import pose


def press(
    heights: ArrayLike,
    *,
    spacing: float,
    contact_modulus: float,
    mean_pressure: float | None = None,
    approach: float | None = None,
    thickness: float | None = None,
    poisson_ratio: float | None = None,
    tolerance: float = 1e-3,
    solver: str | Solver | None = None,
    threads: int = 1,
) -> Result:
    """Press a rigid periodic profile into an elastic half-space or layer, without adhesion or friction.

    heights: (n,) along a line or (ny, nx) over a surface, 2 points or more each way, of the rigid counter-body: the
    largest touches first. spacing: between points; of a surface one number, or those along y and along x.
    contact_modulus: E* = E/(1-ν²). thickness: of a layer bonded to a rigid base, a half-space without it;
    poisson_ratio: the layer's, above -1 and up to exactly 0.5; a half-space, of which E* says all, has none.

    Exactly one of mean_pressure (≥ 0) and approach: how far the profile's height zero has moved past the undeformed
    surface; first touch is at -max(heights). On a half-space, where the mean displacement is zero by convention, and
    on a layer with poisson_ratio 0.5, which keeps its volume, full contact is at -mean(heights), and an approach must
    stay below; any other layer yields on average too, so it takes any approach.

    tolerance: of gap in contact and of overlap outside, in grid steps (the typical height difference of neighbouring
    points); close to full contact, and on flat tops at a light load, choose it well below the mean gap, and below p*,
    in such steps. solver: a name, or a solver with options of its own; without it, the usual one of the dimension.
    Units are free but consistent: lengths in one, pressures in that of E*.

    Returns pressure, never negative, gap and contact, each shaped as heights; relative_contact_area; approach; status;
    record with transforms and the certificate. A `SceneError` says what is wrong with the input.
    """
    if np.ma.is_masked(heights):
        raise SceneError("heights", heights, "finite numbers, none missing; these are masked in part")
    try:
        given = np.asarray(heights)
        plane = given.ndim > 1
        profile = Topography(given, spacing, None) if plane else Profile(given, spacing, None)
    except SceneError:
        raise
    except ValueError as error:
        raise SceneError("heights", heights, "two or more real numbers, in 1D, or rows of them, in 2D") from error
    surface = Sampled(profile)
    if (mean_pressure is None) == (approach is None):
        given = {"mean_pressure": mean_pressure, "approach": approach}
        raise SceneError("load", given, "exactly one of mean_pressure and approach")
    path = loading.press([mean_pressure]) if approach is None else loading.approach([approach])
    elasticity = _elasticity(contact_modulus, thickness, poisson_ratio)
    scene = Scene(Body(Flat.facing(surface), elasticity), Body(surface), (HardWall(),), path)
    method = usual(scene) if solver is None else named(solver) if isinstance(solver, str) else solver
    require(method, scene)
    return solve(method, *pose(scene, path.steps[0], profile.heights, tolerance, threads))


def _elasticity(contact_modulus: float, thickness: float | None, poisson_ratio: float | None) -> Elasticity:
    if thickness is not None:
        return Layer(contact_modulus, poisson_ratio, thickness)
    if poisson_ratio is not None:
        raise SceneError("poisson_ratio", poisson_ratio, "none without a thickness: a half-space has only its E*")
    return HalfSpace(contact_modulus)
