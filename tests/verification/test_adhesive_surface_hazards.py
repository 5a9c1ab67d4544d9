"""Paths of smooth laws on surfaces that get harder: never wrong; their judge finds every fault; solvers agree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import contactsim as cs
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.evaluation.robustness.adhesive_surfaces import ADHESIVE_SURFACES, oblong_cell
from contactsim.evaluation.robustness.judge import find_path_violation, judge
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.evaluation.robustness.registry import HAZARDS
from contactsim.solvers.registry import make_solver

NAMES = [hazard.__name__ for hazard in ADHESIVE_SURFACES]
SOLVERS = {"newton": {}, "mass_weighted_verlet": {"budget": 300}, "energy_minimisation": {}}
HONEST = {"snap_in": ("interpenetration", "number of iterations")}
"""Hazards in which every solver may fail, and what it says; to minimise the energy ends where that rounds."""


@pytest.mark.parametrize("hazard", NAMES)
@pytest.mark.parametrize("severity", [0, 50, 100])
def test_no_path_is_answered_wrongly(hazard, severity):
    case = HAZARDS[hazard](severity)
    for name, options in SOLVERS.items():
        verdict = judge(case, make_solver(name, **options))
        if verdict.outcome is Outcome.FAILED:
            allowed = HONEST.get(hazard, ()) if name != "energy_minimisation" else ("number of iterations",)
            assert any(words in verdict.reason for words in allowed), (name, verdict.reason)
        else:
            known = case.exact is not None
            assert verdict.outcome is (Outcome.EXACT if known else Outcome.CERTIFIED), (name, verdict.reason)


def test_every_fault_of_a_state_is_found():
    case = oblong_cell(30)
    problem, states = case.follow(make_solver("newton"))
    assert find_path_violation(case, problem, states) == ""
    for wave, fault in ((1e-2, "unbalanced"), (np.nan, "finite")):
        moved = states[-1].displacement.copy()
        moved[0, 3] += wave
        assert fault in find_path_violation(case, problem, [*states[:-1], replace(states[-1], displacement=moved)])
    branch = np.array([case.forces(state.step, state.displacement) for state in states])
    vars(case)["branch"] = branch * [[1.0], [1.0 + 3e-4]]
    assert "smaller increments" in find_path_violation(case, problem, states)


def test_the_equations_of_the_judge_are_those_of_the_problem():
    case = oblong_cell(50)
    problem = pose_cohesive(case.scene, case.heights, 1e-4).at(case.steps[-1])
    rng = np.random.default_rng(1)
    displacement = problem.coefficients(rng.normal(size=(1, problem.grid.size)) * 0.1)
    displacement[0, 0] = 0.0
    gap = problem.gap(displacement)
    assert case.gap(case.steps[-1], displacement) == pytest.approx(gap, abs=1e-12)
    traction = problem.traction(gap)
    assert case.traction(gap) == pytest.approx(traction, rel=1e-12)
    largest = np.abs(problem.grid.backward_rows(problem.residual(displacement, traction))).max()
    assert case.residual(case.steps[-1], displacement) == pytest.approx(largest, rel=1e-9)


def test_three_solvers_agree_along_a_loop_with_jumps():
    surface = cs.SelfAffine(256.0, 0.8, 128.0, 32.0, rms_height=3.0, seed=1, dimensions=2)
    law, path = cs.NormalCohesiveZone(0.3, 1.0), cs.approaches([-12.0, -6.0, -18.0], 0.5)
    scene = cs.Scene(cs.HalfSpace(1.0), surface, law, path)
    options = SOLVERS | {"mass_weighted_verlet": {"budget": 2000}}
    paths = {
        name: cs.simulate(scene, points=32, tolerance=1e-6, solver=make_solver(name, **own))
        for name, own in options.items()
    }
    newton = paths.pop("newton")
    assert (newton.jump > 0).sum() >= 2
    for name, data in paths.items():
        assert (data.status == 0).all(), name
        assert np.abs(data.normal_force - newton.normal_force).max() < 1e-5 * np.abs(newton.normal_force).max(), name
