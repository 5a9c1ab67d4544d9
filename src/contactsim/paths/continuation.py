"""Follow one branch of equilibria along a load path: each state starts from the one before.

The branch is that of a slow experiment: the equilibrium that the overdamped flow reaches from the last stable state.
Where continuation fails, the flow leads on, and the step is divided until it follows the branch or shows a jump. The
jump of one contact among many is located where the pull may be the largest since the approach turned.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.contact.wall import hold_wall, is_beyond_closure
from contactsim.grid import Array, OutOfWorkError
from contactsim.paths.extrapolation import MAX_AMPLIFICATION, History
from contactsim.paths.jumps import FOLD_WIDTH, Jump, JumpCriterion, Side, pull_of
from contactsim.paths.state import PathState
from contactsim.paths.step_division import Division, divide_step
from contactsim.solvers.cohesive.base import CohesiveSolver, Equilibrium
from contactsim.solvers.cohesive.linearised import grows_on_its_own
from contactsim.solvers.cohesive.multipliers import fit_solver
from contactsim.status import Status
from contactsim.traits import Trait

MAX_HALVINGS = 8
"""Largest number of times that a step, or a part of it, is halved."""
MAX_DIVIDED_TOLERANCE = 3e-3
"""Largest tolerance on paths whose steps are divided. Less exact states predict the next one so badly that more steps
are divided, and a path takes several times the work."""
FAILED_STEPS = 2
"""Newton steps without a solution, from which on a goal is taken to lie beyond the end of the branch: it is not tried
again before the next jump."""
MAX_RESTLESS = 2
"""Motions that do not come to rest, after which a step has no state."""
STATE_BUDGET = 50_000.0
"""Transforms that a state may take by default."""
LOCATING_SHARES = 0.8, 0.04
"""Parts of them that a path may take until its jumps are not located any more: once, and again for each state."""
MAX_FAILURES = 3
"""Steps in a row without a solution, each sought from the last stable state, after which a path ends."""


class Continuation:
    """The last accepted state of a path, and the history that predicts the next one.

    Parameters
    ----------
    problem
        The problem that the path solves.
    solver
        Solver of its states.
    fold_width
        Largest distance (nm) that the load moves the surface between both sides of a jump.
    divides
        If True, steps that continuation fails to take are divided as `divide_step` says.
    max_amplification
        Largest ratio of a prediction's error to those of the states that it follows from.
    budget
        Transforms that a state may take.
    """

    def __init__(
        self,
        problem: CohesiveProblem,
        solver: CohesiveSolver,
        fold_width: float = FOLD_WIDTH,
        divides: bool = True,
        max_amplification: float = MAX_AMPLIFICATION,
        budget: float = STATE_BUDGET,
    ) -> None:
        self._budget = budget
        self._locating_end = problem.counter.spent + LOCATING_SHARES[0] * budget
        self.passed_unlocated = False  # on the way to the current state
        self._divides = divides and solver.uses_guess
        if self._divides:
            problem = replace(problem, tolerance=min(problem.tolerance, MAX_DIVIDED_TOLERANCE))
        self.problem, self.solver = problem, fit_solver(solver, problem)
        self.history = History(max_amplification)
        self.displacement = np.zeros(problem.unknowns, complex)
        self._failures = 0
        self._leaves_unstable = False  # the current state, under a control that has just begun
        self._memory = solver.new_memory()
        self.current: Side | None = None  # step and state accepted last
        self._peak: Side | None = None  # those with the largest pull since a step of the path began, or a jump
        self.jumps = JumpCriterion(problem, fold_width)

    def begin(self, states: int) -> None:
        """Begin the way to so many requested states, and grant the work to locate the jumps on it."""
        self._locating_end += LOCATING_SHARES[1] * self._budget * states
        self.passed_unlocated = False

    @property
    def may_locate(self) -> bool:
        """True as long as there is work left to locate jumps, and to adapt increments."""
        return self.problem.counter.spent <= self._locating_end

    def parameter(self, target: LoadStep) -> float | None:
        """Return the load parameter of the current state, under the control of a target step; None at the beginning.

        It is an approach or a sliding distance in nm, or a mean pressure in GPa.
        """
        if self.current is not None and target.control is not self.current[0].control:
            self._change_control(target)
        return self.history.parameters[-1] if self.history.parameters else None

    def _change_control(self, target: LoadStep) -> None:
        """Continue from the current state under another control, which changes its parameter and its uniform mode."""
        assert self.current is not None
        step, state = self.current
        here, displacement = self.at(step), state.displacement.copy()
        normal = step.normal
        if target.normal.control is not step.normal.control:
            if target.normal.control is Trait.MEAN_PRESSURE:
                value = -float(state.traction[0].mean())
                displacement[0, 0] -= here.approach
            else:
                value = here.mean_displacement - float(displacement[0, 0].real) - here.origin
                displacement[0, 0] = here.mean_displacement
            normal = LoadStep(target.normal.control, value)
        current = normal
        if target.control is Trait.SLIDE:
            current = LoadStep(Trait.SLIDE, step.sliding_distance, held=normal)
        self.displacement = displacement
        self.jumps.forget()
        self.current = current, replace(state, displacement=displacement)
        self.history.restart(current.value, displacement)
        self._leaves_unstable = state.is_stable and self._grows(self.at(current), state)

    def at(self, step: LoadStep) -> CohesiveProblem:
        """Return the problem at a load step."""
        return self.problem.at(step)

    def prediction(self, step: LoadStep) -> Array:
        """Return the expected displacement at a step, (exerted, m)."""
        parameter = self.parameter(step)
        if parameter is None or not self.solver.uses_guess:
            return self.start(step)
        if self.history.turns_at(step.value) and abs(step.value - parameter) > self.trust_radius:
            return self.start(step)
        return self.history.extrapolate(step.value)

    def start(self, step: LoadStep) -> Array:
        """Return the current displacement at a step before anything gives way; on a slide the surfaces stick.

        The far side of the upper body moves on and shears it. A half-space moves as a whole and is not sheared.
        """
        here = self.at(step)
        if step.held is None or self.current is None or len(here.fixed_modes) < 2 or here.fixed_modes[1]:
            return self.displacement
        start = self.displacement.copy()
        start[1, 0] -= step.sliding_distance - self.current[0].sliding_distance
        return start

    @property
    def trust_radius(self) -> float:
        """Largest distance (nm) between a state and its prediction on the same branch."""
        return self.solver.trust_radius * self.problem.interaction_range

    def is_on_branch(self, state: Equilibrium) -> bool:
        """Return True if a state found by continuation is on the branch.

        It must lie where it is predicted. Over a lattice it must not have slipped by more than half a cell, because
        states a cell apart are alike, and a prediction that is off by a cell finds the wrong one.
        """
        if not (state.is_stable and state.largest_change <= self.trust_radius):
            return False
        return self.current is None or not self.jumps.slips_half_a_cell(self.current[1], state)

    def continue_to(self, step: LoadStep) -> Equilibrium:
        """Return the state at a step that the solver finds near its prediction."""
        return self.solver.solve_near(self.at(step), self.prediction(step), self._memory, self.trust_radius)

    def passes_instability(self, step: LoadStep, state: Equilibrium) -> bool:
        """Return True if the state halfway between the current one and that of a step is unstable, though both are not.

        A symmetric state, such as that of flat surfaces, exists before, after and while it is unstable.
        """
        return self.current is not None and self._grows(self.at(step), self.current[1], state)

    def _grows(self, here: CohesiveProblem, *states: Equilibrium) -> bool:
        """Return True if a small displacement grows on its own at the mean of states."""
        gap, traction = (np.mean([getattr(state, name) for state in states], 0) for name in ("gap", "traction"))
        return grows_on_its_own(hold_wall(here, gap, traction), gap)

    def flow_to(self, step: LoadStep) -> Equilibrium:
        """Return the state at a step that the overdamped flow reaches from the current one."""
        return self.solver.flow_from(self.at(step), self.start(step))

    def accept(self, step: LoadStep, state: Equilibrium, flowed: bool) -> Jump | None:
        """Make a state the current one; return the jump to it if it is one."""
        parameter = self.parameter(step)
        increment = np.inf if parameter is None else abs(step.value - parameter)
        jump = None
        distance, leaves = state.largest_change, self._leaves_unstable
        if flowed and self.current is not None and self.jumps.is_jump(step, increment, distance, leaves):
            jump = Jump(*self.current, step, state, distance, self._peak or self.current, (step, state))
        self._leaves_unstable = False
        if self.current is not None and not jump and 0 < increment < np.inf:
            self.jumps.learn(self.current, (step, state), state.displacement - self.displacement)
        if jump or (flowed and not self._divides):  # the branch may have ended
            self.history.restart(step.value, state.displacement)
        else:
            self.history.add(step.value, state.displacement)
        if self.current is not None and step.control is Trait.APPROACH:
            self.jumps.watch(self.current, (step, state))
        self.displacement, self.current = state.displacement, (step, state)
        if jump or self._peak is None or pull_of(self.current) > pull_of(self._peak):
            self._peak = self.current
        return jump

    def advance(self, step: LoadStep) -> PathState:
        """Return the state at the next step of the path, found by continuation or else by flow."""
        counter, here = self.problem.counter, self.at(step)
        if self._failures == MAX_FAILURES or is_beyond_closure(here):  # the path may come back from beyond closure
            status = Status.SKIPPED if self._failures == MAX_FAILURES else Status.NO_EQUILIBRIUM
            return PathState(step, here, self.displacement, status, np.nan, 0.0, 0, 0.0)
        self.begin(1)
        before = counter.transforms
        try:
            with counter.granted(self._budget):
                state, jumps, iterations = self.advance_to(step)
        except OutOfWorkError:
            self.end()
            cost = counter.transforms - before
            return PathState(step, here, self.displacement, Status.OVER_BUDGET, np.nan, 0.0, 0, cost)
        is_final = state.status in (Status.NO_EQUILIBRIUM, Status.NON_FINITE)
        self._failures = 0 if state.is_stable else MAX_FAILURES if is_final else self._failures + 1
        distance, cost = sum(jump.distance for jump in jumps), counter.transforms - before
        status = Status.UNLOCATED if state.is_stable and self.passed_unlocated else state.status
        numbers = status, state.residual, distance, iterations, cost
        return PathState(step, here, state.displacement, *numbers, state, jumps)

    def end(self) -> None:
        """Skip all steps that follow."""
        self._failures = MAX_FAILURES

    def advance_to(self, step: LoadStep) -> tuple[Equilibrium, tuple[Jump, ...], int]:
        """Advance to a step; return the state, the jumps on the way, and the iterations.

        Where continuation fails, the flow from the current state leads on. The step is divided, to find where the jump
        begins, with the exceptions of `divide_step`. A motion that does not come to rest is tried twice.
        """
        goals, divides, division, iterations, restless = [step.value], self._divides, Division.NONE, 0, 0
        self._peak = self.current
        jumps: list[Jump] = []
        beyond: set[float] = set()  # goals beyond the end of the branch
        while True:
            goal = replace(step, value=goals[-1])
            flowed = True
            hiding = self._divisible_increment(goal) if divides and len(goals) <= MAX_HALVINGS else 0.0
            increment = hiding if self.may_locate else 0.0
            if self.solver.uses_guess and not (increment and goal.value in beyond):
                state = self.continue_to(goal)
                iterations += state.iterations
                flowed = not self.is_on_branch(state)
                if state.status is Status.MAX_ITERATIONS and state.iterations >= FAILED_STEPS:
                    beyond.add(goal.value)
            if flowed:
                if not (increment and division is Division.LOCATE):
                    state = self.flow_to(goal)
                    iterations += state.iterations
                    last = self.current if state.is_stable else None
                    division = divide_step(self.jumps, last, (goal, state)) if last else Division.LOCATE
                    restless += state.status is Status.NO_REST
                    if restless == MAX_RESTLESS:
                        return state, self._with_last_peak(jumps), iterations
                if increment and division is not Division.NONE:
                    goals.append(goals[-1] - increment / 2)
                    continue
                self.passed_unlocated |= bool(hiding) and division is not Division.NONE
            if state.is_stable:
                jumps += [jump for jump in [self.accept(goal, state, flowed)] if jump]
                if flowed:
                    division = Division.NONE
                    beyond.clear()
            elif len(goals) > 1:  # no solution on the way: straight on
                goals, divides = [step.value], False
                continue
            goals.pop()
            if not goals:
                return state, self._with_last_peak(jumps), iterations

    def _with_last_peak(self, jumps: list[Jump]) -> tuple[Jump, ...]:
        """Return the jumps of a step, the last with the largest pull after it."""
        return (*jumps[:-1], *(replace(jump, peak_after=self._peak or jump.peak_after) for jump in jumps[-1:]))

    def _divisible_increment(self, step: LoadStep) -> float:
        """Return the change of the load to a step, with its sign, where a jump may hide in it; else zero."""
        parameter = self.parameter(step)
        increment = 0.0 if parameter is None else step.value - parameter
        return increment if self.jumps.may_hide_in(step, abs(increment)) else 0.0
