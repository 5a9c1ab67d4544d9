"""Peeling, slips and the onset of sliding: what they are told by, and the laws of peeling.

Up to the onset the contact peels: its length is held against the square of the force (Eq. 6.8), and over several
approaches lengths and forces of the onset against each other (Eq. 6.9).
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
"""What a slide amounts to."""
ERRORS = (
    "static_friction",
    "mean_friction",
    "average_friction",
    "onset_sliding_distance",
    "first_force_drop",
    "loop_energy",
)
"""Those of which it is known what the increments leave open."""
THRESHOLD = ("shear_strength", "friction_without_contact", "threshold_r_squared")
"""Eq. 6.9 fitted over the approaches of a study."""
ALONG = "slide_approach"
"""The dimension along which Eq. 6.9 is fitted."""


def quadratic_law(force: Array, length: Array) -> tuple[float, float]:
    """ζ of Eq. 6.8, l = l0 - ζF² with l0 the first length, and R² of the fit; force (N/m), length (nm): (step,).

    ζ is in nm (m/N)². NaN for fewer than three states, or of a length that does not change.
    """
    if force.size < 3 or not np.ptp(length) > 0 or not np.ptp(force) > 0:
        return np.nan, np.nan
    square, lost = force**2, length[0] - length
    coefficient = float((square @ lost) / (square @ square))
    left = np.sum((lost - coefficient * square) ** 2)
    return coefficient, float(1 - left / np.sum((length - length.mean()) ** 2))


def threshold_law(length: Array, force: Array) -> tuple[float, float, float]:
    """Slope (GPa), intercept (N/m) and R² of Eq. 6.9, F = τl + F0, through onsets (approach,), nm and N/m.

    Those without contact, of which there is one force for each approach, are left out. NaN for fewer than three others.
    """
    known = np.isfinite(force) & (length > 0)
    if known.sum() < 3 or not np.ptp(length[known]) > 0:
        return np.nan, np.nan, np.nan
    slope, offset = np.polyfit(length[known], force[known], 1)
    left = np.sum((force[known] - slope * length[known] - offset) ** 2)
    return float(slope), float(offset), float(1 - left / np.sum((force[known] - force[known].mean()) ** 2))


def asymmetry(trailing: Array, leading: Array, step: int) -> float:
    """By which part more has peeled at the trailing than at the leading edge, -1 to 1; edges (step,), nm."""
    behind, ahead = trailing[step] - trailing[0], leading[0] - leading[step]
    return float((behind - ahead) / (abs(behind) + abs(ahead))) if behind or ahead else np.nan
