"""A case to press, what is right for it, and how cases with an exact answer are made.

Right answers come from no solver. Most are made: choose a pressure p ≥ 0 and a gap g ≥ 0 that is zero wherever p is
not; the heights S p - g then have exactly that answer, and no other, because S is positive definite at a given load.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contactsim.grid import Array
from contactsim.traits import Trait


@dataclass(frozen=True)
class Case:
    """A scene to press: heights (n,) or (ny, nx), contact modulus, tolerance in grid steps, and the load.

    spacing: of points, of a surface one number or those along y and x. Exactly one of mean_pressure and approach is
    given. exact: the pressure, shaped as heights, None where it is unknown; area: the exact relative contact area, of
    a profile so smooth that the grid moves it by at most half a point at each edge; refuse: whether this must be
    refused; mirror: the point about which the scene is symmetric, of a surface in both directions, where there is one;
    thickness and poisson_ratio: of a layer, None on a half-space.
    """

    heights: Array
    mean_pressure: float | None = None
    approach: float | None = None
    spacing: float | tuple[float, float] = 1.0
    contact_modulus: float = 1.0
    tolerance: float = 1e-4
    exact: Array | None = None
    area: float | None = None
    refuse: bool = False
    mirror: int | tuple[int, int] | None = None
    thickness: float | None = None
    poisson_ratio: float | None = None

    @property
    def kind(self) -> frozenset[Trait]:
        """Traits that a solver must accept to solve such cases."""
        return frozenset({Trait.WALL, {1: Trait.LINE, 2: Trait.SURFACE}[self.heights.ndim]})

    @property
    def spacings(self) -> Array:
        """Of points in each direction, x last."""
        return np.broadcast_to(self.spacing, self.heights.ndim)

    @property
    def compliance(self) -> Array:
        """Displacement over pressure of each real Fourier mode, (n//2 + 1,) or (ny, nx//2 + 1).

        By numpy and other formulas than ours.
        """
        *rows, last = zip(self.heights.shape, self.spacings, strict=True)
        waves = [np.fft.fftfreq(size, spacing) for size, spacing in rows]
        q = 2 * np.pi * np.sqrt(sum(np.square(wave) for wave in np.ix_(*waves, np.fft.rfftfreq(*last))))
        if self.thickness is None:
            return np.divide(2 / self.contact_modulus, q, out=np.zeros_like(q), where=q > 0)
        assert self.poisson_ratio is not None, "a layer has one"
        response = layer_response(q.ravel() * self.thickness, self.poisson_ratio).reshape(q.shape)
        return response * (self.thickness / self.contact_modulus)


def layer_response(x: Array, poisson_ratio: float) -> Array:
    """Compliance over h/E* of a bonded layer at x = |q|h (Johnson 1985), (sinh 2x - 2x)/2x as an integral.

    That is ∫₀¹ (cosh 2xt - 1) dt, by 60 points of Gauss; from x = 30 on it is the half-space's 2/x to 20 digits.
    """
    k, deep = 3 - 4 * poisson_ratio, np.minimum(x, 30.0)
    points, weights = np.polynomial.legendre.leggauss(60)
    bulk = 2 * np.sinh(np.outer(deep, (points + 1) / 2)) ** 2 @ (weights / 2)
    layer = 4 * (k * bulk + (2 - 4 * poisson_ratio)) / (k * np.cosh(2 * deep) + (1 + k**2) / 2 + 2 * deep**2)
    return np.where(x < 30, layer, 2 / np.maximum(x, 30.0))


def displacement(pressure: Array, compliance: Array) -> Array:
    """Displacement S p less its mean under a pressure (n,) or (ny, nx); by numpy's transforms alone."""
    return _back(np.fft.rfftn(pressure - pressure.mean()) * compliance, pressure.shape)


def flat_pressure(heights: Array, compliance: Array) -> Array:
    """Pressure less its mean that flattens heights (n,) or (ny, nx): that of complete contact."""
    waves = np.fft.rfftn(heights - heights.mean())
    return _back(np.divide(waves, compliance, out=np.zeros_like(waves), where=compliance > 0), heights.shape)


def _back(waves: Array, shape: tuple[int, ...]) -> Array:
    """The field of real Fourier coefficients."""
    return np.fft.irfftn(waves, shape, range(len(shape)))


def mirror_field(values: Array, about: int | tuple[int, int]) -> Array:
    """A field (n,) or (ny, nx) mirrored about a point, in each direction."""
    shifts = 2 * np.broadcast_to(about, values.ndim) + 1
    return np.roll(np.flip(values), shifts, range(values.ndim))


def make_case(
    field: Array,
    scale: float = 1.0,
    unit: float = 1.0,
    tolerance: float = 1e-8,
    spacing: float | tuple[float, float] = 1.0,
    thickness: float | None = None,
    poisson_ratio: float | None = None,
) -> Case:
    """The case whose pressure is the positive part of a field (n,) or (ny, nx), and whose gap is the negative part.

    scale: factor on heights and pressure; unit: of length, with a modulus that keeps the load of a length; spacing: in
    that unit; thickness: of a layer, in that unit; poisson_ratio: of the layer.
    """
    pressure = np.maximum(field, 0.0)
    exact = scale / unit * pressure
    case = Case(
        field,
        exact.mean(),
        spacing=(unit * spacing[0], unit * spacing[1]) if isinstance(spacing, tuple) else unit * spacing,
        contact_modulus=1 / unit,
        tolerance=tolerance,
        exact=exact,
        thickness=None if thickness is None else unit * thickness,
        poisson_ratio=poisson_ratio,
    )
    heights = displacement(exact, case.compliance) - unit * scale * np.maximum(-field, 0.0)
    return replace(case, heights=heights)


def shift_field(field: Array, share: float) -> Array:
    """The field less the value that a share of its points exceeds."""
    return field - np.quantile(field, 1 - share)


def nearly_incompressible_ratio(severity: float) -> float:
    """Return a Poisson's ratio that rises with the severity from 0.3 to exactly 0.5."""
    return 0.5 if severity >= 100 else 0.5 - 0.2 * 10 ** (-severity / 8)


def push_to_approach(case: Case, flat: Array, severity: float) -> Case:
    """Return a case whose approach goes up to a million times that of complete contact.

    Parameters
    ----------
    case : Case
        Heights on a layer.
    flat : Array, the shape of the heights
        Pressure less its mean in complete contact.
    severity : float
        From 0, half the load of complete contact, to 100.
    """
    full = -flat.min()
    load = full * (0.5 + 10 ** (-4 + severity / 10))
    exact = load + flat if load >= full else None
    return replace(case, approach=load * case.compliance.flat[0], exact=exact)


def point_pressure(heights: Array, load: float | None = None, depth: float = 0.0) -> Array | None:
    """The pressure if the highest point carries the load, or is pushed in by the depth, alone; None if it does not."""
    top = np.unravel_index(np.argmax(heights), heights.shape)
    pressure = np.zeros_like(heights)
    pressure[top] = 1.0
    half_space = Case(heights).compliance
    pressure[top] = depth / displacement(pressure, half_space)[top] if load is None else load * heights.size
    gap = displacement(pressure, half_space) - heights
    return pressure if (gap >= gap[top]).all() else None


def summit_pressure(heights: Array, load: float) -> Array | None:
    """The pressure if the highest points, of equal height, carry the load alone; None if they do not.

    By elimination among them: the matrix of influences of a half-space, bordered by the load.
    """
    half_space, top = Case(heights).compliance, np.argwhere(heights == heights.max())
    influence = _back(half_space.astype(complex), heights.shape)
    apart = (top[:, None] - top) % heights.shape
    matrix = np.ones((len(top) + 1, len(top) + 1))
    matrix[:-1, :-1] = influence[tuple(np.moveaxis(apart, -1, 0))]
    matrix[-1, -1] = 0.0
    pressure = np.zeros_like(heights)
    forces = np.linalg.solve(matrix, np.append(np.zeros(len(top)), load * heights.size))[:-1]
    pressure[tuple(top.T)] = forces
    gap = displacement(pressure, half_space) - heights
    touching = gap[tuple(top.T)].mean()
    return pressure if forces.min() > 0 and gap.min() > touching - 1e-9 * np.abs(heights).max() else None
