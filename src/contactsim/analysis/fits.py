"""Fits of Eq. 3.11 to the contact area of rough lines, with confidence intervals of the parameters."""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.analysis.ensemble import converged
from contactsim.grid import Array
from contactsim.reference import hard_wall

WEIGHTINGS = ("area", "logarithm")
PARAMETERS = {"": ("fit_b1", "fit_b2"), "_corrected": ("fit_b1_corrected", "fit_b2_corrected")}
"""Parameters of Eq. 3.11 by the end of the name of the area that they are fitted to."""


def fit_line_areas(data: xr.Dataset, limits: list[float], estimator: str = "") -> xr.Dataset:
    """Return the parameters of Eq. 3.11 for each Hurst exponent and for all together.

    Parameters
    ----------
    data : Dataset
        Relative contact area along `hurst_exponent`, `member` and `reduced_pressure`.
    limits : list of float
        Largest reduced pressures to fit.
    estimator : str
        End of the area's name, one of `PARAMETERS`: none for counted points, "_corrected".

    Returns
    -------
    Dataset
        b1 and b2, and half-widths of their 95 % confidence intervals by the jackknife over members; dims (fitted,
        weighting, fit_limit).

    References
    ----------
    Eq. 3.11 of the thesis.
    """
    areas = converged(data[f"relative_contact_area{estimator}"], data)
    area = areas.transpose("hurst_exponent", "member", "reduced_pressure").values
    pressure = data.reduced_pressure.values
    sets = [[row] for row in range(data.hurst_exponent.size)] + [list(range(data.hurst_exponent.size))]
    names = [f"{value:g}" for value in data.hurst_exponent.values] + ["all"]
    values = np.full((4, len(sets), len(WEIGHTINGS), len(limits)), np.nan)
    for s, rows in enumerate(sets):
        for w, weighting in enumerate(WEIGHTINGS):
            for k, limit in enumerate(limits):
                below = pressure <= limit * (1 + 1e-9)
                part = area[rows][:, :, below]
                best = fit_line_area(pressure[below], part, weighting)
                values[:2, s, w, k] = best
                values[2:, s, w, k] = _jackknife(pressure[below], part, weighting)
    dims = ("fitted", "weighting", "fit_limit")
    kinds = [f"{name}{kind}" for kind in ("", "_half_width") for name in PARAMETERS[estimator]]
    variables = {name: (dims, block) for name, block in zip(kinds, values, strict=True)}
    return xr.Dataset(variables, {"fitted": names, "weighting": list(WEIGHTINGS), "fit_limit": limits})


def fit_line_area(pressure: Array, area: Array, weighting: str) -> tuple[float, float]:
    """Return b1 and b2 of Eq. 3.11 by least squares.

    Parameters
    ----------
    pressure : array (k,)
        Reduced pressure.
    area : array (..., k)
        Relative contact area; NaN is left out.
    weighting : str
        "area" for differences of the area, where the largest loads decide; "logarithm" for those of its logarithm.
    """
    from scipy.optimize import least_squares  # takes longer to import than to fit

    usable = np.isfinite(area) & (area > 0)
    if not usable.any():
        return float("nan"), float("nan")

    def misfit(logarithms: Array) -> Array:
        """Return the misfit of the model with the parameters of these logarithms."""
        model = np.broadcast_to(hard_wall.line_area(pressure, *np.exp(logarithms)), area.shape)[usable]
        return model - area[usable] if weighting == "area" else np.log(model) - np.log(area[usable])

    fit = least_squares(misfit, np.log([0.7, 1.0]), bounds=(np.log([1e-2, 1e-4]), np.log([1e1, 1e4])), x_scale="jac")
    return tuple(np.exp(fit.x))


def _jackknife(pressure: Array, area: Array, weighting: str) -> Array:
    """Return the half-widths of the 95 % confidence intervals of b1 and b2; NaN below three members."""
    from scipy.special import stdtrit

    members = area.shape[1]
    if members < 3:
        return np.full(2, np.nan)
    parts = [fit_line_area(pressure, np.delete(area, member, axis=1), weighting) for member in range(members)]
    error = np.sqrt((members - 1) / members * np.sum((parts - np.mean(parts, axis=0)) ** 2, axis=0))
    return error * stdtrit(members - 1, 0.975)
