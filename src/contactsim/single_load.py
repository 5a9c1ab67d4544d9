"""Press heights against an elastic body at one load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Any, cast

import numpy as np
from numpy.typing import ArrayLike

from contactsim.arguments import Only, Positive, Values, checked
from contactsim.contact.loading import LoadPath, load_step
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import FreeHalfSpace, HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.error_control.estimates import TOLERANCE_SHARES, tell_error
from contactsim.error_control.measured import MIN_POINTS, STRIDES
from contactsim.errors import InputError, is_positive
from contactsim.grid import Threads
from contactsim.interface.hard_wall import HardWall
from contactsim.solvers.base import HardWallSolver, Result, check_solver, solve
from contactsim.solvers.registry import SolverName, default_solver, make_solver
from contactsim.surfaces.pair import add_heights
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.topography import Measured, Topography
from contactsim.traits import Trait

MAX_TOLERANCE = 0.1
"""Largest tolerance, in grid steps: with larger gaps in contact and overlaps the contact set means little."""
Tolerance = Annotated[
    float,
    Only(
        f"a positive number, at most {MAX_TOLERANCE:g} grid steps",
        lambda value: is_positive(value) and value <= MAX_TOLERANCE,
    ),
]


@checked
def press(
    heights: Values | Measured,
    other: Values | Measured | None = None,
    *,
    contact_modulus: Positive,
    mean_pressure: float | None = None,
    approach: float | None = None,
    spacing: float | Sequence[float] | None = None,
    offset: int | Sequence[int] | None = None,
    thickness: float | None = None,
    poisson_ratio: float | None = None,
    tolerance: Tolerance = 1e-3,
    solver: SolverName | HardWallSolver | None = None,
    threads: Threads = 1,
    periodic: bool | None = None,
    errors: bool = False,
) -> Result:
    """Press a surface on an elastic half-space or layer, flat or rough too, without adhesion or friction.

    Units are free but consistent: lengths in one, pressures in that of E*. Those of a measured topography are in nm.

    Parameters
    ----------
    heights : array, shape (n,) or (ny, nx), or Topography
        Heights of a body, 2 points or more each way, positive towards the other; the largest touches first.
    other : array or Topography, optional
        Heights of the other body at the same places, positive towards the first; flat without it. Of two scans, each
        seen from outside its body, one has to be mirrored.
    contact_modulus : float
        E* of the pair, 1/E* = (1-ν₁²)/E₁ + (1-ν₂²)/E₂; of one elastic body E/(1-ν²).
    mean_pressure : float, optional
        Load over the length or area of the heights, 0 or more.
    approach : float, optional
        Distance by which the height zero has moved past the undeformed surface; exactly one of mean_pressure and
        approach. First touch is at -max(heights). Where the mean displacement is zero, on a periodic half-space (by
        convention) and on a layer with ν = 0.5, full contact is at -mean(heights), and the approach must stay below.
    spacing : float or (float, float), optional
        Distance between points; of a surface one number, or those along y and along x. A topography has its own.
    offset : int or (int, int), optional
        Whole points by which the other body is moved, along x or along (y, x). Periodic heights come in again at the
        other end. Of others only the part that faces each other is pressed: the result has its shape, and the mean
        pressure is over it.
    thickness : float, optional
        Thickness of a layer bonded to a rigid base; a half-space without it.
    poisson_ratio : float, optional
        Poisson's ratio of the layer, above -1 and at most 0.5; a half-space has none.
    tolerance : float
        Gap in contact and overlap outside, in grid steps (the typical height difference of neighbouring points), at
        most 0.1. Close to full contact, and on flat tops at a light load, choose it well below the mean gap in such
        steps.
    solver : str or solver, optional
        Name of a solver, or a solver with options of its own; the default solver of the dimension where None.
    threads : int
        Threads of the transforms.
    periodic : bool, optional
        True: the heights repeat in each direction; the default of an array, on a layer, and of a topography that was
        made periodic. False: they are alone on a half-space, which bears no load elsewhere; the default of any other
        topography. Far away the half-space does not move; on a line, by convention, a line load moves nothing at the
        distance of the length that is pressed.
    errors : bool
        True to tell the errors that the spacing leaves: one point in two and in four is pressed too, of 16 or more each
        way.

    Returns
    -------
    Result
        Pressure, gap and contact, each shaped as the heights pressed; relative_contact_area, approach, status, the
        record with transforms and certificate, the scene that was pressed and, where they were asked for, the errors of
        its numbers by name, each in the unit of the number.

    Raises
    ------
    InputError
        For an input that cannot be used.
    """
    elasticity = choose_elasticity(heights, contact_modulus, thickness, poisson_ratio, periodic)
    repeats = Trait.FREE not in elasticity.traits
    topographies = [body for body in (heights, other) if isinstance(body, Topography)]
    if topographies and spacing is not None:
        raise InputError("spacing", spacing, "none: a topography has its own")
    steps: Any = topographies[0].spacing if topographies else spacing  # an array beside a topography takes its spacing
    surface = _read_heights(heights, steps, "heights")
    step = load_step(approach, mean_pressure, "load")
    surface = add_heights(surface, None if other is None else _read_heights(other, steps, "other"), offset, repeats)
    if errors and min(surface.values.shape) < MIN_POINTS:
        allowed = f"False for fewer than {MIN_POINTS} points each way: of shape {surface.values.shape}"
        raise InputError("errors", errors, allowed)

    def press_heights(surface: Topography) -> Result:
        """Press heights, or a part of their points."""
        scene = Scene(Body(Flat.facing(surface), elasticity), Body(surface), (HardWall(),), LoadPath((step,)))
        method: Any = make_solver(solver) if isinstance(solver, str) else solver
        method = default_solver(scene) if method is None else method
        check_solver(method, scene)
        return replace(solve(method, *pose_hard_wall(scene, step, surface.values, tolerance, threads)), scene=scene)

    result = press_heights(surface)
    if not errors:
        return result
    divisible = surface.thinned(1)
    runs = [press_heights(surface.thinned(stride)) for stride in STRIDES]
    runs.append(result if divisible is surface else press_heights(divisible))
    told = {}
    for name, value in result.numbers.items():
        least = TOLERANCE_SHARES[ProblemKind.HARD_WALL] * tolerance * np.abs(value)
        if name == "relative_contact_area":  # each edge of a patch lies somewhere between two points
            edges = [result.contact != np.roll(result.contact, 1, axis) for axis in range(result.contact.ndim)]
            least = np.fmax(least, 0.5 * np.sum(edges) / result.contact.size)
        told[name] = float(tell_error([run.numbers[name] for run in runs], [2.0, 2.0], least)[0])
    del told["mean_pressure" if approach is None else "approach"]  # which is given
    return replace(result, errors=told)


def _read_heights(
    heights: ArrayLike | Topography, spacing: float | tuple[float, float] | None, name: str
) -> Topography:
    """Return checked heights, of a line or of a surface; name: of the argument."""
    if isinstance(heights, Topography):
        return heights
    if np.ma.is_masked(heights):
        raise InputError(name, heights, "finite numbers, none missing; these are masked in part")
    try:
        return Topography(np.asarray(heights), cast("tuple[float, ...]", spacing))  # it reads one number as all
    except InputError as error:
        raise error.renamed("heights", name) from error


def choose_elasticity(
    heights: ArrayLike | Topography,
    contact_modulus: float,
    thickness: float | None,
    poisson_ratio: float | None,
    periodic: bool | None,
) -> Elasticity:
    """Return a layer or, without a thickness, a half-space; parameters as of `press`.

    Unless it is said, all heights repeat but those of a measurement on a half-space.
    """
    repeats = periodic
    if periodic is None:
        repeats = thickness is not None or not isinstance(heights, Topography) or heights.periodic
    if thickness is not None:
        if not repeats:
            raise InputError("periodic", periodic, "True for a layer: its response without images is not known")
        return Layer(contact_modulus, cast(float, poisson_ratio), thickness)  # it refuses None
    if poisson_ratio is not None:
        raise InputError("poisson_ratio", poisson_ratio, "none without a thickness: a half-space has only its E*")
    return HalfSpace(contact_modulus) if repeats else FreeHalfSpace(contact_modulus)
