"""Error-controlled runs: grid and increments follow, a coarser run confirms them, and a grid too coarse is refined."""

from __future__ import annotations

import logging
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

import contactsim as cs
from contactsim import cli, dataset
from contactsim.error_control import control, grids, knobs, options
from contactsim.error_control.control import MAX_REFINEMENTS, Controlled, solve_to_error
from contactsim.error_control.estimates import estimate_errors
from contactsim.error_control.forecast import forecast_run, forecast_setup, forecast_to_error
from contactsim.error_control.grids import GRID_FACTORS, MIN_POINTS, round_grid
from contactsim.error_control.options import choose_options, coarsen, expect_error
from contactsim.error_control.relations import Relation, scaling_relations
from contactsim.error_control.scaling import (
    FAMILIES,
    LINE,
    PATH,
    QUANTITIES,
    ROUGH_PATH,
    SLIDE,
    SURFACE,
    features,
    scene_family,
)
from contactsim.error_control.solution import Solution, solve_setup
from contactsim.errors import InputError
from contactsim.evaluation.calibration.sampling import draw_scene, read_trials
from contactsim.evaluation.resources import predict_other_job, predict_run, summarise_jobs
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.options import Setup
from contactsim.solvers.registry import make_solver
from contactsim.study import execute_to_accuracy
from contactsim.study.execute import RunFiles
from contactsim.study.run import Run
from contactsim.study.study import Study
from support.cases import refused
from support.places import ROOT

DRAWS = read_trials(ROOT / "config", {}, "standard")
LINE_SCENE = {
    "surface": {
        "kind": "self_affine",
        "hurst_exponent": 0.8,
        "length": 1024.0,
        "long_cutoff": 256.0,
        "short_cutoff": 8.0,
        "rms_gradient": 0.1,
    },
    "body": {"kind": "half_space", "contact_modulus": 1.0},
    "effects": ["hard_wall"],
    "load": {"reduced_pressure": [0.02, 0.1]},
    "accuracy": 0.02,
}
ASPERITY = {
    "surface": {"kind": "cylinder", "radius": 10000.0, "length": 4000.0},
    "body": {"kind": "layer", "youngs_modulus": 70.0, "poisson_ratio": 0.3, "thickness": 2000.0},
    "effects": ["cohesive_zone"],
    "cohesive_zone": {"work_of_separation": 1.0},
    "path": {"approach": [-6.0, 5.0]},
    "accuracy": 0.03,
}


def study(section: dict, **more: object) -> Study:
    return Study.read("one", {"title": "One"} | section | more, "file", 1)


def setup_of(section: dict, **more: object) -> Setup:
    return study(section, **more).runs()[0].setup


def drawn(family: str, count: int = 0) -> Run:
    return draw_scene(family, DRAWS.kinds[family], 4, count)


def test_a_relation_is_a_power_law_with_its_scatter():
    law = Relation({"one": np.log(2.0), "grid": 1.5}, 0.1)
    assert law({"one": 1.0, "grid": np.log(4.0)}) == pytest.approx(16.0)
    assert law({"one": 1.0, "grid": 0.0}, 2.0) == pytest.approx(2 * np.exp(0.2))


@pytest.mark.parametrize("family", FAMILIES)
def test_every_family_has_relations_and_errors_fall_with_the_grid(family):
    relations = scaling_relations().families[family]
    assert set(QUANTITIES[family]) <= set(relations.errors["points"])
    assert all(relation.coefficients["grid"] >= 1 for relation in relations.errors["points"].values())
    assert relations.seconds["step"] > 0
    assert 0 < relations.warm_start <= 1.5


@pytest.mark.parametrize("family", FAMILIES)
def test_drawn_scenes_are_of_their_family_the_same_each_time_and_within_their_ranges(family):
    first, again, other = drawn(family), drawn(family), drawn(family, 1)
    assert first.settings == again.settings
    assert first.settings != other.settings
    assert scene_family(first.setup.scene) == family
    if "hurst_exponent" in first.settings["surface"]:
        low, high = DRAWS.kinds[family].hurst_exponent
        assert low <= first.settings["surface"]["hurst_exponent"] <= high


