"""The area of rough surfaces by the theory of Bush, Gibson and Thomas: summits that do not feel one another.

Wear 35, 87 (1975), doi:10.1016/0043-1648(75)90145-3. The heights are a Gaussian field, alike in all directions. Each
summit is a paraboloid of the heights' own curvatures, and touches a flat as Hertz's ellipse does.
"""

from __future__ import annotations

import numpy as np

from contactsim.errors import InputError, is_number
from contactsim.grid import Array

MIN_NAYAK = 1.6
"""Smallest Nayak's parameter at which the quadrature is right to 1e-5; a single wavelength has the least, 1.5."""
NODES = {"curvature": 48, "shape": 32, "overlap": 40}
"""Nodes of the quadrature over the mean curvature of a summit, its departure from a sphere, and its overlap."""
SEPARATIONS = np.linspace(-4.0, 7.0, 45)
"""Distances of the flat from the mean plane, in rms heights, between which the area is interpolated."""
TAIL = 9.0
"""Standard deviations after which a Gaussian has ended."""


def bush_area(reduced_pressure: Array | float, nayak_parameter: float) -> Array:
    """Return the relative contact area of a rough surface by the theory of Bush, Gibson and Thomas.

    Parameters
    ----------
    reduced_pressure
        p* = p/(E* ḡ), with the rms gradient ḡ of the surface; NaN is returned where the theory does not reach it.
    nayak_parameter
        m₀m₄/m₂² of the spectral moments of a profile, 1.6 or more.

    Notes
    -----
    The area over p* rises to √(2π) as the load vanishes, the slower the larger Nayak's parameter.

    Raises
    ------
    InputError
        For a smaller parameter.
    """
    if not (is_number(nayak_parameter) and nayak_parameter >= MIN_NAYAK):
        raise InputError("nayak_parameter", nayak_parameter, f"a number, {MIN_NAYAK:g} or more")
    from scipy.interpolate import CubicSpline  # takes longer to import than most of this package

    shape = _nodes(NODES["shape"], 0.0, 1.0)
    factors = _ellipse(shape[0])
    contacts = [_contact_at(separation, nayak_parameter, shape, factors) for separation in SEPARATIONS[::-1]]
    areas, pressures = np.transpose(contacts)
    curve = CubicSpline(np.log(pressures), np.log(areas), extrapolate=False)
    with np.errstate(divide="ignore"):  # no load: outside the curve
        return np.asarray(np.exp(curve(np.log(reduced_pressure))))


def _contact_at(
    separation: float, nayak_parameter: float, shape: tuple[Array, Array], factors: tuple[Array, Array]
) -> tuple[float, float]:
    """Return relative contact area and reduced pressure at a separation.

    Parameters
    ----------
    separation
        Distance of the flat from the mean plane, in rms heights.
    nayak_parameter
        m₄, as m₀ = m₂ = 1.
    shape
        Nodes w and weights over a summit's departure from a sphere.
    factors
        Of area and load at each of them, from `_ellipse`.

    Notes
    -----
    With t the mean curvature of a summit and w t the half difference of its principal curvatures, the summits have the
    density t²(1-w²)/(2π) times the densities of height and t, which are Gaussian together, and of w t, Rayleigh's.
    """
    fourth = nayak_parameter
    deviation = np.sqrt(2 * fourth / 3)  # of the mean curvature
    t, t_weights = _nodes(NODES["curvature"], 0.0, TAIL * deviation)
    (w, w_weights), (area_factor, load_factor) = shape, factors
    mean = 3 * t / (2 * fourth)  # of the height at a given curvature
    spread = np.sqrt(1 - 3 / (2 * fourth))
    overlaps, weights = _nodes(NODES["overlap"], 0.0, 1.0)
    ends = mean + np.array([[-TAIL], [TAIL]]) * spread - separation  # least and largest overlap of each curvature
    least, largest = np.sqrt(np.maximum(ends, 0.0))[:, :, None]
    root = least + (largest - least) * overlaps  # the load is smooth in it
    overlap, steps = root**2, 2 * root * (largest - least) * weights
    density = _gaussian((separation + overlap - mean[:, None]) / spread) / spread * steps
    summits = t**2 * _gaussian(t / deviation) / deviation * t_weights / (2 * np.pi)
    shapes = (1 - w**2) * w_weights * 3 * w * t[:, None] ** 2 / fourth
    shapes = shapes * np.exp(-3 * (w * t[:, None]) ** 2 / (2 * fourth))
    area = np.sum(summits / t * (shapes @ area_factor) * (density * overlap).sum(1))
    load = np.sum(summits / np.sqrt(t) * (shapes @ load_factor) * (density * overlap**1.5).sum(1))
    return float(area), float(load / np.sqrt(2))  # ḡ² = 2 m₂


def _nodes(count: int, low: float, high: float) -> tuple[Array, Array]:
    """Return nodes and weights of Gauss and Legendre between two ends."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return low + (high - low) * (nodes + 1) / 2, (high - low) / 2 * weights


def _gaussian(values: Array) -> Array:
    """Return the normal density."""
    return np.exp(-(values**2) / 2) / np.sqrt(2 * np.pi)


def _ellipse(shape: Array) -> tuple[Array, Array]:
    """Return the area of a Hertzian ellipse over overlap/t, and its load over E* overlap^(3/2) t^(-1/2).

    Parameters
    ----------
    shape
        Half difference of the principal curvatures over their mean t, above 0 and below 1.

    Notes
    -----
    Johnson 1985, Sec. 4.2: of the square m of the eccentricity the ratio of the curvatures is
    (E/(1-m) - K)/(K - E), with complete elliptic integrals K and E.
    """
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipkm1

    def ratio(logit: float) -> float:
        """Return the ratio of the curvatures at m = 1/(1 + exp(-logit))."""
        rest = 1 / (1 + np.exp(logit))
        first, second = ellipkm1(rest), ellipe(1 - rest)
        return (second / rest - first) / (first - second)

    logits = [brentq(lambda logit, w=w: np.log(ratio(logit) * (1 - w) / (1 + w)), -18.0, 60.0) for w in shape]
    rest = 1 / (1 + np.exp(np.array(logits)))
    first, second = ellipkm1(rest), ellipe(1 - rest)
    square = 2 * (first - second) / (first * (1 - rest) * (1 - shape))  # long half-axis² over overlap/t
    return np.pi * square * np.sqrt(rest), 2 * np.pi / 3 * np.sqrt(square) / first
