from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
import yaml

from contactsim.errors import InputError
from contactsim.evaluation.work_precision import case_config, cases, error_cost
from contactsim.paths.continuation import STATE_BUDGET
from contactsim.paths.jumps import FOLD_WIDTH
from contactsim.simulation import simulate
from contactsim.solvers import registry as solver_registry
from contactsim.status import Status
from contactsim.study.plan import Plan
from contactsim.study.study import Study
from support.places import ROOT
from support.prices import path_study, study

CASE = {
    "title": "Case",
    "caption": "What it shows.",
    "size": [8.0, 5.0],
    "study": "smooth_line",
    "load": [0.1, 0.2],
    "quantities": ["kappa_r", "relative_contact_area"],
    "settled": {"points": 512, "tolerance": 1.0e-4},
    "reference": {"points": 16384, "tolerance": 1.0e-8},
    "levels": {"points": [0.05], "tolerance": [0.1, 0.01]},
    "solvers": {
        "active_set": {"points": [256, 512, 1024], "tolerance": [10.0, 1.0e-2]},
        "polonsky_keer": {"points": [256], "tolerance": [1.0, 1.0e-2]},
    },
    "repeats": 2,
}
ASPERITY = {
    "title": "Asperity",
    "surface": {"kind": "cylinder", "radius": 25000.0, "length": 10000.0},
    "body": {"kind": "layer", "youngs_modulus": 70.0, "poisson_ratio": 0.3, "thickness": 5000.0},
    "effects": ["cohesive_zone"],
    "cohesive_zone": {"work_of_separation": 2.0, "work_ratio": 0.5},
    "path": {"approach": [-8.0, -4.0, -9.0], "increment": 0.1},  # into contact by a jump, and out of it
    "increments": {"kind": "adaptive"},
    "snapshots": [-5.0],
    "points": 64,
    "tolerance": 1.0e-3,
}
PATH_CASE = {name: CASE[name] for name in ("title", "caption", "size")} | {
    "study": "asperity",
    "quantities": ["pull_off_load_loading", "final_contact_length"],
    "thesis_increment": 0.02,
    "settled": {"points": 64, "tolerance": 1.0e-4, "increment": 0.5},
    "reference": {"points": 256, "tolerance": 1.0e-7, "increment": 0.05},
    "levels": {"increment": [0.01]},
    "solvers": {
        "newton": {"points": [64, 128], "tolerance": [1.0e-2], "increment": [1.0, 0.2]},
        "mass_weighted_verlet": {"increment": [1.0]},
    },
}
ROUGH_CASE = {
    "study": "rough_line",
    "load": [1e-3],
    "quantities": ["kappa_r"],
    "vary": {"surface.hurst_exponent": [0.8]},
    "settled": {"points": 8192, "tolerance": 1.0e-4},
    "reference": {"points": 32768, "tolerance": 1.0e-7},
    "solvers": {"active_set": {"points": [8192, 16384]}},
}
WALL_ON_A_PATH = ASPERITY | {
    "effects": ["hard_wall"],
    "body": {"kind": "half_space", "contact_modulus": 70.0},
    "path": {"approach": [0.0, 1.0], "increment": 0.5},
}
for _key in ("cohesive_zone", "increments", "snapshots"):
    del WALL_ON_A_PATH[_key]
PLAN = Plan.read(ROOT / "config", "quick")
OWN = {name: Study.read(name, own, "own.yaml", 1) for name, own in (("asperity", ASPERITY), ("wall", WALL_ON_A_PATH))}
PLAN = replace(PLAN, studies=PLAN.studies | OWN)


def case(tmp_path, base=CASE, **changes):
    (tmp_path / "accuracy.yaml").write_text(yaml.safe_dump({"quick": {"case": base | changes}}))
    return case_config.read_cases(tmp_path, PLAN)["case"]


@pytest.fixture(scope="module")
def followed(tmp_path_factory):
    one = case(tmp_path_factory.mktemp("path"), PATH_CASE)
    return one, {job: one.measure(job) for job in one.jobs()}


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    one = case(tmp_path_factory.mktemp("case"))
    return one, {job: one.measure(job) for job in one.jobs()}


