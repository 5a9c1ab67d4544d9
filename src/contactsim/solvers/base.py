"""The outer loop of all hard-wall solvers, and the result of a load step.

A solver takes a problem and a state and returns a better state. The loop repeats that. It calls a state converged only
after the certificate has been recomputed from the pressure alone; it stops after the largest number of steps or at a
value that is not finite. Inner iterations and coarser grids are the solver's own affair; their work is counted by the
operators.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from contactsim.contact.certificate import Certificate
from contactsim.contact.scene import Scene
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.status import Status
from contactsim.traits import Trait

if TYPE_CHECKING:
    from contactsim.contact.hard_wall import HardWallProblem, Scale


class Solver(Protocol):
    """Common part of the solvers of both kinds of problem."""

    @property
    def accepts(self) -> frozenset[Trait]:
        """Traits of the scenes that it can solve."""

    @property
    def fields(self) -> float:
        """Memory at its peak, with that of the problem: doubles at each point and for each component."""

    def transforms(self, points: int) -> float:
        """Return the real transforms of one iteration, for each unknown component, on a grid of that many points."""


@dataclass(frozen=True)
class State:
    """Pressure (n,) or (ny, nx), without units, and whether the solver believes that it has converged."""

    pressure: Array
    done: bool


class HardWallSolver(Solver, Protocol):
    """A method for problems with a hard wall."""

    @property
    def budget(self) -> int:
        """Largest number of outer steps."""

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> Any:
        """Return the first state, from a guess of the pressure if there is one."""

    def step(self, problem: HardWallProblem, state: Any) -> Any:
        """Return a better state; where memory is short, in the memory of the pressure of this one."""


@dataclass(frozen=True)
class Record:
    """Cost and quality of a solution; reproducible bit for bit at one number of threads.

    Parameters
    ----------
    iterations
        Outer steps.
    transforms
        Real transforms, in equivalents of one on the finest grid.
    certificate
        Errors of the solution, lengths in grid steps.
    """

    iterations: int
    transforms: float
    certificate: Certificate


@dataclass(frozen=True)
class Result:
    """One solved load step.

    Parameters
    ----------
    pressure
        Pressure (n,) or (ny, nx), GPa; never negative.
    gap
        Gap of the same shape, nm.
    approach
        Approach, nm; see `contactsim.contact.loading`.
    status
        Status of the solution.
    record
        Cost and quality.
    seconds
        CPU time; apart from the record because it is not reproducible.
    scene
        What was pressed, if it was kept.
    errors
        Errors of its numbers by name, each in its unit, if they were asked for.
    """

    pressure: Array = field(repr=False)
    gap: Array = field(repr=False)
    approach: float
    status: Status
    record: Record
    seconds: float
    scene: Scene | None = field(default=None, repr=False)
    errors: Mapping[str, float] | None = field(default=None, repr=False)

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
        """Mean pressure over the length or area of the heights, GPa."""
        return float(self.pressure.mean())

    @property
    def numbers(self) -> dict[str, Array]:
        """Numbers that have an error, each of shape (1,): infinite where the solution did not converge."""
        numbers = {
            "relative_contact_area": self.relative_contact_area,
            "approach": self.approach,
            "mean_pressure": self.mean_pressure,
            "mean_gap": float(self.gap.mean()),
            "max_pressure": float(self.pressure.max()),
        }
        return {name: np.full(1, value if self.status.solved else np.inf) for name, value in numbers.items()}


def pressed_scene(result: Result) -> Scene:
    """Return the scene of a result; raise an InputError for one that did not converge or has no scene."""
    if result.scene is None or not result.status.solved:
        raise InputError("result", result, "a converged result of `contactsim.press`")
    return result.scene


def check_solver(solver: Solver, scene: Scene) -> None:
    """Raise a `InputError` if an object is no solver, or if a scene has a trait that the solver does not accept."""
    if isinstance(solver, type) or not hasattr(solver, "accepts"):  # a user's argument may be anything
        raise InputError("solver", solver, "the name of a solver, or a solver made with its options")
    for trait in sorted(scene.traits - solver.accepts, key=lambda trait: trait.name):
        accepted = ", ".join(sorted(accepted.name for accepted in solver.accepts))
        raise InputError(
            "solver",
            type(solver).__name__,
            f"one that accepts {trait.name} ({trait.value}); this one accepts {accepted}",
        )


def coarser_level(problem: HardWallProblem, coarsest: int, tolerance: float) -> HardWallProblem | None:
    """Return the next level of a cascade of grids; None if it has too few points a side, or no contact."""
    if min(problem.shape) // 2 < coarsest:
        return None
    coarse = problem.coarser(tolerance)
    return None if coarse.is_separated else coarse


def check_cascade(coarsest: int, coarse_tolerance: float) -> None:
    """Raise a `InputError` for options of a cascade of grids that are out of range."""
    if not coarse_tolerance > 0:
        raise InputError("coarse_tolerance", coarse_tolerance, "a positive number of grid steps")
    if coarsest < 2:
        raise InputError("coarsest", coarsest, "a whole number of points, 2 or more")


def iterate(solver: HardWallSolver, problem: HardWallProblem, state: State, budget: int) -> tuple[State, int, bool]:
    """Step until the solver believes that it has converged, at most `budget` times, or to a value that is not finite.

    Returns
    -------
    state, steps, finite
        The last state with finite values (where a step works in place, one of no or of uniform pressure), the number of
        steps, and whether all values were finite.
    """
    for count in range(1, budget + 1):
        following = solver.step(problem, state)
        if not (np.isfinite(following.pressure.sum()) or np.isfinite(following.pressure).all()):
            if following.pressure is state.pressure:  # where memory is short a step works in place
                state = replace(state, pressure=problem.project(np.zeros(problem.shape)))
            return state, count, False
        state = following
        if state.done:
            return state, count, True
    return state, budget, True


def solve(solver: HardWallSolver, problem: HardWallProblem, scale: Scale) -> Result:
    """Solve one load step and certify the solution.

    Parameters
    ----------
    solver
        The method.
    problem, scale
        Problem without units, and its units; see `contactsim.contact.pose_hard_wall.pose_hard_wall`.

    Returns
    -------
    Result
        In physical units. A status other than `CONVERGED` is no exception.
    """
    begin = time.process_time()
    if problem.is_separated:
        pressure, spent, status = np.zeros(problem.shape), 0, Status.CONVERGED
        certificate, gap = problem.certify(pressure)
    else:
        pressure, gap, certificate, spent, status = _solve_contact(solver, problem)
    record = Record(spent, problem.counter.transforms, certificate)
    pressure *= scale.pressure
    gap *= scale.step
    return Result(
        pressure=pressure,
        gap=gap,
        approach=certificate.approach * scale.step - scale.highest + scale.mean_displacement,
        status=status,
        record=record,
        seconds=time.process_time() - begin,
    )


def _solve_contact(solver: HardWallSolver, problem: HardWallProblem) -> tuple[Array, Array, Certificate, int, Status]:
    """Return pressure, gap, their certificate, the outer steps and the status; without units."""
    state, spent = solver.start(problem), 0
    while True:
        pressure = gap = None  # frees memory before the solver needs it
        state, count, finite = iterate(solver, problem, state, solver.budget - spent)
        spent += count
        pressure = problem.project(state.pressure)
        certificate, gap = problem.certify(pressure)
        if not finite:
            return pressure, gap, certificate, spent, Status.NON_FINITE
        if certificate.met(problem.tolerance):
            return pressure, gap, certificate, spent, Status.CONVERGED
        if spent >= solver.budget:
            return pressure, gap, certificate, spent, Status.MAX_ITERATIONS
