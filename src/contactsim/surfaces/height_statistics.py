"""Statistics of heights by whether they repeat: which functions count across their ends, and which do not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from contactsim.grid import Array
from contactsim.surfaces import open_statistics, statistics


@dataclass(frozen=True)
class HeightStatistics:
    """Functions of heights (n,) or (ny, nx) and their spacing.

    Parameters
    ----------
    rms_gradient
        Over all points, or over those of a third argument.
    rms_gradient_pairs
        Over pairs of neighbours with both ends in a third argument.
    rms_curvature
        Over all points.
    local_squares
        Mean squares of the slopes at each point, of the shape of the heights.
    """

    rms_gradient: Callable[..., float]
    rms_gradient_pairs: Callable[..., float]
    rms_curvature: Callable[..., float]
    local_squares: Callable[..., Array]


STATISTICS = {
    True: HeightStatistics(
        statistics.rms_gradient, statistics.rms_gradient_pairs, statistics.rms_curvature, statistics.local_squares
    ),
    False: HeightStatistics(
        open_statistics.rms_gradient_open,
        open_statistics.rms_gradient_pairs_open,
        open_statistics.rms_curvature_open,
        open_statistics.local_squares_open,
    ),
}
"""By whether heights repeat."""
