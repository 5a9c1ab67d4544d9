"""Equilibria of smooth laws: methods of different kinds that agree."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.contact.loading import approaches
from support.smooth import LAWS, scene_of, walk

PATH = approaches([-2.0, 0.0, 2.0, -2.0, -4.0])


@pytest.mark.parametrize("name", LAWS)
def test_newtons_method_and_damped_dynamics_find_the_same_states(name):
    scene = scene_of(LAWS[name], PATH)
    newton, verlet = (walk(scene, 128, method, tolerance=1e-6) for method in ("newton", "mass_weighted_verlet"))
    for count in range(len(PATH.steps)):
        assert np.abs(newton.gap(count) - verlet.gap(count)).max() < 1e-4  # 1e-4 of the laws' length


def test_the_thesis_scheme_and_energy_minimisation_find_the_states_of_newtons_method():
    scene = scene_of(LAWS["uncoupled"], approaches([0.0, 2.0]))
    newton = walk(scene, 64, tolerance=1e-4)
    for method in ("damped_verlet", "energy_minimisation"):
        other = walk(scene, 64, method, tolerance=1e-4)
        assert other.load == pytest.approx(newton.load, rel=1e-3)
        assert np.abs(other.gap() - newton.gap()).max() < 1e-3
