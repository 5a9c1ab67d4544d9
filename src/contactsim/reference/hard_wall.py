"""Exact answers without adhesion, on a half-space: Hertz, parallel cylinders, Westergaard, complete contact."""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array, Grid
from contactsim.reference.persson import persson_area


def cylinder_load(half_width: Array | float, radius: float, contact_modulus: float) -> Array:
    """Line load π E* c²/(4R) that gives contact half-width c (Eq. 3.5); nm, GPa to N/m."""
    return np.pi * contact_modulus * np.asarray(half_width) ** 2 / (4 * radius)


def cylinder_pressure(position: Array | float, half_width: float, radius: float, contact_modulus: float) -> Array:
    """Hertz's pressure E*/(2R) √(c² - x²), zero outside; nm, GPa (Johnson 1985, doi:10.1017/CBO9781139171731)."""
    inside = np.maximum(half_width**2 - np.asarray(position) ** 2, 0.0)
    return contact_modulus / (2 * radius) * np.sqrt(inside)


def cylinder_stress_on_axis(depth: Array | float, half_width: float, peak_pressure: float) -> tuple[Array, Array]:
    """Stresses σ_xx and σ_zz on the axis below a cylinder's contact; nm, GPa (Johnson 1985, Eq. 4.46).

    Their difference is largest at depth 0.786 c, where the shear is 0.300 of the peak pressure.
    """
    z, root = np.asarray(depth), np.hypot(half_width, depth)
    along = -peak_pressure / half_width * ((half_width**2 + 2 * z**2) / root - 2 * z)
    return along, -peak_pressure * half_width / root


def cylinder_rms_gradient(half_width: Array | float, radius: float) -> Array:
    """Rms gradient c/(R√3) over the contact of a cylinder (Eq. 3.6)."""
    return np.asarray(half_width) / (radius * np.sqrt(3))


def cylinder_array_load(half_width: Array | float, radius: float, period: float, contact_modulus: float) -> Array:
    """Return the line load per period, N/m, at which parallel cylinders touch over the half-width c.

    Parameters
    ----------
    half_width
        Half-width c of each contact, nm; less than half the period.
    radius
        Radius R of the parabolic cylinders, nm.
    period
        Distance L of their axes, nm.
    contact_modulus
        E*, GPa.

    Notes
    -----
    P = E* L²/(2πR) ln sec(πc/L). For c ≪ L it is the load of one cylinder; at a given load the half-width is smaller
    than that of one cylinder by the part π²c²/(12 L²) to the lowest order. It follows from the slope x/R over a contact
    of a periodic half-space, whose kernel is the cotangent (Johnson 1985, Sec. 13.2, doi:10.1017/CBO9781139171731).
    """
    phase = np.pi * np.asarray(half_width) / period
    return -contact_modulus * period**2 / (4 * np.pi * radius) * np.log1p(-(np.sin(phase) ** 2))


def cylinder_array_half_width(load: Array | float, radius: float, period: float, contact_modulus: float) -> Array:
    """Return the half-width, nm, at which parallel cylinders touch under a line load per period, N/m."""
    decay = 2 * np.pi * radius * np.asarray(load) / (contact_modulus * period**2)
    return period / np.pi * np.arctan(np.sqrt(np.expm1(2 * decay)))


CYLINDER_KAPPA_R = 8 / (np.pi * np.sqrt(3))
"""Proportionality of area and reduced pressure for a cylinder, 1.470 (Eq. 3.7)."""


def sphere_load(contact_radius: Array | float, radius: float, contact_modulus: float) -> Array:
    """Load 4E*c³/(3R) that gives contact radius c (Hertz; Table 3.1); nm, GPa to nN."""
    return 4 * contact_modulus * np.asarray(contact_radius) ** 3 / (3 * radius)


