"""Polonsky and Keer's conjugate gradients as tamaas has them, as a peer to measure against; needs `pip install tamaas`.

J. Open Source Softw. 5, 2121 (2020), doi:10.21105/joss.02121. tamaas stops at a relative error of its own, so it is
asked for ever smaller ones, going on from where it stands, until our certificate is met. Restarting costs it about one
iteration in a hundred.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.solvers.base import State
from contactsim.traits import Trait


@dataclass(frozen=True)
class TamaasState(State):
    """Pressure (n,) or (ny, nx); tamaas's solver; a counter of its iterations; the relative error asked for next."""

    method: object = field(repr=False)
    counter: object = field(repr=False)
    error: float


@dataclass(frozen=True)
class Tamaas:
    """One outer step is a solution to a relative error ten times smaller than the last.

    first_error: the first; iterations: most of an outer step.
    """

    first_error: float = 1e-2
    iterations: int = 20000
    budget: int = 14
    fields = 16
    accepts = frozenset({Trait.LINE, Trait.SURFACE, Trait.WALL, Trait.HALF_SPACE, Trait.MEAN_PRESSURE})

    def transforms(self, points: int) -> float:
        """Real transforms of an iteration on a grid of that size."""
        return 4.0

    def start(self, problem: HardWallProblem, guess: Array | None = None) -> TamaasState:
        """A model without units: spacing 1 along x, E* = 1.

        Refused on an odd number of rows, of which tamaas 2.9 takes one of the two shortest waves for a shorter one.
        """
        shape, grid = problem.heights.shape, problem.compliance.grid
        if len(shape) == 2 and shape[0] % 2:
            raise SceneError("points", shape, "an even number of rows with tamaas, whose wavenumbers are wrong else")
        import tamaas

        class Counter(tamaas.Functional):  # a term that is zero: called once an iteration
            def __init__(self) -> None:
                super().__init__()
                self.iterations = 0

            def computeF(self, *_: object) -> float:  # noqa: N802 - tamaas's name
                """No energy."""
                return 0.0

            def computeGradF(self, *_: object) -> None:  # noqa: N802 - tamaas's name
                """No gradient, but one iteration more."""
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
        """Go on to a smaller relative error; the certificate decides whether it was enough."""
        before = state.counter.iterations
        state.method.tolerance = state.error
        state.method.solve(problem.load)
        problem.tally.add(4 * (state.counter.iterations - before) + 2, problem.heights.size)
        pressure = np.array(state.method.model.traction).reshape(problem.heights.shape)
        return TamaasState(pressure, True, state.method, state.counter, state.error / 10)
