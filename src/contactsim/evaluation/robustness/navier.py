"""The compliance of elastic bodies by Navier's equations, wave by wave: no formula of `contactsim.elasticity`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.grid import Array

DEEP = 40.0
"""|q|h from which on a layer is a half-space to all digits."""


def surface_compliance(body: Elasticity, q: Array) -> Array:
    """Displacement per traction, normal and along x, of a body from below, at q ≥ 0 (m,), complex, (m, 2, 2), nm/GPa.

    With φ = (a + b e^{-2qz}…) and ψ harmonic, u = ∇(φ + zψ) - 4(1-ν) ψ e_z solves Navier's equations; its amplitudes
    e^{qz} and e^{-q(z+h)} are found, wave by wave, from no displacement at depth h and the tractions at z = 0.
    """
    ratio = body.poisson_ratio
    assert ratio is not None, "tangential displacements need one"
    shear = body.contact_modulus * (1 - ratio) / 2
    waves = np.empty((q.size, 2, 2), complex)
    waves[0] = np.diag(UNIFORM[type(body)](body.base_depth, ratio, shear))
    deep = np.minimum(q[1:] * body.base_depth, DEEP)
    decay = np.exp(-deep)

    def state(z: Array, harmonic: Array, sign: int) -> list[tuple[Array, ...]]:
        """For φ and for ψ, with qz and the harmonic there: u_n, u_t/i, and the tractions σ_zz/2μq, σ_xz/2μqi."""
        k = 3 - 4 * ratio
        phi = sign * harmonic, harmonic, harmonic, sign * harmonic
        psi = (
            (sign * z - k) * harmonic,
            z * harmonic,
            (z - 2 * (1 - ratio) * sign) * harmonic,
            (sign * z + (1 - k) / 2) * harmonic,
        )
        return [phi, psi]

    unity, zero = np.ones_like(deep), np.zeros_like(deep)
    top: Array = np.array(state(zero, unity, 1) + state(zero, decay, -1)).transpose(2, 1, 0)
    base: Array = np.array(state(-deep, decay, 1) + state(-deep, unity, -1)).transpose(2, 1, 0)
    system = np.concatenate([base[:, :2], top[:, 2:]], axis=1)
    amplitudes = np.linalg.solve(system, np.broadcast_to(np.eye(4)[:, 2:], (deep.size, 4, 2)))
    displacement = (top[:, :2] @ amplitudes) / (2 * shear * q[1:, None, None])
    waves[1:] = displacement * np.array([[1, -1j], [1j, 1]])
    return waves


UNIFORM: dict[type, Callable[..., tuple[float, float]]] = {
    HalfSpace: lambda *_: (0.0, 0.0),
    Layer: lambda depth, ratio, shear: (depth * (1 - 2 * ratio) / (2 * shear * (1 - ratio)), depth / shear),
}
"""Displacement per uniform traction, normal and along x; zero where the mean does not move, or is free."""
