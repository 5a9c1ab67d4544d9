"""Curves of area against load as numbers, against what is known by hand; and the energy of a cycle."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from contactsim.observables.hysteresis import dissipated_energy, summarise_cycles
from contactsim.observables.linearity import (
    AREA_LEVELS,
    AREA_LOAD,
    LINE_LOADS,
    area_load_numbers,
    curvature,
    nonlinearity,
    solved_loading,
    summarise_area_load,
    value_after_contact,
    value_at_level,
    values_at_loads,
)
from contactsim.observables.load_curve import FOLD, LoadCurve, join_folds

AREA = np.linspace(0.01, 0.3, 30)
FINE = np.linspace(0.0, 1.0, 20001)


def test_a_straight_line_through_the_origin_is_neither_nonlinear_nor_curved():
    assert nonlinearity(FINE, 0.5 * FINE, 0.5 * FINE, 0.1) == pytest.approx(0.0, abs=1e-12)
    assert nonlinearity(FINE, 0.5 * FINE, 3 * FINE, 0.1) == pytest.approx(0.0, abs=1e-12)
    assert abs(curvature(AREA, 0.5 * AREA)) < 1e-12


@pytest.mark.parametrize("scale", [3.0, 1e-3])
def test_the_misfit_of_a_parabola_is_that_of_its_best_line_whatever_its_unit(scale):
    loads = np.linspace(0, 1, LINE_LOADS + 1)[1:]
    areas = np.sqrt(loads)
    misfit = areas - loads * (areas * loads).sum() / (loads**2).sum()
    expected = np.sqrt((misfit**2).mean())
    assert nonlinearity(FINE, scale * FINE**2, scale * FINE**2, scale) == pytest.approx(expected, rel=1e-3)
    assert abs(curvature(FINE, scale * FINE**2)) == pytest.approx(1.0)


def test_equal_parts_of_line_and_square_are_half_curved_and_a_load_that_bends_back_is_so_with_its_sign():
    share = AREA / AREA.max()
    assert curvature(AREA, share + share**2) == pytest.approx(0.5)
    assert curvature(AREA, 3 * share - share**2) == pytest.approx(-0.25)


def test_loads_that_pull_first_are_far_from_a_straight_line_and_loads_that_only_pull_have_no_measure():
    pulls = FINE**2 - 0.5 * FINE
    assert nonlinearity(FINE, pulls, pulls, 0.1) > 0.3
    assert np.isnan(nonlinearity(FINE, -0.5 * FINE, -0.5 * FINE, 0.1))
    assert np.isnan(nonlinearity(FINE, pulls, pulls, 0.6))  # the curve ends at 0.5


def test_a_curve_without_contact_has_no_curvature():
    assert np.isnan(curvature(0 * AREA, AREA))
    assert np.isnan(curvature(AREA[:2], AREA[:2]))


def test_a_load_is_read_where_it_is_last_reached():
    pressure, area = np.array([0.0, 1.0, -1.0, 3.0, np.nan]), np.array([0.0, 0.1, 0.2, 0.6, 0.9])
    assert values_at_loads(pressure, area, np.array([0.0, 0.5, 3.0])) == pytest.approx([0.3, 0.35, 0.6])
    assert np.isnan(values_at_loads(pressure, area, np.array([-2.0, 4.0]))).all()


def test_a_level_is_interpolated_where_a_curve_reaches_it_and_missing_elsewhere():
    area, load = np.array([0.0, 0.1, 0.3, 0.2, 0.4]), np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    assert value_at_level(area, 0.2, load) == pytest.approx(1.5)
    assert np.isnan(value_at_level(area, 0.5, load))
    assert np.isnan(value_at_level(area[1:], 0.05, load[1:]))


APPROACH = np.arange(0.0, 11.0)


def test_the_gradient_after_contact_is_read_2_nm_after_an_area_of_a_thousandth():
    ratio = 0.5 + 0.1 * APPROACH
    assert value_after_contact(APPROACH, 4e-4 * APPROACH, ratio) == pytest.approx(0.95)  # at 4.5 nm
    no_contact = np.where(APPROACH < 2, np.nan, ratio)  # a state without contact has no gradient
    assert value_after_contact(APPROACH, 4e-4 * APPROACH, no_contact) == pytest.approx(0.95)


@pytest.mark.parametrize(("first_area", "slope"), [(0.01, 4e-4), (0.0, 1.1e-4), (0.0, 0.0)])
def test_a_path_that_begins_late_or_ends_early_has_no_gradient_after_contact(first_area, slope):
    assert np.isnan(value_after_contact(APPROACH, first_area + slope * APPROACH, 1 + 0 * APPROACH))


def test_a_single_unknown_state_is_bridged_and_two_end_the_loading():
    pressure = np.array([0.0, np.nan, 2.0, np.nan, np.nan, 5.0])
    assert solved_loading(np.arange(6.0), pressure, 10 * np.arange(6.0))[0].tolist() == [0.0, 1.0, 2.0]


def numbers_of(deep, area, pressure):
    """Numbers of a curve by their names, and what bridged gaps leave open of them."""
    numbers = area_load_numbers(deep, area, pressure, np.full(deep.size, 0.1), 0.2)
    return (dict(zip(AREA_LOAD, part, strict=True)) for part in np.split(np.array(numbers), 2))


def test_a_curve_is_read_on_loading_alone():
    deep = np.concatenate((np.linspace(-1.0, 21.0, 23), np.linspace(20.0, -1.0, 22)))
    area = np.maximum(deep, 0.0) / 40 + 0.2 * (np.arange(deep.size) > 22)
    found, errors = numbers_of(deep, area, 0.01 * area)
    assert [found["nonlinearity"], found["nonlinearity_reduced"]] == pytest.approx([0.0, 0.0], abs=1e-7)
    assert found["area_at_12nm"] == pytest.approx(0.3)
    assert found["pressure_at_20nm"] == pytest.approx(0.005)
    assert found["area_at_load_0_003"] == pytest.approx(0.3)
    assert found["gradient_ratio_at_area_0_02"] == pytest.approx(0.5)
    assert [found[name] for name in AREA_LEVELS] == pytest.approx([0.01 * level for level in AREA_LEVELS.values()])
    assert [errors[name] for name in ("area_at_12nm", "pressure_at_20nm", "area_at_load_0_003")] == pytest.approx(
        [0.0] * 3
    )


def test_a_single_unknown_state_is_bridged_with_the_distance_to_its_neighbours_as_error():
    deep = np.linspace(-1.0, 21.0, 23)
    area = np.maximum(deep, 0.0) / 40
    pressure = np.where(deep == 12.0, np.nan, 0.01 * area)
    found, errors = numbers_of(deep, area, pressure)
    assert found["area_at_12nm"] == pytest.approx(0.3)
    assert errors["area_at_12nm"] == pytest.approx(1 / 40)
    assert [found["area_at_20nm"], errors["area_at_20nm"]] == pytest.approx([0.5, 0.0])


def test_the_error_of_a_reading_is_its_change_without_every_second_state():
    deep = np.linspace(0.0, 20.0, 21)
    area = deep**2 / 400
    found, errors = numbers_of(deep, area, 0.01 * area)
    assert found["area_at_load_0_001"] == pytest.approx(0.1)
    coarse = np.interp(12.0, deep[::2], area[::2]) - np.interp(12.0, deep, area)
    assert errors["area_at_12nm"] == pytest.approx(abs(coarse))
    pressure = 0.01 * area**2  # curved against the area: linear pieces leave an error
    _, errors = numbers_of(deep, area, pressure)
    change = np.interp(0.001, pressure[::2], area[::2]) - np.interp(0.001, pressure, area)
    assert errors["area_at_load_0_001"] == pytest.approx(abs(change)) and change != 0


@pytest.mark.parametrize("unknown", [(12.0, 13.0), (21.0,)])
def test_two_unknown_states_in_a_row_or_the_last_one_end_a_curve(unknown):
    deep = np.linspace(-1.0, 21.0, 23)
    area = np.maximum(deep, 0.0) / 40
    pressure = np.where(np.isin(deep, unknown), np.nan, 0.01 * area)
    found, _ = numbers_of(deep, area, pressure)
    assert np.isnan(found["area_at_20nm"]) == (unknown[0] < 20)
    assert found["pressure_at_area_0_1"] == pytest.approx(0.001)


def path(load, jump=None, status=0) -> xr.Dataset:
    """A path up to 4 nm and back, of unit contact modulus."""
    approach = np.array([-2.0, 0.0, 2.0, 4.0, 2.0, 0.0, -2.0])
    columns = {"approach": approach, "line_load": load, "jump": jump or [0.0] * 7, "status": [status] * 7}
    data = xr.Dataset({name: ("step", np.array(values, float)) for name, values in columns.items()})
    return data.assign(length=100.0, approach_first_touch=-10.0).merge(join_folds([]))


def test_a_cycle_dissipates_the_area_of_its_loop():
    there = path([0.0, 1.0, 2.0, 3.0, 1.0, -1.0, 0.0])
    found = summarise_cycles(there)
    # up 1 + 3 + 5, down 4 + 0 - 1
    assert float(found.dissipated_energy) == pytest.approx(6.0)
    assert float(found.dissipated_work) == pytest.approx(0.06)


def test_loading_and_unloading_along_one_curve_dissipate_nothing():
    assert float(summarise_cycles(path([0.0, -1.0, 2.0, 3.0, 2.0, -1.0, 0.0])).dissipated_energy) == pytest.approx(0.0)


def test_a_jump_has_an_error_of_half_its_step_and_a_smooth_cycle_has_none():
    load = [0.0, -1.0, 2.0, 3.0, 1.0, -2.0, 0.0]
    assert float(summarise_cycles(path(load)).dissipated_energy_increment_error) == 0.0
    found = summarise_cycles(path(load, [0.0] * 6 + [0.5]))
    assert float(found.dissipated_energy_increment_error) == pytest.approx(2.0)


def test_errors_of_several_jumps_are_added_in_squares():
    load = [0.0, -1.0, 2.0, 3.0, 1.0, -2.0, 0.0]
    found = summarise_cycles(path(load, [0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.5]))
    assert float(found.dissipated_energy_increment_error) == pytest.approx(np.hypot(1.0, 2.0))


def test_a_cycle_of_a_surface_has_an_energy_over_its_area():
    line = path([0.0, 1.0, 2.0, 3.0, 1.0, -1.0, 0.0])
    surface = line.rename(line_load="normal_force").drop_dims("fold").merge(join_folds([], 2)).assign(length_y=50.0)
    found = summarise_cycles(surface)
    assert float(found.dissipated_work) == pytest.approx(6.0 / (100.0 * 50.0))
    assert "dissipated_energy" not in found


def test_a_jump_that_is_located_leaves_half_its_width_and_its_place_open():
    data = path([0.0, -1.0, 2.0, 3.0, 1.0, -2.0, 0.0], [0.0] * 6 + [0.5])
    fold = dict(zip(FOLD, (6.0, -0.5, -0.5, -0.6, -0.6, -2.5, -2.5, -0.1, -0.1), strict=True))
    found = summarise_cycles(data.drop_dims("fold").merge(join_folds([fold])))
    # up -1 + 1 + 5, down 4 - 1 to the state before the jump, and pulls of 1.125, 0.13 across the jump, and 0.07
    assert float(found.dissipated_energy) == pytest.approx(5.0 - 3.0 + 1.125 + 0.13 + 0.07)
    assert float(found.dissipated_energy_increment_error) == pytest.approx(0.1 * 2.4 / 2)


def test_an_open_or_incomplete_loop_has_no_dissipated_energy():
    closed = np.array([0.0, -1.0, 2.0, 3.0, 1.0, -2.0, 0.0])
    approach = path(closed).approach.values

    def energy(load: np.ndarray) -> float:
        return dissipated_energy(LoadCurve.from_states(approach[: load.size], load, 0 * load))[0]

    assert np.isfinite(energy(closed))
    for place, value in ((-1, -1.0), (0, 0.5), (3, np.nan)):
        load = closed.copy()
        load[place] = value
        assert np.isnan(energy(load))
    assert np.isnan(energy(closed[:4]))
    assert np.isnan(float(summarise_cycles(path(closed, status=1)).dissipated_energy))


def test_a_hard_wall_is_read_by_its_own_area_and_approach():
    deep = np.linspace(-1.0, 20.0, 22)
    area = np.maximum(deep, 0.0) / 40
    columns = {"approach": deep - 10, "relative_contact_area": area, "normalised_pressure": area / 50}
    columns |= {"rms_gradient_contact": np.full(22, 0.1), "status": np.zeros(22)}
    data = xr.Dataset({name: ("step", values) for name, values in columns.items()})
    found = summarise_area_load(
        data.assign(rms_gradient=0.2, approach_first_touch=-10.0), "relative_contact_area", "rms_gradient_contact"
    )
    assert float(found.area_at_12nm) == pytest.approx(0.3)
    assert float(found.gradient_ratio_at_area_0_02) == pytest.approx(0.5)
