"""Numbers of rough adhesive contact by each criterion of contact: what depends on the threshold, and what does not."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.analysis.ensemble import converged
from contactsim.grid import Array
from contactsim.observables.adhesion import GRADIENTS
from contactsim.observables.linearity import APPROACH_LEVELS, AREA_LEVELS, value_at_level

CRITERIA = {"rms_gradient_repulsive": "contact_length", **GRADIENTS}
"""Length of contact by each criterion, by the gradient over it."""
SMALL_AREA = AREA_LEVELS["pressure_at_area_0_02"]
"""Relative area at which pressure and gradient are read."""


def criterion_numbers(approach: Array, area: Array, pressure: Array, ratio: Array) -> tuple[float, ...]:
    """Return the numbers `NUMBERS` of one path by one criterion; all (step,)."""
    return (
        value_at_level(approach, APPROACH_LEVELS[0], area),
        value_at_level(area, SMALL_AREA, pressure),
        value_at_level(area, SMALL_AREA, ratio),
    )


NUMBERS = ("area_at_12nm", "pressure_at_area_0_02", "gradient_ratio_at_area_0_02")
"""Area, pressure over E*, and ratio of gradients."""


def compare_criteria(data: xr.Dataset) -> pd.DataFrame:
    """Return `NUMBERS` by each criterion, one row a variant and criterion: means over members, their standard errors.

    data: of a study of rough adhesive paths that varies something. A number that some member does not have has no mean.
    """
    tables = []
    for gradient, length in CRITERIA.items():
        columns = xr.apply_ufunc(
            criterion_numbers,
            data.approach - data.approach_first_touch,
            converged(data[length], data) / data.length,
            converged(data.normalised_pressure, data),
            converged(data[gradient] / data.rms_gradient, data),
            input_core_dims=[["step"]] * 4,
            output_core_dims=[[]] * len(NUMBERS),
            vectorize=True,
        )
        table = {}
        for name, values in zip(NUMBERS, columns, strict=True):
            table[name] = values.mean("member", skipna=False)
            table[f"{name}_error"] = values.std("member", ddof=1, skipna=False) / np.sqrt(data.member.size)
        tables.append(xr.Dataset(table).to_dataframe().reset_index().assign(criterion=length))
    return pd.concat(tables, ignore_index=True)
