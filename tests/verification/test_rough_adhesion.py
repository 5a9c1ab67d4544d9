"""The criterion of Pastewka and Robbins as they print it, and what it says of known cases."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.reference.rough_adhesion import attraction_over_repulsion, sticking_work


def test_the_criterion_is_the_printed_one():
    """Their surfaces stick if (ḡ r)/(κ ℓ) (ḡ d/(4 r))^(2/3) < π (3/16)^(2/3), with ℓ = w/E* and d = 4ḡ/c."""
    rng = np.random.default_rng(0)
    for work, reach, modulus, gradient, curvature in np.exp(rng.normal(0, 1, (20, 5))):
        diameter, length = 4 * gradient / curvature, work / modulus
        left = gradient * reach / (2 * length) * (gradient * diameter / (4 * reach)) ** (2 / 3)
        right = np.pi * (3 / 16) ** (2 / 3)
        assert attraction_over_repulsion(work, reach, modulus, gradient, curvature) == pytest.approx(right / left)


def test_surfaces_stick_from_the_sticking_work_on():
    work = sticking_work(2.7, 1.0, 0.13, 0.02)
    assert attraction_over_repulsion(work, 2.7, 1.0, 0.13, 0.02) == pytest.approx(1)
    assert sticking_work(2.7, 1.0, 0.26, 0.02) > work  # steeper surfaces stick less
    assert sticking_work(2.7, 2.0, 0.13, 0.02) == pytest.approx(2 * work)  # and stiffer ones


def test_the_gap_beside_a_patch_is_that_of_a_cylinder():
    """Outside a contact 2a wide the gap of a cylinder of radius R opens with √(x² - a²)/R."""
    half, radius = 1.0, 50.0
    x = np.linspace(0, 1e-3, 2001)
    slope = np.sqrt((half + x) ** 2 - half**2) / radius
    gap = float(np.sum((slope[1:] + slope[:-1]) / 2 * np.diff(x)))
    diameter = 2 * half
    gradient = diameter / (2 * radius)  # with which 4ḡ/3 √(x³/d) is this gap near the edge
    assert gap == pytest.approx(4 / 3 * gradient * np.sqrt(x[-1] ** 3 / diameter), rel=1e-3)
