from __future__ import annotations

import numpy as np
import pytest

from contactsim.surfaces.open_statistics import (
    rms_curvature_open,
    rms_gradient_open,
    rms_gradient_pairs_open,
    squared_gradient_open,
)
from contactsim.surfaces.spectral_moments import nayak_parameter
from contactsim.surfaces.squared_gradient import squared_gradient
from contactsim.surfaces.statistics import (
    rms_curvature,
    rms_gradient,
    rms_gradient_pairs,
    rms_height,
)


def wave(points, mode=3):
    return 2.0 * np.cos(2 * np.pi * mode * np.arange(points) / points)


def test_a_wave_has_the_rms_values_known_by_hand():
    points, length = 4096, 10.0
    q = 2 * np.pi * 3 / length
    heights = wave(points)
    assert rms_height(heights) == pytest.approx(np.sqrt(2), rel=1e-12)
    # differences see q as 2 sin(ql/2)/l: relative change (ql)²/24 ≈ 9e-7, twice that for the curvature
    assert rms_gradient(heights, length / points) == pytest.approx(np.sqrt(2) * q, rel=2e-6)
    assert rms_curvature(heights, length / points) == pytest.approx(np.sqrt(2) * q**2, rel=4e-6)


def test_crossed_waves_have_the_height_of_one_side_and_the_slopes_of_both():
    shape, spacing = (512, 1024), (0.02, 0.03)
    y, x = (2 * np.pi * waves * np.arange(n) / n for waves, n in zip((2, 3), shape, strict=True))
    heights = 5.0 + np.outer(np.cos(y), np.cos(x))
    q = [2 * np.pi * waves / (n * step) for waves, n, step in zip((2, 3), shape, spacing, strict=True)]
    assert rms_height(heights) == pytest.approx(0.5, rel=1e-12)
    assert rms_gradient(heights, spacing) == pytest.approx(np.hypot(*q) / 2, rel=1e-4)
    assert rms_curvature(heights, spacing) == pytest.approx((q[0] ** 2 + q[1] ** 2) / 4, rel=1e-4)


@pytest.mark.parametrize(("modes", "within"), [(None, 1e-3), (3, 1e-13)])
def test_the_squared_gradient_of_crossed_waves_is_that_of_both_directions(modes, within):
    shape, lengths = (512, 768), (10.0, 3.0)
    y, x = (2 * np.pi * waves * np.arange(n) / n for waves, n in zip((2, 3), shape, strict=True))
    heights = np.outer(np.cos(y), np.sin(x))
    q = [2 * np.pi * waves / length for waves, length in zip((2, 3), lengths, strict=True)]
    exact = (q[0] * np.outer(np.sin(y), np.sin(x))) ** 2 + (q[1] * np.outer(np.cos(y), np.cos(x))) ** 2
    np.testing.assert_allclose(squared_gradient(heights, lengths, modes), exact, rtol=0, atol=within * exact.max())


