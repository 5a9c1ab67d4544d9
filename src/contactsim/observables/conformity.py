"""How closely a deformed surface follows the long and the short waves of a profile.

Waves are short from the wave on at which half of the mean square gradient of the profile is reached. A surface follows
a wave as far as the wave is absent from the gap.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array


def first_short_mode(profile: Array) -> int:
    """Return the number in a period of the longest of the short waves of a profile; 1 for a flat one.

    profile: Fourier coefficients, (m,)
    """
    square = np.cumsum((np.arange(profile.size) * np.abs(profile)) ** 2)
    return max(int(np.searchsorted(square, square[-1] / 2)), 1)


def conformities(profile: Array, gap: Array, first_short: int) -> dict[str, float]:
    """Return one minus the rms of the gap over that of the profile, of the long waves and of the short ones.

    Parameters
    ----------
    profile, gap
        Fourier coefficients of the normal gap of the undeformed and of the deformed surfaces, (m,), nm.
    first_short
        Number in a period of the longest of the short waves.

    Returns
    -------
    dict
        0 where the surface is not deformed, 1 where it touches all over; NaN where the profile has no such waves.
    """
    parts = {"conformity_long": slice(1, first_short), "conformity_short": slice(first_short, None)}
    numbers = {}
    for name, part in parts.items():
        before, after = np.linalg.norm(profile[part]), np.linalg.norm(gap[part])
        numbers[name] = float(1 - after / before) if before else np.nan
    return numbers