def table_of(measured, made):
    one, jobs = measured
    study = xr.load_dataset(made / "results/quick/datasets/ch3_smooth_line.nc")
    return error_cost.error_table(
        one.settings.quantities, one.settings.load, {job: data for job, (data, _) in jobs.items()}, study, one.default
    )


def test_each_knob_is_turned_on_its_own_and_the_reference_is_on_no_curve(tmp_path):
    one = case(tmp_path)
    turned = one.settings_of("active_set")
    assert [(at.points, at.tolerance) for at in turned if at.knob == "points"] == [
        (256, 1e-4),
        (512, 1e-4),
        (1024, 1e-4),
    ]
    assert [(at.points, at.tolerance) for at in turned if at.knob == "tolerance"] == [(512, 10.0), (512, 1e-2)]
    assert not set(one.settings_of(cases.REFERENCE)) & {at for job in one.jobs()[1:] for at in one.settings_of(job)}


def test_errors_are_those_by_hand_and_fall_with_the_grid(measured, made):
    table = table_of(measured, made)
    grids = table[(table.knob == "points") & (table.solver == "active_set")]
    data, reference = measured[1]["active_set"][0], measured[1]["reference"][0]
    by_hand = np.sqrt(np.mean((data.kappa_r.values[0] / reference.kappa_r.values[0] - 1) ** 2))
    assert grids.kappa_r.iloc[0] == pytest.approx(by_hand)
    assert grids.kappa_r.iloc[-1] < 0.05  # a point at each edge of 100 to 50 points
    assert (grids.work.diff().dropna() > 0).all()
    assert (table.unconverged == 0).all()


def test_solvers_meet_the_same_error_on_the_same_grid(measured, made):
    table = table_of(measured, made)
    pair = table[(table.knob == "points") & (table.points == 256)]
    assert pair.solver.tolist() == ["active_set", "polonsky_keer"]
    assert pair.kappa_r.iloc[0] == pytest.approx(pair.kappa_r.iloc[1], rel=1e-6)


def test_a_tighter_tolerance_is_nearer_and_dearer(measured, made):
    table = table_of(measured, made)
    knob = table[(table.knob == "tolerance") & (table.solver == "polonsky_keer")]
    assert knob.relative_contact_area.iloc[1] < knob.relative_contact_area.iloc[0]
    assert knob.work.iloc[1] > knob.work.iloc[0]


def test_on_a_surface_the_study_s_own_solver_is_the_measure_and_work_counts_all_points(tmp_path):
    tests = {"points": [16], "tolerance": [1.0]}
    changes = {"study": "smooth_surface", "solvers": {"conjugate_gradients": tests, "polonsky_keer": tests}}
    settings = {"settled": {"points": 32, "tolerance": 1e-4}, "reference": {"points": 64, "tolerance": 1e-6}}
    one = case(tmp_path, **changes, **settings)
    jobs = {job: one.measure(job)[0] for job in one.jobs()}
    assert one.job_settings(cases.REFERENCE)["runs"][0]["solver"]["kind"] == "conjugate_gradients"
    assert jobs["polonsky_keer"].points_y.values.tolist() == [16, 32]
    data = jobs["polonsky_keer"].isel(setting=0)
    alone = study(members=1).rename(reduced_pressure="contact_ratio").assign_coords(contact_ratio=data.contact_ratio)
    table = (
        error_cost.error_table(one.settings.quantities, one.settings.load, jobs, alone.assign(length=1.0), one.default)
        .query("knob == 'points'")
        .set_index("solver")
    )
    assert table.work["polonsky_keer"] == data.transforms.sum() * 16**2
    assert table.own.to_dict() == {"conjugate_gradients": True, "polonsky_keer": False}
    assert table.kappa_r["polonsky_keer"] == pytest.approx(table.kappa_r["conjugate_gradients"], rel=1e-3)


