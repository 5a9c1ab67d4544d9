"""Exact answers of flats joined by springs on a lattice: sums over sites, and a slide of one degree of freedom."""

from __future__ import annotations

import numpy as np

from contactsim.grid import Array


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