def sphere_pressure(distance: Array | float, contact_radius: float, radius: float, contact_modulus: float) -> Array:
    """Hertz's pressure 2E*/(πR) √(c² - r²) at a distance from the centre, zero outside; nm, GPa."""
    inside = np.maximum(contact_radius**2 - np.asarray(distance) ** 2, 0.0)
    return 2 * contact_modulus / (np.pi * radius) * np.sqrt(inside)


def sphere_rms_gradient(contact_radius: Array | float, radius: float) -> Array:
    """Rms gradient c/(R√2) over the contact of a sphere (Table 3.1)."""
    return np.asarray(contact_radius) / (radius * np.sqrt(2))


SPHERE_KAPPA_R = 3 * np.pi / (4 * np.sqrt(2))
"""Proportionality of area and reduced pressure for a sphere, 1.666 (Table 3.1)."""


def full_contact_pressure(amplitude: float, length: float, contact_modulus: float) -> float:
    """Mean pressure π E* h₀/L above which a sinusoid of amplitude h₀ is in complete contact (Westergaard 1939)."""
    return np.pi * contact_modulus * amplitude / length


def sinusoid_area(pressure_ratio: Array | float) -> Array:
    """Relative contact area (2/π) asin √(p/p_c) of a sinusoid at p/p_c ≤ 1 (Westergaard 1939)."""
    return 2 / np.pi * np.arcsin(np.sqrt(np.clip(pressure_ratio, 0.0, 1.0)))


def sinusoid_mean_gap(pressure_ratio: Array | float, amplitude: float) -> Array:
    """Mean gap h₀(1 - r + r ln r) of a sinusoid of amplitude h₀ at r = p/p_c, 0 < r ≤ 1 (Westergaard 1939); nm."""
    ratio = np.asarray(pressure_ratio)
    return amplitude * (1 - ratio + ratio * np.log(ratio))


def sinusoid_pressure(phase: Array | float, pressure_ratio: float, mean_pressure: float) -> Array:
    """Pressure 2p cos φ √(r - sin²φ)/r at φ = πx/λ from a crest, zero where sin²φ > r (Westergaard 1939); GPa."""
    inside = np.maximum(pressure_ratio - np.sin(phase) ** 2, 0.0)
    return 2 * mean_pressure / pressure_ratio * np.abs(np.cos(phase)) * np.sqrt(inside)


def complete_contact(heights: Array, length: float, contact_modulus: float) -> Array:
    """Pressure E*|q|h/2, with zero mean, that flattens heights (n,) out completely; nm, GPa.

    A mean pressure of at least minus its least value keeps every point in contact.
    """
    grid = Grid((len(heights),), (length,))
    return grid.backward(grid.forward(heights) * (contact_modulus * grid.wavenumber / 2))


def uniaxial_modulus(youngs_modulus: float, poisson_ratio: float) -> float:
    """Stiffness C11 = E(1-ν)/((1+ν)(1-2ν)) of a body that cannot expand sideways, GPa; infinite at ν = 1/2."""
    if poisson_ratio == 0.5:
        return np.inf
    return youngs_modulus * (1 - poisson_ratio) / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))


def body_compression(pressure: Array | float, height: float, youngs_modulus: float, poisson_ratio: float) -> Array:
    """Approach p h/C11 (nm) that a body of a height takes up under a mean pressure, beside that of a half-space.

    This is all that a finite height changes if it is at least the period: there the compliance of the longest wave
    differs from that of a half-space by 0.05 %, at half the period by 8 %.
    """
    return np.asarray(pressure) * height / uniaxial_modulus(youngs_modulus, poisson_ratio)


def line_area(reduced_pressure: Array | float, b1: float, b2: float) -> Array:
    """Relative contact area erf(√2 p*/Ψ), Ψ = b1 + (1 - b1) erf(b2 p*), of a rough line (Eq. 3.11)."""
    pressure = np.asarray(reduced_pressure)
    from scipy.special import erf

    return persson_area(pressure / (b1 + (1 - b1) * erf(b2 * pressure)))