def test_a_part_of_a_study_s_variants_is_measured_on_the_same_surfaces(tmp_path):
    one = case(tmp_path, **ROUGH_CASE)
    (run,) = one.study_at(one.settings_of("active_set")[0], "active_set").runs()
    whole = next(run for run in PLAN.studies["rough_line"].runs() if run.coordinates == {"hurst_exponent": 0.8})
    assert run.coordinates == {"hurst_exponent": 0.8}
    assert run.settings["surface"] == whole.settings["surface"]
    assert {run.settings[key] for key in ("seed", "study")} == {whole.settings[key] for key in ("seed", "study")}
    assert one.selection == {"hurst_exponent": [0.8]}


@pytest.mark.parametrize("name", ["figure", "taken", "a-b", ""])
def test_a_case_cannot_have_a_name_that_is_no_target_or_that_of_another(tmp_path, name):
    studies = PLAN.studies | {"accuracy_taken": PLAN.studies["smooth_line"]}
    plan = replace(PLAN, studies=studies, reserved_names=(*PLAN.reserved_names, "accuracy_figure"))
    (tmp_path / "accuracy.yaml").write_text(yaml.safe_dump({"quick": {name: CASE}}))
    with pytest.raises(InputError, match="letters, digits and underscores; with accuracy_ before it no") as caught:
        case_config.read_cases(tmp_path, plan)
    assert (caught.value.key, caught.value.value) == ("quick", name)


def test_each_knob_of_a_path_is_turned_on_its_own_and_has_its_own_reference(tmp_path):
    one = case(tmp_path, PATH_CASE)
    numbers = [(at.knob, at.points, at.tolerance, at.increment) for at in one.settings_of("newton")]
    assert numbers == [
        ("points", 64, 1e-4, 0.5),
        ("points", 128, 1e-4, 0.5),
        ("tolerance", 64, 1e-2, 0.5),
        ("increment", 64, 1e-4, 1.0),
        ("increment", 64, 1e-4, 0.2),
    ]
    numbers = [(at.knob, at.points, at.tolerance, at.increment) for at in one.settings_of(cases.REFERENCE)]
    assert numbers == [
        ("points", 256, 1e-7, 0.5),
        ("tolerance", 64, 1e-7, 0.5),
        ("increment", 64, 1e-4, 0.05),
    ]


def test_a_path_is_solved_at_every_increment_asked_for_whatever_the_study_does(tmp_path):
    one = case(tmp_path, PATH_CASE)
    settings = one.job_settings("newton")["runs"][0]
    assert settings["increments"] == {"kind": "requested", "fold_width": FOLD_WIDTH, "budget": STATE_BUDGET}
    assert settings["snapshots"] is None
    assert settings["load"] == {"name": "step", "control": "approach", "through": [-8.0, -4.0, -9.0], "increment": 0.5}
    assert one.job_settings("newton")["settings"]["load"] is None


def test_a_path_is_measured_whole(followed):
    one, jobs = followed
    data, seconds = jobs["newton"]
    assert dict(data.sizes) == {"setting": 5, "member": 1}
    assert len(seconds) == 5
    last = one.settings_of("newton")[-1]
    (run,) = one.study_at(last, "newton").runs()
    alone = simulate(run.setup.scene, points=64, tolerance=1e-4, solver="newton")
    assert alone.step.size == 45  # 4 nm there and 5 nm back, in increments of 0.2
    assert data.increment.values[-1] == 0.2
    assert data.transforms.values[-1, 0] == alone.transforms.sum()
    loading = alone.line_load.values[: int(np.argmax(alone.approach.values)) + 1]
    assert data.pull_off_load_loading.values[-1, 0] == -float(alone.fold_load_after[0]) > -loading.min()
    assert (data.status == 0).all()


