"""Forecasts of work, time and memory."""

from __future__ import annotations

import numpy as np
import pytest
import yaml

import contactsim as cs
from contactsim import cli, dataset
from contactsim.error_control.forecast import forecast_run, forecast_setup, forecast_to_error
from contactsim.error_control.ladder import solve_to_error
from contactsim.error_control.options import choose_options
from contactsim.error_control.scaling import FAMILIES, Family, cost_relations, features, run_family
from contactsim.evaluation.resources import predict_other_job, predict_run, summarise_jobs
from contactsim.paths.options import RunOptions, Setup
from contactsim.solvers.registry import make_solver
from support.cases import refused
from support.error_scenes import CYLINDER, LINE_SCENE, SCENES, setup_of, study


def test_a_relation_is_a_power_law():
    family = Family({"one": np.log(2.0), "size": 1.5}, {}, {"size": (0.0, 1.0)})
    assert family.work({"one": 1.0, "size": np.log(4.0)}) == pytest.approx(16.0)
    assert family.outside({"one": 1.0, "size": 2.0}) == ["size"]
    assert family.outside({"one": 1.0, "size": 0.5}) == []


@pytest.mark.parametrize("family", FAMILIES)
def test_every_family_has_relations_and_a_larger_grid_takes_more_time(family):
    assert cost_relations()[family].units["point"] > 0


@pytest.mark.parametrize("name", ["rough line", "free sphere", "load"])
def test_a_forecast_is_near_what_a_run_takes(name):
    setup = choose_options(Setup(SCENES[name]), 0.02)
    (run,) = [solve_to_error(Setup(SCENES[name]), 0.02)]
    forecast = forecast_setup(run.last.setup)
    assert 1 / 6 < forecast.transforms / run.last.transforms < 6
    assert forecast_to_error(Setup(SCENES[name]), 0.02).points == pytest.approx(3 * setup.points, rel=0.2)


def test_a_forecast_is_printed_in_words():
    text = str(cs.estimate_cost(CYLINDER, accuracy=0.01))
    heads = [line.split()[0] for line in text.splitlines()]
    assert heads[:5] == ["grid", "unknowns", "transforms", "time", "memory"]
    assert "e+" not in text


def test_a_forecast_says_what_it_does_not_know():
    setup = setup_of(LINE_SCENE)
    with refused("solver.kind", "were not measured"):
        forecast_setup(setup.with_options(solver=make_solver("polonsky_keer")))
    with refused("path", "walls at given approaches"):
        forecast_setup(
            Setup(
                cs.Scene(cs.HalfSpace(1.0), SCENES["wave"].upper, cs.HardWall(), cs.approaches([0.1])), RunOptions(64)
            )
        )
    wide = cs.Scene(cs.HalfSpace(1.0), cs.Sinusoid(1e5, 0.1, 20000), cs.HardWall(), cs.pressures([1e-6]))
    assert "waves" in forecast_setup(Setup(wide, RunOptions(60000))).unsure
    assert forecast_run(setup).transforms > forecast_setup(setup).transforms * 0.5


def test_the_shell_tells_the_cost_of_a_scene_and_runs_it_to_its_accuracy(tmp_path, capsys):
    file = tmp_path / "scene.yaml"
    file.write_text(yaml.safe_dump(LINE_SCENE))
    cli.main(["estimate", str(file)])
    out = capsys.readouterr().out
    assert "coarser runs before included" in out
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
    plain = {name: value for name, value in LINE_SCENE.items() if name != "accuracy"}
    other = study(plain, points=1024, tolerance=1e-3, solver={"kind": "polonsky_keer"}).runs()[0]
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
    for original, scaled in zip(*(features(setup) for setup in setups), strict=True):
        assert scaled == pytest.approx(original)


def test_the_expected_area_of_a_wave_at_a_light_load_follows_its_slope():
    wave = cs.Sinusoid(100.0, 0.5)
    load = 1e-4
    (numbers,) = features(Setup(cs.Scene(cs.HalfSpace(1.0), wave, cs.HardWall(), cs.pressures([load])), RunOptions(64)))
    slope = 2 * np.pi * 0.5 / 100.0 / np.sqrt(2)
    assert np.exp(numbers["area"]) == pytest.approx(1.75 * load / slope, rel=0.05)


def test_families_follow_kind_and_dimension():
    names = {name: run_family(scene) for name, scene in SCENES.items()}
    assert (names["rough line"], names["free sphere"]) == ("rough_wall_line", "wall_surface")
    assert (names["cylinder"], names["rough"], names["slide"]) == ("path_line", "path_surface", "slide")
