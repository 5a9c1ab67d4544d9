"""Newton–Krylov equilibrium of smooth laws, and the overdamped flow that takes over where a branch ends.

From a guess near the solution, Newton's method on the Fourier coefficients needs one or two linear solves, each a few
Krylov iterations behind the preconditioner of `zone`. Where the branch ends (a jump into or out of contact) Newton
would land anywhere; what a slow experiment does there is the overdamped flow du/dt = -(K u + T) from the last stable
state. It is followed by linearly implicit steps

    (K + T' + s) du = -r,

with a shift s, the inverse of the time step, that adapts to how far a step moves the surface. Steps uphill or too far
are refused. Once s is small against the laws' tangent it is dropped, and the end is Newton's.

A symmetric scene has symmetric equilibria, which nothing symmetric leaves, stable or not. So each is looked at: by
the sign of the determinant of K + T' and by its eigenvalue nearest zero, by-products of the preconditioner, and at the
end of a flow by all eigenvalues. A state from which a displacement grows by itself is left along it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent
from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import SMOOTH_PATHS, Equilibrium, are_pulled_apart, largest_change, status_of
from contactsim.solvers.cohesive.gmres import gmres
from contactsim.solvers.cohesive.zone_preconditioner import ZonePreconditioner
from contactsim.status import Status
from contactsim.traits import Trait

TIGHTEST, LOOSEST = 1e-3, 0.1
"""Smallest and largest relative residual asked of a linear solve."""
MARGIN = 0.3
"""By how much the residual should fall below the tolerance, at the place where it is largest."""
ROUGH = 3e-2
"""The same for a step of the flow: its direction need not be exact."""
FIRST, RETURN, DROP = 0.03, 0.02, 1e-3
"""Shift over the laws' largest tangent: at the start, at least after a refusal, and below which it is zero."""

STRAYED = 3.0
"""Newton is given up once it has moved this many times as far as is of use."""
HARD = 5
"""A preconditioner is made anew after a linear solve that took more iterations than this."""
NUDGE, NUDGES = 0.03, 5
"""How far an unstable state is pushed along a displacement that grows, over the laws' length, and how often."""


class Memory:
    """The preconditioner of the last state, which serves the next one nearly as well, and its softest wave."""

    def __init__(self) -> None:
        self._kept: ZonePreconditioner | None = None
        self._last: ZonePreconditioner | None = None
        self._held = b""
        self._wave: Array | None = None

    def preconditioner(self, problem: CohesiveProblem, tangent: Tangent) -> ZonePreconditioner:
        """The one kept, or a new one for this tangent."""
        if self._kept is None or self._held != problem.fixed_modes.tobytes():
            return self.renew(problem, tangent)
        return self._kept

    def renew(self, problem: CohesiveProblem, tangent: Tangent) -> ZonePreconditioner:
        """A new one for this tangent, to keep."""
        held = problem.fixed_modes.tobytes()
        before = self._last if held == self._held else None
        self._kept = self._last = ZonePreconditioner(problem, tangent, before=before)
        self._held = held
        return self._kept

    def doubts(self) -> bool:
        """Whether the state that the one kept was made for may be one that a disturbance leaves."""
        doubtful, self._wave = self._kept.softest(self._wave)
        return doubtful

    def learn(self, iterations: int) -> None:
        """Drop it if it served badly."""
        if iterations > HARD:
            self._kept = None


