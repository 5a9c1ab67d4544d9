"""Error-controlled runs: finer and finer grids until the error that their changes tell is small enough."""

from __future__ import annotations

import logging
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

import contactsim as cs
from contactsim import cli, dataset
from contactsim.error_control import grids, ladder
from contactsim.error_control.grids import GRID_FACTORS, MIN_POINTS, POINTS_PER_WAVE, round_grid
from contactsim.error_control.ladder import FIELDS, MAX_RUNS, Controlled, solve_to_error, solve_with_errors
from contactsim.error_control.options import choose_options, coarser_setups, usual_quantities
from contactsim.error_control.solution import Solution, relative_difference, solve_setup
from contactsim.errors import InputError
from contactsim.paths.options import RunOptions, Setup
from contactsim.paths.requested import Requested
from contactsim.reference.hard_wall import cylinder_array_load
from contactsim.study import execute_to_accuracy
from contactsim.study.execute import RunFiles
from contactsim.study.run import Run
from support.cases import refused
from support.error_scenes import (
    ASPERITY,
    CYCLE,
    CYLINDER,
    LINE_SCENE,
    ROUGH,
    SCENES,
    SLIDE,
    SOFT,
    SPHERE,
    ZONE,
    study,
)


def reference_error(result: Controlled, refinement: float = 2.0) -> float:
    """Return the largest relative error against a finer grid, shorter increments and a tighter tolerance."""
    last = result.last.setup
    setup = last.with_options(points=round_grid(refinement * last.points), tolerance=0.1 * last.options.tolerance)
    if last.scene.path.increment is not None:
        setup = setup.with_increment(last.scene.path.increment / refinement)
    reference = solve_setup(setup, tuple(result.errors))
    return max(float(relative_difference(reference, result.last, name).max()) for name in result.errors)


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_is_as_accurate_as_was_asked_for_and_its_error_is_covered(name):
    result = solve_to_error(Setup(SCENES[name]), 0.05)
    assert result.met
    assert set() < set(result.errors) <= set(usual_quantities(SCENES[name]))
    error = reference_error(result, 3.0 if len(SCENES[name].lengths) == 1 else 1.5)
    assert error <= 0.05
    assert error <= 1.5 * ladder.largest_error(result.errors)  # covered in 95 of 100 cases, by this in all of these


@pytest.mark.parametrize("error", [0.05, 0.01, 0.002])
def test_the_stated_error_covers_the_distance_from_the_exact_contact_of_parallel_cylinders(error):
    """Of twelve contacts, all are within the error asked for, and at most two estimates are too small by chance."""
    radius, period, covered = 1e4, 1000.0, 0
    for half_width in np.linspace(60.0, 280.0, 12):
        load = float(cylinder_array_load(half_width, radius, period, 1.0)) / period
        scene = cs.Scene(SOFT, cs.Cylinder(period, radius), cs.HardWall(), cs.pressures([load]))
        result = solve_to_error(Setup(scene), error)
        (area,), (told,) = result.last.values["relative_contact_area_subgrid"], *result.errors.values()
        distance = abs(area / (2 * half_width / period) - 1)
        assert distance <= error
        covered += bool(distance <= told <= error)
    assert covered >= 10


def test_no_error_is_below_what_the_increments_leave_beside_an_extreme_though_all_runs_agree():
    result = solve_with_errors(Setup(SLIDE, RunOptions(512)).with_increment(1.0))
    (name,), last = result.errors, result.last
    alike = [replace(run, values=last.values) for run in (*result.before, last)]
    error = ladder.estimate_error(alike, name)
    assert error == pytest.approx(last.increment_errors[name] / last.values[name])
    assert error > 1e-3
    assert result.errors[name] >= error


def test_a_number_that_is_infinite_has_no_finite_error():
    scene = cs.Scene(SOFT, cs.Cylinder(1000.0, 1e4), cs.HardWall(), cs.pressures([0.01, 10.0]))
    setup = Setup(scene, RunOptions(64, keep=("stiffness",)))
    data = solve_with_errors(setup, ("contact_stiffness",)).data
    assert np.isinf(data.contact_stiffness.values[1])  # in full contact
    assert np.isinf(data.contact_stiffness_estimated_error.values[1])


