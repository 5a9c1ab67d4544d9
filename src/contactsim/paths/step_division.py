"""How a step that continuation fails to take is divided: not at all, shortened, or until its jump is located."""

from __future__ import annotations

from enum import Enum

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.grid import Array
from contactsim.paths.jumps import JumpCriterion, Side
from contactsim.solvers.cohesive.base import Equilibrium
from contactsim.traits import Trait

MANY_PATCHES, MOST_PATCHES, LOADED = {1: 20, 2: 3}, {1: 200, 2: 30}, 0.5
"""Loaded patches above which the jump of one contact is located only where the pull may be the largest, and above which
not even there, by the number of dimensions; a fold is then as wide as its step. A contact has up to three patches on a
line, middle and edges, and two on a surface. To locate every jump of a rough surface takes ten times the work of its
path. Least traction of a loaded patch, over the laws' strength."""
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
ROUNDING = 1e-9
"""Relative rounding of a step's length."""


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


def divide_step(jumps: JumpCriterion, before: Side, after: Side) -> Division:
    """Return how a step that continuation fails to take is divided.

    A step that is, with its motion, shorter than the smallest jump holds none. Else a jump is located, but for steps of
    the approach where the energy balances, or where the jump is that of one contact among many or of few points of a
    large contact. These are located where the pull may be the largest since the approach turned: a pull-off lies there.
    Beside a hard wall, steps of a load are taken whole: how far they move a surface that the wall pushes is not known.

    Parameters
    ----------
    jumps
        Tells jumps of the path from smooth motion.
    before, after
        Load step and state from which a flow starts, and those that it reaches.
    """
    (start, first), (step, state), problem = before, after, jumps.problem
    if step.control is Trait.MEAN_PRESSURE and problem.wall is not None:
        return Division.NONE
    if jumps.is_too_small(before, after):
        return Division.NONE
    if step.control is not Trait.APPROACH:
        return Division.LOCATE
    if is_balanced(jumps, before, after):
        return Division.NONE
    increment = abs(step.value - start.value)
    if not _is_calm(problem, state, increment):
        pulls_most = jumps.may_pull_most(before, after)
        is_minor = not pulls_most and _moves_few_points(jumps, before, after)
        most = MOST_PATCHES if pulls_most else MANY_PATCHES
        if not (is_minor or _has_more_patches(problem, most, first, state)):
            return Division.LOCATE
    is_short = increment <= problem.interaction_range * (1 + ROUNDING)
    return Division.NONE if is_short else Division.SHORTEN


def is_balanced(jumps: JumpCriterion, before: Side, after: Side) -> bool:
    """Return True if the work of the load over a short step equals the change of energy.

    A jump releases energy, and then they differ. The work is that of a trapezoidal rule, whose error on a smooth path
    is small where the traction changes little.
    """
    problem, length = jumps.problem, jumps.problem.interaction_range
    (start, first), (end, last) = before, after
    increment = abs(end.value - start.value)
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
    change = max(abs(forces[1] - forces[0]), jumps.rate * increment)
    return abs(released) <= BALANCED_ENERGY * change * increment


def _is_calm(problem: CohesiveProblem, after: Equilibrium, increment: float) -> bool:
    """Return True if a flow moved the surface by so little of the step that there is no jump to locate."""
    ratio = CALM_RATIO if problem.wall is None else 1 + CALM_RATIO
    return after.largest_change <= ratio * increment


def _moves_few_points(jumps: JumpCriterion, before: Side, after: Side) -> bool:
    """Return True if few points, beside those loaded, move farther than the step and than half the largest motion.

    A motion that would count as a jump is not left unlocated, as it may be smooth.
    """
    (start, first), (step, state), problem = before, after, jumps.problem
    increment = abs(step.value - start.value)
    if jumps.is_jump(step, increment, state.largest_change):
        return False
    motion = np.abs(problem.on_heights(state.gap - first.gap)).max(axis=0)
    moved = np.count_nonzero(motion > max(increment, state.largest_change / 2))
    loaded = max(np.count_nonzero(_loaded_points(problem, side)) for side in (first, state))
    return bool(0 < moved <= SMALL_SHARE * loaded)


def _has_more_patches(problem: CohesiveProblem, most: dict[int, int], *states: Equilibrium) -> bool:
    """Return True if one of the states has more loaded patches than `most`, by the number of dimensions."""
    shape = problem.heights.shape
    count = PATCH_COUNTERS[len(shape)]
    return any(count(_loaded_points(problem, state).reshape(shape)) > most[len(shape)] for state in states)


def _loaded_points(problem: CohesiveProblem, state: Equilibrium) -> Array:
    """Return the points of a state that are loaded, bool (n,)."""
    return np.abs(problem.on_heights(state.traction[0])) > LOADED * problem.strength
