"""What is beyond what a model describes is computed, flagged state by state, logged and told by figures."""

from __future__ import annotations

import logging

import numpy as np
import pytest
import xarray as xr

import contactsim as cs
from contactsim import status
from contactsim.contact.loading import approaches
from contactsim.dataset import describe
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.simulation import simulate
from contactsim.surfaces.shapes import Sinusoid
from support.cases import refused
from support.smooth import LENGTH, along, scene_of


def flagged(data, name):
    return (data.validity_flags.values & status.FLAGS[name]) > 0


def test_the_process_zone_is_that_of_the_specification():
    law = NormalCohesiveZone(2.0, 1.5)
    assert status.process_zone(77.0, law.strength, law.interaction_range) == pytest.approx(
        np.e**2 * 77.0 * 1.5**2 / 2.0
    )


def test_every_limit_has_its_bit_and_missing_numbers_are_within():
    assert sorted(status.FLAGS.values()) == [1, 2, 4, 8, 16, 32]
    assert status.validity_flags({}) == 0
    for name, (limit, _) in status.LIMITS.items():
        assert status.validity_flags({name: limit}) == 0
        assert status.validity_flags({name: 1.01 * limit + 1e-9}) == status.FLAGS[name]


def test_overlap_is_flagged_from_where_it_is_too_deep(caplog):
    with caplog.at_level(logging.WARNING, "contactsim.status"):
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


def test_exceeded_limits_of_solved_states_are_reported_in_words():
    numbers = {"max_interpenetration": [1.0, 4.0, np.nan, 5.0, 9.0], "validity_flags": [0, 1, np.nan, 1, 1]}
    solved, failed = (state.value[0] for state in (status.Status.CONVERGED, status.Status.NO_EQUILIBRIUM))
    numbers["status"] = [solved, solved, solved, solved, failed]
    data = describe(xr.Dataset({name: ("step", values) for name, values in numbers.items()}))
    assert status.describe_excess(data) == ["overlap over the laws' length up to 5 (limit 3) in 50 %"]
    assert list(data.validity_flags.flag_masks) == [1, 2, 4, 8, 16, 32]
    assert data.validity_flags.flag_meanings == " ".join(status.LIMITS)
    assert not status.describe_excess(data.isel(step=[0]))


def wall_scene(surface, hardness=None):
    """Return a surface against a hard wall under two loads."""
    return cs.Scene(cs.HalfSpace(1.0), surface, cs.HardWall(hardness=hardness), cs.pressures([0.001, 0.05]))


def test_at_a_hard_wall_steep_slopes_coarse_waves_and_yielding_are_flagged():
    rough = {"length": 64.0, "hurst_exponent": 0.8, "long_cutoff": 32.0, "short_cutoff": 8.0, "seed": 1}
    gentle = cs.simulate(wall_scene(cs.SelfAffine(rms_gradient=0.1, **rough)), points=64)
    assert not gentle.validity_flags.values.any()
    assert "yielding_share" not in gentle
    steep = cs.simulate(wall_scene(cs.SelfAffine(rms_gradient=0.5, **rough)), points=64)
    assert flagged(steep, "rms_gradient").all()
    coarse = cs.simulate(wall_scene(cs.SelfAffine(rms_gradient=0.1, **rough)), points=24)
    assert flagged(coarse, "wave_step").all()
    assert coarse.wave_step.values == pytest.approx(7 / 24)  # the shortest of the waves has a seventh of the length


def test_yielding_is_the_share_of_the_contact_above_the_hardness():
    data = cs.simulate(wall_scene(Sinusoid(64.0, 1.0), hardness=0.05), points=256, keep=["contact", "pressure"])
    ends = np.cumsum(data.contact_points.values)
    for step, (begin, end) in enumerate(zip([0, ends[0]], ends, strict=True)):
        share = float((data.contact_pressure.values[begin:end] > 0.05).mean())
        assert data.yielding_share.values[step] == share
        assert flagged(data, "yielding_share")[step] == (share > 0)
    assert data.yielding_share.values[0] < data.yielding_share.values[1]
    for hardness in (0.0, -1.0, np.nan, "hard"):
        with refused("hardness", "positive"):
            cs.HardWall(hardness=hardness)


def test_fields_stand_at_their_places():
    data = cs.simulate(wall_scene(cs.Sphere(radius=10.0, length=8.0)), points=16, keep=["fields"])
    assert list(data.x.values) == list(data.y.values) == [0.5 * place for place in range(16)]
    assert data.x.attrs["units"] == "nm"
    assert data.pressure.dims == ("step", "y", "x")