def test_a_smaller_error_takes_a_finer_grid():
    loose, tight = (solve_to_error(Setup(SCENES["cylinder"]), error) for error in (0.05, 0.002))
    assert tight.last.points > loose.last.points
    assert tight.last.setup.scene.path.increment < loose.last.setup.scene.path.increment
    assert tight.last.setup.options.tolerance < loose.last.setup.options.tolerance


def test_the_choice_does_not_depend_on_the_grid_and_increments_that_a_run_has():
    setup = Setup(SCENES["cylinder"])
    other = setup.with_options(points=512, tolerance=1e-7).with_increment(0.37)
    assert choose_options(other, 0.02) == choose_options(setup, 0.02)


def test_coarser_runs_have_fewer_points_and_longer_increments_but_still_show_all_waves():
    setup = choose_options(Setup(SCENES["cylinder"]), 0.001)
    coarsest, coarse = coarser_setups(setup)
    assert coarsest.points < coarse.points < setup.points
    steps = [one.scene.path.increment * one.points for one in (coarsest, coarse, setup)]
    assert steps == pytest.approx(3 * [steps[0]], rel=0.15)
    waves = cs.Scene(SOFT, cs.Sinusoid(100.0, 0.1, 64), cs.HardWall(), cs.pressures([2e-3]))
    assert coarser_setups(choose_options(Setup(waves), 0.1))[0].points >= POINTS_PER_WAVE * 64
    with refused("points", "or more"):
        coarser_setups(Setup(waves, RunOptions(points=160)))


def test_every_increment_of_a_path_is_solved():
    assert choose_options(Setup(SCENES["sphere"]), 0.01).options.increments == Requested()
    assert choose_options(Setup(SCENES["wave"]), 0.01).options.increments is None


