"""Conjugate gradients of Polonsky and Keer as tamaas has them, for comparison; needs `pip install tamaas`.

J. Open Source Softw. 5, 2121 (2020), doi:10.21105/joss.02121. tamaas stops at a relative error of its own. It is
therefore run with smaller and smaller errors, each from the last solution, until our certificate is met. The restarts
cost about one iteration in a hundred.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.solvers.base import State
from contactsim.traits import Trait


@dataclass(frozen=True)
class TamaasState(State):
    """Pressure (n,) or (ny, nx), solver of tamaas, counter of its iterations, and the next relative error."""

    method: Any = field(repr=False)
    counter: Any = field(repr=False)
    error: float


@dataclass(frozen=True)
class Tamaas:
    """Solver of tamaas; one outer step is a solution to a relative error ten times smaller than the last.

    Parameters
    ----------
    first_error
        Relative error of the first outer step.
    iterations
        Largest number of iterations in an outer step.
    budget
        Largest number of outer steps.
    """

    first_error: float = 1e-2
    iterations: int = 20000
    budget: int = 14
    fields = 16
    accepts = frozenset({Trait.LINE, Trait.SURFACE, Trait.WALL, Trait.HALF_SPACE, Trait.MEAN_PRESSURE})

    def transforms(self, points: int) -> float:
        """Return the real transforms of an iteration."""
        return 4.0

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> TamaasState:
        """Return the first state, a model without units: spacing 1 along x, E* = 1.

        Raises
        ------
        InputError
            For an odd number of rows, on which tamaas 2.9 has a wrong wavenumber for one of the two shortest waves.
        """
        shape, grid = problem.heights.shape, problem.compliance.grid
        if len(shape) == 2 and shape[0] % 2:
            raise InputError(
                "points", shape, "an even number of rows with tamaas, whose wavenumbers are wrong otherwise"
            )
        import tamaas

        class Counter(tamaas.Functional):  # type: ignore[misc]  # tamaas has no types; zero, called once an iteration
            def __init__(self) -> None:
                super().__init__()
                self.iterations = 0

            def computeF(self, *_: object) -> float:  # noqa: N802 - tamaas's name
                """Return no energy."""
                return 0.0

            def computeGradF(self, *_: object) -> None:  # noqa: N802 - tamaas's name
                """Count an iteration, without a gradient."""
                self.iterations += 1

        tamaas.set_log_level(tamaas.LogLevel.error)
        kind = {1: tamaas.model_type.basic_1d, 2: tamaas.model_type.basic_2d}[len(shape)]
        periods = [length / grid.spacing[-1] for length in grid.lengths]
        model = tamaas.ModelFactory.createModel(kind, periods, list(shape))
        model.E, model.nu = 1.0, 0.0
        if guess is not None:
            model.traction[...] = problem.project(guess)
        method, counter = tamaas.PolonskyKeerRey(model, problem.heights, self.first_error), Counter()
        method.addFunctionalTerm(counter)
        method.max_iter, method.dump_freq = self.iterations, 10**9
        return TamaasState(np.zeros_like(problem.heights), False, method, counter, self.first_error)

    def step(self, problem: HardWallProblem, state: TamaasState) -> TamaasState:
        """Return the solution to a smaller relative error; the certificate decides whether it is good enough."""
        before = state.counter.iterations
        state.method.tolerance = state.error
        try:
            state.method.solve(problem.load)
            pressure = np.array(state.method.model.traction).reshape(problem.shape)
        except FloatingPointError:  # of tamaas, on a contact of a single point
            pressure = np.full(problem.shape, np.nan)
        problem.counter.add(4 * (state.counter.iterations - before) + 2, problem.size)
        return TamaasState(pressure, True, state.method, state.counter, state.error / 10)
