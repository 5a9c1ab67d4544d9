"""Exact answers for contacts that are pressed and then sheared, under Coulomb's law: Cattaneo and Mindlin.

Bodies are two alike half-spaces, and `shear_ratio` is the tangential force over that at which all slides, 0 to 1.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array


def cylinder_stick_ratio(shear_ratio: Array | float) -> Array:
    """Return the half-width of the stick area over that of the contact, √(1 - Q/(μP)), of a cylinder."""
    return np.sqrt(1 - np.asarray(shear_ratio, float))


def sphere_stick_ratio(shear_ratio: Array | float) -> Array:
    """Return the radius of the stick area over that of the contact, (1 - Q/(μP))^(1/3), of a sphere."""
    return np.cbrt(1 - np.asarray(shear_ratio, float))


def sphere_shift(
    shear_ratio: Array | float,
    contact_radius: float,
    radius: float,
    friction_coefficient: float,
    poisson_ratio: float,
) -> Array:
    """Return the tangential displacement of two bodies, one of them a sphere, relative to each other, nm.

    Parameters
    ----------
    shear_ratio
        Q/(μP).
    contact_radius
        Radius a of the contact, nm.
    radius
        Radius R of the sphere, nm.
    friction_coefficient
        μ.
    poisson_ratio
        ν of both bodies.

    Notes
    -----
    δ = 3μP/(8Ga) (2 - ν) (1 - (1 - Q/(μP))^(2/3)) of both bodies (Mindlin, J. Appl. Mech. 16, 259, 1949), here with
    P = 4E*a³/(3R) and E* = G/(1 - ν).
    """
    remaining = sphere_stick_ratio(shear_ratio) ** 2
    return (
        friction_coefficient
        * (2 - poisson_ratio)
        / (2 * (1 - poisson_ratio))
        * contact_radius**2
        / radius
        * (1 - remaining)
    )