def test_the_error_of_increments_is_that_by_hand_and_falls_with_them_and_flows_do_not_locate_the_jump(followed):
    one, jobs = followed
    jobs = {job: data for job, (data, _) in jobs.items()}
    table = error_cost.error_table(
        one.settings.quantities, one.settings.load, jobs, path_study([1.0]), one.default
    ).query("knob == 'increment'")
    by_hand = jobs["newton"].pull_off_load_loading.values[3:, 0] / jobs["reference"].pull_off_load_loading.values[2, 0]
    own = table[table.own]
    assert own.increment.tolist() == [1.0, 0.2]
    assert own.pull_off_load_loading.to_numpy() == pytest.approx(abs(by_hand - 1))
    assert own.pull_off_load_loading.iloc[1] < own.pull_off_load_loading.iloc[0]
    assert own.work.tolist() == (jobs["newton"].transforms.values[3:, 0] * 64).tolist()
    slow = table[table.solver == "mass_weighted_verlet"]
    assert slow.pull_off_load_loading.iloc[0] > 10 * own.pull_off_load_loading.iloc[0]


@pytest.mark.parametrize(("place", "share"), [(None, 0.0), (0, 1.0), (20, 1.0), (-1, 1.0)])
def test_a_path_with_any_step_that_did_not_converge_is_unconverged(tmp_path, monkeypatch, place, share):
    one = case(tmp_path, PATH_CASE, solvers={"newton": {"increment": [0.2]}})
    data = cases.simulate_run(one.study_at(one.settings_of("newton")[0], "newton").runs()[0])
    if place is not None:
        data["status"][place] = Status.MAX_ITERATIONS.value[0]
        data["status"][place:][1:] = Status.SKIPPED.value[0]
    monkeypatch.setattr(cases, "simulate_run", lambda run: data)
    found, _ = one.measure("newton")
    assert float(error_cost.unconverged_share(found)) == share
    assert found.status.item() == (0 if place is None else Status.MAX_ITERATIONS.value[0])


def test_seconds_are_apart_and_the_dataset_is_reproducible(measured):
    one, jobs = measured
    data, seconds = jobs["polonsky_keer"]
    assert len(seconds) == data.setting.size == 3
    assert "seconds" not in data
    xr.testing.assert_identical(one.measure("polonsky_keer")[0], data)


@pytest.mark.parametrize(("spent", "best"), [([3.0, 1.0, 2.0], 1.0), ([1.0, 2.0, 3.0], 1.0), ([9.0, 1.0, 1.0], 9.0)])
def test_the_best_of_the_timings_counts_and_a_long_one_is_the_only_one(tmp_path, monkeypatch, spent, best):
    one = case(tmp_path, repeats=3, solvers={"active_set": {"points": [256]}})
    run = one.study_at(one.settings_of("active_set")[0], "active_set").runs()[0]
    solved, left = cases.simulate_run(run), [*spent]

    def timed(run):
        return solved.assign(seconds=solved.seconds * 0 + left.pop(0) / solved.seconds.size)

    monkeypatch.setattr(cases, "simulate_run", timed)
    assert one.measure("active_set")[1] == pytest.approx([best])
    assert len(left) == (2 if best > cases.MAX_REPEATED_SECONDS else 0)


def test_a_peer_that_is_not_installed_is_left_out(tmp_path, monkeypatch):
    solvers = {"active_set": {"points": [256]}, "tamaas": {"points": [256]}}
    monkeypatch.setattr(solver_registry, "find_spec", lambda name: None)
    assert case(tmp_path, solvers=solvers).jobs() == ["reference", "active_set"]
    monkeypatch.setattr(solver_registry, "find_spec", lambda name: object())
    assert case(tmp_path, solvers=solvers).jobs() == ["reference", "active_set", "tamaas"]


def test_the_settings_of_a_peer_that_is_not_installed_are_checked_all_the_same(tmp_path, monkeypatch):
    monkeypatch.setattr(solver_registry, "find_spec", lambda name: None)
    with pytest.raises(InputError, match="more than 8190: two points per shortest wavelength") as caught:
        case(tmp_path, **ROUGH_CASE | {"solvers": ROUGH_CASE["solvers"] | {"tamaas": {"points": [64]}}})
    assert caught.value.key == "quick.case.solvers.tamaas.points"


