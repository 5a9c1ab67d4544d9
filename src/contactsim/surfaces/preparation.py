"""Preparation of measured heights: spikes, scan lines and form are removed, and the seams are closed.

A line and an area are treated alike, direction by direction.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from contactsim.arguments import checked
from contactsim.errors import POSITIVE, InputError, is_positive
from contactsim.grid import Array
from contactsim.surfaces.topography import Topography
from contactsim.topography_files import io

Operations = Mapping[str, Callable[[Array], Array]]

TAPER = 0.1
"""Length of the taper of a window at each end, over the length of the heights."""
DEVIATION_RATIO = 1.4826
"""Standard deviation over the median of absolute values, of Gaussian numbers."""
MAX_SPIKE_SHARE = 0.01
"""Share of points up to which they are spikes if all others agree with those about them."""


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


def _level_by_median(heights: Array) -> Array:
    """Return the heights of an area with each row less its median."""
    return heights - np.median(heights, axis=1, keepdims=True)


def _level_by_steps(heights: Array) -> Array:
    """Return the heights of an area with each row moved until the median of its steps from the row before is zero."""
    moves = np.cumsum(np.median(np.diff(heights, axis=0), axis=1))
    return heights - np.concatenate([[0.0], moves])[:, None]


USUAL_DETREND = {1: "linear", 2: "plane"}
"""What is subtracted where nothing else is named, by dimension."""


def _remove_spikes(heights: Array, threshold: float) -> tuple[Array, float]:
    """Return the heights with spikes replaced by the median about them, and the share of the points replaced."""
    from scipy.ndimage import median_filter  # takes longer to import than most files to read

    about = median_filter(heights, size=5 if heights.ndim == 1 else 3, mode="nearest")
    difference = np.abs(heights - about)
    differs = difference > 0
    spread = DEVIATION_RATIO * float(np.median(difference))
    if not spread and differs.mean() > MAX_SPIKE_SHARE:  # heights of few digits
        spread = float(difference[differs].min())
    spikes = difference > threshold * spread
    return np.where(spikes, about, heights), float(spikes.mean())


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

LEVEL: Mapping[int, Operations] = {
    1: {"none": np.copy},
    2: {"none": np.copy, "median": _level_by_median, "steps": _level_by_steps},
}
"""Ways to level scan lines, for a line and for an area."""

ENDS: Mapping[int, Operations] = {
    1: {"none": np.copy, "window": _apply_window, "mirror": _mirror, "tilt": _tilt},
    2: {"none": np.copy, "window": _apply_window, "mirror": _mirror},
}
"""Ways to close the seams, for a line and for an area."""


@checked
def prepare_topography(
    topography: Topography,
    detrend: str | None = None,
    ends: str = "none",
    level: str = "none",
    spikes: float | None = None,
) -> Topography:
    """Return measured heights without spikes, steps between scan lines and form; made periodic if it is asked for.

    In this order: spikes, scan lines, form, seams.

    Parameters
    ----------
    topography : Topography
        Heights (n,) or (ny, nx), in nm.
    detrend : str, optional
        "none", "mean", "quadratic", or the fit of first degree, which is the default: "linear" for a line, "plane"
        for an area. A quadratic fit of an area has all of 1, x, y, x², xy and y².
    ends : {"none", "mirror", "window", "tilt"}
        How the ends are made to meet; all but "none" make the heights periodic.

        - "none": the ends do not meet. Where the heights repeat, a step is left at the seam; along a line it adds
          step²/(n spacing²) to the mean square slope.
        - "mirror": the heights are followed by their mirror image in each direction, n become 2n-2. Slopes are kept.
        - "window": mean-free heights are tapered to zero over 10 % at each end. The rms slope of roughness much
          shorter than the length falls by about 6 % along a line (mean square times 0.875).
        - "tilt", for a line only: the line through both ends is subtracted. The mean square of the n-1 slopes falls
          by that of the line. No plane closes a seam along which heights vary.
    level : {"none", "median", "steps"}
        How scan lines, the rows of an area, are levelled: "median", each has a median of zero; "steps", the median of
        the steps from a row to the next is zero. That keeps an object, however wide, if less than half of a row steps
        at once, as along oblique edges.
    spikes : float, optional
        Points are replaced that differ from the median of the 5 about them on a line, 3 × 3 over an area, by more than
        this many robust standard deviations of such differences (1.4826 of their median).

    Returns
    -------
    Topography
        The prepared heights, with the same spacing and source; `spikes` is the share of points replaced.

    Raises
    ------
    InputError
        If an option has a value that is not one of these.
    """
    heights, dimensions, replaced = topography.values, topography.values.ndim, topography.spikes
    if spikes is not None:
        if not is_positive(spikes):
            raise InputError("spikes", spikes, f"{POSITIVE}, of standard deviations", topography.source)
        heights, replaced = _remove_spikes(heights, float(spikes))
    detrend = USUAL_DETREND[dimensions] if detrend is None else detrend
    for key, name, operations in (
        ("level", level, LEVEL),
        ("detrend", detrend, DETREND),
        ("ends", ends, ENDS),
    ):
        ways = operations[dimensions]
        if name not in ways:
            raise InputError(key, name, f"one of {', '.join(ways)}", topography.source)
        heights = ways[name](io.finite_numbers(heights, "heights", topography.source, dims=dimensions))
    repeats = topography.periodic or ends != "none"
    return dataclasses.replace(topography, values=heights, spikes=replaced, periodic=repeats)
