"""A walk along a load path: each state starts from the one before, since the past decides.

The branch is that of a slow experiment: the equilibrium that the overdamped flow reaches from the last stable state.
Where continuation fails, a step is divided, so that what it does at once is what small steps would do, and what is
left in the end is a jump or none.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.loading import LoadStep
from contactsim.grid import Array
from contactsim.paths.extrapolation import History
from contactsim.solvers.cohesive.base import CohesiveSolver, Equilibrium, largest_change
from contactsim.status import Status
from contactsim.traits import Trait

SUDDEN, STEADY = 0.1, 5.0
"""A flow has jumped if it moved the surface by more than this part of the laws' length, and this times the step, which
is a length or, under a load, the length that the step before moved the surface by for each unit of load."""

FASTEST = 250.0
"""How many times as fast as it is driven a surface may slide over a lattice, which is seen as no jump."""

CLOSE = 3.0
"""Gaps, in the laws' length, over which sites of a lattice hold each other."""

DEEPEST = 8
"""Most times that a step, or a part of it, is halved."""

PATIENCE = 3
"""Steps in a row without a solution, each sought from the last stable state, after which a path breaks off."""


@dataclass(frozen=True)
class Leap:
    """A jump of the surface: the step and the state before, and after; moved: how far (nm)."""

    left: LoadStep
    before: Equilibrium = field(repr=False)
    step: LoadStep
    after: Equilibrium = field(repr=False)
    moved: float


@dataclass(frozen=True)
class PathState:
    """One state of the path: its load step, the problem there, its coefficients (exerted, m), and how it was found.

    residual: over the laws' strength; jump: how far (nm) the surface jumped since the state before, in all leaps;
    iterations and transforms: spent since the state before; found: the solution or what was interpolated, None after a
    break-off.
    """

    step: LoadStep
    problem: CohesiveProblem = field(repr=False)
    displacement: Array = field(repr=False)
    status: Status
    residual: float
    jump: float
    iterations: int
    transforms: float
    found: Equilibrium | None = field(default=None, repr=False)
    leaps: tuple[Leap, ...] = field(default=(), repr=False)

    @property
    def points(self) -> int:
        """Of the grid that it is a solution on."""
        return self.problem.grid.size

    def fields(self) -> tuple[Array, Array]:
        """Gap (read, n), nm, and traction (exerted, n), GPa."""
        if self.found is not None:
            return self.found.gap, self.found.traction
        gap = self.problem.gap(self.displacement)
        return gap, self.problem.traction(gap)


