"""The contact of an adhesive cylinder under a tangential force, by the energy released at its edges."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.reference import adhesion, hard_wall

WORK, RADIUS, MODULUS = 2.0, 25000.0, 87.77
PULL_OFF = float(adhesion.cylinder_pull_off(WORK, RADIUS, MODULUS))


@pytest.mark.parametrize("load", [-0.5 * PULL_OFF, 0.0, 400.0])
@pytest.mark.parametrize("force", [0.0, 50.0, 150.0])
def test_the_energy_released_by_both_modes_is_the_work(load, force):
    half_width = adhesion.sheared_half_width(load, force, WORK, RADIUS, MODULUS)
    normal = hard_wall.cylinder_load(half_width, RADIUS, MODULUS) - load
    released = (normal**2 + force**2) / (2 * np.pi * half_width * MODULUS)
    assert released == pytest.approx(WORK, rel=1e-9)


def test_without_a_tangential_force_the_contact_is_lost_at_the_pull_off():
    beside = adhesion.sheared_half_width(np.array([-1 + 1e-6, -1 - 1e-6]) * PULL_OFF, 0.0, WORK, RADIUS, MODULUS)
    assert beside[0] ** 3 == pytest.approx(2 * WORK * RADIUS**2 / (np.pi * MODULUS), rel=0.01)
    assert np.isnan(beside[1])


def test_a_tangential_force_peels_until_the_contact_is_lost():
    forces = np.linspace(0.0, 2000.0, 401)
    sizes = adhesion.sheared_half_width(0.0, forces, WORK, RADIUS, MODULUS)
    exists = np.isfinite(sizes)
    assert exists[0] and not exists[-1]
    assert np.all(np.diff(exists.astype(int)) <= 0)
    assert np.all(np.diff(sizes[exists]) < 0)


def test_without_adhesion_it_is_hertz():
    half_width = adhesion.sheared_half_width(100.0, 0.0, 0.0, RADIUS, MODULUS)
    assert hard_wall.cylinder_load(half_width, RADIUS, MODULUS) == pytest.approx(100.0, rel=1e-6)
