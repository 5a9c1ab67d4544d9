"""Results of baselines that the package contains are those of the standard tier, equal to what a solver gives anew."""

from __future__ import annotations

import json
import os
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml

from contactsim import dataset
from contactsim.errors import InputError
from contactsim.evaluation.work_precision import baselines, case_config, cases
from contactsim.evaluation.work_precision.baselines import Baseline, load_baseline, measured_dates, write_baselines
from contactsim.provenance import digest
from contactsim.solvers.registry import is_installed
from contactsim.study.plan import Plan
from support.places import CONFIG

PLAN = Plan.read(CONFIG, "standard")
CASES = case_config.read_cases(CONFIG, PLAN)
SECTIONS = yaml.safe_load((CONFIG / "accuracy.yaml").read_text(encoding="utf-8"))
PEERS = {"tamaas"}  # not measured where it is not installed
KEPT = [(case.name, solver) for case in CASES.values() for solver in case.baselines if solver not in PEERS]


def read_case(folder, name, **changes):
    """One case of the standard tier with changes, which takes its baselines from the package."""
    content = {"standard": {name: SECTIONS["standard"][name] | changes}, "baselines_from_package": ["standard"]}
    (folder / "accuracy.yaml").write_text(yaml.safe_dump(content))
    return case_config.read_cases(folder, PLAN)[name]


def write_job(folder, case, data, seconds):
    """The two files of a measured baseline, with the settings of the case."""
    settings = CASES[case.case].job_settings(case.solver)
    dataset.write(dataset.stamp(data.copy(), "accuracy", settings, "source"), folder / "job.nc")
    (folder / "job.json").write_text(json.dumps({"seconds": seconds, "transform_seconds": case.transform_seconds}))
    return folder / "job.nc", folder / "job.json"


@pytest.mark.parametrize(("case", "solver"), KEPT)
def test_the_package_contains_the_baselines_of_the_standard_tier(case, solver):
    # Fails where accuracy.yaml or a study was edited without `snakemake export_baselines`.
    assert load_baseline(case, solver).settings == digest(CASES[case].job_settings(solver))
    assert load_baseline(case, solver).data.setting.size == len(CASES[case].settings_of(solver))


def test_the_standard_tier_measures_references_and_the_studies_own_solvers_and_no_kept_one():
    for case in CASES.values():
        own = [cases.REFERENCE, case.default]
        assert case.jobs() == own + [name for name in PEERS if name in case.baselines and is_installed(name)]
        assert [job for job in case.shown_jobs() if job not in case.jobs()] == list(case.kept)


@pytest.mark.parametrize("tier", ["quick", "full"])
def test_other_tiers_measure_every_solver(tier):
    for case in case_config.read_cases(CONFIG, Plan.read(CONFIG, tier)).values():
        assert case.kept == {}
        assert case.jobs() == case.shown_jobs()


@pytest.mark.parametrize(("case", "solver"), KEPT)
def test_tables_give_back_every_bit_of_the_results(tmp_path, case, solver):
    kept = load_baseline(case, solver)
    read = Baseline.from_files(*write_job(tmp_path, kept, kept.data, kept.seconds))
    xr.testing.assert_identical(read.data, kept.data)
    write_baselines([replace(read, measured=kept.measured)], tmp_path / "baselines.csv")
    again = load_baseline(case, solver, tmp_path / "baselines.csv")
    xr.testing.assert_identical(again.data, kept.data)
    assert {name: item.dtype for name, item in again.data.variables.items()} == {
        name: item.dtype for name, item in kept.data.variables.items()
    }
    assert replace(again, data=None) == replace(kept, data=None)


def test_values_that_are_missing_infinite_or_long_are_given_back(tmp_path):
    kept = load_baseline("cylinder", "verlet")
    values = kept.data.kappa_r.copy()
    values[0, 0, :4] = [np.nan, np.inf, 0.1 + 0.2, 5e-324]
    odd = replace(kept, data=kept.data.assign(kappa_r=values), settings="12345678901234e5")
    write_baselines([odd, load_baseline("cylinder", "polonsky_keer")], tmp_path / "baselines.csv")
    again = load_baseline("cylinder", "verlet", tmp_path / "baselines.csv")
    xr.testing.assert_identical(again.data, odd.data)
    assert again.settings == odd.settings


