"""Estimates of errors, and what decides from them, on numbers known by hand."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from contactsim import HalfSpace, HardWall, Scene, Sphere, pressures
from contactsim.error_control import neglect
from contactsim.error_control.estimates import FACTORS, ORDER, tell_error, told_changes
from contactsim.error_control.ladder import Controlled
from contactsim.paths.options import RunOptions, Setup

GRIDS = [(16, 45, 64), (8, 23, 64, 91)]


def ratios(grids):
    return [fine / coarse for coarse, fine in itertools.pairwise(grids)]


@pytest.mark.parametrize("grids", GRIDS)
def test_errors_that_fall_as_expected_are_told_exactly_by_each_change(grids):
    values = [np.array([1.0 + 3.0 * points**-ORDER]) for points in grids]
    assert np.ravel(told_changes(values, ratios(grids))) == pytest.approx(3.0 * grids[-1] ** -ORDER)
    count = len(grids) - 1
    assert tell_error(values, ratios(grids)) == pytest.approx(FACTORS[count] * count**0.5 * 3.0 * grids[-1] ** -ORDER)


def test_one_change_tells_nothing_and_fewer_say_less():
    assert FACTORS[2] > FACTORS[3] >= 1
    assert np.isinf(tell_error([np.array([1.0]), np.array([1.0])], (2.0,)))


@pytest.mark.parametrize("order", [0.8, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("grids", [(16, 32, 64), (16, 32, 64, 128), (16, 32, 64, 91)])
def test_errors_of_other_orders_are_covered(grids, order):
    values = [np.array([1.0 + points**-order]) for points in grids]
    assert tell_error(values, ratios(grids)) >= grids[-1] ** -order


def test_a_last_change_that_is_small_by_chance_does_not_hide_the_one_before():
    values = [np.array([value]) for value in (1.1, 1.0, 1.0)]
    assert tell_error(values, (2.0, 2.0)) == pytest.approx(FACTORS[2] * 0.1 / (2**ORDER - 1) / 2**ORDER)


@pytest.mark.parametrize("missing", [np.nan, np.inf])
@pytest.mark.parametrize("lost", [0, 1, 2, 3])
def test_a_run_without_the_quantity_or_a_solution_leaves_the_error_unknown_or_to_later_changes(missing, lost):
    values = [np.array([1.0 + 0.1 / 2**place]) for place in range(4)]
    values[lost] = np.array([missing])
    error = tell_error(values, (2.0,) * 3)
    if lost >= 1:
        assert np.isinf(error)
    else:
        assert error == pytest.approx(tell_error(values[lost + 1 :], (2.0,) * (2 - lost)))


def test_what_both_lack_has_no_error_and_what_neither_solved_has():
    assert tell_error([np.array([np.nan])] * 3, (2.0, 2.0)) == 0
    assert np.isinf(tell_error([np.array([np.inf])] * 3, (2.0, 2.0)))


def test_loads_have_errors_of_their_own():
    errors = tell_error([np.array([1.0, 2.0]), np.array([1.1, 2.0]), np.array([1.0, 2.0])], (2.0, 2.0))
    assert errors[0] > 0
    assert errors[1] == 0


@pytest.mark.parametrize(
    ("loads", "met"),
    [([0.001, 0.01], True), ([0.001, 0.011], False), ([0.011, 0.001], False), ([0.001, np.nan], False)],
)
def test_an_error_is_met_where_every_load_of_every_quantity_meets_it(loads, met):
    errors = {"relative_contact_area": np.full(2, 1e-3), "mean_gap": np.array(loads)}
    assert Controlled(None, [], errors, wanted=0.01).met is met


def test_the_worst_member_of_a_sample_decides_what_is_neglected(monkeypatch):
    monkeypatch.setattr(neglect, "neglectable_effects", lambda scene: ["friction"])
    monkeypatch.setattr(neglect, "expected_change", lambda scene, effect: 0.001)
    monkeypatch.setattr(neglect, "_coarse_check", lambda setup: setup)
    monkeypatch.setattr(neglect, "change_without", lambda setup, *rest: setup.options.tolerance)
    scene = Scene(HalfSpace(3.0), Sphere(400.0, 1000.0), HardWall(), pressures([0.01]))
    for changes, neglected in (([0.01, 0.04], ["friction"]), ([0.01, 0.06], []), ([0.06, 0.01], [])):
        samples = [Setup(scene, RunOptions(64, tolerance=change)) for change in changes]
        decision = neglect.decide_neglect(samples, 0.05, ["mean_gap"])
        assert decision.neglected == neglected
