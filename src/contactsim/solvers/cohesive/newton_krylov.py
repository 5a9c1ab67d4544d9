"""Newton–Krylov equilibrium of smooth laws, and the overdamped flow that takes over at the end of a branch.

From a guess near the solution, Newton's method on the Fourier coefficients needs one or two linear solves, each of a
few Krylov iterations with the preconditioner of `zone_preconditioner`. At the end of a branch (a jump into or out of
contact) Newton's method could end anywhere. A slow experiment follows the overdamped flow du/dt = -(K u + T) from the
last stable state. For laws with a potential it goes downhill in energy, and `descent` finds its end in short steps; for
others see `overdamped_flow`.

A symmetric scene has symmetric equilibria, which no symmetric method leaves, stable or not. The factors of the
preconditioner therefore show of each state whether K + T' has negative eigenvalues. An unstable state is left along a
growing displacement.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent
from contactsim.contact.wall import correct_wall
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import SMOOTH_PATHS, Equilibrium, largest_change, status_of
from contactsim.solvers.cohesive.convex_steps import settle
from contactsim.solvers.cohesive.descent import descend
from contactsim.solvers.cohesive.linearised import find_growth, newton_forcing, solve_linearised
from contactsim.solvers.cohesive.overdamped_flow import MAX_NUDGES, NUDGE, flow
from contactsim.solvers.cohesive.zone_preconditioner import ZonePreconditioner
from contactsim.status import Status
from contactsim.traits import Trait

MAX_CHANGE_RATIO = 3.0
"""Newton's method ends once it has moved this many times as far as is of use."""
MAX_RESIDUAL = 0.1
"""Newton's method ends where the residual is more than this part of the strength, if a state is sought within the trust
radius: it is farther away, and the end of its branch is sooner found by a flow."""
MAX_STALL = 0.5
"""Largest ratio of the residual to that of the Newton step before, from the second on, if a state is sought within the
trust radius. An iteration that converges reduces it more; beyond the end of a branch there is no state to reach."""
MAX_SHARED_ITERATIONS = 5
"""A preconditioner is made anew after a linear solve with more iterations than this."""
CORRECTION_STEPS, MAX_CORRECTED = 3, 60
"""Newton steps that a correction of a wall's pressure may take, and their number above which it is not corrected."""
SHORT_STEPS = 150
"""Short steps down the energy, after which the rest of a motion is done in convex ones."""
STEP_DIVISIONS = 1, 3
"""Parts into which the largest step of a flow is divided, one after the other, until the flow comes to rest."""


