"""Quantities that claims are about: means over members, and what is fitted to them.

A mean is unknown where one of its members is. `absent` values, of paths that were solved and have no such number, are
left out of a mean if the claim says so.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.analysis.carried import CARRIED, carried_quantity, grid_share
from contactsim.analysis.ensemble import WIDENING, converged
from contactsim.analysis.fits import fit_line_area
from contactsim.grid import Array
from contactsim.observables.contact_readings import CRITERIA
from contactsim.observables.dataset_forms import AVERAGED, PATH_SUMMARIES
from contactsim.reference import adhesion, hard_wall
from contactsim.status import is_solved
from contactsim.variables import GRID_CHANGE, GRID_CHANGE_SCATTER, GRID_ERROR

FITTED: dict[str, tuple[str, bool]] = {
    "kappa_fit": ("area", False),
    "kappa_fit_logarithm": ("logarithm", False),
    "kappa_fit_all": ("area", True),
}
"""κ of Eq. 3.11 fitted to the selected loads: its weighting, and whether all Hurst exponents share one fit."""
SIZES = {
    "half_width": "relative_contact_area",
    "half_width_subgrid": "relative_contact_area_subgrid",
    "contact_radius": "relative_contact_area",
    "contact_radius_subgrid": "relative_contact_area_subgrid",
}
"""Sizes of a contact, and the area that each follows from."""
GRADIENT_DEFICITS = {
    "gradient_deficit": "rms_gradient_contact",
    "gradient_deficit_corrected": "rms_gradient_contact_corrected",
    "gradient_deficit_subgrid": "rms_gradient_contact_subgrid",
}
"""The part 1 - ḡ_r/ḡ = 1 - κ_r/κ by which the gradient over the contact is smaller, and that gradient."""
ERROR_BARS = {
    f"{name}_error_bar": name
    for name in ("area_at_12nm", "area_at_20nm", *(f"area_at_12nm_{criterion}" for criterion in CRITERIA))
}
"""Lengths of error bars: the standard errors of these numbers."""
BAR_SHARES = {"relative_contact_area_bar_share": "relative_contact_area"}
"""Error bars over the range of the axis, which goes from zero to the largest mean."""
SCATTERS = (*ERROR_BARS, *BAR_SHARES)
"""Quantities that measure how much members differ."""
SECOND_ESTIMATORS = {
    f"{name}_corrected": f"{name}_subgrid"
    for name in ("relative_contact_area", "rms_gradient_contact", "kappa", "kappa_r")
}
"""Corrected quantities, and the same from edges that are placed between points."""
CRACK_DEPARTURE = "crack_pull_off_departure"
"""Departure of the pull-off load on loading from that of a crack on a half-space, where the work is varied."""
PULL_OFF = "pull_off_load_loading"
"""The pull-off load of the thesis."""
RESOLVED_WAVELENGTH = 16
"""Points per shortest wavelength from which edges can be placed between points."""
READ_BY_ALL = ("status", "points", "length", "length_y", "contact_modulus", "rms_gradient")
"""Variables from which quantities are computed, or by which they are known to be unknown."""
PATH_ERRORS = ("increment", "approach")
"""Errors of a path, and of what is fitted to several; those of two paths are independent."""
READ_BESIDE = (GRID_CHANGE, WIDENING, *(f"_{kind}_error" for kind in PATH_ERRORS))
"""Ends of the names of the changes and errors of a quantity that are read with it."""


def with_quantities(data: xr.Dataset, names: Iterable[str]) -> xr.Dataset:
    """Return a dataset with what some quantities are computed from, with their errors and changes, and nothing else.

    Numbers of states that were not solved are NaN there. Members are left out of a dataset again and again, which takes
    as long as it has variables.
    """
    sources = {computed_from(name) for name in names}
    carried = sources & {*CARRIED}
    sources |= {name for counted in (CARRIED[key] for key in carried) for name in (counted, f"{counted}_corrected")}
    sources |= {SECOND_ESTIMATORS[name] for name in sources if name in SECOND_ESTIMATORS}
    read = {f"{source}{suffix}" for source in sources for suffix in ("", *READ_BESIDE)} | {*READ_BY_ALL}
    read |= {str(scatter_name(source)) for source in sources}
    part = data[[name for name in data.data_vars if name in read]]
    own = {"member", *data.status.dims}
    part = part.assign({name: converged(part[name], data) for name in sources & {*part} if own <= {*part[name].dims}})
    return part.assign({key: values for name in carried for key, values in carried_quantity(part, name).items()})


def mean_quantity(data: xr.Dataset, name: str, leave_out_absent: bool = False) -> xr.DataArray:
    """Return a quantity as the mean over members.

    Parameters
    ----------
    data
        Dataset of a study, of `with_quantities`.
    name
        A variable, `CRACK_DEPARTURE`, or one of `FITTED`, `SIZES`, `GRADIENT_DEFICITS`, `ERROR_BARS` and `BAR_SHARES`.
    leave_out_absent
        If True, members whose path was solved and has no such number are left out of the mean.

    Returns
    -------
    The mean, NaN where it is unknown.
    """
    if name in FITTED:
        return _fitted_kappa(data, *FITTED[name])
    if name in SIZES:
        area = mean_quantity(data, SIZES[name])
        return np.sqrt(area * data.length * data.length_y / np.pi) if "length_y" in data else area * data.length / 2
    if name == CRACK_DEPARTURE:
        radius = dataset.settings_of(data)["surface"]["radius"]
        modulus = mean_quantity(data, "contact_modulus")
        crack = xr.apply_ufunc(adhesion.cylinder_pull_off, data.work_of_separation, radius, modulus)
        return mean_quantity(data, PULL_OFF, leave_out_absent) / crack - 1
    if name in GRADIENT_DEFICITS:
        return 1 - mean_quantity(data, GRADIENT_DEFICITS[name]) / mean_quantity(data, "rms_gradient")
    if name in ERROR_BARS:
        return _standard_error(data, data[ERROR_BARS[name]])
    if name in BAR_SHARES:
        area = data[BAR_SHARES[name]]
        return _standard_error(data, area) / area.mean("member", skipna=False).max()
    values = data[name]
    if "member" not in values.dims:
        return values
    if not leave_out_absent:
        return values.mean("member", skipna=False)
    return values.mean("member").where(~unknown(data, name).any("member"))


def is_function_of_means(name: str) -> bool:
    """Return True for a quantity that follows from means over members alone."""
    return name not in FITTED and name not in SCATTERS


def unknown(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return True where a number of a member is unknown because a state was not solved.

    A number of a state is unknown where that state is; a summary of a path where it is missing and a state failed.
    """
    failed = _failed(data)
    others = [dim for dim in failed.dims if dim not in data[name].dims]
    return data[name].isnull() & failed.any(others) if others else failed


