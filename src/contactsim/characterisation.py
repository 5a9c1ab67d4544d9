"""Characterise the contact of a surface at several loads: area, gap, stiffness and patches, each with its error."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from contactsim.dataset import describe
from contactsim.errors import POSITIVE, InputError, Words, check_option_names, is_number, is_positive
from contactsim.grid import Array
from contactsim.observables.contact import relative_contact_area_subgrid, yielding_share
from contactsim.observables.patches import find_patches
from contactsim.paths.contact_stiffness import contact_stiffness
from contactsim.paths.pressures import STATISTICS
from contactsim.single_load import press
from contactsim.solvers.base import HardWallSolver, Result
from contactsim.status import validity_flags
from contactsim.surfaces.spectral_moments import nayak_parameter
from contactsim.surfaces.statistics import rms_height
from contactsim.surfaces.topography import Topography

MIN_POINTS = 8
"""Fewest points each way: half of them make the coarser grid."""


@check_option_names
def characterise(
    topography: Topography,
    *,
    contact_modulus: float,
    mean_pressures: Sequence[float],
    hardness: float | None = None,
    tolerance: float = 1e-4,
    threads: int = 1,
    periodic: bool | None = None,
    thickness: float | None = None,
    poisson_ratio: float | None = None,
    solver: str | HardWallSolver | None = None,
) -> xr.Dataset:
    """Press a surface at several loads and return what the contact transmits, with its error.

    All is done once more with every second point, of an even number each way. The change is the error: of the grid
    where the heights are resolved, and where they are rough down to the spacing, what finer points would add. An error
    as large as the number says that the spacing decides it.

    Parameters
    ----------
    topography : Topography
        Heights of a body, 8 points or more each way, nm.
    contact_modulus : float
        E* of the pair, GPa.
    mean_pressures : sequence of float
        Mean pressures, GPa.
    hardness : float, optional
        Pressure above which the softer body yields, GPa. Pressures stay elastic; the share of the contact is told that
        would yield.
    tolerance : float
        Gap in contact and overlap outside, in grid steps.
    threads : int
        Threads of the transforms.
    periodic, thickness, poisson_ratio, solver
        As in `contactsim.press`.

    Returns
    -------
    xarray.Dataset
        With dimension `mean_pressure`: relative contact area with edges between points, approach, mean gap, largest
        pressure, contact stiffness, yielding share with a hardness, number of patches, status, and `validity_flags`,
        which tell if slopes are too large for linear elasticity and if the contact would yield; without it rms height
        and gradient, Nayak's parameter, E*, and lengths of the heights. The error of a number is that with
        `_grid_error` behind its name.

    Raises
    ------
    InputError
        For an input that cannot be used.
    """
    if not isinstance(topography, Topography) or min(topography.values.shape) < MIN_POINTS:
        value = Words(f"shape {topography.values.shape}") if isinstance(topography, Topography) else topography
        raise InputError("topography", value, f"a Topography of {MIN_POINTS} points or more each way")
    pressures = np.atleast_1d(np.asarray(mean_pressures, object))
    if pressures.ndim != 1 or not pressures.size or not all(is_number(value) and value > 0 for value in pressures):
        raise InputError("mean_pressures", mean_pressures, "positive numbers, in GPa")
    if not (hardness is None or is_positive(hardness)):
        raise InputError("hardness", hardness, f"{POSITIVE}, in GPa")
    options: dict[str, Any] = {"contact_modulus": contact_modulus, "tolerance": tolerance, "threads": threads}
    options |= {"periodic": periodic, "thickness": thickness, "poisson_ratio": poisson_ratio, "solver": solver}
    even = topography.even_part()
    surfaces = [topography, *([] if even is topography else [even]), even.every_second()]
    numbers = [_numbers_at(surface, pressures.astype(float), hardness, options) for surface in surfaces]
    fine, (base, coarse) = numbers[0], numbers[-2:]
    names = [str(name) for name in fine if name not in ("status", "patches", "validity_flags")]
    errors = {f"{name}_grid_error": abs(base[name] - coarse[name]) for name in names}
    sizes = zip(("length", "length_y"), topography.lengths[::-1], strict=False)
    return describe(fine.assign(errors).assign({"contact_modulus": contact_modulus, **dict(sizes)}))


def _numbers_at(
    topography: Topography, pressures: Array, hardness: float | None, options: dict[str, Any]
) -> xr.Dataset:
    """Return the numbers at each load, NaN where it did not converge, and those of the heights."""
    results = [press(topography, mean_pressure=float(pressure), **options) for pressure in pressures]
    readers = dict(NUMBERS)
    if hardness is not None:
        readers["yielding_share"] = lambda result: yielding_share(result.pressure, hardness)
    data = xr.Dataset(coords={"mean_pressure": pressures})
    for name, read in readers.items():
        values = [read(result) if result.status.solved else np.nan for result in results]
        data[name] = "mean_pressure", values
    data["status"] = "mean_pressure", np.array([result.status.value[0] for result in results], np.int8)
    repeats = _repeats(results[0])
    data["rms_gradient"] = STATISTICS[repeats][0](topography.values, topography.spacing)
    data["rms_height"] = rms_height(topography.values)
    data["nayak_parameter"] = nayak_parameter(topography.values, topography.spacing, repeats)
    yielding = data.get("yielding_share", xr.zeros_like(data.mean_pressure)).values
    gradient = float(data.rms_gradient)
    flags = [validity_flags({"rms_gradient": gradient, "yielding_share": share}) for share in yielding]
    data["validity_flags"] = "mean_pressure", np.array(flags, np.int8)
    return data


def _repeats(result: Result) -> bool:
    """Return whether the heights of a result repeat."""
    return result.scene is not None and result.scene.repeats


NUMBERS: Mapping[str, Callable[[Result], float]] = {
    "relative_contact_area_subgrid": lambda result: relative_contact_area_subgrid(
        result.pressure, result.gap, _repeats(result)
    ),
    "approach": lambda result: result.approach,
    "mean_gap": lambda result: float(result.gap.mean()),
    "max_pressure": lambda result: float(result.pressure.max()),
    "contact_stiffness": contact_stiffness,
    "patches": lambda result: find_patches(result.contact, _repeats(result)).count,
}
"""How each number of a state is read."""
