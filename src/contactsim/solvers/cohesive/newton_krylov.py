"""Newton–Krylov equilibrium of smooth laws, and the overdamped flow that takes over at the end of a branch.

From a guess near the solution, Newton's method on the Fourier coefficients needs one or two linear solves, each of a
few Krylov iterations with the preconditioner of `zone_preconditioner`. At the end of a branch (a jump into or out of
contact) Newton's method could end anywhere. A slow experiment follows the overdamped flow du/dt = -(K u + T) from the
last stable state. For laws with a potential it goes downhill in energy, and `descent` finds its end in a few short
steps. For other laws it is integrated by linearly implicit steps

    (K + T' + s) du = -r,

with a shift s, the inverse of the time step, that adapts to the change of the displacement in a step. Steps that go
uphill or too far are refused. Once s is small against the laws' tangent it is set to zero, and the last steps are
Newton's.

A symmetric scene has symmetric equilibria, which no symmetric method leaves, stable or not. The stability of each state
is therefore checked: by the sign of the determinant of K + T' and by its eigenvalue nearest zero, by-products of the
preconditioner, and at the end of a flow by all eigenvalues. An unstable state is left along a growing displacement.
Laws without a potential have tangents that are not symmetric, and there such a displacement may yet decay. A state to
which the flow returns, in steps in which growth would double, is stable.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import SMOOTH_PATHS, Equilibrium, are_pulled_apart, largest_change, status_of
from contactsim.solvers.cohesive.descent import descend
from contactsim.solvers.cohesive.gmres import LinearMap, gmres
from contactsim.solvers.cohesive.zone_preconditioner import ZonePreconditioner
from contactsim.status import Status
from contactsim.traits import Trait

MIN_FORCING, MAX_FORCING = 1e-3, 0.1
"""Smallest and largest relative residual of a linear solve."""
SAFETY = 0.3
"""Fraction of the tolerance to which a linear solve should reduce the residual."""
MAX_FLOW_FORCING = 3e-2
"""Largest relative residual of a linear solve in a step of the flow: its direction need not be exact."""
INITIAL_SHIFT, MIN_REFUSED_SHIFT, NEGLIGIBLE_SHIFT = 0.03, 0.02, 1e-3
"""Shift over the laws' largest tangent: at first, at least after a refused step, and below which it is set to zero."""
MAX_CHANGE_RATIO = 3.0
"""Newton's method ends once it has moved this many times as far as is of use."""
MAX_RESIDUAL = 0.1
"""Newton's method does not begin, or ends, where the residual is more than this part of the strength: the state is far
from the guess, and the end of its branch is sooner found by a flow."""
MAX_SHARED_ITERATIONS = 5
"""A preconditioner is made anew after a linear solve with more iterations than this."""
STEP_DIVISIONS = 1, 3
"""Parts into which the largest step of a flow is divided, one after the other, until the flow comes to rest."""
GROWTH_SHIFT, GROWTH_STEPS = 2.0, 12
"""Least shift over the rate of growth, and for how many steps, after an unstable state: growth doubles in each step."""
NUDGE, MAX_NUDGES = 0.03, 5
"""Size of the displacement that is added to an unstable state, over the interaction range, and how often at most."""


@dataclass(frozen=True)
class Growth:
    """A displacement (exerted, m) of largest value 1 that grows at an unstable state, and its rate, GPa/nm."""

    wave: Array
    rate: float


