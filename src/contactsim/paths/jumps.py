"""Jumps of the surface, told from smooth motion.

A jump is a motion that the load does not account for: the surface snaps into contact, pulls off, or slips.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.grid import Array
from contactsim.solvers.cohesive.base import Equilibrium, largest_change
from contactsim.traits import Trait

JUMP_LENGTH, JUMP_RATIO = 0.1, 5.0
"""A flow is a jump if it moves the surface by more than this part of the laws' length and by more than this many steps.
A step under load counts as the length that a step of that size moved the surface before."""
MANY_PATCHES, LOADED = {1: 20, 2: 3}, 0.5
"""Loaded patches above which the jump of one contact is not located, by the number of dimensions. A contact has up to
three on a line, middle and edges, and two on a surface, where to locate every jump of a rough contact takes ten times
the work of its path. Least traction of a loaded patch, over the laws' strength."""
SMALL_SHARE = 1 / 20
"""Share of the loaded points that may jump without being located, as where one valley of many closes."""
CALM_RATIO = 0.25
"""Distance that a flow moves the surface, over the step of the approach, up to which there is no jump to locate. In
contact with a hard wall a surface moves by the step itself, and by this more."""
BALANCED_CHANGE = 2.0
"""Largest distance that a flow without a jump moves the surface beyond the step, over the step; it is at most the laws'
length."""
BALANCED_STEP = 2.0
"""Longest step whose energy is balanced, over the laws' length."""
BALANCED_ENERGY = 1 / 8
"""Largest difference of work and energy, over the product of the step and the change of the traction: the error that a
trapezoidal rule may have along a smooth path."""
BOND_LENGTH = 3.0
"""Gaps, in the laws' length, over which sites of a lattice hold each other."""
SLIP_RATIO = 250.0
"""Ratio of a surface's speed to the driving speed below which sliding over a lattice is smooth."""
ROUNDING = 1e-9
"""Relative rounding of a step's length."""
FOLD_WIDTH = 0.002
"""Largest width of a jump by default, nm."""


def _count_runs(loaded: Array) -> int:
    """Return the number of patches of a line, bool (n,)."""
    return int(np.count_nonzero(loaded & ~np.roll(loaded, 1)))


def _count_areas(loaded: Array) -> int:
    """Return the number of patches of a surface, bool (ny, nx); points that touch at a corner are connected."""
    from scipy.ndimage import label  # takes longer to import than a line needs

    return int(label(loaded, np.ones((3, 3)))[1])


class Division(Enum):
    """How a step that continuation fails to take is divided."""

    NONE = "not at all"
    SHORTEN = "until it is no longer than the laws' length"
    LOCATE = "until the jump in it is located"


PATCH_COUNTERS = {1: _count_runs, 2: _count_areas}
"""Functions that count the patches of loaded points, by the number of dimensions."""


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
    """

    step_before: LoadStep
    before: Equilibrium = field(repr=False)
    step: LoadStep
    after: Equilibrium = field(repr=False)
    distance: float


Side = tuple[LoadStep, Equilibrium]
"""Load step and state at one end of a step."""


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
        self._rate = 0.0  # change of the traction per approach, GPa/nm

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
            self._rate = abs(float(last.traction[0].mean() - first.traction[0].mean())) / increment

    def forget(self) -> None:
        """Forget how fast the surface moved, because the control changes."""
        self._pace, self._rate = None, 0.0

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

    def division(self, before: Side, after: Side) -> Division:
        """Return how a step that continuation fails to take is divided.

        A step that is, with its motion, shorter than the smallest jump holds none. Else only steps of the approach are
        taken whole: where the energy balances, and where the jump is that of one contact or valley among many. Beside a
        hard wall, steps of a load are taken whole: how far they move a surface that the wall pushes is not known.

        Parameters
        ----------
        before, after
            Load step and state from which a flow starts, and those that it reaches.
        """
        step, state = after
        if step.control is Trait.MEAN_PRESSURE and self.problem.wall is not None:
            return Division.NONE
        if self._is_too_small(before, after):
            return Division.NONE
        if step.control is not Trait.APPROACH:
            return Division.LOCATE
        increment = abs(step.value - before[0].value)
        if self._is_balanced(before, after, increment):
            return Division.NONE
        if not self._is_among_many(before[1], state, increment):
            return Division.LOCATE
        is_short = increment <= self.problem.interaction_range * (1 + ROUNDING)
        return Division.NONE if is_short else Division.SHORTEN

    def _is_among_many(self, before: Equilibrium, after: Equilibrium, increment: float) -> bool:
        """Return True if a step of the approach holds no jump, or that of one contact or valley among many."""
        ratio = CALM_RATIO if self.problem.wall is None else 1 + CALM_RATIO
        if after.largest_change <= ratio * increment or self._moves_few_points(before, after, increment):
            return True
        patches = max(self._count_patches(before), self._count_patches(after))
        return patches > MANY_PATCHES[len(self.problem.grid.shape)]

    def _moves_few_points(self, before: Equilibrium, after: Equilibrium, increment: float) -> bool:
        """Return True if few points move farther than the step and half the largest motion, beside those loaded."""
        motion = np.abs(self.problem.on_heights(after.gap - before.gap)).max(axis=0)
        moved = np.count_nonzero(motion > max(increment, after.largest_change / 2))
        loaded = max(np.count_nonzero(self._is_loaded(state)) for state in (before, after))
        return bool(0 < moved <= SMALL_SHARE * loaded)

    def _is_too_small(self, before: Side, after: Side) -> bool:
        """Return True if a step and its motion together are shorter than the smallest jump.

        On a longer step a jump may be undone by other motion: after a slip over a lattice a surface is where it was, a
        cell further.
        """
        (start, _), (step, state) = before, after
        length = self._length(step, abs(step.value - start.value)) + state.largest_change
        return self.problem.wall is None and length <= self._longest_motion(step, 0.0)

    def _is_balanced(self, before: Side, after: Side, increment: float) -> bool:
        """Return True if the work of the load over a short step equals the change of energy.

        A jump releases energy, and then they differ. The work is that of a trapezoidal rule, whose error on a smooth
        path is small where the traction changes little.
        """
        problem, length = self.problem, self.problem.interaction_range
        (start, first), (end, last) = before, after
        excess = last.largest_change - increment
        if (
            problem.wall is not None
            or Trait.NON_CONSERVATIVE in problem.law.traits
            or increment > BALANCED_STEP * length * (1 + ROUNDING)
            or excess > min(BALANCED_CHANGE * increment, length)
        ):
            return False
        forces = [-float(state.traction[0].mean()) for state in (first, last)]
        energies = [problem.at(step).energy(state.displacement, state.gap) for step, state in (before, after)]
        released = sum(forces) / 2 * (end.value - start.value) - (energies[1] - energies[0])
        change = max(abs(forces[1] - forces[0]), self._rate * increment)
        return abs(released) <= BALANCED_ENERGY * change * increment

    def _count_patches(self, state: Equilibrium) -> int:
        """Return the number of loaded patches of a state."""
        shape = self.problem.heights.shape
        return PATCH_COUNTERS[len(shape)](self._is_loaded(state).reshape(shape))

    def _is_loaded(self, state: Equilibrium) -> Array:
        """Return the points of a state that are loaded, bool (n,)."""
        return np.abs(self.problem.on_heights(state.traction[0])) > LOADED * self.problem.strength

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
