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

In plane strain σ_xx = (ν σ_zz + 2μ ∂u_t/∂x)/(1-ν). The mean stress is uniform; a uniform strain along x is excluded.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.elasticity import Elasticity, relative_compliance
from contactsim.errors import SceneError
from contactsim.grid import Array, Grid
from contactsim.plane_strain import DEEP, cosh_less_sinh, determinant

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

    @property
    def largest_shear(self) -> Array:
        """Largest shear stress in the plane, (depth, n), GPa."""
        along, normal, shear = np.moveaxis(self.stress, 1, 0)
        return np.hypot((along - normal) / 2, shear)


def inside(body: Elasticity, grid: Grid, traction: Array, depths: Array) -> Fields:
    """Fields under tractions on the surface of the lower body, which is a half-space or a layer on a rigid base.

    traction: (1, n), normal alone, or (2, n), normal and along x, GPa; positive pulls the body up and along x, so a
    pressure is negative. depths: (depth,), nm, from 0 to the thickness. The mean displacement of a half-space is zero.
    An upper body is a lower one upside down: give (T_n, -T_t) and read -u_n and -σ_xz.
    """
    depths, traction = np.atleast_1d(np.asarray(depths, float)), np.asarray(traction, float)
    if not (depths >= 0).all() or not (depths <= body.base_depth).all():
        raise SceneError("depths", depths, f"from 0 to {body.base_depth:g} nm")
    if traction.ndim != 2 or traction.shape[0] > 2 or traction.shape[1:] != grid.shape:
        raise SceneError("traction", traction, f"(1, {grid.shape[0]}) or (2, {grid.shape[0]}): components on this line")
    both = np.zeros((2, *grid.shape))
    both[: len(traction)] = traction
    tractions = np.stack([grid.forward(row) for row in both])
    compliance = relative_compliance(body, None, grid, ("n", "t"))
    surface = compliance.apply(tractions)
    waves = _waves(body, grid.wavenumber[1:], surface[:, 1:], depths)
    coefficients = np.empty((depths.size, 5, *grid.half_shape), complex)
    coefficients[:, :, 1:] = np.moveaxis(waves, 0, 1)
    coefficients[:, :, 0] = _mean(body, tractions[:, 0].real, surface[:, 0].real, depths)
    values = np.stack([grid.backward(row) for row in coefficients.reshape(-1, *grid.half_shape)])
    values = values.reshape(depths.size, 5, *grid.shape)
    return Fields(grid.positions(), depths, values[:, :2], values[:, 2:])


def _mean(body: Elasticity, traction: Array, surface: Array, depths: Array) -> Array:
    """Mean displacement and stress at each depth, (depth, 5)."""
    left = np.ones_like(depths) if np.isinf(body.base_depth) else 1 - depths / body.base_depth
    normal, shear = traction
    side = body.poisson_ratio / (1 - body.poisson_ratio) * normal
    return np.column_stack([surface[0] * left, surface[1] * left, *np.outer([side, normal, shear], np.ones_like(left))])


def _waves(body: Elasticity, wavenumber: Array, surface: Array, depths: Array) -> Array:
    """Coefficients (5, depth, m): displacement n, t, stress xx, zz, xz, of waves q > 0 from the surface's (2, m)."""
    ratio = body.poisson_ratio
    start = np.stack([-1j * surface[0], surface[1]])  # p and u_t
    out = np.empty((4, depths.size, wavenumber.size), complex)
    thin = wavenumber * body.base_depth < THIN
    carry = {True: _from_base, False: _decaying}
    for is_thin, method in carry.items():
        chosen = thin == is_thin
        q = wavenumber[chosen]
        out[:, :, chosen] = method(q, start[:, chosen], depths, body.base_depth, ratio)
    shear_modulus = body.contact_modulus * (1 - ratio) / 2
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


def _from_base(q: Array, start: Array, depths: Array, base: float, ratio: float) -> Array:
    """The same, (4, depth, m), carried up from the base; its displacement gradient there follows from the surface."""
    r, omega = 1 / (3 - 4 * ratio), 2 * (1 - 2 * ratio) / (3 - 4 * ratio)
    x = q * base
    (nn, cross), (_, tt) = _lift(x, r, omega)
    p, along = start
    root = np.stack([tt * p + cross * along, nn * along - cross * p]) * (4 * np.exp(-2 * x) / determinant(x, ratio))
    y = np.outer(base - depths, q)
    (nn, cross), (_, tt) = _lift(y, r, omega)
    sinh, cosh = np.sinh(y), np.cosh(y)
    p, along = root
    normal = p * ((1 + r) * cosh - 2 * r * y * sinh) - along * (omega * sinh + 2 * r * y * cosh)
    shear = along * ((1 + r) * cosh + 2 * r * y * sinh) + p * (2 * r * y * cosh - omega * sinh)
    return np.stack([nn * p - cross * along, cross * p + tt * along, normal, shear])


def _lift(y: Array, r: float, omega: float) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """What takes p and u_t of the base to displacement: sinh y ∓ r y cosh y, and across r y sinh y."""
    sinh, cosh = np.sinh(y), np.cosh(y)
    normal = omega * y * cosh - cosh_less_sinh(y) * np.exp(y) / 2
    cross = r * y * sinh
    return (normal, cross), (cross, sinh + r * y * cosh)
