"""How closely a surface follows the long and the short waves of a profile, on made profiles."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.observables.conformity import conformities, first_short_mode

PLACES = 2 * np.pi * np.arange(64) / 64


def waves(field: np.ndarray) -> np.ndarray:
    """Fourier coefficients of a field."""
    return np.fft.rfft(field) / field.size


@pytest.mark.parametrize(("height", "first"), [(0.1, 2), (0.3, 8)])
def test_half_of_the_mean_square_gradient_tells_short_waves_from_long_ones(height: float, first: int):
    # squares of the slopes of the three waves: 1, 1 and 64 height²
    heights = np.cos(PLACES) + np.cos(2 * PLACES + 1) / 2 + height * np.cos(8 * PLACES)
    assert first_short_mode(waves(heights - 3.0)) == first


def test_each_wave_is_followed_as_far_as_it_is_absent_from_the_gap():
    shape = 5.0 + 3 * np.cos(2 * PLACES) + np.sin(9 * PLACES)
    gap = 1.0 + 0.6 * np.cos(2 * PLACES + 1) + 0.9 * np.sin(9 * PLACES)
    found = conformities(waves(shape), waves(gap), first_short=9)
    assert found["conformity_long"] == pytest.approx(0.8)
    assert found["conformity_short"] == pytest.approx(0.1)
    undeformed = conformities(waves(shape), waves(shape - 2.0), 9)
    assert undeformed == pytest.approx({"conformity_long": 0.0, "conformity_short": 0.0}, abs=1e-12)


def test_a_flat_profile_has_no_waves_to_follow():
    flat = waves(np.zeros(16))
    assert all(np.isnan(value) for value in conformities(flat, flat + 1.0, first_short_mode(flat)).values())