@pytest.mark.parametrize("wanted", [1, MIN_POINTS, 33, 100, 1000, 4097, 10**6])
def test_grids_are_short_products_of_a_few_primes_and_never_too_small(wanted):
    points = round_grid(wanted)
    assert points >= max(wanted, MIN_POINTS)
    assert points <= 1.3 * max(wanted, MIN_POINTS)
    powers = [points // factor for factor in GRID_FACTORS if points % factor == 0]
    assert any(power & (power - 1) == 0 for power in powers)


def test_what_was_not_measured_is_refused():
    with refused("quantities", "relative_contact_area"):
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


def test_a_dataset_holds_each_quantity_beside_its_error_and_warns_of_the_run_that_counts_alone(caplog):
    with caplog.at_level(logging.WARNING):
        data = cs.simulate(CYLINDER, accuracy=0.1)
    for name in usual_quantities(CYLINDER):
        assert data[f"{name}_estimated_error"] <= 0.1 * abs(data[name])
    assert data.final_contact_length == pytest.approx(float(data.contact_length[-1]), rel=1e-12)
    (warning,) = caplog.messages
    assert f"up to {float(data.process_zone_step.max()):.2g} " in warning


def test_a_quantity_that_a_path_does_not_show_is_missing_and_warned_of(caplog):
    pressed = replace(CYLINDER, path=cs.approaches([4.0, 8.0], 0.1))  # in contact from the beginning
    with caplog.at_level(logging.WARNING):
        data = cs.simulate(pressed, accuracy=0.1)
    assert "the path shows no pull_off_load_loading" in caplog.text
    assert data.accuracy_reached == 1  # of the length
    assert 0 < data.final_contact_length_estimated_error <= 0.1 * data.final_contact_length
    assert np.isnan([data.pull_off_load_loading, data.pull_off_load_loading_estimated_error]).all()
    with caplog.at_level(logging.WARNING):
        lonely = cs.simulate(pressed, accuracy=0.1, quantities=["pull_off_load_loading"])
    assert lonely.accuracy_reached == 0
    assert "is not reached" in caplog.text


def test_a_quantity_that_coarse_runs_lack_is_not_forgotten():
    """On two grids there is no jump into contact."""
    law, path = cs.NormalCohesiveZone(1.0, 1.0), cs.approaches([-3.0, 3.0, -10.0], 0.5)
    scene = cs.Scene(cs.HalfSpace(70.0), cs.Cylinder(400.0, 1000.0), law, path)
    result = solve_to_error(Setup(scene), 0.02)
    values = [float(run.values["pull_off_load_loading"][0]) for run in (*result.before, result.last)]
    assert np.isnan(values[0]) and np.isfinite(values[-1])
    assert result.errors["pull_off_load_loading"] <= 0.02 or not result.met


def test_a_slide_that_ends_before_its_onset_has_no_static_friction_to_be_reached():
    path = cs.approaches([-2.0, 5.0], 0.5) >> cs.sliding([0.0, 0.2], 0.1, approach=5.0)
    result = solve_to_error(Setup(replace(SLIDE, path=path)), 0.05)
    assert np.isnan(result.last.values["static_friction"]).all()
    assert not result.met


def test_a_gap_in_full_contact_is_told_by_the_tolerance_and_is_not_refined_for():
    wave = cs.Sinusoid(100.0, 0.5)
    scene = cs.Scene(SOFT, wave, cs.HardWall(), cs.pressures([2 * np.pi * 0.5 / 100]))  # twice the full contact's
    result = solve_to_error(Setup(scene), 0.01, ["mean_gap"])
    assert (result.met, result.refinements) == (True, 0)
    assert 0 < result.errors["mean_gap"] < 0.01
    assert result.data.mean_gap_estimated_error < 1e-4 * 0.5


def test_a_run_is_refined_until_there_were_enough_and_is_then_said_to_miss(monkeypatch, caplog):
    monkeypatch.setattr(ladder, "MAX_RUNS", 4)
    monkeypatch.setattr(ladder, "estimate_error", lambda runs, name: np.array([0.2, 0.1]))
    result = solve_to_error(Setup(SCENES["rough line"]), 0.1)
    assert (result.met, len(result.before), result.refinements) == (False, 3, 1)
    with caplog.at_level(logging.WARNING):
        data = cs.simulate(SCENES["rough line"], accuracy=0.1)
    assert "is not reached" in caplog.text
    assert data.accuracy_reached == 0
    assert MAX_RUNS > 4


def test_on_the_largest_grid_what_was_solved_is_kept_and_is_not_said_to_be_accurate(monkeypatch):
    setup = Setup(SCENES["rough line"])
    monkeypatch.setattr(grids, "MAX_POINTS", choose_options(setup, 1e-3).points)
    monkeypatch.setattr(ladder, "estimate_error", lambda runs, name: np.array([0.2, 0.1]))
    result = solve_to_error(setup, 1e-3)
    assert (result.last.points, result.refinements, result.met) == (grids.MAX_POINTS, 0, False)


def test_a_run_that_would_take_too_long_is_not_begun_and_what_was_solved_is_kept(monkeypatch):
    monkeypatch.setattr(ladder, "MAX_WORK", 1.0)
    monkeypatch.setattr(ladder, "estimate_error", lambda runs, name: np.array([0.2, 0.1]))
    result = solve_to_error(Setup(SCENES["rough line"]), 0.05)
    assert (result.met, len(result.before), result.refinements) == (False, 2, 0)


def test_where_neither_of_two_runs_is_solved_nothing_is_refined(monkeypatch):
    monkeypatch.setattr(Solution, "solved", property(lambda self: False))
    result = solve_to_error(Setup(SCENES["sphere"]), 0.05)
    assert not result.met
    assert (len(result.before), result.refinements) == (2, 0)


@pytest.mark.parametrize("name", ["rough line", "thin layer"])
def test_at_a_hard_wall_a_run_that_begins_from_a_coarser_one_takes_fewer_transforms_to_the_same_contact(name):
    names = usual_quantities(SCENES[name])
    setup = choose_options(Setup(SCENES[name]), 0.02).with_options(tolerance=1e-4, keep=("fields",))
    coarse = solve_setup(coarser_setups(setup)[-1], names)
    warm, cold = solve_setup(setup, names, coarse), solve_setup(setup, names)
    assert warm.transforms < cold.transforms
    assert warm.values[names[0]] == pytest.approx(cold.values[names[0]], rel=2e-3)


def test_fields_that_only_the_next_run_needs_are_not_kept_unless_they_are_asked_for():
    scene = SCENES["rough line"]
    plain, lean, full = (
        cs.simulate(scene, accuracy=0.1, keep=keep) for keep in (None, ["patches"], ["patches", "fields"])
    )
    assert not set(FIELDS) & set(plain)
    assert "contact_bits" in plain
    assert "contact_bits" not in lean
    assert set(FIELDS[:3]) <= set(full)
    assert full.patches.equals(lean.patches)


@pytest.mark.parametrize("name", ["rough line", "load", "cylinder"])
def test_errors_of_a_run_as_it_is_cover_the_true_ones(name):
    scene, first = SCENES[name], choose_options(Setup(SCENES[name]), 0.02)
    options = {"points": first.points, "tolerance": first.options.tolerance, "errors": True}
    data = cs.simulate(first.scene, **options)
    asked = solve_with_errors(first)
    assert "accuracy" not in data
    assert data.points == first.points
    assert [run.points for run in asked.before] == sorted(run.points for run in asked.before)
    true = reference_error(asked, 3.0 if len(scene.lengths) == 1 else 1.5)
    assert true <= ladder.largest_error(asked.errors)
    for value, error in asked.errors.items():
        sizes = np.atleast_1d(error * np.abs(asked.last.values[value]))
        assert np.atleast_1d(data[f"{value}_estimated_error"].values) == pytest.approx(sizes, nan_ok=True)


def test_errors_are_told_of_the_quantities_asked_for_and_none_without_them():
    scene = SCENES["rough line"]
    data = cs.simulate(scene, points=1024, errors=True, quantities=["mean_gap"])
    assert "mean_gap_estimated_error" in data
    assert not [name for name in cs.simulate(scene, points=1024) if str(name).endswith("_estimated_error")]
    with refused("quantities", "none without an accuracy or errors"):
        cs.simulate(scene, points=1024, quantities=["mean_gap"])


def run_to_accuracy(run: Run, folder: Path, name: str = "run") -> Path:
    """Compute a run of a study into a folder; return the file of its dataset."""
    files = RunFiles(folder / f"{name}.nc", folder / f"{name}.json")
    execute_to_accuracy.run(run.settings, "source", files)
    return files.data


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


def test_each_variant_gets_the_grid_that_its_own_scene_needs():
    runs = study(LINE_SCENE, vary={"surface.short_cutoff": [8.0, 32.0]}).runs()
    points = {run.settings["surface"]["short_cutoff"]: run.settings["points"] for run in runs}
    assert points[8.0] > 3 * points[32.0]
    assert all(run.settings["accuracy"] == {"error": 0.02, "quantities": []} for run in runs)


def test_any_number_of_a_path_may_be_asked_for_and_others_are_refused():
    result = solve_to_error(Setup(SCENES["sphere"]), 0.1, ["pull_off_force_unloading", "final_force"])
    assert set(result.errors) == {"pull_off_force_unloading", "final_force"}
    with refused("quantities", "final_contact_area"):
        choose_options(Setup(SCENES["sphere"]), 0.1, ["final_contact_length"])
    with refused("quantities", "final_contact_area"):
        choose_options(Setup(SCENES["sphere"]), 0.1, ["static_friction"])


def test_a_wall_pressed_by_approach_is_refused():
    with refused("path", "needs loads above zero"):
        cs.simulate(cs.Scene(SOFT, SPHERE, cs.HardWall(), CYCLE), accuracy=0.1)


def test_the_shell_runs_an_adhesive_sphere_to_its_accuracy(tmp_path, capsys):
    scene = {
        "surface": {"kind": "sphere", "radius": 2000.0, "length": 500.0},
        "body": {"kind": "half_space", "contact_modulus": 1.0},
        "effects": ["normal_cohesive_zone"],
        "normal_cohesive_zone": {"work_of_separation": 0.05},
        "path": {"approach": [-6.0, 2.0, -10.0], "origin": "first_touch"},
        "accuracy": 0.05,
    }
    file = tmp_path / "scene.yaml"
    file.write_text(yaml.safe_dump(scene))
    cli.main(["run", str(file)])
    assert "pull_off_force_loading to" in capsys.readouterr().out
    data = dataset.load_dataset(tmp_path / "scene.nc")
    assert data.accuracy_reached == 1
    assert data.pull_off_force_loading_estimated_error > 0
    cli.main(["estimate", str(file)])
    assert "coarser runs before included" in capsys.readouterr().out


@pytest.mark.parametrize("periods", [20, 64, 128])
def test_waves_of_any_number_are_seen_by_the_first_grid(periods):
    scene = cs.Scene(SOFT, cs.Sinusoid(100.0, 0.5 / periods, periods), cs.HardWall(), cs.pressures([2e-3, 8e-3]))
    result = solve_to_error(Setup(scene), 0.03)
    assert result.met
    assert result.before[0].points >= 2.5 * periods
    assert reference_error(result) <= 0.03


def test_what_unloading_shows_is_refused_of_a_path_that_does_not_turn_back(monkeypatch):
    monkeypatch.setattr(ladder, "solve_setup", None)  # before anything runs
    for name in ("pull_off_force_unloading", "dissipated_work"):
        with refused("quantities", "pull_off_force_loading"):
            solve_to_error(Setup(SCENES["rough"]), 0.1, [name])
    with refused("quantities", "static_friction"):
        solve_to_error(Setup(SLIDE), 0.1, ["slip_count"])


def test_a_load_that_has_no_equilibrium_is_not_sought_on_ever_finer_grids():
    result = solve_to_error(Setup(cs.Scene(SOFT, SPHERE, ZONE, cs.pressures([1e-4, -5e-2]))), 0.1)
    assert not result.met
    assert len(result.before) <= 2


def test_a_path_of_two_controls_is_refused():
    path = cs.approaches([-5.0, 2.0], 0.5) >> cs.pressures([1e-3, -2e-3], 1e-4)
    with refused("path", "one of them"):
        cs.simulate(cs.Scene(SOFT, SPHERE, ZONE, path), accuracy=0.1)
    with refused("quantities", "a list"):
        cs.simulate(SCENES["sphere"], accuracy=0.1, quantities="final_force")


@pytest.mark.parametrize("surface", [cs.Cylinder(500.0, 2000.0), SPHERE, ROUGH])
def test_a_load_of_zero_among_others_has_no_error(surface):
    result = solve_to_error(Setup(cs.Scene(SOFT, surface, cs.HardWall(), cs.pressures([0.0, 1e-3]))), 0.1)
    assert result.met
    assert result.last.values["relative_contact_area_subgrid"][0] == 0


def test_an_oblong_surface_has_points_on_its_shorter_side():
    scene = cs.Scene(SOFT, cs.Flat(100.0, 1.0, 10.0), cs.HardWall(), cs.pressures([1e-3]))
    assert min(scene.upper.surface.shape(choose_options(Setup(scene), 0.1).points)) >= 8


def test_large_runs_keep_no_fields_for_the_next_and_come_to_the_same(monkeypatch):
    setup = Setup(SCENES["rough line"])
    usual = solve_to_error(setup, 0.05)
    monkeypatch.setattr(ladder, "MAX_FIELDS", 0)
    lean = solve_to_error(setup, 0.05)
    assert lean.work > usual.work
    assert lean.last.points == usual.last.points
    for name, values in usual.last.values.items():
        assert lean.last.values[name] == pytest.approx(values, rel=5e-3)


def test_errors_are_not_told_of_nested_increments():
    with refused("increments", "Requested or Adaptive"):
        cs.simulate(CYLINDER, points=8192, errors=True, increments=cs.Nested([8.0]))
