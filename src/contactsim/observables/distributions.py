"""Distributions of pressure and gap over a surface at a hard wall."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.grid import Array


@dataclass(frozen=True)
class Bins:
    """Equal bins from 0 to a largest value; the last one holds what lies beyond, too.

    Parameters
    ----------
    largest : float
        End of the last bin.
    count : int
        Number of bins.
    """

    largest: float
    count: int

    @property
    def width(self) -> float:
        """Width of a bin."""
        return self.largest / self.count

    @property
    def centres(self) -> Array:
        """Middle of each bin."""
        return (np.arange(self.count) + 0.5) * self.width

    def density(self, values: Array, size: int) -> Array:
        """Return the share of `size` points with a value in each bin, over the width of a bin; values: (m,)."""
        counts = np.histogram(np.minimum(values, self.largest), self.count, (0.0, self.largest))[0]
        return counts / (size * self.width)


PRESSURE_BINS = Bins(4.0, 80)
"""Bins of the pressure over E* ḡ: its standard deviation in full contact is 0.5."""
GAP_BINS = Bins(8.0, 80)
"""Bins of the gap over the rms height."""


def distributions(pressure: Array, gap: Array, pressure_unit: float, rms_height: float) -> dict[str, Array]:
    """Return the densities of pressure and gap over the whole surface.

    Parameters
    ----------
    pressure, gap : array, shape (n,) or (ny, nx)
        A converged state.
    pressure_unit : float
        E* ḡ, with the rms gradient ḡ of the surface, in the unit of pressure.
    rms_height : float
        In the unit of gap.

    Returns
    -------
    dict
        `pressure_density` in contact, `PRESSURE_BINS`, whose integral is the relative contact area; `gap_density` out
        of contact, `GAP_BINS`, whose integral is the rest. NaN where the unit is zero, as of a flat surface.
    """
    contact = pressure > 0
    densities = {}
    for name, values, unit, bins in (
        ("pressure_density", pressure[contact], pressure_unit, PRESSURE_BINS),
        ("gap_density", gap[~contact], rms_height, GAP_BINS),
    ):
        densities[name] = bins.density(values / unit, pressure.size) if unit else np.full(bins.count, np.nan)
    return densities
