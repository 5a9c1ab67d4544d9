"""Paths of smooth laws that get harder: right, certified or an honest failure; and their judge finds every fault."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contactsim.contact.loading import pressures
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.evaluation.robustness import rough
from contactsim.evaluation.robustness.adhesive import ADHESIVE
from contactsim.evaluation.robustness.judge import find_path_violation, judge
from contactsim.evaluation.robustness.navier import surface_compliance
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.evaluation.robustness.path_cases import PathCase
from contactsim.evaluation.robustness.registry import HAZARDS
from contactsim.evaluation.robustness.rough import ROUGH
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.solvers.registry import make_solver
from contactsim.status import Status
from support.smooth import LENGTH, along, scene_of

NAMES = [hazard.__name__ for hazard in (*ADHESIVE, *ROUGH)]
SOLVERS = {"newton": {}, "mass_weighted_verlet": {"budget": 300}, "energy_minimisation": {}}
CASE = PathCase(scene_of(NormalCohesiveZone(2.0), along(-8.0, 0.0, 4.0)), parts=4)
FRICTION = PathCase(scene_of(CohesiveZone(2.0, 1.0), along(-8.0, 0.0, 4.0)))
HONEST = {
    ("newton", "deep_path"): "interpenetration",
    ("mass_weighted_verlet", "deep_path"): "number of iterations",
    ("mass_weighted_verlet", "past_pull_off"): "number of iterations",
    ("energy_minimisation", "deep_step"): "number of iterations",
    ("energy_minimisation", "past_pull_off"): "number of iterations",
    ("energy_minimisation", "soft_wall"): "number of iterations",
    ("energy_minimisation", "steep_ridges"): "number of iterations",  # the energy rounds; it depends on the BLAS kernel
    ("energy_minimisation", "jagged_line"): "number of iterations",
    ("mass_weighted_verlet", "frictionless_flow"): "number of iterations",
}
"""Which solver may fail where, and what it says."""


@pytest.mark.parametrize("hazard", NAMES)
@pytest.mark.parametrize("severity", [0, 50, 100])
def test_no_path_is_answered_wrongly(hazard, severity):
    case = HAZARDS[hazard](severity)
    for name, options in SOLVERS.items():
        method = make_solver(name, **options)
        verdict = judge(case, method)
        if not case.scene.traits <= method.accepts:
            assert verdict.outcome is Outcome.REFUSED
            assert "accepts NON_CONSERVATIVE" in verdict.reason
        elif verdict.outcome is Outcome.FAILED:
            assert HONEST[name, hazard] in verdict.reason
        else:
            known = case.exact is not None or case.twin is not None or case.ends is Status.NO_EQUILIBRIUM
            assert verdict.outcome is (Outcome.EXACT if known else Outcome.CERTIFIED), verdict.reason


@pytest.mark.parametrize("hazard", NAMES)
def test_a_solver_of_hard_walls_is_refused_and_one_of_smooth_laws_refuses_them(hazard):
    assert "accepts " in judge(HAZARDS[hazard](0), "active_set").reason
    assert "accepts WALL" in judge(HAZARDS["flat"](0), "newton").reason


@pytest.mark.parametrize("hazard", NAMES)
def test_a_path_is_the_same_every_time_and_symmetric_where_it_says_so(hazard):
    assert HAZARDS[hazard](37) == HAZARDS[hazard](37)
    heights = HAZARDS[hazard](37).shape[0, 1:]
    assert np.array_equal(heights, heights[::-1]) == HAZARDS[hazard](37).even


# the boundary value problem, solved in doubles, loses up to 1e-9 where a layer is thin and incompressible
@pytest.mark.parametrize(
    ("body", "lost"),
    [
        (HalfSpace(77.0, 0.3), 1e-14),
        (Layer(77.0, 0.3, 5000.0), 1e-14),
        (Layer(77.0, 0.0, 100.0), 1e-12),
        (Layer(77.0, 0.5, 10.0), 1e-8),
        (Layer(77.0, 0.3, 1e7), 1e-14),
    ],
    ids=repr,
)
def test_an_independent_boundary_value_solution_gives_the_same_compliance(body, lost):
    q = 2 * np.pi * np.fft.rfftfreq(64, LENGTH / 64)
    ours, theirs = body.coupled_compliance(q), surface_compliance(body, q)
    assert np.allclose(theirs[:, 0, 0], ours.diagonal[0], rtol=lost, atol=0)
    assert np.allclose(theirs[:, 1, 1], ours.diagonal[1], rtol=lost, atol=0)
    scale = np.sqrt(ours.diagonal[0] * ours.diagonal[1])
    assert (np.abs(theirs[:, 0, 1] - 1j * ours.coupling) <= lost * scale).all()
    assert (np.abs(theirs[:, 1, 0] + 1j * ours.coupling) <= lost * scale).all()


@pytest.mark.parametrize("case", [CASE, FRICTION], ids=["uncoupled", "frictional"])
def test_every_fault_of_a_state_is_found(case):
    problem, states = case.follow(make_solver("newton"))
    assert find_path_violation(case, problem, states) == ""
    x = np.arange(case.points)
    odd, even = (1e-2 * np.fft.rfft(f(2 * np.pi * x / case.points)) / case.points for f in (np.sin, np.cos))
    for wave, fault in ((odd, "unbalanced"), (even, "unbalanced"), (np.nan * even, "finite")):
        moved = states[-1].displacement.copy()
        moved[-1] += wave
        assert fault in find_path_violation(case, problem, [*states[:-1], replace(states[-1], displacement=moved)])
    lax = replace(case, tolerance=1.0)
    moved = states[-1].displacement.copy()
    moved[0] += odd
    assert "symmetric" in find_path_violation(lax, problem, [replace(states[-1], displacement=moved)])


@pytest.mark.parametrize(("error", "fault"), [(5e-5, ""), (3e-4, "smaller increments")])
def test_a_force_off_by_more_than_a_ten_thousandth_of_the_largest_is_found(error, fault):
    case = replace(CASE)
    problem, states = case.follow(make_solver("newton"))
    vars(case)["branch"] = CASE.branch + error * np.abs(CASE.branch).max()
    assert fault in find_path_violation(case, problem, states)
    assert fault or not find_path_violation(case, problem, states)


def test_a_state_of_another_branch_is_found():
    # unloading, at -8 nm, is still in contact
    there = replace(CASE, scene=replace(CASE.scene, path=along(-8.0, 0.0, 4.0) >> along(-0.5, -8.0, 0.5)), parts=0)
    problem, states = there.follow(make_solver("newton"))
    verdict = find_path_violation(CASE, problem, [states[-1]])
    assert "smaller increments" in verdict


@pytest.mark.parametrize("name", ["newton", "mass_weighted_verlet"])
def test_one_step_of_4_nm_onto_a_rough_line_ends_where_sixteen_small_steps_end(name):
    case = HAZARDS["one_large_step"](100)
    assert len(case.steps) == 1
    assert case.branch is not None
    _, states = case.follow(make_solver(name))
    load = case.forces(states[0].step, states[0].displacement)[0]
    assert load == pytest.approx(case.branch[0, 0], rel=1e-4)


def test_a_rough_line_has_its_rms_height_and_hurst_exponent():
    for hurst_exponent, height in ((0.8, 2.5), (0.2, 30.0)):
        heights = rough.Ridges(height, hurst_exponent).heights(rough.POINTS)
        waves = np.abs(np.fft.rfft(heights)) * 2 / rough.POINTS
        assert np.sqrt((heights**2).mean()) == pytest.approx(height, rel=1e-12)
        assert np.polyfit(np.log(np.arange(4, 64)), np.log(waves[4:64]), 1)[0] == pytest.approx(
            -(1 + 2 * hurst_exponent) / 2
        )
        assert waves[64:].max() < 1e-12 * height


def test_a_path_that_ends_otherwise_than_expected_is_wrong():
    pulled = PathCase(scene_of(NormalCohesiveZone(2.0), pressures([0.02, -1.0])), ends=Status.NO_EQUILIBRIUM)
    assert judge(pulled, "newton").outcome is Outcome.EXACT
    assert "not converged, no_equilibrium" in judge(replace(pulled, ends=Status.CONVERGED), "newton").reason
    held = replace(pulled, scene=replace(pulled.scene, path=pressures([0.02, -0.001])))
    assert judge(held, "newton").outcome is Outcome.WRONG


def test_running_out_of_iterations_and_divergence_are_reported():
    short = judge(CASE, make_solver("newton", newton_budget=1, flow_budget=1))
    assert (short.outcome, "number of iterations" in short.reason) == (Outcome.FAILED, True)
    deep = judge(HAZARDS["deep_step"](100), "damped_verlet")
    assert deep.outcome in (Outcome.NON_FINITE, Outcome.REFUSED)


def test_fixed_point_iteration_finds_the_exact_answer_for_stiff_bodies_and_gives_none_otherwise():
    weak, strong = HAZARDS["vanishing_adhesion"](75), HAZARDS["vanishing_adhesion"](0)
    rigid = [-float(weak.traction(weak.gap(step, np.zeros((1, 65))))[0].mean()) * 5000.0 for step in weak.steps]
    assert np.allclose(weak.exact[:, 0], rigid, rtol=1e-6)
    assert strong.exact is None
