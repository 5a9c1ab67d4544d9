"""Numbers that equations of the thesis give without a simulation, by the names that claims use.

They hold the equations of Chapter 2 as they are printed against the exact answer, and compare the interface law with
others. All are exact: they have no error.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from contactsim.elasticity.half_space import HalfSpace
from contactsim.grid import Array
from contactsim.interface.cohesive_zone import CohesiveZone
from contactsim.reference import adhesion

POISSON_RATIOS = (0.1, 0.3, 0.45)
"""Poisson's ratios of Chapter 4."""
WORK_RATIOS = (0.01, 0.1, 0.5)
"""Tangential over normal works of Chapter 4, other than one."""
DAMPING, TIME_STEP = 1.0, 0.1
"""Damping factor η and pseudo time increment δt of Section 4.2."""
COMPLETE_SHEAR = 5.0
"""Tangential gap over its length at which the law has failed in shear."""
OVERCLOSURES = np.linspace(0.0, 3.0, 7)
"""Overclosures over the normal length at which tangential strengths are compared."""
DEPTHS = (0.1, 1.0, 5.0)
"""Wavenumbers times height at which a body's stiffness is compared."""
INITIAL_GAP = 10.0
"""Gap over its length at which paths begin."""


def modulus_ratio(poisson_ratio: float) -> float:
    """Return s = C44/C11 (Eq. 2.13)."""
    return (1 - 2 * poisson_ratio) / (2 * (1 - poisson_ratio))


def printed_elements(depth: float, poisson_ratio: float) -> Array:
    """Return the elements of Eq. 2.12 in units of C11, (4, 4), in the upper triangle; depth: wavenumber × height."""
    s = modulus_ratio(poisson_ratio)
    r = (1 - s) / (1 + s)
    sinh, cosh = np.sinh(depth), np.cosh(depth)
    denominator = cosh**2 - (r * depth) ** 2 - 1
    along = (1 - r) * (sinh * cosh - r * depth)
    normal = (1 - r) * (sinh * cosh + r * depth)
    cross = (1 - r) / (1 + r) * ((1 - r) * sinh**2 - 2 * (r * depth) ** 2)
    along_through = (1 - r) * (r * depth * cosh - sinh)
    cross_through = (1 - r) * r * depth * sinh
    normal_through = -(1 - r) * (r * depth * cosh + sinh)
    rows = (
        (along, -cross, along_through, -cross_through),
        (0.0, normal, cross_through, normal_through),
        (0.0, 0.0, along, cross),
        (0.0, 0.0, 0.0, normal),
    )
    return np.array(rows) / denominator


def slab_stiffness(elements: Array, is_printed: bool) -> Array:
    """Return the matrix of Eq. 2.11 in units of C11, (4, 4), from the elements of `printed_elements`.

    As printed, all elements off the diagonal are imaginary. As meant, those that join the same component of both
    surfaces, M13 and M24, are real, and M23 has the other sign: a slab is its own mirror image upside down.
    """
    factors = np.full((4, 4), -1j)
    if not is_printed:
        factors[0, 2] = factors[1, 3] = 1.0
        factors[1, 2] = 1j
    upper = np.triu(factors * elements, 1)
    return np.diag(np.diag(elements)) + upper + upper.conj().T


def exact_slab_stiffness(depth: float, poisson_ratio: float) -> Array:
    """Return the exact stiffness of a body in plane strain in units of C11 and of the wavenumber, (4, 4).

    Displacements (x, z) of the lower and of the upper surface to the forces on them. Navier's equations are integrated
    from one surface to the other. The wave runs along -x, as that of Eq. 2.11 does.
    """
    from scipy.linalg import expm  # takes longer to import than to use

    s = modulus_ratio(poisson_ratio)
    side = 1 - 2 * s  # λ/C11
    rates = np.array(  # of u_x, u_z, σ_xz, σ_zz along z over the height's unit, stresses in C11
        [
            [0, 1j, 1 / s, 0],
            [1j * side, 0, 0, 1],
            [1 - side**2, 0, 0, 1j * side],
            [0, 0, 1j, 0],
        ]
    )
    transfer = expm(rates * depth)
    (same, compliance), (stiffness, back) = (
        (transfer[rows, :2], transfer[rows, 2:]) for rows in (slice(2), slice(2, 4))
    )
    to_stress = np.linalg.inv(compliance)
    return np.block([[to_stress @ same, -to_stress], [stiffness - back @ to_stress @ same, back @ to_stress]])


def stiffness_departure(is_printed: bool) -> float:
    """Return the largest difference of Eqs 2.11 and 2.12 from the exact stiffness, over the largest entry of that."""
    departures = []
    for poisson_ratio in POISSON_RATIOS:
        for depth in DEPTHS:
            exact = exact_slab_stiffness(depth, poisson_ratio)
            matrix = slab_stiffness(printed_elements(depth, poisson_ratio), is_printed)
            waves = (matrix, matrix.conj())  # the text does not say which way its waves run
            departures.append(min(np.abs(wave - exact).max() for wave in waves) / np.abs(exact).max())
    return float(max(departures))


