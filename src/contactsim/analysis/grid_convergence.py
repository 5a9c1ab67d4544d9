"""What a quantity tends to as the grid is refined: Richardson's extrapolation from three grids, each twice as fine.

A quantity f + c hᵖ changes by c hᵖ(4ᵖ − 2ᵖ) and c hᵖ(2ᵖ − 1) between spacings 4h, 2h and h: the ratio of the changes
gives the order p that is observed, and the last change over 2ᵖ − 1 is what is left to the limit f (Roache, J. Fluids
Eng. 116, 405 (1994), doi:10.1115/1.2910291). Changes that turn round or do not shrink have no limit to show: NaN.

Three grids cannot show that one power rules. An area of contact counted in points errs along the rim of the patches,
which is of first order once the patches are resolved (Yastrebov, Anciaux, Molinari, Tribol. Int. 114, 161 (2017),
doi:10.1016/j.triboint.2017.04.023), so another order observed may still change: the spread of the limit is its
distance from that of first order. It is no bound; the standard error over members comes on top.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr

from contactsim.errors import InputError

GRIDS = 3
"""Grids that an extrapolation takes."""


def is_doubled(points: xr.DataArray) -> bool:
    """Whether there are three grids, each with twice the points of the one before."""
    counts = np.asarray(points, float)
    return counts.size == GRIDS and np.array_equal(counts, counts[0] * 2.0 ** np.arange(GRIDS))


def extrapolated(values: xr.DataArray) -> xr.Dataset:
    """Limit of values along `points`, of which there are three, each twice the one before, the coarsest first.

    `limit`, in the unit of the values; `order` observed; `spread`: the limit less that of first order. NaN where the
    changes turn round or do not shrink; values that no longer change are their own limit.
    """
    if not is_doubled(values.points):
        raise InputError("points", values.points.values.tolist(), f"{GRIDS} grids, each twice as fine as the last")
    coarse, medium, fine = (values.isel(points=place, drop=True) for place in range(GRIDS))
    before, last = medium - coarse, fine - medium
    shrinks = (before * last >= 0) & (abs(before) > abs(last))
    ratio = (before / last).where(shrinks & (last != 0))
    left = xr.where(last == 0, 0.0, last / (ratio - 1))
    return xr.Dataset({"limit": fine + left, "order": np.log2(ratio), "spread": left - last})


def jackknifed(measure: Callable[..., xr.Dataset], *ensembles: xr.DataArray) -> xr.Dataset:
    """What a measure finds from the means over `member` of independent ensembles, with standard errors.

    measure: from one array for each ensemble, without `member`, to variables NAME. Adds NAME_standard_error, from
    leaving out each member of each ensemble; NaN where an ensemble has one member. Where a member left out leaves
    nothing to find, nothing is certain, and all is NaN.
    """
    means = [values.mean("member") for values in ensembles]
    found = measure(*means)
    square, certain = 0.0, True
    for place, values in enumerate(ensembles):
        count = values.member.size
        if count == 1:
            square = np.nan
            continue
        parts = xr.concat(
            [
                measure(*means[:place], values.drop_isel(member=member).mean("member"), *means[place + 1 :])
                for member in range(count)
            ],
            "member",
        )
        square = square + (count - 1) * parts.var("member", skipna=False)
        certain = certain & parts.notnull().all("member")
    found = found.where(certain)
    errors = (found * 0 + np.sqrt(square)).rename({name: f"{name}_standard_error" for name in found})
    return found.merge(errors)
