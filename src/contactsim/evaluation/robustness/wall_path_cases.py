"""A path of attraction beside a hard wall on a surface, and what is right for it; see `path_cases`.

The wall's pressure is what balances elasticity and attraction. It must never pull, and it must be zero where the gap is
open; the gap must never be negative.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.contact.steps import LoadStep
from contactsim.evaluation.robustness.surface_path_cases import SurfacePathCase
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.solvers.registry import make_solver
from contactsim.traits import Trait

BRANCH_SOLVER = "energy_minimisation"
"""The solver of smaller increments: it goes downhill in energy, where the default one follows equilibria."""


@dataclass(frozen=True)
class WallPathCase(SurfacePathCase):
    """A scene of a hard wall and normal laws on a surface, and how its path must end; along approaches alone."""

    tolerance: float = 1e-6

    @property
    def kind(self) -> frozenset[Trait]:
        """Traits that a solver must accept to solve such cases."""
        return frozenset({Trait.SURFACE, Trait.SMOOTH, Trait.ADHESIVE_WALL})

    @property
    def exact(self) -> None:
        """No answer is known but by smaller increments."""

    @property
    def branch_solver(self) -> CohesiveSolver:
        """The solver of smaller increments."""
        solver: CohesiveSolver = make_solver(BRANCH_SOLVER)
        return solver

    @property
    def closed(self) -> float:
        """Largest gap (nm) that counts as closed."""
        return 2 * self.tolerance * min(law.interaction_range for law in self.laws)

    def balance(self, step: LoadStep, displacement: Array) -> tuple[Array, Array]:
        """Gap (n,), nm, and what the wall must bear (n,), GPa: elasticity and attraction together."""
        gap = self.gap(step, displacement)
        pull = self.traction(np.maximum(gap, 0.0))[0]
        waves = np.zeros_like(displacement[0])
        moves = self.compliance > 0
        waves[moves] = displacement[0, moves] / self.compliance[moves]
        bearing = self._field(waves) + pull
        if not moves[0]:  # the reaction to a fixed mean displacement, which is that of the open points
            is_open = gap[0] > self.closed
            bearing -= np.median(bearing[is_open]) if is_open.any() else bearing.min()
        return gap[0], bearing

    def forces(self, step: LoadStep, displacement: Array) -> Array:
        """Compression of a state, (1,), nN."""
        gap, bearing = self.balance(step, displacement)
        pull = self.traction(np.maximum(gap, 0.0)[None])[0]
        pressure = np.where(gap <= self.closed, bearing, 0.0)
        return np.array([(pressure - pull).mean() * np.prod(self.scene.lengths)])

    def residual(self, step: LoadStep, displacement: Array) -> float:
        """Largest traction (GPa) that nothing balances, or with which the wall pulls; infinite under overlap."""
        gap, bearing = self.balance(step, displacement)
        if gap.min() < -self.closed:
            return np.inf
        unbalanced = np.where(gap <= self.closed, np.minimum(bearing, 0.0), bearing)
        return float(np.abs(unbalanced).max())
