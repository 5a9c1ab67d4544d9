"""Follow smooth laws through a load path: each state starts from the one before, since the past decides.

The branch is that of a slow experiment: the equilibrium that the overdamped flow reaches from the last stable state.
With increments as requested every state asked for is solved. With adaptive increments the path is walked in steps as
long as the prediction of the next state allows, and the states asked for are interpolated between those of one smooth
stretch, never across a jump.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from contactsim.errors import SceneError, is_number
from contactsim.grid import Array
from contactsim.interface import InterfaceProblem
from contactsim.loading import LoadStep
from contactsim.solvers.base import Status
from contactsim.solvers.equilibrium import Equilibrium, PathSolver, moved
from contactsim.solvers.predictor import POINTS, History, lagrange
from contactsim.traits import Trait

SUDDEN, STEADY = 0.1, 5.0
"""A flow has jumped if it moved the surface by more than this part of the laws' length, and this times the step, which
is a length or, under a load, the length that the step before moved the surface by for each unit of load."""
SAFETY, SHRINK, GROW = 0.9, 0.4, 2.0
"""Of an adaptive increment: share of the length that the error allows, least and largest change."""
REFUSED = 4.0
"""An increment is refused if its prediction was wrong by this many times what is allowed."""


@dataclass(frozen=True)
class PathState:
    """One state of the path: its load step, displacement (exerted, m), coefficients, and how it was found.

    residual: over the laws' strength, NaN where interpolated; jump: how far (nm) the surface jumped since the state
    before; iterations and transforms: spent since the state before; found: the solution, unless interpolated.
    """

    step: LoadStep
    displacement: Array = field(repr=False)
    status: Status
    residual: float
    jump: float
    iterations: int
    transforms: float
    found: Equilibrium | None = field(default=None, repr=False)

    def fields(self, problem: InterfaceProblem) -> tuple[Array, Array]:
        """Gap (read, n), nm, and traction (exerted, n), GPa, in the problem posed at this step."""
        if self.found is not None:
            return self.found.gap, self.found.traction
        gap = problem.gap(self.displacement)
        return gap, problem.traction(gap)


class Walk:
    """Where a path stands: the last stable state, and the history that predicts the next."""

    def __init__(self, problem: InterfaceProblem, solver: PathSolver) -> None:
        self.problem, self.solver = problem, solver
        self.history = History()
        self.last = np.zeros(problem.unknowns, complex)
        self._memory = solver.begin_walk()
        self._pace: float | None = None

    def at(self, step: LoadStep) -> InterfaceProblem:
        """The problem at a load step."""
        return self.problem.at(step)

    def guess(self, place: float) -> Array:
        """Where the state is expected."""
        return self.history.guess(place) if self.solver.predicts and self.history.places else self.last

    def near(self, step: LoadStep) -> Equilibrium:
        """The state by continuation alone."""
        return self.solver.near(self.at(step), self.guess(step.value), self._memory)

    def flow(self, step: LoadStep) -> Equilibrium:
        """The state by flow from the last stable one."""
        return self.solver.flow(self.at(step), self.last)

    def accept(self, step: LoadStep, found: Equilibrium, flowed: bool) -> float:
        """Move on to a state; how far the surface jumped to it."""
        taken = abs(step.value - self.history.places[-1]) if self.history.places else np.inf
        expected = np.inf if taken == np.inf else STEADY * self._length(step, taken)
        jump = found.moved if flowed and found.moved > max(SUDDEN * self.problem.reach, expected) else 0.0
        if step.control is Trait.MEAN_PRESSURE and not jump and 0 < taken < np.inf:
            self._pace = moved(self.problem, found.displacement - self.last) / taken
        if jump:
            self.history.restart(step.value, found.displacement)
        else:
            self.history.add(step.value, found.displacement)
        self.last = found.displacement
        return jump

    def _length(self, step: LoadStep, taken: float) -> float:
        """About how far (nm) a step of that size moves the surface where it does not jump: unknown, infinitely far."""
        if step.control is Trait.APPROACH:
            return taken
        return np.inf if self._pace is None else self._pace * taken


@dataclass(frozen=True)
class Requested:
    """Every increment of the path as it is asked for."""

    def follow(self, problem: InterfaceProblem, solver: PathSolver, steps: Sequence[LoadStep]) -> Iterator[PathState]:
        """States at all steps, in order."""
        walk = Walk(problem, solver)
        broken = None
        for step in steps:
            if broken is not None:
                yield PathState(step, broken, Status.BROKEN_OFF, np.nan, 0.0, 0, 0.0)
                continue
            before = problem.tally.transforms
            found, spent, flowed = walk.near(step) if solver.predicts else None, 0, False
            if found is None or not (found.settled and found.moved <= solver.trusted * problem.reach):
                spent, flowed = found.iterations if found else 0, True
                found = walk.flow(step)
            jump = 0.0
            if found.settled:
                jump = walk.accept(step, found, flowed)
            else:
                broken = found.displacement
            spent, cost = spent + found.iterations, problem.tally.transforms - before
            yield PathState(step, found.displacement, found.status, found.residual, jump, spent, cost, found)


@dataclass
class Stretch:
    """States of a walk between two jumps, by place, and the jump that it begins with."""

    jump: float
    places: list[float] = field(default_factory=list)
    states: list[Array] = field(default_factory=list)

    def near(self, place: float) -> Array:
        """The state at a place within, by the polynomial through the nearest states."""
        nearest = np.argsort(np.abs(np.asarray(self.places) - place), kind="stable")[:POINTS]
        return lagrange([self.places[i] for i in nearest], [self.states[i] for i in nearest], place)


@dataclass(frozen=True)
class Adaptive:
    """Increments as long as the prediction is right to `error` (nm), from `least` to `most` (nm or GPa)."""

    error: float = 0.005
    least: float = 0.01
    most: float = 1.0

    def __post_init__(self) -> None:
        for name in ("error", "least", "most"):
            if not (is_number(getattr(self, name)) and getattr(self, name) > 0):
                raise SceneError(name, getattr(self, name), "a positive number")
        if self.least > self.most:
            raise SceneError("least", self.least, f"at most the longest increment, {self.most:g}")

    def follow(self, problem: InterfaceProblem, solver: PathSolver, steps: Sequence[LoadStep]) -> Iterator[PathState]:
        """States at all steps, in order, interpolated between those walked through."""
        if not solver.predicts:
            raise SceneError("increments", "adaptive", f"requested: {type(solver).__name__} makes no predictions")
        walk, begin = Walk(problem, solver), 0
        while begin < len(steps):
            end = _turn(steps, begin)
            leg, spent = steps[begin:end], problem.tally.transforms
            iterations, stretches, status = self._walk(walk, leg)
            spent = problem.tally.transforms - spent
            for count, step in enumerate(leg):
                shared = (iterations, spent) if count == 0 else (0, 0.0)
                yield self._state(step, leg, stretches, status, shared)
            begin = end
            if status is not Status.CONVERGED:
                for step in steps[end:]:
                    yield PathState(step, walk.last, Status.BROKEN_OFF, np.nan, 0.0, 0, 0.0)
                return

    def _walk(self, walk: Walk, leg: Sequence[LoadStep]) -> tuple[int, list[Stretch], Status]:
        """Walk from the first step of a leg to its last: iterations spent, the stretches, and how it ended.

        Where a flow is needed it goes to the next state asked for, if that is within the least increment, so that a
        jump is found between the same two states as without adapting.
        """
        first, last = leg[0], leg[-1]
        iterations, increment = 0, self.least
        stretches = [Stretch(0.0)]
        if walk.history.places:
            stretches[0].places.append(walk.history.places[-1])
            stretches[0].states.append(walk.last)
            place = walk.history.places[-1]
        else:
            place = None
        while place != last.value:
            goal = first.value if place is None else _towards(place, last.value, increment)
            step = LoadStep(first.control, goal)
            found, flowed = walk.near(step), False
            iterations += found.iterations
            order = walk.history.order
            wrong = found.moved if found.settled and walk.history.places else np.inf
            if not wrong <= REFUSED * self.error and increment > self.least and place is not None:
                increment = max(increment * SHRINK, self.least)
                continue
            if not (found.settled and found.moved <= walk.solver.trusted * walk.problem.reach):
                goal = next((other.value for other in leg if _between(place, other.value, goal)), goal)
                found, flowed = walk.flow(LoadStep(first.control, goal)), True
                iterations += found.iterations
            if not found.settled:
                return iterations, stretches, found.status
            jump = walk.accept(LoadStep(first.control, goal), found, flowed)
            if jump:
                stretches.append(Stretch(jump))
            stretches[-1].places.append(goal)
            stretches[-1].states.append(found.displacement)
            growth = GROW if flowed or not 0 < wrong < np.inf else SAFETY * (self.error / wrong) ** (1 / (order + 1))
            increment = float(np.clip(increment * np.clip(growth, SHRINK, GROW), self.least, self.most))
            place = goal
        return iterations, stretches, Status.CONVERGED

    def _state(
        self, step: LoadStep, leg: Sequence[LoadStep], stretches: list[Stretch], status: Status, spent: tuple
    ) -> PathState:
        """The state asked for, from the stretch that holds it; between two, the end of the earlier."""
        sign = 1 if leg[-1].value >= leg[0].value else -1
        reached = [stretch for stretch in stretches if stretch.places and sign * (step.value - stretch.places[0]) >= 0]
        stretch = reached[-1] if reached else stretches[0]
        beyond = sign * (step.value - stretch.places[-1]) > 0
        if beyond and stretch is stretches[-1] and status is not Status.CONVERGED:
            return PathState(step, stretch.states[-1], status, np.nan, 0.0, *spent)
        place = stretch.places[-1] if beyond else step.value
        earlier = [other.value for other in leg if sign * (step.value - other.value) > 0]
        jumped = sum(
            item.jump
            for item in reached
            if not earlier or sign * (item.places[0] - max(earlier, key=lambda value: sign * value)) > 0
        )
        return PathState(step, stretch.near(place), Status.CONVERGED, np.nan, jumped, *spent)


def _towards(place: float, end: float, increment: float) -> float:
    """One increment from a place towards the end, which is not overshot nor approached by less than a millionth."""
    left = end - place
    return end if abs(left) <= increment * (1 + 1e-6) else place + np.copysign(increment, left)


def _between(place: float | None, value: float, goal: float) -> bool:
    """Whether a value lies after a place and not beyond the goal."""
    return place is not None and (value - place) * (goal - place) > 0 and abs(value - place) <= abs(goal - place)


def _turn(steps: Sequence[LoadStep], begin: int) -> int:
    """Where the monotone leg that begins at a step ends, exclusive."""
    for place in range(begin + 1, len(steps)):
        if steps[place].control is not steps[begin].control:
            return place
        if place >= begin + 2:
            now, before = (steps[i].value - steps[i - 1].value for i in (place, place - 1))
            if now * before < 0:
                return place
    return len(steps)


INCREMENTS = {"requested": Requested, "adaptive": Adaptive}