def element_departure() -> float:
    """Return the largest difference in size of an element of Eq. 2.12 from the exact one, over the largest of them."""
    departures = []
    for poisson_ratio in POISSON_RATIOS:
        for depth in DEPTHS:
            exact = np.abs(np.triu(exact_slab_stiffness(depth, poisson_ratio)))
            printed = np.abs(printed_elements(depth, poisson_ratio))
            departures.append(np.abs(printed - exact).max() / exact.max())
    return float(max(departures))


def half_space_ratio(poisson_ratio: float) -> float:
    """Return 2(1-s)C44 over the stiffness per wavenumber of a half-space without surface shear."""
    body = HalfSpace(contact_modulus=1.0, poisson_ratio=poisson_ratio)
    shear_modulus = (1 - poisson_ratio) / 2
    stiffness = 1 / float(body.compliance(np.ones(1))[0])
    return 2 * (1 - modulus_ratio(poisson_ratio)) * shear_modulus / stiffness


def verlet_growth(sign: float) -> float:
    """Return the factor by which the displacement of a free wave grows at least in an iteration of Eq. 2.5.

    The two factors of a wave are the roots of z² - (2 - kδt² + dδt²) z + (1 + dδt²), with d the damping factor with its
    sign. The larger one is at least the root of their product, whatever the stiffness k. sign: +1 as printed.
    """
    return float(np.sqrt(1 + sign * DAMPING * TIME_STEP**2))


def restoring_work(sign: float) -> float:
    """Return the work of T_el along a displacement over twice the energy; sign: +1 for Eq. 2.8 as printed.

    The energy is quadratic, so its derivative along the displacement is twice itself.
    """
    matrix = slab_stiffness(printed_elements(1.0, POISSON_RATIOS[1]), is_printed=False)
    displacement = np.array([0, 0, 0, 1])
    energy = (displacement @ matrix @ displacement).real / 2
    force = sign * (matrix @ displacement).real
    return float(force @ displacement / (2 * energy))


def xu_needleman_remainder(work_ratio: float) -> float:
    """Return the largest normal traction of Xu and Needleman's law at complete shear failure, over the strength."""
    failed, whole = (adhesion.xu_needleman_normal(1.0, slip, work_ratio) for slip in (COMPLETE_SHEAR, 0.0))
    return float(failed / whole)


def xu_needleman_work_ratio() -> float:
    """Return the ratio of works at which Xu and Needleman's law leaves nothing at complete shear failure.

    The remainder falls with the ratio, so there is only one.
    """
    return float(brentq(xu_needleman_remainder, 0.0, 2.0, xtol=1e-12))


def largest_normal_traction(slip: float) -> float:
    """Return the largest normal traction of Eq. 2.17 at a tangential gap over its length, over that without; any c."""
    law = CohesiveZone(work_of_separation=1.0, work_ratio=0.5)
    opening = np.linspace(0.0, 5.0, 5001)  # the largest is at 1
    slipped, whole = (law.traction(np.stack((opening, np.full_like(opening, gap))))[0].max() for gap in (slip, 0.0))
    return float(slipped / whole)


def bsg_strengths() -> Array:
    """Return the tangential strength of the BSG law at `OVERCLOSURES`, over that without overclosure."""
    strengths = adhesion.bsg_factor(-OVERCLOSURES) * adhesion.tangential_strength(1.0, 1.0, -OVERCLOSURES)
    return strengths / strengths[0]


def traction_at_start() -> float:
    """Return the normal traction of Eq. 6.4 at δ0 over the strength."""
    return float(INITIAL_GAP * np.exp(-INITIAL_GAP) / adhesion.normal_strength(1.0, 1.0, 0.0))


FORMULAS: dict[str, Callable[[], float]] = {
    "half_space_scalar": lambda: half_space_ratio(0.5),
    "half_space_scalar_compressible": lambda: max(
        (half_space_ratio(nu) for nu in POISSON_RATIOS), key=lambda r: abs(r - 1)
    ),
    "verlet_growth": lambda: verlet_growth(1.0),
    "verlet_growth_meant": lambda: verlet_growth(-1.0),
    "restoring_work": lambda: restoring_work(1.0),
    "restoring_work_meant": lambda: restoring_work(-1.0),
    "stiffness_departure": lambda: stiffness_departure(is_printed=True),
    "stiffness_departure_meant": lambda: stiffness_departure(is_printed=False),
    "element_departure": element_departure,
    "xu_needleman_work_ratio": xu_needleman_work_ratio,
    "xu_needleman_remainder": lambda: min(xu_needleman_remainder(ratio) for ratio in WORK_RATIOS),
    "law_remainder": lambda: largest_normal_traction(COMPLETE_SHEAR),
    "slipped_strength": lambda: largest_normal_traction(1.0) / np.exp(-1.0),
    "bsg_change": lambda: float(np.diff(bsg_strengths()).max()),
    "bsg_strength_deep": lambda: float(bsg_strengths()[OVERCLOSURES == 2.0][0]),
    "traction_at_start": traction_at_start,
}
"""Numbers by name."""
