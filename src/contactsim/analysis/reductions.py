"""Numbers read off a dataset: its quantities as means over members, and the ways to reduce one to a single number.

Each take is a function of a quantity; where it wants another quantity or dimensions besides, its parameters
`against`, `along` and `across` say so.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable

import numpy as np
import xarray as xr

from contactsim import reference
from contactsim.analysis import grid_convergence
from contactsim.analysis.aggregate import AVERAGED
from contactsim.analysis.ensemble import converged, on_all_grids
from contactsim.analysis.fits import fit_line_area
from contactsim.observables.adhesion import FINAL, SUMMARY
from contactsim.observables.hysteresis import CYCLE
from contactsim.observables.linearity import AREA_LOAD
from contactsim.observables.peeling import ALONG, ONSET, THRESHOLD
from contactsim.study.keys import COMPANIONS, is_smooth
from contactsim.study.scenes import scene_of
from contactsim.study.study import Study


def mean(of: xr.DataArray) -> float:
    """The mean over all points."""
    return float(of.mean())


def spread(of: xr.DataArray, along: str) -> float:
    """(largest − smallest)/mean along a dimension, averaged over the others."""
    return float(((of.max(along) - of.min(along)) / of.mean(along)).mean())


def largest_spread(of: xr.DataArray, along: str) -> float:
    """(largest − smallest)/|mean| along a dimension, the largest over the others."""
    return float(((of.max(along) - of.min(along)) / abs(of.mean(along))).max())


def rise(of: xr.DataArray, along: str) -> float:
    """By which part it rises from the first to the last value of a dimension, averaged over the others."""
    return float(_rise(of, along).mean())


def largest_rise(of: xr.DataArray, along: str) -> float:
    """By which part it rises from the first to the last value of a dimension, the largest over the others."""
    return float(_rise(of, along).max())


def least_rise(of: xr.DataArray, along: str) -> float:
    """By which part it rises from the first to the last value of a dimension, the least over the others."""
    return float(_rise(of, along).min())


def rise_gain(of: xr.DataArray, along: str, across: str) -> float:
    """The part by which it rises along one dimension, at the last less that at the first value across another."""
    risen = _rise(of, along)
    return float((risen.isel({across: -1}) - risen.isel({across: 0})).mean())


def shortfall(of: xr.DataArray, along: str) -> float:
    """By which part of the last value of a dimension the first is smaller, averaged over the others."""
    return float((1 - of.isel({along: 0}) / of.isel({along: -1})).mean())


def _rise(of: xr.DataArray, along: str) -> xr.DataArray:
    return of.isel({along: -1}) / of.isel({along: 0}) - 1


def least_step(of: xr.DataArray, along: str) -> float:
    """The smallest change from one value of a dimension to the next, the smallest over the others."""
    return float(of.diff(along).min())


def largest_step(of: xr.DataArray, along: str) -> float:
    """The largest change from one value of a dimension to the next, the largest over the others."""
    return float(of.diff(along).max())


def least(of: xr.DataArray) -> float:
    """The smallest of all points."""
    return float(of.min())


def largest(of: xr.DataArray) -> float:
    """The largest of all points."""
    return float(of.max())


def fall(of: xr.DataArray, along: str) -> float:
    """By which part it falls from the first to the last value of a dimension, averaged over the others."""
    return float((1 - of.isel({along: -1}) / of.isel({along: 0})).mean())


def slope(of: xr.DataArray, against: xr.DataArray, along: str) -> float:
    """Slope of the straight line through the logarithms along a dimension, averaged over the others."""
    x = np.log(against) - np.log(against).mean(along)
    return float(((x * np.log(of)).sum(along, skipna=False) / (x**2).sum(along)).mean())


def spread_ratio(of: xr.DataArray, against: xr.DataArray, along: str) -> float:
    """The spread of one quantity over that of another."""
    return spread(of, along) / spread(against, along)


def departure(of: xr.DataArray, against: xr.DataArray) -> float:
    """The largest departure from another quantity, as a part of that."""
    return float(abs(of / against - 1).max())


def ratio(of: xr.DataArray, against: xr.DataArray) -> float:
    """The largest ratio to another quantity."""
    return float((of / against).max())


TAKES: dict[str, Callable[..., float]] = {
    take.__name__: take
    for take in (
        *(mean, spread, fall, slope, spread_ratio, departure, ratio),
        *(least, largest, least_step, largest_step, largest_spread),
        *(rise, least_rise, largest_rise, rise_gain, shortfall),
    )
}


def needs(take: str) -> list[str]:
    """What a take wants besides `of`: some of `against`, `along` and `across`."""
    return list(inspect.signature(TAKES[take]).parameters)[1:]


def _fit(data: xr.Dataset, weighting: str, together: bool) -> xr.DataArray:
    area = converged(data.relative_contact_area, data).transpose("hurst", "member", "reduced_pressure").values
    pressure = data.reduced_pressure.values
    sets = [area] * len(area) if together else area
    fits = [reference.line_area(pressure, *fit_line_area(pressure, one, weighting)) / pressure for one in sets]
    return xr.DataArray(fits, dims=("hurst", "reduced_pressure"))


FITTED: dict[str, tuple[str, bool]] = {
    "kappa_fit": ("area", False),
    "kappa_fit_logarithm": ("logarithm", False),
    "kappa_fit_all": ("area", True),
}
"""κ of Eq. 3.11 fitted to the selected loads: how it weighs, and whether all Hurst exponents share one fit."""


LIMIT = "_limit"
"""Ends the name of a quantity's limit on finer grids, of three."""


