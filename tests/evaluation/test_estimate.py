from __future__ import annotations

import json

import pytest

from contactsim import cli
from contactsim.evaluation import estimate, resources
from contactsim.evaluation.robustness.survey import read_robustness
from contactsim.study.plan import Plan
from support.places import ROOT


@pytest.fixture(scope="module")
def plan():
    return Plan.read(ROOT / "config", "quick")


@pytest.fixture(autouse=True)
def nowhere(tmp_path, monkeypatch):
    """A folder without results: what runs took there would be known."""
    monkeypatch.chdir(tmp_path)


def first_run(plan, study):
    return plan.studies[study].runs()[0]


def test_figures_of_one_study_cost_the_same_each_and_once_in_all(plan):
    figures = estimate.figure_costs(plan, {})
    assert figures["fig_3_2"] == figures["fig_3_3"]
    studies = {study for figure in plan.figures.values() for study in figure.studies}
    studies |= {study for chapter in plan.claims for study in plan.claims_studies(chapter)}
    whole = estimate.total_cost(plan, {})
    assert whole.jobs == sum(len(plan.studies[study].runs()) for study in studies)
    assert whole.seconds < sum(cost.seconds for cost in figures.values())
    assert whole.megabytes == max(cost.megabytes for cost in figures.values())


def test_a_figure_costs_what_its_studies_cost_together(plan):
    figure = plan.figures["fig_3_5"]
    runs = [run for study in figure.studies for run in plan.studies[study].runs()]
    cost = estimate.figure_costs(plan, {})["fig_3_5"]
    assert (cost.jobs, cost.unknown) == (len(runs), 0)
    seconds = [
        resources.predict_seconds(run, "nothing") + resources.START_SECONDS for run in runs if plan.twin(run) is None
    ]
    assert cost.seconds == pytest.approx(sum(seconds), rel=1e-12)


def test_what_is_taken_over_from_another_run_costs_its_start_alone(plan):
    runs = plan.studies["rough_adhesive_auto"].runs()
    taken = [run for run in runs if plan.twin(run) is not None]
    assert taken
    assert estimate.Cost.of(taken, plan, {}).seconds == len(taken) * resources.START_SECONDS


@pytest.fixture
def unforecast(monkeypatch):
    """Flat probes without a forecast, as of a solver whose costs were not measured."""
    find = resources.find_forecast
    monkeypatch.setattr(resources, "find_forecast", lambda run: None if run.study == "flat" else find(run))


def test_what_is_not_known_is_told_and_not_counted_as_nothing(plan, unforecast):
    lines = {line.split("  ")[0]: line for line in estimate.cost_table(ROOT / "config", plan).splitlines()}
    assert estimate.figure_costs(plan, {})["fig_6_4"].unknown == estimate.figure_costs(plan, {})["fig_6_4"].jobs
    assert "unknown" in lines["fig_6_4"]
    assert "solves nothing" in lines["fig_2_2"]
    hazards = read_robustness(ROOT / "config", plan).hazards
    assert lines["stability"].split() == ["stability", str(len(hazards)), "unknown", "unknown"]
    assert {*plan.figures, "all runs, each once", "effects", "trials", "accuracy_cylinder"} <= set(lines)


def test_what_a_run_of_the_same_settings_took_at_another_tier_counts_where_nothing_is_forecast(plan, unforecast):
    full, standard = (Plan.read(ROOT / "config", tier) for tier in ("full", "standard"))
    run, other = first_run(full, "flat"), first_run(standard, "flat")
    assert run.settings == other.settings
    costs = standard.results / f"costs/runs/{other.stem}.json"
    costs.parent.mkdir(parents=True)
    costs.write_text(json.dumps({"cpu_seconds_of_last_run": 99.0, "peak_memory_of_last_run": 4321.0}))
    measured = estimate.find_measured_costs([plan, standard, full])
    assert list(measured.values()) == [costs]
    found = estimate.figure_costs(full, measured)["fig_6_4"]
    assert (found.unknown, found.seconds, found.megabytes) == (found.jobs - 1, 99.0 + resources.START_SECONDS, 4321.0)
    assert estimate.figure_costs(plan, measured)["fig_6_4"].unknown == estimate.figure_costs(plan, {})["fig_6_4"].jobs


def test_the_shell_tells_the_cost_of_every_figure(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    cli.main(["estimate", "--tier", "quick"])
    told = capsys.readouterr().out
    assert all(f"{name}  " in told for name in Plan.read("config", "quick").figures)
    with pytest.raises(SystemExit, match="--accuracy"):
        cli.main(["estimate", "--tier", "quick", "--accuracy", "0.1"])


def test_a_run_asks_for_more_than_is_forecast_and_for_as_much_again_with_each_attempt(plan, tmp_path):
    run = first_run(plan, "rough_surface")
    expected = resources.find_forecast(run)
    assert resources.request_memory(run, tmp_path) > expected.megabytes + 300
    assert 60 * resources.request_minutes(run, tmp_path) > 3 * expected.seconds
    for asked in (resources.request_memory, resources.request_minutes):
        assert isinstance(asked(run, tmp_path), int)
        assert asked(run, tmp_path, attempt=2) == 2 * asked(run, tmp_path)


def test_a_run_of_an_unknown_kind_asks_for_what_it_took_before(plan, tmp_path, unforecast):
    run, costs = first_run(plan, "flat"), tmp_path / "costs.json"
    assert resources.find_forecast(run) is None
    assert resources.request_minutes(run, costs) == resources.UNKNOWN_MINUTES
    assert resources.request_memory(run, costs) == resources.UNKNOWN_MEGABYTES
    costs.write_text(json.dumps({"cpu_seconds_of_last_run": 99.0, "peak_memory_of_last_run": 4321.0}))
    assert resources.request_minutes(run, costs) == 10
    assert resources.request_memory(run, costs) == 4400


def test_runs_share_a_job_of_a_cluster_only_where_they_are_short(plan, tmp_path):
    assert resources.is_short(first_run(plan, "smooth_line"), tmp_path)
    assert resources.is_short(first_run(plan, "flat"), tmp_path)
    full = Plan.read(ROOT / "config", "full")
    assert not resources.is_short(first_run(full, "surface_finest"), tmp_path)
