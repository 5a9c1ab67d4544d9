"""Slides that get harder: right, certified or an honest failure; and their judge finds faults of slides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contactsim.evaluation.robustness.judge import find_path_violation, judge
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.evaluation.robustness.sliding import LATTICE, SLIDING, large_increments, many_cells_slid, wide_window
from contactsim.solvers.registry import make_solver
from contactsim.status import Status

SOLVERS = {"newton": {}, "mass_weighted_verlet": {"budget": 300}}
EXACT = {"many_cells_slid", "fine_lattice", "wide_window"}
"""Hazards for which the fixed point contracts, but for a few severities."""


@pytest.mark.parametrize("hazard", SLIDING)
@pytest.mark.parametrize("severity", [0, 50, 100])
def test_no_slide_is_answered_wrongly(hazard, severity):
    case = hazard(severity)
    for name, options in SOLVERS.items():
        verdict = judge(case, make_solver(name, **options))
        if verdict.outcome is Outcome.FAILED:
            assert hazard.__name__ in {"pulled_off_slide", "pressed_through_slide"}
            assert ("over budget" if name == "newton" else "number of iterations") in verdict.reason
        else:
            known = case.exact is not None or case.ends is Status.NO_EQUILIBRIUM
            assert verdict.outcome is (Outcome.EXACT if known else Outcome.CERTIFIED), verdict.reason


@pytest.mark.parametrize("hazard", SLIDING)
def test_a_slide_is_the_same_every_time_and_not_symmetric(hazard):
    assert hazard(37) == hazard(37)
    assert not hazard(37).even


def test_exact_slides_have_exact_answers():
    known = {hazard.__name__ for hazard in SLIDING if any(hazard(at).exact is not None for at in (0, 30, 100))}
    assert known >= EXACT


def test_energy_minimisation_refuses_slides_of_a_law_without_potential():
    assert judge(wide_window(0), "energy_minimisation").outcome is Outcome.REFUSED


def test_a_state_one_lattice_constant_too_far_is_found():
    """A slip that did not happen, or one too many, leaves a balanced state: only the branch tells."""
    case = large_increments(0)
    problem, states = case.follow(make_solver("newton"))
    assert find_path_violation(case, problem, states) == ""
    last = states[-1]
    moved = last.displacement.copy()
    moved[1, 0] += LATTICE
    found = make_solver("newton").flow_from(problem.at(last.step), moved)
    assert found.is_stable
    wrong = [*states[:-1], replace(last, displacement=found.displacement, solution=found)]
    assert "smaller increments" in find_path_violation(case, problem, wrong)


def test_the_judge_sums_over_sites_by_itself():
    case = many_cells_slid(20)
    problem, states = case.follow(make_solver("newton"))
    for state in states:
        gap, traction = state.fields()
        np.testing.assert_allclose(case.gap(state.step, state.displacement), gap, atol=1e-9)
        np.testing.assert_allclose(case.traction(gap), traction, atol=1e-10 * problem.strength)