NO_INCREMENTS = "loads are solved on their own, without increments"
SHORTEST = "more than 8190: two points per shortest wavelength"
ROUGH = {"study": "rough_line", "load": [1e-3]}


def assert_refused(folder, section, key, allowed):
    """A case is refused with its file, the key and what is allowed, in one line."""
    with pytest.raises(InputError) as caught:
        case(folder, section)
    assert caught.value.key == f"quick.case.{key}"
    assert allowed in caught.value.allowed
    assert str(folder / "accuracy.yaml") in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize(
    ("changes", "key", "allowed"),
    [
        ({"study": "no_line"}, "study", "smooth_line"),
        ({"quantities": ["happiness"]}, "quantities", "kappa_r"),
        ({"solvers": {"magic": {}}}, "solvers", "active_set"),
        ({"solvers": {"verlet": {"points": [16384]}}}, "solvers.verlet.points", "fewer than"),
        ({"settled": {"points": 512}}, "settled.tolerance", "missing"),
        ({"reference": {"points": 1, "tolerance": 1.0}}, "reference.points", "whole number"),
        ({"levels": {"members": [0.1]}}, "levels.members", "points"),
        ({"levels": {"points": [-0.1]}}, "levels.points", "relative errors"),
        ({"solvers": {"active_set": {}}}, "solvers.active_set", "points, or tolerance"),
        ({"solvers": {"verlet": {"points": [256]}}}, "solvers", "active_set"),
        ({"solvers": {"active_set": {"tolerance": [1e-8]}}}, "solvers.active_set.tolerance", "above the"),
        ({"settled": {"points": 16384, "tolerance": 1e-4}}, "settled.points", "fewer than"),
        ({"load": [0.11]}, "load", "0.15"),
        ({"quantities": ["kappa"]}, "quantities", "kappa_r"),
        ({"vary": {"surface.hurst_exponent": [0.8]}}, "vary.surface.hurst_exponent", "none"),
        (ROUGH | {"vary": {"surface.hurst_exponent": [0.3]}}, "vary.surface.hurst_exponent", "0.2, 0.5, 0.8"),
        (ROUGH | {"vary": {"surface.hurst_exponent": []}}, "vary.surface.hurst_exponent", "0.2, 0.5, 0.8"),
        ({"solvers": CASE["solvers"] | {"conjugate_gradients": {"points": [64]}}}, "solvers", "LINE"),
        ({"study": "smooth_surface"}, "solvers", "conjugate_gradients, the study's own"),
        (ROUGH_CASE | {"solvers": {"active_set": {"points": [8190, 16384]}}}, "solvers.active_set.points", SHORTEST),
        (ROUGH_CASE | {"settled": {"points": 8190, "tolerance": 1e-4}}, "settled.points", SHORTEST),
        ({"repeats": 0}, "repeats", "1 or more"),
        ({"thesis_members": 0}, "thesis_members", "1 or more"),
        ({"speed": 1}, "speed", "no such key"),
        ({"settled": CASE["settled"] | {"increment": 0.1}}, "settled.increment", NO_INCREMENTS),
        ({"reference": CASE["reference"] | {"increment": 0.1}}, "reference.increment", NO_INCREMENTS),
        ({"levels": {"increment": [0.1]}}, "levels.increment", NO_INCREMENTS),
        ({"solvers": {"verlet": {"increment": [1.0]}}}, "solvers.verlet.increment", NO_INCREMENTS),
        ({"thesis_increment": 0.02}, "thesis_increment", NO_INCREMENTS),
        ({"load": None}, "load", "a list of the study's loads"),
        ({"quantities": ["final_load"]}, "quantities", "the study's own: relative_contact_area"),
        ({"study": "wall"}, "study", "a path of smooth laws"),
    ],
)
def test_a_bad_case_is_refused_with_file_key_value_and_what_is_allowed(tmp_path, changes, key, allowed):
    assert_refused(tmp_path, CASE | changes, key, allowed)


