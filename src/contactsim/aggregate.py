"""From the runs of a study to one dataset: ensemble means, standard errors, grid errors and fits.

Unconverged solutions are left out of means and fits, and counted. The grid error is the change of the mean on halving
the number of points, over the members for which both were computed: for a first-order quantity it bounds the error
that remains, for a higher order generously so. The tolerance error is the change on solving far more tightly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.optimize import least_squares
from scipy.special import stdtrit

from contactsim import analytic, dataset, extrapolation
from contactsim.adhesion import SUMMARY, summarised
from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.observables import proportionality
from contactsim.solvers.base import Status

APART = ("contact_bits", "contact_pressure", "profile_real", "profile_imag", "point")
"""What stays with the runs."""

AVERAGED = (
    "relative_contact_area",
    "kappa",
    "kappa_r",
    "kappa_r_bond",
    "rms_gradient_contact",
    "rms_gradient_contact_bond",
    "reduced_pressure_contact",
    "mean_gap",
)
ROUND = {
    False: ("half_width_exact", analytic.cylinder_rms_gradient),
    True: ("contact_radius_exact", analytic.sphere_rms_gradient),
}
"""Size of the contact of a cylinder, or of a sphere, and the exact gradient in it."""
LOADS = ("reduced_pressure", "mean_pressure", "contact_ratio")


def aggregate(runs: list[dict], settings: dict, source: str) -> xr.Dataset:
    """One dataset of a study: dims (varied keys, member, load).

    runs: path, coordinates, member, companion and tight of each; settings: of the study; source: digest of the code.
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
    for suffix, tight in (("_grid_error", False), ("_tolerance_error", True)):
        others = [run for run in runs if run["companion"] and run.get("tight", False) is tight]
        if others:
            data = data.merge(_change(fine, _read(others), suffix))
    if "points" in fine.dims and extrapolation.is_doubled(fine.points):
        data = data.merge(_limits(fine))
    if settings["fit_limits"] is not None:
        data = data.merge(fits(fine, settings["fit_limits"]))
    return dataset.stamped(dataset.described(data), settings["title"], settings, source)


def load_name(data: xr.Dataset) -> str:
    """The dimension along which the load varies."""
    return next(name for name in LOADS if name in data.dims)


def converged(values: xr.DataArray, data: xr.Dataset) -> xr.DataArray:
    """Values with NaN where the solution did not converge."""
    return values.where(data.status == Status.CONVERGED.value[0])


def left_out(data: xr.Dataset) -> tuple[int, int]:
    """How many solutions did not converge, and how many there are."""
    return int((data.status != Status.CONVERGED.value[0]).sum()), data.status.size


def combined(parts: list[tuple[xr.Dataset, dict[str, object]]]) -> xr.Dataset:
    """Datasets of runs, each with its place among the varied keys and members, as one, with κ and κ_r."""
    places = [
        data.drop_vars([*APART, *place], errors="ignore").expand_dims({name: [at] for name, at in place.items()})
        for data, place in parts
    ]
    data = xr.combine_by_coords(places, combine_attrs="drop", join="outer", compat="no_conflicts")
    for name in {"points", "length", "contact_modulus", "seed", "points_y", "length_y"} & set(data):
        if (data[name] == data[name].values.flat[0]).all():
            data[name] = data[name].values.flat[0]
    return data if "step" in data.dims else _derived(data)


def _paths(fine: xr.Dataset, runs: list[dict]) -> xr.Dataset:
    """Paths with what they amount to, and its change on halving the grid and on solving more tightly."""
    if "line_load" not in fine:  # a hard wall pressed through given approaches
        return fine
    data = summarised(fine)
    for suffix, tight in (("_grid_error", False), ("_tolerance_error", True)):
        others = [run for run in runs if run["companion"] and run.get("tight", False) is tight]
        if others:
            other = summarised(_read(others))
            same = data.sel(member=other.member)
            changes = {name: abs(same[name] - other[name]).max("member") for name in SUMMARY if name in other}
            data = data.assign({f"{name}{suffix}": change for name, change in changes.items()})
    return data


def _read(runs: list[dict]) -> xr.Dataset:
    return combined([(dataset.read(run["path"]), run["coordinates"] | {"member": run["member"]}) for run in runs])


def _derived(data: xr.Dataset) -> xr.Dataset:
    area, pressure, modulus = data.relative_contact_area, data.mean_pressure, data.contact_modulus

    def kappa(gradient: xr.DataArray) -> xr.DataArray:
        return xr.apply_ufunc(proportionality, area, pressure, gradient, modulus)

    data = data.assign(
        kappa_r=kappa(data.rms_gradient_contact),
        kappa_r_bond=kappa(data.rms_gradient_contact_bond),
        reduced_pressure_contact=pressure / (data.rms_gradient_contact * modulus),
    )
    if "reduced_pressure" in data.dims:
        data["kappa"] = area / data.reduced_pressure
    if "contact_ratio" in data.dims and "length_y" in data:
        data["contact_radius"] = np.sqrt(area * data.length * data.length_y / np.pi)
    elif "contact_ratio" in data.dims:
        data["half_width"] = area * data.length / 2
    return data