class Walk:
    """Where a path stands: the last stable state, and the history that predicts the next."""

    def __init__(self, problem: CohesiveProblem, solver: CohesiveSolver, divides: bool = True) -> None:
        self.problem, self.solver = problem, solver
        self._divides = divides and solver.uses_guess
        self.history = History()
        self.last = np.zeros(problem.unknowns, complex)
        self._failed = 0
        self._memory = solver.new_memory()
        self.stands: tuple[LoadStep, Equilibrium] | None = None  # the last state and its step
        self._pace: float | None = None

    def place(self, to: LoadStep) -> float | None:
        """Where it stands, nm or GPa, on the way to a step; None at the beginning."""
        if self.stands is not None and to.control is not self.stands[0].control:
            self._turn(to)
        return self.history.places[-1] if self.history.places else None

    def _turn(self, to: LoadStep) -> None:
        """Go on from the last state under another control, where it has another place and maybe uniform mode."""
        step, state = self.stands
        here, last = self.at(step), state.displacement.copy()
        stands = step.normal
        if to.normal.control is not step.normal.control:
            if to.normal.control is Trait.MEAN_PRESSURE:
                place = -float(state.traction[0].mean())
                last[0, 0] -= here.approach
            else:
                place = here.mean_displacement - float(last[0, 0].real) - here.origin
                last[0, 0] = here.mean_displacement
            stands = LoadStep(to.normal.control, place)
        if to.control is Trait.SLIDE:
            stands = LoadStep(Trait.SLIDE, step.sliding_distance, held=stands)
        place = stands.value
        self.last, self._pace = last, None
        self.stands = stands, replace(state, displacement=last)
        self.history = History()
        self.history.add(place, last)

    def at(self, step: LoadStep) -> CohesiveProblem:
        """The problem at a load step."""
        return self.problem.at(step)

    def guess(self, step: LoadStep) -> Array:
        """Where the state is expected."""
        place = self.place(step)
        if place is None or not self.solver.uses_guess:
            return self.start(step)
        if self.history.holds(step.value) and abs(step.value - place) > self.near_by:
            return self.start(step)
        return self.history.guess(step.value)

    def start(self, step: LoadStep) -> Array:
        """The last state at a step, before anything gives way: on a slide, surfaces that stay where they are.

        The far side of a body moves on and shears it; a half-space, of which the mean is moved, is not sheared.
        """
        here = self.at(step)
        if step.held is None or self.stands is None or len(here.fixed_modes) < 2 or here.fixed_modes[1]:
            return self.last
        start = self.last.copy()
        start[1, 0] -= step.sliding_distance - self.stands[0].sliding_distance
        return start

    @property
    def near_by(self) -> float:
        """How far (nm) a state may lie from where it is expected, to be believed on the same branch."""
        return self.solver.trust_radius * self.problem.interaction_range

    def believed(self, found: Equilibrium) -> bool:
        """Whether a state by continuation is on the branch: where it is expected and, over a lattice, not a cell on.

        States a cell apart are alike, and a guess that is wrong by one finds the wrong one at once.
        """
        if not (found.is_stable and found.largest_change <= self.near_by):
            return False
        if self.stands is None or not self.slips:
            return True
        close = found.gap[0] <= CLOSE * self.problem.interaction_range
        slipped = np.abs(found.gap[1, close] - self.stands[1].gap[1, close]).max(initial=0.0)
        return bool(slipped <= self.problem.lattice_constant / 2)

    def near(self, step: LoadStep) -> Equilibrium:
        """The state by continuation alone."""
        return self.solver.solve_near(self.at(step), self.guess(step), self._memory, self.near_by)

    def flow(self, step: LoadStep) -> Equilibrium:
        """The state by flow from the last stable one."""
        return self.solver.flow_from(self.at(step), self.start(step))

    def accept(self, step: LoadStep, found: Equilibrium, flowed: bool) -> Leap | None:
        """Move on to a state; the jump to it, if it is one."""
        before = self.place(step)
        taken = np.inf if before is None else abs(step.value - before)
        expected = (
            np.inf
            if taken == np.inf
            else max(STEADY * self._length(step, taken), SUDDEN * self.problem.interaction_range)
        )
        if step.held is not None and before is not None:  # a slip of a cell is one, however long the step
            expected = min(expected, self.problem.lattice_constant / 2)
        jump = (
            Leap(*self.stands, step, found, found.largest_change)
            if flowed and found.largest_change > expected
            else None
        )
        if step.control is Trait.MEAN_PRESSURE and not jump and 0 < taken < np.inf:
            self._pace = largest_change(self.problem, found.displacement - self.last) / taken
        if jump:
            self.history.restart(step.value, found.displacement)
        else:
            self.history.add(step.value, found.displacement)
        self.last, self.stands = found.displacement, (step, found)
        return jump

    def advance(self, step: LoadStep) -> PathState:
        """The state at the next step: by continuation, or where that is not to be trusted by flow."""
        tally, here = self.problem.tally, self.at(step)
        if self._failed == PATIENCE:
            return PathState(step, here, self.last, Status.SKIPPED, np.nan, 0.0, 0, 0.0)
        before = tally.transforms
        found, leaps, spent = self.reach(step)
        lost = found.status in (Status.NO_EQUILIBRIUM, Status.NON_FINITE)  # nothing comes after that
        self._failed = 0 if found.is_stable else PATIENCE if lost else self._failed + 1
        cost = tally.transforms - before
        numbers = found.status, found.residual, sum(leap.moved for leap in leaps), spent, cost
        return PathState(step, here, found.displacement, *numbers, found, leaps)

    def reach(self, step: LoadStep) -> tuple[Equilibrium, tuple[Leap, ...], int]:
        """Go to a step, by way of others between if need be: the state, jumps on the way, iterations spent."""
        goals, divides, leaps, spent = [step.value], self._divides, [], 0
        while True:
            goal = replace(step, value=goals[-1])
            found, flowed = self.near(goal) if self.solver.uses_guess else None, False
            spent += found.iterations if found else 0
            if found is None or not self.believed(found):
                place = self.place(step)
                divisible = divides and len(goals) <= DEEPEST and place is not None
                if divisible and self._length(goal, abs(goals[-1] - place)) > self._small:
                    goals.append((place + goals[-1]) / 2)
                    continue
                found, flowed = self.flow(goal), True
                spent += found.iterations
            if found.is_stable:
                leaps += [leap for leap in [self.accept(goal, found, flowed)] if leap]
            elif len(goals) > 1:  # no solution on the way: straight on
                goals, divides = [step.value], False
                continue
            goals.pop()
            if not goals:
                return found, tuple(leaps), spent

    @property
    def slips(self) -> bool:
        """Whether surfaces slide over a lattice, where smooth motion may be fast."""
        return np.isfinite(self.problem.lattice_constant)

    @property
    def _small(self) -> float:
        """A step (nm) not worth dividing: what moves smoothly during it is not taken for a jump."""
        return SUDDEN * self.problem.interaction_range / (FASTEST if self.slips else STEADY)

    def _length(self, step: LoadStep, taken: float) -> float:
        """About how far (nm) a step of that size moves the surface where it does not jump: unknown, infinitely far."""
        if step.control is not Trait.MEAN_PRESSURE:
            return taken
        return np.inf if self._pace is None else self._pace * taken
