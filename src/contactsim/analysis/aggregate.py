"""From the runs of a study to one dataset: ensemble means, standard errors, grid errors and fits.

Unconverged solutions are left out of means and fits, and counted. The grid error is the change of the mean on halving
the number of points, over the members for which both were computed: for a first-order quantity it bounds the error
that remains, for a higher order generously so. The tolerance error is the change on solving far more tightly.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from contactsim import dataset, reference
from contactsim.analysis import grid_convergence
from contactsim.analysis.ensemble import converged, on_all_grids
from contactsim.analysis.fits import fits
from contactsim.observables.adhesion import SUMMARY
from contactsim.observables.derived import combine_runs, summarise_approaches, summarise_paths
from contactsim.observables.hysteresis import CYCLE
from contactsim.observables.linearity import AREA_LOAD
from contactsim.observables.peeling import ONSET, THRESHOLD
from contactsim.variables import ERRORS

AVERAGED = (
    "relative_contact_area",
    "relative_contact_area_subgrid",
    "kappa",
    "kappa_r",
    "kappa_r_pairs",
    "rms_gradient_contact",
    "rms_gradient_contact_pairs",
    "reduced_pressure_contact",
    "mean_gap",
)
AVERAGED_STATES = (
    "mean_pressure",
    "normalised_pressure",
    "relative_repulsive_area",
    "relative_interacting_area",
    "gradient_ratio_repulsive",
    "gradient_ratio_interacting",
    "mean_gap",
)
"""What is averaged over members state by state, of paths with smooth laws."""
ROUND = {
    False: ("half_width_exact", reference.cylinder_rms_gradient),
    True: ("contact_radius_exact", reference.sphere_rms_gradient),
}
"""Size of the contact of a cylinder, or of a sphere, and the exact gradient in it."""


def aggregate(runs: list[dict], settings: dict, source: str) -> xr.Dataset:
    """One dataset of a study: dims (varied keys, member, load).

    runs: path, coordinates, member, companion and error of each; settings: of the study; source: digest of the code.
    """
    fine = _read([run for run in runs if not run["companion"]])
    if "step" in fine.dims:
        return dataset.stamped(dataset.described(_paths(fine, runs)), settings["title"], settings, source)
    if "contact_ratio" in fine.dims:
        radius = fine.radius if "radius" in fine.dims else settings["surface"]["radius"]
        size, gradient = ROUND["length_y" in fine]
        fine[size] = fine.contact_ratio * radius
        fine["rms_gradient_exact"] = xr.apply_ufunc(gradient, fine[size], radius)
    data = fine.merge(_ensemble(fine))
    for suffix, other in _others(runs):
        data = data.merge(_change(fine, other, suffix))
    if "points" in fine.dims and grid_convergence.is_doubled(fine.points):
        data = data.merge(_limits(fine))
    if settings["fit_limits"] is not None:
        data = data.merge(fits(fine, settings["fit_limits"]))
    return dataset.stamped(dataset.described(data), settings["title"], settings, source)


def _paths(fine: xr.Dataset, runs: list[dict]) -> xr.Dataset:
    """Paths with what they amount to, and its change on halving the grid, on solving more tightly, and with no less."""
    smooth = "line_load" in fine  # else a hard wall pressed through given approaches
    made, names = (
        (summarise_paths, AVERAGED_STATES) if smooth else (summarise_approaches, (*AVERAGED, "normalised_pressure"))
    )
    data = made(fine)
    if data.member.size > 1:
        data = data.merge(_ensemble(data, names))
    for suffix, other in _others(runs):
        other = made(other)
        same = data.sel(member=other.member)
        known = [name for name in (*SUMMARY, *CYCLE, *AREA_LOAD, *ONSET, *THRESHOLD) if name in other and name in same]
        data = data.assign({f"{name}{suffix}": abs(same[name] - other[name]).max("member") for name in known})
        if data.member.size > 1 or not smooth:
            data = data.merge(_change(data, other, suffix, names))
    return data


def _others(runs: list[dict]) -> Iterator[tuple[str, xr.Dataset]]:
    """What errors are measured by, as far as there is such: suffix and dataset."""
    for error in ERRORS:
        others = [run for run in runs if run["companion"] and run.get("error", "grid") == error]
        if others:
            yield f"_{error}_error", _read(others)


def _read(runs: list[dict]) -> xr.Dataset:
    return combine_runs([(dataset.read(run["path"]), run["coordinates"] | {"member": run["member"]}) for run in runs])


def _ensemble(data: xr.Dataset, names: Sequence[str] = AVERAGED) -> xr.Dataset:
    found = {}
    for name in names:
        if name in data:
            values = converged(data[name], data)
            count = values.notnull().sum("member")
            found[f"{name}_mean"] = values.mean("member")
            spread = values.std("member", ddof=1) if data.member.size > 1 else values.mean("member") * np.nan
            found[f"{name}_standard_error"] = spread / np.sqrt(count)
    return xr.Dataset(found)


def _change(fine: xr.Dataset, coarse: xr.Dataset, suffix: str, names: Sequence[str] = AVERAGED) -> xr.Dataset:
    """How far the means move between two datasets, over the members that both have."""
    same = fine.sel(member=coarse.member)
    return xr.Dataset(
        {
            f"{name}{suffix}": abs((converged(same[name], same) - converged(coarse[name], coarse)).mean("member"))
            for name in names
            if name in fine
        }
    )


def _limits(data: xr.Dataset) -> xr.Dataset:
    """Means on three grids, extrapolated: NAME_limit, _order and _spread, and standard errors of the first two."""
    found = {}
    for name in AVERAGED:
        if name in data:
            ends = grid_convergence.jackknifed(grid_convergence.extrapolated, on_all_grids(data, name))
            kept = ends.drop_vars("spread_standard_error")
            found |= {f"{name}_{kind}": values for kind, values in kept.items()}
    return xr.Dataset(found)
