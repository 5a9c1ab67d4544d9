"""Hard cases at every severity: the right answer or a clear refusal, never NaN."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import contactsim
from cases import ALL, FAST, press, rough, wave
from contactsim import analytic
from contactsim.errors import SceneError
from contactsim.hazards import HAZARDS
from contactsim.stability import Outcome, judge
from contactsim.solvers.base import Status


def assert_right(result, tolerance=1e-3):
    """Finite, balanced, certified."""
    assert result.status is Status.CONVERGED
    assert np.isfinite(result.pressure).all()
    assert np.isfinite(result.gap).all()
    assert result.pressure.min() >= 0
    assert result.record.certificate.met(tolerance)


@pytest.mark.parametrize("name", ALL)
def test_few_points_carry_a_light_load(name):
    heights = rough(1024)
    for pressure in (1e-6, 1e-5, 1e-4):
        result = press(heights, pressure, name)
        assert_right(result)
        assert result.contact.sum() <= 12
        assert result.contact[np.argmax(heights)]


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("severity", [0, 25, 50, 75, 100])
@pytest.mark.parametrize("hazard", HAZARDS)
def test_no_hazard_is_answered_wrongly(name, severity, hazard):
    verdict = judge(HAZARDS[hazard](severity), name)
    assert verdict.outcome in (Outcome.RIGHT, Outcome.CERTIFIED, Outcome.REFUSED, Outcome.FAILED), verdict.reason
    if hazard == "tension":
        assert verdict.outcome is Outcome.REFUSED
    elif verdict.outcome is Outcome.FAILED:
        assert hazard in ("flat", "tight_tolerance")  # below what rounding allows, and said so


@pytest.mark.parametrize("name", ["active_set", "verlet"])
def test_a_low_spike_lets_its_surroundings_touch(name):
    heights = np.zeros(257)
    heights[100] = 1.0
    result = press(heights, 1e-3, name, tolerance=1e-6)
    assert_right(result, 1e-6)
    assert result.contact.sum() == 11


def test_polonsky_keer_goes_in_circles_around_a_low_spike_and_says_so():
    heights = np.zeros(257)
    heights[100] = 1.0
    result = press(heights, 1e-3, "polonsky_keer")
    assert result.status is Status.BUDGET
    assert result.record.certificate.non_uniformity > 1


@pytest.mark.parametrize("name", ALL)
def test_a_single_spike_carries_everything_until_its_surroundings_touch(name):
    heights = np.zeros(101)
    heights[37] = 1.0
    result = press(heights, 1e-3, name, tolerance=1e-6)
    assert_right(result, 1e-6)
    assert np.flatnonzero(result.contact).tolist() == [37]
    assert result.pressure[37] == pytest.approx(0.101)


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("height", [0.0, 1e-12, -5.0, 1e12])
def test_a_flat_surface_is_in_uniform_contact(name, height):
    result = press(np.full(32, height), 0.7, name)
    assert_right(result)
    assert np.allclose(result.pressure, 0.7, rtol=1e-12)


@pytest.mark.parametrize("name", FAST)
@pytest.mark.parametrize("points", [2, 3, 4, 5, 7, 8, 9, 97, 101, 510, 512, 513, 997, 1000])
def test_every_number_of_points_is_accepted(name, points):
    heights = np.random.default_rng(points).normal(size=points)
    for pressure in (1e-4, 0.05, 5.0):
        assert_right(press(heights, pressure, name))


@pytest.mark.parametrize("points", [64, 500, 4096])
def test_white_noise_at_nyquist_converges(points):
    heights = np.random.default_rng(0).normal(size=points)
    for pressure in (1e-3, 0.1, 1.0):
        assert_right(press(heights, pressure, tolerance=1e-6), 1e-6)
    zigzag = (-1.0) ** np.arange(points)
    result = press(zigzag, 0.1, tolerance=1e-9)
    assert_right(result, 1e-9)
    assert np.array_equal(result.contact, zigzag > 0)
    assert np.allclose(result.pressure[::2], 0.2, rtol=1e-6)


@pytest.mark.parametrize("name", FAST)
def test_steep_slopes_give_the_same_answer_as_shallow_ones(name):
    heights = rough(512)
    shallow = press(1e-3 * heights, 1e-3 * 0.02, name, tolerance=1e-6)
    steep = press(10 * heights, 10 * 0.02, name, tolerance=1e-6)
    assert np.array_equal(shallow.contact, steep.contact)
    assert np.allclose(steep.pressure, 1e4 * shallow.pressure, rtol=1e-7)


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("unit", [1e-12, 1e-6, 1.0, 1e6, 1e12])
@pytest.mark.parametrize("modulus", [1e-12, 1.0, 1e12])
def test_the_answer_does_not_depend_on_units(name, unit, modulus):
    heights = rough(256)
    reference = press(heights, 0.03, name)
    result = contactsim.press(
        unit * heights, spacing=unit, contact_modulus=modulus, mean_pressure=0.03 * modulus, solver=name
    )
    assert_right(result)
    assert np.array_equal(result.contact, reference.contact)
    assert np.allclose(result.pressure / modulus, reference.pressure, rtol=1e-6)
    assert result.record.iterations == reference.record.iterations


def test_neither_modulus_nor_height_scale_changes_the_area_at_equal_reduced_pressure():
    heights = rough(1024)
    areas = [
        contactsim.press(scale * heights, spacing=1.0, contact_modulus=e, mean_pressure=0.02 * scale * e).contact
        for scale in (1.0, 3.0)
        for e in (1.0, 70.0)
    ]
    assert all(np.array_equal(area, areas[0]) for area in areas)


@pytest.mark.parametrize("name", ALL)
def test_zero_load_touches_without_iterating(name):
    heights = rough(128)
    result = press(heights, 0.0, name)
    assert_right(result)
    assert result.record.iterations == 0
    assert not result.contact.any()
    assert result.gap.min() == pytest.approx(0, abs=1e-12)
    assert result.approach == pytest.approx(-heights.max())


@pytest.mark.parametrize("name", ALL)
def test_tension_is_refused(name):
    with pytest.raises(SceneError, match="nothing can pull") as caught:
        press(rough(64), -1e-3, name)
    assert (caught.value.key, caught.value.value) == ("mean_pressure", -1e-3)


@pytest.mark.parametrize("pressure", [1.0, 3.0, 30.0])
def test_heavy_loads_come_to_full_contact(pressure):
    heights = rough(1024, 0.2)
    result = press(heights, pressure, tolerance=1e-6)
    assert_right(result, 1e-6)
    full = analytic.complete_contact(heights, 1024.0, 1.0)
    assert result.contact.all() == (pressure > -full.min())


@pytest.mark.parametrize("severity", [0, 25, 50, 75, 100])
def test_near_full_contact_opens_point_by_point(severity):
    heights = rough(2048)
    full = analytic.complete_contact(heights, 2048.0, 1.0)
    result = press(heights, -full.min() * (1 - 10 ** (-1 - severity / 20)), tolerance=1e-6)
    assert_right(result, 1e-6)
    assert 0 < (~result.contact).sum() < 400


@pytest.mark.parametrize("name", FAST)
def test_equal_highest_points_share_the_load(name):
    heights = np.tile([0.0, 1.0, 0.0, -1.0], 16)
    result = press(heights, 1e-3, name, tolerance=1e-8)
    assert_right(result, 1e-8)
    assert np.allclose(result.pressure[1::4], 4e-3, rtol=1e-5)


@pytest.mark.parametrize("name", FAST)
def test_a_mirrored_or_shifted_profile_has_the_mirrored_or_shifted_answer(name):
    heights = rough(510)
    reference = press(heights, 0.02, name, tolerance=1e-7)
    for change in (lambda field: field[::-1], lambda field: np.roll(field, 123)):
        result = press(np.ascontiguousarray(change(heights)), 0.02, name, tolerance=1e-7)
        assert np.array_equal(result.contact, change(reference.contact))
        assert np.allclose(result.pressure, change(reference.pressure), rtol=0, atol=1e-5 * reference.pressure.max())


def test_the_area_is_the_same_from_every_depth_of_the_cascade_and_with_two_threads():
    heights = rough(4096)
    reference = press(heights, 0.02)
    for threads in (1, 2):
        assert np.array_equal(press(heights, 0.02, threads=threads).contact, reference.contact)
    for coarsest in (64, 1024, 1 << 20):
        method = contactsim.solvers.solver("active_set", coarsest=coarsest)
        assert np.array_equal(press(heights, 0.02, method).contact, reference.contact)


def test_a_tolerance_below_rounding_ends_as_an_honest_failure():
    result = press(rough(256), 0.05, tolerance=1e-18)
    assert result.status is Status.BUDGET
    assert np.isfinite(result.pressure).all()
    assert result.record.certificate.non_uniformity < 1e-9


heights_strategy = st.integers(2, 200).flatmap(
    lambda n: st.lists(st.floats(-1e6, 1e6, allow_nan=False, allow_subnormal=False), min_size=n, max_size=n)
)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(heights_strategy, st.floats(-6, 2))
def test_any_heights_under_any_load_are_solved_and_certified(values, exponent):
    heights = np.array(values)
    step = np.sqrt(np.mean(np.diff(heights, append=heights[0]) ** 2)) or 1.0
    result = press(heights, 10**exponent * step)
    assert_right(result)
    assert result.mean_pressure == pytest.approx(10**exponent * step, rel=1e-9)


def test_a_wave_on_a_very_long_line_keeps_its_area():
    result = press(wave(2**18), 0.3 * analytic.full_contact_pressure(1.0, 2**18, 1.0))
    assert_right(result)
    assert abs(result.relative_contact_area - analytic.sinusoid_area(0.3)) <= 1.5 / 2**18