@dataclass(frozen=True)
class NewtonKrylov:
    """Newton–Krylov method, with the overdamped flow at instabilities.

    Parameters
    ----------
    newton_budget
        Largest number of Newton steps from a guess.
    krylov_budget
        Largest number of Krylov iterations in a Newton step.
    flow_budget
        Largest number of steps of a flow.
    flow_step
        Largest change of the displacement in a step of the flow, over the interaction range of the laws.
    trust_radius
        Largest change from a guess to a state on the same branch, in the same unit.
    """

    newton_budget: int = 8
    krylov_budget: int = 60
    flow_budget: int = 4000
    flow_step: float = 0.3
    trust_radius: float = 0.1
    fields = 40
    uses_guess = True
    accepts = SMOOTH_PATHS | {Trait.NON_CONSERVATIVE}

    def __post_init__(self) -> None:
        for name in ("flow_step", "trust_radius"):
            if not getattr(self, name) > 0:
                raise SceneError(name, getattr(self, name), "a positive number of the laws' length")

    def transforms(self, points: int) -> float:
        """Real transforms of a Krylov iteration and unknown component."""
        return 2.5

    def new_memory(self) -> Memory:
        """What is kept between the states of one walk."""
        return Memory()

    def solve_near(self, problem: CohesiveProblem, guess: Array, memory: Memory, within: float = np.inf) -> Equilibrium:
        """Newton's method from a guess."""
        displacement, far, strayed = guess, STRAYED * within, 0.0
        for count in range(self.newton_budget + 1):
            gap = problem.gap(displacement)
            traction, tangent = problem.tangent(gap)
            residual = problem.residual(displacement, traction)
            worst = problem.norm(residual)
            if count:
                strayed = largest_change(problem, displacement - guess, self.trust_radius * problem.interaction_range)
            if worst <= problem.tolerance or count == self.newton_budget or not (np.isfinite(worst) and strayed <= far):
                break
            forcing = np.clip(MARGIN * problem.tolerance / worst, TIGHTEST, LOOSEST)
            precondition = memory.preconditioner(problem, tangent)
            change, iterations = self._solve(problem, tangent, precondition, residual, 0.0, forcing)
            memory.learn(iterations)
            displacement = displacement + change
        status = status_of(worst, problem)
        unstable = False
        if status is Status.CONVERGED:
            fresh = memory.renew(problem, tangent)
            unstable = memory.doubts() and self._growing(problem, tangent, fresh) is not None
        return Equilibrium(displacement, gap, traction, status, worst, strayed, count, unstable)

    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """The overdamped flow from a state."""
        displacement, shift, most = start, FIRST * problem.law_stiffness, self.flow_step * problem.interaction_range
        status, worst, count, nudges = Status.MAX_ITERATIONS, np.inf, 0, 0
        while count < self.flow_budget:
            count += 1
            gap = problem.gap(displacement)
            traction, tangent = problem.tangent(gap)
            residual = problem.residual(displacement, traction)
            worst = problem.norm(residual)
            if not np.isfinite(worst):
                status = Status.NON_FINITE
                break
            if are_pulled_apart(problem, gap):
                status = Status.NO_EQUILIBRIUM
                break
            precondition = ZonePreconditioner(problem, tangent, shift)
            if shift == 0 and worst <= problem.tolerance:
                growing = self._growing(problem, tangent, precondition)
                if growing is None:
                    status = Status.CONVERGED
                    break
                if nudges == NUDGES:
                    break
                nudges, shift = nudges + 1, FIRST * problem.law_stiffness
                displacement = displacement + NUDGE * problem.interaction_range * growing
                continue
            forcing = np.clip(MARGIN * problem.tolerance / worst, TIGHTEST, ROUGH)
            change, _ = self._solve(problem, tangent, precondition, residual, shift, forcing)
            move = float(np.abs(problem.field(change)[: len(change)]).max())
            downhill = -np.vdot(change, residual).real > 0
            if not (downhill and move <= 2 * most):
                shift = max(3 * shift, RETURN * problem.law_stiffness)
                continue
            displacement = displacement + change
            shift /= 3 if move < 0.3 * most else 1.5 if move < most else 1
            shift = shift if shift > DROP * problem.law_stiffness else 0.0
        distance = largest_change(problem, displacement - start)
        return Equilibrium(displacement, gap, traction, status, worst, distance, count)

    def _growing(self, problem: CohesiveProblem, tangent: Tangent, precondition: ZonePreconditioner) -> Array | None:
        """A displacement of largest value one that grows by itself from a state of that tangent; None if none does."""
        wave = precondition.growing()
        if wave is None or np.vdot(wave, problem.add_elastic(tangent(wave), wave)).real >= 0:
            return None
        return wave / np.abs(problem.field(wave)[: len(wave)]).max()

    def _solve(
        self,
        problem: CohesiveProblem,
        tangent: Callable,
        precondition: Callable,
        residual: Array,
        shift: float,
        forcing: float,
    ) -> tuple[Array, int]:
        def product(change: Array) -> Array:
            """(K + T' + s) times a change of the displacement."""
            out = tangent(change)
            if shift:
                out += shift * change
            return problem.add_elastic(out, change)

        unit = problem.strength  # squares of a weak law's tractions would underflow
        change, iterations = gmres(product, precondition, residual / -unit, forcing, self.krylov_budget)
        return unit * change, iterations
