"""Damped Verlet dynamics of smooth laws: the scheme of the thesis (Eqs 2.3-2.7, 2.14), and one with other masses.

The surface moves in pseudo time as u⁺ = 2u - u⁻ + δt² F - d (u - u⁻), from rest at the last stable state, until the
force F vanishes; the sign of the damping as printed in Eq. 2.5 would feed energy in. The thesis gives every node the
same mass. The shortest wave then limits the time step, and the longest wave sets the number of steps. If the mass of
each wave is proportional to its stiffness plus the largest tangent of the laws, all waves have about one frequency, and
the number of steps depends on neither. Both schemes end in the same equilibrium: mass and damping decide how fast it is
reached, and only one can be reached from the last stable state unless the surface is thrown over a barrier.

With equal masses the force of the laws is evaluated ahead of the step by their tangent (Eq. 2.14),
T(g) + T'(g)(g - g⁻), which adds damping where a law repels and removes it where the law softens.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent, contract
from contactsim.errors import POSITIVE, InputError, is_positive
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import SMOOTH_PATHS, Equilibrium, cannot_carry_load, largest_change, status_of
from contactsim.status import Status
from contactsim.traits import Trait

MIN_TANGENTIAL_STIFFNESS = 0.01
"""Smallest tangential tangent for which masses are made, over the laws' largest tangent."""
MAX_STIFFENING = 2.0
"""Ratio of a law's tangent to that for which the masses were made beyond which they are made anew, at rest."""

Mobility = Callable[[Array], Array]


class VerletDynamics(ABC):
    """Common part of both schemes: each state is reached by the flow from the last one."""

    fields = 30
    uses_guess = False
    trust_radius = 0.0
    accepts = SMOOTH_PATHS | {Trait.NON_CONSERVATIVE}

    def transforms(self, points: int) -> float:
        """Return the real transforms of a time step, for each unknown component."""
        return 2.0

    def new_memory(self) -> None:
        """Return nothing: the method has no memory of earlier states."""
        return

    def solve_near(self, problem: CohesiveProblem, guess: Array, memory: None, within: float = np.inf) -> Equilibrium:
        """Return the equilibrium reached from a guess."""
        return self.flow_from(problem, guess)

    @abstractmethod
    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return the equilibrium reached from a state at rest."""


@dataclass(frozen=True)
class DampedVerlet(VerletDynamics):
    """Unit mass on every node (Eqs 2.3-2.7), the scheme of the thesis.

    Parameters
    ----------
    time_step, damping
        δt and η in units in which nm, GPa and the mass are 1 (thesis: 0.1 and about 1).
    batch
        Steps between two checks of the residual.
    budget
        Largest number of batches.
    """

    time_step: float = 0.1
    damping: float = 1.0
    batch: int = 50
    budget: int = 4000

    def __post_init__(self) -> None:
        _check_positive(self, "time_step", "damping")

    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return the equilibrium reached from a state at rest."""
        square = self.time_step**2
        highest = float(problem.stiffness.diagonal.max()) + problem.law_stiffness
        if not square * highest < 4:
            raise InputError("time_step", self.time_step, f"below {2 / np.sqrt(highest):.3g}, the limit of stability")

        def mobility(tangent: Tangent) -> Mobility:
            """Return the displacement for a force: the same for all waves."""
            return lambda force: square * force

        return _move_until_rest(problem, start, mobility, self.damping * square, True, self.batch, self.budget)


@dataclass(frozen=True)
class MassWeightedVerlet(VerletDynamics):
    """Masses proportional to the stiffness of each wave plus the largest tangent of the laws.

    Parameters
    ----------
    time_step
        Over the limit of stability 2/ω.
    damping
        Over the critical damping of the softest wave.
    batch
        Steps between two checks of the residual. Masses are made anew at each check, and earlier if the laws stiffen.
    budget
        Largest number of batches.
    """

    time_step: float = 0.5
    damping: float = 1.0
    batch: int = 20
    budget: int = 10000

    def __post_init__(self) -> None:
        _check_positive(self, "time_step", "damping")
        if not self.time_step < 1:
            raise InputError("time_step", self.time_step, "above 0 and below 1, the limit of stability")

    def flow_from(self, problem: CohesiveProblem, start: Array) -> Equilibrium:
        """Return the equilibrium reached from a state at rest."""
        square = 4 * self.time_step**2
        rows = problem.unknowns[0]
        soft = problem.regularised_stiffness.diagonal[0]
        soft = soft[soft > 0].min()
        friction = min(2 * self.damping * np.sqrt(square * soft / (soft + problem.law_stiffness)), 1.0)

        def mobility(tangent: Tangent) -> Mobility:
            """Return the displacement for a force: smaller for stiffer waves."""
            largest = max(problem.law_stiffness, np.abs(tangent.values[0]).max())
            sideways = np.abs(tangent.values[1:, 1:]).max(initial=MIN_TANGENTIAL_STIFFNESS * problem.law_stiffness)
            inverse = problem.regularised_stiffness.inverse(np.array([largest, sideways][:rows]))
            return lambda force: square * inverse.apply(force)

        return _move_until_rest(problem, start, mobility, friction, False, self.batch, self.budget)


def _move_until_rest(
    problem: CohesiveProblem,
    start: Array,
    mobility: Callable[[Tangent], Mobility],
    friction: float,
    ahead: bool,
    batch: int,
    budget: int,
) -> Equilibrium:
    """Move from rest until a residual, computed from the displacement alone, is within the tolerance."""
    displacement, change, before = start, np.zeros_like(start), None
    status, worst, count = Status.MAX_ITERATIONS, np.inf, 0
    with np.errstate(over="ignore", invalid="ignore"):  # divergence is reported by the status
        for count in range(budget + 1):
            gap = problem.gap(displacement)
            traction, tangent = problem.tangent(gap)
            worst = problem.norm(problem.residual(displacement, traction))
            if cannot_carry_load(problem, gap):
                status = Status.NO_EQUILIBRIUM
                break
            status = status_of(worst, problem)
            if status is not Status.MAX_ITERATIONS or count == budget:
                break
            move, stiffest = mobility(tangent), max(problem.law_stiffness, np.abs(tangent.values).max())
            for _ in range(batch):
                gap = problem.gap(displacement)
                traction, tangent = problem.tangent(gap)
                if np.abs(tangent.values).max() > MAX_STIFFENING * stiffest:
                    move, stiffest = mobility(tangent), np.abs(tangent.values).max()
                    change = np.zeros_like(start)
                if ahead and before is not None:
                    traction += contract(tangent.values, gap - before)
                before = gap
                change = (1 - friction) * change - move(problem.residual(displacement, traction))
                displacement = displacement + change
        distance = largest_change(problem, displacement - start)
    return Equilibrium(displacement, gap, traction, status, worst, distance, count * batch)


def _check_positive(method: object, *names: str) -> None:
    """Raise a `InputError` for an option that is not a positive, finite number."""
    for name in names:
        value = getattr(method, name)
        if not is_positive(value):
            raise InputError(name, value, POSITIVE)
