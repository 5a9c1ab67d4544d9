"""The judge can tell every outcome, and the map of outcomes is made of what it says."""

from __future__ import annotations

import json
from copy import deepcopy
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import yaml
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from contactsim import dataset, press
from contactsim.contact import hard_wall
from contactsim.errors import InputError
from contactsim.evaluation.robustness.cases import Case, make_case
from contactsim.evaluation.robustness.judge import find_violation, judge
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.evaluation.robustness.registry import HAZARDS
from contactsim.evaluation.robustness.survey import (
    hazard_job,
    merge_surveys,
    read_robustness,
    read_robustness_section,
    robustness_figure_job,
    robustness_job,
    survey_hazard,
)
from contactsim.figures.diagnostics.robustness import robustness
from contactsim.figures.diagnostics.stability import COLOURS, footer, refusals, short_reason, stability, supported
from contactsim.figures.layout import write_figure
from contactsim.solvers.base import State
from contactsim.solvers.registry import make_solver
from contactsim.study.figure_plan import PICTURE_ENDINGS
from contactsim.study.plan import Plan
from contactsim.variables import RESULTS
from support.cases import ALL, ON_SURFACES, refused
from support.places import ROOT

ON_PATHS = ("newton", "mass_weighted_verlet", "energy_minimisation")
CASE = make_case(np.cos(2 * np.pi * np.arange(64) / 64) - 0.3)
SURFACE = make_case(np.add.outer(np.cos(2 * np.pi * np.arange(10) / 10), np.cos(2 * np.pi * np.arange(16) / 16)) - 0.3)
SETTINGS = yaml.safe_load((ROOT / "config/stability.yaml").read_text(encoding="utf-8"))


class Stuck:
    """A solver that believes that uniform pressure times a factor is the answer."""

    accepts = make_solver("active_set").accepts
    budget, fields = 3, 1.0

    def __init__(self, factor):
        self.factor = factor

    def transforms(self, points):
        return 2.0

    def start(self, problem, guess=None):
        return State(np.ones_like(problem.heights), False)

    def step(self, problem, state):
        return State(state.pressure * self.factor, True)


def solved(case):
    return press(
        case.heights,
        spacing=case.spacing,
        contact_modulus=case.contact_modulus,
        mean_pressure=case.mean_pressure,
        approach=case.approach,
        tolerance=case.tolerance,
    )


# --- the judge ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("case", "method", "outcome", "reason"),
    [
        (CASE, "active_set", Outcome.EXACT, ""),
        (replace(CASE, exact=None), "active_set", Outcome.CERTIFIED, ""),
        (replace(CASE, mean_pressure=-1.0), "active_set", Outcome.REFUSED, "nothing can pull"),
        (replace(CASE, mean_pressure=None, approach=0.0), "verlet", Outcome.REFUSED, "APPROACH"),
        (CASE, make_solver("polonsky_keer", budget=1, batch=1), Outcome.FAILED, "iterations"),
        (CASE, Stuck(1.0), Outcome.FAILED, "iterations"),
        (CASE, "conjugate_gradients", Outcome.REFUSED, "LINE"),
        (SURFACE, "conjugate_gradients", Outcome.EXACT, ""),
        (SURFACE, "polonsky_keer", Outcome.EXACT, ""),
        (SURFACE, "active_set", Outcome.REFUSED, "SURFACE"),
        (replace(SURFACE, exact=None), "conjugate_gradients", Outcome.CERTIFIED, ""),
        (replace(SURFACE, exact=SURFACE.exact[:, ::-1]), "conjugate_gradients", Outcome.WRONG, "pressure off"),
        (replace(SURFACE, mirror=(0, 0)), "conjugate_gradients", Outcome.EXACT, ""),
        (replace(SURFACE, mirror=(0, 1)), "conjugate_gradients", Outcome.WRONG, "symmetric"),
        (replace(SURFACE, mirror=(1, 0)), "conjugate_gradients", Outcome.WRONG, "symmetric"),
        (CASE, Stuck(np.nan), Outcome.NON_FINITE, "not finite"),
        (CASE, Stuck(np.inf), Outcome.NON_FINITE, "not finite"),
        (replace(CASE, refuse=True), "active_set", Outcome.WRONG, "should have refused"),
        (replace(CASE, exact=CASE.exact[::-1] * 1.01), "active_set", Outcome.WRONG, "pressure off"),
    ],
)
def test_every_outcome_can_be_reached(case, method, outcome, reason):
    verdict = judge(case, method)
    assert verdict.outcome is outcome
    assert reason in verdict.reason


