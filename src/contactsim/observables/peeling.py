"""Peeling of a contact up to the onset of sliding: its asymmetry, and the law of its area (Eq. 6.8)."""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array

PEELING = (
    "peeled_fraction",
    "contact_shift_quarter",
    "contact_shift_halfway",
    "contact_shift_three_quarters",
    "contact_shift",
    "trailing_peel_halfway",
    "leading_peel_halfway",
    "trailing_peel",
    "leading_peel",
    "peel_asymmetry_halfway",
    "peel_asymmetry",
    "quadratic_coefficient",
    "quadratic_r_squared",
    "quadratic_r_squared_all",
    "peel_rate_ratio",
    "peel_exponent",
)
"""Numbers of the peeling of a slide."""
MIN_STATES = 3
"""Smallest number of states to which a law is fitted."""
EXPONENTS = (0.1, 40.0)
"""Smallest and largest exponent of the contact's law that is looked for."""


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
    ζ in nm (m/N)² and R²; NaN for fewer than `MIN_STATES` states, or if force or length is constant.
    """
    if not _is_varied(force, length):
        return np.nan, np.nan
    square, lost = force**2, length[0] - length
    coefficient = float((square @ lost) / (square @ square))
    residual = np.sum((lost - coefficient * square) ** 2)
    return coefficient, float(1 - residual / np.sum((length - length.mean()) ** 2))


def fit_exponent(force: Array, length: Array) -> float:
    """Return the exponent m of the law l = l0 - ζF^m that fits best; NaN if none of `EXPONENTS` does.

    Parameters
    ----------
    force, length
        Tangential force (N/m) and contact length (nm), (state,); the first length is l0.
    """
    from scipy.optimize import minimize_scalar  # takes longer to import than to fit

    if not _is_varied(force, length):
        return np.nan
    relative, lost = np.abs(force) / np.abs(force).max(), length[0] - length

    def residual(logarithm: float) -> float:
        """Return the sum of squares that the best ζ leaves with an exponent."""
        power = relative ** np.exp(logarithm)
        return float(np.sum((lost - (power @ lost) / (power @ power) * power) ** 2))

    low, high = np.log(EXPONENTS)
    best = minimize_scalar(residual, bounds=(low, high), method="bounded", options={"xatol": 1e-6}).x
    return float(np.exp(best)) if min(best - low, high - best) > 1e-3 else np.nan


def peel_rate_ratio(force: Array, length: Array) -> float:
    """Return the slope of the length against F² in the last quarter of F² over that in the first quarter.

    It is 1 under the quadratic law, and larger if the contact peels faster near the onset. NaN for fewer than
    `MIN_STATES` states in a quarter, or if the contact does not shrink in the first one.

    Parameters
    ----------
    force, length
        Tangential force (N/m) and contact length (nm), (state,).
    """
    if not _is_varied(force, length):
        return np.nan
    square = force**2 / np.max(force**2)
    parts = [square <= 0.25, square >= 0.75]
    if min(np.count_nonzero(part) for part in parts) < MIN_STATES:
        return np.nan
    first, last = (float(np.polyfit(square[part], length[part], 1)[0]) for part in parts)
    return last / first if first < 0 else np.nan


def edge_peel(trailing: Array, leading: Array, distance: Array, place: float) -> tuple[float, float]:
    """Return the lengths (nm) peeled at the trailing and at the leading edge up to a sliding distance.

    Parameters
    ----------
    trailing, leading
        Positions of the edges on the undeformed probe, nm, (state,).
    distance
        Sliding distances, increasing, nm, (state,).
    place
        Sliding distance, nm; between states the edges are interpolated.
    """
    behind, ahead = (float(np.interp(place, distance, edge)) for edge in (trailing, leading))
    return behind - float(trailing[0]), float(leading[0]) - ahead


def peel_asymmetry(behind: float, ahead: float) -> float:
    """Return the difference of the lengths peeled at the trailing and the leading edge over their sum.

    It is 1 if only the trailing edge peels, and larger if the leading edge moves outwards. NaN if nothing peels in sum.
    """
    total = behind + ahead
    return (behind - ahead) / total if total > 0 else np.nan


def edge_shift(trailing: Array, leading: Array, share: float) -> float:
    """Return the shift of a contact's centre (nm) where it has lost a share of what it loses in all.

    Parameters
    ----------
    trailing, leading
        Positions of the edges up to the onset of sliding, nm, (state,); NaN without contact.
    share
        Part of the length that is lost in all, which may be the whole contact.

    Returns
    -------
    The shift, interpolated between two states with contact; else that of the last state with contact before. NaN if
    the contact does not shrink.
    """
    length = np.nan_to_num(leading - trailing)
    centre = (leading + trailing) / 2
    lost = length[0] - length
    reached = np.flatnonzero(lost >= share * lost[-1])
    if not lost[-1] > 0 or not reached.size:
        return np.nan
    after = int(reached[0])
    before = after - 1
    if np.isnan(centre[after]):
        return float(centre[before] - centre[0])
    part = (share * lost[-1] - lost[before]) / (lost[after] - lost[before])
    return float(centre[before] + part * (centre[after] - centre[before]) - centre[0])


def _is_varied(force: Array, length: Array) -> bool:
    """Return True if a law can be fitted to states."""
    return force.size >= MIN_STATES and bool(np.ptp(length) > 0) and bool(np.ptp(force) > 0)
