"""The comparison of a claim: a quantity of one study, or its ratio, difference or departure in two, as one number.

Two studies are compared at the loads and variants that both have. A key that only one of them varies is compared at
each of its values.
"""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from contactsim.analysis.cross_validation import FEW_SPLITS, MAX_SPLITS, joint_splits
from contactsim.analysis.ensemble import waves_name, widen_interval
from contactsim.analysis.measures import SPLIT, Places, departure_of_curves
from contactsim.analysis.quantities import is_function_of_means, mean_quantity, number_exists, with_quantities
from contactsim.analysis.reductions import ORDERS, REDUCTIONS
from contactsim.grid import Array

Datasets = Sequence[xr.Dataset]
Halves = Sequence[Sequence[Array]]
"""Of each split of ensembles, the places of the members of each that are in a half."""
Arguments = tuple[xr.DataArray, dict[str, Any]]
"""A quantity, and the further inputs of its reduction."""


class StudyComparison(NamedTuple):
    """What is done with a second study.

    word: for it, between the names of both studies; operation: on the values of both; no_change: where both agree
    """

    word: str
    operation: Callable[[Any, Any], Any]
    no_change: float


SECOND_STUDY = {
    "relative_to": StudyComparison("over", operator.truediv, 1.0),
    "minus": StudyComparison("minus", operator.sub, 0.0),
    "departs_from": StudyComparison("beside", departure_of_curves, 0.0),
}
"""Keys of a claim that name a second study, and what is done with it."""
MAX_BLOCKS = 20
"""Largest number of blocks into which an ensemble is divided to leave out one after the other."""
PATH_DIMENSIONS = ("step", "snapshot", "x", "fold", "event")
"""Dimensions along a path: two studies need not share them, as summaries of paths do not have them."""


def studies_of(claim: Mapping) -> list[str]:
    """Return the names of the studies that a claim compares: none, one or two."""
    return [claim[key] for key in ("study", *SECOND_STUDY) if claim[key] is not None]


