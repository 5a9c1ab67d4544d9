"""Displacements of two alike half-spaces under tractions along x, relative to each other."""

from __future__ import annotations

import numpy as np

from contactsim.elasticity.base import known_poisson_ratio
from contactsim.elasticity.half_space import HalfSpace
from contactsim.grid import Array, Grid


def shear_displacements(body: HalfSpace, grid: Grid, traction: Array) -> tuple[Array, Array]:
    """Return the displacements along and across a shear, nm, without their means.

    Parameters
    ----------
    body
        Contact modulus of the pair, and Poisson's ratio of both bodies, which a surface needs.
    grid
        Grid of a line or surface.
    traction
        Traction along x, GPa, shaped as the grid.

    Notes
    -----
    A wave that runs at an angle θ to x is displaced by (1 - ν cos²θ)/(1 - ν) times the normal displacement under the
    same pressure along x, and by -ν sinθ cosθ/(1 - ν) times it across. On a line, in plane strain, both are alike.
    """
    normal = body.compliance(grid.wavenumber) * grid.forward(traction)
    if len(grid.shape) == 1:
        return grid.backward(normal), np.zeros_like(traction)
    ratio = known_poisson_ratio(body)
    first, last = np.fft.fftfreq(grid.shape[0], grid.spacing[0]), np.fft.rfftfreq(grid.shape[1], grid.spacing[1])
    angle = np.arctan2(first[:, None], last)
    factors = 1 - ratio * np.cos(angle) ** 2, -ratio * np.sin(angle) * np.cos(angle)
    along, across = (grid.backward(factor / (1 - ratio) * normal) for factor in factors)
    return along, across
