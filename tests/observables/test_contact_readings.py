"""Other readings of what contact is and how high the body is, on made paths whose numbers are known by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from contactsim.observables.contact_readings import (
    BY_CRITERION,
    CRITERIA,
    CRITERION_NUMBERS,
    RoughPath,
    numbers_by_criterion,
    summarise_readings,
)
from contactsim.reference.hard_wall import uniaxial_modulus
from support.rough_readings import STEPS, rough_path

PATH = RoughPath(adheres=True, slips=False, uniaxial_modulus=uniaxial_modulus(1.5, 0.3))
SLIPPING = replace(PATH, slips=True)


def test_each_criterion_has_the_numbers_of_its_own_length_and_gradient():
    found = numbers_by_criterion(rough_path())
    for place, criterion in enumerate(CRITERIA):
        assert float(found[f"area_at_12nm_{criterion}"]) == pytest.approx(12 / 60 * (place + 1) / 4)
        assert float(found[f"area_at_load_0_001_{criterion}"]) == pytest.approx(10 / 60 * (place + 1) / 4)
        assert float(found[f"gradient_ratio_at_area_0_02_{criterion}"]) == pytest.approx(0.5)
    assert set(found) == {f"{name}{end}" for name in BY_CRITERION for end in ("", "_increment_error")}


def test_at_a_hard_wall_all_criteria_are_the_same():
    numbers = {f"{name}{end}": float(len(name)) for name in CRITERION_NUMBERS for end in ("", "_increment_error")}
    found = numbers_by_criterion(xr.Dataset(numbers))
    assert {float(found[f"area_at_12nm_{criterion}"]) for criterion in CRITERIA} == {float(len("area_at_12nm"))}


def test_gap_and_peaks_are_read_where_the_load_and_the_approach_are_reached():
    data = summarise_readings(rough_path(), PATH)
    assert float(data.mean_gap_at_load_0_001) == pytest.approx(30.0)
    assert float(data.touching_peaks_at_20nm) == pytest.approx(200.0)
    assert float(data.conformity_at_20nm_long) == pytest.approx(0.5)
    assert float(data.conformity_at_20nm_contrast) == pytest.approx(-0.1)
    assert float(data.gap_at_20nm_long_over_short) == pytest.approx(0.5 / 0.6)
    assert PATH.reading_names <= set(data)


def test_errors_of_long_and_of_short_waves_add_in_squares():
    data, long, short = rough_path().isel(step=slice(0, 30)), 3e-4, 4e-4  # without the last, 20 nm is left out once
    curves = {
        "conformity_long": ("step", long * STEPS[:30] ** 2),
        "conformity_short": ("step", short * STEPS[:30] ** 2),
    }
    found = summarise_readings(data.assign(curves), PATH)
    assert float(found.conformity_at_20nm_long_increment_error) == pytest.approx(long)
    assert float(found.conformity_at_20nm_contrast_increment_error) == pytest.approx(5e-4)
    left = 1 - 400 * long, 1 - 400 * short
    error = left[0] / left[1] * np.hypot(long / left[0], short / left[1])
    assert float(found.gap_at_20nm_long_over_short) == pytest.approx(left[0] / left[1])
    assert float(found.gap_at_20nm_long_over_short_increment_error) == pytest.approx(error)


def test_the_largest_slip_is_that_up_to_twenty_nm_and_unknown_where_the_path_ends_before():
    slips = {"rms_slip": ("step", STEPS / 10), "slipped_share": ("step", 0.8 - abs(STEPS - 10) / 20)}
    data = summarise_readings(rough_path().assign(slips), SLIPPING)
    assert float(data.rms_slip_to_20nm) == pytest.approx(2.0)
    assert float(data.slipped_share_to_20nm) == pytest.approx(0.8)
    short = summarise_readings(rough_path().assign(slips).isel(step=slice(0, 20)), SLIPPING)
    assert np.isnan(float(short.rms_slip_to_20nm))
    assert "rms_slip_to_20nm" not in PATH.reading_names


def test_a_largest_slip_bridges_one_unknown_state_and_no_two():
    slips = {"rms_slip": ("step", STEPS / 10), "slipped_share": ("step", STEPS / 100)}
    for lost, known in ((slice(7, 8), True), (slice(7, 9), False), (slice(23, 30), True)):
        data = rough_path().assign(slips)
        data.status[lost] = 1
        assert np.isfinite(float(summarise_readings(data, SLIPPING).rms_slip_to_20nm)) == known


def test_only_what_a_path_has_is_read():
    wall, anywhere = replace(PATH, adheres=False), replace(PATH, uniaxial_modulus=None)
    assert not any(name.endswith("on_5um") for name in anywhere.reading_names)
    assert "touching_peaks_at_20nm" not in wall.reading_names
    for path in (wall, anywhere):
        data = summarise_readings(rough_path(), path)
        assert path.reading_names <= set(data) and not (PATH.reading_names - path.reading_names) & set(data)