class Comparison:
    """A claim's quantity in the datasets of its studies.

    Parameters
    ----------
    claim
        Settings of the claim.
    data
        Datasets of its studies: one, or two.
    """

    def __init__(self, claim: Mapping, data: Datasets) -> None:
        self.claim = claim
        self._names = [name for name in (claim["quantity"], claim["against"]) if name is not None]
        data = [with_quantities(study, self._names) for study in data]
        self.data = list(xr.align(*data, join="inner", exclude={"member", *PATH_DIMENSIONS}))
        self.is_empty = any(0 in study.sizes.values() for study in self.data)
        self.groups = _groups_of_members(self.data)

    def select(self, selection: Mapping[str, Sequence[float]]) -> Comparison:
        """Return the comparison at selected loads and variants: the least and largest value of dimensions."""
        data = self.data
        for dim, ends in selection.items():
            within = {dim: slice(*widen_interval(*ends))}
            data = [study.sel(within) if dim in study.dims else study for study in data]
        return Comparison(self.claim, data)

    def number(self, data: Datasets, searched: Datasets | None = None) -> float:
        """Return the quantity in some datasets reduced to one number.

        Parameters
        ----------
        data
            The datasets of the comparison, or such as have other members or values.
        searched
            Datasets in which extremes are located; None for the same.
        """
        arguments = self._arguments(data)
        return self._reduce(arguments, arguments if searched is None else self._arguments(searched))

    def _reduce(self, arguments: Arguments, searched: Arguments) -> Any:
        """Return the number, or that of each half, with extremes at their places in `searched`; NaN without values."""
        reduction = REDUCTIONS[self.claim["reduce"]]
        values, inputs = arguments
        if not values.size:
            return float("nan")
        where, where_inputs = searched
        return reduction.measure_at(reduction.places(where, **where_inputs), values, **inputs)

    def unbiased_number(self, data: Datasets) -> float:
        """Return the number, with extremes located in one half of the members and measured in the other, in both roles.

        It is unknown where that of all members is, as an unknown value may hide in the half that is searched.
        """
        ensembles, whole = [self._members_left(data, group[0]) for group in self.groups], self.number(data)
        is_single = all(len(left) == 1 for _, left in ensembles)
        if REDUCTIONS[self.claim["reduce"]].locate is None or is_single or math.isnan(whole):
            return whole
        is_fast = all(map(self._is_of_means, self._names))
        splits = joint_splits(ensembles, MAX_SPLITS if is_fast else FEW_SPLITS)
        first, second = (self._arguments(data, halves) for halves in zip(*splits, strict=True))
        return float(np.mean([self._reduce(second, first), self._reduce(first, second)]))

    def extreme(self) -> tuple[xr.DataArray, Places] | None:
        """Return the values of which the number is an extreme, and its place; None for a number of another kind."""
        reduction = REDUCTIONS.get(self.claim["reduce"])
        if reduction is None or reduction.values_of is None:
            return None
        values, inputs = self._arguments(self.data)
        return reduction.values_of(values, **inputs), reduction.places(values, **inputs)

    def steps(self, data: Datasets) -> Array:
        """Return the steps of an ordered quantity, positive in the claimed sense, flat."""
        return self._steps(data).values.ravel()

    def end_to_end(self, data: Datasets) -> Array:
        """Return the changes of an ordered quantity from the first to the last value, flat."""
        return self._steps(data).sum(self.claim["along"], skipna=False).values.ravel()

    def _steps(self, data: Datasets) -> xr.DataArray:
        """Return the steps of an ordered quantity, positive in the claimed sense."""
        return ORDERS[self.claim["reduce"]](self._values(data, self.claim["quantity"]), self.claim["along"])

    def varied_dimensions(self) -> dict[str, Array]:
        """Return the loads and variants that the quantity depends on, by dimension."""
        values = self._combine([mean_quantity(study, self.claim["quantity"]) for study in self.data])
        return {str(dim): values[dim].values for dim in values.dims if values.sizes[dim] > 1}

    def _arguments(self, data: Datasets, halves: Halves | None = None) -> Arguments:
        """Return the quantity and the further inputs of the reduction, of all members or of many halves of them."""
        inputs: dict[str, Any] = {name: self.claim[name] for name in REDUCTIONS[self.claim["reduce"]].inputs}
        if "against" in inputs:
            is_first = REDUCTIONS[self.claim["reduce"]].against_first
            inputs["against"] = self._values(data[:1] if is_first else data, self.claim["against"], halves)
        return self._values(data, self.claim["quantity"], halves), inputs

    def _values(self, data: Datasets, name: str, halves: Halves | None = None) -> xr.DataArray:
        """Return a quantity, or what it is in one study beside another, without what is absent.

        halves: of each split, the members of each group that are in a half, for values along `SPLIT`
        """
        if halves is not None and self._is_of_means(name):
            return self._values(self._half_means(data, halves), name)
        if halves is not None:
            return xr.concat([self._values(self._with_members(data, half), name) for half in halves], SPLIT)
        leave_out = self.claim["absent"] is not None
        values = self._combine([mean_quantity(study, name, leave_out) for study in data])
        if not leave_out or not values.ndim:
            return values
        exists, values = xr.broadcast(self._exists, values)
        return values.stack(place=values.dims).isel(place=np.flatnonzero(exists.values))

    def _is_of_means(self, name: str) -> bool:
        """Return True for a quantity that follows from means over all members."""
        return self.claim["absent"] is None and is_function_of_means(name)

    @functools.cached_property
    def _exists(self) -> xr.DataArray:
        """True where the quantity exists in all studies, or should exist."""
        return functools.reduce(operator.and_, [number_exists(study, self.claim["quantity"]) for study in self.data])

    def _combine(self, values: Sequence[xr.DataArray]) -> xr.DataArray:
        """Return the values of one study, or those of two combined."""
        operations = [second.operation for key, second in SECOND_STUDY.items() if self.claim[key] is not None]
        return operations[0](*values) if len(values) > 1 else values[0]

    def _members_left(self, data: Datasets, index: int) -> tuple[int, Array]:
        """Return the number of members of a study, and which of them are in one of some datasets."""
        members = self.data[index].member.values
        return len(members), np.flatnonzero(np.isin(members, data[index].member.values))

    def _half_means(self, data: Datasets, halves: Halves) -> list[xr.Dataset]:
        """Return the means of many halves of the members, along `SPLIT`."""
        parts = list(data)
        for place, group in enumerate(self.groups):
            weights = np.zeros((len(halves), data[group[0]].member.size))
            for split, half in enumerate(halves):
                weights[split, half[place]] = 1 / len(half[place])
            for index in group:
                parts[index] = _weighted_means(data[index], weights)
        return parts

    def _with_members(self, data: Datasets, members: Sequence[Array]) -> list[xr.Dataset]:
        """Return the datasets with these members of each group."""
        parts = list(data)
        for group, indices in zip(self.groups, members, strict=True):
            for index in group:
                parts[index] = parts[index].isel(member=indices)
        return parts


def _weighted_means(data: xr.Dataset, weights: Array) -> xr.Dataset:
    """Return the numbers of a dataset as weighted sums over its members, one for each row of weights."""
    numbers = {}
    for name, part in data.variables.items():
        if "member" in part.dims and part.dtype.kind == "f":
            part = part.transpose("member", ...)
            numbers[name] = xr.Variable((SPLIT, *part.dims[1:]), np.tensordot(weights, part.values, 1))
    return data.assign(numbers)


def _groups_of_members(data: Datasets) -> list[tuple[int, ...]]:
    """Return the indices of the datasets in groups whose members have the same random waves."""
    waves = [waves_name(study) or index for index, study in enumerate(data)]
    shared = len(set(waves)) == 1 and len({study.member.size for study in data}) == 1
    indices = range(len(data))
    return [tuple(indices)] if shared else [(index,) for index in indices]


def members_left_out(data: Datasets, group: Sequence[int]) -> Iterator[list[xr.Dataset]]:
    """Yield the datasets without one member of a group after another, or without one block of a large ensemble."""
    count = data[group[0]].member.size
    blocks = min(count, MAX_BLOCKS)
    for block in (np.arange(first, count, blocks) for first in range(blocks)):
        yield [study.drop_isel(member=block) if index in group else study for index, study in enumerate(data)]
