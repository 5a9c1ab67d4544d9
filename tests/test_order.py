"""Observed orders of convergence."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim
from cases import FAST, press, wave
from contactsim import analytic


def orders(errors):
    return np.log2(np.divide(errors[:-1], errors[1:]))


@pytest.mark.parametrize("name", FAST)
def test_mean_gap_of_a_wave_converges_at_second_order(name):
    # p/p_c = 1/2 puts the edges of the contact halfway between points on each of these grids
    errors = []
    for points in (64, 128, 256, 512, 1024):
        mean = 0.5 * analytic.full_contact_pressure(1.0, points, 1.0)
        result = press(wave(points), mean, name, tolerance=1e-8)
        errors.append(abs(result.gap.mean() - analytic.sinusoid_mean_gap(0.5, 1.0)))
    assert orders(errors) == pytest.approx([2, 2, 2, 2], abs=0.1)


def test_cylinder_area_converges_at_first_order():
    worst = []
    radius, length = 1.0, 64.0
    for points in (2**12, 2**14, 2**16):
        x = np.arange(points) * length / points - length / 2
        errors = []
        for half_width in np.linspace(0.5, 0.9, 13):
            load = analytic.cylinder_load(half_width, radius, 1.0)
            result = contactsim.press(
                -(x**2) / (2 * radius), spacing=length / points, contact_modulus=1.0, mean_pressure=load / length
            )
            errors.append(abs(result.relative_contact_area * length / 2 - half_width))
        worst.append(max(errors))
    assert worst[0] <= 64.0 / 2**12  # half a point at each edge, and the neighbours 64 radii apart
    assert np.log2(worst[0] / worst[1]) / 2 == pytest.approx(1, abs=0.35)


def test_a_tighter_tolerance_brings_the_pressure_closer_at_the_same_rate():
    heights = wave(512) + 0.3 * np.cos(2 * np.pi * 7 * np.arange(512) / 512)
    exact = press(heights, 0.002, tolerance=1e-10).pressure
    errors = [
        np.abs(press(heights, 0.002, tolerance=tolerance).pressure - exact).max() / exact.max()
        for tolerance in (1e-2, 1e-4, 1e-6)
    ]
    assert errors[1] < 0.05 * errors[0] + 1e-12
    assert errors[2] < 0.05 * errors[1] + 1e-12
