"""Laws of peeling, and the names of the numbers that summarise a slide.

Up to the onset of sliding the contact peels, and its length falls with the square of the force (Eq. 6.8). Over several
approaches the force at the onset grows with the contact length there (Eq. 6.9).
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array

ONSET = (
    "static_friction",
    "mean_friction",
    "average_friction",
    "onset_sliding_distance",
    "onset_contact_length",
    "initial_contact_length",
    "initial_load",
    "peeled_fraction",
    "reattached_fraction",
    "regained_fraction",
    "peel_asymmetry_halfway",
    "peel_asymmetry",
    "quadratic_coefficient",
    "quadratic_r_squared",
    "slip_count",
    "first_force_drop",
    "first_slip_periods",
    "first_slip_released_energy",
    "loop_energy",
)
"""Numbers that summarise a slide."""
ERRORS = (
    "static_friction",
    "mean_friction",
    "average_friction",
    "onset_sliding_distance",
    "first_force_drop",
    "loop_energy",
)
"""Numbers of a slide whose increment error is known."""
THRESHOLD = ("shear_strength", "friction_without_contact", "threshold_r_squared")
"""Numbers of Eq. 6.9, fitted over the approaches of a study."""
ALONG = "slide_approach"
"""The dimension along which Eq. 6.9 is fitted."""


def fit_quadratic_law(force: Array, length: Array) -> tuple[float, float]:
    """Return ζ and R² of the quadratic law l = l0 - ζF² (Eq. 6.8).

    Parameters
    ----------
    force
        Tangential force, N/m, (state,).
    length
        Contact length, nm, (state,); the first one is l0.

    Returns
    -------
    ζ in nm (m/N)² and R²; NaN for fewer than three states, or if force or length is constant.
    """
    if force.size < 3 or not np.ptp(length) > 0 or not np.ptp(force) > 0:
        return np.nan, np.nan
    square, lost = force**2, length[0] - length
    coefficient = float((square @ lost) / (square @ square))
    residual = np.sum((lost - coefficient * square) ** 2)
    return coefficient, float(1 - residual / np.sum((length - length.mean()) ** 2))


def fit_threshold_law(length: Array, force: Array) -> tuple[float, float, float]:
    """Return slope τ, intercept F0 and R² of the threshold law F = τl + F0 (Eq. 6.9).

    Parameters
    ----------
    length, force
        Contact length (nm) and force (N/m) at the onset of sliding, (approach,). Onsets without contact are left out.

    Returns
    -------
    τ in GPa, F0 in N/m, and R²; NaN for fewer than three onsets with contact.
    """
    usable = np.isfinite(force) & (length > 0)
    if usable.sum() < 3 or not np.ptp(length[usable]) > 0:
        return np.nan, np.nan, np.nan
    slope, offset = np.polyfit(length[usable], force[usable], 1)
    residual = np.sum((force[usable] - slope * length[usable] - offset) ** 2)
    total = np.sum((force[usable] - force[usable].mean()) ** 2)
    return float(slope), float(offset), float(1 - residual / total)


def peel_asymmetry(trailing: Array, leading: Array, state: int) -> float:
    """Return the difference of the lengths peeled at the trailing and the leading edge over their sum, -1 to 1.

    Parameters
    ----------
    trailing, leading
        Positions of the edges, nm, (state,).
    state
        State that is compared with the first one.
    """
    behind, ahead = trailing[state] - trailing[0], leading[0] - leading[state]
    return float((behind - ahead) / (abs(behind) + abs(ahead))) if behind or ahead else np.nan