@pytest.mark.parametrize("wanted", [1, MIN_POINTS, 33, 100, 1000, 4097, 10**6])
def test_grids_are_short_products_of_a_few_primes_and_never_too_small(wanted):
    points = round_grid(wanted)
    assert points >= max(wanted, MIN_POINTS)
    assert points <= 1.3 * max(wanted, MIN_POINTS)
    powers = [points // factor for factor in GRID_FACTORS if points % factor == 0]
    assert any(power & (power - 1) == 0 for power in powers)


@pytest.mark.parametrize("family", [LINE, SURFACE, PATH])
def test_a_quarter_of_the_error_takes_twice_the_points_where_errors_are_of_second_order(family):
    coarse, fine = (choose_options(drawn(family, 1).setup, error).points for error in (0.02, 0.005))
    assert fine / coarse == pytest.approx(2.0, rel=0.25)


def test_increments_are_at_most_as_much_shorter_as_the_error_is_smaller():
    setup = setup_of(ASPERITY)
    coarse, fine = (choose_options(setup, error).scene.path.increment for error in (0.02, 0.005))
    assert 1 <= coarse / fine <= 4.1  # two digits
    assert fine > 0.05  # of 1 nm, the law's length: relations that a fit gave no power had asked for 0.0003


@pytest.mark.parametrize("family", [PATH, ROUGH_PATH, SLIDE])
def test_the_expected_error_of_a_path_is_within_the_requested_one_and_that_of_its_coarse_run_is_larger(family):
    for error in (0.01, 0.05):
        setup = choose_options(drawn(family).setup, error)
        relations = scaling_relations().families[family]
        for name in QUANTITIES[family]:
            expected = expect_error(setup, relations, name)
            assert expected < 1.3 * error
            assert expect_error(coarsen(setup), relations, name) > expected


def test_the_choice_does_not_depend_on_the_grid_and_increments_that_a_run_has():
    setup = drawn(PATH).setup
    other = setup.with_options(points=512, tolerance=1e-7).with_increment(0.37)
    assert other != setup
    assert choose_options(other, 0.02) == choose_options(setup, 0.02)


def test_what_was_not_measured_is_refused():
    with refused("accuracy.quantities", "relative_contact_area"):
        study(LINE_SCENE, accuracy={"error": 0.1, "quantities": ["pull_off_load_loading"]})
    with refused("accuracy", "grid points are enough"):
        study(LINE_SCENE, accuracy=1e-16)
    with refused("path", "needs loads above zero"):
        study({name: value for name, value in LINE_SCENE.items() if name != "load"}, path={"approach": [0.0, 1.0]})


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("points", 256),
        ("tolerance", 1e-3),
        ("coarse_grid", {"points": 64, "members": 1}),
        ("tight_tolerance", {"tolerance": 1e-9, "members": 1}),
        ("increments", {"kind": "adaptive"}),
        ("vary", {"points": [64, 128]}),
        ("path", {"approach": [-6.0, 5.0], "increment": 0.1}),
    ],
)
def test_what_follows_from_an_accuracy_cannot_be_given(key, value):
    whole = {"vary": "vary.points", "path": "path.increment"}.get(key, key)
    with refused(whole, "follows from the accuracy"):
        study(ASPERITY, **{key: value})


@pytest.mark.parametrize("value", [0.0, 1.0, -1.0, "fine", {"quantities": []}, {"error": 0.1, "off": []}])
def test_an_accuracy_is_a_relative_error(value):
    with pytest.raises(InputError, match="accuracy"):
        study(LINE_SCENE, accuracy=value)


def test_without_an_accuracy_tolerance_and_increments_are_required():
    plain = {name: value for name, value in ASPERITY.items() if name != "accuracy"} | {"points": 64}
    with refused("tolerance", "the key is missing"):
        study(plain, path={"approach": [-6.0, 5.0], "increment": 0.1})
    with refused("path.increment", "the key is missing"):
        study(plain, tolerance=1e-3)


def true_error(result: Controlled, factor: int) -> float:
    """Return the error against a grid that many times finer."""
    setup = result.last.setup.with_options(points=result.last.points * factor, tolerance=1e-6)
    if setup.options.increments is not None:
        setup = setup.with_options(increments=Adaptive())
    reference = solve_setup(setup, tuple(result.errors))
    return max(float(np.max(np.abs(result.last.values[name] / reference.values[name] - 1))) for name in result.errors)


@pytest.mark.parametrize("error", [0.05, 0.01])
def test_a_rough_line_is_as_accurate_as_was_asked_for(error):
    result = solve_to_error(setup_of(LINE_SCENE), error)
    assert result.met
    assert true_error(result, 8) <= error
    assert result.last.points > 2 * result.before[0].points


