"""Read the numbers of a slip off the states on both sides of it."""

from __future__ import annotations

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.observables.adhesion import contact_length
from contactsim.observables.sliding import TOUCHING, slide_observables
from contactsim.paths.state import Jump
from contactsim.solvers.cohesive.base import Equilibrium


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
