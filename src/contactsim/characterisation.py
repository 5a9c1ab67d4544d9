"""Characterise the contact of a surface at several loads: area, gap, stiffness and patches, each with its error."""

from __future__ import annotations

import logging
from collections.abc import Sequence

import numpy as np
import xarray as xr

from contactsim.arguments import Modulus, checked
from contactsim.contact.loading import pressures
from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Body, Scene
from contactsim.dataset import describe
from contactsim.error_control.estimates import TOLERANCE_SHARES, tell_error
from contactsim.error_control.measured import MIN_POINTS, STRIDES
from contactsim.errors import InputError, Words
from contactsim.grid import Threads
from contactsim.interface.hard_wall import HardWall
from contactsim.observables.conductance import Conductivities, conductance
from contactsim.simulation import simulate
from contactsim.single_load import Tolerance, choose_elasticity
from contactsim.solvers.base import HardWallSolver
from contactsim.solvers.registry import SolverName
from contactsim.status import is_solved
from contactsim.surfaces.pair import add_heights
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.spectral_moments import nayak_parameter
from contactsim.surfaces.topography import Measured, Topography
from contactsim.traits import Trait

logger = logging.getLogger(__name__)

NUMBERS = (
    "relative_contact_area_subgrid",
    "approach",
    "mean_gap",
    "max_pressure",
    "contact_stiffness",
    "contact_conductance",
    "patches",
    "yielding_share",
)
"""Numbers of each load, conductance with conductivities and the last with a hardness; NaN where it did not converge."""
OF_HEIGHTS = ("rms_gradient", "rms_height", "contact_modulus", "length", "length_y")
"""Numbers of the heights and of the body, the last of a surface."""
WITHOUT_ERROR = ("patches", "contact_modulus", "length", "length_y")
"""Numbers that are exact or whole."""


