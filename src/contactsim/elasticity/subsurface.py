"""Displacement and stress below the surface of a body, from the tractions on its surface (Section 2.2).

A wave that decays before it meets the base is the sum of a part that decays downwards and one that decays upwards from
the base, both in closed form. Below `THIN` = qh these two cancel; the field is then carried up from the base, where
displacement is zero, by functions without cancellation. Stress needs neither derivatives nor C11, so ν may be 1/2.

With u_n = i p and everything in units of μq, a wave that decays downwards from the displacement (p, u_t) of the surface
is, at depth d, with y = qd, r = 1/(3-4ν) and β = r(u_t + p),

    p + βy,   u_t - βy,   σ_zz = 2i (p - (1-2ν)β + βy),   σ_xz = u_t - p + β - 2βy,   all times e^{-y}.

A wave that decays upwards is its mirror image. Their difference, from the same displacement of the base, is zero at the
base. Up to a factor of two, with y = qz counted from the base, it is

    p:    p (sinh y - r y cosh y) - u_t r y sinh y
    u_t:  p r y sinh y + u_t (sinh y + r y cosh y)
    σ_zz: i (p [(1+r) cosh y - 2 r y sinh y] - u_t [(1-r) sinh y + 2 r y cosh y])
    σ_xz: u_t [(1+r) cosh y + 2 r y sinh y] + p [2 r y cosh y - (1-r) sinh y].

In plane strain σ_xx = (ν σ_zz + 2μ ∂u_t/∂x)/(1-ν). The mean stress is uniform; the mean strain along x is zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.elasticity.base import Elasticity, known_poisson_ratio, relative_compliance
from contactsim.elasticity.plane_strain import MAX_DEPTH, cosh_less_sinh, determinant
from contactsim.errors import InputError
from contactsim.grid import Array, Grid

THIN = 1.0
"""|q|h below which fields are carried up from the base."""


@dataclass(frozen=True)
class SubsurfaceFields:
    """Displacement and stress below the surface of a body.

    Parameters
    ----------
    position : array, shape (n,)
        Coordinates along x, nm.
    depth : array, shape (depth,)
        Distance below the surface, nm.
    displacement : array, shape (depth, 2, n)
        Displacement, normal (up) and along x, nm.
    stress : array, shape (depth, 3, n)
        Stresses σ_xx, σ_zz and σ_xz, tension positive, GPa.
    """

    position: Array
    depth: Array
    displacement: Array
    stress: Array

    def between(self, left: float, right: float) -> SubsurfaceFields:
        """Return the fields from one position to another, nm, both included."""
        selection = (self.position >= left) & (self.position <= right)
        displacement, stress = self.displacement[..., selection], self.stress[..., selection]
        return SubsurfaceFields(self.position[selection], self.depth, displacement, stress)


def subsurface_fields(body: Elasticity, grid: Grid, traction: Array, depths: Array) -> SubsurfaceFields:
    """Return the fields below the surface of a lower body under tractions.

    An upper body is a lower one upside down: pass (T_n, -T_t), and read -u_n and -σ_xz.

    Parameters
    ----------
    body : Elasticity
        Half-space or layer with a Poisson's ratio.
    grid : Grid
        Grid of the surface, a line.
    traction : array, shape (1, n) or (2, n)
        Normal traction, or normal traction and that along x, GPa; positive pulls the body up and along x, so a
        pressure is negative.
    depths : array, shape (depth,)
        Distances below the surface, nm, from 0 to the depth of the base.

    Returns
    -------
    SubsurfaceFields
        Displacement and stress. The mean displacement of the surface of a half-space is zero.

    Raises
    ------
    InputError
        If a depth is outside the body, the traction does not fit the grid, or Poisson's ratio is unknown.
    """
    depths, traction = np.atleast_1d(np.asarray(depths, float)), np.asarray(traction, float)
    if not (depths >= 0).all() or not (depths <= body.base_depth).all():
        raise InputError("depths", depths, f"from 0 to {body.base_depth:g} nm")
    if traction.ndim != 2 or traction.shape[0] > 2 or traction.shape[1:] != grid.shape:
        raise InputError("traction", traction, f"(1, {grid.shape[0]}) or (2, {grid.shape[0]}): components on this line")
    components = np.zeros((2, *grid.shape))
    components[: len(traction)] = traction
    tractions = np.stack([grid.forward(row) for row in components])
    surface = relative_compliance(body, None, grid, ("n", "t")).apply(tractions)
    waves = _waves(body, grid.wavenumber[1:], tractions[:, 1:], surface[:, 1:], depths)
    coefficients = np.empty((depths.size, 5, *grid.half_shape), complex)
    coefficients[:, :, 1:] = np.moveaxis(waves, 0, 1)
    coefficients[:, :, 0] = _mean(body, tractions[:, 0].real, surface[:, 0].real, depths)
    values = np.stack([grid.backward(row) for row in coefficients.reshape(-1, *grid.half_shape)])
    values = values.reshape(depths.size, 5, *grid.shape)
    return SubsurfaceFields(grid.positions(), depths, values[:, :2], values[:, 2:])


def _mean(body: Elasticity, traction: Array, surface: Array, depths: Array) -> Array:
    """Return the mean displacement and stress at each depth, shape (depth, 5)."""
    ratio = known_poisson_ratio(body)
    flexibility = np.array([(1 - 2 * ratio) / (1 - ratio) ** 2, 2 / (1 - ratio)]) / body.contact_modulus
    displacement = surface - np.outer(depths, traction * flexibility)
    stress = np.array([ratio / (1 - ratio) * traction[0], *traction])
    return np.hstack([displacement, np.tile(stress, (depths.size, 1))])


def _waves(body: Elasticity, wavenumber: Array, traction: Array, surface: Array, depths: Array) -> Array:
    """Return the coefficients, shape (5, depth, m), of displacement n, t and stress xx, zz, xz for waves q > 0.

    Both the traction and the displacement of the surface, shape (2, m), are needed for rounding errors to stay small:
    the displacement of a thin incompressible layer determines its pressure badly, the tractions on a deep one its base.
    """
    ratio = known_poisson_ratio(body)
    shear_modulus = body.contact_modulus * (1 - ratio) / 2
    turned = np.array([[-1j], [1]])
    out = np.empty((4, depths.size, wavenumber.size), complex)
    thin = wavenumber * body.base_depth < THIN
    loads, moved = turned * traction / (shear_modulus * wavenumber), turned * surface
    out[:, :, thin] = _from_base(wavenumber[thin], loads[:, thin], depths, body.base_depth, ratio)
    out[:, :, ~thin] = _decaying(wavenumber[~thin], moved[:, ~thin], depths, body.base_depth, ratio)
    p, along, normal, shear = out
    strain = 1j * wavenumber * along
    normal, shear = 1j * shear_modulus * wavenumber * normal, shear_modulus * wavenumber * shear
    return np.stack([1j * p, along, (ratio * normal + 2 * shear_modulus * strain) / (1 - ratio), normal, shear])


def _decaying(q: Array, start: Array, depths: Array, base: float, ratio: float) -> Array:
    """Return p, u_t, σ_zz/i and σ_xz in μq, shape (4, depth, m): a wave from the surface less its image in the base."""
    r = 1 / (3 - 4 * ratio)
    x = np.minimum(q * base, MAX_DEPTH)
    decay = np.exp(-2 * x)
    p, along = start
    lost, turn = -np.expm1(-2 * x) - 2 * decay * (x * r) ** 2, 2 * decay * x * r
    first = np.stack([(lost + turn) * p + turn * x * r * along, turn * x * r * p + (lost - turn) * along])
    first /= determinant(x, ratio)
    image = -np.exp(-x) * (first + np.stack([x, -x]) * (r * first.sum(0)))
    down = _wave(np.minimum(np.outer(depths, q), MAX_DEPTH), first, ratio)
    up = _wave(np.minimum(np.outer(np.maximum(base - depths, 0.0), q), MAX_DEPTH), image * [[-1], [1]], ratio)
    return down + up * np.reshape([-1, 1, 1, -1], (4, 1, 1))


def _wave(y: Array, start: Array, ratio: float) -> Array:
    """Return the same for a wave that decays over y = qd, shape (depth, m), from p and u_t in `start`, shape (2, m)."""
    p, along = start
    slope = (along + p) / (3 - 4 * ratio)
    bent = slope * y
    normal, shear = 2 * (p - (1 - 2 * ratio) * slope + bent), along - p + slope - 2 * bent
    return np.exp(-y) * np.stack([p + bent, along - bent, normal, shear])


def _from_base(q: Array, loads: Array, depths: Array, base: float, ratio: float) -> Array:
    """Return the same, shape (4, depth, m), from σ_zz/i and σ_xz in μq of the surface, shape (2, m), via the base."""
    r = 1 / (3 - 4 * ratio)
    x, y = q * base, np.outer(base - depths, q)
    (nn, nt), (tn, tt) = _stresses(x, ratio)
    normal, shear = loads
    root = np.stack([tt * normal - nt * shear, nn * shear - tn * normal])
    p, along = root / ((1 + r) ** 2 + 4 * r * np.sinh(x) ** 2 + 4 * (r * x) ** 2)
    sinh, cosh = np.sinh(y), np.cosh(y)
    bent, cross = cosh_less_sinh(y) * np.exp(y) / 2, r * y * sinh
    lifted = 2 * (1 - 2 * ratio) * r * y * cosh - bent  # sinh y - r y cosh y
    moved = lifted * p - cross * along, cross * p + (sinh + r * y * cosh) * along
    (nn, nt), (tn, tt) = _stresses(y, ratio)
    return np.stack([*moved, nn * p + nt * along, tn * p + tt * along])


def _stresses(y: Array, ratio: float) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Return the factors that give σ_zz/i, and σ_xz, at y above the base from the state of the base."""
    r, omega = 1 / (3 - 4 * ratio), 2 * (1 - 2 * ratio) / (3 - 4 * ratio)
    sinh, cosh = np.sinh(y), np.cosh(y)
    even, odd = 2 * r * y * sinh, 2 * r * y * cosh
    return ((1 + r) * cosh - even, -omega * sinh - odd), (odd - omega * sinh, (1 + r) * cosh + even)
