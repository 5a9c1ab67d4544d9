"""The problem linearised at a state: steps towards equilibrium, and displacements that grow on their own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent
from contactsim.grid import Array
from contactsim.solvers.cohesive.gmres import gmres
from contactsim.solvers.cohesive.zone_preconditioner import ZonePreconditioner

MIN_FORCING, MAX_FORCING = 1e-3, 0.1
"""Smallest and largest relative residual of a step of Newton's method."""
SAFETY = 0.3
"""Fraction of the tolerance to which a step of Newton's method should reduce the residual."""


@dataclass(frozen=True)
class Growth:
    """A displacement (exerted, m) of largest value 1 that grows at an unstable state, and its rate, GPa/nm."""

    wave: Array
    rate: float


def newton_forcing(problem: CohesiveProblem, worst: float) -> float:
    """Return the relative residual to which a step of Newton's method is solved, at a residual over the strength."""
    return float(np.clip(SAFETY * problem.tolerance / worst, MIN_FORCING, MAX_FORCING))


def solve_linearised(
    tangent: Tangent, precondition: ZonePreconditioner, residual: Array, forcing: float, budget: int, shift: float = 0.0
) -> tuple[Array, int]:
    """Return the solution of (K + T' + s) du = -r to a relative residual, and the iterations that it took."""
    problem = tangent.problem

    def product(change: Array) -> Array:
        """Return (K + T' + s) times a change of the displacement."""
        out = tangent(change)
        if shift:
            out += shift * change
        return problem.add_elastic(out, change)

    unit = problem.strength  # squares of a weak law's tractions would underflow
    change, iterations = gmres(product, precondition, residual / -unit, forcing, budget)
    return unit * change, iterations


def find_growth(tangent: Tangent, precondition: ZonePreconditioner) -> Growth | None:
    """Return how a displacement grows on its own at a state; None if none does."""
    problem, waves = tangent.problem, precondition.growing()
    if not waves:
        return None
    weights = problem.mode_weights
    push = sum(np.vdot(weights * wave, problem.add_elastic(tangent(wave), wave)).real for wave in waves)
    rate = -float(push / sum(np.vdot(weights * wave, wave).real for wave in waves))
    if rate <= 0:
        return None
    return Growth(waves[0] / np.abs(problem.field(waves[0])[: len(waves[0])]).max(), rate)


def grows_on_its_own(problem: CohesiveProblem, gap: Array) -> bool:
    """Return True if a small displacement grows on its own at a gap (read, n)."""
    tangent = problem.tangent(gap)[1]
    return find_growth(tangent, ZonePreconditioner(problem, tangent)) is not None
