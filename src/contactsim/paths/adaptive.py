"""Increments as long as the prediction of the next state allows.

The requested states are interpolated between those of one smooth segment, never across a jump. As elasticity is
linear, the residual of an interpolated state needs no transform: it is the traction at the interpolated gap minus the
interpolated traction.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from contactsim.arguments import Positive, checked
from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep, Steps
from contactsim.errors import InputError
from contactsim.grid import OutOfWorkError
from contactsim.paths.continuation import STATE_BUDGET, Continuation
from contactsim.paths.increment_control import ROUNDING, IncrementController
from contactsim.paths.jumps import FOLD_WIDTH, Jump
from contactsim.paths.legs import Leg, leg_end
from contactsim.paths.state import PathState
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.status import Status
from contactsim.traits import Trait

DEFAULT_ERROR, DEFAULT_MIN, DEFAULT_MAX = 0.005, 0.01, 1.0
"""Error of a prediction, and smallest and largest increment of an approach, in the laws' length."""
MIN_SHARE = 1e-9
"""Smallest increment that may be asked for, over the range of the path."""


@checked
@dataclass(frozen=True)
class Adaptive:
    """Increments that keep the error of the predictions constant.

    Parameters
    ----------
    error
        Allowed error of a prediction, nm; 0.005 of the laws' length by default.
    least, most
        Smallest and largest increment, nm or GPa; 0.01 and 1 of the laws' length by default. A mean pressure has no
        default.
    fold_width
        Largest distance (nm) that the load moves the surface between both sides of a jump: the step is divided.
    budget
        Transforms for each requested state; see `Requested`. Where no work is left to locate jumps, the requested steps
        are the increments.

    Raises
    ------
    InputError
        If a value is not positive, or `least` exceeds `most`.
    """

    error: Positive | None = None
    least: Positive | None = None
    most: Positive | None = None
    fold_width: Positive = FOLD_WIDTH
    budget: Positive = STATE_BUDGET
    needs_period = False

    def __post_init__(self) -> None:
        if self.least is not None and self.most is not None and self.least > self.most:
            raise InputError("least", self.least, f"at most the longest increment, {self.most:g}")

    def check(self, points: int, steps: Steps, solver: CohesiveSolver) -> None:
        """Raise InputError for a solver without predictions, and for a mean pressure without bounds."""
        if not solver.uses_guess:
            raise InputError("increments", "adaptive", f"requested: {type(solver).__name__} makes no predictions")
        bounds = {"least": self.least, "most": self.most}
        if None in bounds.values() and any(step.control is Trait.MEAN_PRESSURE for step in steps):
            raise InputError("least", bounds, "least and most in GPa, where a mean pressure is prescribed")
        reach = np.ptp([step.value for step in steps])
        if self.least is not None and self.least < MIN_SHARE * reach:
            raise InputError("least", self.least, f"at least {MIN_SHARE:g} of the path's {reach:g}")

    def follow(self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Steps) -> Iterator[PathState]:
        """Yield the states at all steps, in order, interpolated between solved states."""
        self.check(problem.grid.size, steps, solver)
        # increments that follow the error of the predictions need no other bound of it
        path, begin = Continuation(problem, solver, self.fold_width, max_amplification=np.inf), 0
        while begin < len(steps):
            end = leg_end(steps, begin, path.parameter(steps[begin]))
            transforms = problem.counter.transforms
            leg = Leg(steps[begin:end])
            try:
                with problem.counter.granted(self.budget * (end - begin)):
                    self._solve_leg(path, leg)
            except OutOfWorkError:
                leg.status = Status.OVER_BUDGET
            transforms = problem.counter.transforms - transforms
            lost = False
            for count, step in enumerate(leg.steps):
                cost = (leg.iterations, transforms) if count == 0 else (0, 0.0)
                state = self._requested_state(path, leg, step, Status.SKIPPED if lost else leg.status, cost)
                lost |= not state.status.solved
                yield state
            begin = end
            if leg.status is not Status.CONVERGED:
                for step in steps[end:]:
                    yield PathState(step, path.at(step), path.displacement, Status.SKIPPED, np.nan, 0.0, 0, 0.0)
                return

    def _controller(self, problem: CohesiveProblem) -> IncrementController:
        """Return a controller that begins with the smallest increment."""
        length = problem.interaction_range
        largest = self.most or max(DEFAULT_MAX * length, self.least or 0.0)
        smallest = self.least or min(DEFAULT_MIN * length, largest)
        return IncrementController(self._allowed_error(problem), smallest, largest, smallest)

    def _allowed_error(self, problem: CohesiveProblem) -> float:
        """Return the allowed error of a prediction, nm."""
        return self.error or DEFAULT_ERROR * problem.interaction_range

    def _solve_leg(self, path: Continuation, leg: Leg) -> None:
        """Solve states from the current one to the last step of a leg.

        Where continuation fails, the path goes on to the next requested step if that is within the increment. A jump is
        then found in the same step as without adaptive increments.
        """
        controller, steps = self._controller(path.problem), leg.steps
        path.begin(len(steps))
        first, last = steps[0], steps[-1]
        parameter = path.parameter(first)
        if parameter is not None and path.current is not None:
            leg.segments[0].add(parameter, path.current[1])
        while parameter != last.value:
            goal = first.value if parameter is None else controller.propose(parameter, last.value)
            adapts = path.may_locate
            if not adapts:
                goal = next((step.value for step in steps if _is_between(parameter, step.value, last.value)), goal)
            may_shrink = adapts and parameter is not None and controller.can_shrink
            jumps: tuple[Jump, ...] = ()
            state = path.continue_to(replace(first, value=goal))
            leg.iterations += state.iterations
            order = path.history.order
            error = state.largest_change if state.is_stable and path.history.parameters else np.inf
            if may_shrink and controller.rejects(error):
                controller.shrink()
                continue
            flowed = not path.is_on_branch(state)
            if not flowed and may_shrink and path.passes_instability(first, state):
                controller.shrink()
                continue
            if flowed:
                goal = next((step.value for step in steps if _is_between(parameter, step.value, goal)), goal)
                state, jumps, iterations = path.advance_to(replace(first, value=goal))
                leg.iterations += iterations
                if path.passed_unlocated and leg.unlocated is None:
                    leg.unlocated = goal
            else:
                path.accept(replace(first, value=goal), state, False)
            if not state.is_stable:
                leg.status = state.status
                break
            leg.add(goal, state, jumps)
            controller.accept(error, order, flowed)
            parameter = goal

    def _requested_state(
        self, path: Continuation, leg: Leg, step: LoadStep, status: Status, cost: tuple[int, float]
    ) -> PathState:
        """Return a requested state, interpolated in its segment, or solved where interpolation is not good enough."""
        problem, direction, segments = path.at(step), leg.direction, leg.passed_segments(step.value)
        unsolved = status is not Status.CONVERGED
        if not segments or (unsolved and direction * (step.value - segments[-1].parameters[-1]) > 0):
            return PathState(step, problem, path.displacement, status, np.nan, 0.0, *cost)
        segment = segments[-1]
        is_after_end = direction * (step.value - segment.parameters[-1]) > 0  # by rounding
        state = segment.interpolate(problem, segment.parameters[-1] if is_after_end else step.value)
        allowed = problem.tolerance + self._allowed_error(problem) * problem.law_stiffness / problem.strength
        off_load = 0.0 if problem.load is None else abs(float(state.traction[0].mean()) + problem.load)
        if state.residual > allowed or off_load > problem.tolerance * problem.strength:
            before = problem.counter.transforms
            state = path.solver.solve_near(problem, state.displacement, path.solver.new_memory())
            cost = cost[0] + state.iterations, cost[1] + problem.counter.transforms - before
        jumps = leg.jumps_before(step.value)
        distance, found = sum(jump.distance for jump in jumps), state.status
        if leg.unlocated is not None and found.solved and direction * (step.value - leg.unlocated) >= 0:
            found = Status.UNLOCATED
        return PathState(step, problem, state.displacement, found, state.residual, distance, *cost, state, jumps)


def _is_between(parameter: float | None, value: float, goal: float) -> bool:
    """Return True if a value lies after a parameter, by more than rounding, and not after the goal."""
    return parameter is not None and ROUNDING < (value - parameter) / (goal - parameter) <= 1
