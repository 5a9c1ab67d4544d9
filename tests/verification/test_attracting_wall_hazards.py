"""Paths along a hard wall that attracts, that get harder: never wrong; their judge finds every fault."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contactsim.evaluation.robustness.attracting_walls import ATTRACTING_WALLS, attracting_wall_range
from contactsim.evaluation.robustness.judge import find_path_violation, judge
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.evaluation.robustness.registry import HAZARDS
from contactsim.solvers.registry import make_solver

NAMES = [hazard.__name__ for hazard in ATTRACTING_WALLS]


@pytest.mark.parametrize("hazard", NAMES)
@pytest.mark.parametrize("severity", [0, 50, 100])
def test_no_path_is_answered_wrongly(hazard, severity):
    """To minimise the energy ends where the energy rounds, and says so."""
    case = HAZARDS[hazard](severity)
    newton = judge(case, "newton")
    assert newton.outcome is Outcome.CERTIFIED, newton.reason
    descent = judge(case, "energy_minimisation")
    assert descent.outcome is Outcome.CERTIFIED or "number of iterations" in descent.reason, descent.reason


def test_every_fault_of_a_state_is_found():
    case = attracting_wall_range(30)
    problem, states = case.follow(make_solver("newton"))
    assert find_path_violation(case, problem, states) == ""
    for row, wave, fault in ((3, 1e-2, "unbalanced"), (3, np.nan, "finite")):
        moved = states[-1].displacement.copy()
        moved[0, row] += wave
        assert fault in find_path_violation(case, problem, [*states[:-1], replace(states[-1], displacement=moved)])


def test_a_wall_that_pulls_and_one_that_is_passed_are_faults():
    case = attracting_wall_range(0)
    _, states = case.follow(make_solver("newton"))
    step, displacement = states[-1].step, states[-1].displacement
    assert case.residual(step, displacement) < 1e-5
    deeper = replace(step, value=step.value + 0.1)  # the same displacement at a larger approach: all points overlap
    assert case.residual(deeper, displacement) == np.inf
    gap, bearing = case.balance(step, displacement)
    touching = gap <= case.closed
    assert touching.any() and bearing[touching].max() > 1e-3
    apart = replace(step, value=step.value - 0.1)  # at a smaller one the wall pushes over open gaps
    assert case.residual(apart, displacement) > 1e-3
