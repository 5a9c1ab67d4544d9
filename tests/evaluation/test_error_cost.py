"""Errors, orders and costs by hand, from small made datasets."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from contactsim.evaluation.work_precision import error_cost
from contactsim.status import Status
from support.prices import PATH_REFERENCE, PATH_SETTINGS, REFERENCE, SETTINGS, job, path_job, path_study, study

GRIDS = [("points", 16, 1e-3), ("points", 32, 1e-3)]


def table_of(**jobs):
    return error_cost.error_table(
        SETTINGS["quantities"], SETTINGS["load"], {"reference": REFERENCE} | jobs, study(), "active_set"
    )


def rows(errors, costs, **columns):
    """A table of one solver's settings, all converged."""
    plain = {"solver": "active_set", "knob": "points", "unconverged": 0.0, "own": True}
    return pd.DataFrame(
        {"points": 2 ** np.arange(4, 4 + len(errors)), "error": errors, "work": costs} | plain | columns
    )


def test_the_error_of_a_knob_is_against_the_reference_of_that_knob():
    table = table_of(active_set=job([*GRIDS, ("tolerance", 32, 0.1)], [2.2, 2.1, 4.4]))
    assert table.kappa_r[:3].to_numpy() == pytest.approx([0.1, 0.05, 0.1])


def test_the_error_is_the_root_mean_square_over_loads_and_the_work_transforms_times_points():
    table = table_of(active_set=job(GRIDS, [[2.2, 2.0], [2.0, 2.0]], [10, 30]))
    assert table.kappa_r[:2].to_numpy() == pytest.approx([0.1 / np.sqrt(2), 0])
    assert table.work[:2].tolist() == [2 * 10 * 16, 2 * 30 * 32]


def test_the_work_on_a_surface_counts_all_of_its_points():
    grids = job(GRIDS, [2.1, 2.1], [10, 30]).assign(points_y=("setting", [8, 32]))
    jobs = {"reference": REFERENCE, "conjugate_gradients": grids}
    table = error_cost.error_table(
        SETTINGS["quantities"], SETTINGS["load"], jobs, study().assign(points_y=16), "conjugate_gradients"
    )
    assert table.work.tolist() == [2 * 10 * 16 * 8, 2 * 30 * 32 * 32, 8 * 64 * 16, 12 * 64 * 16]
    assert table.own.all()
    assert set(table.solver) == {"conjugate_gradients"}


@pytest.mark.parametrize("missing", [[np.nan, 2.0], [np.nan, np.nan], [np.inf, 2.0]])
def test_a_setting_without_a_value_at_one_load_has_no_finite_error(missing):
    table = table_of(active_set=job(GRIDS, [missing, [2.1, 2.1]]))
    assert table.kappa_r[0] == np.inf
    assert len(error_cost.converged_rows(table.query("knob == 'points'"), "kappa_r")) == 1


def test_a_reference_without_a_value_leaves_no_error():
    data = {"reference": REFERENCE.assign(kappa_r=REFERENCE.kappa_r * np.nan), "active_set": job(GRIDS, [2.1, 2.1])}
    assert np.isinf(
        error_cost.error_table(SETTINGS["quantities"], SETTINGS["load"], data, study(), "active_set").kappa_r[:2]
    ).all()


def test_the_share_of_unconverged_solutions_is_told():
    data = job(GRIDS, [2.1, 2.1])
    data["status"][1, 0] = Status.MAX_ITERATIONS.value[0]
    assert table_of(active_set=data).unconverged[:2].tolist() == [0.0, 0.5]


def test_the_work_of_an_ensemble_is_its_members_and_its_error_falls_as_their_root():
    table = table_of(active_set=job(GRIDS, [2.1, 2.1]))
    ensembles = table[table.knob == "members"]
    assert ensembles.members.tolist() == [2, 3]
    # on average a member takes 2 transforms at each of 2 loads, on 64 points
    assert ensembles.work.tolist() == [2 * 2 * 2 * 64, 3 * 2 * 2 * 64]
    assert ensembles.kappa_r.to_numpy() == pytest.approx([0.01 * np.sqrt(3 / 2), 0.01])
    assert ensembles.points.tolist() == [64, 64]


def test_an_ensemble_with_unconverged_solutions_says_so():
    data = study()
    data["status"][0, 0] = Status.MAX_ITERATIONS.value[0]
    table = error_cost.error_table(
        SETTINGS["quantities"],
        SETTINGS["load"],
        {"reference": REFERENCE, "active_set": job(GRIDS, [2.1, 2.1])},
        data,
        "active_set",
    )
    assert (table[table.knob == "members"].unconverged == 1 / 6).all()


def test_one_member_is_no_ensemble():
    jobs = {"reference": REFERENCE, "active_set": job(GRIDS, [2.1, 2.1])}
    table = error_cost.error_table(SETTINGS["quantities"], SETTINGS["load"], jobs, study(members=1), "active_set")
    assert set(table.knob) == {"points"}


def path_table(data, study):
    return error_cost.error_table(
        PATH_SETTINGS["quantities"],
        PATH_SETTINGS["load"],
        {"reference": PATH_REFERENCE, "newton": data},
        study,
        "newton",
    )