def test_an_adhesive_asperity_is_as_accurate_as_was_asked_for():
    result = solve_to_error(setup_of(ASPERITY), 0.03)
    assert result.met
    assert true_error(result, 4) <= 0.03
    assert set(result.errors) == set(QUANTITIES[PATH])


CYLINDER = cs.Scene(
    cs.HalfSpace(1.0),
    cs.Cylinder(8000.0, 1e4),
    cs.NormalCohesiveZone(work_of_separation=0.05, normal_length=0.5),
    cs.approaches([-9.0, 8.0], 0.1),
)


def test_a_dataset_holds_each_quantity_beside_its_error_and_warns_of_the_run_that_counts_alone(caplog):
    with caplog.at_level(logging.WARNING):
        data = cs.simulate(CYLINDER, accuracy=0.1)
    for name in QUANTITIES[PATH]:
        assert data[f"{name}_estimated_error"] <= 0.1 * abs(data[name])
    assert data.final_contact_length == pytest.approx(float(data.contact_length[-1]), rel=1e-12)
    (warning,) = caplog.messages
    assert f"up to {float(data.process_zone_step.max()):.2g} " in warning


def test_a_quantity_that_a_path_does_not_have_is_left_out_or_refused_if_it_was_asked_for():
    pressed = replace(CYLINDER, path=cs.approaches([4.0, 8.0], 0.1))  # in contact from the beginning
    data = cs.simulate(pressed, accuracy=0.1)
    assert "final_contact_length_estimated_error" in data
    assert "pull_off_load_loading_estimated_error" not in data
    with refused("accuracy.quantities", "does not come so far, or does not turn back"):
        cs.simulate(pressed, accuracy=0.1, quantities=["pull_off_load_loading"])


SLIDES = {
    "weak, on a half-space": (cs.HalfSpace(80.0, 0.35), 1.2, 4000.0, 5.0, 0.02),
    "on a thin layer": (cs.Layer(80.0, 0.35, 2000.0), 0.8, 4000.0, 5.0, 0.02),
    "of a small contact": (cs.HalfSpace(100.0, 0.3), 3.0, 2500.0, 0.0, 0.01),
}
"""Elastic body, work of separation, radius, depth and wanted error of slides beyond those that were measured."""


@pytest.mark.parametrize("name", SLIDES)
def test_a_slide_beyond_all_that_was_measured_is_as_accurate_as_was_asked_for(name):
    body, work, radius, depth, error = SLIDES[name]
    path = cs.approaches([-2.0, depth], 0.5) >> cs.sliding([0.0, 10.0], 0.5, approach=depth)
    scene = cs.Scene(body, cs.Cylinder(4 * radius, radius), cs.CohesiveZone(work, 0.8, 1.0, 1.0), path)
    result = solve_to_error(Setup(scene), error)
    last = result.last.setup.with_options(tolerance=1e-5)
    finer = solve_setup(last.with_increment(0.02, pressing=0.5).with_options(points=2 * last.points), QUANTITIES[SLIDE])
    assert result.met
    assert result.last.values["static_friction"] == pytest.approx(finer.values["static_friction"], rel=error)


def a_slide(work: float = 3.0, length: float = 10.0) -> cs.Scene:
    """A cylinder with a small contact that slides."""
    law = cs.CohesiveZone(work, 0.8, 1.0, 1.0)
    path = cs.approaches([-2.0, 0.0], 0.5) >> cs.sliding([0.0, length], 0.5, approach=0.0)
    return cs.Scene(cs.HalfSpace(100.0, 0.3), cs.Cylinder(10000.0, 2500.0), law, path)


def test_of_a_slide_whose_states_are_too_far_apart_the_increments_alone_are_refined(monkeypatch):
    monkeypatch.setattr(knobs, "PEAK_INCREMENTS", {SLIDE: 10.0})
    result = solve_to_error(Setup(a_slide(work=0.5)), 0.02)
    coarsest, coarse, first, second, *_ = [*result.before, result.last]
    assert coarsest.points < coarse.points < first.points == second.points
    assert second.setup.scene.path.increment < first.setup.scene.path.increment
    assert result.companion.points < result.last.points  # a run on the same grid would tell nothing of it


def test_a_slide_that_ends_before_its_onset_has_no_static_friction_to_be_reached():
    with refused("accuracy.quantities", "does not come so far"):
        solve_to_error(Setup(a_slide(length=0.5)), 0.02)