def _ensemble(data: xr.Dataset) -> xr.Dataset:
    found = {}
    for name in AVERAGED:
        if name in data:
            values = converged(data[name], data)
            count = values.notnull().sum("member")
            found[f"{name}_mean"] = values.mean("member")
            spread = values.std("member", ddof=1) if data.member.size > 1 else values.mean("member") * np.nan
            found[f"{name}_standard_error"] = spread / np.sqrt(count)
    return xr.Dataset(found)


def _change(fine: xr.Dataset, coarse: xr.Dataset, suffix: str) -> xr.Dataset:
    """How far the means move between two datasets, over the members that both have."""
    same = fine.sel(member=coarse.member)
    return xr.Dataset(
        {
            f"{name}{suffix}": abs((converged(same[name], same) - converged(coarse[name], coarse)).mean("member"))
            for name in AVERAGED
            if name in fine
        }
    )


def _limits(data: xr.Dataset) -> xr.Dataset:
    """Means on three grids, extrapolated: NAME_limit, _order and _spread, and standard errors of the first two."""
    found = {}
    for name in AVERAGED:
        if name in data:
            ends = extrapolation.jackknifed(extrapolation.extrapolated, on_all_grids(data, name))
            kept = ends.drop_vars("spread_standard_error")
            found |= {f"{name}_{kind}": values for kind, values in kept.items()}
    return xr.Dataset(found)


def on_all_grids(data: xr.Dataset, name: str) -> xr.DataArray:
    """A quantity of the members that converged on all grids; NaN for the others."""
    values = converged(data[name], data)
    return values.where(values.notnull().all("points"))


def ratio_limits(one: xr.Dataset, two: xr.Dataset, name: str) -> xr.Dataset:
    """The mean of a quantity over that in another, independent ensemble, on three grids and extrapolated.

    `points` of both count the same points per wavelength. Returns `ratio` along `points` and, with both means
    extrapolated, `limit` and its `spread`: less that of first order; each with its standard error.
    """

    def ratios(above: xr.DataArray, below: xr.DataArray) -> xr.Dataset:
        return (above / below).to_dataset(name="ratio")

    def limits(above: xr.DataArray, below: xr.DataArray) -> xr.Dataset:
        top, bottom = extrapolation.extrapolated(above), extrapolation.extrapolated(below)
        limit = top.limit / bottom.limit
        first = (top.limit - top.spread) / (bottom.limit - bottom.spread)
        return xr.Dataset({"limit": limit, "spread": limit - first})

    ensembles = [on_all_grids(data, name) for data in (one, two)]
    return xr.merge([extrapolation.jackknifed(measure, *ensembles) for measure in (ratios, limits)])


@dataclass(frozen=True)
class Departure:
    """A difference of two means: its size, its standard error, and the two places."""

    difference: float
    standard_error: float
    places: tuple[dict[str, float], dict[str, float]]

    @property
    def in_errors(self) -> float:
        """The difference over its standard error."""
        return self.difference / self.standard_error


def departure(data: xr.Dataset, name: str, along: str) -> Departure:
    """The most significant difference of a quantity between two values of `along`, all else being equal.

    Members are the same profiles but for their scale along everything else than the Hurst exponent, so differences are
    taken member by member there; different Hurst exponents are independent. Needs two members or more.
    """
    if data.member.size < 2:
        raise SceneError("members", data.member.size, "2 or more: without a spread nothing is significant")
    if data[along].size < 2:
        raise SceneError(along, data[along].size, "2 or more values: a difference needs two")
    values = converged(data[name], data)
    others = [dim for dim in values.dims if dim not in ("member", along)]
    best = None
    for (i, first), (j, second) in (
        (a, b) for a in enumerate(data[along]) for b in enumerate(data[along]) if a[0] < b[0]
    ):
        one, two = values.isel({along: i}, drop=True), values.isel({along: j}, drop=True)
        paired = along != "hurst"
        gap = abs((one - two).mean("member")) if paired else abs(one.mean("member") - two.mean("member"))
        square = _squared_error(one - two) if paired else _squared_error(one) + _squared_error(two)
        error = np.sqrt(square)
        if not (gap / error).notnull().any():
            continue
        place = (gap / error).argmax(...)
        found = Departure(
            float(gap[place]),
            float(error[place]),
            tuple(
                {dim: float(data[dim][place[dim]]) for dim in others} | {along: float(end)} for end in (first, second)
            ),
        )
        if best is None or found.in_errors > best.in_errors:
            best = found
    return best


