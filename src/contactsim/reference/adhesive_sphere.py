"""Exact answers for an adhesive sphere on a half-space: JKR, DMT, and Maugis between them.

Forces are in nN with lengths in nm and moduli in GPa; compression is positive.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array

DUGDALE_ZONES = (1e-12, 1e6, 8001)
"""Least and largest m - 1, m the radius of Dugdale's zone over that of the contact, and their number."""


def jkr_force(contact_radius: Array | float, work: float, radius: float, contact_modulus: float) -> Array:
    """Return the force 4E*a³/(3R) - √(8πwE*a³) at a contact radius a (Proc. R. Soc. Lond. A 324, 301, 1971)."""
    cube = np.asarray(contact_radius, float) ** 3
    return 4 * contact_modulus * cube / (3 * radius) - np.sqrt(8 * np.pi * work * contact_modulus * cube)


def jkr_approach(contact_radius: Array | float, work: float, radius: float, contact_modulus: float) -> Array:
    """Return the approach a²/R - √(2πwa/E*), nm, at a contact radius a, nm."""
    size = np.asarray(contact_radius, float)
    return size**2 / radius - np.sqrt(2 * np.pi * work * size / contact_modulus)


def jkr_pull_off(work: float, radius: float) -> float:
    """Return the pull-off 3πwR/2 of short-ranged adhesion on a soft body, nN."""
    return 1.5 * np.pi * work * radius


def dmt_pull_off(work: float, radius: float) -> float:
    """Return the pull-off 2πwR of long-ranged adhesion on a stiff body, nN; that of a rigid sphere (Bradley)."""
    return 2 * np.pi * work * radius


def maugis_parameter(work: float, radius: float, contact_modulus: float, strength: float) -> float:
    """Return Maugis's parameter λ = 2σ (R/(πwK²))^(1/3), K = 4E*/3: below 0.1 DMT holds, above 5 JKR.

    Parameters
    ----------
    work
        Work of adhesion w, N/m.
    radius
        Radius R, nm.
    contact_modulus
        E*, GPa.
    strength
        Largest attraction σ, GPa.

    Notes
    -----
    With the length w/σ of the law in place of the equilibrium distance, Tabor's parameter (Rw²/(E*²z³))^(1/3) is
    0.89 λ (Maugis, J. Colloid Interface Sci. 150, 243, 1992, doi:10.1016/0021-9797(92)90285-T).
    """
    stiffness = 4 * contact_modulus / 3
    return float(2 * strength * np.cbrt(radius / (np.pi * work * stiffness**2)))


def maugis_states(work: float, radius: float, contact_modulus: float, strength: float) -> tuple[Array, Array, Array]:
    """Return contact radius (nm), force (nN) and approach (nm) of states by the model of Maugis and Dugdale.

    The states are those of all ratios m of the radii of Dugdale's zone and of the contact, from the largest contact
    on; parameters as of `maugis_parameter`.
    """
    stiffness, size = 4 * contact_modulus / 3, maugis_parameter(work, radius, contact_modulus, strength)
    m = 1 + np.geomspace(*DUGDALE_ZONES)
    root = np.sqrt(m**2 - 1)
    angle = np.arctan(root)
    undeformed = size / 2 * (root + (m**2 - 2) * angle)
    elastic = 4 * size**2 / 3 * (root * angle - m + 1)
    contact = 2 / (elastic + np.sqrt(elastic**2 + 4 * undeformed))  # of undeformed a² + elastic a = 1
    force = contact**3 - size * contact**2 * (root + m**2 * angle)
    approach = contact**2 - 4 / 3 * size * contact * root
    length = np.cbrt(np.pi * work * radius**2 / stiffness)
    return contact * length, force * np.pi * work * radius, approach * length**2 / radius


def maugis_pull_off(work: float, radius: float, contact_modulus: float, strength: float) -> float:
    """Return the pull-off by the model of Maugis and Dugdale, nN; parameters as of `maugis_parameter`."""
    return float(-maugis_states(work, radius, contact_modulus, strength)[1].min())
