"""Ratios of means of two independent ensembles: factors of proportionality of lines over those of surfaces."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.analysis.ensemble import ratio_of_means
from contactsim.analysis.mean_errors import second_mean


def ratio_curves(above: xr.Dataset, below: xr.Dataset, name: str) -> pd.DataFrame:
    """Return the ratio of a quantity's means at the loads that both ensembles have, one row each.

    Parameters
    ----------
    above, below : datasets of studies with a coarser grid
    name : of an averaged quantity

    Returns
    -------
    table : quantity, hurst_exponent, reduced_pressure, value and error, that of ensemble and grid in quadrature. Both
        grids are halved together, as errors of one sign cancel in a ratio.
    """
    above, below = xr.align(above, below, join="inner", exclude=("member",))
    ratio = ratio_of_means(above, below, name)
    mean, change = f"{name}_mean", f"{name}_grid_change"
    coarse = (above[mean] - above[change]) / (below[mean] - below[change])
    grid_error = abs(coarse - ratio.value)
    numerator, denominator = (second_mean(data, name) for data in (above, below))
    if numerator is not None and denominator is not None:
        grid_error = np.maximum(grid_error, abs(numerator / denominator - ratio.value))
    error = np.hypot(ratio.error.fillna(0.0), grid_error)
    table = xr.Dataset({"value": ratio.value, "error": error}).to_dataframe().reset_index()
    return table[["hurst_exponent", "reduced_pressure", "value", "error"]].assign(quantity=name)
