"""Load against approach through states and both sides of jumps, and what the width of a jump leaves open."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.interface.cohesive_zone import NormalCohesiveZone
from contactsim.observables.load_curve import FOLD, LoadCurve, join_folds
from contactsim.observables.path_summary import pull_off, summarise_load_curves
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.nested import Nested
from contactsim.paths.requested import Requested
from contactsim.simulation import simulate
from support.smooth import LAWS, along, scene_of

APPROACH = np.array([-4.0, -3.0, -2.0, -1.0, 0.0])
LOAD = np.array([-0.1, -0.2, -5.0, -4.0, 2.0])
JUMP = np.array([0.0, 0.0, 3.0, 0.0, 0.0])


def folds(*rows, peak=None, then=None):
    """Columns of jumps, each a step, two approaches and two loads; peak, then: largest pulls, else the sides."""
    numbers = []
    for step, before, after, load_before, load_after in rows:
        (top, load_top), (end, load_end) = peak or (before, load_before), then or (after, load_after)
        values = (step, top, before, after, end, load_top, load_before, load_after, load_end)
        numbers.append(dict(zip(FOLD, values, strict=True)))
    data = join_folds(numbers)
    return [data[name].values for name in FOLD]


def test_both_sides_of_a_jump_lie_between_the_states_beside_it():
    curve = LoadCurve.from_states(APPROACH, LOAD, JUMP, folds((2, -2.5, -2.4, -0.3, -5.3)))
    assert curve.approach.tolist() == [-4.0, -3.0, -2.5, -2.4, -2.0, -1.0, 0.0]
    assert curve.load.tolist() == [-0.1, -0.2, -0.3, -5.3, -5.0, -4.0, 2.0]
    assert curve.width == pytest.approx([0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0])
    assert np.flatnonzero(~curve.is_state).tolist() == [2, 3]


def test_the_largest_pulls_beside_a_jump_lie_between_the_states_and_the_jump():
    jump = (4, -0.5, -0.4, -1.0, 1.5)
    curve = LoadCurve.from_states(APPROACH, LOAD, JUMP[::-1], folds(jump, peak=(-0.8, -6.0)))
    assert curve.approach.tolist() == [-4.0, -3.0, -2.0, -1.0, -0.8, -0.5, -0.4, 0.0]
    assert curve.load[4] == -6.0
    assert not curve.is_state[4]
    assert pull_off(curve)["pull_off_approach_loading"] == -0.8
    later = LoadCurve.from_states(APPROACH, LOAD, JUMP[::-1], folds(jump, then=(-0.3, -5.5)))
    assert (later.approach[6], later.load[6]) == (-0.3, -5.5)
    begun = LoadCurve.from_states(APPROACH, LOAD, JUMP[::-1], folds(jump, peak=(-1.0, -4.0)))
    assert begun.approach.size == 7  # the step began with it


def test_a_side_of_a_jump_that_is_a_state_is_no_second_place():
    first = LoadCurve.from_states(APPROACH, LOAD, JUMP, folds((2, -3.0, -2.4, -0.2, -5.3)))
    assert first.approach.tolist() == [-4.0, -3.0, -2.4, -2.0, -1.0, 0.0]
    last = LoadCurve.from_states(APPROACH, LOAD, JUMP, folds((2, -2.5, -2.0, -0.3, -5.0)))
    assert last.approach.tolist() == [-4.0, -3.0, -2.5, -2.0, -1.0, 0.0]
    assert last.width[3] == 0.5
    unknown = LoadCurve.from_states(APPROACH, LOAD, JUMP, folds((2, -3.0, -2.0, -0.2, -5.0)))
    assert unknown.approach.tolist() == APPROACH.tolist()
    assert unknown.width.tolist() == [0.0, 0.0, 1.0, 0.0, 0.0]


def test_jumps_that_follow_each_other_within_a_step_share_the_state_between_them():
    rows = (2, -2.8, -2.7, -0.3, -1.0), (2, -2.7, -2.6, -1.0, -5.3)
    curve = LoadCurve.from_states(APPROACH, LOAD, JUMP, folds(*rows))
    assert curve.approach.tolist() == [-4.0, -3.0, -2.8, -2.7, -2.6, -2.0, -1.0, 0.0]
    assert curve.width[3:5] == pytest.approx([0.1, 0.1])


def test_a_jump_without_known_sides_lies_anywhere_in_its_step():
    curve = LoadCurve.from_states(APPROACH, LOAD, JUMP, folds())
    assert curve.width.tolist() == [0.0, 0.0, 1.0, 0.0, 0.0]
    found = pull_off(curve)
    assert found["pull_off_load_loading"] == 5.0
    assert found["pull_off_load_loading_increment_error"] == pytest.approx(1.0)  # 1 N/m/nm over the step
    assert found["pull_off_approach_loading_increment_error"] == 1.0


def test_the_error_after_a_jump_is_the_slope_over_its_width():
    found = pull_off(LoadCurve.from_states(APPROACH, LOAD, JUMP, folds((2, -2.5, -2.4, -0.3, -5.3))))
    assert (found["pull_off_load_loading"], found["pull_off_approach_loading"]) == (5.3, -2.4)
    assert found["pull_off_load_loading_increment_error"] == pytest.approx(0.1 * 0.3 / 0.4)
    assert found["pull_off_approach_loading_increment_error"] == pytest.approx(0.1)


@pytest.mark.parametrize("step", [0.01, 0.1, 1.0])
def test_the_error_before_a_jump_is_that_of_a_branch_that_ends_like_a_square_root(step):
    fold, width = -2.0, 0.05
    approach = np.array([fold - width - 2 * step, fold - width - step, fold - width, fold, 0.0])
    load = np.append(np.sqrt(fold - approach[:3]) - 3.0, [-0.5, 1.0])  # the pull at the fold is 3
    curve = LoadCurve.from_states(approach, load, np.array([0.0, 0.0, 0.0, 1.0, 0.0]))
    found = pull_off(curve)
    pull, error = (found[f"pull_off_load_loading{end}"] for end in ("", "_increment_error"))
    assert 3.0 - pull == pytest.approx(error)


def test_the_neighbours_of_a_smooth_extreme_are_states_not_sides_of_a_jump():
    folded = folds((2, -2.02, -2.01, -0.3, -4.99))
    found = pull_off(LoadCurve.from_states(APPROACH, LOAD, JUMP, folded))
    assert found["pull_off_load_loading"] == 5.0
    assert found["pull_off_load_loading_increment_error"] == pytest.approx(1.0)  # not the 0.01 of the side


@pytest.mark.parametrize("shift", [-0.49, -0.2, 0.0, 0.3, 0.49])
def test_the_error_of_a_smooth_extreme_covers_a_curve_that_bends_more_on_one_side(shift):
    def load(approach):
        return approach**2 - 0.2 * approach**3 - 5.0

    approach = np.arange(-3.0, 3.0) + shift
    found = pull_off(LoadCurve.from_states(approach, load(approach), np.zeros(6)))
    pull, error = (found[f"pull_off_load_loading{end}"] for end in ("", "_increment_error"))
    assert 0 <= 5.0 - pull <= error <= 1.0
    assert abs(found["pull_off_approach_loading"]) <= found["pull_off_approach_loading_increment_error"]


INTO = along(-6.4, -5.2, 0.2) >> along(-5.0, 0.0, 1.0)


@pytest.mark.parametrize("increments", [Requested(), Adaptive()], ids=["requested", "adaptive"])
def test_a_jump_is_known_to_its_width_and_the_states_are_those_without_it(increments):
    narrow, wide = (
        simulate(scene_of(LAWS["frictionless"], INTO), points=256, tolerance=1e-7, increments=each)
        for each in (increments, type(increments)(fold_width=10.0))
    )
    assert narrow.sizes["fold"] == 1
    before, after = float(narrow.fold_approach_before[0]), float(narrow.fold_approach_after[0])
    assert 0 < after - before <= 0.002
    assert wide.fold_approach_before <= before < after <= wide.fold_approach_after
    jumps = [np.flatnonzero(data.jump).tolist() for data in (narrow, wide)]
    assert jumps == [narrow.fold_step.values.tolist()] * 2
    largest = float(-wide.line_load.min())
    assert np.allclose(narrow.line_load, wide.line_load, rtol=0, atol=1e-3 * largest)


def test_a_path_without_a_jump_solves_nothing_more():
    scene = scene_of(NormalCohesiveZone(0.4), along(-4.0, 0.0, 0.02))
    narrow, wide = (
        simulate(scene, points=128, tolerance=1e-7, increments=Requested(fold_width=width)) for width in (0.002, 10.0)
    )
    assert not narrow.jump.any()
    assert np.isnan(narrow.fold_step).all()
    assert narrow.drop_vars("seconds").identical(wide.drop_vars("seconds"))
    assert narrow.transforms.sum() > 0


def test_a_path_on_a_coarse_grid_leaves_its_jumps_as_wide_as_its_steps():
    scene = scene_of(LAWS["uncoupled"], along(-6.4, -4.4, 0.2))
    data = simulate(scene, points=256, tolerance=1e-7, increments=Nested([], coarse_ratio=2, intermediate_ratio=1))
    assert np.count_nonzero(data.jump) == 1
    assert np.isnan(data.fold_step).all()
    found = summarise_load_curves(data)
    assert found.pull_off_approach_loading_increment_error == pytest.approx(0.2)
