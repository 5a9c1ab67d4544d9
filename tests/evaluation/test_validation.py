"""Accuracy on trial, relations measured anew, and the figures of both."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest

from contactsim import dataset
from contactsim.error_control.scaling import FAMILIES, Family, features
from contactsim.error_control.solution import relative_difference
from contactsim.errors import InputError
from contactsim.evaluation.calibration import fit
from contactsim.evaluation.calibration.population import KIND_NAMES, draw_scene
from contactsim.evaluation.calibration.settings import read_trials, trial_job, trials_figure_job
from contactsim.evaluation.calibration.trial import Trial, judge, run_trial
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
from support.cases import refused
from support.places import ROOT

QUICK = {"trial": {"scenes": 2}, "errors": [0.05], "kinds": ["waves", "rough_line", "adhesive_cylinder"]}
SETTINGS = read_trials(ROOT / "config", QUICK, "quick")


def trial(kind: str, count: int) -> Trial:
    """A trial as a job of the workflow reads it."""
    job = json.loads(canonical(trial_job(SETTINGS, SETTINGS.trial, "trial", kind, count)))
    return Trial(**job["settings"])


@pytest.fixture(scope="module")
def tried() -> dict[str, tuple]:
    """Trials of two lines and an asperity."""
    return {
        f"{kind}_{count}": run_trial(trial(kind, count))
        for kind, count in (("rough_line", 0), ("rough_line", 1), ("adhesive_cylinder", 0))
    }


@pytest.mark.parametrize("kind", KIND_NAMES)
def test_drawn_scenes_are_the_same_each_time_and_differ_by_seed_and_number(kind):
    scene = draw_scene(3, kind, 0)
    assert scene == draw_scene(3, kind, 0)
    assert scene not in (draw_scene(4, kind, 0), draw_scene(3, kind, 1))


def test_a_trial_is_judged_by_a_finer_run_and_against_the_cheapest_setting(tried):
    for data, spent in tried.values():
        assert data.requested_error.item() == 0.05
        assert 0 <= data.true_error.item() < 0.2
        assert data.covered.item() == int(data.true_error.item() <= data.predicted_error.item())
        assert spent["least"] > 0
        assert spent["predicted"] > 0


def test_the_cheapest_setting_is_within_the_error_and_no_cheaper_one_is():
    judged = judge(trial("rough_line", 0))
    least = judged.cheapest(0.05)
    assert judged.true_error(least) <= 0.05
    assert all(judged.true_error(run) > 0.05 for run in judged.settings if run.seconds < least.seconds)
    assert judged.cheapest(0.0) is None
    assert judged.reference.points > judged.result.last.points


def test_a_true_error_holds_what_a_finer_run_leaves_and_other_numbers_are_judged_too(tried):
    judged = judge(trial("rough_line", 0))
    run, reference = judged.result.last, judged.reference
    change = relative_difference(reference, run, "approach").max()
    assert judged.true_error(run, "approach") == pytest.approx(change / (1 - (run.points / reference.points) ** 1.5))
    data = tried["rough_line_0"][0]
    assert data.others.item() >= 3
    assert 0 <= data.covered_others.item() <= data.others.item()
    assert len(judged.covered(*reference.values)) == data.others.item() + 1


def test_a_trial_whose_cost_cannot_be_forecast_is_judged(tried, monkeypatch):
    def no_forecast(*_):
        raise InputError("pairing", "lattice", "facing points")

    monkeypatch.setattr("contactsim.evaluation.calibration.trial.forecast_to_error", no_forecast)
    data, spent = run_trial(trial("rough_line", 0))
    assert data.covered.item() == tried["rough_line_0"][0].covered.item()
    assert np.isnan(spent["predicted"])


def test_a_trial_is_the_same_each_time_but_for_what_follows_from_seconds(tried):
    again, _ = run_trial(trial("rough_line", 0))
    first, _ = tried["rough_line_0"]
    assert again.drop_vars("min_work_points").identical(first.drop_vars("min_work_points"))


def test_errors_are_asked_for_by_turns_and_calibration_has_other_scenes():
    settings = read_trials(ROOT / "config", {}, "standard")
    for kind in settings.kinds:
        asked = [Trial.draw(1, settings.errors, kind, count).requested_error for count in range(len(settings.errors))]
        assert sorted(asked) == sorted(settings.errors)
    assert settings.calibration.seed != settings.trial.seed
    assert len(settings.names(settings.trial)) >= 200
    assert SETTINGS.names(SETTINGS.trial)[:3] == ["waves_0", "waves_1", "rough_line_0"]


def test_the_figure_of_trials_tells_how_many_met_what_was_asked(tried, tmp_path):
    data, costs = [], []
    for name, (found, spent) in tried.items():
        dataset.write(dataset.stamp(found, "trial", {}, "source"), tmp_path / f"{name}.nc")
        (tmp_path / f"{name}.json").write_text(json.dumps(spent))
        data.append(str(tmp_path / f"{name}.nc"))
        costs.append(str(tmp_path / f"{name}.json"))
    targets = {kind: str(tmp_path / f"trials.{kind}") for kind in PICTURE_ENDINGS} | {"data": tmp_path / "all.nc"}
    plan = trials_figure_job(SETTINGS, "quick")
    trial_figure.write_trials(plan, data, costs, targets)
    table = pd.read_csv(targets["csv"])
    assert np.allclose(table.cost, table.seconds / table.least)
    text = trial_figure.footer_text(table, plan)
    assert f"{int(table.covered.sum())} of 3 stated errors" in text
    assert f"of {int(table.accuracy_reached.sum())} reached are within" in text


def test_what_is_measured_for_the_fit_has_works_and_ratios_and_is_fitted_to_the_form_of_the_package():
    tables = [fit.measure_scene(trial(kind, count)) for kind in ("waves", "adhesive_cylinder") for count in range(2)]
    table = pd.concat(tables, ignore_index=True)
    works, ratios = table.dropna(subset="family"), table.dropna(subset="ratio")
    assert (works.transforms > 0).all()
    assert (ratios.ratio >= 0).all()
    assert set(ratios.changes) <= {1, 2, 3}
    known = works.family.unique()
    found = {name: Family(**fit.fit_family(works, name)) for name in known}
    setup = trial("adhesive_cylinder", 0).setup.with_options(points=128)
    assert found["path_line"].work(features(setup)[0]) > 0
    assert set(known) < set(FAMILIES)


def test_coverage_factors_are_quantiles_by_the_number_of_changes():
    table = pd.DataFrame({"changes": np.repeat([1.0, 2.0, 3.0], 100), "ratio": np.tile(np.arange(1.0, 101.0), 3)})
    table.loc[table.changes == 3, "ratio"] /= 1000
    assert fit.coverage_factors(table) == pytest.approx([1.3 * 99.01, 1.3 * 0.09901], rel=1e-3)


@pytest.mark.parametrize(
    ("over", "key", "allowed"),
    [
        ({"kinds": ["moon"]}, "kinds", "some of rough_line"),
        ({"errors": [-1.0]}, "errors", "a list"),
        ({"trial": {"scenes": 0}}, "trial.scenes", "how many"),
    ],
)
def test_wrong_settings_of_trials_are_refused(over, key, allowed):
    with refused(key, allowed):
        read_trials(ROOT / "config", over, "quick")


def test_a_folder_without_these_files_has_neither_trials_nor_maps_nor_an_overview(tmp_path):
    assert read_trials(tmp_path, {}, "quick") is None
    assert map_settings.read_maps(tmp_path, {}, "quick") is None
    assert effect_cost.read_variants(tmp_path, 0, {}, "quick") is None
    assert case_config.read_overview(tmp_path) is None


READERS = {
    "stability": lambda file, over: read_robustness_section(*tiered(file, over, "quick")),
    "effects": lambda file, over: effect_cost.read_variants(file.parent, 0, over, "quick"),
    "trials": lambda file, over: read_trials(file.parent, over, "quick"),
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
