"""Eq. 3.11 fitted to the area of rough lines, and how well its parameters are determined."""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim import reference
from contactsim.analysis.ensemble import converged
from contactsim.grid import Array

WEIGHTINGS = ("area", "logarithm")


def fits(data: xr.Dataset, limits: list[float]) -> xr.Dataset:
    """Eq. 3.11 fitted to each Hurst exponent and to all, two weightings, each up to each limit of p*.

    Returns b1 and b2 with half-widths of their 95 % confidence intervals by the jackknife over members: dims
    (fitted, weighting, fit_limit).
    """
    area = converged(data.relative_contact_area, data).transpose("hurst_exponent", "member", "reduced_pressure").values
    pressure = data.reduced_pressure.values
    sets = [[row] for row in range(data.hurst_exponent.size)] + [list(range(data.hurst_exponent.size))]
    names = [f"{value:g}" for value in data.hurst_exponent.values] + ["all"]
    values = np.full((4, len(sets), len(WEIGHTINGS), len(limits)), np.nan)
    for s, rows in enumerate(sets):
        for w, weighting in enumerate(WEIGHTINGS):
            for k, limit in enumerate(limits):
                below = pressure <= limit * (1 + 1e-9)
                chosen = area[rows][:, :, below]
                best = fit_line_area(pressure[below], chosen, weighting)
                values[:2, s, w, k] = best
                values[2:, s, w, k] = _jackknife(pressure[below], chosen, weighting)
    dims = ("fitted", "weighting", "fit_limit")
    kinds = ("fit_b1", "fit_b2", "fit_b1_half_width", "fit_b2_half_width")
    variables = {name: (dims, block) for name, block in zip(kinds, values, strict=True)}
    return xr.Dataset(variables, {"fitted": names, "weighting": list(WEIGHTINGS), "fit_limit": limits})


def fit_line_area(pressure: Array, area: Array, weighting: str) -> tuple[float, float]:
    """b1 and b2 of Eq. 3.11 by least squares; pressure (k,), area (..., k), NaN left out.

    weighting: "area" weighs the area itself, so the largest loads decide; "logarithm" weighs all alike.
    """
    from scipy.optimize import least_squares  # takes longer to import than to fit

    known = np.isfinite(area) & (area > 0)
    if not known.any():
        return float("nan"), float("nan")

    def misfit(logarithms: Array) -> Array:
        """Of the model with the parameters of these logarithms, by the weighting."""
        model = np.broadcast_to(reference.line_area(pressure, *np.exp(logarithms)), area.shape)[known]
        return model - area[known] if weighting == "area" else np.log(model) - np.log(area[known])

    found = least_squares(misfit, np.log([0.7, 1.0]), bounds=(np.log([1e-2, 1e-4]), np.log([1e1, 1e4])), x_scale="jac")
    return tuple(np.exp(found.x))


def _jackknife(pressure: Array, area: Array, weighting: str) -> Array:
    from scipy.special import stdtrit

    members = area.shape[1]
    if members < 3:
        return np.full(2, np.nan)
    parts = [fit_line_area(pressure, np.delete(area, member, axis=1), weighting) for member in range(members)]
    error = np.sqrt((members - 1) / members * np.sum((parts - np.mean(parts, axis=0)) ** 2, axis=0))
    return error * stdtrit(members - 1, 0.975)