def test_a_run_is_refined_twice_at_most(monkeypatch):
    monkeypatch.setattr(Controlled, "met", property(lambda self: False))
    result = solve_to_error(drawn(LINE, 1).setup, 0.05)
    assert result.refinements == len(result.before) - 1 == MAX_REFINEMENTS


def test_on_the_largest_grid_what_was_solved_is_kept_and_is_not_said_to_be_accurate(monkeypatch):
    setup = setup_of(LINE_SCENE)
    first = solve_to_error(setup, 0.02).last.points
    monkeypatch.setattr(grids, "MAX_POINTS", first)
    monkeypatch.setattr(control, "estimate_errors", lambda *found: {"kappa": np.array([0.2, 0.1])})
    result = solve_to_error(setup, 0.02)
    assert (result.last.points, result.refinements, result.met) == (first, 0, False)


def test_where_neither_of_two_runs_is_solved_nothing_is_refined(monkeypatch):
    monkeypatch.setattr(Solution, "solved", property(lambda self: False))
    result = solve_to_error(setup_of(ASPERITY), 0.05)
    assert not result.met
    assert result.refinements == 0


@pytest.mark.parametrize("family", [LINE, SURFACE])
def test_a_run_that_begins_from_its_coarse_run_takes_fewer_transforms_to_the_same_contact(family):
    names = QUANTITIES[family]
    setup = choose_options(drawn(family, 2 if family == LINE else 1).setup, 0.05).with_options(tolerance=1e-4)
    coarse = solve_setup(coarsen(setup).with_options(keep=("fields",)), names)
    warm, cold = solve_setup(setup, names, coarse), solve_setup(setup, names)
    assert warm.transforms < cold.transforms
    assert warm.values[names[0]] == pytest.approx(cold.values[names[0]], rel=2e-3)


def run_to_accuracy(run: Run, folder: Path, name: str = "run") -> Path:
    """Compute a run of a study into a folder; return the file of its dataset."""
    files = RunFiles(folder / f"{name}.nc", folder / f"{name}.json")
    execute_to_accuracy.run(run.settings, "source", files)
    return files.data


def test_a_grid_that_was_too_coarse_is_refined_and_an_error_that_is_still_too_large_is_reported(
    monkeypatch, caplog, tmp_path
):
    true = scaling_relations()
    line = true.families[LINE]
    hopeful = {
        knob: {
            name: Relation(relation.coefficients | {"one": relation.coefficients["one"] - 4}, relation.spread)
            for name, relation in relations.items()
        }
        for knob, relations in line.errors.items()
    }
    wrong = replace(true, families=true.families | {LINE: replace(line, errors=hopeful)})
    run = study(LINE_SCENE).runs()[0]
    for module in (control, options):
        monkeypatch.setattr(module, "scaling_relations", lambda: wrong)
    result = solve_to_error(run.setup, 0.005)
    assert len(result.before) == 2
    assert result.last.points > result.before[1].points > result.before[0].points
    assert result.data.refinements == 1
    assert bool(result.data.accuracy_reached) == result.met
    monkeypatch.setattr(Controlled, "met", property(lambda self: False))
    with caplog.at_level(logging.WARNING):
        file = run_to_accuracy(run, tmp_path)
    assert "is not reached" in caplog.text
    assert dataset.load_dataset(file).accuracy_reached == 0


def test_a_run_stores_its_estimate_what_it_was_asked_for_and_all_that_it_cost(tmp_path):
    run = study(LINE_SCENE).runs()[0]
    file = run_to_accuracy(run, tmp_path)
    data = dataset.load_dataset(file)
    assert data.accuracy == 0.02
    assert data.accuracy_reached == 1
    assert data.relative_contact_area_subgrid_estimated_error.dims == ("reduced_pressure",)
    assert (data.relative_contact_area_subgrid_estimated_error <= 0.02 * data.relative_contact_area_subgrid).all()
    assert data.coarse_run_points < data.points
    assert data.coarse_run_transforms > 0
    assert dataset.settings_of(data)["points"] == data.points
    assert run_to_accuracy(run, tmp_path, "again").read_bytes() == file.read_bytes()


def test_the_error_of_a_quantity_that_only_one_of_two_runs_has_is_unknown():
    name = "pull_off_load_loading"
    solution = solve_setup(setup_of(ASPERITY).with_options(tolerance=1e-4), QUANTITIES[PATH])
    without = replace(solution, values=solution.values | {name: np.array([np.nan])})
    relations = scaling_relations().families[PATH]
    assert np.isinf(estimate_errors(solution, [without], relations, [name])[name])
    assert estimate_errors(without, [without], relations, [name])[name] == expect_error(solution.setup, relations, name)