def test_the_table_of_a_path_has_its_increments_each_against_their_own_reference():
    turned = [("points", 16, 1e-3, 0.5), ("tolerance", 32, 0.1, 0.5), ("increment", 32, 1e-3, 1.0)]
    found = path_table(path_job(turned, [220.0, 105.0, 51.0], [10, 20, 30]), path_study([200.0]))
    assert found.columns.tolist() == [
        *("solver", "knob", "points", "tolerance", "increment", "members"),
        *("pull_off_load_loading", "work", "unconverged", "own"),
    ]
    assert list(zip(found.knob, found.points, found.tolerance, found.increment, strict=True)) == turned
    assert found.pull_off_load_loading.to_numpy() == pytest.approx([0.1, 0.05, 0.02])
    assert found.work.tolist() == [10 * 16, 20 * 32, 30 * 32]
    assert found.own.all()


def test_loads_on_their_own_have_no_increments_in_their_table():
    assert "increment" not in table_of(active_set=job(GRIDS, [2.1, 2.1]))


def test_an_ensemble_of_paths_has_the_standard_error_of_what_they_amount_to():
    study = path_study([200.0, 202.0, 204.0])
    found = path_table(path_job([("points", 16, 1e-3, 0.5)], [220.0]), study).query("knob == 'members'")
    assert found.members.tolist() == [2, 3]
    assert found.pull_off_load_loading.to_numpy() == pytest.approx([2 / np.sqrt(2) / 202, 2 / np.sqrt(3) / 202])
    assert found.work.tolist() == [2 * 30 * 64, 3 * 30 * 64]
    study["status"][1, 2] = Status.MAX_ITERATIONS.value[0]
    found = path_table(path_job([("points", 16, 1e-3, 0.5)], [220.0]), study).query("knob == 'members'")
    assert found.unconverged.to_numpy() == pytest.approx([1 / 3, 1 / 3])  # of the paths, not of their steps


def test_the_cost_at_an_error_is_that_of_the_cheapest_setting_where_larger_errors_cost_more():
    table = rows([0.5, 0.1, 0.02], [9.0, 2.0, 4.0])
    assert error_cost.cost_at_error(table, "error", 0.3, "work") == pytest.approx(2.0)
    assert error_cost.cost_at_error(table, "error", 0.05, "work") == pytest.approx(2.0 * 2 ** (np.log(2) / np.log(5)))
    assert np.isnan(error_cost.cost_at_error(table, "error", 0.6, "work"))


def test_the_observed_order_and_the_cost_at_an_error_are_those_planted():
    points = np.array([100, 200, 400, 800])
    table = rows(5.0 * points**-1.5, 7.0 * points, points=points)
    assert error_cost.convergence_order(table, "error") == pytest.approx(1.5)
    assert error_cost.cost_at_error(table, "error", 5.0 * 300**-1.5, "work") == pytest.approx(2100.0)
    assert np.isnan(error_cost.cost_at_error(table, "error", 1e-9, "work"))  # no setting meets it


@pytest.mark.parametrize("bad", [{"unconverged": 0.1}, {"error": np.inf}, {"error": 0.0}, {"error": 1e-16}])
def test_the_observed_order_leaves_out_failures_and_rounding(bad):
    table = rows([0.4, 0.2, 0.1, 7.0], [1.0, 2.0, 4.0, 8.0])
    table.loc[3, list(bad)] = list(bad.values())
    assert error_cost.convergence_order(table, "error") == pytest.approx(1.0)
    assert np.isnan(error_cost.convergence_order(table[2:], "error"))


def test_on_the_front_a_dearer_setting_is_a_better_one():
    table = rows([0.5, 0.6, 0.2, 0.2, 0.1, 1e-12, 1e-14], [1.0, 2.0, 3.0, 3.5, 5.0, 6.0, 7.0])
    found = error_cost.pareto_front(table.sample(frac=1, random_state=1), "error", "work")
    assert found.error.tolist() == [0.5, 0.2, 0.1, 1e-12]
    assert found.work.tolist() == [1.0, 3.0, 5.0, 6.0]


@pytest.mark.parametrize("bad", [{"unconverged": 0.5}, {"error": np.inf}])
def test_failures_are_not_on_the_front(bad):
    table = rows([0.5, 0.2, 0.1], [1.0, 2.0, 3.0])
    table.loc[1, list(bad)] = list(bad.values())
    assert error_cost.pareto_front(table, "error", "work").index.tolist() == [0, 2]


def test_solvers_are_compared_at_equal_error_and_failures_do_not_count():
    points = np.array([100.0, 1000.0])
    table = pd.concat(
        rows(1 / points, factor * points, solver=kind, unconverged=bad, own=kind == "active_set")
        for kind, factor, bad in (("active_set", 1.0, 0), ("slow", 30.0, 0), ("failed", 0.1, 1))
    )
    found = error_cost.compare_solvers(table, "error", {"points": [0.005, 1e-9]}, ["work"]).set_index(
        ["solver", "error"]
    )
    assert found.work["slow", 0.005] == pytest.approx(30.0)
    assert np.isnan(found.work["slow", 1e-9])
    assert "failed" not in found.index
    assert error_cost.compare_solvers(table, "error", {"tolerance": [0.1]}, ["work"]).empty
