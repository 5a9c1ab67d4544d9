"""Small hostile load paths, judged by equations that are written once more; hundreds are in the benchmarks."""

from __future__ import annotations

import sys

import numpy as np
import pytest

import contactsim as cs
from contactsim.status import Status
from support.places import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))

import hostile_paths

ONCE_BAD = {
    8: "an interpolated state did not carry its load",
    38: "nor beside a hard wall",
    111: "a residual beyond the heights moved a free surface",
    3: "a pull on a ramp of a thousandth of the law's length had no end",
    91: "a motion across a ramp did not end",
    131: "nor on a free surface",
    103: "a wall too stiff for its law was not found",
}
"""Numbers of scenes of seed 1, and what was wrong with them."""


@pytest.mark.parametrize("number", ONCE_BAD, ids=ONCE_BAD.values())
def test_a_hostile_path_is_right(number):
    _, verdict, _, words = hostile_paths.judge(number, seed=1)
    assert verdict == "right", words


def attracted_cylinder(ramp: float, path: cs.LoadPath, offset: float = 0.0) -> cs.Scene:
    """A soft cylinder that a constant attraction pulls to a wall."""
    cylinder = cs.Cylinder(100.0, radius=1000.0).heights(64) + offset
    surface = cs.Topography(cylinder, (100.0 / 64,))
    effects = cs.HardWall(), cs.DugdaleAttraction(0.05, 0.5, ramp=ramp)
    return cs.Scene(cs.HalfSpace(contact_modulus=1.0), surface, effects, path)


def test_a_motion_of_many_ramps_takes_no_more_steps_on_a_steeper_one():
    work = [
        float(cs.simulate(attracted_cylinder(ramp, cs.approaches([0.2])), points=64).transforms.sum())
        for ramp in (0.01, 0.001)
    ]
    assert work[1] < 2 * work[0]


def test_a_load_that_presses_moves_bodies_together_from_beyond_the_reach_of_a_steep_law():
    near, far = (
        cs.simulate(attracted_cylinder(0.001, cs.pressures([0.01]), offset), points=64, tolerance=1e-6)
        for offset in (0.0, -3.0)
    )
    assert far.status.item() == Status.CONVERGED.value[0]
    assert far.approach.item() == pytest.approx(near.approach.item() + 3.0, abs=1e-3)


def test_the_pressure_of_a_wall_is_corrected_within_newtons_steps():
    law = cs.ExponentialAttraction(0.05, 0.5)
    path = cs.approaches([0.0, 0.3], 0.03)
    scene = cs.Scene(cs.HalfSpace(1.0), cs.Cylinder(100.0, radius=1000.0), (cs.HardWall(), law), path)
    data = cs.simulate(scene, points=64, tolerance=1e-8)
    assert (data.status == Status.CONVERGED.value[0]).all()
    assert data.transforms.sum() < 15_000


def test_a_state_after_jumps_that_no_work_was_left_to_locate_says_so():
    path = cs.approaches([-3.0, -2.9, 0.3, 0.4])
    scene = cs.Scene(cs.HalfSpace(1.0), cs.Cylinder(100.0, radius=1000.0), cs.NormalCohesiveZone(0.5, 0.5), path)
    whole, short = (
        cs.simulate(scene, points=64, tolerance=1e-6, increments=cs.Requested(budget=budget)) for budget in (5e4, 900)
    )
    assert (whole.status == 0).all()
    assert short.status.values[1] == Status.UNLOCATED.value[0]
    assert Status.UNLOCATED.solved
    assert np.isfinite(short.line_load).all()


@pytest.mark.parametrize("kind", ["requested", "adaptive", "nested"])
def test_a_state_over_its_budget_is_told_and_the_states_before_it_are_kept(kind):
    path = cs.approaches([-3.0, -2.9, 0.3, 0.4])
    scene = cs.Scene(cs.HalfSpace(1.0), cs.Cylinder(100.0, radius=1000.0), cs.NormalCohesiveZone(0.5, 0.5), path)
    whole = cs.simulate(scene, points=64, tolerance=1e-6)
    increments = {
        "requested": cs.Requested(budget=200),
        "adaptive": cs.Adaptive(budget=75, error=0.02, least=0.01, most=0.1),
        "nested": cs.Nested([step.value for step in path.steps[1:]], coarse_ratio=2, intermediate_ratio=2, budget=70),
    }
    data = cs.simulate(scene, points=64, tolerance=1e-6, increments=increments[kind])
    numbers = list(data.status.values)
    place = numbers.index(Status.OVER_BUDGET.value[0])
    assert place >= (kind != "nested") and cs.Status.OVER_BUDGET.sentence.startswith("over budget")
    assert set(numbers[place + 1 :]) <= {Status.SKIPPED.value[0]}
    kept = slice(0, place)
    assert np.isfinite(data.mean_pressure.values[kept]).all()
    np.testing.assert_allclose(data.mean_pressure.values[kept], whole.mean_pressure.values[kept], rtol=1e-2, atol=1e-5)


def test_the_judge_sees_every_kind_of_wrong_state():
    case = hostile_paths.draw_case(91, seed=1)
    data = cs.simulate(case.scene, **case.options)
    judge = hostile_paths.Judge(case, data)
    place, state = next(iter(hostile_paths.solved_states(case, data)))

    def errors(**changes):
        return judge.errors(state.assign({name: state[name] + value for name, value in changes.items()}), place)

    assert max(errors().values()) <= 1
    law, wave = case.scene.laws[-1], np.cos(np.arange(data.heights.size))
    assert errors(normal_gap=-1e-3 * law.normal_length)["overlap"] > 1
    assert errors(normal_traction=1e-3 * law.strength)["load"] > 1
    assert errors(normal_traction=1e-3 * law.strength * wave)["equilibrium"] > 1
    assert errors(approach=0.1 * law.normal_length)["mean gap"] > 1 or errors(approach=0.1)["equilibrium"] > 1
    assert errors(normal_gap=np.nan) == {"finite": np.inf}
