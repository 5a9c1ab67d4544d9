"""Distance of heights from a Gaussian."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ndtr, ndtri
from scipy.stats import kstest

from contactsim import dataset
from contactsim.analysis.height_distribution import gaussian_distance


def test_heights_at_the_quantiles_of_a_gaussian_have_the_smallest_distance():
    heights = ndtri((np.arange(4001) + 0.5) / 4001)
    assert gaussian_distance(np.random.default_rng(0).permutation(heights)) == pytest.approx(0.5 / 4001, abs=1e-4)
    assert gaussian_distance(-3 + 7 * heights) == pytest.approx(
        gaussian_distance(heights), rel=1e-9
    )  # own mean and rms


def test_one_wave_is_as_far_from_a_gaussian_as_theory_says():
    heights = np.cos(2 * np.pi * (np.arange(20000) + 0.5) / 20000)
    angles = np.linspace(0, np.pi, 200001)  # of a wave of amplitude √2 rms heights: F(h) = 1 - arccos(h/√2)/π
    exact = abs(1 - angles / np.pi - ndtr(np.sqrt(2) * np.cos(angles))).max()
    assert gaussian_distance(heights) == pytest.approx(exact, abs=1e-4)


@pytest.mark.parametrize("sign", [1, -1])
def test_skewed_heights_have_the_distance_that_another_code_finds(sign):
    heights = sign * np.random.default_rng(1).exponential(size=50)
    standard = (heights - heights.mean()) / heights.std()
    assert gaussian_distance(heights) == pytest.approx(kstest(standard, "norm").statistic, rel=1e-12)


def test_two_heights_are_far_from_a_gaussian():
    assert gaussian_distance(np.array([[0.0, 1.0], [1.0, 0.0]])) == pytest.approx(0.5 - 0.158655, abs=1e-5)


def test_a_study_that_varies_the_roll_off_has_the_distance_of_each_profile(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_line_heights.nc")
    assert set(data.height_distance.dims) == {"long_cutoff", "hurst_exponent", "member"}
    assert ((data.height_distance > 0) & (data.height_distance < 0.3)).all()
    other = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    assert "height_distance" not in other
