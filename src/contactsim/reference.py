"""Exact answers, for tests and figures alike.

Line contacts without adhesion on a half-space: a parabolic cylinder (Hertz), a sinusoid (Westergaard), and the
complete contact of any profile; Persson's estimate of the contact area of rough surfaces. With adhesion: the pull-off
of a cylinder in its two limits and between them, and the strengths of the mixed-mode cohesive zone. Loads are per unit
thickness; units nm, GPa, N/m, in which E* times a length is a line load without further factors.
"""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array, Grid

DUGDALE_ZONES = (1e-6, 1e8, 20001)
"""Least and largest m - 1, m the width of Dugdale's zone over that of the contact, and their number."""


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


def persson_area(reduced_pressure: Array | float) -> Array:
    """Relative contact area erf(√2 p*) of a rough surface (J. Chem. Phys. 115, 3840, doi:10.1063/1.1388626)."""
    from scipy.special import erf  # takes longer to import than most of this package

    return erf(np.sqrt(2) * np.asarray(reduced_pressure))


def line_area(reduced_pressure: Array | float, b1: float, b2: float) -> Array:
    """Relative contact area erf(√2 p*/Ψ), Ψ = b1 + (1 - b1) erf(b2 p*), of a rough line (Eq. 3.11)."""
    pressure = np.asarray(reduced_pressure)
    from scipy.special import erf

    return persson_area(pressure / (b1 + (1 - b1) * erf(b2 * pressure)))


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


def spring_sum(offset: Array | float, lattice_constant: float, length: float = 1.0) -> tuple[Array, Array]:
    """Sums over a lattice of what springs contribute, C = Σ exp(-s²) and S = Σ 2s exp(-s²), s = (Δt + jl)/δt.

    offset: Δt of any shape, lattice_constant l and length δt, nm. A flat lattice exerts (φn/δn) y e^{-y} C and
    (φt/δt) e^{-y} S on a site at y = Δn/δn (Eqs 6.2-6.4, all springs).
    """
    offset = np.asarray(offset, float)
    beyond = np.ceil(8 * length / lattice_constant) + 1
    nearest = offset - lattice_constant * np.rint(offset / lattice_constant)
    s = (nearest[..., None] + lattice_constant * np.arange(-beyond, beyond + 1)) / length
    parts = np.exp(-(s**2))
    return parts.sum(-1), (2 * s * parts).sum(-1)


def steepest_fall(lattice_constant: float, length: float = 1.0) -> float:
    """Greatest negative slope of S of `spring_sum` by Δt/δt: flats slip where (φt/δt²) times it exceeds C44/h."""
    places = np.linspace(0.0, lattice_constant, 20001)
    sums = spring_sum(places, lattice_constant, length)[1]
    return float(-np.gradient(sums, places / length).min())


def sticking_stiffness(stiffness: float, strength: float, lattice_constant: float, length: float = 1.0) -> float:
    """Return the initial slope of the shear traction of `uniform_slide`, GPa/nm: body and springs in series.

    For strong springs it is the body's stiffness C44/h.
    """
    step = 1e-6 * length
    springs = strength * float(spring_sum(step, lattice_constant, length)[1]) / step
    return 1 / (1 / stiffness + 1 / springs)


def sine_sum(offset: Array | float, lattice_constant: float, length: float = 1.0) -> Array:
    """Return a sine of the lattice constant whose amplitude is that of S of `spring_sum`: Prandtl and Tomlinson's."""
    amplitude = spring_sum(np.linspace(0.0, lattice_constant, 2001), lattice_constant, length)[1].max()
    return amplitude * np.sin(2 * np.pi * np.asarray(offset) / lattice_constant)


def uniform_slide(
    slides: Array,
    stiffness: float,
    strength: float,
    lattice_constant: float,
    length: float = 1.0,
    sine: bool = False,
) -> Array:
    """Shear traction (slide,), GPa, of a flat layer sliding slowly over a rigid flat lattice: one degree of freedom.

    slides: displacement of its far side, growing from 0, nm; stiffness: C44/h, GPa/nm; strength: φt/δt at Δn = 0, GPa.
    The gap u follows U = u + (φt/δt) S(u) C⁻¹ and slips, overdamped, where U has a maximum in u to the next u that has
    that U. Exact but for rounding: bracketed on a fine grid and refined by bisection. With `sine` S is `sine_sum`, and
    the layer slides by the model of Prandtl and Tomlinson.
    """

    def driven(gap: Array) -> Array:
        """The slide that holds a gap."""
        pull = sine_sum if sine else lambda *place: spring_sum(*place)[1]
        return gap + strength / stiffness * pull(gap, lattice_constant, length)

    slides = np.asarray(slides, float)
    gaps = np.arange(0.0, slides.max() + 2 * lattice_constant, lattice_constant / 4000)
    reached = np.maximum.accumulate(driven(gaps))
    after = np.searchsorted(reached, slides)
    low, high = gaps[np.maximum(after - 1, 0)], gaps[after]
    for _ in range(60):
        middle = (low + high) / 2
        short = driven(middle) < slides
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return stiffness * (slides - high)