@pytest.mark.parametrize(
    ("changes", "measured"),
    [
        ({}, []),
        ({"title": "Other words", "levels": {"points": [0.01]}}, []),
        ({"load": [0.05, 0.1]}, ["polonsky_keer", "verlet"]),
        ({"quantities": ["kappa_r"]}, ["polonsky_keer", "verlet"]),
        ({"settled": {"points": 4096, "tolerance": 1.0e-4}}, ["polonsky_keer", "verlet"]),
        ({"members": 2}, ["polonsky_keer", "verlet"]),
        ({"verlet": {"points": [512]}}, ["verlet"]),
        ({"active_set": {"points": [512]}}, []),
    ],
)
def test_a_solver_whose_settings_differ_from_those_of_the_tables_is_measured(tmp_path, changes, measured):
    solvers = {name: knobs for name, knobs in SECTIONS["standard"]["cylinder"]["solvers"].items() if name not in PEERS}
    solvers |= {name: changes.pop(name) for name in list(changes) if name in solvers}
    case = read_case(tmp_path, "cylinder", solvers=solvers, **changes)
    assert case.jobs() == ["reference", "active_set", *measured]
    assert case.shown_jobs() == ["reference", *solvers]


def test_a_case_of_another_name_is_measured(tmp_path):
    (tmp_path / "accuracy.yaml").write_text(
        yaml.safe_dump({"standard": {"pipe": SECTIONS["standard"]["cylinder"]}, "baselines_from_package": ["standard"]})
    )
    assert case_config.read_cases(tmp_path, PLAN)["pipe"].kept == {}


@pytest.mark.parametrize(
    "value", [["other"], [], "standard", True, ["standard", "standard"], ["baselines_from_package"]]
)
def test_tiers_that_do_not_exist_are_refused(tmp_path, value):
    content = {"standard": {}, "baselines_from_package": value}
    (tmp_path / "accuracy.yaml").write_text(yaml.safe_dump(content))
    with pytest.raises(InputError, match="a list from standard") as caught:
        case_config.read_cases(tmp_path, PLAN)
    assert caught.value.key == "baselines_from_package"
    assert str(tmp_path / "accuracy.yaml") in str(caught.value)


def test_the_figure_of_a_case_depends_on_what_is_kept():
    tiers = {PLAN.tier: PLAN}
    case = CASES["sphere"]
    kept = case_config.case_figure_job(case, PLAN, tiers)
    assert kept["kept"] == {"polonsky_keer": load_baseline("sphere", "polonsky_keer").measured}
    assert kept["jobs"] == ["reference", "conjugate_gradients", "polonsky_keer"]
    assert len(kept["digests"]) == 2


@pytest.mark.parametrize(
    ("case", "solver", "points"), [("cylinder", "polonsky_keer", 512), ("sphere", "polonsky_keer", 128)]
)
def test_a_kept_setting_that_is_solved_anew_has_the_same_transforms_and_quantities(tmp_path, case, solver, points):
    solvers = {name: {"points": [points]} for name in (CASES[case].default, solver)}
    one = read_case(tmp_path, case, repeats=1, solvers=solvers)
    data, _ = one.measure(solver)
    kept = load_baseline(case, solver).data
    place = int(np.flatnonzero((kept.knob == "points") & (kept.points == points))[0])
    np.testing.assert_array_equal(data.transforms[0], kept.transforms[place])
    np.testing.assert_array_equal(data.status[0], kept.status[place])
    for name in one.settings.quantities:
        np.testing.assert_allclose(data[name][0], kept[name][place], rtol=1e-9)


def test_seconds_count_in_the_time_of_a_transform_here():
    kept = load_baseline("cylinder", "verlet")
    assert kept.scaled_seconds(kept.transform_seconds) == pytest.approx(kept.seconds)
    assert kept.scaled_seconds(kept.transform_seconds * 3) == pytest.approx([3 * seconds for seconds in kept.seconds])


def test_the_date_of_a_measurement_is_that_of_its_costs(tmp_path):
    kept = load_baseline("cylinder", "verlet")
    data, costs = write_job(tmp_path, kept, kept.data, kept.seconds)
    os.utime(costs, (10.5 * 86400, 10.5 * 86400))
    assert Baseline.from_files(data, costs).measured == "1970-01-11"


def test_tables_name_their_jobs_once_and_hold_no_others():
    jobs = [(row["case"], row["solver"]) for row in pd.read_csv(baselines.FILE).to_dict("records")]
    assert sorted(jobs) == sorted(set(jobs))
    assert set(KEPT) <= set(jobs)
    tables = {file.stem for file in baselines.table_file("any").parent.glob("*")}
    assert tables == {case for case, _ in jobs}


def test_a_case_without_results_in_the_tables_has_no_dates(tmp_path):
    write_baselines([load_baseline("sphere", "polonsky_keer")], tmp_path / "baselines.csv")
    assert measured_dates(CASES["cylinder"], tmp_path / "baselines.csv") == {}
    assert set(measured_dates(CASES["sphere"], tmp_path / "baselines.csv")) == {"polonsky_keer"}
