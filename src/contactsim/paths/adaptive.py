"""Increments as long as the prediction of the next state allows.

The states asked for are interpolated between those of one smooth stretch, never across a jump. As elasticity is linear,
the residual of an interpolated state is known without a transform: it is the traction at the interpolated gap less the
interpolated traction.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.loading import LoadStep
from contactsim.errors import SceneError, is_number
from contactsim.grid import Array
from contactsim.paths.continuation import Leap, PathState, Walk
from contactsim.paths.extrapolation import POINTS, lagrange, shares
from contactsim.solvers.cohesive.base import CohesiveSolver, Equilibrium
from contactsim.status import Status
from contactsim.traits import Trait

SAFETY, SHRINK, GROW = 0.9, 0.4, 2.0
"""Of an adaptive increment: share of the length that the error allows, least and largest change."""
ALLOWED, SHORTEST, LONGEST = 0.005, 0.01, 1.0
"""Error of a prediction, and increments of an approach, in the laws' length."""
CLOSE = 1e-6
"""Of an increment: what is nearer counts as the same place."""
REFUSED = 4.0
"""An increment is refused if its prediction was wrong by this many times what is allowed."""


@dataclass
class Stretch:
    """States of a walk between two jumps, by place, and the jumps that it begins with."""

    leaps: tuple[Leap, ...] = ()
    places: list[float] = field(default_factory=list)
    states: list[Equilibrium] = field(default_factory=list)

    def add(self, place: float, state: Equilibrium) -> None:
        """A state that the walk came through."""
        self.places.append(place)
        self.states.append(state)

    def near(self, problem: CohesiveProblem, place: float) -> Equilibrium:
        """The state at a place within, by the polynomial through the nearest states."""
        ahead = sum((other - place) * (self.places[0] - place) > 0 for other in self.places)  # before it on the walk
        first = min(max(ahead - POINTS // 2, 0), max(len(self.places) - POINTS, 0))
        places, states = (kept[first : first + POINTS] for kept in (self.places, self.states))
        if place in places:
            return states[places.index(place)]

        def between(name: str) -> Array:
            """A field of the states at that place."""
            return lagrange(places, [getattr(state, name) for state in states], place)

        gap = between("gap")
        traction = problem.traction(gap)
        left = traction - between("traction")
        left[problem.fixed_modes] -= left[problem.fixed_modes].mean(axis=1, keepdims=True)
        parts = zip(shares(places, place), states, strict=True)
        residual = float(np.abs(left).max() / problem.strength) + sum(abs(part) * of.residual for part, of in parts)
        status = Status.CONVERGED if residual <= problem.tolerance else Status.INTERPOLATED
        return Equilibrium(between("displacement"), gap, traction, status, residual, 0.0, 0)


@dataclass(frozen=True)
class Adaptive:
    """Increments as long as the prediction is right to `error` (nm), from `least` to `most` (nm or GPa).

    Left out, they are `ALLOWED`, `SHORTEST` and `LONGEST`; of a mean pressure the last two have to be given.
    """

    error: float | None = None
    least: float | None = None
    most: float | None = None

    def __post_init__(self) -> None:
        for name in ("error", "least", "most"):
            value = getattr(self, name)
            if value is not None and not (is_number(value) and value > 0):
                raise SceneError(name, value, "a positive number")
        if self.least is not None and self.most is not None and self.least > self.most:
            raise SceneError("least", self.least, f"at most the longest increment, {self.most:g}")

    def _allowed(self, problem: CohesiveProblem) -> float:
        """Error of a prediction, nm."""
        return self.error or ALLOWED * problem.interaction_range

    def check(self, points: int, steps: Sequence[LoadStep], solver: CohesiveSolver) -> None:
        """SceneError for a solver that makes no predictions, and where a pressure's increments have no bounds."""
        if not solver.uses_guess:
            raise SceneError("increments", "adaptive", f"requested: {type(solver).__name__} makes no predictions")
        given = {"least": self.least, "most": self.most}
        if None in given.values() and any(step.control is Trait.MEAN_PRESSURE for step in steps):
            raise SceneError("least", given, "least and most in GPa, where a mean pressure is prescribed")

    def coarsened(self, factor: int) -> Adaptive:
        """Return the same for a coarser grid: it does not depend on the grid."""
        return self

    def follow(
        self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Sequence[LoadStep]
    ) -> Iterator[PathState]:
        """States at all steps, in order, interpolated between those walked through."""
        self.check(problem.grid.size, steps, solver)
        walk, begin = Walk(problem, solver), 0
        while begin < len(steps):
            end = _turn(steps, begin, walk.place(steps[begin]))
            leg, spent = steps[begin:end], problem.tally.transforms
            iterations, stretches, status = self._walk(walk, leg)
            spent = problem.tally.transforms - spent
            lost = False
            for count, step in enumerate(leg):
                shared = (iterations, spent) if count == 0 else (0, 0.0)
                state = self._state(walk, step, leg, stretches, Status.SKIPPED if lost else status, shared)
                lost |= not state.status.solved
                yield state
            begin = end
            if status is not Status.CONVERGED:
                for step in steps[end:]:
                    yield PathState(step, walk.at(step), walk.last, Status.SKIPPED, np.nan, 0.0, 0, 0.0)
                return

    def _walk(self, walk: Walk, leg: Sequence[LoadStep]) -> tuple[int, list[Stretch], Status]:
        """Walk from where it stands to the last step of a leg: iterations spent, the stretches, and how it ended.

        Where a flow is needed it goes to the next state asked for, if that is within the least increment, so that a
        jump is found between the same two states as without adapting.
        """
        first, last = leg[0], leg[-1]
        reach, error = walk.problem.interaction_range, self._allowed(walk.problem)
        most = self.most or max(LONGEST * reach, self.least or 0.0)
        least = self.least or min(SHORTEST * reach, most)
        iterations, increment = 0, least
        stretches = [Stretch()]
        place = walk.place(first)
        if place is not None:
            stretches[0].add(place, walk.stands[1])
        while place != last.value:
            goal = first.value if place is None else _towards(place, last.value, increment)
            step = replace(first, value=goal)
            found, flowed = walk.near(step), False
            iterations += found.iterations
            order = walk.history.order
            wrong = found.largest_change if found.is_stable and walk.history.places else np.inf
            if not wrong <= REFUSED * error and increment > least and place is not None:
                increment = max(increment * SHRINK, least)
                continue
            leaps = ()
            if walk.believed(found):
                walk.accept(step, found, False)
            else:
                goal = next((other.value for other in leg if _between(place, other.value, goal)), goal)
                found, leaps, spent = self._flowed(walk, replace(first, value=goal))
                flowed, iterations = True, iterations + spent
            if not found.is_stable:
                return iterations, stretches, found.status
            if leaps:
                stretches.append(Stretch(leaps))
            stretches[-1].add(goal, found)
            growth = GROW if flowed or not 0 < wrong < np.inf else SAFETY * (error / wrong) ** (1 / (order + 1))
            increment = float(np.clip(increment * np.clip(growth, SHRINK, GROW), least, most))
            place = goal
        return iterations, stretches, Status.CONVERGED

    def _flowed(self, walk: Walk, step: LoadStep) -> tuple[Equilibrium, tuple[Leap, ...], int]:
        """The state at a step to which continuation did not lead: by flow, over a lattice in ever smaller steps."""
        if walk.slips:
            return walk.reach(step)
        found = walk.flow(step)
        leap = walk.accept(step, found, True) if found.is_stable else None
        return found, (leap,) if leap else (), found.iterations

    def _state(
        self,
        walk: Walk,
        step: LoadStep,
        leg: Sequence[LoadStep],
        stretches: list[Stretch],
        status: Status,
        spent: tuple[int, float],
    ) -> PathState:
        """The state asked for, from the stretch that holds it; solved for where interpolation is not good enough."""
        problem = walk.at(step)
        begun = stretches[0].places[0] if stretches[0].places else leg[0].value
        sign = 1 if leg[-1].value >= begun else -1
        reached = [stretch for stretch in stretches if stretch.places and sign * (step.value - stretch.places[0]) >= 0]
        if not reached or (status is not Status.CONVERGED and sign * (step.value - reached[-1].places[-1]) > 0):
            return PathState(step, problem, walk.last, status, np.nan, 0.0, *spent)
        stretch = reached[-1]
        beyond = sign * (step.value - stretch.places[-1]) > 0  # by rounding
        found = stretch.near(problem, stretch.places[-1] if beyond else step.value)
        if found.residual > problem.tolerance + self._allowed(problem) * problem.law_stiffness / problem.strength:
            before = problem.tally.transforms
            found = walk.solver.solve_near(problem, found.displacement, walk.solver.new_memory())
            spent = spent[0] + found.iterations, spent[1] + problem.tally.transforms - before
        earlier = [other.value for other in leg if sign * (step.value - other.value) > 0]
        since = [
            item
            for item in reached
            if item.leaps
            and (not earlier or sign * (item.places[0] - max(earlier, key=lambda value: sign * value)) > 0)
        ]
        leaps = tuple(leap for item in since for leap in item.leaps)
        numbers = found.status, found.residual, sum(leap.moved for leap in leaps), *spent
        return PathState(step, problem, found.displacement, *numbers, found, leaps)


def _towards(place: float, end: float, increment: float) -> float:
    """One increment from a place towards the end; the last two are alike, as states close by interpolate badly."""
    left = end - place
    if abs(left) <= increment * (1 + CLOSE):
        return end
    return place + np.copysign(min(increment, abs(left) / 2), left)


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
