"""Attraction beside a hard wall: numbers, derivatives, energy; and the push of the wall itself."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.interface.attraction import DugdaleAttraction, ExponentialAttraction
from contactsim.interface.wall_pressure import WallPressure
from support.cases import refused

LAWS = (
    ExponentialAttraction(0.7, 2.0),
    ExponentialAttraction(1e-3, 0.1),
    DugdaleAttraction(0.7, 2.0),
    DugdaleAttraction(0.05, 0.4, ramp=1.0),
)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_the_work_of_separation_is_that_of_the_traction_and_of_the_energy(law):
    gap = np.linspace(0.0, 60.0 * law.normal_length, 600001)
    assert np.trapezoid(law.traction(gap[None])[0], gap) == pytest.approx(law.work_of_separation, rel=1e-6)
    assert law.energy(np.zeros((1, 1)))[0] == pytest.approx(-law.work_of_separation, rel=1e-12)
    assert abs(law.energy(np.array([[800.0 * law.normal_length]]))[0]) <= 1e-15


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_tangent_and_energy_belong_to_the_traction(law):
    step = 1e-6 * law.normal_length
    gap = np.linspace(-2.0, 5.0, 700)[None] * law.normal_length + 3 * step
    traction, tangent = law.tangent(gap)
    assert np.array_equal(traction, law.traction(gap))
    slope = (law.traction(gap + step) - law.traction(gap - step)) / (2 * step)
    assert (np.abs(slope - tangent[0]) <= 1e-4 * law.stiffness).all()
    force = (law.energy(gap + step) - law.energy(gap - step)) / (2 * step)
    assert (np.abs(force - traction[0]) <= 1e-6 * law.strength).all()


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_strength_and_stiffness_are_the_largest_traction_and_tangent(law):
    traction, tangent = law.tangent(np.linspace(0.0, 10.0 * law.normal_length, 100001)[None])
    assert traction.max() == pytest.approx(law.strength, rel=1e-6)
    assert np.abs(tangent).max() == pytest.approx(law.stiffness, rel=1e-3)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_under_overlap_the_attraction_is_that_of_contact(law):
    traction, tangent = law.tangent(np.array([[-1e-9, -1.0, -1e9]]))
    assert traction == pytest.approx(np.full((1, 3), law.strength), rel=1e-12)
    assert not tangent.any()


@pytest.mark.parametrize("law", [ExponentialAttraction, DugdaleAttraction])
@pytest.mark.parametrize("value", [0, -1.0, float("nan"), float("inf"), "2", None])
def test_works_and_lengths_that_are_not_positive_are_refused(law, value):
    with refused("work_of_separation", "positive"):
        law(value)
    with refused("normal_length", "positive"):
        law(1.0, value)


@pytest.mark.parametrize("ramp", [0, -0.1, 1.01, float("nan"), "0.2"])
def test_a_ramp_that_is_none_or_wider_than_the_length_is_refused(ramp):
    with refused("ramp", "at most 1"):
        DugdaleAttraction(1.0, 1.0, ramp)


def test_the_push_of_a_wall_is_the_derivative_of_its_energy_and_never_a_pull():
    wall = WallPressure(np.full(801, 0.3), 2.0, 2.0)
    gap, step = np.linspace(-1.0, 1.0, 801), 1e-6
    slope = (wall.energy(gap + step) - wall.energy(gap - step)) / (2 * step)
    assert -slope == pytest.approx(wall.push(gap), abs=1e-6)  # the push has a kink
    assert (wall.push(gap) >= 0).all() and not wall.push(np.full(801, 0.16)).any()


def test_a_correction_leaves_the_pressure_of_points_whose_gap_is_zero():
    wall = WallPressure(np.array([0.0, 0.5, 0.5, 0.5]), 2.0, 2.0)
    gap = np.array([0.0, 0.0, 0.1, -0.1])
    assert wall.corrected(gap).values == pytest.approx([0.0, 0.5, 0.3, 0.7])
    assert wall.corrected(gap, 4.0).stiffness == 8.0
    assert wall.largest_gap(gap) == pytest.approx(0.1)
    assert wall.largest_gap(np.array([3.0, 0.0, 0.3, 0.0])) == 0.0
