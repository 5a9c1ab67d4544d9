"""The gap about the pull-off, and how far the surface moves under the asperity and beside it."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.layer import Layer
from contactsim.interface.cohesive_zone import NormalCohesiveZone
from contactsim.observables.deformation import displacement_numbers, gaps_about_pull_off
from contactsim.observables.derived import summarise_paths
from contactsim.simulation import simulate
from contactsim.surfaces.shapes import Cylinder, Flat
from support.smooth import along


def pressed(modulus, ratio=0.3, work=0.5, snapshots=(-1.0,)):
    """The summaries of a cylinder that is pressed on a layer."""
    surface = Cylinder(length=1000.0, radius=2500.0)
    layer = Layer(modulus, ratio, 500.0)
    scene = Scene(Body(Flat.facing(surface), layer), Body(surface), (NormalCohesiveZone(work),), along(-6.0, 2.0, 0.05))
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


def test_without_fields_there_is_no_displacement():
    found = pressed(70.0, snapshots=())
    assert np.isnan([found.peak_displacement, found.far_displacement]).all()
