"""The numbers of jumps and slips that a dataset keeps."""

from __future__ import annotations

import math

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.grid import Array
from contactsim.observables.adhesion import contact_length
from contactsim.observables.load_curve import CURVES
from contactsim.observables.sliding import TOUCHING, slide_observables
from contactsim.paths.jumps import Jump, pull_of
from contactsim.solvers.cohesive.base import Equilibrium


def fold_numbers(problem: CohesiveProblem, jump: Jump, step: int) -> dict[str, float]:
    """Return the numbers of one jump on a path of approach or load (the folds of `CURVES`).

    Parameters
    ----------
    problem
        The problem that the path solves.
    jump
        The jump, with the states on both sides, and those with the largest pulls before and after it.
    step
        Number of the step of the path during which the jump came.
    """
    values: list[float] = [step]
    sides = jump.peak_before, (jump.step_before, jump.before), (jump.step, jump.after), jump.peak_after
    values += [approach_of(problem.at(at), state.displacement) for at, state in sides]
    values += [-pull_of(side) * math.prod(problem.grid.lengths) for side in sides]
    return dict(zip(CURVES[len(problem.grid.lengths)].folds, values, strict=True))


def approach_of(problem: CohesiveProblem, displacement: Array) -> float:
    """Return the approach (nm) of a state, prescribed or by its displacement (exerted, m)."""
    approach = problem.approach
    return problem.mean_displacement - float(displacement[0, 0].real) if approach is None else approach


def slip_numbers(problem: CohesiveProblem, slip: Jump, step: int) -> dict[str, float]:
    """Return the numbers of one slip (`EVENT`).

    Parameters
    ----------
    problem
        The problem that the path solves.
    slip
        The jump, with the states on both sides.
    step
        Number of the step of the path during which the slip came.

    Notes
    -----
    `event_width` is the sliding distance between both sides, nm. `event_released_energy`, nJ/m, is the energy that the
    bodies release; the interface keeps a part of it.
    """
    before, after = (
        _side_numbers(problem, at, state) for at, state in ((slip.step_before, slip.before), (slip.step, slip.after))
    )
    return {
        "event_step": step,
        "event_sliding_distance": slip.step.sliding_distance,
        "event_width": abs(slip.step.sliding_distance - slip.step_before.sliding_distance),
        "event_force_before": before["force"],
        "event_force_after": after["force"],
        "event_length_before": before["length"],
        "event_length_after": after["length"],
        "event_released_energy": before["elastic_energy"] - after["elastic_energy"],
        "event_slip": abs(after["contact_slip"] - before["contact_slip"]),
    }


def _side_numbers(problem: CohesiveProblem, step: LoadStep, state: Equilibrium) -> dict[str, float]:
    """Return the numbers of the state on one side of a slip."""
    numbers = slide_observables(problem.at(step), state.gap, state.displacement)
    exerts_shear = len(state.traction) > 1
    numbers["force"] = float(state.traction[1:].mean() * problem.grid.lengths[0]) if exerts_shear else 0.0
    touches_all_over = abs(state.gap[0].mean()) <= TOUCHING
    numbers["length"] = np.nan if touches_all_over else contact_length(state.gap[0], problem.grid.spacing[0])
    return numbers