class Memory:
    """Preconditioner of the last state, which serves the next state nearly as well."""

    def __init__(self) -> None:
        self._shared: ZonePreconditioner | None = None
        self._last: ZonePreconditioner | None = None
        self._fixed_modes = b""

    def preconditioner(self, problem: CohesiveProblem, tangent: Tangent) -> ZonePreconditioner:
        """Return the preconditioner of the last state, or a new one if it does not serve."""
        if self._shared is None or self._fixed_modes != problem.fixed_modes.tobytes():
            return self.renew(problem, tangent)
        return self._shared

    def renew(self, problem: CohesiveProblem, tangent: Tangent) -> ZonePreconditioner:
        """Return a new preconditioner for a tangent, and keep it."""
        fixed_modes = problem.fixed_modes.tobytes()
        before = self._last if fixed_modes == self._fixed_modes else None
        self._shared = self._last = ZonePreconditioner(problem, tangent, before=before)
        self._fixed_modes = fixed_modes
        return self._shared

    def record(self, iterations: int) -> None:
        """Forget the preconditioner if a linear solve took many iterations."""
        if iterations > MAX_SHARED_ITERATIONS:
            self._shared = None


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
    flow_budget: int = 1000
    flow_step: float = 0.3
    trust_radius: float = 0.1
    fields = 40
    uses_guess = True
    accepts = SMOOTH_PATHS | {Trait.NON_CONSERVATIVE, Trait.ADHESIVE_WALL}

    def __post_init__(self) -> None:
        for name in ("flow_step", "trust_radius"):
            if not getattr(self, name) > 0:
                raise InputError(name, getattr(self, name), "a positive number, over the interaction range of the laws")

    def transforms(self, points: int) -> float:
        """Return the real transforms of a Krylov iteration, for each unknown component."""
        return 2.5

    def new_memory(self) -> Memory:
        """Return an empty memory of preconditioners."""
        return Memory()

    def solve_near(self, problem: CohesiveProblem, guess: Array, memory: Memory, within: float = np.inf) -> Equilibrium:
        """Return the state that Newton's method reaches from a guess."""
        displacement, far, distance = guess, MAX_CHANGE_RATIO * within, 0.0
        is_near = within <= self.trust_radius * problem.interaction_range
        worst, worst_near, count, budget = np.inf, MAX_RESIDUAL if is_near else np.inf, 0, self.newton_budget
        while True:
            gap = problem.gap(displacement)
            traction, tangent = problem.tangent(gap)
            residual = problem.residual(displacement, traction)
            before, worst = worst, problem.norm(residual)
            stalls = is_near and count > 1 and worst > MAX_STALL * before
            corrected = correct_wall(problem, gap) if worst <= problem.tolerance and budget < MAX_CORRECTED else None
            if corrected is not None:  # by little, and the residual grows: no sign of a branch's end
                problem, is_near, worst_near, budget = corrected, False, np.inf, budget + CORRECTION_STEPS
                traction, tangent = problem.tangent(gap)
                residual = problem.residual(displacement, traction)
                worst = problem.norm(residual)
            if count:
                distance = largest_change(problem, displacement - guess, self.trust_radius * problem.interaction_range)
            if (
                worst <= problem.tolerance
                or count == budget
                or stalls
                or not (np.isfinite(worst) and worst <= worst_near and distance <= far)
            ):
                break
            precondition = memory.preconditioner(problem, tangent)
            forcing = newton_forcing(problem, worst)
            change, iterations = solve_linearised(tangent, precondition, residual, forcing, self.krylov_budget)
            memory.record(iterations)
            displacement, count = displacement + change, count + 1
        status = status_of(worst, problem)
        unstable = False
        if status is Status.CONVERGED:
            unstable = find_growth(tangent, memory.renew(problem, tangent)) is not None
        return Equilibrium(displacement, gap, traction, status, worst, distance, count, unstable)

    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return the end of a slow motion from a state: downhill in energy, or by the overdamped flow.

        The flow takes smaller steps where it does not come to rest.
        """
        iterations = 0
        if Trait.NON_CONSERVATIVE not in problem.law.traits:
            state = self._descend(problem, start)
            if state.status is not Status.MAX_ITERATIONS:
                return state
            iterations = state.iterations
        for parts in STEP_DIVISIONS:
            state = flow(problem, start, self.flow_step / parts, self.flow_budget * parts, self.krylov_budget)
            iterations += state.iterations
            if state.status is not Status.MAX_ITERATIONS:
                break
        return replace(state, iterations=iterations)

    def _descend(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return the stable minimum of the energy below a state; one that is not stable is left."""
        state = self._go_down(problem, start)
        iterations, nudge = state.iterations, NUDGE * problem.interaction_range
        for _ in range(MAX_NUDGES):
            if state.status is not Status.CONVERGED:
                break
            tangent = problem.tangent(state.gap)[1]
            growing = find_growth(tangent, ZonePreconditioner(problem, tangent))
            if growing is None:
                break
            residual = problem.residual(state.displacement, state.traction)
            downhill = 1 if np.vdot(growing.wave, residual * problem.mode_weights).real <= 0 else -1
            state = self._go_down(problem, state.displacement + downhill * nudge * growing.wave)
            iterations += state.iterations
            nudge *= 2  # the state beside the unstable one may be an equilibrium to the tolerance, too
        else:
            state = replace(state, status=Status.MAX_ITERATIONS)
        return replace(state, largest_change=largest_change(problem, state.displacement - start), iterations=iterations)

    def _go_down(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return a minimum of the energy below a state, in convex steps where short ones do not get there."""
        state = descend(problem, start, min(SHORT_STEPS, self.flow_budget))
        if state.status is not Status.MAX_ITERATIONS:
            return state
        rest = settle(problem, state.displacement, self.flow_budget)
        if rest is None or rest.status is Status.MAX_ITERATIONS:
            rest = descend(problem, state.displacement, self.flow_budget)
        return replace(rest, iterations=state.iterations + rest.iterations)
