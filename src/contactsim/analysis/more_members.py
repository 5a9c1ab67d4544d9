"""Means over members that were solved on a coarse grid only, transferred to the fine grid of a few of them.

The mean over N members on the coarse grid, plus the mean change to the fine grid over n of them, is the mean of N
members on the fine grid (Giles, Acta Numerica 24, 259, 2015). It is written as one *transferred number* for each of the
N members. A member on the coarse grid only has its number there plus the mean change. A member on both grids has this
plus √(N (N - 1) / n (n - 1)) times what its own change differs from the mean change. So the mean of all transferred
numbers is the mean above, and their standard error has both parts: the scatter of N members, and that of n changes.
Errors are widened, because n is small. A transferred number is not the number of its member.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.analysis.comparison import studies_of
from contactsim.analysis.ensemble import WIDENING, converged, waves_name
from contactsim.analysis.uncertainty import student_factor
from contactsim.observables.dataset_forms import AVERAGED
from contactsim.status import is_solved

SURFACE_NUMBERS = ("rms_gradient",)
"""Numbers of the surface of each member that quantities are computed with."""
OF_MEANS = ("_mean", "_standard_error")
"""Ends of the names of means over the members of a study, which are not those of the transferred numbers."""
TRANSFERRED_FROM = "transferred_from"
"""Attribute of transferred numbers: name, members and points of each study that they come from, the finest first."""


class Studies:
    """Datasets of studies by name, and those with the members of others, which are made once."""

    def __init__(self, data: Mapping[str, xr.Dataset]) -> None:
        self._data = data
        self._with_more: dict[tuple[str, ...], xr.Dataset] = {}

    def of(self, claim: Mapping) -> list[xr.Dataset]:
        """Return the datasets of the studies of a claim, with the members that it takes from others."""
        return [self._get(name, *(claim["more_members"] or ())) for name in studies_of(claim)]

    def _get(self, *names: str) -> xr.Dataset:
        """Return the dataset of the first study, with the members of the others."""
        if names not in self._with_more:
            first, *others = (self._data[name] for name in names)
            self._with_more[names] = with_more_members(first, others)
        return self._with_more[names]


def with_more_members(fine: xr.Dataset, others: Sequence[xr.Dataset]) -> xr.Dataset:
    """Return a dataset with the transferred numbers of the members that other studies of the same surfaces have.

    Parameters
    ----------
    fine
        Dataset on the finest grid, of two members or more.
    others
        Datasets on coarser and coarser grids, each of more members than the one before. Those of other surfaces are
        left out.

    Returns
    -------
    data : at the loads and variants that all have; errors of NAME are computed with `NAME_widening` added to it
    """
    grids = [fine, *(other for other in others if waves_name(other) == waves_name(fine))]
    if len(grids) == 1:
        return fine
    grids = list(xr.align(*grids, join="inner", exclude={"member"}))
    names = [name for name in (*AVERAGED, *SURFACE_NUMBERS) if all(name in grid for grid in grids)]
    dims, status = fine.status.dims, grids[-1].status
    numbers = {name: _known(grids[-1], name) for name in names}
    widening = {name: xr.zeros_like(values) for name, values in numbers.items()}
    for finer, coarser in reversed(list(itertools.pairwise(grids))):
        status = _joined_status(finer.status, status)
        for name in names:
            mean, beyond = _change(finer, coarser, name, status.member)
            numbers[name] = numbers[name] + mean + beyond
            widening[name] = widening[name] + (student_factor(finer.member.size) - 1) * beyond
    transferred = {"status": status, **numbers, **{f"{name}{WIDENING}": part for name, part in widening.items()}}
    stale = {f"{name}{end}" for name in names for end in OF_MEANS}
    kept = [name for name in fine.data_vars if "member" not in fine[name].dims and name not in stale]
    origins = [(dataset.settings_of(grid)["name"], grid.member.size, int(grid.points)) for grid in grids]
    variables = {key: part.transpose(*(dim for dim in dims if dim in part.dims)) for key, part in transferred.items()}
    return grids[0][kept].assign(variables).assign_attrs({TRANSFERRED_FROM: origins})


def _change(
    fine: xr.Dataset, coarse: xr.Dataset, name: str, members: xr.DataArray
) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the mean change of a number to the finer grid, and the weighted rest of it for each of all members."""
    change = _known(fine, name) - _known(coarse, name).sel(member=fine.member)
    mean = change.mean("member", skipna=False)
    few, many = fine.member.size, members.size
    weight = np.sqrt(many * (many - 1) / (few * (few - 1)))
    return mean, (weight * (change - mean)).reindex(member=members, fill_value=0.0)


def _known(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return a number of each member, NaN where a state was not solved."""
    return data[name] if name in SURFACE_NUMBERS else converged(data[name], data)


def _joined_status(fine: xr.DataArray, coarse: xr.DataArray) -> xr.DataArray:
    """Return the status of a state on the coarse grid, and that on the fine one where it was not solved there."""
    own = fine.reindex_like(coarse)
    return xr.where(own.notnull() & ~is_solved(own), own, coarse)
