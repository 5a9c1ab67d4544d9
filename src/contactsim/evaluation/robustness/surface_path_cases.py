"""A path of normal laws on a surface to follow, and what is right for it; see `path_cases`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contactsim.contact.steps import LoadStep
from contactsim.evaluation.robustness.navier import surface_compliance
from contactsim.evaluation.robustness.path_cases import PathCase
from contactsim.evaluation.robustness.printed_laws import FORMULAS
from contactsim.grid import Array
from contactsim.traits import Trait


@dataclass(frozen=True)
class SurfacePathCase(PathCase):
    """A scene of normal laws on a surface, and how its path must end; along approaches alone."""

    points: int = 32
    even: bool = False

    @property
    def kind(self) -> frozenset[Trait]:
        """Traits that a solver must accept to solve such cases."""
        return frozenset({Trait.SURFACE}).union(*(effect.traits for effect in self.scene.effects))

    @cached_property
    def shape(self) -> Array:
        """The gap of the undeformed bodies at zero approach, (1, n), nm."""
        return -self.heights.reshape(1, -1)

    @cached_property
    def compliance(self) -> Array:
        """Displacement per traction of both bodies together, (m,), nm/GPa."""
        ny, nx = self.heights.shape
        length_y, length_x = self.scene.lengths
        across, along = np.fft.fftfreq(ny, length_y / ny), np.fft.rfftfreq(nx, length_x / nx)
        q = 2 * np.pi * np.hypot(across[:, None], along).ravel()
        bodies = self.scene.lower.elasticity, self.scene.upper.elasticity
        return np.asarray(sum(surface_compliance(body, q)[:, 0, 0].real for body in bodies if body is not None))

    def _field(self, coefficients: Array) -> Array:
        """The values (n,) of coefficients (m,)."""
        ny, nx = self.heights.shape
        return np.asarray(np.fft.irfft2(coefficients.reshape(ny, nx // 2 + 1), (ny, nx)).ravel() * (ny * nx))

    def _coefficients(self, field: Array) -> Array:
        """The coefficients (m,) of values (n,)."""
        return np.asarray(np.fft.rfft2(field.reshape(self.heights.shape)).ravel() / field.size)

    def gap(self, step: LoadStep, displacement: Array) -> Array:
        """The normal gap (1, n), nm, at the coefficients of a displacement (1, m)."""
        return self.shape + self._field(displacement[0]) - step.normal.value

    def traction(self, gap: Array) -> Array:
        """Normal traction (1, n), GPa, at a gap (1, n), nm."""
        none = np.zeros_like(gap[0])
        tractions: list[Array] = [FORMULAS[type(law)](law, gap[0], none)[:1] for law in self.laws]
        return np.asarray(sum(tractions))

    def forces(self, step: LoadStep, displacement: Array) -> Array:
        """Compression of a state, (1,), nN."""
        return -self.traction(self.gap(step, displacement)).mean(1) * np.prod(self.scene.lengths)

    def residual(self, step: LoadStep, displacement: Array) -> float:
        """Largest normal traction that nothing balances (GPa)."""
        waves = self._coefficients(self.traction(self.gap(step, displacement))[0])
        moves = self.compliance > 0
        waves[~moves] = 0.0
        waves[moves] += displacement[0, moves] / self.compliance[moves]
        return float(np.abs(self._field(waves)).max())

    def answer(self, step: LoadStep, displacement: Array) -> Array:
        """Coefficients (1, m) of -C T(g + v), with which the bodies answer a displacement v."""
        return -self.compliance * self._coefficients(self.traction(self.gap(step, displacement))[0])[None]
