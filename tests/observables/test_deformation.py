"""The gap about the pull-off, and how far the surface moves under the asperity and beside it."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.layer import Layer
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.observables.deformation import (
    displacement_at_largest_pull,
    displacement_numbers,
    gap_errors_about_pull_off,
    gaps_about_pull_off,
    slip_at_largest_pull,
)
from contactsim.observables.derived import summarise_paths
from contactsim.simulation import simulate
from contactsim.surfaces.shapes import Cylinder, Flat
from support.smooth import along

LAW = NormalCohesiveZone(0.5)


def pressed(modulus, ratio=0.3, law=LAW, snapshots=(-1.0,)):
    """The summaries of a cylinder that is pressed on a layer."""
    surface = Cylinder(length=1000.0, radius=2500.0)
    layer = Layer(modulus, ratio, 500.0)
    scene = Scene(Body(Flat.facing(surface), layer), Body(surface), (law,), along(-6.0, 2.0, 0.05))
    data = simulate(scene, points=128, tolerance=1e-7, snapshots=snapshots)
    return summarise_paths(data)


def test_gaps_are_those_of_the_states_on_both_sides_of_the_largest_pull():
    approach = np.array([-3.0, -2.0, -1.0, 0.0, -1.0, -2.0])
    gap = np.array([3.0, 2.0, 0.5, -0.2, 0.1, 0.2])
    assert gaps_about_pull_off(approach, gap, -2.0) == (2.0, 0.5)
    assert gaps_about_pull_off(approach, gap, -1.5) == (2.0, 0.5)
    assert np.isnan(gaps_about_pull_off(approach, gap, 0.0)).all()
    assert np.isnan(gaps_about_pull_off(approach, gap, np.nan)).all()


def test_rigid_bodies_pull_most_at_half_the_length_of_the_law():
    found = pressed(1e6)
    assert float(found.gap_at_pull_off_loading) == pytest.approx(0.5, abs=0.05)
    assert float(found.gap_after_pull_off_loading) == pytest.approx(0.45, abs=0.05)


def test_the_surface_is_pulled_up_under_the_asperity_and_may_sink_beside_it():
    found = pressed(70.0, ratio=0.49)
    assert float(found.peak_displacement) > 0 > float(found.far_displacement)
    assert float(pressed(70.0, ratio=0.0).far_displacement) > 0


def test_displacements_are_read_from_the_peak_wherever_it_is():
    place = np.arange(16)
    displacement, heights = np.cos(2 * np.pi * place / 16), -(((place + 8) % 16 - 8) ** 2.0)
    for shift in (0, 3, 15):
        largest, far = displacement_numbers(np.roll(displacement, shift), np.roll(heights, shift))
        assert (largest, far) == pytest.approx((1.0, displacement[4:12].mean()))


def test_the_displacement_at_pull_off_is_that_of_the_fields_there():
    place = float(pressed(70.0).pull_off_approach_loading)
    found = pressed(70.0, snapshots=(round(place, 2),))
    assert np.argmax(found.heights.values) == 64
    assert float(found.pull_off_displacement) == pytest.approx(float(found.normal_displacement[0, 64]), rel=1e-9)
    assert abs(float(pressed(1e6).pull_off_displacement)) < 1e-3


def test_slip_is_read_where_the_pull_is_largest():
    traction, slip = np.array([-3.0, 0.5, 1.0, 0.2]), np.array([5.0, 0.1, -0.7, 0.3])
    assert slip_at_largest_pull(traction, slip) == 0.7
    assert np.isnan(slip_at_largest_pull(np.full(4, np.nan), slip))
    free, sticking = (pressed(70.0, law=CohesiveZone(0.5, ratio), snapshots=(2.0,)) for ratio in (0.0, 1.0))
    assert float(free.slip_at_largest_pull) > float(sticking.slip_at_largest_pull) > 0


def test_the_share_of_the_period_in_contact_is_a_length_over_the_period():
    found = pressed(70.0)
    assert float(found.final_contact_share) == pytest.approx(float(found.final_contact_length) / 1000.0)
    assert 0 < float(found.final_contact_share) < 1


def test_without_fields_there_is_no_displacement():
    found = pressed(70.0, snapshots=())
    assert np.isnan([found.peak_displacement, found.far_displacement, found.slip_at_largest_pull]).all()


def test_the_errors_of_gaps_about_a_pull_off_are_their_changes_to_the_states_beyond():
    approach = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    gap = np.array([10.0, 7.0, 5.0, 1.0, 0.5])
    assert gaps_about_pull_off(approach, gap, 2.3) == (5.0, 1.0)
    assert gap_errors_about_pull_off(approach, gap, 2.3) == (2.0, 0.5)
    assert np.isnan(gap_errors_about_pull_off(approach, gap, np.nan)).all()
    assert np.isnan(gap_errors_about_pull_off(approach, gap, 4.0)).all()


def test_the_displacement_at_the_largest_pull_is_read_after_a_jump_and_has_the_change_of_that_branch():
    approach = np.array([-4.0, -3.0, -2.0, -1.0, 0.0])
    gap, load = np.array([3.9, 2.8, 0.5, -0.4, -1.3]), np.array([-0.1, -0.2, -5.0, -4.0, -3.0])
    assert displacement_at_largest_pull(approach, gap, load) == pytest.approx((1.5, 0.1))
    assert np.isnan(displacement_at_largest_pull(approach, gap, np.full(5, np.nan))).all()
    assert np.isnan(displacement_at_largest_pull(approach, gap, -load)).all()
    assert np.isnan(displacement_at_largest_pull(approach[:3], gap[:3], load[:3])).all()
