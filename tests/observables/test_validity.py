"""What is beyond what a model describes is computed, flagged state by state, logged and told by figures."""

from __future__ import annotations

import logging

import numpy as np
import pytest
import xarray as xr

from contactsim import status
from contactsim.contact.loading import approaches
from contactsim.dataset import describe
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.simulation import simulate
from contactsim.surfaces.shapes import Sinusoid
from support.smooth import LENGTH, along, scene_of


def flagged(data, name):
    return (data.validity_flags.values & status.FLAGS[name]) > 0


def test_the_process_zone_is_that_of_the_specification():
    law = NormalCohesiveZone(2.0, 1.5)
    assert status.process_zone(77.0, law.strength, law.interaction_range) == pytest.approx(
        np.e**2 * 77.0 * 1.5**2 / 2.0
    )


def test_every_limit_has_its_bit_and_missing_numbers_are_within():
    assert sorted(status.FLAGS.values()) == [1, 2, 4, 8]
    assert status.validity_flags({}) == 0
    for name, (limit, _) in status.LIMITS.items():
        assert status.validity_flags({name: limit}) == 0
        assert status.validity_flags({name: 1.01 * limit}) == status.FLAGS[name]


def test_overlap_is_flagged_from_where_it_is_too_deep(caplog):
    with caplog.at_level(logging.WARNING, "contactsim.paths.record"):
        data = simulate(scene_of(NormalCohesiveZone(0.002), along(-1, 20, 1.0)), points=128, tolerance=1e-6)
    deep = flagged(data, "max_interpenetration")
    assert np.array_equal(deep, data.max_interpenetration > 3)
    assert 0 < deep.sum() < deep.size
    assert not flagged(data, "process_zone_step").any()
    assert "overlap over the laws' length up to" in caplog.text


def test_slip_of_a_frictionless_contact_of_a_compressible_body_is_flagged():
    data = simulate(scene_of(CohesiveZone(2.0, 0.0, 1.0, 0.3), along(-8, 10, 1.0)), points=256, tolerance=1e-6)
    assert np.array_equal(flagged(data, "slip"), data.slip > 2)
    assert flagged(data, "slip").any()


def test_a_grid_too_coarse_for_the_process_zone_is_flagged_and_one_fine_enough_is_not():
    law = NormalCohesiveZone(2.0)
    zone = status.process_zone(scene_of(law).contact_modulus, law.strength, law.interaction_range)
    for points in (64, 128, 256, 512):
        data = simulate(scene_of(law, approaches([-8.0])), points=points, tolerance=1e-6)
        assert flagged(data, "process_zone_step").all() == (LENGTH / points > 0.2 * zone)
        assert float(data.process_zone_step[0]) == pytest.approx(LENGTH / points / zone)


@pytest.mark.parametrize("amplitude", [20.0, 40.0])
def test_slopes_that_are_not_small_are_flagged(amplitude):
    wave = Sinusoid(length=300.0, amplitude=amplitude)
    law = NormalCohesiveZone(0.5)
    data = simulate(scene_of(law, approaches([-amplitude - 2.0]), surface=wave), points=256, tolerance=1e-6)
    rms = 2 * np.pi * amplitude / 300.0 / np.sqrt(2)
    assert flagged(data, "rms_gradient").all() == (rms > 0.45)


def test_exceeded_limits_are_reported_in_words_even_where_states_are_missing():
    numbers = {"max_interpenetration": [1.0, 4.0, np.nan, 5.0], "validity_flags": [0, 1, np.nan, 1]}
    data = describe(xr.Dataset({name: ("step", values) for name, values in numbers.items()}))
    assert status.describe_excess(data) == ["overlap over the laws' length up to 5 (limit 3) in 50 %"]
    assert list(data.validity_flags.flag_masks) == [1, 2, 4, 8]
    assert data.validity_flags.flag_meanings == "max_interpenetration slip process_zone_step rms_gradient"
    assert not status.describe_excess(data.isel(step=[0]))
