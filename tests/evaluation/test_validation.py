"""Accuracy on trial, relations measured anew, and the figures of both."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest

from contactsim import dataset
from contactsim.error_control.knobs import MAX_INCREMENTS
from contactsim.error_control.relations import build_relations
from contactsim.error_control.scaling import LINE, PATH
from contactsim.evaluation.calibration import fit, measurement, sampling, validation
from contactsim.evaluation.calibration.sampling import read_trials
from contactsim.evaluation.effects import effect_cost, map_settings, survey
from contactsim.evaluation.robustness.survey import read_robustness_section
from contactsim.evaluation.work_precision import case_config
from contactsim.figures.diagnostics import effect_maps as map_figure
from contactsim.figures.diagnostics import overview
from contactsim.figures.diagnostics import trials as trial_figure
from contactsim.provenance import canonical
from contactsim.study.figure_plan import PICTURE_ENDINGS
from contactsim.study.plan import Plan
from contactsim.study.tier_overrides import tiered
from contactsim.variables import RESULTS
from support.cases import refused
from support.places import ROOT

QUICK = {"trial": {"scenes": 2}, "errors": [0.05], "kinds": {"surface": None, "slide": None, "rough_path": None}}
SETTINGS = read_trials(ROOT / "config", QUICK, "quick")


def trial(kind: str, count: int) -> validation.Trial:
    """A trial as a job of the workflow reads it."""
    return validation.Trial.from_settings(json.loads(canonical(validation.trial_job(SETTINGS, kind, count))))


@pytest.fixture(scope="module")
def tried() -> dict[str, tuple]:
    """Trials of two lines and an asperity."""
    return {
        f"{kind}_{count}": validation.run_trial(trial(kind, count)) for kind, count in ((LINE, 0), (LINE, 1), (PATH, 0))
    }


def test_a_trial_is_judged_by_a_finer_run_and_against_the_cheapest_setting(tried):
    for data, spent in tried.values():
        assert data.requested_error.item() == 0.05
        assert 0 <= data.true_error.item() < 0.2
        assert data.min_work.item() > 0
        assert data.settings_within_error.item() <= data.settings_tried.item()
        assert spent["predicted"] > 0
        assert data.description.item()


def test_a_trial_is_the_same_each_time_but_for_its_seconds(tried):
    again, _ = validation.run_trial(trial(LINE, 0))
    assert again.identical(tried["line_0"][0])


def test_errors_are_asked_for_by_turns():
    settings = read_trials(ROOT / "config", {}, "standard")
    for kind in settings.kinds:
        asked = [validation.requested_error(settings.errors, kind, count) for count in range(len(settings.errors))]
        assert sorted(asked) == settings.errors
    jobs = [validation.trial_job(settings, LINE, count) for count in range(3)]
    errors = [validation.Trial.from_settings(job).requested_error for job in jobs]
    assert errors == [validation.requested_error(settings.errors, LINE, count) for count in range(3)]
    assert validation.trial_names(SETTINGS) == ["line_0", "line_1", "path_0", "path_1"]


def test_calibration_and_trial_have_different_scenes_of_the_same_ranges():
    settings = read_trials(ROOT / "config", {}, "standard")
    assert settings.calibration.seed != settings.trial.seed


def test_the_figure_of_trials_tells_how_many_met_what_was_asked(tried, tmp_path):
    data, costs = [], []
    for name, (found, spent) in tried.items():
        dataset.write(dataset.stamp(found, "trial", {}, "source"), tmp_path / f"{name}.nc")
        (tmp_path / f"{name}.json").write_text(json.dumps(spent))
        data.append(str(tmp_path / f"{name}.nc"))
        costs.append(str(tmp_path / f"{name}.json"))
    targets = {kind: str(tmp_path / f"trials.{kind}") for kind in PICTURE_ENDINGS} | {"data": tmp_path / "all.nc"}
    plan = validation.trials_figure_job(SETTINGS, "quick")
    trial_figure.write_trials(plan, data, costs, targets)
    table = pd.read_csv(targets["csv"])
    assert list(table.met) == list(table.true_error <= table.requested_error)
    assert np.allclose(table.cost, table.work / table.min_work)
    assert f"{int(table.met.sum())} of 3 scenes" in trial_figure.footer_text(table, plan)


def test_relations_measured_anew_have_the_form_of_the_packages():
    """Two scenes of each of two kinds: enough for the form, not for the values."""
    job = measurement.ScalingJob(LINE, SETTINGS.kinds[LINE], seed=5, scenes=2)
    table = measurement.measure_scaling(job)
    assert set(table.knob) == {"points", "tolerance", "warm_start"}
    found = build_relations(fit.fit_relations(table))
    law = found.families[LINE].errors["points"]["relative_contact_area_subgrid"]
    assert law.coefficients["grid"] == 2.0
    assert 0 < found.families[LINE].warm_start < 1.2
    assert "families:" in fit.format_relations(table)


@pytest.mark.parametrize("family", sorted(measurement.MEASURED_QUANTITIES))
def test_what_the_relations_are_of_is_a_number_of_results(family):
    assert set(measurement.MEASURED_QUANTITIES[family]) <= set(RESULTS)


@pytest.mark.parametrize("family", sorted(MAX_INCREMENTS))
def test_no_increment_is_longer_than_the_longest_that_was_measured(family):
    assert MAX_INCREMENTS[family] <= max(measurement.INCREMENTS[family])


def test_a_straight_line_through_logarithms_is_found_again():
    rng = np.random.default_rng(1)
    grid = rng.uniform(-4, -1, 60)
    rows = pd.DataFrame({"kind": PATH, "knob": "increment", "one": 1.0, "grid": grid})
    rows["error_a"] = np.exp(-1.0 + 1.5 * grid)
    law = fit.fit_power_law(rows, "error_a", ("one", "grid"), {})
    assert law.coefficients["grid"] == pytest.approx(1.5, rel=0.02)
    assert law.spread < 0.05
    assert fit.fit_power_law(rows[:3], "error_a", ("one", "grid"), {}) is None


def test_a_relation_gives_the_size_of_errors_that_scatter_and_not_their_middle():
    rng = np.random.default_rng(2)
    grid, noise = rng.uniform(-3, -2, 200), rng.normal(scale=0.8, size=200)
    rows = pd.DataFrame({"kind": PATH, "knob": "increment", "one": 1.0, "grid": grid})
    rows["error_a"] = np.exp(2 * grid + noise - 1.0)
    law = fit.fit_power_law(rows, "error_a", ("one", "grid"), {"grid": 2.0})
    sizes = rows.error_a / np.exp(law.coefficients["one"] + 2 * grid)
    assert np.sqrt(np.mean(sizes**2)) == pytest.approx(1.0, rel=1e-3)
    assert law.spread == pytest.approx(noise.std(), rel=1e-3)


@pytest.mark.parametrize(
    ("over", "key", "allowed"),
    [
        ({"kinds": {"moon": {}}}, "kinds.moon", "one of line"),
        ({"kinds": {"line": {"hurst_exponent": [0.5]}}}, "kinds.line.hurst_exponent", "a pair"),
        ({"errors": [-1.0]}, "errors", "a list"),
        ({"trial": {"scenes": 0}}, "trial.scenes", "how many"),
    ],
)
def test_wrong_settings_of_trials_are_refused(over, key, allowed):
    with refused(key, allowed):
        read_trials(ROOT / "config", over, "quick")


def test_a_folder_without_these_files_has_neither_trials_nor_maps_nor_an_overview(tmp_path):
    assert sampling.read_trials(tmp_path, {}, "quick") is None
    assert map_settings.read_maps(tmp_path, {}, "quick") is None
    assert effect_cost.read_variants(tmp_path, 0, {}, "quick") is None
    assert case_config.read_overview(tmp_path) is None


READERS = {
    "stability": lambda file, over: read_robustness_section(*tiered(file, over, "quick")),
    "effects": lambda file, over: effect_cost.read_variants(file.parent, 0, over, "quick"),
    "trials": lambda file, over: sampling.read_trials(file.parent, over, "quick"),
    "effect_maps": lambda file, over: map_settings.read_maps(file.parent, over, "quick"),
}


@pytest.mark.parametrize("part", READERS)
def test_a_tier_cannot_change_what_has_no_file_and_is_named_where_it_is_wrong(tmp_path, part):
    with refused("title", "a line of text") as caught:
        READERS[part](ROOT / f"config/{part}.yaml", {"title": []})
    assert str(caught.value.file).endswith("tiers.yaml")
    assert f"{part}.yaml with tier quick of" in str(caught.value.file)
    with refused(f"quick.{part}", "left out, as there is no"):
        READERS[part](tmp_path / f"{part}.yaml", {"title": []})


def test_the_maps_are_drawn_with_their_conditions_and_their_numbers_kept(tmp_path):
    settings = map_settings.read_maps(ROOT / "config", {}, "standard")
    files = []
    for name, one in sorted(settings.maps.items()):
        shape = [len(axis.values) for axis in one.axes.values()]
        data = dataset.describe(survey.map_dataset(one, np.linspace(1e-4, 0.9, int(np.prod(shape))).reshape(shape)))
        files.append(str(tmp_path / f"{name}.nc"))
        dataset.write(dataset.stamp(data, name, {}, "source"), files[-1])
    targets = {kind: str(tmp_path / f"maps.{kind}") for kind in PICTURE_ENDINGS}
    map_figure.write_effect_maps(survey.maps_figure_job(settings, "quick"), files, targets)
    assert set(pd.read_csv(targets["csv"])["map"]) == set(settings.maps)


def test_the_overview_shows_every_case_and_leaves_ensembles_out(tmp_path):
    plan = Plan.read(ROOT / "config", "quick")
    cases = case_config.read_cases(ROOT / "config", plan)
    told = case_config.overview_figure_job(case_config.read_overview(ROOT / "config"), cases, "quick")
    tables = []
    for name, case in sorted(told["cases"].items()):
        rows = {
            "solver": ["newton"] * 3,
            "knob": ["points", "tolerance", "members"],
            case["quantity"]: [1e-2, 1e-3, 0.1],
        }
        rows |= {"work": [1.0, 2.0, 3.0], "seconds": [0.1, 0.2, 0.3], "unconverged": [0.0] * 3, "own": [True] * 3}
        tables.append(str(tmp_path / f"{name}.csv"))
        pd.DataFrame(rows).to_csv(tables[-1], index=False)
    targets = {kind: str(tmp_path / f"overview.{kind}") for kind in PICTURE_ENDINGS}
    overview.write_overview(told, tables, targets)
    shown = pd.read_csv(targets["csv"])
    assert set(shown.case) == set(cases)
    assert set(shown.knob) == {"points", "tolerance"}
