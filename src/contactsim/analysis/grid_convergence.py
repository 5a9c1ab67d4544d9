"""Limits of quantities on fine grids: Richardson's extrapolation from three grids, each twice as fine as the last.

A quantity f + c hᵖ changes by c hᵖ(4ᵖ − 2ᵖ) and c hᵖ(2ᵖ − 1) between spacings 4h, 2h and h: the ratio of the changes
gives the order p that is observed, and the last change over 2ᵖ − 1 is the distance to the limit f (Roache, J. Fluids
Eng. 116, 405 (1994), doi:10.1115/1.2910291). Changes that turn round or do not shrink have no limit: NaN.

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
"""Number of grids of an extrapolation."""


def is_doubled(points: xr.DataArray) -> bool:
    """Return True for three grids, each with twice the points of the one before."""
    counts = np.asarray(points, float)
    return counts.size == GRIDS and np.array_equal(counts, counts[0] * 2.0 ** np.arange(GRIDS))


def extrapolate(values: xr.DataArray) -> xr.Dataset:
    """Return the limit of values on fine grids.

    Parameters
    ----------
    values : DataArray
        Values along `points`: three grids, the coarsest first, each with twice the points of the one before.

    Returns
    -------
    Dataset
        `limit`, in the unit of the values; `order`, as observed; `spread`, the limit less that of first order. NaN
        where the changes turn round or do not shrink. Values that no longer change are their own limit.

    Raises
    ------
    InputError
        For other grids.

    References
    ----------
    Roache, J. Fluids Eng. 116, 405 (1994), doi:10.1115/1.2910291.
    """
    if not is_doubled(values.points):
        raise InputError("points", values.points.values.tolist(), f"{GRIDS} grids, each twice as fine as the last")
    coarse, medium, fine = (values.isel(points=place, drop=True) for place in range(GRIDS))
    before, last = medium - coarse, fine - medium
    shrinks = (before * last >= 0) & (abs(before) > abs(last))
    ratio = (before / last).where(shrinks & (last != 0))
    remainder = xr.where(last == 0, 0.0, last / (ratio - 1))
    return xr.Dataset({"limit": fine + remainder, "order": np.log2(ratio), "spread": remainder - last})


def jackknife(measure: Callable[..., xr.Dataset], *ensembles: xr.DataArray) -> xr.Dataset:
    """Return a measure of the means of independent ensembles, with standard errors by the jackknife.

    Parameters
    ----------
    measure : callable
        Function of one array for each ensemble, without `member`; returns variables NAME.
    *ensembles : DataArray
        Values along `member`.

    Returns
    -------
    Dataset
        NAME and NAME_standard_error, from leaving out each member of each ensemble. The error is NaN where an ensemble
        has one member. All is NaN where the measure is NaN without some member.
    """
    means = [values.mean("member") for values in ensembles]
    result = measure(*means)
    square: xr.Dataset | float = 0.0
    certain: xr.Dataset | bool = True
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
    result = result.where(certain)
    errors = (result * 0 + np.sqrt(square)).rename({name: f"{name}_standard_error" for name in result})
    return result.merge(errors)
