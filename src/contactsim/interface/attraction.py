"""Attraction beside a hard wall, which alone resists overlap: adhesion without a soft repulsion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from contactsim.arguments import Gap, Only, checked
from contactsim.errors import is_positive
from contactsim.grid import Array
from contactsim.interface.normal_law import NormalLaw

MIN_RAMP = 1e-3
"""Narrowest fall of Dugdale's attraction, over its length."""
Ramp = Annotated[
    float,
    Only(
        f"at least {MIN_RAMP:g} and at most 1, in parts of the length",
        lambda value: is_positive(value) and MIN_RAMP <= value <= 1,
    ),
]


@checked
@dataclass(frozen=True)
class ExponentialAttraction(NormalLaw):
    """Attraction that decays exponentially with the gap, for use beside a hard wall.

    The traction is φn/δn exp(-Δn/δn) where the gap is open. Its work of separation is φn, from contact to far apart.

    Parameters
    ----------
    work_of_separation
        Work of separation φn > 0, N/m.
    normal_length
        Characteristic length δn, nm.
    """

    @property
    def strength(self) -> float:
        """Traction φn/δn in contact, GPa."""
        return self.work_of_separation / self.normal_length

    @property
    def peak(self) -> float:
        """Gap from which the traction falls, nm."""
        return 0.0

    def traction(self, gap: Gap) -> Array:
        """Return the traction (1, n), GPa, at a gap (1, n), nm; that of contact under overlap."""
        return self.strength * np.exp(-np.maximum(gap, 0.0) / self.normal_length)

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (1, n), GPa, and its derivative (1, 1, n), GPa/nm; zero under overlap."""
        traction = self.traction(gap)
        return traction, np.where(gap > 0, -traction / self.normal_length, 0.0)[None]

    def energy(self, gap: Gap) -> Array:
        """Return the potential -φn exp(-Δn/δn), (n,), N/m, at a gap (1, n), nm; a straight line under overlap."""
        opening, overlap = np.maximum(gap[0], 0.0), np.minimum(gap[0], 0.0)
        return self.strength * overlap - self.work_of_separation * np.exp(-opening / self.normal_length)


@checked
@dataclass(frozen=True)
class DugdaleAttraction(NormalLaw):
    """Constant attraction up to a gap, for use beside a hard wall: the model of Maugis and Dugdale.

    The traction is φn/δn up to a gap of δn (1 - r/2) and zero from δn (1 + r/2) on. Between them it falls along a cubic
    without kinks. Its work of separation is φn, whatever the ramp r.

    Parameters
    ----------
    work_of_separation
        Work of separation φn > 0, N/m.
    normal_length
        Gap δn up to which it acts, nm.
    ramp
        Width of the fall over the length, from 0.001 to 1. It is the law's length for tolerances and jumps; a narrower
        one needs finer grids and shorter steps.

    References
    ----------
    D. Maugis, J. Colloid Interface Sci. 150, 243 (1992), doi:10.1016/0021-9797(92)90285-T.
    """

    ramp: Ramp = 0.2

    @property
    def strength(self) -> float:
        """Traction φn/δn in contact, GPa."""
        return self.work_of_separation / self.normal_length

    @property
    def peak(self) -> float:
        """Gap from which the traction falls, nm."""
        return 0.0

    @property
    def stiffness(self) -> float:
        """Size of the steepest tangent 3φn/(2 r δn²), GPa/nm."""
        return 1.5 * self.strength / self.interaction_range

    @property
    def interaction_range(self) -> float:
        """Length r δn over which the traction falls, nm."""
        return self.ramp * self.normal_length

    def _fall(self, gap: Gap) -> Array:
        """Return how far a gap (1, n), nm, is along the fall, from 0 to 1."""
        return np.clip((gap - self.normal_length) / self.interaction_range + 0.5, 0.0, 1.0)

    def traction(self, gap: Gap) -> Array:
        """Return the traction (1, n), GPa, at a gap (1, n), nm; that of contact under overlap."""
        part = self._fall(gap)
        return self.strength * (1 - part**2 * (3 - 2 * part))

    def tangent(self, gap: Gap) -> tuple[Array, Array]:
        """Return the traction (1, n), GPa, and its derivative (1, 1, n), GPa/nm."""
        part = self._fall(gap)
        return self.traction(gap), (-4 * self.stiffness * part * (1 - part))[None]

    def energy(self, gap: Gap) -> Array:
        """Return the potential (n,), N/m, at a gap (1, n), nm; zero where the surfaces are far apart."""
        part, width = self._fall(gap)[0], self.interaction_range
        before = np.minimum(gap[0], self.normal_length - width / 2) - (self.normal_length - width / 2)
        return self.strength * (before + width * (part - part**3 + part**4 / 2 - 0.5))
