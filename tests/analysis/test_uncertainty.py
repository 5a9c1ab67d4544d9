"""The number of a claim and its errors: members, grids, increments, two studies, and what is unknown or absent."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from contactsim import dataset
from contactsim.analysis.comparison import Comparison
from contactsim.analysis.quantities import mean_quantity
from contactsim.analysis.uncertainty import (
    MIN_MARGIN,
    estimate,
    estimate_on_thesis_grid,
    estimate_steps,
    student_factor,
)
from contactsim.analysis.unknown_places import unknown_places
from contactsim.reference import hard_wall
from support.claims import BANDLESS, claim, made_up, path_claim, paths, with_corrected

RATIO = {"relative_to": "rough_surface", "expect": 0.9, "tolerance": 0.05}


def selected(settings, *data):
    """What a claim compares where it selects it."""
    return Comparison(settings, data).select(settings["select"])


def number(settings, *data):
    """The number of a claim where its studies are selected."""
    return estimate(selected(settings, *data))


def noisy(members=10, seed=0, scatter=0.05):
    """Rough lines whose κ does not depend on the load, with noise of its own at each load and member."""
    data = made_up(members=members)
    noise = np.random.default_rng(seed).standard_normal(data.kappa.shape)
    return data.assign(kappa=data.kappa + scatter * noise)


def with_settings(data, **changes):
    """The dataset of a study with other settings."""
    return data.assign_attrs(settings=json.dumps(dataset.settings_of(data) | changes))


# --- members ------------------------------------------------------------------------------------------------------


def test_the_range_of_a_constant_is_zero_on_average_over_ensembles_and_its_error_is_not_too_small():
    settings = claim(reduce="spread", along="reduced_pressure", **BANDLESS, at_most=0.1)
    ranges = [number(settings, noisy(members=4, seed=seed)) for seed in range(24)]
    values = np.array([each.value for each in ranges])
    assert abs(values.mean()) < 3 * values.std() / np.sqrt(len(values))
    assert np.median([each.ensemble_error for each in ranges]) > 0.7 * values.std()


def test_a_trend_is_found_in_noise():
    settings = claim(reduce="trend", along="reduced_pressure", **BANDLESS, at_most=0.1)
    tilted = noisy(seed=3)
    tilted = tilted.assign(kappa=tilted.kappa + 0.2 * np.log10(tilted.reduced_pressure / 0.01))
    result = number(settings, tilted)
    assert result.value == pytest.approx(0.2, abs=3 * result.ensemble_error)
    assert 0 < result.ensemble_error < 0.05


def test_one_member_of_a_random_surface_has_no_known_error_and_a_cylinder_has_none():
    alone = made_up(members=1)
    assert np.isnan(number(claim(), alone).ensemble_error)
    alone.attrs["settings"] = json.dumps({"surface": {"kind": "cylinder"}, "thesis_points": None})
    assert number(claim(), alone).ensemble_error == 0


def test_the_ensembles_of_a_ratio_are_independent():
    one, two = made_up(1.8, scatter=0.02, members=4), made_up(2.0, scatter=0.05, members=9)
    relative = [number(claim(), data).ensemble_error / level for data, level in ((one, 1.8), (two, 2.0))]
    assert number(claim(**RATIO), one, two).ensemble_error == pytest.approx(0.9 * np.hypot(*relative), rel=1e-3)
    assert np.isnan(number(claim(**RATIO), one, made_up(2.0, members=1)).ensemble_error)


def test_members_of_a_large_ensemble_are_left_out_in_twenty_blocks():
    data = noisy(members=40, seed=5)
    over_loads = (data.kappa * xr.DataArray([0.25, 0.5, 0.25], dims="reduced_pressure")).sum("reduced_pressure")
    blocks = over_loads.mean(set(over_loads.dims) - {"member"})
    means = blocks.values.reshape(2, 20).mean(axis=0)  # every twentieth, so that the first members are apart
    expected = student_factor(20) * means.std(ddof=1) / np.sqrt(20)
    assert number(claim(**BANDLESS, at_most=2.0), data).ensemble_error == pytest.approx(expected)


@pytest.mark.parametrize("members", [3, 5, 10])
def test_two_errors_of_a_mean_hold_the_true_value_in_95_percent_of_small_ensembles(members):
    samples = np.random.default_rng(members).normal(size=(20_000, members))
    errors = student_factor(members) * samples.std(axis=1, ddof=1) / np.sqrt(members)
    beyond = np.abs(samples.mean(axis=1)) > MIN_MARGIN * errors
    assert beyond.mean() == pytest.approx(0.05, abs=0.005)
    unscaled = np.abs(samples.mean(axis=1)) > MIN_MARGIN * errors / student_factor(members)
    assert unscaled.mean() > 0.07


# --- unknown and absent -------------------------------------------------------------------------------------------


def test_one_unconverged_solution_makes_a_mean_unknown_and_is_named():
    data = made_up()
    data["status"][1, 2, 0] = 1
    assert np.isnan(number(claim(), data).value)
    words = unknown_places(selected(claim(), data))
    assert words == "κ at H = 0.8, member = 2, p* = 0.001"
    elsewhere = claim(select={"reduced_pressure": [0.01, 0.1]})
    assert number(elsewhere, data).value == pytest.approx(2.0)
    assert unknown_places(selected(elsewhere, data)) == ""


def test_what_does_not_exist_is_left_out_only_where_the_claim_says_so():
    data = paths([np.nan, 14.0, 16.0], work_ratio=[0.0, 0.5, 1.0])
    assert np.isnan(number(path_claim(), data).value)
    assert "φt/φn = 0" in unknown_places(selected(path_claim(), data))
    without = path_claim(absent="no pull-off")
    assert number(without, data).value == pytest.approx(15.0)
    assert unknown_places(selected(without, data)) == ""


@pytest.mark.parametrize("reduce", ["mean", "least", "largest"])
def test_where_nothing_exists_there_is_no_number(reduce):
    data = paths([np.nan, np.nan], work_ratio=[0.0, 0.5])
    assert np.isnan(number(path_claim(reduce=reduce, absent="no pull-off"), data).value)


def test_what_is_unknown_stays_so_where_something_may_be_absent():
    data = paths([np.nan, 14.0, 16.0], work_ratio=[0.0, 0.5, 1.0])
    data["status"][0, 0, 3] = 1
    without = path_claim(absent="no pull-off")
    assert np.isnan(number(without, data).value)
    assert "φt/φn = 0" in unknown_places(selected(without, data))


def test_an_empty_selection_has_no_number():
    assert np.isnan(number(claim(select={"reduced_pressure": [0.5, 1.0]}), made_up()).value)


# --- grids and increments -----------------------------------------------------------------------------------------


def test_the_grid_error_is_the_change_of_the_number_on_the_coarser_grid():
    assert number(claim(), made_up(grid=-0.2)).grid_error == pytest.approx(0.2)
    share = claim(quantity="relative_contact_area", against="kappa", reduce="ratio", expect=0.1, tolerance=0.05)
    assert number(share, made_up(grid=0.2)).grid_error == pytest.approx(0, abs=1e-12)  # both move alike
    data = made_up(2.0).assign(kappa_grid_change=made_up(grid=0.2).kappa_grid_change)
    assert number(share, data).grid_error == pytest.approx(0.1 * (1 / 0.9 - 1))  # κ alone is smaller


def test_both_grids_of_a_ratio_are_halved_together():
    one, two = made_up(1.8, grid=0.09), made_up(2.0, grid=0.2)
    assert number(claim(**RATIO), one, two).grid_error == pytest.approx(1.71 / 1.8 - 0.9)
    assert number(claim(**RATIO), one, made_up(2.0, grid=0.1)).grid_error == pytest.approx(0, abs=1e-12)
    assert np.isnan(number(claim(**RATIO), one, two.drop_vars("kappa_grid_change")).grid_error)


def test_without_a_coarse_run_the_grid_error_is_unknown():
    assert np.isnan(number(claim(), made_up().drop_vars("kappa_grid_change")).grid_error)


def test_the_error_of_a_fit_over_approaches_counts_with_the_grid():
    data = paths([10.0], grid=0.3, work_ratio=[1.0]).isel(work_ratio=0)
    data["pull_off_load_loading_approach_error"] = ("member", [0.4])
    assert number(path_claim(reduce="mean"), data).grid_error == pytest.approx(0.5)


def test_increments_of_variants_err_independently_and_count_with_the_grid():
    data = paths([[10.0, 20.0]], grid=0.2, increment=0.3, work_of_separation=[1.0], work_ratio=[0.0, 1.0])
    result = number(path_claim(), data)
    assert (result.ensemble_error, result.grid_error) == (0, pytest.approx(np.sqrt(0.2**2 + 2 * 0.15**2)))


def test_increments_of_members_err_independently():
    one = paths([10.0], grid=0.2, increment=0.3, work_ratio=[1.0]).isel(work_ratio=0)
    four = xr.concat([one] * 4, "member", data_vars="minimal")
    assert number(path_claim(reduce="mean"), four).grid_error == pytest.approx(np.hypot(0.2, 0.3 / np.sqrt(4)))


def test_a_grid_that_changes_all_members_in_proportion_does_not_change_their_relative_scatter():
    bars = claim(quantity="relative_contact_area_bar_share", reduce="largest", **BANDLESS, at_most=0.1)
    scattered = with_settings(made_up(scatter=0.1, grid=0.2), members=4)
    assert number(bars, scattered).value > 0.01
    assert number(bars, scattered).grid_error == pytest.approx(0, abs=1e-12)


def test_on_the_grid_of_the_thesis_a_number_has_no_grid_error_and_on_another_an_unknown_one():
    def on_thesis_grid(points):
        return estimate_on_thesis_grid(selected(claim(), made_up(grid=0.5, points=points))).grid_error

    assert on_thesis_grid(262144) == 0
    assert np.isnan(on_thesis_grid(1024))


@pytest.mark.parametrize(
    ("points", "error"),
    [(262144, 0.07), (65536, 0.07), (65535, 0.02)],
)
def test_a_corrected_quantity_is_as_uncertain_as_its_second_estimator_where_the_grid_resolves_that(points, error):
    data = with_corrected(made_up(points=points), 1.9, change=0.02, subgrid=1.83)
    found = number(claim(quantity="kappa_corrected"), data)
    assert (found.value, found.grid_error) == pytest.approx((1.9, error))


@pytest.mark.parametrize(("is_surface", "error"), [(False, 0.07), (True, 0.04)])
def test_on_rough_surfaces_the_second_estimator_is_freed_of_its_second_order(is_surface, error):
    data = with_corrected(made_up(), 1.9, change=0.02, subgrid=1.83)
    data["kappa_subgrid_grid_change"] = data.kappa_grid_change * 0 + 0.09  # 1.83 and, on half the points, 1.74: to 1.86
    data = data.assign(length_y=160000.0) if is_surface else data
    assert number(claim(quantity="kappa_corrected"), data).grid_error == pytest.approx(error)


def test_a_close_second_estimator_does_not_lower_the_error():
    data = with_corrected(made_up(), 1.9, change=-0.02, subgrid=1.901)
    assert number(claim(quantity="kappa_corrected"), data).grid_error == pytest.approx(0.02)


# --- two studies --------------------------------------------------------------------------------------------------


def test_over_a_second_study_the_number_is_the_ratio_of_the_means():
    two = [made_up(1.8, scatter=0.1), made_up(2.0, scatter=0.3, members=7)]
    assert number(claim(**RATIO), *two).value == pytest.approx(0.9)
    assert number(claim(**RATIO), *two[::-1]).value == pytest.approx(1 / 0.9)


def test_studies_of_the_same_surfaces_scatter_together_and_others_on_their_own():
    one, two = made_up(1.8, scatter=0.09), made_up(2.0, scatter=0.1)  # the same members are 5 % too high in both
    alike = with_settings(one, name="a"), with_settings(two, name="b", same_surfaces_as="a")
    assert number(claim(**RATIO), *alike).ensemble_error == pytest.approx(0, abs=1e-12)
    apart = with_settings(one, name="a"), with_settings(two, name="b")
    single = number(claim(expect=1.8), one).ensemble_error / 1.8
    assert number(claim(**RATIO), *apart).ensemble_error == pytest.approx(0.9 * np.sqrt(2) * single, rel=0.01)


def test_minus_a_second_study_the_number_is_the_difference_of_the_means():
    settings = claim(minus="rough_surface", expect=-0.2, tolerance=0.05)
    assert number(settings, made_up(1.8), made_up(2.0)).value == pytest.approx(-0.2)


def test_a_comparison_is_made_where_both_studies_have_loads_and_variants():
    lines = made_up(1.8, tilt=0.3)  # κ of 1.5, 1.8 and 2.1
    surfaces = made_up(2.0).isel(reduced_pressure=[0, 2], hurst_exponent=[1])
    common = surfaces.assign_coords(reduced_pressure=[0.001, 0.2])
    assert number(claim(**RATIO), lines, common).value == pytest.approx(0.75)  # the first load alone
    apart = surfaces.assign_coords(reduced_pressure=[0.002, 0.2])
    assert np.isnan(number(claim(**RATIO), lines, apart).value)
    below = claim(**RATIO, select={"reduced_pressure": [0.05, 0.1]})
    assert number(below, lines, surfaces).value == pytest.approx(2.1 / 2)


def test_a_ratio_of_two_studies_is_taken_at_each_value_that_one_of_them_varies():
    grid = paths([[10.0, 12.0, 11.0], [20.0, 21.0, 30.0]], work_of_separation=[1.0, 2.0], work_ratio=[0.0, 0.5, 1.0])
    uncoupled = paths([[5.0, 4.0], [10.0, 8.0]], poisson_ratio=[0.1, 0.3], work_of_separation=[2.0, 3.0])
    over = {"relative_to": "indentation_uncoupled", "reduce": "largest"} | BANDLESS | {"at_least": 1.0}
    assert number(path_claim(**over), grid, uncoupled).value == pytest.approx(30 / 5)
    place = path_claim(**over, select={"poisson_ratio": [0.3, 0.3], "work_ratio": [0.0, 0.0]})
    assert number(place, grid, uncoupled).value == pytest.approx(20 / 10)


# --- steps of an order --------------------------------------------------------------------------------------------


def test_each_step_of_an_order_has_its_own_error():
    data = paths([1.0, 3.0, 3.0], increment=0.1, work_ratio=[0.0, 0.5, 1.0])
    settings = path_claim(reduce="rising_steps", along="work_ratio", **BANDLESS)
    comparison = selected(settings, data)
    steps, errors = estimate_steps(comparison.steps, comparison)
    assert steps.tolist() == [2.0, 0.0]
    assert errors == pytest.approx(np.full(2, 0.1 * np.sqrt(2)))


def test_the_change_from_end_to_end_has_its_own_error():
    data = paths([1.0, 3.0, 3.0], increment=0.1, work_ratio=[0.0, 0.5, 1.0])
    comparison = selected(path_claim(reduce="rising_steps", along="work_ratio", **BANDLESS), data)
    change, error = estimate_steps(comparison.end_to_end, comparison)
    assert change.tolist() == [2.0]
    assert error == pytest.approx(0.1 * np.sqrt(2))


def test_a_summary_of_a_path_without_an_error_of_its_increments_has_no_known_error():
    claimed = path_claim()
    known = paths([1.0, 3.0], increment=0.1, work_ratio=[0.0, 1.0])
    unmeasured = known.drop_vars(f"{claimed['quantity']}_increment_error")
    assert np.isfinite(number(claimed, known).grid_error)
    assert np.isnan(number(claimed, unmeasured).grid_error)


# --- against what is stored ---------------------------------------------------------------------------------------


def test_the_ensemble_error_of_a_mean_is_the_stored_standard_error_and_so_is_the_grid_error(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    settings = claim(select={"hurst_exponent": [0.5, 0.5], "reduced_pressure": [0.1, 0.1]})
    result, stored = number(settings, data), data.sel(hurst_exponent=0.5, reduced_pressure=0.1)
    assert result.value == pytest.approx(float(stored.kappa_mean))
    expected = student_factor(data.member.size) * float(stored.kappa_standard_error)
    assert result.ensemble_error == pytest.approx(expected)
    assert result.grid_error == pytest.approx(float(stored.kappa_grid_error))


def test_the_fits_are_those_of_the_dataset(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    below = data.sel(reduced_pressure=slice(0, 0.1001))
    pressure = below.reduced_pressure.values
    for name, weighting, fitted in (
        ("kappa_fit", "area", ["0.2", "0.5", "0.8"]),
        ("kappa_fit_logarithm", "logarithm", ["0.2", "0.5", "0.8"]),
        ("kappa_fit_all", "area", ["all"] * 3),
    ):
        for row, sample in zip(mean_quantity(below, name).values, fitted, strict=True):
            fit = data.sel(weighting=weighting, fit_limit=0.1, fitted=sample)
            expected = hard_wall.line_area(pressure, float(fit.fit_b1), float(fit.fit_b2)) / pressure
            assert np.allclose(row, expected)


def test_a_number_about_the_grid_error_has_the_scatter_of_the_few_members_on_both_grids():
    data = made_up(2.0, scatter=0.1, grid=0.1)
    share = claim(quantity="kappa_grid_error", against="kappa", reduce="ratio", **BANDLESS, at_most=0.02)
    alone = number(share, data).ensemble_error
    scattered = data.assign(kappa_grid_change_standard_error=data.kappa_grid_change_standard_error + 0.03)
    expected = np.hypot(alone, student_factor(3) * 0.03 / 2.0)
    assert number(share, scattered).ensemble_error == pytest.approx(expected)
    one = data.drop_vars("kappa_grid_change_standard_error")
    assert np.isnan(number(share, one).ensemble_error)
    one.attrs["settings"] = json.dumps({"surface": {"kind": "cylinder"}, "thesis_points": None})
    assert number(share, one).ensemble_error == pytest.approx(alone)
