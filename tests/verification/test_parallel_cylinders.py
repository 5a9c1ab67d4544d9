"""Parallel cylinders on a half-space touch as the exact answer says, at every distance from each other."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim
from contactsim.observables.contact import relative_contact_area_subgrid
from contactsim.reference import hard_wall

RADIUS, MODULUS = 1000.0, 2.0
PERIOD = 4 * RADIUS


def half_width_error(points: int, half_width: float) -> float:
    """The relative error of the computed half-width, with edges between points."""
    x = (np.arange(points) - points // 2) * PERIOD / points
    load = hard_wall.cylinder_array_load(half_width, RADIUS, PERIOD, MODULUS)
    state = contactsim.press(
        -(x**2) / (2 * RADIUS),
        spacing=PERIOD / points,
        contact_modulus=MODULUS,
        mean_pressure=float(load) / PERIOD,
        tolerance=1e-8,
    )
    return abs(relative_contact_area_subgrid(state.pressure, state.gap) * PERIOD / 2 / half_width - 1)


@pytest.mark.parametrize("contact_ratio", [0.25, 0.5, 1.0, 1.5])
def test_the_half_width_is_that_of_the_exact_array(contact_ratio):
    assert half_width_error(4096, contact_ratio * RADIUS) < 2e-5
    single = hard_wall.cylinder_load(contact_ratio * RADIUS, RADIUS, MODULUS)
    array = hard_wall.cylinder_array_load(contact_ratio * RADIUS, RADIUS, PERIOD, MODULUS)
    assert array / single - 1 > 100 * 2e-5  # one cylinder alone is a different answer


def test_load_and_half_width_are_inverse():
    half_widths = np.linspace(1.0, 0.49 * PERIOD, 50)
    loads = hard_wall.cylinder_array_load(half_widths, RADIUS, PERIOD, MODULUS)
    assert hard_wall.cylinder_array_half_width(loads, RADIUS, PERIOD, MODULUS) == pytest.approx(half_widths, rel=1e-12)


def test_far_apart_cylinders_are_single_ones_and_neighbours_count_at_second_order():
    ratios = np.array([0.01, 0.02, 0.04])
    single = np.sqrt(4 * RADIUS * hard_wall.cylinder_array_load(ratios * PERIOD, RADIUS, PERIOD, MODULUS)
                     / (np.pi * MODULUS))  # fmt: skip
    excess = single / (ratios * PERIOD) - 1
    assert excess == pytest.approx(np.pi**2 * ratios**2 / 12, rel=0.02)
