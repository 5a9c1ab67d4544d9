"""Estimate the number that answers a claim, with its ensemble error and its grid error.

A claim relative to a second study is about the ratio of the two means, at the loads and variants that both studies
have; a claim minus a second study is about their difference. A key that only one study varies is compared at each of
its values. The rules of the errors stand in `docs/judging.md`.
"""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.analysis.cross_validation import joint_splits
from contactsim.analysis.ensemble import widen_interval
from contactsim.analysis.quantities import grid_change_name, mean_quantity, number_exists, source_quantity, unknown
from contactsim.analysis.reductions import ORDERS, REDUCTIONS
from contactsim.analysis.wording import quantity_text, range_text
from contactsim.grid import Array

Number = Callable[[Sequence[xr.Dataset], Sequence[xr.Dataset]], Any]
"""Function of the datasets where extremes are searched, and of those where they are measured."""
NAN = float("nan")
PATH_DIMENSIONS = ("step", "snapshot", "x", "event")
"""Dimensions along a path: two studies need not share them, as summaries of paths do not have them."""


@dataclass(frozen=True)
class Estimate:
    """A number with its ensemble error and its grid error; NaN is unknown."""

    value: float = NAN
    ensemble_error: float = NAN
    grid_error: float = NAN

    @property
    def error(self) -> float:
        """Both errors in quadrature."""
        return math.hypot(self.ensemble_error, self.grid_error)


def select(data: Sequence[xr.Dataset], selection: Mapping[str, Sequence[float]]) -> list[xr.Dataset]:
    """Return the datasets at selected loads and variants; of two studies those that both have.

    Parameters
    ----------
    data
        Datasets of one study, or of the two studies of a comparison.
    selection
        Least and largest value of dimensions.
    """
    for dim, ends in selection.items():
        within = {dim: slice(*widen_interval(*ends))}
        data = [study.sel(within) if dim in study.dims else study for study in data]
    return list(xr.align(*data, join="inner", exclude={"member", *PATH_DIMENSIONS}))


def varied_dimensions(claim: Mapping, data: Sequence[xr.Dataset]) -> dict[str, Array]:
    """Return the loads and variants that a claim's quantities depend on, by dimension."""
    values = _values(claim | {"absent": None}, data, claim["quantity"])
    return {str(dim): values[dim].values for dim in values.dims if values.sizes[dim] > 1}


def unknown_places(claim: Mapping, data: Sequence[xr.Dataset]) -> str:
    """Return in words where a claim's quantities are unknown: the first place, and the number of all; else nothing."""
    for study in data:
        for name in filter(None, (claim["quantity"], claim["against"])):
            source = source_quantity(name)
            if source is None or "member" not in study[source].dims:
                continue
            gaps = unknown(study, source) if claim["absent"] else study[source].isnull() | unknown(study, source)
            places = np.argwhere(gaps.transpose(*study[source].dims).values)
            if len(places):
                first = {
                    dim: study[dim].values[index] for dim, index in zip(study[source].dims, places[0], strict=True)
                }
                words = ", ".join(range_text(str(dim), value, value) for dim, value in first.items())
                more = f" and {len(places) - 1} more" if len(places) > 1 else ""
                return f"{quantity_text(source)} at {words}{more}"
    return ""


def raw_number(claim: Mapping, data: Sequence[xr.Dataset]) -> float:
    """Return the number of a claim with places and values of extremes from the same members."""
    return NAN if any(0 in study.sizes.values() for study in data) else float(_number(claim, data, data))


def estimate(claim: Mapping, data: Sequence[xr.Dataset], on_thesis_grid: bool = False) -> Estimate:
    """Return the number that answers a claim.

    Parameters
    ----------
    claim
        Settings of the claim.
    data
        Datasets of its studies where they are selected (`select`).
    on_thesis_grid
        If True, the number is that of the thesis's own grid, and has no grid error on it.

    Returns
    -------
    The number, all NaN where the selection is empty.
    """
    if any(0 in study.sizes.values() for study in data):
        return Estimate()
    groups = _ensemble_groups(data)
    number = functools.partial(_number, claim)
    grid_error = _grid_error(number, claim, data)
    if on_thesis_grid or claim["grid"] == "thesis":
        own = all((study.points == dataset.settings_of(study)["thesis_points"]).all() for study in data)
        grid_error = 0.0 if own else NAN
    ensemble_error = _in_quadrature(
        _jackknife_error(lambda parts: _unbiased(number, claim, parts, groups), data, group) for group in groups
    )
    return Estimate(_unbiased(number, claim, data, groups), float(ensemble_error), float(grid_error))


def estimate_steps(claim: Mapping, data: Sequence[xr.Dataset]) -> tuple[Array, Array]:
    """Return the steps of an ordered quantity, positive in the claimed sense, and the error of each; flat arrays."""
    if any(0 in study.sizes.values() for study in data):
        return np.full(1, NAN), np.full(1, NAN)

    def steps(searched: Sequence[xr.Dataset], measured: Sequence[xr.Dataset]) -> Array:
        """Return all steps."""
        return ORDERS[claim["reduce"]](_values(claim, measured, claim["quantity"]), claim["along"]).values.ravel()

    errors = [_jackknife_error(lambda parts: steps(parts, parts), data, group) for group in _ensemble_groups(data)]
    return steps(data, data), _in_quadrature([*errors, _grid_error(steps, claim, data)])


