"""Preparation of measured heights: form is removed, and the seams are closed for the periodic solvers.

A line and an area are treated alike, direction by direction.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.surfaces import io
from contactsim.surfaces.topography import Topography

Operations = Mapping[str, Callable[[Array], Array]]

TAPER = 0.1
"""Length of the taper of a window at each end, over the length of the heights."""


def _subtract_fit(degree: int, heights: Array) -> Array:
    """Return the heights less their least-squares polynomial of a total degree in all directions.

    Products of the discrete orthonormal polynomials of each direction are orthonormal on the grid, so the fit is a
    projection.
    """
    bases = [np.linalg.qr(np.polynomial.legendre.legvander(np.linspace(-1, 1, n), degree)).Q for n in heights.shape]
    fit = heights
    for basis in bases:  # each direction in turn leads, and goes last
        fit = np.tensordot(fit, basis, (0, 0))
    fit = np.where(sum(np.indices(fit.shape)) <= degree, fit, 0.0)
    for basis in bases:
        fit = np.tensordot(fit, basis, (0, 1))
    remainder: Array = heights - fit
    return remainder


def _apply_window(heights: Array) -> Array:
    """Return mean-free heights tapered by cosines to zero over `TAPER` of the length at each end of each direction."""
    tapered: Array = heights - heights.mean()
    for axis, size in enumerate(heights.shape):
        edge = np.minimum(np.arange(size), np.arange(size)[::-1]) / (size - 1)
        taper = 0.5 - 0.5 * np.cos(np.pi * np.minimum(edge / TAPER, 1))
        tapered *= np.expand_dims(taper, [other for other in range(heights.ndim) if other != axis])
    return tapered


def _mirror(heights: Array) -> Array:
    """Return the heights followed by their reverse in each direction, the ends once: n become 2n-2."""
    for axis, size in enumerate(heights.shape):
        heights = heights.take([*range(size), *range(size - 2, 0, -1)], axis)
    return heights


def _tilt(heights: Array) -> Array:
    """Return the heights (n,) less the line through both ends."""
    return heights - np.linspace(heights[0], heights[-1], heights.size)


DETREND: Mapping[int, Operations] = {
    dimensions: {
        "none": np.copy,
        "mean": partial(_subtract_fit, 0),
        name: partial(_subtract_fit, 1),
        "quadratic": partial(_subtract_fit, 2),
    }
    for dimensions, name in ((1, "linear"), (2, "plane"))
}
"""Ways to remove form, for a line and for an area."""

PERIODIC: Mapping[int, Operations] = {
    1: {"none": np.copy, "window": _apply_window, "mirror": _mirror, "tilt": _tilt},
    2: {"none": np.copy, "window": _apply_window, "mirror": _mirror},
}
"""Ways to close the seams, for a line and for an area."""


def prepare(topography: Topography, detrend: str | None = None, periodic: str = "mirror") -> Topography:
    """Return measured heights less their least-squares fit, then made periodic.

    Parameters
    ----------
    topography : Topography
        Heights (n,) or (ny, nx), in nm.
    detrend : str, optional
        "none", "mean", "quadratic", or the fit of first degree, which is the default: "linear" for a line, "plane"
        for an area. A quadratic fit of an area has all of 1, x, y, x², xy and y².
    periodic : {"mirror", "window", "tilt", "none"}
        - "mirror": the heights are followed by their mirror image in each direction, n become 2n-2. Slopes are kept.
        - "window": mean-free heights are tapered to zero over 10 % at each end. The rms slope of roughness much
          shorter than the length falls by about 6 % along a line (mean square times 0.875).
        - "tilt", for a line only: the line through both ends is subtracted. The mean square of the n-1 slopes falls
          by that of the line. No plane closes a seam along which heights vary.
        - "none": a step at the seam stays. Along a line it adds step²/(n spacing²) to the mean square slope.

    Returns
    -------
    Topography
        The prepared heights, with the same spacing and source.

    Raises
    ------
    InputError
        If `detrend` or `periodic` is not one of these names.
    """
    dimensions = topography.values.ndim
    if detrend is None:
        detrend = "linear" if dimensions == 1 else "plane"
    heights = topography.values
    for key, name, operations in (("detrend", detrend, DETREND), ("periodic", periodic, PERIODIC)):
        ways = operations[dimensions]
        if not isinstance(name, str) or name not in ways:
            raise InputError(key, name, f"one of {', '.join(ways)}", topography.source)
        heights = ways[name](io.finite_numbers(heights, "heights", topography.source, dims=dimensions))
    return dataclasses.replace(topography, values=heights)