def test_each_variant_gets_the_grid_that_its_own_scene_needs():
    runs = study(LINE_SCENE, vary={"surface.short_cutoff": [8.0, 32.0]}).runs()
    points = {run.settings["surface"]["short_cutoff"]: run.settings["points"] for run in runs}
    assert points[8.0] > 3 * points[32.0]
    assert all(run.settings["accuracy"] == {"error": 0.02, "quantities": []} for run in runs)


@pytest.mark.parametrize("family", [LINE, PATH])
def test_a_forecast_is_near_what_a_run_takes(family):
    setup = drawn(family, 2).setup
    forecast, result = forecast_to_error(setup, 0.03), solve_to_error(setup, 0.03)
    spent = result.work * result.last.size
    assert 1 / 3 < forecast.transforms * forecast.points / spent < 3
    assert forecast.points == choose_options(setup, 0.03).points


def test_a_forecast_is_printed_in_words():
    text = str(cs.estimate_cost(CYLINDER, accuracy=0.01))
    heads = [line.split()[0] for line in text.splitlines()]
    assert heads[:6] == ["grid", "unknowns", "transforms", "time", "memory", "error"]
    assert "e+" not in text


def test_a_forecast_says_what_it_does_not_know():
    setup = setup_of(LINE_SCENE)
    with refused("solver.kind", "were not measured"):
        forecast_setup(setup.with_options(solver=make_solver("polonsky_keer")))
    light = setup_of(LINE_SCENE, load={"reduced_pressure": [1e-6]}, accuracy=0.3)
    assert "area" in forecast_setup(light).unsure
    assert forecast_run(setup).transforms > forecast_setup(setup).transforms * 0.5


def test_the_shell_tells_the_cost_of_a_scene_and_runs_it_to_its_accuracy(tmp_path, capsys):
    file = tmp_path / "scene.yaml"
    file.write_text(yaml.safe_dump(LINE_SCENE))
    cli.main(["estimate", str(file)])
    out = capsys.readouterr().out
    assert "a coarser run before included" in out
    assert "relative_contact_area_subgrid" in out
    cli.main(["run", str(file)])
    assert "relative_contact_area_subgrid to" in capsys.readouterr().out
    assert dataset.load_dataset(tmp_path / "scene.nc").accuracy_reached == 1
    plain = {name: value for name, value in LINE_SCENE.items() if name != "accuracy"}
    file.write_text(yaml.safe_dump(plain | {"points": 1024, "tolerance": 1e-3}))
    cli.main(["estimate", str(file)])
    assert "1024 points" in capsys.readouterr().out
    cli.main(["estimate", str(file), "--accuracy", "0.01"])
    assert "1024 points" not in capsys.readouterr().out
    with pytest.raises(SystemExit, match="accuracy"):
        cli.main(["estimate", str(file), "--accuracy", "2"])


def test_the_summary_of_jobs_ahead_says_what_is_unknown(tmp_path):
    known = study(LINE_SCENE).runs()[0]
    wave = {"kind": "sinusoid", "length": 100.0, "amplitude": 0.1}
    plain = {name: value for name, value in LINE_SCENE.items() if name != "accuracy"}
    other = study(plain, surface=wave, points=64, tolerance=1e-3).runs()[0]
    runs = [predict_run(run, "none.json") for run in (known, other)]
    text = summarise_jobs(runs, [predict_other_job(rule) for rule in ("aggregate", "solve_trial")], 2)
    assert "2 runs and 2 other jobs" in text
    assert "2 jobs of unknown time" in text
    (tmp_path / "costs.json").write_text('{"cpu_seconds_of_last_run": 7200}')
    assert "about 2 h" in summarise_jobs([predict_run(other, tmp_path / "costs.json")], [], 1)


def test_features_do_not_depend_on_units():
    surface = LINE_SCENE["surface"]
    lengths = ("length", "long_cutoff", "short_cutoff")
    larger = surface | {name: 10 * surface[name] for name in lengths}
    setups = setup_of(LINE_SCENE), setup_of(LINE_SCENE, surface=larger)
    for original, scaled in zip(*(features(setup.scene) for setup in setups), strict=True):
        assert scaled == pytest.approx(original)
