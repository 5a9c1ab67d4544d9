"""An accuracy that is asked for: grid and increments follow, a companion confirms, and what is missed is refined."""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np
import pytest
import yaml

from contactsim import cli, dataset
from contactsim.error_control import control, scaling
from contactsim.error_control.control import outcome, reach
from contactsim.error_control.forecast import forecast, forecast_of, forecast_to
from contactsim.error_control.options import FEWEST, SIZES, at_least, chosen, coarser, left_open
from contactsim.error_control.scaling import (
    KINDS,
    LINE,
    MEASURES,
    PATH,
    ROUGH_PATH,
    SLIDE,
    SURFACE,
    Relation,
    features,
    kind_of,
)
from contactsim.errors import SceneError
from contactsim.evaluation.calibration.sampling import draw, read_draws
from contactsim.evaluation.resources import told
from contactsim.study.scenes import scene_of
from contactsim.study.study import Study
from support.cases import refused
from support.places import ROOT

DRAWS = read_draws(ROOT / "config", {}, "standard")
LINE_SCENE = {
    "surface": {
        "kind": "self_affine",
        "hurst": 0.8,
        "length": 1024.0,
        "rolloff_wavelength": 256.0,
        "shortest_wavelength": 8.0,
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


def settings_of(section: dict, **more: object) -> dict:
    return study(section, **more).runs()[0].settings


def drawn(kind: str, count: int = 0) -> dict:
    return draw(kind, DRAWS["kinds"][kind], 4, count).settings


def test_a_relation_is_a_power_law_with_its_scatter():
    law = Relation({"one": np.log(2.0), "grid": 1.5}, 0.1)
    assert law({"one": 1.0, "grid": np.log(4.0)}) == pytest.approx(16.0)
    assert law({"one": 1.0, "grid": 0.0}, 2.0) == pytest.approx(2 * np.exp(0.2))


@pytest.mark.parametrize("kind", KINDS)
def test_relations_are_known_of_every_kind_and_errors_fall_with_the_grid(kind):
    known = scaling.relations().kinds[kind]
    assert set(MEASURES[kind]) <= set(known.errors["points"])
    assert all(law.coefficients["grid"] >= 1 for law in known.errors["points"].values())
    assert known.seconds["step"] > 0
    assert 0 < known.begun <= 1.5


@pytest.mark.parametrize("kind", KINDS)
def test_drawn_scenes_are_of_their_kind_the_same_each_time_and_within_their_ranges(kind):
    one, again, other = drawn(kind), drawn(kind), drawn(kind, 1)
    assert one == again
    assert one != other
    assert kind_of(scene_of(one)) == kind
    if "hurst" in one["surface"]:
        assert DRAWS["kinds"][kind]["hurst"][0] <= one["surface"]["hurst"] <= DRAWS["kinds"][kind]["hurst"][1]


@pytest.mark.parametrize("wanted", [1, FEWEST, 33, 100, 1000, 4097, 10**6])
def test_grids_are_short_products_of_a_few_primes_and_never_too_small(wanted):
    found = at_least(wanted)
    assert found >= max(wanted, FEWEST)
    assert found <= 1.3 * max(wanted, FEWEST)
    assert any(found % size == 0 and (found // size) & (found // size - 1) == 0 for size in SIZES)


@pytest.mark.parametrize(("kind", "finer"), [(LINE, 2.0), (SURFACE, 2.0), (PATH, 2.0)])
def test_a_quarter_of_the_error_takes_twice_the_points_where_errors_are_of_second_order(kind, finer):
    coarse, fine = (chosen(drawn(kind, 1), error)["points"] for error in (0.02, 0.005))
    assert fine / coarse == pytest.approx(finer, rel=0.25)


@pytest.mark.parametrize("kind", [PATH, ROUGH_PATH, SLIDE])
def test_what_a_path_leaves_open_is_within_what_was_asked_for_and_its_companion_leaves_more(kind):
    for error in (0.01, 0.05):
        found = chosen(drawn(kind), error)
        known = scaling.relations().kinds[kind]
        for name in MEASURES[kind]:
            assert left_open(found, known, name) < 1.3 * error
            assert left_open(coarser(found), known, name) > left_open(found, known, name)


def test_the_choice_does_not_depend_on_the_grid_and_increments_that_a_run_has():
    run = drawn(PATH)
    other = run | {"points": 512, "tolerance": 1e-7, "load": run["load"] | {"increment": 0.37}}
    assert chosen(run, 0.02) == chosen(other, 0.02)


def test_what_was_not_measured_is_refused():
    wave = LINE_SCENE | {"surface": {"kind": "sinusoid", "length": 1.0, "amplitude": 0.1}}
    with refused("surface", "were not measured"):
        study(wave)
    with refused("accuracy.of", "relative_contact_area"):
        study(LINE_SCENE, accuracy={"error": 0.1, "of": ["pull_off_load_loading"]})
    with refused("accuracy", "grid points are enough"):
        study(LINE_SCENE, accuracy=1e-16)
    with refused("path", "loads"):
        study({name: value for name, value in LINE_SCENE.items() if name != "load"}, path={"approach": [0.0, 1.0]})


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("points", 256),
        ("tolerance", 1e-3),
        ("companion", {"points": 64, "members": 1}),
        ("tight", {"tolerance": 1e-9, "members": 1}),
        ("increments", {"kind": "adaptive"}),
        ("vary", {"points": [64, 128]}),
        ("path", {"approach": [-6.0, 5.0], "increment": 0.1}),
    ],
)
def test_what_follows_from_an_accuracy_cannot_be_given(key, value):
    whole = {"vary": "vary.points", "path": "path.increment"}.get(key, key)
    with refused(whole, "follows from the accuracy"):
        study(ASPERITY, **{key: value})


@pytest.mark.parametrize("value", [0.0, 1.0, -1.0, "fine", {"of": []}, {"error": 0.1, "off": []}])
def test_an_accuracy_is_a_relative_error(value):
    with pytest.raises(SceneError, match="accuracy"):
        study(LINE_SCENE, accuracy=value)


def test_without_an_accuracy_tolerance_and_increments_are_required():
    plain = {name: value for name, value in ASPERITY.items() if name != "accuracy"} | {"points": 64}
    with refused("tolerance", "the key is missing"):
        study(plain, path={"approach": [-6.0, 5.0], "increment": 0.1})
    with refused("path.increment", "the key is missing"):
        study(plain, tolerance=1e-3)


def true_error(found: control.Reached, factor: int) -> float:
    """Against a grid that many times finer."""
    settings = found.last.settings | {"points": found.last.points * factor, "tolerance": 1e-6}
    if "increments" in settings:
        settings["increments"] = {"kind": "adaptive"}
    reference = outcome(settings, tuple(found.errors))
    return max(float(np.max(np.abs(found.last.values[name] / reference.values[name] - 1))) for name in found.errors)


@pytest.mark.parametrize("error", [0.05, 0.01])
def test_a_rough_line_is_as_accurate_as_was_asked_for(error):
    found = reach(settings_of(LINE_SCENE), error)
    assert found.met
    assert true_error(found, 8) <= error
    assert found.last.points > 2 * found.before[0].points


def test_an_adhesive_asperity_is_as_accurate_as_was_asked_for():
    found = reach(settings_of(ASPERITY), 0.03)
    assert found.met
    assert true_error(found, 4) <= 0.03
    assert set(found.errors) == set(MEASURES[PATH])


@pytest.mark.parametrize("kind", [LINE, SURFACE])
def test_a_run_that_begins_from_its_companion_takes_fewer_transforms_to_the_same_contact(kind):
    run = chosen(drawn(kind, 2 if kind == LINE else 1), 0.05) | {"tolerance": 1e-4}
    before = outcome(coarser(run) | {"keep": ["fields"]}, MEASURES[kind])
    begun, alone = outcome(run, MEASURES[kind], 1, before), outcome(run, MEASURES[kind])
    assert begun.transforms < alone.transforms
    name = MEASURES[kind][0]
    assert begun.values[name] == pytest.approx(alone.values[name], rel=2e-3)


def test_a_grid_that_was_too_hopeful_is_refined_and_an_error_that_is_still_missed_is_told(
    monkeypatch, caplog, tmp_path
):
    true = scaling.relations()
    line = true.kinds[LINE]
    hopeful = {
        knob: {
            name: Relation(law.coefficients | {"one": law.coefficients["one"] - 4}, law.spread)
            for name, law in laws.items()
        }
        for knob, laws in line.errors.items()
    }
    wrong = replace(true, kinds=true.kinds | {LINE: replace(line, errors=hopeful)})
    monkeypatch.setattr(control, "relations", lambda: wrong)
    run = settings_of(LINE_SCENE)
    monkeypatch.setattr("contactsim.error_control.options.relations", lambda: wrong)
    found = reach(run, 0.005)
    assert len(found.before) == 2
    assert found.last.points > found.before[1].points > found.before[0].points
    assert found.data.refinements == 1
    assert bool(found.data.reached) == found.met
    monkeypatch.setattr(control.Reached, "met", property(lambda self: False))
    with caplog.at_level(logging.WARNING):
        control.run(run, "source", tmp_path / "a.nc", tmp_path / "a.json")
    assert "is not reached" in caplog.text
    assert dataset.read(tmp_path / "a.nc").reached == 0


def test_a_run_stores_its_estimate_what_it_was_asked_for_and_all_that_it_cost(tmp_path):
    run = settings_of(LINE_SCENE)
    control.run(run, "source", tmp_path / "a.nc", tmp_path / "a.json")
    data = dataset.read(tmp_path / "a.nc")
    assert data.accuracy == 0.02
    assert data.reached == 1
    assert data.relative_contact_area_subgrid_estimated_error.dims == ("reduced_pressure",)
    assert (data.relative_contact_area_subgrid_estimated_error <= 0.02 * data.relative_contact_area_subgrid).all()
    assert data.points_before < data.points
    assert data.transforms_before > 0
    again = tmp_path / "b.nc"
    control.run(run, "source", again, tmp_path / "b.json")
    assert again.read_bytes() == (tmp_path / "a.nc").read_bytes()


def test_a_quantity_that_only_one_of_two_runs_has_is_of_no_known_error():
    settings = settings_of(ASPERITY)
    one = outcome(settings | {"tolerance": 1e-4}, MEASURES[PATH])
    lost = replace(one, values=one.values | {"pull_off_load_loading": np.array([np.nan])})
    known = scaling.relations().kinds[PATH]
    assert np.isinf(control.estimated(one, lost, known, ["pull_off_load_loading"])["pull_off_load_loading"])
    both = control.estimated(lost, lost, known, ["pull_off_load_loading"])["pull_off_load_loading"]
    assert both == control._expected(lost, known, "pull_off_load_loading")


def test_each_variant_gets_the_grid_that_its_own_scene_needs():
    runs = study(LINE_SCENE, vary={"surface.shortest_wavelength": [8.0, 32.0]}).runs()
    points = {run.settings["surface"]["shortest_wavelength"]: run.settings["points"] for run in runs}
    assert points[8.0] > 3 * points[32.0]
    assert all(run.settings["accuracy"] == {"error": 0.02, "of": []} for run in runs)


@pytest.mark.parametrize("kind", [LINE, PATH])
def test_a_forecast_is_near_what_a_run_takes(kind):
    run = drawn(kind, 2)
    expected, found = forecast_to(run, 0.03), reach(run, 0.03)
    spent = found.work * found.last.size
    assert 1 / 3 < expected.transforms * expected.points / spent < 3
    assert expected.points == chosen(run, 0.03)["points"]


def test_a_forecast_tells_what_it_does_not_know():
    run = settings_of(LINE_SCENE)
    with refused("solver.kind", "were not measured"):
        forecast(run | {"solver": {"kind": "polonsky_keer"}})
    steep = settings_of(LINE_SCENE, load={"reduced_pressure": [1e-6]}, accuracy=0.3)
    assert "area" in forecast(steep).unsure
    assert forecast_of(run).transforms > forecast(run).transforms * 0.5


def test_the_shell_tells_the_cost_of_a_scene_and_runs_it_to_its_accuracy(tmp_path, capsys):
    file = tmp_path / "scene.yaml"
    file.write_text(yaml.safe_dump(LINE_SCENE))
    cli.main(["cost", str(file)])
    out = capsys.readouterr().out
    assert "a coarser run before included" in out
    assert "relative_contact_area_subgrid" in out
    cli.main(["run", str(file)])
    assert "relative_contact_area_subgrid to" in capsys.readouterr().out
    assert dataset.read(tmp_path / "scene.nc").reached == 1
    plain = {name: value for name, value in LINE_SCENE.items() if name != "accuracy"}
    file.write_text(yaml.safe_dump(plain | {"points": 1024, "tolerance": 1e-3}))
    cli.main(["cost", str(file)])
    assert "1024 points" in capsys.readouterr().out
    cli.main(["cost", str(file), "--accuracy", "0.01"])
    assert "1024 points" not in capsys.readouterr().out
    with pytest.raises(SystemExit, match="accuracy"):
        cli.main(["cost", str(file), "--accuracy", "2"])


def test_what_lies_ahead_is_told_with_what_is_not_known(tmp_path):
    known = study(LINE_SCENE).runs()[0]
    wave = {"kind": "sinusoid", "length": 100.0, "amplitude": 0.1}
    plain = {name: value for name, value in LINE_SCENE.items() if name != "accuracy"}
    other = study(plain, surface=wave, points=64, tolerance=1e-3).runs()[0]
    text = told([(known, "none.json"), (other, "none.json")], ["aggregate", "trial"], 2)
    assert "2 runs and 2 other jobs" in text
    assert "2 jobs of which no time is known" in text
    (tmp_path / "costs.json").write_text('{"cpu_seconds_of_last_run": 7200}')
    assert "about 2 h" in told([(other, tmp_path / "costs.json")], [], 1)


def test_features_do_not_depend_on_units():
    run = settings_of(LINE_SCENE)
    scaled = run | {
        "surface": run["surface"]
        | {name: 10 * run["surface"][name] for name in ("length", "rolloff_wavelength", "shortest_wavelength")}
    }
    for one, two in zip(features(scene_of(run)), features(scene_of(scaled)), strict=True):
        assert one == pytest.approx(two)
