"""The certificate of a pressure at a hard wall: its errors, whatever solver found it. There are no units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from contactsim.grid import Array, map_blocks


@dataclass(frozen=True)
class Certificate:
    """Errors of a pressure; lengths in grid steps.

    Parameters
    ----------
    max_contact_gap
        Largest |gap| in contact.
    penetration
        Largest overlap elsewhere.
    min_pressure
        Smallest pressure in E*·step/spacing; never negative in a solution.
    load_error
        Relative error of the load.
    approach
        Approach that belongs to the pressure.
    """

    max_contact_gap: float
    penetration: float
    min_pressure: float
    load_error: float
    approach: float

    def met(self, tolerance: float) -> bool:
        """Return whether this is a solution to within `tolerance` grid steps; NaN is none."""
        is_close = self.max_contact_gap <= tolerance and self.penetration <= tolerance
        return is_close and self.min_pressure >= 0 and self.load_error <= 1e-12


def certify_gap(gap: Array, pressure: Array, approach: float | None, load: float | None, threads: int) -> Certificate:
    """Return the errors of a pressure, and count its gap from the approach, in place.

    Parameters
    ----------
    gap
        Displacement less heights, in grid steps.
    pressure
        Pressure of the same shape.
    approach, load
        Approach beyond first touch, or mean pressure; without an approach it is the mean gap under pressure.
    threads
        Threads that share the work.
    """
    gaps, pressures = np.atleast_2d(gap, pressure)

    def over_blocks(measure: Callable[[Array, Array], tuple[float, ...]]) -> Array:
        """Return the numbers (blocks, …) that a function finds of the gap and pressure of each block of rows."""
        return np.array(
            map_blocks(lambda low, high: measure(gaps[low:high], pressures[low:high]), pressure.shape, threads)
        )

    if approach is None:
        total, count = over_blocks(_sum_under_pressure).sum(axis=0)
        approach = float(total / count) if count else 0.0
    widest, lowest, least, carried = over_blocks(partial(_count_from, approach)).T
    return Certificate(
        max_contact_gap=float(widest.max()),
        penetration=0.0 - min(float(lowest.min()), 0.0),
        min_pressure=float(least.min()),
        load_error=0.0 if not load else abs(float(carried.sum()) / pressure.size / load - 1),
        approach=approach,
    )


def _sum_under_pressure(gap: Array, pressure: Array) -> tuple[float, float]:
    """Return the sum of the gap under pressure, and the number of its points."""
    under = gap[pressure > 0]
    return under.sum(), under.size


def _count_from(approach: float, gap: Array, pressure: Array) -> tuple[float, ...]:
    """Count a gap from an approach, in place.

    Returns
    -------
    widest, lowest, least, carried
        Largest |gap| under pressure, smallest gap elsewhere or zero, smallest pressure, and its sum.
    """
    gap -= approach
    contact = pressure > 0
    under = gap[contact]
    gap[contact] = 0.0
    lowest = gap.min()
    gap[contact] = under
    return np.abs(under, out=under).max(initial=0.0), lowest, pressure.min(), pressure.sum()
