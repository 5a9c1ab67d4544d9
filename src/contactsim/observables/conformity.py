"""How closely a deformed surface follows the long and the short waves of a profile.

Waves are short from the wave on at which half of the mean square gradient of the profile is reached. A surface follows
a wave as far as the wave is absent from the gap.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array, Grid


def first_short_mode(heights: Array) -> int:
    """Return the number in a period of the longest of the short waves of a profile, (n,); 1 for a flat one."""
    size = np.abs(Grid(heights.shape, (1.0,)).forward(heights)) ** 2
    reached = np.cumsum(np.arange(size.size) ** 2 * size)
    return max(int(np.searchsorted(reached, reached[-1] / 2)), 1)


def conformities(shape: Array, gap: Array, first_short: int) -> dict[str, float]:
    """Return one minus the rms of the gap over that of the profile, of the long waves and of the short ones.

    Parameters
    ----------
    shape, gap
        Normal gap of the undeformed and of the deformed surfaces, (n,), nm.
    first_short
        Of `first_short_mode`.

    Returns
    -------
    dict
        0 where the surface is not deformed, 1 where it touches all over; NaN where the profile has no such waves.
    """
    grid = Grid(shape.shape, (1.0,))
    before, after = (np.abs(grid.forward(field)) ** 2 for field in (shape, gap))
    parts = {"conformity_long": slice(1, first_short), "conformity_short": slice(first_short, None)}
    sums = {name: (before[part].sum(), after[part].sum()) for name, part in parts.items()}
    return {name: float(1 - np.sqrt(left / total)) if total > 0 else np.nan for name, (total, left) in sums.items()}