class Memory:
    """Preconditioner of the last state, which serves the next state nearly as well, and its softest wave."""

    def __init__(self) -> None:
        self._shared: ZonePreconditioner | None = None
        self._last: ZonePreconditioner | None = None
        self._fixed_modes = b""
        self._wave: Array | None = None

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

    def may_be_unstable(self, preconditioner: ZonePreconditioner) -> bool:
        """Return whether the state of a preconditioner may be unstable."""
        negative, self._wave = preconditioner.softest(self._wave)
        return negative

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
    flow_budget: int = 4000
    flow_step: float = 0.3
    trust_radius: float = 0.1
    fields = 40
    uses_guess = True
    accepts = SMOOTH_PATHS | {Trait.NON_CONSERVATIVE}

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
        worst_near = MAX_RESIDUAL if np.isfinite(within) else np.inf
        for count in range(self.newton_budget + 1):
            gap = problem.gap(displacement)
            traction, tangent = problem.tangent(gap)
            residual = problem.residual(displacement, traction)
            worst = problem.norm(residual)
            if count:
                distance = largest_change(problem, displacement - guess, self.trust_radius * problem.interaction_range)
            if (
                worst <= problem.tolerance
                or count == self.newton_budget
                or not (np.isfinite(worst) and worst <= worst_near and distance <= far)
            ):
                break
            precondition = memory.preconditioner(problem, tangent)
            change, iterations = self._solve(
                problem, tangent, precondition, residual, 0.0, self._forcing(problem, worst)
            )
            memory.record(iterations)
            displacement = displacement + change
        status = status_of(worst, problem)
        unstable = False
        if status is Status.CONVERGED:
            fresh = memory.renew(problem, tangent)
            unstable = memory.may_be_unstable(fresh) and self._growing(problem, tangent, fresh) is not None
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
            state = self._flow(problem, start, self.flow_step / parts, self.flow_budget * parts)
            iterations += state.iterations
            if state.status is not Status.MAX_ITERATIONS:
                break
        return replace(state, iterations=iterations)

    def _descend(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return the stable minimum of the energy below a state; one that is not stable is left."""
        state, iterations = descend(problem, start, self.flow_budget), 0
        for _ in range(MAX_NUDGES):
            iterations += state.iterations
            if state.status is not Status.CONVERGED:
                break
            tangent = problem.tangent(state.gap)[1]
            growing = self._growing(problem, tangent, ZonePreconditioner(problem, tangent))
            if growing is None:
                break
            nudged = state.displacement + NUDGE * problem.interaction_range * growing.wave
            state = descend(problem, nudged, self.flow_budget)
        return replace(state, largest_change=largest_change(problem, state.displacement - start), iterations=iterations)

    def _flow(self, problem: CohesiveProblem, start: Array, largest_step: float, budget: int) -> Equilibrium:
        """Return the end of the overdamped flow from a state.

        Parameters
        ----------
        problem
            The problem at the load step.
        start
            Coefficients of a displacement (exerted, m), nm.
        largest_step
            Largest change of the displacement in a step, over the interaction range.
        budget
            Largest number of steps.
        """
        displacement, shift = start, INITIAL_SHIFT * problem.law_stiffness
        status, worst, count, nudges = Status.MAX_ITERATIONS, np.inf, 0, 0
        least_shift, growth_steps = 0.0, 0  # of a flow that leaves an unstable state
        left: Array | None = None  # the state that the flow was made to leave, since it seemed to be unstable
        while count < budget:
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
                nudge = NUDGE * problem.interaction_range
                returned = left is not None and largest_change(problem, displacement - left) < nudge / 2
                if growing is None or returned:
                    status = Status.CONVERGED
                    break
                if nudges == MAX_NUDGES:
                    break
                nudges, least_shift, growth_steps = nudges + 1, GROWTH_SHIFT * growing.rate, GROWTH_STEPS
                shift = max(INITIAL_SHIFT * problem.law_stiffness, least_shift)
                left, displacement = displacement, displacement + nudge * growing.wave
                continue
            forcing = MAX_FLOW_FORCING if shift else self._forcing(problem, worst)
            change, _ = self._solve(problem, tangent, precondition, residual, shift, forcing)
            accepted, shift = self._judge_step(problem, change, residual, shift, largest_step)
            growth_steps -= accepted
            shift = max(shift, least_shift) if growth_steps > 0 else shift
            displacement = displacement + change if accepted else displacement
        distance = largest_change(problem, displacement - start)
        return Equilibrium(displacement, gap, traction, status, worst, distance, count)

    def _forcing(self, problem: CohesiveProblem, worst: float) -> float:
        """Return the relative residual to which a step of Newton's method is solved."""
        return float(np.clip(SAFETY * problem.tolerance / worst, MIN_FORCING, MAX_FORCING))

    def _judge_step(
        self, problem: CohesiveProblem, change: Array, residual: Array, shift: float, largest_step: float
    ) -> tuple[bool, float]:
        """Return whether a step of the flow is accepted, and the shift of the next step."""
        size = float(np.abs(problem.field(change)[: len(change)]).max())
        largest, stiffness = largest_step * problem.interaction_range, problem.law_stiffness
        downhill = float(np.vdot(change, residual).real) < 0
        if not (downhill and size <= 2 * largest):
            return False, max(3 * shift, MIN_REFUSED_SHIFT * stiffness)
        shift /= 3 if size < 0.3 * largest else 1.5 if size < largest else 1
        return True, shift if shift > NEGLIGIBLE_SHIFT * stiffness else 0.0

    def _growing(self, problem: CohesiveProblem, tangent: Tangent, precondition: ZonePreconditioner) -> Growth | None:
        """Return how a displacement grows on its own at a state; None if none does."""
        wave = precondition.growing()
        if wave is None:
            return None
        rate = -float(np.vdot(wave, problem.add_elastic(tangent(wave), wave)).real / np.vdot(wave, wave).real)
        if rate <= 0:
            return None
        return Growth(wave / np.abs(problem.field(wave)[: len(wave)]).max(), rate)

    def _solve(
        self,
        problem: CohesiveProblem,
        tangent: LinearMap,
        precondition: LinearMap,
        residual: Array,
        shift: float,
        forcing: float,
    ) -> tuple[Array, int]:
        """Return the solution of (K + T' + s) du = -r to a relative residual, and the iterations that it took."""

        def product(change: Array) -> Array:
            """Return (K + T' + s) times a change of the displacement."""
            out = tangent(change)
            if shift:
                out += shift * change
            return problem.add_elastic(out, change)

        unit = problem.strength  # squares of a weak law's tractions would underflow
        change, iterations = gmres(product, precondition, residual / -unit, forcing, self.krylov_budget)
        return unit * change, iterations