@pytest.mark.parametrize(
    ("changes", "key", "allowed"),
    [
        ({"load": [0.1]}, "load", "a path, which is priced whole"),
        ({"quantities": ["kappa_r"]}, "quantities", "the study's own: pull_off_load_loading"),
        ({"settled": {"points": 64, "tolerance": 1e-4}}, "settled.increment", "missing"),
        ({"settled": PATH_CASE["settled"] | {"increment": 0.0}}, "settled.increment", "a positive number"),
        ({"settled": PATH_CASE["settled"] | {"increment": "0.1"}}, "settled.increment", "text to YAML"),
        ({"settled": PATH_CASE["settled"] | {"increment": 0.05}}, "settled.increment", "above the reference"),
        ({"solvers": {"newton": {"increment": [0.01]}}}, "solvers.newton.increment", "reference's, 0.05"),
        ({"solvers": {"newton": {"tolerance": [1.0]}}}, "solvers.newton.tolerance", "at most 0.1"),
        ({"solvers": {"newton": {"increment": [-1.0]}}}, "solvers.newton.increment", "list of increments"),
        ({"solvers": {"newton": {"increment": 1.0}}}, "solvers.newton.increment", "list of increments"),
        ({"solvers": {"newton": {}}}, "solvers.newton", "points, or tolerance, or increment"),
        ({"levels": {"increment": [-0.1]}}, "levels.increment", "relative errors"),
        ({"thesis_increment": -0.02}, "thesis_increment", "a positive number"),
        (
            {"solvers": PATH_CASE["solvers"] | {"energy_minimisation": {"points": [64]}}},
            *("solvers", "NON_CONSERVATIVE"),
        ),
        ({"solvers": {"mass_weighted_verlet": {"points": [64]}}}, "solvers", "newton, the study's own"),
    ],
)
def test_a_bad_case_of_a_path_is_refused_likewise(tmp_path, changes, key, allowed):
    assert_refused(tmp_path, PATH_CASE | changes, key, allowed)


def test_the_marks_of_a_path_are_increments_that_are_solved_as_asked_for():
    one = case_config.read_cases(ROOT / "config", PLAN)["adhesive_asperity"]
    tiers = case_config.read_all_tiers(ROOT / "config", PLAN)
    assert tiers["quick"] is PLAN
    found = case_config.case_figure_job(one, PLAN, tiers)
    marks = found["marks"]
    assert {name: own.get("increment") for name, own in marks.items()} == {
        "quick": None,  # they adapt
        "standard": 0.02,
        "full": 0.01,
        "thesis": 0.02,
    }
    assert marks["thesis"]["points"] == 2048
    assert found["units"] == {"increment": "nm"}
    assert found["loads"] == {}


def test_an_increment_of_a_pressure_is_in_its_unit(tmp_path):
    path = {"path": {"mean_pressure": [-0.01, 0.1], "increment": 0.01}, "snapshots": [0.1]}
    pressed = ASPERITY | path | {"increments": {"kind": "requested"}}
    study = Study.read("asperity", pressed, "own.yaml", 1)
    one = case(tmp_path, PATH_CASE)
    assert one.kind.units(study) == {"increment": "GPa"}


def test_the_real_cases_can_be_read_at_every_tier_and_mark_what_the_tiers_and_the_thesis_use():
    tiers = case_config.read_all_tiers(ROOT / "config", PLAN)
    for plan in tiers.values():
        every_case = case_config.read_cases(ROOT / "config", plan)
        assert "conjugate_gradients" in {case.default for case in every_case.values()}
        marks = case_config.case_figure_job(every_case["rough_line"], plan, tiers)["marks"]
        studies = {tier: other.studies["rough_line"].settings for tier, other in tiers.items()}
        for key in ("points", "members", "tolerance"):
            assert {tier: marks[tier][key] for tier in tiers} == {tier: own[key] for tier, own in studies.items()}
        assert marks["thesis"]["points"] == studies["standard"]["thesis_points"]
        assert "tolerance" not in marks["thesis"]
        assert "members" not in case_config.case_figure_job(every_case["cylinder"], plan, tiers)["marks"]["thesis"]