def relative_change(data: xr.Dataset, name: str, along: str, reference: object) -> xr.Dataset:
    """Change of a quantity from its value at a reference of `along`, as a part of that, with its standard error.

    Taken member by member, so only for what leaves the profiles as they are. Variables `NAME_change` and
    `NAME_change_standard_error`, the latter NaN for one member.
    """
    apart = difference(data, name, along, reference)
    values = converged(data[name], data)
    start = values.sel({along: reference}, drop=True)
    level = start.where(values.notnull()).mean("member")
    names = {f"{name}_difference{error}": f"{name}_change{error}" for error in ("", "_standard_error")}
    return (apart / level).rename(names)


def difference(data: xr.Dataset, name: str, along: str, reference: object) -> xr.Dataset:
    """Difference of a quantity from its value at a reference of `along`, and its standard error.

    Taken member by member, over those known at both. Variables `NAME_difference` and `NAME_difference_standard_error`,
    the latter NaN for one member.
    """
    values = converged(data[name], data)
    apart = values - values.sel({along: reference}, drop=True)
    mean = apart.mean("member")
    error = np.sqrt(_squared_error(apart)) if data.member.size > 1 else mean * np.nan
    return xr.Dataset({f"{name}_difference": mean, f"{name}_difference_standard_error": error})


def _squared_error(values: xr.DataArray) -> xr.DataArray:
    """Squared standard error of the mean over the members that are known."""
    return values.var("member", ddof=1) / values.notnull().sum("member")


def ratio_of_means(one: xr.Dataset, two: xr.Dataset, name: str) -> xr.Dataset:
    """The mean of a quantity over that in another, independent ensemble: `value` and its standard `error`."""
    value = one[f"{name}_mean"] / two[f"{name}_mean"]
    parts = [data[f"{name}_standard_error"] / data[f"{name}_mean"] for data in (one, two)]
    return xr.Dataset({"value": value, "error": value * np.sqrt(parts[0] ** 2 + parts[1] ** 2)})


WEIGHTINGS = ("area", "logarithm")


def fits(data: xr.Dataset, limits: list[float]) -> xr.Dataset:
    """Eq. 3.11 fitted to each Hurst exponent and to all, two weightings, each up to each limit of p*.

    Returns b1 and b2 with half-widths of their 95 % confidence intervals by the jackknife over members: dims
    (fitted, weighting, fit_limit).
    """
    area = converged(data.relative_contact_area, data).transpose("hurst", "member", "reduced_pressure").values
    pressure = data.reduced_pressure.values
    sets = [[row] for row in range(data.hurst.size)] + [list(range(data.hurst.size))]
    names = [f"{value:g}" for value in data.hurst.values] + ["all"]
    values = np.full((4, len(sets), len(WEIGHTINGS), len(limits)), np.nan)
    for s, rows in enumerate(sets):
        for w, weighting in enumerate(WEIGHTINGS):
            for k, limit in enumerate(limits):
                below = pressure <= limit * (1 + 1e-9)
                chosen = area[rows][:, :, below]
                best = fit_line_area(pressure[below], chosen, weighting)
                values[:2, s, w, k] = best
                values[2:, s, w, k] = _jackknife(pressure[below], chosen, weighting)
    dims = ("fitted", "weighting", "fit_limit")
    kinds = ("fit_b1", "fit_b2", "fit_b1_half_width", "fit_b2_half_width")
    variables = {name: (dims, block) for name, block in zip(kinds, values, strict=True)}
    return xr.Dataset(variables, {"fitted": names, "weighting": list(WEIGHTINGS), "fit_limit": limits})


def fit_line_area(pressure: Array, area: Array, weighting: str) -> tuple[float, float]:
    """b1 and b2 of Eq. 3.11 by least squares; pressure (k,), area (..., k), NaN left out.

    weighting: "area" weighs the area itself, so the largest loads decide; "logarithm" weighs all alike.
    """
    known = np.isfinite(area) & (area > 0)
    if not known.any():
        return float("nan"), float("nan")

    def misfit(logarithms: Array) -> Array:
        model = np.broadcast_to(analytic.line_area(pressure, *np.exp(logarithms)), area.shape)[known]
        return model - area[known] if weighting == "area" else np.log(model) - np.log(area[known])

    found = least_squares(misfit, np.log([0.7, 1.0]), bounds=(np.log([1e-2, 1e-4]), np.log([1e1, 1e4])), x_scale="jac")
    return tuple(np.exp(found.x))


def _jackknife(pressure: Array, area: Array, weighting: str) -> Array:
    members = area.shape[1]
    if members < 3:
        return np.full(2, np.nan)
    parts = [fit_line_area(pressure, np.delete(area, member, axis=1), weighting) for member in range(members)]
    error = np.sqrt((members - 1) / members * np.sum((parts - np.mean(parts, axis=0)) ** 2, axis=0))
    return error * stdtrit(members - 1, 0.975)
