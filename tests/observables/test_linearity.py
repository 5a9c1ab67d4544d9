"""Curves of area against load as numbers, against what is known by hand; and the energy of a cycle."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from contactsim.observables.hysteresis import dissipated_energy, summarise_cycles
from contactsim.observables.linearity import (
    AREA_LOAD,
    LEVELS,
    area_load_numbers,
    curvature,
    nonlinearity,
    summarise_area_load,
    value_at_level,
)
from contactsim.observables.load_curve import FOLD, LoadCurve, join_folds

AREA = np.linspace(0.01, 0.3, 30)


def test_a_straight_line_through_the_origin_is_neither_nonlinear_nor_curved():
    assert nonlinearity(AREA, 0.5 * AREA) == pytest.approx(0.0, abs=1e-7)
    assert abs(curvature(AREA, 0.5 * AREA)) < 1e-12


@pytest.mark.parametrize("scale", [-3.0, 1e-3])
def test_a_parabola_is_all_curvature_whatever_its_unit(scale):
    assert abs(curvature(AREA, scale * AREA**2)) == pytest.approx(1.0)
    wanted = np.sqrt(1 - (AREA**3).sum() ** 2 / ((AREA**2).sum() * (AREA**4).sum()))
    assert nonlinearity(AREA, scale * AREA**2) == pytest.approx(wanted)


def test_equal_parts_of_line_and_square_are_half_curved_and_a_load_that_bends_back_is_so_with_its_sign():
    share = AREA / AREA.max()
    assert curvature(AREA, share + share**2) == pytest.approx(0.5)
    assert curvature(AREA, 3 * share - share**2) == pytest.approx(-0.25)


def test_loads_that_pull_first_are_far_from_a_straight_line():
    assert nonlinearity(AREA, AREA**2 - 0.2 * AREA) > 0.5


def test_too_few_states_or_no_contact_give_no_measure_of_linearity():
    assert np.isnan(nonlinearity(AREA[:2], AREA[:2]))
    assert np.isnan(nonlinearity(AREA, 0 * AREA))
    assert np.isnan(curvature(0 * AREA, AREA))


def test_a_level_is_interpolated_where_a_curve_reaches_it_and_missing_elsewhere():
    area, load = np.array([0.0, 0.1, 0.3, 0.2, 0.4]), np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    assert value_at_level(area, 0.2, load) == pytest.approx(1.5)
    assert np.isnan(value_at_level(area, 0.5, load))
    assert np.isnan(value_at_level(area[1:], 0.05, load[1:]))


def test_a_curve_is_read_on_loading_alone_and_ends_where_a_state_is_unknown():
    deep = np.concatenate((np.linspace(-1.0, 20.0, 22), np.linspace(19.0, -1.0, 21)))
    area = np.maximum(deep, 0.0) / 40 + 0.2 * (np.arange(deep.size) > 21)
    found = dict(zip(AREA_LOAD, area_load_numbers(deep, area, 0.01 * area, np.full(43, 0.1), 0.2), strict=True))
    assert found["nonlinearity"] == found["nonlinearity_reduced"] == pytest.approx(0.0, abs=1e-7)
    assert found["area_at_12nm"] == pytest.approx(0.3)
    assert found["pressure_at_12nm"] == pytest.approx(0.003)
    assert found["gradient_ratio_at_area_0_02"] == pytest.approx(0.5)
    assert [found[name] for name in LEVELS] == pytest.approx([0.01 * level for level in LEVELS.values()])
    pressure = np.where(deep == 10.0, np.nan, 0.01 * area)
    found = dict(zip(AREA_LOAD, area_load_numbers(deep, area, pressure, np.full(43, 0.1), 0.2), strict=True))
    assert np.isnan(found["area_at_12nm"])
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


def test_a_jump_that_is_located_leaves_half_its_width_and_its_place_open():
    data = path([0.0, -1.0, 2.0, 3.0, 1.0, -2.0, 0.0], [0.0] * 6 + [0.5])
    fold = dict(zip(FOLD, (6.0, -0.5, -0.6, -2.5, -0.1), strict=True))
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
