"""Repulsion of its own stiffness with friction: its parts, its tangent, and its limit without adhesion."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.errors import InputError
from contactsim.interface.cohesive_zone import CohesiveZone
from contactsim.interface.frictional_repulsion import FrictionalRepulsiveZone, StiffMixedZone
from contactsim.interface.repulsion import RepulsiveZone, StiffCohesiveZone

LAWS = (FrictionalRepulsiveZone(0.7, 0.4, 2.0, 3.0), StiffMixedZone(0.7, 3.0, 0.5, 2.0, 3.0), StiffMixedZone(0.7, 3.0))


def test_friction_leaves_the_repulsion_as_it_is_and_is_at_most_a_part_of_the_pressure():
    law, wall = FrictionalRepulsiveZone(0.7, 0.4, 2.0, 3.0), RepulsiveZone(0.7, 2.0)
    normal, tangential = np.meshgrid(np.linspace(-4, 12, 41), np.linspace(-9, 9, 2001))
    gap = np.stack((normal.ravel(), tangential.ravel()))
    traction = law.traction(gap)
    assert np.array_equal(traction[0], wall.traction(gap[:1])[0])
    assert not traction[1, gap[0] >= 0].any()
    assert (np.sign(traction[1]) == np.sign(gap[1]) * (gap[0] < 0)).all()
    deep = gap[0] == -4.0
    assert traction[1, deep].max() == pytest.approx(-0.4 * traction[0, deep][0], rel=1e-5)
    assert (law.without_slip(), law.without_friction(), law.without_coupling()) == (wall, wall, law)


def test_the_stiff_mixed_law_is_eq_2_17_but_for_its_wall():
    law, whole, wall = (
        StiffMixedZone(0.7, 3.0, 0.5, 2.0, 3.0),
        CohesiveZone(0.7, 0.5, 2.0, 3.0),
        RepulsiveZone(12.0, 2.0),
    )
    normal, tangential = np.meshgrid(np.linspace(-4, 12, 41), np.linspace(-7, 7, 41))
    gap = np.stack((normal.ravel(), tangential.ravel()))
    opened = gap[0] >= 0
    assert np.array_equal(law.traction(gap)[1], whole.traction(gap)[1])
    assert np.array_equal(law.traction(gap)[0, opened], whole.traction(gap)[0, opened])
    assert np.array_equal(law.traction(gap)[0, ~opened], wall.traction(gap[:1])[0, ~opened])
    weak = StiffMixedZone(1e-30, 3.0, 1.0, 2.0, 3.0).traction(gap)
    assert np.allclose(weak, [wall.traction(gap[:1])[0], np.zeros(normal.size)], atol=1e-28)


def test_what_is_left_out_of_the_stiff_mixed_law():
    law = StiffMixedZone(0.7, 3.0, 0.5, 2.0, 3.0)
    assert law.without_slip() == StiffCohesiveZone(0.7, 3.0, 2.0)
    assert law.without_friction() == StiffMixedZone(0.7, 3.0, 0.0, 2.0, 3.0)
    assert law.without_friction().without_coupling() == law.without_slip()
    assert law.without_friction().exerts == {"n"}
    with pytest.raises(InputError, match="coupling"):
        law.without_coupling()


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_the_tangent_belongs_to_the_traction(law):
    step = 1e-5
    normal, tangential = np.meshgrid(np.linspace(-4.05, 12, 41), np.linspace(-7, 7, 41))
    gap = np.stack((normal.ravel(), tangential.ravel()))
    traction, tangent = law.tangent(gap)
    assert np.array_equal(traction, law.traction(gap))
    for component in range(2):
        shift = step * np.eye(2)[component][:, None]
        slope = (law.traction(gap + shift) - law.traction(gap - shift)) / (2 * step)
        assert np.allclose(slope, tangent[:, component], rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize("options", [(0.7, 0.0, 0.5), (0.7, 3.0, -1.0), (0.0, 3.0, 0.5)])
def test_values_without_meaning_are_refused(options):
    with pytest.raises(InputError, match="positive"):
        StiffMixedZone(*options)
    with pytest.raises(InputError, match="positive"):
        FrictionalRepulsiveZone(0.7, -0.1)


def test_without_a_coefficient_of_friction_there_is_repulsion_alone():
    law, gap = FrictionalRepulsiveZone(0.7, 0.0, 2.0), np.array([[-1.0, 2.0], [0.5, 0.5]])
    assert law.exerts == {"n"}
    assert np.array_equal(law.traction(gap), RepulsiveZone(0.7, 2.0).traction(gap[:1]))
    assert law.tangent(gap)[1].shape == (1, 2, 2)