def _in_quadrature(errors: Iterable[Any]) -> Any:
    """Return the root of the sum of the squares."""
    return np.sqrt(sum(np.square(error) for error in errors))


def _values(claim: Mapping, data: Sequence[xr.Dataset], name: str) -> xr.DataArray:
    """Return a quantity, or its ratio or difference in two studies, without what is absent."""
    combine = operator.sub if claim["minus"] is not None else operator.truediv
    absent = claim["absent"] is not None
    values = functools.reduce(combine, [mean_quantity(study, name, absent) for study in data])
    return _without_absent(values, data, name) if absent else values


def _without_absent(values: xr.DataArray, data: Sequence[xr.Dataset], name: str) -> xr.DataArray:
    """Return the values where all studies have such a number or should have one, along one dimension."""
    exists = functools.reduce(operator.and_, [number_exists(study, name) for study in data])
    if not values.ndim:
        return values
    exists, values = xr.broadcast(exists, values)
    return values.stack(place=values.dims).isel(place=np.flatnonzero(exists.values))


def _number(claim: Mapping, searched: Sequence[xr.Dataset], measured: Sequence[xr.Dataset]) -> float:
    """Return the quantity of a claim reduced to one number; places of extremes come from the datasets searched."""
    reduction = REDUCTIONS[claim["reduce"]]

    def arguments(data: Sequence[xr.Dataset]) -> tuple[xr.DataArray, dict[str, Any]]:
        """Return the quantity and the further inputs of the reduction."""
        inputs: dict[str, Any] = {name: claim[name] for name in reduction.inputs}
        if "against" in inputs:
            inputs["against"] = _values(claim, data, claim["against"])
        return _values(claim, data, claim["quantity"]), inputs

    values, inputs = arguments(searched)
    if not values.size:  # nothing of what is selected exists
        return NAN
    places = reduction.places(values, **inputs)
    if searched is not measured:
        values, inputs = arguments(measured)
    return reduction.measure_at(places, values, **inputs)


def _ensemble_groups(data: Sequence[xr.Dataset]) -> list[tuple[int, ...]]:
    """Return the indices of the datasets in groups whose members have the same random waves."""
    settings = [dataset.settings_of(study) for study in data]
    waves = [(own.get("same_surfaces_as") or own.get("name", index)) for index, own in enumerate(settings)]
    shared = len(set(waves)) == 1 and len({study.member.size for study in data}) == 1
    indices = range(len(data))
    return [tuple(indices)] if shared else [(index,) for index in indices]


def _unbiased(number: Number, claim: Mapping, data: Sequence[xr.Dataset], groups: Sequence[Sequence[int]]) -> float:
    """Return the number; extremes are located in one half of the members and measured in the other."""
    sizes = [data[group[0]].member.size for group in groups]
    if REDUCTIONS[claim["reduce"]].locate is None or max(sizes) == 1:
        return number(data, data)
    numbers = [
        number(_members(data, groups, searched), _members(data, groups, measured))
        for searched, measured in joint_splits(sizes)
    ]
    return math.fsum(numbers) / len(numbers)


def _members(data: Sequence[xr.Dataset], groups: Sequence[Sequence[int]], members: Sequence[Array]) -> list[xr.Dataset]:
    """Return the datasets with these members of each group."""
    parts = list(data)
    for group, chosen in zip(groups, members, strict=True):
        for index in group:
            parts[index] = parts[index].isel(member=chosen)
    return parts


def _jackknife_error(number: Callable[..., Any], data: Sequence[xr.Dataset], group: Sequence[int]) -> Any:
    """Return the standard error from leaving out each member of a group of datasets; of a mean it is the usual one.

    One member has no error if the surface is not random, else an unknown one.
    """
    count = data[group[0]].member.size
    if count == 1:
        return NAN if dataset.settings_of(data[group[0]])["surface"]["kind"] == "self_affine" else 0.0

    def without(member: int) -> list[xr.Dataset]:
        """Return all datasets, those of the group without that member."""
        return [study.drop_isel(member=member) if index in group else study for index, study in enumerate(data)]

    return np.sqrt((count - 1) * np.var([number(without(member)) for member in range(count)], axis=0))


def _grid_error(number: Number, claim: Mapping, data: Sequence[xr.Dataset]) -> Any:
    """Return the change of a number on the coarser grid, in quadrature with what the increments of paths leave open."""
    names = {name for name in (claim["quantity"], claim["against"]) if name is not None and source_quantity(name)}
    changes = {str(source_quantity(name)): str(grid_change_name(name)) for name in sorted(names)}
    if any(change not in study for study in data for change in changes.values()):
        return NAN
    coarse = [study.assign({name: study[name] - study[change] for name, change in changes.items()}) for study in data]
    fine = number(data, data)
    errors = [number(data, coarse) - fine]
    for index in range(len(data)):
        for name in changes:
            errors += [number(data, moved) - fine for moved in _moved_by_increments(data, index, name)]
    return _in_quadrature(errors)


def _moved_by_increments(data: Sequence[xr.Dataset], index: int, name: str) -> Iterator[list[xr.Dataset]]:
    """Yield the datasets with a quantity of one study moved by the increment error of one variant after another."""
    error = data[index].get(f"{name}_increment_error")
    if error is None:
        return
    error = error.max("member", skipna=False)
    for place in np.ndindex(error.shape):
        step = xr.zeros_like(error)
        step[place] = error[place]
        yield [*data[:index], data[index].assign({name: data[index][name] + step}), *data[index + 1 :]]
