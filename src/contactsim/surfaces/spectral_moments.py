"""Nayak's parameter of heights, which the theory of Bush, Gibson and Thomas needs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from contactsim.grid import Array, Grid
from contactsim.surfaces.open_statistics import rms_gradient_open, second_differences


def nayak_parameter(heights: Array, spacing: Sequence[float], periodic: bool = True) -> float:
    """Return Nayak's parameter m₀m₄/m₂² of the spectral moments of a profile; NaN for flat heights.

    Parameters
    ----------
    heights : array, shape (n,) or (ny, nx)
        Heights, of a surface alike in all directions: there the mean square of the gradient is 2 m₂, and that of the
        sum of both curvatures 8 m₄/3.
    spacing : sequence of float
        Distance between points in each direction, in the unit of heights.
    periodic : bool
        True: derivatives are those of the waves. False: those of differences inside, where heights do not repeat.
    """
    height, gradient, curvature = (_wave_squares if periodic else _difference_squares)(heights, spacing)
    factor = {1: 1.0, 2: 1.5}[heights.ndim]
    return factor * height * curvature / gradient**2 if gradient else float("nan")


def _wave_squares(heights: Array, spacing: Sequence[float]) -> tuple[float, ...]:
    """Return the mean squares of height, gradient, and sum of curvatures of waves."""
    grid = Grid(heights.shape, tuple(size * step for size, step in zip(heights.shape, spacing, strict=True)))
    power = np.abs(grid.forward(heights - heights.mean())) ** 2
    power[..., 1 : (heights.shape[-1] + 1) // 2] *= 2  # with the opposite waves
    squares = grid.wavenumber**2
    return tuple(float(np.sum(power * squares**order)) for order in range(3))


def _difference_squares(heights: Array, spacing: Sequence[float]) -> tuple[float, ...]:
    """Return the same of differences between neighbours."""
    total = sum(second_differences(heights, axis, step) for axis, step in enumerate(spacing))
    return (
        float(np.var(heights)),
        rms_gradient_open(heights, spacing) ** 2,
        float(np.mean(np.square(total))) if np.size(total) else np.nan,
    )
