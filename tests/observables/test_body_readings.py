"""Load curves at even approaches and on bodies of finite height, on made paths whose numbers are known by hand."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.observables.body_readings import (
    BY_HEIGHT,
    CURVE_APPROACHES,
    CURVE_DIMENSION,
    CURVES,
    load_curve_at,
    readings_on_bodies,
)
from contactsim.reference.hard_wall import uniaxial_modulus
from support.rough_readings import LENGTH, MODULUS, STEPS, rough_path

STIFFNESS = uniaxial_modulus(1.5, 0.3)
BODIES = ((5000.0, "on_5um"), (LENGTH, "on_one_period"), (2 * LENGTH, "on_two_periods"))


def test_a_body_of_finite_height_reaches_an_approach_under_a_smaller_pressure():
    found = readings_on_bodies(rough_path(), STIFFNESS)
    strain = 1e-4 * MODULUS / STIFFNESS  # for each nm of approach
    for height, name in BODIES:
        share = 1 / (1 + strain * height)
        assert float(found[f"pressure_at_20nm_{name}"]) == pytest.approx(1e-4 * 20 * share)
        assert float(found[f"area_at_12nm_{name}"]) == pytest.approx(12 / 60 * share)
        assert float(found[f"area_at_12nm_{name}_increment_error"]) == pytest.approx(0.0, abs=1e-12)
        assert found[f"pressure_curve_{name}"].values == pytest.approx(1e-4 * CURVE_APPROACHES * share)
    assert found["pressure_curve"].values == pytest.approx(1e-4 * CURVE_APPROACHES)
    assert found["pressure_curve"][CURVE_DIMENSION].values.tolist() == CURVE_APPROACHES.tolist()
    assert set(found) == {f"{name}{end}" for name in (*BY_HEIGHT, *CURVES) for end in ("", "_increment_error")}


def test_without_a_known_stiffness_there_is_the_curve_on_a_half_space_alone():
    assert set(readings_on_bodies(rough_path(), None)) == {"pressure_curve", "pressure_curve_increment_error"}


def test_a_body_that_falls_back_passes_the_states_in_a_jump():
    pulled = np.where((STEPS > 5) & (STEPS < 10), -0.01, 1e-4 * STEPS)
    found = readings_on_bodies(rough_path(pulled), STIFFNESS)
    after = 1e-4 / (1 + 1e-4 * MODULUS * LENGTH / STIFFNESS)
    assert float(found["pressure_at_20nm_on_one_period"]) == pytest.approx(20 * after)
    assert float(found["pressure_curve_on_one_period"][-1]) == pytest.approx(20 * after)


def test_a_curve_is_unknown_beyond_its_last_state_and_from_one_state():
    assert np.isnan(load_curve_at(np.arange(3.0), np.arange(3.0), np.array([1.0, 2.5]))).tolist() == [False, True]
    assert np.isnan(load_curve_at(np.ones(1), np.ones(1), np.array([1.0]))).all()


def test_the_error_of_a_curve_is_zero_at_solved_states_and_small_between_them():
    path = rough_path(1e-4 * STEPS**2)
    at_states = readings_on_bodies(path, None)["pressure_curve_increment_error"]
    assert np.abs(at_states).max() < 1e-12
    between = readings_on_bodies(path.assign(approach_first_touch=-5.5), None)
    exact = 1e-4 * (CURVE_APPROACHES - 0.5) ** 2
    true_error = np.abs(between["pressure_curve"].values - exact)[2:]
    error = between["pressure_curve_increment_error"].values[2:]
    assert (error > true_error).all() and error.max() < 1e-3 * exact.max()
