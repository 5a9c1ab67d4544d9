"""Exact answers with adhesion: pull-off of a cylinder, its contact under shear, and the strengths of cohesive zones."""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array
from contactsim.reference.hard_wall import cylinder_load

DUGDALE_ZONES = (1e-6, 1e8, 20001)
"""Least and largest m - 1, m the width of Dugdale's zone over that of the contact, and their number."""


def cylinder_pull_off(work: Array | float, radius: float, contact_modulus: float) -> Array:
    """Pull-off 3 (π E* w² R/16)^(1/3) of an adhesive cylinder in the limit of JKR; N/m, nm, GPa to N/m.

    Hertz's load less that of a crack whose energy release rate P²/(2π c E*) is the work w,
    L = π E* c²/(4R) - √(2π E* w c), is least at c³ = 2wR²/(π E*) (Barquins, J. Adhesion 26, 1988).
    """
    return 3 * (np.pi * contact_modulus * np.asarray(work) ** 2 * radius / 16) ** (1 / 3)


def maugis_cylinder_pull_off(work: Array | float, radius: float, contact_modulus: float, strength: float) -> Array:
    """Pull-off of a cylinder on a half-space by the model of Maugis and Dugdale; N/m, nm, GPa to N/m.

    Around the contact |x| < c the traction is the strength σ up to |x| = mc, where the gap is w/σ:

        w/σ = c²/(2R) (m √(m²-1) - arcosh m) + 4σc/(πE*) (√(m²-1) arcosh m - m ln m),

    and the load is πE*c²/(4R) - 2σc √(m²-1). For each m the first is quadratic in c; the pull-off is the largest pull
    over m (Baney and Hui, J. Adhesion Sci. Technol. 11, 1997; Johnson and Greenwood, J. Phys. D 41, 2008). Its limits
    are `cylinder_pull_off` for high strength and 2σ √(2Rw/σ) of rigid bodies.
    """
    m = 1 + np.geomspace(*DUGDALE_ZONES)
    root, angle = np.sqrt(m**2 - 1), np.arccosh(m)
    undeformed = (m * root - angle) / (2 * radius)
    elastic = 4 * strength / (np.pi * contact_modulus) * (root * angle - m * np.log(m))
    opening = np.asarray(work)[..., None] / strength
    half_width = 2 * opening / (elastic + np.sqrt(elastic**2 + 4 * undeformed * opening))
    pull = 2 * strength * half_width * root - cylinder_load(half_width, radius, contact_modulus)
    return pull.max(-1)


def sheared_half_width(
    load: Array | float, tangential_force: Array | float, work: float, radius: float, contact_modulus: float
) -> Array:
    """Return the half-width (nm) of an adhesive cylinder on a half-space that carries a tangential force.

    Parameters
    ----------
    load, tangential_force
        Load P, compression positive, and tangential force F, N/m, of one shape.
    work
        Work of separation w, N/m.
    radius
        Radius R, nm.
    contact_modulus
        E*, GPa.

    Returns
    -------
    The stable half-width a, NaN where there is none.

    Notes
    -----
    (π E* a²/(4R) - P)² + F² = 2π E* w a: a crack whose energy release rate, that of both modes, is the work. It is the
    line's form of Savkoor and Briggs (1977, doi:10.1098/rspa.1977.0123), without friction in the crack. Without F it is
    `cylinder_pull_off`'s contact.
    """
    curvature = np.pi * contact_modulus / (4 * radius)
    forces = np.broadcast_arrays(np.asarray(load, float), np.asarray(tangential_force, float))

    def largest_root(normal: float, tangential: float) -> float:
        """Return the largest real half-width, NaN where there is none."""
        terms = [curvature**2, 0.0, -2 * curvature * normal, -2 * np.pi * contact_modulus * work]
        roots = np.roots([*terms, normal**2 + tangential**2])
        real = roots.real[(abs(roots.imag) <= 1e-6 * abs(roots)) & (roots.real > 0)]
        return float(real.max()) if real.size else np.nan

    values = [largest_root(*pair) for pair in zip(*(force.ravel() for force in forces), strict=True)]
    return np.reshape(values, forces[0].shape)


def rigid_cylinder_pull_off(work: Array | float, radius: float, length: float) -> Array:
    """Pull-off w √(2π R/(e δ)) of a rigid cylinder by the exponential cohesive zone; N/m, nm to N/m.

    Over the gap g + x²/(2R) the traction w y e^(-y)/δ, y the gap over δ, amounts to w √(2π R/δ) (g/δ + 1/2) e^(-g/δ),
    which is largest at g = δ/2: what Bradley's limit is for a sphere. Nothing moves, so nothing slips.
    """
    return np.asarray(work) * np.sqrt(2 * np.pi * radius / (np.e * length))


def normal_strength(work: float, length: float, slip: Array | float) -> Array:
    """Largest normal traction φn/(e δn) exp(-s²) of the mixed-mode cohesive zone at s = Δt/δt (Eq. 2.18); GPa."""
    return work / (np.e * length) * np.exp(-(np.asarray(slip) ** 2))


def tangential_strength(work: float, length: float, opening: Array | float) -> Array:
    """Largest tangential traction √(2/e) φt/δt exp(-y) of the mixed-mode cohesive zone at y = Δn/δn (Eq. 2.18); GPa."""
    return np.sqrt(2 / np.e) * work / length * np.exp(-np.asarray(opening))


def xu_needleman_normal(opening: Array | float, slip: Array | float, work_ratio: float) -> Array:
    """Normal traction of Xu and Needleman's law with r = 0 over φn/δn, at y = Δn/δn, s = Δt/δt and c = φt/φn.

    It is y exp(-y) (1 - c + c exp(-s²)), the derivative of their potential. Complete shear leaves 1 - c of it, nothing
    for c = 1 alone (van den Bosch et al., Eng. Fract. Mech. 73, 2006).
    """
    opening = np.asarray(opening)
    return opening * np.exp(-opening) * (1 - work_ratio + work_ratio * np.exp(-(np.asarray(slip) ** 2)))


def bsg_factor(opening: Array | float) -> Array:
    """Tangential traction of the BSG law over that of Eq. 2.17, 1 + y at y = Δn/δn.

    The strength of that law is proportional to (1 + y) exp(-y): largest at Δn = 0, zero at an overclosure of δn, and
    negative beyond (van den Bosch et al., Eng. Fract. Mech. 73, 2006; McGarry et al., J. Mech. Phys. Solids
    63, 2014).
    """
    return 1 + np.asarray(opening)