def test_a_wrong_answer_that_the_certificate_lets_pass_is_found_out(monkeypatch):
    monkeypatch.setattr(hard_wall.Certificate, "met", lambda self, tolerance: True)
    verdict = judge(CASE, Stuck(1.0))
    assert verdict.outcome is Outcome.WRONG
    assert "contact condition" in verdict.reason


@pytest.mark.parametrize(
    ("change", "violation"),
    [
        ({"pressure": lambda result: result.pressure - 2 * result.pressure.max() * (np.arange(64) == 32)}, "negative"),
        ({"pressure": lambda result: result.pressure * (1 + 1e-9)}, "forces"),
        ({"pressure": lambda result: np.roll(result.pressure, 1)}, "contact condition"),
        ({"approach": lambda result: result.approach + 1e-4}, "contact condition"),
    ],
)
def test_every_violation_of_a_solution_is_found(change, violation):
    result = solved(CASE)
    assert find_violation(CASE, result) == ""
    assert violation in find_violation(CASE, replace(result, **{name: edit(result) for name, edit in change.items()}))


def test_a_solution_not_exact_not_symmetric_or_of_another_area_is_found():
    result = solved(CASE)
    assert "exact" in find_violation(replace(CASE, exact=np.roll(CASE.exact, 1)), result)
    assert "area" in find_violation(replace(CASE, exact=None, area=0.3), result)
    assert find_violation(replace(CASE, mirror=0), result) == ""
    assert "symmetric" in find_violation(replace(CASE, mirror=5), result)
    wanted = Case(CASE.heights, approach=0.01, tolerance=1e-8)
    assert "approach" in find_violation(wanted, result)
    assert find_violation(replace(wanted, approach=result.approach), result) == ""


def test_an_overlap_outside_the_contact_is_found():
    result = solved(CASE)
    raised = CASE.heights + np.where(np.arange(64) == 32, 5.0, 0.0)  # where nothing carries
    assert result.pressure[32] == 0
    assert "contact condition" in find_violation(replace(CASE, heights=raised, exact=None), result)


def test_a_share_of_the_load_on_the_wrong_points_is_found_where_a_grid_step_is_coarse():
    case = HAZARDS["equal_heights"](85)
    result = solved(case)
    uneven = result.pressure * np.where(np.cumsum(result.contact) % 2, 1.3, 0.7)
    assert find_violation(case, result) == ""
    assert "exact" in find_violation(case, replace(result, pressure=uneven * (result.pressure.sum() / uneven.sum())))


def test_at_a_given_approach_the_pressure_is_held_to_a_thousandth():
    case = HAZARDS["last_gap"](0)
    result = solved(case)
    assert "exact" in find_violation(replace(case, exact=case.exact * 1.01), result)


def test_iterations_without_a_load_are_found():
    case = Case(CASE.heights, 0.0)
    result = solved(case)
    assert find_violation(case, result) == ""
    assert "no load" in find_violation(case, replace(result, record=replace(result.record, iterations=1)))
    assert "no load" in find_violation(case, replace(result, approach=result.approach - 1.0))