def grid_error(name: str) -> str | None:
    """The variable that says how far the averaged quantity behind another may be off; None for what is exact."""
    made = averaged(name)
    return None if made is None else f"{made}_spread" if name.endswith(LIMIT) else f"{made}_grid_error"


def quantities(study: Study) -> list[str]:
    """Names of the quantities that a study's dataset answers for."""
    if study.settings["path"] is not None:
        return _path_quantities(study)
    load = study.settings["load"]["name"]
    known = {*AVERAGED, "mean_pressure", load} - ({"kappa"} if load != "reduced_pressure" else set())
    if load == "contact_ratio":
        size = "contact_radius" if study.settings["surface"]["kind"] == "sphere" else "half_width"
        known |= {size, f"{size}_exact", "rms_gradient_exact"}
    known |= _errors(study, known & {*AVERAGED})
    if grid_convergence.is_doubled(study.settings["vary"].get("points", [])):
        known |= {f"{name}{LIMIT}" for name in AVERAGED if name in known}
    if study.dimensions == ["hurst", "member", "reduced_pressure"]:
        known |= set(FITTED)
    return sorted(known)


def _path_quantities(study: Study) -> list[str]:
    """What a path amounts to, its errors as far as they are measured, and what is varied."""
    known = set(AREA_LOAD)
    if is_smooth(study.settings):
        scene = scene_of(study.runs()[0].settings)
        slips = "t" in scene.components
        known |= {name for name in (*SUMMARY, *CYCLE) if slips or FINAL.get(name) != "slip"}
        known |= {name for name in ONSET if scene.sliding}
        known |= {name for name in THRESHOLD if scene.sliding and ALONG in study.dimensions}
    return sorted(known | _errors(study, known) | (set(study.dimensions) - {"member", "step"}))


def _errors(study: Study, names: set[str]) -> set[str]:
    """Names of the errors of quantities that a study measures."""
    kinds = [error for part, (_, error, _) in COMPANIONS.items() if study.settings[part] is not None]
    return {f"{name}_{error}_error" for name in names for error in kinds}


def quantity(data: xr.Dataset, name: str) -> xr.DataArray:
    """The means over members of a quantity, or their limit on finer grids; unconverged solutions are left out.

    Where one of the means has no limit, none counts: those that have one are not a fair choice.
    """
    if name.removesuffix(LIMIT) in AVERAGED and name.endswith(LIMIT):
        limit = grid_convergence.extrapolated(on_all_grids(data, name.removesuffix(LIMIT)).mean("member")).limit
        return limit.where(limit.notnull().all())
    if name in FITTED:
        return _fit(data, *FITTED[name])
    if name == "half_width":
        return quantity(data, "relative_contact_area") * data.length / 2
    if name == "contact_radius":
        return np.sqrt(quantity(data, "relative_contact_area") * data.length * data.length_y / np.pi)
    if "step" in data.dims:
        whole = name in (*CYCLE, *AREA_LOAD, *ONSET)  # what one member never reaches is not known of the others' mean
        return data[name].mean("member", skipna=not whole) if "member" in data[name].dims else data[name]
    return converged(data[name], data).mean("member")


def averaged(name: str) -> str | None:
    """The averaged quantity, with an error of the grid, that another is made from; None for what is exact."""
    made = "relative_contact_area" if name in (*FITTED, "half_width", "contact_radius") else name.removesuffix(LIMIT)
    return made if made in (*AVERAGED, *SUMMARY, *CYCLE, *AREA_LOAD, *ONSET, *THRESHOLD) else None