def test_the_gradient_converges_at_second_order():
    errors = [abs(rms_gradient(wave(n), 10.0 / n) - np.sqrt(2) * 2 * np.pi * 0.3) for n in (64, 128, 256)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert orders == pytest.approx([2, 2], abs=0.05)


def test_eq_3_8_counts_a_slope_that_leads_out_of_the_contact_and_pairs_do_not():
    heights = np.array([0.0, 0.0, 1.0, 4.0, 0.0])
    where = np.array([False, True, True, False, False])
    # squared slopes to the right of each point: 0, 1, 9, 16, 0
    assert rms_gradient(heights, 1.0, where) ** 2 == pytest.approx(((0 + 1) / 2 + (1 + 9) / 2) / 2)
    assert rms_gradient_pairs(heights, 1.0, where) == pytest.approx(1.0)


def test_the_last_and_the_first_point_are_neighbours():
    heights = np.array([2.0, 0.0, 0.0, 0.0])
    ends = np.array([True, False, False, True])
    assert rms_gradient_pairs(heights, 1.0, ends) == pytest.approx(2.0)


def test_no_points_give_nan():
    nowhere = np.zeros(4, bool)
    for value in (
        rms_height(np.ones(4), nowhere),
        rms_gradient(np.ones(4), 1.0, nowhere),
        rms_gradient_pairs(np.ones(4), 1.0, nowhere),
        rms_curvature(np.ones(4), 1.0, nowhere),
    ):
        assert np.isnan(value)


@pytest.mark.parametrize("periodic", [True, False])
def test_nayaks_parameter_of_a_wave_is_one(periodic):
    assert nayak_parameter(wave(4096), (10.0 / 4096,), periodic) == pytest.approx(1, rel=1e-3)
    assert np.isnan(nayak_parameter(np.zeros(8), (1.0,), periodic))


@pytest.mark.parametrize(("periodic", "within"), [(True, 1e-12), (False, 0.02)])
def test_nayaks_parameter_of_waves_in_all_directions_is_three_halves_of_that_of_a_profile(periodic, within):
    """Waves of two lengths, each along both axes: m₀ = 2, of the gradient q₁² + q₂², of the curvature q₁⁴ + q₂⁴."""
    points, waves = 512, (2, 5)
    phase = 2 * np.pi * np.arange(points) / points
    profile = sum(np.cos(count * phase) for count in waves)
    heights = profile[:, None] + profile
    exact = 1.5 * 2 * sum(count**4 for count in waves) / sum(count**2 for count in waves) ** 2
    spacing = (10.0 / points, 10.0 / points)
    assert nayak_parameter(heights, spacing, periodic) == pytest.approx(exact, rel=within)


def test_heights_that_do_not_repeat_have_no_slope_across_their_ends():
    """A parabola h = x²/2 + y² on 0 to 4 by 0 to 2."""
    y, x = np.linspace(0, 2, 201)[:, None], np.linspace(0, 4, 401)
    heights, spacing = x**2 / 2 + y**2, (0.01, 0.01)
    everywhere = np.ones(heights.shape, bool)
    exact = np.sqrt(16 / 3 + 4 * 4 / 3)
    assert rms_gradient_open(heights, spacing) == pytest.approx(exact, rel=1e-4)
    assert rms_gradient_open(heights, spacing, everywhere) == pytest.approx(exact, rel=1e-2)
    assert rms_gradient_pairs_open(heights, spacing, everywhere) == rms_gradient_open(heights, spacing)
    assert rms_curvature_open(heights, spacing) == pytest.approx(1.5, rel=1e-9)
    assert np.allclose(squared_gradient_open(heights, spacing), x**2 + (2 * y) ** 2, atol=1e-9)


def test_open_slopes_over_a_part_are_those_of_its_points_and_pairs():
    heights = np.array([0.0, 1.0, 3.0, 3.0])
    where = np.array([True, True, False, True])
    # squared slopes 1, 4, 0; of the points 1, (1+4)/2, (4+0)/2, 0
    assert rms_gradient_open(heights, (1.0,), where) ** 2 == pytest.approx((1 + 2.5 + 0) / 3)
    assert rms_gradient_pairs_open(heights, (1.0,), where) == pytest.approx(1.0)
    assert np.isnan(rms_gradient_open(heights, (1.0,), np.zeros(4, bool)))
    assert np.isnan(rms_gradient_pairs_open(heights, (1.0,), np.array([True, False, False, True])))


def test_inside_they_are_those_of_heights_that_repeat():
    rng = np.random.default_rng(1)
    heights, where = rng.normal(size=(20, 30)), np.zeros((20, 30), bool)
    where[3:-3, 4:-4] = rng.uniform(size=(14, 22)) > 0.5
    spacing = (0.5, 0.2)
    assert rms_gradient_open(heights, spacing, where) == pytest.approx(rms_gradient(heights, spacing, where))
    assert rms_gradient_pairs_open(heights, spacing, where) == pytest.approx(
        rms_gradient_pairs(heights, spacing, where)
    )
