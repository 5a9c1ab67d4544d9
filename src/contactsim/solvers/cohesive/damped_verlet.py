"""Damped Verlet dynamics of smooth laws: the thesis's own scheme (Eqs 2.3-2.7, 2.14), and one with masses that suit.

The surface moves in pseudo time as u⁺ = 2u - u⁻ + δt² F - d (u - u⁻), from rest at the last stable state, until the
force F vanishes; the sign of the damping printed in Eq. 2.5 would feed energy in. The thesis gives every node the same
mass, so that the shortest wave sets the time step and the longest the number of steps. With the mass of each wave in
proportion to its stiffness plus the largest tangent of the laws, all waves have about one frequency and the number of
steps depends on neither. Both end on the same equilibrium: mass and damping decide how fast it is reached, and from
the last stable state there is but one to reach unless the surface is thrown over a barrier.

With nodes of one mass the force of the laws is evaluated ahead of the step by their tangent (Eq. 2.14),
T(g) + T'(g)(g - g⁻), which adds to the damping where a law repels and takes from it where the law softens.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent, contract
from contactsim.errors import SceneError, is_number
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import SMOOTH_PATHS, Equilibrium, are_pulled_apart, largest_change, status_of
from contactsim.status import Status
from contactsim.traits import Trait

LEAST = 0.01
"""Least tangential tangent that a mass allows for, over the laws' largest."""
OUTGROWN = 2.0
"""How many times as stiff as the masses were made for a law may become before they are made anew, at rest."""

Mobility = Callable[[Array], Array]


class _Dynamics:
    """What both have in common: from rest at the last state, whatever lies ahead."""

    fields = 30
    uses_guess = False
    trust_radius = 0.0
    accepts = SMOOTH_PATHS | {Trait.NON_CONSERVATIVE}

    def transforms(self, points: int) -> float:
        """Real transforms of a time step and unknown component."""
        return 2.0

    def new_memory(self) -> None:
        """Nothing is kept."""

    def solve_near(self, problem: CohesiveProblem, guess: Array, memory: None, within: float = np.inf) -> Equilibrium:
        """The equilibrium reached from a guess."""
        return self.flow_from(problem, guess)


@dataclass(frozen=True)
class DampedVerlet(_Dynamics):
    """Unit mass on every node (Eqs 2.3-2.7), as the thesis has it.

    time_step: δt and damping: η, in units in which nm, GPa and the mass are 1, text: 0.1 and about 1; batch: steps
    between two checks of the residual; budget: most batches.
    """

    time_step: float = 0.1
    damping: float = 1.0
    batch: int = 50
    budget: int = 4000

    def __post_init__(self) -> None:
        _check(self, "time_step", "damping")

    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """The equilibrium reached from a state at rest."""
        square = self.time_step**2
        highest = float(problem.stiffness.diagonal.max()) + problem.law_stiffness
        if not square * highest < 4:
            raise SceneError("time_step", self.time_step, f"below {2 / np.sqrt(highest):.3g}, the limit of stability")

        def mobility(tangent: Tangent) -> Mobility:
            """Displacement for a force: the same for all waves."""
            return lambda force: square * force

        return _settle(problem, start, mobility, self.damping * square, True, self.batch, self.budget)


@dataclass(frozen=True)
class MassWeightedVerlet(_Dynamics):
    """Masses in proportion to the stiffness of each wave plus the largest tangent of the laws.

    time_step: over the limit of stability 2/ω; damping: over the critical damping of the softest wave; batch: steps
    between two checks of the residual, at which masses follow the laws, and sooner where these stiffen; budget: most
    batches.
    """

    time_step: float = 0.5
    damping: float = 1.0
    batch: int = 20
    budget: int = 10000

    def __post_init__(self) -> None:
        _check(self, "time_step", "damping")
        if not self.time_step < 1:
            raise SceneError("time_step", self.time_step, "above 0 and below 1, the limit of stability")

    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """The equilibrium reached from a state at rest."""
        square = 4 * self.time_step**2
        rows = problem.unknowns[0]
        soft = problem.regularised_stiffness.diagonal[0]
        soft = soft[soft > 0].min()
        friction = min(2 * self.damping * np.sqrt(square * soft / (soft + problem.law_stiffness)), 1.0)

        def mobility(tangent: Tangent) -> Mobility:
            """Displacement for a force: less for waves that the body or the laws hold more stiffly."""
            largest = max(problem.law_stiffness, np.abs(tangent.values[0]).max())
            sideways = np.abs(tangent.values[1:, 1:]).max(initial=LEAST * problem.law_stiffness)
            inverse = problem.regularised_stiffness.inverse(np.array([largest, sideways][:rows]))
            return lambda force: square * inverse.apply(force)

        return _settle(problem, start, mobility, friction, False, self.batch, self.budget)


def _settle(
    problem: CohesiveProblem,
    start: Array,
    mobility: Callable[[Tangent], Mobility],
    friction: float,
    ahead: bool,
    batch: int,
    budget: int,
) -> Equilibrium:
    """Move from rest until a residual, recomputed from the displacement alone, is within the tolerance."""
    displacement, change, before = start, np.zeros_like(start), None
    status, worst, count = Status.MAX_ITERATIONS, np.inf, 0
    with np.errstate(over="ignore", invalid="ignore"):  # what diverges is reported
        for count in range(budget + 1):
            gap = problem.gap(displacement)
            traction, tangent = problem.tangent(gap)
            worst = problem.norm(problem.residual(displacement, traction))
            if are_pulled_apart(problem, gap):
                status = Status.NO_EQUILIBRIUM
                break
            status = status_of(worst, problem)
            if status is not Status.MAX_ITERATIONS or count == budget:
                break
            move, stiffest = mobility(tangent), max(problem.law_stiffness, np.abs(tangent.values).max())
            for _ in range(batch):
                gap = problem.gap(displacement)
                traction, tangent = problem.tangent(gap)
                if np.abs(tangent.values).max() > OUTGROWN * stiffest:  # than the masses hold
                    move, stiffest = mobility(tangent), np.abs(tangent.values).max()
                    change = np.zeros_like(start)
                if ahead and before is not None:
                    traction += contract(tangent.values, gap - before)
                before = gap
                change = (1 - friction) * change - move(problem.residual(displacement, traction))
                displacement = displacement + change
        distance = largest_change(problem, displacement - start)
    return Equilibrium(displacement, gap, traction, status, worst, distance, count * batch)


def _check(method: object, *names: str) -> None:
    for name in names:
        value = getattr(method, name)
        if not (is_number(value) and value > 0):
            raise SceneError(name, value, "a positive, finite number")
