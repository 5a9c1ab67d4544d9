"""Small made ensembles: one quantity of members of a hard-wall study, and the same for two bodies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from contactsim.status import Status

MAX_ITERATIONS = Status.MAX_ITERATIONS.value[0]


def ensemble(values: np.ndarray, bad: Sequence = ()) -> xr.Dataset:
    """A dataset of one quantity over (hurst_exponent, member, reduced_pressure), unconverged at the places in `bad`."""
    status = np.zeros(np.shape(values), np.int8)
    for place in bad:
        status[place] = MAX_ITERATIONS
    dims = ("hurst_exponent", "member", "reduced_pressure")
    coordinates = dict(zip(dims, (np.arange(n) / 10 for n in np.shape(values)), strict=True))
    return xr.Dataset({"kappa": (dims, values), "status": (dims, status)}, coordinates)


def bodies(values: np.ndarray, bad: Sequence = ()) -> xr.Dataset:
    """The same with Poisson's ratios in place of Hurst exponents."""
    return ensemble(values, bad).rename(hurst_exponent="poisson_ratio")
