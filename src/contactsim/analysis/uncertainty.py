"""Estimate the number that answers a claim, with its ensemble error and its grid error.

A claim relative to a second study is about the ratio of the two means, at the loads and variants that both studies
have. A key that only one study varies is compared at each of its values. Two ensembles of the same random waves lose
the same member together in the jackknife. Of independent ensembles one loses a member, then the other, and the two
errors add in quadrature. The grid error is that of the worst combination of signs; it overstates the error of a ratio
if both studies err to the same side. It contains what the increments of a path leave open. The grid error of a limit
on finer grids is its distance from the limit of first order.
"""

from __future__ import annotations

import functools
import itertools
import math
import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.analysis.ensemble import widen_interval
from contactsim.analysis.reductions import REDUCTIONS, grid_error_name, mean_quantity, reduction_inputs, source_quantity

NAN = float("nan")
PATH_DIMENSIONS = ("step", "snapshot", "x", "event")
"""Dimensions along a path: two studies need not share them, as summaries of paths do not have them."""


@dataclass(frozen=True)
class Estimate:
    """A number with its ensemble error and its grid error; NaN is unknown."""

    value: float = NAN
    ensemble_error: float = NAN
    grid_error: float = NAN


def estimate(claim: Mapping, data: Sequence[xr.Dataset], condition: Mapping | None = None) -> Estimate:
    """Return the number that answers a claim.

    Parameters
    ----------
    claim
        Settings of the claim.
    data
        Datasets of its studies: one, or two for a ratio.
    condition
        A condition of the claim, which narrows its selection; None for the whole selection.

    Returns
    -------
    The number, all NaN where the selection is empty.
    """
    parts = [claim] if condition is None else [claim, condition]
    for dim, ends in [interval for part in parts for interval in part["select"].items()]:
        selection = {dim: slice(*widen_interval(*ends))}
        data = [study.sel(selection) if dim in study.dims else study for study in data]
    data = xr.align(*data, join="inner", exclude={"member", *PATH_DIMENSIONS})
    if any(0 in study.sizes.values() for study in data):
        return Estimate()
    value = _number(claim, data)
    ensemble_error = math.hypot(*(_jackknife_error(claim, data, group) for group in _ensemble_groups(data)))
    grid_error = _grid_error(claim, data, value)
    if "thesis" in [part["grid"] for part in parts]:
        own = all((study.points == dataset.settings_of(study)["thesis_points"]).all() for study in data)
        grid_error = 0.0 if own else NAN
    return Estimate(value, ensemble_error, grid_error)


def _number(claim: Mapping, data: Sequence[xr.Dataset]) -> float:
    """Return the quantity of a claim, reduced to one number."""

    def values(name: str) -> xr.DataArray:
        """Return a quantity, or the ratio of it in two studies."""
        return functools.reduce(operator.truediv, [mean_quantity(study, name) for study in data])

    convert = {"against": values, "along": str, "across": str}
    inputs = {name: convert[name](claim[name]) for name in reduction_inputs(claim["reduce"])}
    return REDUCTIONS[claim["reduce"]](values(claim["quantity"]), **inputs)


def _ensemble_groups(data: Sequence[xr.Dataset]) -> list[tuple[int, ...]]:
    """Return the indices of the datasets in groups whose members have the same random waves."""
    settings = [dataset.settings_of(study) for study in data]
    waves = [(own.get("same_surfaces_as") or own.get("name", index)) for index, own in enumerate(settings)]
    shared = len(set(waves)) == 1 and len({study.member.size for study in data}) == 1
    indices = range(len(data))
    return [tuple(indices)] if shared else [(index,) for index in indices]


def _jackknife_error(claim: Mapping, data: Sequence[xr.Dataset], group: Sequence[int]) -> float:
    """Return the standard error from leaving out each member of a group of datasets; of a mean it is the usual one.

    One member has no error if the surface is not random, else an unknown one.
    """
    count = data[group[0]].member.size
    if count == 1:
        return NAN if dataset.settings_of(data[group[0]])["surface"]["kind"] == "self_affine" else 0.0

    def without(member: int) -> list[xr.Dataset]:
        """Return all datasets, those of the group without that member."""
        return [study.drop_isel(member=member) if index in group else study for index, study in enumerate(data)]

    numbers = [_number(claim, without(member)) for member in range(count)]
    return math.sqrt((count - 1) * np.var(numbers))


def _grid_error(claim: Mapping, data: Sequence[xr.Dataset], value: float) -> float:
    """Return the largest change when each quantity of each dataset moves up or down by its grid error."""
    inexact = [claim[key] for key in ("quantity", "against") if claim[key] is not None and source_quantity(claim[key])]
    errors = {source_quantity(name): grid_error_name(name) for name in sorted(inexact)}
    shifts = [(index, name) for index in range(len(data)) for name in sorted(errors)]
    if any(errors[name] not in data[index] for index, name in shifts):
        return NAN
    changes = []
    for signs in itertools.product((-1, 1), repeat=len(shifts)):
        shifted = list(data)
        for sign, (index, name) in zip(signs, shifts, strict=True):
            error = abs(data[index][errors[name]]) + _increment_error(data[index], name)
            shifted[index] = shifted[index].assign({name: data[index][name] + sign * error})
        changes.append(abs(_number(claim, shifted) - value))
    return max(changes)


def _increment_error(data: xr.Dataset, name: str) -> xr.DataArray | float:
    """Return what the increments of a path leave open; zero for other quantities."""
    error = data.get(f"{name}_increment_error")
    return 0.0 if error is None else error.max("member")
