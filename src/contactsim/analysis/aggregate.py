"""Aggregate the runs of a study into one dataset: ensemble means, standard errors, other errors and fits.

Solutions that did not converge are left out of means and fits, and counted. The grid error is the change of the mean
on halving the number of points, over the members that were solved on both grids. It bounds the remaining error of a
quantity of first order, generously for a higher order. The tolerance error is the change on solving more tightly.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.analysis import grid_convergence
from contactsim.analysis.ensemble import converged, on_all_grids
from contactsim.analysis.fits import PARAMETERS, fit_line_areas
from contactsim.analysis.height_distribution import height_distances
from contactsim.analysis.peel_resolution import leave_out_unresolved_peel
from contactsim.analysis.quantities import unknown_summaries
from contactsim.analysis.rough_readings import rough_path_of
from contactsim.observables.contact_readings import summarise_readings
from contactsim.observables.dataset_forms import AVERAGED, PATH_SUMMARIES, DatasetForm, form_of
from contactsim.observables.derived import combine_runs
from contactsim.observables.proportionality import proportionality
from contactsim.reference import hard_wall
from contactsim.variables import ERRORS, GRID_CHANGE, GRID_CHANGE_SCATTER, GRID_ERROR

EXACT_CONTACTS = {
    "line": ("half_width_exact", hard_wall.cylinder_rms_gradient, hard_wall.CYLINDER_KAPPA_R),
    "surface": ("contact_radius_exact", hard_wall.sphere_rms_gradient, hard_wall.SPHERE_KAPPA_R),
}
"""Name of the exact contact size of a cylinder or a sphere, the exact gradient in the contact, and the exact κ_r."""

ROLL_OFF = "long_cutoff"
"""Dimension of a study that varies the roll-off wavelength; its runs have the distribution of their heights."""


def aggregate(runs: list[dict], settings: dict, source: str) -> xr.Dataset:
    """Return the dataset of a study, with dimensions (varied keys, member, load).

    Parameters
    ----------
    runs
        Of each run `path`, `coordinates`, `member`, `measures_error` and `error`.
    settings
        Settings of the study.
    source
        Digest of the code that made the runs.
    """
    combined = _read_runs([run for run in runs if not run["measures_error"]])
    form = form_of(combined)
    data = form.derive(combined)
    data = (
        _aggregate_paths(data, form, runs, settings) if form.is_path else _aggregate_loads(data, form, runs, settings)
    )
    if ROLL_OFF in data.dims:
        data = data.merge(height_distances([run for run in runs if not run["measures_error"]]))
    return dataset.stamp(dataset.describe(data), settings["title"], settings, source)


def _aggregate_loads(fine: xr.Dataset, form: DatasetForm, runs: list[dict], settings: dict) -> xr.Dataset:
    """Return loads on their own with means, errors, limits on finer grids and fits."""
    if "contact_ratio" in fine.dims:
        radius = fine.radius if "radius" in fine.dims else settings["surface"]["radius"]
        size, gradient, kappa_r = EXACT_CONTACTS["surface" if "length_y" in fine else "line"]
        fine[size] = fine.contact_ratio * radius
        fine["rms_gradient_exact"] = xr.apply_ufunc(gradient, fine[size], radius)
        fine["kappa_r_exact"] = xr.full_like(fine[size], kappa_r)
        if "length_y" not in fine:
            fine = fine.assign(_exact_array(fine, radius))
    data = fine.merge(ensemble_means(fine, form.averaged))
    for suffix, other in _error_runs(runs):
        data = data.merge(_mean_changes(fine, form.derive(other), suffix, form.averaged))
    if "points" in fine.dims and grid_convergence.is_doubled(fine.points):
        data = data.merge(finer_grid_limits(fine))
    if settings["fit_limits"] is not None:
        for estimator in PARAMETERS:
            data = data.merge(fit_line_areas(fine, settings["fit_limits"], estimator))
    return data


def _exact_array(data: xr.Dataset, radius: xr.DataArray | float) -> dict[str, xr.DataArray]:
    """Return the exact contact of parallel cylinders a period apart, each under the load of its dataset."""
    load = data.mean_pressure * data.length
    half_width = xr.apply_ufunc(hard_wall.cylinder_array_half_width, load, radius, data.length, data.contact_modulus)
    gradient = xr.apply_ufunc(hard_wall.cylinder_rms_gradient, half_width, radius)
    area = 2 * half_width / data.length
    kappa_r = xr.apply_ufunc(proportionality, area, data.mean_pressure, gradient, data.contact_modulus)
    return {"half_width_array": half_width, "rms_gradient_array": gradient, "kappa_r_array": kappa_r}


def _aggregate_paths(data: xr.Dataset, form: DatasetForm, runs: list[dict], settings: dict) -> xr.Dataset:
    """Return paths with means of their states, and the errors of their summaries."""
    rough = rough_path_of(settings, "rms_slip" in data)
    data = data if rough is None else summarise_readings(data, rough)
    if data.member.size > 1:
        data = data.merge(ensemble_means(data, form.averaged))
    for suffix, combined in _error_runs(runs):
        other = form.derive(combined)
        other = other if rough is None else summarise_readings(other, rough)
        same = data.sel(member=other.member)
        names = [name for name in PATH_SUMMARIES if name in other and name in same]
        changes = _known_changes(same, other, names)
        data = data.assign({f"{name}{suffix}": error for name, error in abs(changes).max("member").items()})
        if suffix == GRID_ERROR:
            data = data.assign({f"{name}{GRID_CHANGE}": mean for name, mean in changes.mean("member").items()})
        if data.member.size > 1 or form.compares_one_member:
            data = data.merge(_mean_changes(data, other, suffix, form.averaged), join="outer")
    return leave_out_unresolved_peel(data)


def _read_runs(runs: list[dict]) -> xr.Dataset:
    """Return the combined dataset of runs."""
    return combine_runs(
        [(dataset.load_dataset(run["path"]), run["coordinates"] | {"member": run["member"]}) for run in runs]
    )


def _error_runs(runs: list[dict]) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield the suffix and the combined runs of each kind of error that is measured."""
    for error in ERRORS:
        error_runs = [run for run in runs if run["measures_error"] and run.get("error", "grid") == error]
        if error_runs:
            yield f"_{error}_error", _read_runs(error_runs)


