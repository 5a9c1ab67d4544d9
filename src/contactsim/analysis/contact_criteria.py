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
HALF_WAY, NEARLY = 0.5, 0.95
"""Parts of the rise of the gradient between which its approach is measured."""


def rise_distance(approach: Array, ratio: Array) -> float:
    """Return the approach over which the gradient goes from half way to 95 % of its rise to that of all, nm.

    approach, ratio: (step,); the rise begins at the first state with contact. NaN if the ratio does not begin below 1,
    or does not come so near to 1.
    """
    ratio, approach = ratio[np.isfinite(ratio)], approach[np.isfinite(ratio)]
    if not ratio.size or ratio[0] >= 1:
        return np.nan
    rise = (ratio - ratio[0]) / (1 - ratio[0])
    ends = [value_at_level(rise, level, approach) for level in (HALF_WAY, NEARLY)]
    return ends[1] - ends[0]


def criterion_numbers(approach: Array, area: Array, pressure: Array, ratio: Array) -> tuple[float, ...]:
    """Return the numbers `NUMBERS` of one path by one criterion; all (step,)."""
    return (
        value_at_level(approach, APPROACH_LEVELS[0], area),
        value_at_level(area, SMALL_AREA, pressure),
        value_at_level(area, SMALL_AREA, ratio),
        rise_distance(approach, ratio),
    )


NUMBERS = ("area_at_12nm", "pressure_at_area_0_02", "gradient_ratio_at_area_0_02", "gradient_rise_distance")
"""Area, pressure over E*, ratio of gradients, and the approach (nm) over which that rises."""


def compare_criteria(data: xr.Dataset) -> pd.DataFrame:
    """Return `NUMBERS` by each criterion, one row a variant and criterion: means over members, their standard errors.

    data: of a study of rough adhesive paths that varies something. A number that some member does not have has no mean:
    a gradient that begins at that of all does not rise.
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
