"""Members of an ensemble that were solved on a coarser grid only, carried to the grid of a few of them.

The mean over N members on a coarse grid, plus the mean change to a fine grid over n of them, is the mean of N members
on the fine grid, at the cost of a coarse one (Giles, Acta Numerica 24, 259, 2015). Here it is written as N replicas: of
a member on both grids its coarse number plus N/n times its change beyond the mean change, of any other its coarse
number, each plus the mean change. Their mean is that mean. Leaving one out after another gives its error, with that of
the change. A replica is not the number of its member.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import xarray as xr

from contactsim.analysis.ensemble import converged, waves_name
from contactsim.analysis.uncertainty import student_factor
from contactsim.observables.dataset_forms import AVERAGED
from contactsim.status import is_solved

SURFACE_NUMBERS = ("rms_gradient",)
"""Numbers of the surface of each member that quantities are computed with."""
SOLVED_MEMBERS = "members_on_this_grid"
"""Attribute of a dataset with replicas: how many members were solved on its grid."""


def with_more_members(fine: xr.Dataset, others: Sequence[xr.Dataset]) -> xr.Dataset:
    """Return a dataset with replicas of the members that other studies of the same surfaces have.

    Parameters
    ----------
    fine
        Dataset on the finest grid.
    others
        Datasets on coarser and coarser grids, each of more members than the one before. Those of other surfaces and of
        no more members are left out.
    """
    grids = [fine]
    for other in others:
        if waves_name(other) == waves_name(fine) and other.member.size > grids[-1].member.size:
            grids.append(other)
    if len(grids) == 1:
        return fine
    grids = list(xr.align(*grids, join="inner", exclude={"member"}))
    result = grids[-1]
    for finer, coarser in reversed(list(itertools.pairwise(grids))):
        result = _carry_members(result, coarser, finer)
    return result.assign_attrs({SOLVED_MEMBERS: fine.member.size})


def _carry_members(replicas: xr.Dataset, coarse: xr.Dataset, fine: xr.Dataset) -> xr.Dataset:
    """Return replicas on a coarse grid carried to a finer one, by the changes of the members that were solved on it."""
    few, many = fine.member, replicas.member
    weight = student_factor(few.size) * many.size / few.size
    carried = {"status": _joined_status(fine.status, replicas.status)}
    for name in (*AVERAGED, *SURFACE_NUMBERS):
        if name in fine and name in replicas:
            change = _known(fine, name) - _known(coarse, name).sel(member=few)
            mean = change.mean("member", skipna=False)
            beyond = (weight * (change - mean)).reindex(member=many, fill_value=0.0)
            carried[name] = (_known(replicas, name) + mean + beyond).transpose(*fine[name].dims)
    without_members = [name for name in fine.data_vars if "member" not in fine[name].dims]
    return fine[without_members].assign(carried)


def _known(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return a number of each member, NaN where a state was not solved."""
    return data[name] if name in SURFACE_NUMBERS else converged(data[name], data)


def _joined_status(fine: xr.DataArray, coarse: xr.DataArray) -> xr.DataArray:
    """Return the status of a state on the coarse grid, and that on the fine one where it was not solved there."""
    own = fine.reindex_like(coarse)
    return xr.where(own.notnull() & ~is_solved(own), own, coarse)