def ensemble_means(data: xr.Dataset, names: Sequence[str]) -> xr.Dataset:
    """Return means over members and their standard errors; of paths, as far as all of them go."""
    variables = {}
    for name in names:
        if name in data:
            values = converged(data[name], data)
            if "step" in values.dims:  # a mean over the paths that still go on would jump where one ends
                values = values.where(data.status.notnull().all("member"))
            spread = values.std("member", ddof=1) if data.member.size > 1 else values.mean("member") * np.nan
            variables[f"{name}_mean"] = values.mean("member")
            variables[f"{name}_standard_error"] = spread / np.sqrt(values.notnull().sum("member"))
    return xr.Dataset(variables)


def _mean_changes(fine: xr.Dataset, other: xr.Dataset, suffix: str, names: Sequence[str]) -> xr.Dataset:
    """Return the changes of the means between two datasets, over the members that both have.

    On halving the grid they stand there with their sign too, and with their standard error from two members on.
    """
    same = fine.sel(member=other.member)
    changes = {name: converged(same[name], same) - converged(other[name], other) for name in names if name in fine}
    means = {name: change.mean("member", skipna=False) for name, change in changes.items()}
    variables = {f"{name}{suffix}": abs(mean) for name, mean in means.items()}
    if suffix == GRID_ERROR:
        variables |= {f"{name}{GRID_CHANGE}": mean for name, mean in means.items()}
        if (count := other.member.size) > 1:
            scatters = {name: change.std("member", ddof=1, skipna=False) for name, change in changes.items()}
            variables |= {f"{name}{GRID_CHANGE_SCATTER}": std / np.sqrt(count) for name, std in scatters.items()}
    return xr.Dataset(variables)


def _known_changes(fine: xr.Dataset, other: xr.Dataset, names: Iterable[str]) -> xr.Dataset:
    """Return the changes of summaries between two datasets of the same members.

    All of one are unknown where one is, because a state of its path was not solved; a member without such a number has
    none.
    """
    groups: dict[tuple, list[str]] = {}  # of the same dimensions, all at once: there are many
    for name in names:
        groups.setdefault((fine[name].dims, other[name].dims), []).append(name)
    changes = xr.Dataset()
    for group in groups.values():
        is_unknown = unknown_summaries(fine, group) | unknown_summaries(other, group)
        changes = changes.assign((fine[group] - other[group]).where(~is_unknown.any("member")).data_vars)
    return changes


def finer_grid_limits(data: xr.Dataset) -> xr.Dataset:
    """Return means extrapolated from three grids: `NAME_limit`, `_order` and `_spread`, with standard errors."""
    variables = {}
    for name in AVERAGED:
        if name in data:
            limits = grid_convergence.jackknife(grid_convergence.extrapolate, on_all_grids(data, name))
            columns = limits.drop_vars("spread_standard_error")
            variables |= {f"{name}_{kind}": values for kind, values in columns.items()}
    return xr.Dataset(variables)