def unknown_summaries(data: xr.Dataset, names: list[str]) -> xr.Dataset:
    """Return the same as `unknown` for summaries of paths that all have the same dimensions, faster than one by one."""
    failed, numbers = _failed(data), data[names]
    return numbers.isnull() & failed.any([dim for dim in failed.dims if dim not in numbers.dims])


def _failed(data: xr.Dataset) -> xr.DataArray:
    """Return True where a state was sought and not solved."""
    return data.status.notnull() & ~is_solved(data.status)


def number_exists(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return True where a member has a number, or may have one that is unknown."""
    return (data[name].notnull() | unknown(data, name)).any("member")


def _standard_error(data: xr.Dataset, values: xr.DataArray) -> xr.DataArray:
    """Return the standard error of the mean of as many members as the study has, from those in the dataset.

    It is unknown from one member.
    """
    if data.sizes["member"] < 2:
        return xr.full_like(values.mean("member"), np.nan)
    return values.std("member", ddof=1, skipna=False) / np.sqrt(dataset.settings_of(data)["members"])


def _fitted_kappa(data: xr.Dataset, weighting: str, together: bool) -> xr.DataArray:
    """Return κ of Eq. 3.11 fitted to the area, (hurst_exponent, reduced_pressure); NaN if an area is unknown."""
    area = data.relative_contact_area.transpose("hurst_exponent", "member", "reduced_pressure")
    pressure = data.reduced_pressure.values

    def kappa(samples: Array) -> Array:
        """Return κ at all loads from areas (…, load)."""
        if not np.isfinite(samples).all():
            return np.full(len(pressure), np.nan)
        return hard_wall.line_area(pressure, *fit_line_area(pressure, samples, weighting)) / pressure

    values = [kappa(area.values)] * len(area) if together else [kappa(samples) for samples in area.values]
    return area.isel(member=0, drop=True).copy(data=np.array(values))


def resolves_edges(data: xr.Dataset) -> bool:
    """Return True if edges can be placed between points on all grids of a dataset."""
    settings = dataset.settings_of(data)
    surface = settings["surface"]
    if surface["kind"] != "self_affine":
        return True
    return bool((data.points * surface["short_cutoff"] >= RESOLVED_WAVELENGTH * surface["length"]).all())


def second_estimate(data: xr.Dataset, name: str, suffix: str = "") -> xr.DataArray:
    """Return the second estimator of a corrected quantity, on rough surfaces without its error of second order.

    On rough surfaces its change on halving the points has shown that order (docs/continuum.md), on lines it has not.

    suffix: of the variable, as of a mean
    """
    if name in CARRIED:
        counted, share = CARRIED[name], grid_share(data)
        return (1 - share) * second_estimate(data, f"{counted}_corrected") + share * data[counted]
    other = SECOND_ESTIMATORS[name]
    is_rough_surface = "length_y" in data and dataset.settings_of(data)["surface"]["kind"] == "self_affine"
    return data[f"{other}{suffix}"] + (data[f"{other}{GRID_CHANGE}"] / 3 if is_rough_surface else 0.0)


def computed_from(name: str) -> str:
    """Return the variable that a quantity is computed from."""
    others = SIZES | GRADIENT_DEFICITS | ERROR_BARS | BAR_SHARES | {CRACK_DEPARTURE: PULL_OFF}
    return "relative_contact_area" if name in FITTED else others.get(name, name)


def scatter_name(name: str) -> str | None:
    """Return the variable with the standard error of a grid error of means; None for another quantity."""
    base = name.removesuffix(GRID_ERROR)
    return f"{base}{GRID_CHANGE_SCATTER}" if base != name and base in AVERAGED else None


def source_quantity(name: str) -> str | None:
    """Return the averaged quantity that another is computed from; None for an exact one, which has no grid error."""
    source = computed_from(name)
    return source if source in (*AVERAGED, *CARRIED, *PATH_SUMMARIES) else None


def grid_change_name(name: str) -> str | None:
    """Return the variable that holds the change of a quantity's source on halving the grid; None if it is exact."""
    source = source_quantity(name)
    return None if source is None else f"{source}{GRID_CHANGE}"
