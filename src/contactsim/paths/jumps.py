"""Jumps of the surface, told from smooth motion.

A jump is a motion that the load does not account for: the surface snaps into contact, pulls off, or slips.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import Equilibrium, largest_change
from contactsim.traits import Trait

JUMP_LENGTH, JUMP_RATIO = 0.1, 5.0
"""A flow is a jump if it moves the surface by more than this part of the laws' length and by more than this many steps.
A step under load counts as the length that a step of that size moved the surface before."""
BOND_LENGTH = 3.0
"""Gaps, in the laws' length, over which sites of a lattice hold each other."""
SLIP_RATIO = 250.0
"""Ratio of a surface's speed to the driving speed below which sliding over a lattice is smooth."""
FOLD_WIDTH = 0.002
"""Largest width of a jump by default, nm."""


@dataclass(frozen=True)
class Jump:
    """A jump of the surface.

    Attributes
    ----------
    step_before, before
        Load step and state before the jump.
    step, after
        Load step and state after the jump.
    distance
        Largest displacement of the surface, nm.
    peak_before, peak_after
        Load step and state with the largest pull since the step of the path began, or since the jump before; and until
        the step of the path ends, if no other jump follows in it.
    """

    step_before: LoadStep
    before: Equilibrium = field(repr=False)
    step: LoadStep
    after: Equilibrium = field(repr=False)
    distance: float
    peak_before: Side = field(repr=False)
    peak_after: Side = field(repr=False)


Side: TypeAlias = tuple[LoadStep, Equilibrium]
"""Load step and state at one end of a step."""


def pull_of(side: Side) -> float:
    """Return the mean pull (GPa) of a state."""
    return float(side[1].traction[0].mean())


class JumpCriterion:
    """Distance beyond which a motion of the surface is a jump.

    Parameters
    ----------
    problem
        The problem that the path solves.
    fold_width
        Largest distance (nm) that the load moves the surface between both sides of a jump.
    """

    def __init__(self, problem: CohesiveProblem, fold_width: float = FOLD_WIDTH) -> None:
        self.problem, self._fold_width = problem, fold_width
        self._pace: float | None = None  # distance that the surface moved per mean pressure, nm/GPa
        self.rate = 0.0  # change of the traction per approach, GPa/nm
        self._direction, self._largest_pull = 0.0, 0.0  # of the approach, and since it turned, GPa

    def watch(self, before: Side, after: Side) -> None:
        """Store the largest pull since the approach turned; before, after: both ends of a step."""
        self._largest_pull = max(self._record(before, after), pull_of(after))
        self._direction = float(np.sign(after[0].value - before[0].value))

    def _record(self, before: Side, after: Side) -> float:
        """Return the largest pull (GPa) from where the approach turned last to the beginning of a step, at least 0."""
        turns = np.sign(after[0].value - before[0].value) != self._direction
        return max(0.0, pull_of(before)) if turns else self._largest_pull

    def may_pull_most(self, before: Side, after: Side) -> bool:
        """Return True if the pull may be larger within a step of the approach than at any state since it turned.

        Within the step it may exceed both ends by as much as it changed in a step before without a jump.
        """
        change = self.rate * abs(after[0].value - before[0].value)
        return max(pull_of(before), pull_of(after)) + change >= self._record(before, after)

    def learn(self, before: Side, after: Side, change: Array) -> None:
        """Store how fast the surface and its traction change on the last smooth step.

        Parameters
        ----------
        before, after
            Load step and state at both ends.
        change
            Change of the displacement (exerted, m), nm.
        """
        (start, first), (end, last) = before, after
        increment = abs(end.value - start.value)
        if end.control is Trait.MEAN_PRESSURE:
            self._pace = largest_change(self.problem, change) / increment
        if end.control is Trait.APPROACH:
            self.rate = abs(float(last.traction[0].mean() - first.traction[0].mean())) / increment

    def forget(self) -> None:
        """Forget how fast the surface moved, because the control changes."""
        self._pace, self.rate = None, 0.0

    @property
    def has_lattice(self) -> bool:
        """True if the surfaces slide over a lattice, where smooth motion may be fast."""
        return bool(np.isfinite(self.problem.lattice_constant))

    def is_jump(self, step: LoadStep, increment: float, distance: float, leaves_unstable: bool = False) -> bool:
        """Return True if a motion is a jump.

        Parameters
        ----------
        step
            Load step at which the motion ends.
        increment
            Change of the load since the last state, nm or GPa; infinite at the first state, which is no jump.
        distance
            Largest displacement of the surface, nm.
        leaves_unstable
            True where the state before is not stable under the control of the step.
        """
        if increment == np.inf:
            return False
        return distance > self._longest_motion(step, 0.0 if leaves_unstable else self._length(step, increment))

    def _longest_motion(self, step: LoadStep, length: float) -> float:
        """Return the distance (nm) up to which a motion is no jump; length: that of the step's own motion, nm."""
        smooth = max(JUMP_RATIO * length, JUMP_LENGTH * self.problem.interaction_range)
        if step.held is not None:  # a slip of half a cell is a jump, however long the step
            smooth = min(smooth, self.problem.lattice_constant / 2)
        return smooth

    def slips_half_a_cell(self, before: Equilibrium, after: Equilibrium) -> bool:
        """Return True if a point near contact has slipped over a lattice by more than half a cell."""
        if not self.has_lattice:
            return False
        close = after.gap[0] <= BOND_LENGTH * self.problem.interaction_range
        slip = np.abs(after.gap[1, close] - before.gap[1, close]).max(initial=0.0)
        return bool(slip > self.problem.lattice_constant / 2)

    def is_too_small(self, before: Side, after: Side) -> bool:
        """Return True if a step and its motion together are shorter than the smallest jump.

        On a longer step a jump may be undone by other motion: after a slip over a lattice a surface is where it was, a
        cell further.
        """
        (start, _), (step, state) = before, after
        length = self._length(step, abs(step.value - start.value)) + state.largest_change
        return self.problem.wall is None and length <= self._longest_motion(step, 0.0)

    def may_hide_in(self, step: LoadStep, increment: float) -> bool:
        """Return True if a step is divided: it might take smooth motion for a jump, or is wider than a jump may be."""
        ratio = SLIP_RATIO if self.has_lattice else JUMP_RATIO
        longest = min(JUMP_LENGTH * self.problem.interaction_range / ratio, self._fold_width)
        return self._length(step, increment) > longest

    def _length(self, step: LoadStep, increment: float) -> float:
        """Return the distance (nm) that a step moves the surface without a jump; infinite if unknown."""
        if step.control is not Trait.MEAN_PRESSURE:
            return increment
        return np.inf if self._pace is None else self._pace * increment
