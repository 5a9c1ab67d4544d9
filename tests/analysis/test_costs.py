"""Costs that claims are about: time of a solution, and the effort of the gradient over the contact."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from contactsim import dataset
from contactsim.analysis import costs
from contactsim.analysis.claims import judge
from contactsim.surfaces.statistics import rms_gradient, rms_height
from support.claims import PLAN, PRESSURES, claim, made_up


def table_of(data, seconds=2.0, whole=0.01, contact=0.03):
    """A table of costs of a made-up dataset, with one more run that measures an error."""
    rows = data.kappa.to_dataframe().reset_index().drop(columns="kappa")
    rows = rows.assign(measures_error=False, seconds=seconds, gradient_seconds=whole, contact_gradient_seconds=contact)
    return pd.concat([rows, rows[:3].assign(measures_error=True, seconds=99.0)]).sample(frac=1, random_state=0)


def test_costs_stand_at_the_places_of_the_results():
    data = made_up()
    table = table_of(data)
    table.loc[(table.member == 2) & (table.reduced_pressure == PRESSURES[1]), "seconds"] = 8.0
    data = costs.with_costs(data, table)
    assert data.solution_seconds.dims == data.status.dims
    assert (data.solution_seconds.sel(member=2, reduced_pressure=PRESSURES[1]) == 8.0).all()
    assert data.solution_seconds.max() == 8.0  # no run that measures an error
    assert np.allclose(data.gradient_effort.sel(member=0), 0.02 / 2.0)
    assert np.allclose(data.gradient_effort.sel(member=2), 0.02 / 4.0)  # over the mean solution of the run


def test_a_claim_about_effort_is_decided_by_costs():
    settings = claim(
        quantity="gradient_effort", reduce="largest_size", expect=None, tolerance=None, at_most=0.05, neutral=0.0
    )
    cheap = judge(settings, [costs.with_costs(made_up(), table_of(made_up()))])
    assert (cheap["verdict"], cheap["grid_error"]) == ("reproduced", 0.0)
    assert cheap["value"] == pytest.approx(0.01)
    dear = costs.with_costs(made_up(), table_of(made_up(), whole=0.5))
    assert judge(settings, [dear])["verdict"] == "not reproduced"  # cheaper over the contact is a difference, too


def test_the_plan_names_the_studies_whose_costs_claims_read():
    assert PLAN.claims_costs("ch3") == ["rough_line", "rough_surface"]
    assert PLAN.claims_costs("ch4") == []
    assert PLAN.claims_settings("ch3")["costs"] == PLAN.claims_costs("ch3")


@pytest.mark.parametrize("study", ["rough_line", "rough_surface"])
def test_heights_of_a_run_are_those_that_it_solved(made, study):
    entry = PLAN.study_settings(study)["runs"][0]
    run = dataset.load_dataset(made / entry["path"])
    heights, spacing = costs.heights_of_run(run)
    assert heights.size == run.points.item() * (run.points_y.item() if "points_y" in run else 1)
    assert rms_gradient(heights, spacing) == pytest.approx(run.rms_gradient.item(), rel=1e-10)
    assert rms_height(heights) == pytest.approx(run.rms_height.item(), rel=1e-10)


def test_the_table_of_costs_has_the_time_of_both_gradients(made):
    table = pd.read_csv(made / "results/quick/costs/ch3_rough_line.csv")
    own = table[~table.measures_error]
    assert (own[["gradient_seconds", "contact_gradient_seconds"]] > 0).all(axis=None)
    assert table[table.measures_error].gradient_seconds.isna().all()
    without = pd.read_csv(made / "results/quick/costs/ch3_surface_resolution.csv")
    assert without.gradient_seconds.isna().all()  # the study keeps no profile


def test_a_run_without_contact_or_profile_has_no_time(made):
    entry = PLAN.study_settings("rough_line")["runs"][0]
    run = dataset.load_dataset(made / entry["path"])
    assert np.isfinite(costs.gradient_seconds(run)).all()
    assert np.isnan(costs.gradient_seconds(run.drop_vars("contact_bits"))).all()
