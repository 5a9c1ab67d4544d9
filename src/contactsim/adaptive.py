"""Increments as long as the prediction of the next state allows.

The states asked for are interpolated between those of one smooth stretch, never across a jump.
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
from contactsim.solvers.equilibrium import PathSolver
from contactsim.solvers.predictor import POINTS, lagrange
from contactsim.walk import PathState, Walk

SAFETY, SHRINK, GROW = 0.9, 0.4, 2.0
"""Of an adaptive increment: share of the length that the error allows, least and largest change."""
CLOSE = 1e-6
"""Of an increment: what is nearer counts as the same place."""
REFUSED = 4.0
"""An increment is refused if its prediction was wrong by this many times what is allowed."""


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
            end = _turn(steps, begin, walk.place(steps[begin].control))
            leg, spent = steps[begin:end], problem.tally.transforms
            iterations, stretches, status = self._walk(walk, leg)
            spent = problem.tally.transforms - spent
            for count, step in enumerate(leg):
                shared = (iterations, spent) if count == 0 else (0, 0.0)
                yield self._state(problem.at(step), step, leg, stretches, status, shared)
            begin = end
            if status is not Status.CONVERGED:
                for step in steps[end:]:
                    yield PathState(step, walk.at(step), walk.last, Status.BROKEN_OFF, np.nan, 0.0, 0, 0.0)
                return

    def _walk(self, walk: Walk, leg: Sequence[LoadStep]) -> tuple[int, list[Stretch], Status]:
        """Walk from the first step of a leg to its last: iterations spent, the stretches, and how it ended.

        Where a flow is needed it goes to the next state asked for, if that is within the least increment, so that a
        jump is found between the same two states as without adapting.
        """
        first, last = leg[0], leg[-1]
        iterations, increment = 0, self.least
        stretches = [Stretch(0.0)]
        place = walk.place(first.control)
        if place is not None:
            stretches[0].places.append(place)
            stretches[0].states.append(walk.last)
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
        self,
        problem: InterfaceProblem,
        step: LoadStep,
        leg: Sequence[LoadStep],
        stretches: list[Stretch],
        status: Status,
        spent: tuple,
    ) -> PathState:
        """The state asked for, from the stretch that holds it; between two, the end of the earlier."""
        begun = stretches[0].places[0] if stretches[0].places else leg[0].value
        sign = 1 if leg[-1].value >= begun else -1
        reached = [stretch for stretch in stretches if stretch.places and sign * (step.value - stretch.places[0]) >= 0]
        stretch = reached[-1] if reached else stretches[0]
        beyond = sign * (step.value - stretch.places[-1]) > 0
        if beyond and stretch is stretches[-1] and status is not Status.CONVERGED:
            return PathState(step, problem, stretch.states[-1], status, np.nan, 0.0, *spent)
        place = stretch.places[-1] if beyond else step.value
        earlier = [other.value for other in leg if sign * (step.value - other.value) > 0]
        jumped = sum(
            item.jump
            for item in reached
            if not earlier or sign * (item.places[0] - max(earlier, key=lambda value: sign * value)) > 0
        )
        return PathState(step, problem, stretch.near(place), Status.CONVERGED, np.nan, jumped, *spent)


def _towards(place: float, end: float, increment: float) -> float:
    """One increment from a place towards the end, which is not overshot nor approached by less than a millionth."""
    left = end - place
    return end if abs(left) <= increment * (1 + CLOSE) else place + np.copysign(increment, left)


def _between(place: float | None, value: float, goal: float) -> bool:
    """Whether a value lies after a place, by more than rounding, and not beyond the goal."""
    return place is not None and CLOSE < (value - place) / (goal - place) <= 1


def _turn(steps: Sequence[LoadStep], begin: int, last: float | None) -> int:
    """Where the leg that begins at a step ends, exclusive: of one control, in one direction; a hold is one too.

    last: where the path stands before it, if it does.
    """
    before, way = last, None
    for place in range(begin, len(steps)):
        if steps[place].control is not steps[begin].control:
            return place
        now = None if before is None else float(np.sign(steps[place].value - before))
        if way is not None and now != way:
            return place
        before, way = steps[place].value, now
    return len(steps)
