"""The threshold law: over several approaches the force at the onset of sliding grows with the contact there (Eq. 6.9).

The straight line is fitted to all onsets, those without contact included, and to the onsets with contact alone.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np
import xarray as xr

from contactsim.grid import Array

ALONG = ("slide_approach", "slide_mean_pressure")
"""Dimensions along which Eq. 6.9 is fitted."""
MIN_ONSETS = 3
"""Smallest number of onsets to which the line is fitted."""
APPROACH_ERROR = "_approach_error"
"""End of the names of errors by leaving out one approach."""


@dataclass(frozen=True)
class ThresholdFit:
    """The line F = τl + F0 through forces F at contact lengths l; all NaN without a fit.

    Attributes
    ----------
    shear_strength
        Slope τ, GPa.
    friction_without_contact
        F0, N/m.
    threshold_residual
        Root mean square of what is left, over the range of the forces.
    threshold_curvature
        Coefficient of a square term over its standard error; NaN for fewer than four onsets.
    threshold_r_squared
        Coefficient of determination.
    """

    shear_strength: float = np.nan
    friction_without_contact: float = np.nan
    threshold_residual: float = np.nan
    threshold_curvature: float = np.nan
    threshold_r_squared: float = np.nan


FIT = ("shear_strength", "friction_without_contact", "threshold_residual", "threshold_curvature", "threshold_r_squared")
THRESHOLD = (
    *FIT,
    "shear_strength_contacts_only",
    "friction_without_contact_contacts_only",
    "threshold_residual_contacts_only",
    "threshold_curvature_contacts_only",
    "threshold_r_squared_contacts_only",
)
"""Numbers of Eq. 6.9, fitted over the approaches or loads of a study: all onsets, then those with contact."""


def fit_threshold_law(length: Array, force: Array) -> ThresholdFit:
    """Return the line through the onsets of sliding.

    Parameters
    ----------
    length, force
        Contact length (nm) and force (N/m) at the onset, (approach,).

    Returns
    -------
    The fit; all NaN if an onset is unknown, or if fewer than `MIN_ONSETS` or only equal ones are there.
    """
    if force.size < MIN_ONSETS or not np.isfinite([length, force]).all() or not (np.ptp(length) and np.ptp(force)):
        return ThresholdFit()
    slope, offset = np.polyfit(length, force, 1)
    squares = np.sum((force - slope * length - offset) ** 2)
    return ThresholdFit(
        float(slope),
        float(offset),
        float(np.sqrt(squares / force.size) / np.ptp(force)),
        _curvature(length, force),
        float(1 - squares / np.sum((force - force.mean()) ** 2)),
    )


def _curvature(length: Array, force: Array) -> float:
    """Return the coefficient of the square term of a parabola over its standard error; NaN without freedom."""
    freedom = force.size - MIN_ONSETS
    scaled = (length - length.mean()) / np.ptp(length)
    terms = np.vander(scaled, 3)
    if freedom < 1 or np.linalg.matrix_rank(terms) < 3:
        return np.nan
    coefficients = np.linalg.lstsq(terms, force, rcond=None)[0]
    variance = np.sum((force - terms @ coefficients) ** 2) / freedom
    error = np.sqrt(variance * np.linalg.inv(terms.T @ terms)[0, 0])
    return float(coefficients[0] / error) if error > 0 else np.nan


def threshold_numbers(length: Array, force: Array) -> tuple[float, ...]:
    """Return the numbers of the fits (`THRESHOLD`), then the error of each by leaving out one approach.

    Parameters
    ----------
    length, force
        Contact length (nm) and force (N/m) at the onset, (approach,).
    """
    touches = ~(length <= 0)  # an unknown length leaves the fit unknown
    parts = ((length, force), (length[touches], force[touches]))
    numbers = np.concatenate([astuple(fit_threshold_law(*part)) for part in parts])
    errors = np.concatenate([_approach_errors(*part) for part in parts])
    return (*numbers.tolist(), *errors.tolist())


def _approach_errors(length: Array, force: Array) -> Array:
    """Return the jackknife error of each number of a fit, over the approaches."""
    count = force.size
    fits = [astuple(fit_threshold_law(np.delete(length, place), np.delete(force, place))) for place in range(count)]
    return np.sqrt((count - 1) * np.var(fits, axis=0)) if fits else np.full(len(FIT), np.nan)


def fit_thresholds(data: xr.Dataset) -> xr.Dataset:
    """Return slides at several approaches or loads with the fits of Eq. 6.9 and their errors; else as they are."""
    along = next((name for name in ALONG if data.sizes.get(name, 0) >= MIN_ONSETS), None)
    if along is None:
        return data
    names = [*THRESHOLD, *(f"{name}{APPROACH_ERROR}" for name in THRESHOLD)]
    fitted = xr.apply_ufunc(
        threshold_numbers,
        data.onset_contact_length,
        data.static_friction,
        input_core_dims=[[along], [along]],
        output_core_dims=[[]] * len(names),
        vectorize=True,
    )
    return data.assign(dict(zip(names, fitted, strict=True)))