# --- the settings ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "key", "value", "allowed"),
    [
        ({"severities": [0, 101]}, "severities", [0, 101], "0 to 100"),
        ({"severities": [50, 0]}, "severities", [50, 0], "rising"),
        ({"severities": []}, "severities", [], "list"),
        ({"severities": [0, "5"]}, "severities", [0, "5"], "numbers"),
        ({"hazards": ["flood"]}, "hazards", ["flood"], "tension"),
        ({"hazards": ["flat", "flat"]}, "hazards", ["flat", "flat"], "twice"),
        ({"solvers": {}}, "solvers", {}, "at least one"),
        ({"solvers": {"guess": {}}}, "solvers.guess", {}, "active_set"),
        ({"solvers": {"verlet": {"speed": 1}}}, "solvers.verlet.speed", 1, "time_step"),
        ({"solvers": {"verlet": {"time_step": 2.0}}}, "solvers.verlet.time_step", 2.0, "below 1"),
        ({"solvers": {"verlet": 3}}, "solvers.verlet", 3, "options"),
        ({"size": [1.0]}, "size", [1.0], "inches"),
        ({"colour": "red"}, "colour", "red", "known keys"),
    ],
)
def test_a_bad_setting_is_refused_with_file_key_value_and_what_is_allowed(change, key, value, allowed):
    with pytest.raises(InputError, match=r"stability\.yaml") as caught:
        read_robustness_section(deepcopy(SETTINGS) | change, "stability.yaml")
    assert (caught.value.key, caught.value.value) == (key, value)
    assert allowed in str(caught.value)


@pytest.mark.parametrize(("count", "families"), [(0, ["grids"]), (2, ["grids", "grids too"])])
def test_every_hazard_is_in_one_family(count, families):
    hazards = {name: list(own) for name, own in SETTINGS["families"]["hazards"].items()}
    own = next(name for name, family in hazards.items() if "ridges" in family)
    hazards[own] = [hazard for hazard in hazards[own] if hazard != "ridges"]
    if count:
        hazards |= {name: ["ridges"] for name in families}
    changed = SETTINGS | {"families": SETTINGS["families"] | {"hazards": hazards}}
    with refused("families.hazards", "every hazard in one family") as caught:
        read_robustness_section(changed, "stability.yaml")
    assert str(caught.value.value) == f"ridges in {count} families"


def test_a_missing_setting_is_refused():
    with pytest.raises(InputError, match="severities"):
        read_robustness_section(
            {key: value for key, value in SETTINGS.items() if key != "severities"}, "stability.yaml"
        )


def test_all_hazards_and_the_defaults_of_every_solver_are_in_the_map():
    settings = read_robustness(ROOT / "config", Plan.read(ROOT / "config"))
    assert settings.hazards == list(HAZARDS)
    assert set(settings.solvers) == {*ALL, *ON_SURFACES, *ON_PATHS}
    assert settings.solvers["verlet"]["budget"] == make_solver("verlet").budget


