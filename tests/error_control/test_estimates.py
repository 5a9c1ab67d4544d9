"""Estimates of errors, and what decides from them, on numbers known by hand."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from contactsim import HalfSpace, HardWall, Scene, Sphere, pressures
from contactsim.error_control import estimates, neglect
from contactsim.error_control.control import Controlled
from contactsim.error_control.estimates import DIFFERENCE_WEIGHT, estimate_errors
from contactsim.error_control.scaling import features
from contactsim.paths.options import RunOptions, Setup
from contactsim.reference import hard_wall


@pytest.mark.parametrize(
    ("loads", "met"),
    [([0.001, 0.01], True), ([0.001, 0.011], False), ([0.011, 0.001], False), ([0.001, np.nan], False)],
)
def test_an_error_is_met_where_every_load_of_every_quantity_meets_it(loads, met):
    errors = {"relative_contact_area": np.full(2, 1e-3), "mean_gap": np.array(loads)}
    assert Controlled(None, [], errors, wanted=0.01, companion=None).met is met


def run(value, expected):
    """A solution that stands for its value and for the error that is expected of it."""
    return SimpleNamespace(setup=expected, values={"mean_gap": np.array([value])}, solved=True, increment_errors={})


def test_a_difference_of_second_order_gives_the_error_of_the_finer_run(monkeypatch):
    monkeypatch.setattr(estimates, "expect_error", lambda setup, family, name, knobs: setup)
    fine, coarse = run(1.003, 1e-4), run(1.012, 4e-4)  # of 1, with twice the spacing
    (error,) = estimate_errors(fine, [coarse], SimpleNamespace(resolved={}), ["mean_gap"])["mean_gap"]
    assert error == pytest.approx(DIFFERENCE_WEIGHT * 0.003 / 1.003)
    (expected,) = estimate_errors(run(1.0, 1e-4), [run(1.0, 4e-4)], SimpleNamespace(resolved={}), ["mean_gap"])[
        "mean_gap"
    ]
    assert expected == 1e-4  # a difference may vanish by chance


def test_of_a_slide_all_coarser_runs_count_and_the_error_that_its_states_tell_is_added(monkeypatch):
    monkeypatch.setattr(estimates, "expect_error", lambda setup, family, name, knobs: setup)
    fine, coarsest, coarse = run(1.0, 1e-4), run(1.14, 1e-2), run(1.0, 1e-3)  # the last two agree by chance
    fine.points, coarsest.points, coarse.points = 64, 16, 32
    without = run(np.nan, 1e-1)
    fine.increment_errors["mean_gap"] = np.array([0.003])
    errors = estimate_errors(fine, [without, coarsest, coarse], SimpleNamespace(resolved={}), ["mean_gap"])
    assert errors["mean_gap"] == pytest.approx(0.14 / (4**1.5 - 1) + 0.003)


def test_the_expected_area_of_a_sphere_is_that_of_hertz():
    contact_radius, radius, length = 20.0, 1000.0, 400.0
    load = hard_wall.sphere_load(contact_radius, radius, 3.0) / length**2
    (numbers,) = features(Scene(HalfSpace(3.0), Sphere(length, radius), HardWall(), pressures([load])))
    assert np.exp(numbers["area"]) == pytest.approx(np.pi * contact_radius**2 / length**2, rel=1e-12)


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