@checked
def characterise(
    topography: Measured,
    other: Measured | None = None,
    *,
    contact_modulus: Modulus,
    mean_pressures: float | Sequence[float],
    offset: int | Sequence[int] | None = None,
    hardness: Modulus | None = None,
    conductivities: Conductivities | None = None,
    tolerance: Tolerance = 1e-4,
    threads: Threads = 1,
    periodic: bool | None = None,
    thickness: float | None = None,
    poisson_ratio: float | None = None,
    solver: SolverName | HardWallSolver | None = None,
) -> xr.Dataset:
    """Press a surface at several loads and return what the contact transmits, with its error.

    All is done once more with every second and every fourth point, of a part whose numbers of points four divides. The
    changes tell the error (`contactsim.error_control.estimates`): of the grid where the heights are resolved, and where
    they are rough down to the spacing, what finer points would add. An error as large as the number says that the
    spacing decides it. It is not a bound: under heights that are not periodic the pressure along the rim, as under a
    punch, and along the edges of patches grows with each refinement.

    Parameters
    ----------
    topography : Topography
        Heights of a body, 16 points or more each way, nm.
    other : Topography, optional
        Heights of the other body, positive towards the first; flat without it. Of two scans, each seen from outside its
        body, one has to be mirrored.
    contact_modulus : float
        E* of the pair, GPa.
    mean_pressures : sequence of float
        Mean pressures, GPa.
    offset : int or (int, int), optional
        Whole points by which the other body is moved, as in `contactsim.press`.
    hardness : float, optional
        Pressure above which the softer body yields, GPa. Pressures stay elastic; the share of the contact is told that
        would yield.
    conductivities : (float, float), optional
        Thermal conductivities of both bodies, W/(m K), of which one may be infinite.
    tolerance : float
        Gap in contact and overlap outside, in grid steps, as in `contactsim.press`.
    threads : int
        Threads of the transforms.
    periodic, thickness, poisson_ratio, solver
        As in `contactsim.press`.

    Returns
    -------
    xarray.Dataset
        With dimension `mean_pressure`: relative contact area with edges between points, approach, mean gap, largest
        pressure, contact stiffness, conductance with conductivities, yielding share with a hardness, number of patches,
        status, and `validity_flags`, which tell if slopes are too large for linear elasticity and if the contact would
        yield; without it rms height and gradient, Nayak's parameter, E* and lengths, of two bodies those of the sum of
        their heights. The error of a number is that with `_grid_error` behind its name.

    Raises
    ------
    InputError
        For an input that cannot be used.
    """
    loads = _read_loads(mean_pressures)
    elasticity = choose_elasticity(topography, contact_modulus, thickness, poisson_ratio, periodic)
    topography = add_heights(topography, other, offset, Trait.FREE not in elasticity.traits)
    if min(topography.values.shape) < MIN_POINTS:
        if offset is not None:
            raise InputError("offset", offset, f"one that leaves {MIN_POINTS} points or more each way")
        value = Words(f"shape {topography.values.shape}")
        raise InputError("topography", value, f"a Topography of {MIN_POINTS} points or more each way")
    wall = HardWall(hardness)

    def numbers_of(surface: Topography) -> xr.Dataset:
        """Return the numbers of a surface at each load."""
        lower = Body(Flat.facing(surface), elasticity)
        scene = Scene(lower, surface, wall, pressures(loads))
        data = simulate(scene, tolerance=tolerance, solver=solver, threads=threads, keep=("patches", "stiffness"))
        if conductivities is not None:
            through = conductance(data.contact_stiffness.values, contact_modulus, conductivities)
            data = data.assign(contact_conductance=("step", np.atleast_1d(through)))
        return _select_numbers(data, surface, scene.repeats, loads)

    fine, divisible = numbers_of(topography), topography.thinned(1)
    if divisible is not topography:
        logger.info("the same without the last rows and columns, to compare with every second and fourth point")
    runs = [fine if divisible is topography else numbers_of(divisible)]
    for stride in reversed(STRIDES):
        logger.info("the same with one point in %d", stride)
        runs.insert(0, numbers_of(topography.thinned(stride)))
    errors, solved = {}, is_solved(fine.status)
    for name in (*NUMBERS, *OF_HEIGHTS, "nayak_parameter"):
        if name not in fine or name in WITHOUT_ERROR:
            continue
        values, least = [run[name] for run in runs], np.zeros(1)
        if name in NUMBERS:
            values = [run[name].where(is_solved(run.status) & solved, np.inf) for run in runs]
            least = TOLERANCE_SHARES[ProblemKind.HARD_WALL] * tolerance * np.abs(fine[name].values)
        if name == "yielding_share":  # a point of the contact more or less
            least = 1 / (fine.relative_contact_area_subgrid.values * topography.values.size)
        errors[name] = tell_error([np.atleast_1d(value.values) for value in values], [2.0, 2.0], least)
    shaped = {f"{name}_grid_error": (fine[name].dims, size.reshape(fine[name].shape)) for name, size in errors.items()}
    return describe(fine.assign(shaped))


def _read_loads(mean_pressures: float | Sequence[float]) -> list[float]:
    """Return mean pressures in a list; InputError unless they are positive, each once."""
    loads = list(mean_pressures) if isinstance(mean_pressures, Sequence) else [mean_pressures]
    if not loads or min(loads) <= 0:
        raise InputError("mean_pressures", mean_pressures, "positive numbers, in GPa")
    if len({*loads}) < len(loads):
        raise InputError("mean_pressures", mean_pressures, "each number once")
    return loads


def _select_numbers(data: xr.Dataset, surface: Topography, repeats: bool, loads: list[float]) -> xr.Dataset:
    """Return what is told of a simulation, by its mean pressures."""
    numbers = data[[name for name in NUMBERS if name in data]].where(is_solved(data.status))
    others = data[["status", "validity_flags", *(name for name in OF_HEIGHTS if name in data)]]
    selected = numbers.merge(others).rename(step="mean_pressure").assign_coords(mean_pressure=loads)
    return selected.assign(nayak_parameter=nayak_parameter(surface.values, surface.spacing, repeats))
