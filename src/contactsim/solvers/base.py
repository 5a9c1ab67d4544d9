"""One loop for all solvers, and what comes out of it.

A solver takes a problem and a state and returns a better state; the loop repeats that, stops on a budget or on a value
that is not finite, and calls a state converged only after the certificate has been recomputed from the pressure alone.
Inner iterations and coarser grids are the solver's own affair; their work is counted through the operators.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from contactsim.contact.hard_wall import Certificate, HardWallProblem, Scale
from contactsim.contact.scene import Scene
from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.status import Status
from contactsim.traits import Trait


@dataclass(frozen=True)
class State:
    """Where a solver is: its pressure (n,) or (ny, nx), without units, and whether it believes to be done."""

    pressure: Array
    done: bool


class HardWallSolver(Protocol):
    """A method for some kinds of scene.

    accepts: the traits it can take; budget: most outer steps; fields: doubles a point and component that it holds at
    its peak, with the problem's own.
    """

    accepts: frozenset[Trait]
    budget: int
    fields: int

    def transforms(self, points: int) -> float:
        """Real transforms of an iteration on a grid of that size."""
        ...

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> State:
        """The first state, from a guess of the pressure where there is one."""
        ...

    def step(self, problem: HardWallProblem, state: State) -> State:
        """A better state."""
        ...


@dataclass(frozen=True)
class Record:
    """What a solution cost and how good it is: reproducible bit for bit at one number of threads.

    iterations: outer steps; transforms: in equivalents of one on the finest grid; certificate: in grid steps.
    """

    iterations: int
    transforms: float
    certificate: Certificate


@dataclass(frozen=True)
class Result:
    """One solved load step.

    pressure (n,) or (ny, nx), GPa, never negative; gap likewise, nm; approach, nm (see
    `contactsim.contact.loading`); mean_pressure, GPa; seconds: of CPU, apart from the record because it is not
    reproducible.
    """

    pressure: Array = field(repr=False)
    gap: Array = field(repr=False)
    approach: float
    status: Status
    record: Record
    seconds: float

    @property
    def contact(self) -> Array:
        """Points with positive pressure, bool (n,) or (ny, nx): the criterion `touching` of Chapter 3."""
        return self.pressure > 0

    @property
    def relative_contact_area(self) -> float:
        """Fraction of points in contact."""
        return float(self.contact.mean())

    @property
    def mean_pressure(self) -> float:
        """Mean over the period (GPa)."""
        return float(self.pressure.mean())


def require(solver: HardWallSolver, scene: Scene) -> None:
    """Refuse what is no solver, and a scene with a trait that the solver does not accept."""
    if isinstance(solver, type) or not hasattr(solver, "accepts"):
        raise SceneError("solver", solver, "the name of a solver, or a solver made with its options")
    for trait in sorted(scene.traits - solver.accepts, key=lambda trait: trait.name):
        accepted = ", ".join(sorted(known.name for known in solver.accepts))
        raise SceneError(
            "solver",
            type(solver).__name__,
            f"one that accepts {trait.name} ({trait.value}); this one accepts {accepted}",
        )


def check_cascade(coarsest: int, coarse_tolerance: float) -> None:
    """Refuse options of a cascade of coarser grids that make none."""
    if not coarse_tolerance > 0:
        raise SceneError("coarse_tolerance", coarse_tolerance, "a positive number of grid steps")
    if coarsest < 2:
        raise SceneError("coarsest", coarsest, "a whole number of points, 2 or more")


def iterate(solver: HardWallSolver, problem: HardWallProblem, state: State, budget: int) -> tuple[State, int, bool]:
    """Step until the solver believes to be done, the budget is spent, or a value is not finite.

    Returns the last state with finite values, the number of steps, and whether all values were finite.
    """
    for count in range(1, budget + 1):
        following = solver.step(problem, state)
        if not (np.isfinite(following.pressure.sum()) or np.isfinite(following.pressure).all()):
            return state, count, False
        state = following
        if state.done:
            return state, count, True
    return state, budget, True


def solve(solver: HardWallSolver, problem: HardWallProblem, scale: Scale) -> Result:
    """Solve one load step and certify it; in physical units."""
    begin = time.process_time()
    status, spent = Status.CONVERGED, 0
    if problem.untouched:
        pressure = np.zeros_like(problem.heights)
        certificate, gap = problem.certify(pressure)
    else:
        state = solver.start(problem)
        status = Status.MAX_ITERATIONS
        while status is Status.MAX_ITERATIONS:
            pressure = gap = None  # no memory is held beside the solver's
            state, count, finite = iterate(solver, problem, state, solver.budget - spent)
            spent += count
            pressure = problem.admissible(state.pressure)
            certificate, gap = problem.certify(pressure)
            if not finite:
                status = Status.NON_FINITE
            elif certificate.met(problem.tolerance):
                status = Status.CONVERGED
            elif spent >= solver.budget:
                break
    record = Record(spent, problem.tally.transforms, certificate)
    pressure *= scale.pressure
    gap *= scale.step
    return Result(
        pressure=pressure,
        gap=gap,
        approach=certificate.approach * scale.step - scale.highest + scale.sunk,
        status=status,
        record=record,
        seconds=time.process_time() - begin,
    )
