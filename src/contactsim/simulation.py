"""Press heights against an elastic body, or follow the load path of a scene."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from inspect import signature

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from threadpoolctl import threadpool_limits

from contactsim.contact import loading
from contactsim.contact.hard_wall import pose_hard_wall
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.solids import Elasticity, HalfSpace, Layer
from contactsim.errors import SceneError
from contactsim.interface.hard_wall import HardWall
from contactsim.paths.pressures import simulate_loads
from contactsim.paths.record import simulate_path
from contactsim.solvers.base import HardWallSolver, Result, require, solve
from contactsim.solvers.registry import default_solver, make_solver
from contactsim.surfaces.measured import Sampled
from contactsim.surfaces.profile import Profile
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.topography import Topography
from contactsim.traits import Trait


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
    solver: str | HardWallSolver | None = None,
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
    in such steps. solver: a name, or a solver with options of its own; the default one of the dimension without it.
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
    path = loading.pressures([mean_pressure]) if approach is None else loading.approaches([approach])
    elasticity = _elasticity(contact_modulus, thickness, poisson_ratio)
    scene = Scene(Body(Flat.facing(surface), elasticity), Body(surface), (HardWall(),), path)
    method = default_solver(scene) if solver is None else make_solver(solver) if isinstance(solver, str) else solver
    require(method, scene)
    return solve(method, *pose_hard_wall(scene, path.steps[0], profile.heights, tolerance, threads))


def _elasticity(contact_modulus: float, thickness: float | None, poisson_ratio: float | None) -> Elasticity:
    if thickness is not None:
        return Layer(contact_modulus, poisson_ratio, thickness)
    if poisson_ratio is not None:
        raise SceneError("poisson_ratio", poisson_ratio, "none without a thickness: a half-space has only its E*")
    return HalfSpace(contact_modulus)


def simulate(
    scene: Scene,
    *,
    points: int | None = None,
    tolerance: float = 1e-3,
    method: str | HardWallSolver | None = None,
    threads: int = 1,
    **given: object,
) -> xr.Dataset:
    """Follow a scene's load path; the workflow's runs are this function.

    points: of the grid along x, None for those of a measured surface; tolerance: in grid steps or, of smooth laws, in
    parts of their strength; method: a solver or the name of one, None for the default one; given: what
    `simulate_loads`, at a hard wall, or `simulate_path` takes besides, None being as good as left out.
    Returns one dataset with dimension `step`: numbers and what is kept; and `seconds`, the one variable that is not
    reproducible.
    """
    method = default_solver(scene) if method is None else make_solver(method) if isinstance(method, str) else method
    require(method, scene)
    smooth = Trait.SMOOTH in scene.traits
    _refuse_unused(smooth, given)
    given = {name: value for name, value in given.items() if value is not None}  # the rest is as good as left out
    given |= {"points": points or scene.upper.surface.points, "tolerance": tolerance, "threads": threads}
    # on small dense systems more threads would only wait for each other
    with threadpool_limits(threads, "blas") if smooth else nullcontext():
        return FOLLOWED[smooth](scene, method, **given)


FOLLOWED = (simulate_loads, simulate_path)
"""How a scene is followed: with a hard wall, and with smooth laws."""


def _refuse_unused(smooth: bool, given: Mapping[str, object]) -> None:
    """SceneError for an option that is unknown or that such a scene has no use for."""
    shared = list(signature(simulate).parameters)[1:-1]  # its own, but for the scene and what is given besides
    kinds = [[name for name in list(signature(how).parameters)[2:] if name not in shared] for how in FOLLOWED]
    used = ", ".join((*shared, *kinds[smooth]))
    for key, value in given.items():
        if key in kinds[not smooth] and value is not None:
            raise SceneError(key, value, f"none with {'smooth laws' if smooth else 'a hard wall'}, only {used}")
        if key not in kinds[0] + kinds[1]:
            raise SceneError(key, value, f"no such option, but {used}")
