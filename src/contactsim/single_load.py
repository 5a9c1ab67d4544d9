"""Press heights against an elastic body at one load."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from contactsim.contact.loading import LoadPath, load_step
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError, check_option_names
from contactsim.interface.hard_wall import HardWall
from contactsim.solvers.base import HardWallSolver, Result, check_solver, solve
from contactsim.solvers.registry import default_solver, make_solver
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.topography import Topography


@check_option_names
def press(
    heights: ArrayLike,
    *,
    spacing: float | tuple[float, float],
    contact_modulus: float,
    mean_pressure: float | None = None,
    approach: float | None = None,
    thickness: float | None = None,
    poisson_ratio: float | None = None,
    tolerance: float = 1e-3,
    solver: str | HardWallSolver | None = None,
    threads: int = 1,
) -> Result:
    """Press a rigid periodic surface into an elastic half-space or layer, without adhesion or friction.

    Units are free but consistent: lengths in one, pressures in that of E*.

    Parameters
    ----------
    heights : array, shape (n,) or (ny, nx)
        Heights of the rigid body, 2 points or more each way; the largest touches first.
    spacing : float or (float, float)
        Distance between points; of a surface one number, or those along y and along x.
    contact_modulus : float
        E* = E/(1-ν²).
    mean_pressure : float, optional
        Mean pressure, 0 or more.
    approach : float, optional
        Distance by which the height zero has moved past the undeformed surface; exactly one of mean_pressure and
        approach. First touch is at -max(heights). Where the mean displacement is zero, on a half-space (by convention)
        and on a layer with ν = 0.5, full contact is at -mean(heights), and the approach must stay below.
    thickness : float, optional
        Thickness of a layer bonded to a rigid base; a half-space without it.
    poisson_ratio : float, optional
        Poisson's ratio of the layer, above -1 and at most 0.5; a half-space has none.
    tolerance : float
        Gap in contact and overlap outside, in grid steps (the typical height difference of neighbouring points). Close
        to full contact, and on flat tops at a light load, choose it well below the mean gap in such steps.
    solver : str or solver, optional
        Name of a solver, or a solver with options of its own; the default solver of the dimension where None.
    threads : int
        Threads of the transforms.

    Returns
    -------
    Result
        Pressure, gap and contact, each shaped as heights; relative_contact_area, approach, status, and the record with
        transforms and certificate.

    Raises
    ------
    InputError
        For an input that cannot be used.
    """
    surface = _read_heights(heights, spacing)
    step = load_step(approach, mean_pressure, "load")
    elasticity = _elasticity(contact_modulus, thickness, poisson_ratio)
    scene = Scene(Body(Flat.facing(surface), elasticity), Body(surface), (HardWall(),), LoadPath((step,)))
    method: Any = make_solver(solver) if isinstance(solver, str) else solver or default_solver(scene)
    check_solver(method, scene)
    return solve(method, *pose_hard_wall(scene, step, surface.values, tolerance, threads))


def _read_heights(heights: ArrayLike, spacing: float | tuple[float, float]) -> Topography:
    """Return checked heights, of a line or of a surface."""
    if np.ma.is_masked(heights):
        raise InputError("heights", heights, "finite numbers, none missing; these are masked in part")
    try:
        return Topography(np.asarray(heights), cast("tuple[float, ...]", spacing))  # it reads one number as all
    except InputError:
        raise
    except ValueError as error:
        raise InputError("heights", heights, "two or more real numbers, in 1D, or rows of them, in 2D") from error


def _elasticity(contact_modulus: float, thickness: float | None, poisson_ratio: float | None) -> Elasticity:
    """Return a layer, or a half-space where there is no thickness."""
    if thickness is not None:
        return Layer(contact_modulus, cast(float, poisson_ratio), thickness)  # it refuses None
    if poisson_ratio is not None:
        raise InputError("poisson_ratio", poisson_ratio, "none without a thickness: a half-space has only its E*")
    return HalfSpace(contact_modulus)
