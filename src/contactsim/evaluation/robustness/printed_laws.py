"""The laws as printed, without the continuation of deep overlap of `contactsim.interface`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contactsim.grid import Array
from contactsim.interface.attraction import ExponentialAttraction
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone


def _mixed_mode(law: CohesiveZone | UncoupledCohesiveZone, normal: Array, tangential: Array) -> Array:
    """Eq. 2.17 as printed, (2, n), GPa."""
    y, s = normal / law.normal_length, tangential / law.tangential_length
    far = np.exp(-y - s**2)
    size = law.work_of_separation / law.normal_length, 2 * law.work_of_separation * law.work_ratio
    return np.stack([size[0] * y * far, size[1] / law.tangential_length * s * far])


def _normal(law: NormalCohesiveZone, normal: Array, tangential: Array) -> Array:
    """Eq. 4.1 as printed, (2, n), GPa."""
    y = normal / law.normal_length
    return np.stack([law.work_of_separation / law.normal_length * y * np.exp(-y), np.zeros_like(tangential)])


def _uncoupled(law: UncoupledCohesiveZone, normal: Array, tangential: Array) -> Array:
    """Eq. 4.1 and the tangential traction of Eq. 2.17 as printed, (2, n), GPa."""
    return np.stack([_normal(law.without_slip(), normal, tangential)[0], _mixed_mode(law, normal, tangential)[1]])


def _exponential(law: ExponentialAttraction, normal: Array, tangential: Array) -> Array:
    """φn/δn exp(-Δn/δn), (2, n), GPa."""
    size = law.work_of_separation / law.normal_length
    return np.stack([size * np.exp(-normal / law.normal_length), np.zeros_like(tangential)])


FORMULAS: dict[type, Callable[..., Array]] = {
    CohesiveZone: _mixed_mode,
    NormalCohesiveZone: _normal,
    UncoupledCohesiveZone: _uncoupled,
    ExponentialAttraction: _exponential,
}
"""Normal traction and that along x (2, n), GPa, at a normal and a tangential gap (n,), nm, by the class of a law."""
