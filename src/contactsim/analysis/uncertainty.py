"""The number that answers a claim, with its ensemble error and its grid error.

A claim over a second study is about the ratio of the means of the two at the loads and variants that both have; what
only one of the two varies is held against the other at each value. Ensembles of the same random waves lose a member
together in the jackknife; of independent ones it leaves out a member of one, then of the other, and the two errors add
in quadrature. Of the grid errors the worst
combination counts, as of any two quantities; where the grids of both err to the same side, that overstates the error of
the ratio. What the increments of a path leave open is counted with the grid. The grid error of a limit on finer grids
is its distance from that of first order.
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
from contactsim.analysis.ensemble import widened
from contactsim.analysis.reductions import TAKES, averaged, grid_error, needs, quantity

NAN = float("nan")
ALONG_PATHS = ("step", "snapshot", "x", "event")
"""Dimensions of which a path's numbers are free, so that two studies need not share them."""


@dataclass(frozen=True)
class Finding:
    """A number with its ensemble and grid error; NaN: unknown."""

    value: float = NAN
    ensemble_error: float = NAN
    grid_error: float = NAN


def find(claim: Mapping, data: Sequence[xr.Dataset], condition: Mapping | None = None) -> Finding:
    """The number that answers a claim, on all of its selection or on the condition.

    data: the datasets of its studies, one or, for a ratio, two.
    """
    parts = [claim] if condition is None else [claim, condition]
    for dim, (least, largest) in [ends for part in parts for ends in part["select"].items()]:
        part = {dim: slice(*widened(least, largest))}
        data = [one.sel(part) if dim in one.dims else one for one in data]
    data = xr.align(*data, join="inner", exclude={"member", *ALONG_PATHS})
    if any(0 in one.sizes.values() for one in data):
        return Finding()
    value = _number(claim, data)
    ensemble = math.hypot(*(_jackknife(claim, data, together) for together in _alike(data)))
    grid = _shifted(claim, data, value)
    if "thesis" in [part["grid"] for part in parts]:
        own = all((one.points == dataset.settings_of(one)["thesis_points"]).all() for one in data)
        grid = 0.0 if own else NAN
    return Finding(value, ensemble, grid)


def _number(claim: Mapping, data: Sequence[xr.Dataset]) -> float:
    def ask(name: str) -> xr.DataArray:
        """The quantity of that name; of two studies, the ratio."""
        return functools.reduce(operator.truediv, [quantity(one, name) for one in data])

    given = {"against": ask, "along": str, "across": str}
    take = claim["take"]
    return TAKES[take](ask(claim["of"]), **{need: given[need](claim[need]) for need in needs(take)})


def _alike(data: Sequence[xr.Dataset]) -> list[tuple[int, ...]]:
    """Places of the datasets in groups whose members are the same random waves."""
    known = [dataset.settings_of(one) for one in data]
    waves = [(one.get("surfaces_of") or one.get("name", place)) for place, one in enumerate(known)]
    shared = len(set(waves)) == 1 and len({one.member.size for one in data}) == 1
    places = range(len(data))
    return [tuple(places)] if shared else [(place,) for place in places]


def _jackknife(claim: Mapping, data: Sequence[xr.Dataset], together: Sequence[int]) -> float:
    """Standard error from leaving out each member of some of the datasets; of a mean it is the usual one.

    One member has none where the surface is not random, else an unknown one.
    """
    count = data[together[0]].member.size
    if count == 1:
        return NAN if dataset.settings_of(data[together[0]])["surface"]["kind"] == "self_affine" else 0.0

    def without(member: int) -> list[xr.Dataset]:
        """All datasets, those of the group without that member."""
        return [one.drop_isel(member=member) if place in together else one for place, one in enumerate(data)]

    parts = [_number(claim, without(member)) for member in range(count)]
    return math.sqrt((count - 1) * np.var(parts))


def _shifted(claim: Mapping, data: Sequence[xr.Dataset], value: float) -> float:
    """The largest change when each quantity of each dataset moves by its grid error, up or down; exact ones stay."""
    asked = [claim[key] for key in ("of", "against") if claim[key] is not None and averaged(claim[key])]
    errors = {averaged(name): grid_error(name) for name in sorted(asked)}
    moved = [(which, name) for which in range(len(data)) for name in sorted(errors)]
    if any(errors[name] not in data[which] for which, name in moved):
        return NAN
    changes = []
    for signs in itertools.product((-1, 1), repeat=len(moved)):
        shifted = list(data)
        for sign, (which, name) in zip(signs, moved, strict=True):
            error = abs(data[which][errors[name]]) + _of_increments(data[which], name)
            shifted[which] = shifted[which].assign({name: data[which][name] + sign * error})
        changes.append(abs(_number(claim, shifted) - value))
    return max(changes)


def _of_increments(data: xr.Dataset, name: str) -> xr.DataArray | float:
    """What the increments of a path leave open; of anything else zero."""
    error = data.get(f"{name}_increment_error")
    return 0.0 if error is None else error.max("member")