def test_a_tier_changes_the_severities_and_a_config_without_the_map_has_none(tmp_path):
    for file in (ROOT / "config").glob("*.yaml"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    assert read_robustness(tmp_path, Plan.read(tmp_path, "quick")).severities == [0, 50, 100]
    assert read_robustness(tmp_path, Plan.read(tmp_path, "standard")).severities == list(range(0, 101, 5))
    (tmp_path / "stability.yaml").unlink()
    assert read_robustness(tmp_path, Plan.read(tmp_path, "standard")) is None
    with pytest.raises(InputError, match=r"quick\.stability"):
        read_robustness(tmp_path, Plan.read(tmp_path, "quick"))


def test_jobs_change_with_what_they_depend_on_and_nothing_else():
    plan = Plan.read(ROOT / "config", "quick")
    settings = read_robustness(ROOT / "config", plan)
    job, dataset_job = hazard_job(settings, "flat"), robustness_job(settings, plan)
    figure_job = robustness_figure_job(settings, plan)
    assert "flat" not in json.dumps(hazard_job(settings, "units"))
    other = replace(settings, caption="Other.")
    assert (job, dataset_job) == (hazard_job(other, "flat"), robustness_job(other, plan))
    assert figure_job != robustness_figure_job(other, plan)
    fewer = replace(settings, severities=[0.0])
    assert job != hazard_job(fewer, "flat")
    assert figure_job["data"] != robustness_figure_job(fewer, plan)["data"]


# --- the dataset and the figure -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """A small map: its files in a folder, and the surveys that it was made of."""
    folder = tmp_path_factory.mktemp("map")
    plan = Plan.read(ROOT / "config", "quick")
    hazards, severities = ["tension", "nearly_full_rough", "low_spike"], [0.0, 20.0, 100.0]
    settings = replace(read_robustness(ROOT / "config", plan), hazards=hazards, severities=severities)
    parts = []
    for hazard in hazards:
        dataset.write(survey_hazard(**json.loads(json.dumps(hazard_job(settings, hazard)))), folder / f"{hazard}.nc")
        parts.append(dataset.load_dataset(folder / f"{hazard}.nc"))
    job = robustness_job(settings, plan)
    data = dataset.stamp(merge_surveys(parts), job["settings"]["title"], job["settings"], job["source"])
    dataset.write(data, folder / "stability.nc")
    targets = {kind: f"{folder}/stability.{kind}" for kind in PICTURE_ENDINGS}
    data = dataset.load_dataset(folder / "stability.nc")
    write_figure(json.loads(json.dumps(robustness_figure_job(settings, plan))), [data], [], targets)
    return folder


def test_the_dataset_says_what_came_of_every_cell(drawn):
    data = dataset.load_dataset(drawn / "stability.nc")
    assert dict(data.sizes) == {"hazard": 3, "solver": 7, "severity": 3}
    assert data.hazard.values.tolist() == ["tension", "nearly_full_rough", "low_spike"]
    assert (data.outcome.sel(hazard="tension") == Outcome.REFUSED.value[0]).all()
    assert "nothing can pull" in str(data.reason.sel(hazard="tension")[0, 0].values)
    failed = data.sel(hazard="low_spike", solver="polonsky_keer", severity=20)
    assert failed.outcome == Outcome.FAILED.value[0]
    assert failed.transforms > 10_000
    assert "number of iterations" in str(failed.reason.values)
    assert data.applicable.sel(hazard="low_spike").values.tolist() == [1, 0, 0, 0, 0, 1, 1]
    surfaces_only = data.sel(solver="conjugate_gradients")
    assert (surfaces_only.outcome == Outcome.REFUSED.value[0]).all()
    data = data.sel(solver=["active_set", "polonsky_keer", "verlet"])
    spike = data.outcome.sel(hazard="low_spike")
    assert (spike.sel(severity=0) == Outcome.EXACT.value[0]).all()
    assert (spike.sel(severity=100) == Outcome.CERTIFIED.value[0]).all()
    right = data.sel(hazard="nearly_full_rough")
    assert (right.outcome == Outcome.EXACT.value[0]).all()
    assert (right.tolerance == 1e-8).all()


def test_everything_in_the_dataset_is_described(drawn):
    data = dataset.load_dataset(drawn / "stability.nc")
    for name in data.variables:
        assert data[name].attrs["units"] == "1", name
        assert RESULTS[name].long_name == data[name].attrs["long_name"], name
    meanings = data.outcome.attrs["flag_meanings"].split()
    assert dict(zip(meanings, data.outcome.attrs["flag_values"], strict=True)) == {
        outcome.name.lower(): outcome.value[0] for outcome in Outcome
    }
    assert dataset.settings_of(data)["tier"] == "quick"


def test_a_survey_made_again_is_the_same_byte_for_byte(drawn, tmp_path):
    data = dataset.load_dataset(drawn / "low_spike.nc")
    again = survey_hazard(**dataset.settings_of(data), source=data.attrs["source_digest"])
    dataset.write(again, tmp_path / "again.nc")
    assert (tmp_path / "again.nc").read_bytes() == (drawn / "low_spike.nc").read_bytes()


def test_the_table_of_the_map_has_a_row_for_each_cell(drawn):
    rows = pd.read_csv(drawn / "stability.csv")
    assert len(rows) == 63
    assert rows.outcome.value_counts()["refused"] == 45
    assert not rows.outcome.isin(["wrong", "non_finite"]).any()


def test_the_map_colours_its_cells_by_outcome_and_counts_what_must_not_occur(drawn):
    data = dataset.load_dataset(drawn / "stability.nc")
    data["outcome"][0, 0, 0], data["outcome"][0, 0, 1:] = Outcome.WRONG.value[0], Outcome.NON_FINITE.value[0]
    assert footer(data).endswith("1 wrong, 2 not finite")
    axes = Figure().subplots()
    stability(data, [axes])
    for mesh, hazard in zip(axes.collections, data.hazard.values, strict=True):
        outcomes = supported(data.sel(hazard=hazard)).outcome.values
        wanted = [to_rgba(list(COLOURS.values())[value]) for value in outcomes.ravel()]
        assert np.allclose(mesh.to_rgba(mesh.get_array()).reshape(-1, 4), wanted)


FAMILIES = [("spikes", ["low_spike"]), ("loads", ["tension", "nearly_full_rough"]), ("slides", ["fine_lattice"])]


def test_a_family_shows_its_worst_outcome_by_the_default_solver_and_how_often_there_is_no_answer(drawn):
    data = dataset.load_dataset(drawn / "stability.nc")
    axes = Figure().subplots()
    table = robustness(data, axes, FAMILIES)
    assert len(table) == 9
    assert set(table.solver) == {"active_set"}
    assert [text.get_text() for text in axes.get_yticklabels()] == ["spikes: 1 hazard", "loads: 2 hazards"]
    worst = axes.collections[0].get_array().reshape(2, 3)
    assert set(worst[1].tolist()) == {Outcome.REFUSED.value[0]}  # tension
    assert worst[0].max() < Outcome.REFUSED.value[0]
    assert [text.get_text() for text in axes.texts] == ["1", "1", "1"]
    assert axes.get_title(loc="left") == "9 cases, 0 wrong"


@pytest.mark.parametrize("outcome", [Outcome.WRONG, Outcome.NON_FINITE])
def test_one_wrong_answer_is_seen_in_its_family_and_counted(drawn, outcome):
    data = dataset.load_dataset(drawn / "stability.nc")
    data["outcome"].loc[{"hazard": "low_spike", "solver": "active_set", "severity": 20.0}] = outcome.value[0]
    axes = Figure().subplots()
    robustness(data, axes, FAMILIES)
    assert axes.collections[0].get_array().reshape(2, 3)[0, 1] == Outcome.WRONG.value[0]
    assert axes.get_title(loc="left") == "9 cases, 1 wrong"


def test_the_map_says_why_a_case_was_refused(drawn):
    data = dataset.load_dataset(drawn / "stability.nc")
    axes = Figure(figsize=(13, 8)).subplots()
    stability(data, [axes])
    texts = [text.get_text() for text in axes.texts]
    assert texts.count("without adhesion nothing can pull") == 3  # solvers that take lines


def test_solvers_of_the_other_dimension_are_left_out_and_counted(drawn):
    data = dataset.load_dataset(drawn / "stability.nc")
    assert "36 cells left out, whose solver does not take the kind of case ·" in footer(data)
    one = data.sel(hazard="low_spike")
    assert supported(one).solver.values.tolist() == ["active_set", "polonsky_keer", "verlet"]
    alone = one.sel(solver=["conjugate_gradients"])
    assert supported(alone).solver.values.tolist() == ["conjugate_gradients"]


def test_a_run_of_cells_refused_for_one_reason_is_told_once(drawn):
    one = dataset.load_dataset(drawn / "stability.nc").sel(hazard="nearly_full_rough")
    one = one.sel(solver=["active_set", "polonsky_keer", "verlet"])
    refused = Outcome.REFUSED.value[0]
    one["outcome"].values[:2] = [[refused, refused, 0], [refused, 0, refused]]
    one["reason"].values[:2] = [["a: b", "c: b", ""], ["b", "", "c"]]
    assert refusals(one) == [{(0, 2): "b"}, {(0, 1): "b", (2, 3): "c"}, {}]


def test_the_short_reason_of_a_trait_is_what_the_solver_does_not_take():
    verdict = judge(replace(CASE, mean_pressure=None, approach=0.0), "verlet")
    assert short_reason(verdict.reason) == "takes no approach"
