"""Repulsion by itself and of its own stiffness: numbers, derivatives, energy, the limits of both laws."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.interface.cohesive_zone import NormalCohesiveZone
from contactsim.interface.exponentials import MAX_OVERLAP
from contactsim.interface.repulsion import RepulsiveZone, StiffCohesiveZone
from support.cases import refusal

WHOLE = NormalCohesiveZone(0.7, 2.0)
LAWS = (RepulsiveZone(0.7, 2.0), StiffCohesiveZone(0.7, 3.0, 2.0), StiffCohesiveZone(10.5, 0.2))
OVERLAPS = -np.linspace(1e-3, 1.5 * MAX_OVERLAP, 301)[None]
OPENINGS = np.linspace(0.0, 12.0, 301)[None]


def test_repulsion_alone_is_the_law_under_overlap_and_nothing_else():
    law = RepulsiveZone(0.7, 2.0)
    assert np.array_equal(law.traction(2.0 * OVERLAPS), WHOLE.traction(2.0 * OVERLAPS))
    assert not law.traction(OPENINGS).any() and not law.tangent(OPENINGS)[1].any() and not law.energy(OPENINGS).any()
    assert law.traction(np.array([[-2.0]]))[0, 0] == pytest.approx(-0.35 * np.e, rel=1e-15)
    assert (law.strength, law.stiffness) == (WHOLE.strength, WHOLE.stiffness)


def test_the_stiff_law_pulls_as_the_cohesive_zone_and_repels_with_its_own_stiffness():
    law = StiffCohesiveZone(0.7, 3.0, 2.0)
    assert np.array_equal(law.traction(OPENINGS), WHOLE.traction(OPENINGS))
    assert law.traction(np.array([[-2.0]]))[0, 0] == pytest.approx(-3.0 * 2.0 * np.e, rel=1e-15)
    assert law.tangent(np.array([[-1e-9]]))[1][0, 0, 0] == pytest.approx(3.0, rel=1e-8)
    assert law.traction(np.array([[-1e-12, 0.0, 1e-12]]))[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-11)
    assert law.energy(np.zeros((1, 1)))[0] == -0.7


def test_the_stiff_law_is_the_cohesive_zone_at_that_laws_stiffness():
    law = StiffCohesiveZone(0.7, WHOLE.stiffness, 2.0)
    for gap in (2.0 * OVERLAPS, OPENINGS):
        assert np.allclose(law.traction(gap), WHOLE.traction(gap), rtol=1e-14, atol=0)
        assert np.allclose(law.tangent(gap)[1], WHOLE.tangent(gap)[1], rtol=1e-14, atol=0)
        assert np.allclose(law.energy(gap), WHOLE.energy(gap), rtol=1e-13, atol=1e-14)


def test_without_adhesion_the_stiff_law_is_repulsion_alone_however_weak_its_pull_was():
    weak, wall = StiffCohesiveZone(1e-30, 3.0, 2.0), RepulsiveZone(12.0, 2.0)
    assert np.array_equal(weak.traction(OVERLAPS), wall.traction(OVERLAPS))
    assert (np.abs(weak.traction(OPENINGS)) < 1e-30).all()


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_tangent_and_energy_belong_to_the_traction(law):
    step = 1e-5
    for gap in (law.normal_length * OVERLAPS, OPENINGS + 2 * step):
        traction, tangent = law.tangent(gap)
        assert np.array_equal(traction, law.traction(gap))
        size = np.abs(tangent[0, 0]) + np.abs(traction[0]) + law.stiffness
        slope = (law.traction(gap + step) - law.traction(gap - step)) / (2 * step)
        assert (np.abs(slope - tangent[0])[0] <= 1e-6 * size).all()
        force = (law.energy(gap + step) - law.energy(gap - step)) / (2 * step)
        assert (np.abs(force - traction[0]) <= 1e-5 * (size + np.abs(law.energy(gap)))).all()


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_the_energy_is_continuous_at_zero_gap_and_zero_far_away(law):
    below, at, above = law.energy(np.array([[-1e-9, 0.0, 1e-9]]))
    assert [below, above] == pytest.approx([at, at], abs=1e-12)
    assert law.energy(np.array([[800.0 * law.normal_length]]))[0] == 0


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_beyond_the_largest_overlap_traction_grows_in_proportion(law):
    far = law.traction(-law.normal_length * np.array([[1.0, 2.0, 3.0]]) * 10 * MAX_OVERLAP)[0]
    assert far[2] - far[1] == pytest.approx(far[1] - far[0], rel=1e-12)
    assert (np.isfinite(far) & (far < 0)).all()


@pytest.mark.parametrize("name", ["work_of_separation", "contact_stiffness", "normal_length"])
@pytest.mark.parametrize("value", [0, -1.0, float("nan"), "2"])
def test_works_stiffnesses_and_lengths_that_are_not_positive_are_refused(name, value):
    options = {"work_of_separation": 2.0, "contact_stiffness": 1.0, "normal_length": 1.0} | {name: value}

    def read():
        try:
            StiffCohesiveZone(**options)
        except ValueError as error:
            raise error.located("scene.yaml") from None

    assert "positive" in refusal(name, "scene.yaml", read).allowed
