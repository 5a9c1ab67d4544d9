"""Displacement and stress inside an elastic body, from the tractions on its surface (Section 2.2).

Where a wave decays before it meets the base, the field is a part that decays downwards and one that decays upwards from
the base; each is known in closed form. Where it does not, x = qh below `THIN`, these two cancel, and the field is
carried up from the base instead, where displacement is zero, by functions without cancellation. Stress follows without
derivatives, and without C11, so that ν may be 1/2.

With u_n = i p and everything in units of μq, a wave that decays downwards from displacement (p, u_t) at the surface is
at depth d, with y = qd, r = 1/(3-4ν) and β = r(u_t + p),

    p + βy,   u_t - βy,   σ_zz = 2i (p - (1-2ν)β + βy),   σ_xz = u_t - p + β - 2βy,   all times e^{-y},

and one that decays upwards is its mirror image. Their difference, from the same displacement of the base, vanishes
there and is, up to a factor of two and with y = qz counted from the base,

    p:    p (sinh y - r y cosh y) - u_t r y sinh y
    u_t:  p r y sinh y + u_t (sinh y + r y cosh y)
    σ_zz: i (p [(1+r) cosh y - 2 r y sinh y] - u_t [(1-r) sinh y + 2 r y cosh y])
    σ_xz: u_t [(1+r) cosh y + 2 r y sinh y] + p [2 r y cosh y - (1-r) sinh y].

In plane strain σ_xx = (ν σ_zz + 2μ ∂u_t/∂x)/(1-ν). The mean stress is uniform, the mean strain along x none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.elasticity.plane_strain import DEEP, cosh_less_sinh, determinant
from contactsim.elasticity.solids import Elasticity, relative_compliance
from contactsim.errors import InputError
from contactsim.grid import Array, Grid

THIN = 1.0
"""|q|h below which fields are carried up from the base."""


@dataclass(frozen=True)
class Fields:
    """What happens inside a body with its surface on top.

    position: (n,), nm; depth: below the surface, (depth,), nm; displacement: normal, up, and along x, (depth, 2, n),
    nm; stress: σ_xx, σ_zz, σ_xz, tension positive, (depth, 3, n), GPa.
    """

    position: Array
    depth: Array
    displacement: Array
    stress: Array

    def between(self, left: float, right: float) -> Fields:
        """The part from one position to another (nm)."""
        shown = (self.position >= left) & (self.position <= right)
        return Fields(self.position[shown], self.depth, self.displacement[..., shown], self.stress[..., shown])

    @property
    def largest_shear(self) -> Array:
        """Largest shear stress in the plane, (depth, n), GPa."""
        along, normal, shear = np.moveaxis(self.stress, 1, 0)
        return np.hypot((along - normal) / 2, shear)


def inside(body: Elasticity, grid: Grid, traction: Array, depths: Array) -> Fields:
    """Fields under tractions on the surface of the lower body, which is a half-space or a layer on a rigid base.

    traction: (1, n), normal alone, or (2, n), normal and along x, GPa; positive pulls the body up and along x, so a
    pressure is negative. depths: (depth,), nm, from 0 to the thickness. On the surface of a half-space the mean
    displacement is zero. An upper body is a lower one upside down: give (T_n, -T_t) and read -u_n and -σ_xz.
    """
    depths, traction = np.atleast_1d(np.asarray(depths, float)), np.asarray(traction, float)
    if not (depths >= 0).all() or not (depths <= body.base_depth).all():
        raise InputError("depths", depths, f"from 0 to {body.base_depth:g} nm")
    if traction.ndim != 2 or traction.shape[0] > 2 or traction.shape[1:] != grid.shape:
        raise InputError("traction", traction, f"(1, {grid.shape[0]}) or (2, {grid.shape[0]}): components on this line")
    both = np.zeros((2, *grid.shape))
    both[: len(traction)] = traction
    tractions = np.stack([grid.forward(row) for row in both])
    surface = relative_compliance(body, None, grid, ("n", "t")).apply(tractions)
    waves = _waves(body, grid.wavenumber[1:], tractions[:, 1:], surface[:, 1:], depths)
    coefficients = np.empty((depths.size, 5, *grid.half_shape), complex)
    coefficients[:, :, 1:] = np.moveaxis(waves, 0, 1)
    coefficients[:, :, 0] = _mean(body, tractions[:, 0].real, surface[:, 0].real, depths)
    values = np.stack([grid.backward(row) for row in coefficients.reshape(-1, *grid.half_shape)])
    values = values.reshape(depths.size, 5, *grid.shape)
    return Fields(grid.positions(), depths, values[:, :2], values[:, 2:])


def _mean(body: Elasticity, traction: Array, surface: Array, depths: Array) -> Array:
    """Mean displacement and stress at each depth, (depth, 5)."""
    ratio = body.poisson_ratio
    flexibility = np.array([(1 - 2 * ratio) / (1 - ratio) ** 2, 2 / (1 - ratio)]) / body.contact_modulus
    displacement = surface - np.outer(depths, traction * flexibility)
    stress = np.array([ratio / (1 - ratio) * traction[0], *traction])
    return np.hstack([displacement, np.tile(stress, (depths.size, 1))])


def _waves(body: Elasticity, wavenumber: Array, traction: Array, surface: Array, depths: Array) -> Array:
    """Coefficients (5, depth, m): displacement n, t, stress xx, zz, xz, of waves q > 0.

    traction, surface: both known at the surface, (2, m), since either follows from the other: the displacements of a
    thin incompressible layer say little of its pressure, the tractions on a deep one nothing of its base.
    """
    ratio = body.poisson_ratio
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
    """p, u_t, σ_zz/i and σ_xz in μq, (4, depth, m): a wave from the surface less its image in the base."""
    r = 1 / (3 - 4 * ratio)
    x = np.minimum(q * base, DEEP)
    decay = np.exp(-2 * x)
    p, along = start
    lost, turn = -np.expm1(-2 * x) - 2 * decay * (x * r) ** 2, 2 * decay * x * r
    first = np.stack([(lost + turn) * p + turn * x * r * along, turn * x * r * p + (lost - turn) * along])
    first /= determinant(x, ratio)
    image = -np.exp(-x) * (first + np.stack([x, -x]) * (r * first.sum(0)))
    down = _wave(np.minimum(np.outer(depths, q), DEEP), first, ratio)
    up = _wave(np.minimum(np.outer(np.maximum(base - depths, 0.0), q), DEEP), image * [[-1], [1]], ratio)
    return down + up * np.reshape([-1, 1, 1, -1], (4, 1, 1))


def _wave(y: Array, start: Array, ratio: float) -> Array:
    """The same of a wave that decays over y = qd, (depth, m), from p and u_t in `start`, (2, m)."""
    p, along = start
    slope = (along + p) / (3 - 4 * ratio)
    bent = slope * y
    normal, shear = 2 * (p - (1 - 2 * ratio) * slope + bent), along - p + slope - 2 * bent
    return np.exp(-y) * np.stack([p + bent, along - bent, normal, shear])


def _from_base(q: Array, loads: Array, depths: Array, base: float, ratio: float) -> Array:
    """The same, (4, depth, m), from σ_zz/i and σ_xz in μq of the surface, (2, m), by what the base then does."""
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
    """What takes the base to σ_zz/i, and to σ_xz."""
    r, omega = 1 / (3 - 4 * ratio), 2 * (1 - 2 * ratio) / (3 - 4 * ratio)
    sinh, cosh = np.sinh(y), np.cosh(y)
    even, odd = 2 * r * y * sinh, 2 * r * y * cosh
    return ((1 + r) * cosh - even, -omega * sinh - odd), (odd - omega * sinh, (1 + r) * cosh + even)
