"""What is negligible is left out: maps, a check on a sample, what is decided, and what is simulated once."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from contactsim import dataset
from contactsim.contact.simplification import SIMPLIFICATIONS, simplify
from contactsim.error_control import effect_maps, neglect
from contactsim.error_control.effect_maps import change_without, expected_change, neglect_effects
from contactsim.error_control.neglect import decide_neglect, expected_neglect, neglectable_effects
from contactsim.error_control.solution import solve_setup
from contactsim.evaluation.effects.map_settings import read_maps
from contactsim.evaluation.effects.survey import MapJob, format_maps, map_job, measure_map
from contactsim.paths.options import Setup
from contactsim.study import execute_neglecting
from contactsim.study.execute import RunFiles
from contactsim.study.plan import Plan
from contactsim.study.run import Run
from contactsim.study.study import Study
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed
from support.cases import refused
from support.places import ROOT

ASPERITY = {
    "title": "Asperity",
    "surface": {"kind": "cylinder", "radius": 25000.0, "length": 10000.0},
    "body": {"kind": "layer", "youngs_modulus": 70.0, "poisson_ratio": 0.3, "thickness": 5000.0},
    "effects": {"list": ["cohesive_zone"], "neglect_within": 0.05, "quantities": ["pull_off_load_loading"]},
    "cohesive_zone": {"work_of_separation": 2.0, "work_ratio": 0.1},
    "path": {"approach": [-10.0, 4.0], "increment": 0.5},
    "points": 512,
    "tolerance": 1.0e-4,
}


def study(**more: object) -> Study:
    return Study.read("asperity", ASPERITY | more, "file", 1)


PULL_OFF = ["pull_off_load_loading"]


def run_of(ratio: float = 0.3, work: float = 0.1, **more: object) -> Run:
    body = ASPERITY["body"] | {"poisson_ratio": ratio}
    law = ASPERITY["cohesive_zone"] | {"work_ratio": work}
    return study(body=body, cohesive_zone=law, **more).runs()[0]


def setup_of(ratio: float = 0.3, work: float = 0.1, **more: object) -> Setup:
    return run_of(ratio, work, **more).setup


def coupling_change(ratio: float, work: float, **more: object) -> float | None:
    """Return the change that the maps expect without the coupling."""
    return expected_change(setup_of(ratio, work, **more).scene, "coupling")


def test_the_thesis_three_conditions_are_on_the_map():
    large = coupling_change(0.1, 0.0)
    assert large > 0.1
    assert coupling_change(0.1, 3.0) < 0.5 * large  # large friction
    assert coupling_change(0.49, 0.0) < 0.1 * large  # an incompressible solid
    close = ASPERITY["surface"] | {"length": 0.04 * ASPERITY["surface"]["radius"]}
    assert coupling_change(0.3, 0.0, surface=close) < 0.5 * coupling_change(0.3, 0.0)  # closely spaced contacts


def test_between_places_of_a_map_the_largest_change_around_counts_and_beyond_it_nothing_is_known():
    corners = [coupling_change(ratio, 0.1) for ratio in (0.3, 0.4)]
    assert coupling_change(0.35, 0.1) == max(corners)
    assert coupling_change(0.4999, 0.1) is None
    assert coupling_change(0.3, 0.1, counter_body=ASPERITY["body"]) is None
    assert coupling_change(0.3, 0.1, surface={"kind": "flat", "length": 10000.0}) is None


def test_a_map_is_the_change_that_two_solutions_show():
    settings = map_job(read_maps(ROOT / "config", {}, "standard"), "coupling")
    axes = settings["map"]["axes"]
    settings["map"]["axes"] = {
        "poisson_ratio": axes["poisson_ratio"] | {"values": [0.1, 0.49]},
        "work_ratio": axes["work_ratio"] | {"values": [0.0]},
    }
    job = MapJob.from_settings(settings)
    data = measure_map(job)
    assert data.change_without.dims == ("poisson_ratio", "work_ratio")
    large, small = data.change_without.values.ravel()
    assert large > 0.1 > 10 * small
    told = format_maps({"coupling": job.map}, {"coupling": data})
    assert json.loads(told)["coupling"]["neglect"] == ["coupling"]


def test_the_frozen_maps_are_those_of_the_config():
    settings = read_maps(ROOT / "config", {}, "standard")
    assert set(effect_maps.effect_maps()) == set(settings.maps)
    for name, section in effect_maps.effect_maps().items():
        assert section["axes"] == settings.settings["maps"][name]["axes"], name
        assert len(section["change"]) == np.prod([len(axis["values"]) for axis in section["axes"].values()])
        assert all(np.isfinite(section["change"]))


@pytest.mark.parametrize(
    ("over", "key", "allowed"),
    [
        ({"maps": {"coupling": {"neglect": ["gravity"]}}}, "neglect", "coupling"),
        ({"maps": {"coupling": {"axes": {"spacing": {"values": "all"}}}}}, "values", "a list"),
        ({"maps": {"coupling": None, "new": []}}, "maps.new", "a mapping"),
        ({"maps": {"coupling": {"of": ["colour"]}}}, "coupling.of", "pull_off_load_loading"),
        ({"maps": {"height": {"scene": {"members": 2}}}}, "height.scene", "one: nothing varied"),
        ({"maps": {"height": {"axes": {"thickness": {"key": "table.thickness"}}}}}, "thickness.key", "scene"),
        ({"maps": {"height": {"axes": {"thickness": {"key": "accuracy.thickness"}}}}}, "thickness.key", "scene"),
        ({"maps": {"height": {"axes": {"thickness": {"per": ["surface.kind"]}}}}}, "thickness.per", "numbers"),
        ({"maps": {"height": {"axes": {"thickness": {"per": ["body.width"]}}}}}, "thickness.per", "numbers"),
        ({"maps": {"height": {"axes": {"thickness": {"key": "body.width"}}}}}, "body.width", "known keys"),
        ({"maps": {"height": {"axes": {"thickness": None, "poisson_ratio": None}}}}, "height.axes", "at least one"),
        (
            {"panels": [{"map": "height", "across": "thickness", "up": "poisson_ratio", "conditions": {"here": 1}}]},
            "conditions.here",
            "two parts",
        ),
        ({"panels": [{"map": "none", "across": "a", "up": "b"}]}, "panels.0.map", "coupling"),
        ({"panels": [{"map": "height", "across": "thickness", "up": "thickness"}]}, "panels.0", "poisson_ratio"),
        (
            {"panels": [{"map": "friction", "across": "poisson_ratio", "up": "work_ratio", "at": {"strength": 7.0}}]},
            "strength",
            "one of",
        ),
    ],
)
def test_wrong_settings_of_a_map_are_refused(over, key, allowed):
    with refused(key, allowed):
        read_maps(ROOT / "config", over, "quick")


def test_only_effects_that_a_scene_has_can_be_neglected():
    effects = neglectable_effects(setup_of(0.3, 0.1).scene)
    assert set(effects) == {"friction", "coupling", "compressibility", "height"}
    assert "friction" not in neglectable_effects(setup_of(0.3, 0.0).scene)
    assert "compressibility" not in neglectable_effects(setup_of(0.5, 0.1).scene)


def test_an_effect_that_maps_and_sample_find_negligible_is_left_out_and_another_stays():
    nearly = decide_neglect([setup_of(0.49, 0.0)], 0.05, PULL_OFF)
    assert "coupling" in nearly.neglected
    assert nearly.together <= 0.05
    assert "coupling left out" in nearly.description
    assert nearly.work > 0
    compressible = decide_neglect([setup_of(0.0, 0.0)], 0.05, PULL_OFF)
    assert "coupling" not in compressible.neglected
    assert "coupling kept" in compressible.description
    assert "as no map knows: height" in compressible.description
    assert json.loads(nearly.text)["neglected"] == nearly.neglected
    assert "seconds" not in json.loads(nearly.text)


def test_the_measured_change_decides_against_the_map(monkeypatch):
    monkeypatch.setattr(neglect, "expected_change", lambda scene, effect: 0.001)
    decision = decide_neglect([setup_of(0.0, 0.0)], 0.05, PULL_OFF)
    assert decision.measured["coupling"] > 0.05
    assert "coupling" not in decision.neglected


def test_of_effects_that_are_too_much_together_the_largest_is_put_back(monkeypatch):
    changes = {"friction": 0.01, "coupling": 0.03, "compressibility": 0.04, "height": 0.2}
    monkeypatch.setattr(neglect, "expected_change", lambda scene, effect: 0.001)
    monkeypatch.setattr(neglect, "change_without", lambda setup, effects, *rest: sum(changes[name] for name in effects))
    decision = decide_neglect([setup_of()], 0.05, PULL_OFF)
    assert decision.neglected == ["friction", "coupling"]
    assert decision.together == pytest.approx(0.04)


def test_an_effect_far_from_negligible_is_not_even_checked(monkeypatch):
    monkeypatch.setattr(neglect, "expected_change", lambda scene, effect: 0.9)
    monkeypatch.setattr(neglect, "change_without", lambda *arguments: pytest.fail("checked"))
    assert decide_neglect([setup_of()], 0.05, PULL_OFF).neglected == []


def test_setups_have_the_same_fingerprint_where_their_scenes_are_the_same_without_an_effect():
    frictionless, frictional, other = setup_of(0.45, 0.0), setup_of(0.45, 0.5), setup_of(0.3, 0.0)
    assert frictionless.fingerprint != frictional.fingerprint
    without_slip = [
        neglect_effects(setup, ["coupling", "friction"]).fingerprint for setup in (frictionless, frictional, other)
    ]
    assert without_slip[0] == without_slip[1]
    assert without_slip[0] != without_slip[2]
    uncoupled = [neglect_effects(setup, ["coupling"]).fingerprint for setup in (frictionless, frictional)]
    assert uncoupled[0] != uncoupled[1]  # friction stays where only the coupling is neglected


@pytest.mark.parametrize(
    ("with_it", "without_it", "change"), [(np.nan, 3.0, np.inf), (3.0, np.nan, np.inf), (2.0, 3.0, 0.5)]
)
def test_a_quantity_that_only_exists_with_an_effect_changes_altogether(with_it, without_it, change):
    full, simple = setup_of(points=64), neglect_effects(setup_of(points=64), ["coupling"])
    solution = solve_setup(full, PULL_OFF)
    values = {full: with_it, simple: without_it}
    solutions = {
        setup.fingerprint: replace(solution, values={PULL_OFF[0]: np.array([value])}) for setup, value in values.items()
    }
    assert change_without(full, ["coupling"], PULL_OFF, solutions) == change


def test_nothing_is_known_of_the_change_of_a_quantity_that_a_scene_has_neither_with_nor_without_an_effect():
    pressed = setup_of(points=64, path={"approach": [0.0, 4.0], "increment": 0.5})  # never pulled off
    assert change_without(pressed, ["coupling"], PULL_OFF) == np.inf


def test_a_run_is_computed_without_what_was_decided_and_says_so_and_a_twin_is_taken_over(tmp_path):
    frictionless, frictional = (run_of(0.49, work, points=128) for work in (0.0, 0.5))

    def compute(run: Run, name: str, decision: Path, twin: Path | None = None) -> xr.Dataset:
        """Return the dataset of a run that neglects what was decided."""
        files = RunFiles(tmp_path / f"{name}.nc", tmp_path / f"{name}.json")
        execute_neglecting.run(run.settings, "source", files, decision=decision, twin=twin)
        return dataset.load_dataset(files.data)

    decision = tmp_path / "decision.json"
    decision.write_text(decide_neglect([frictional.setup], 0.05, PULL_OFF).text)
    neglected = json.loads(decision.read_text())["neglected"]
    assert {"coupling", "friction"} <= set(neglected)
    data = compute(frictionless, "first", decision)
    assert data.neglected.item() == ", ".join(neglected)
    assert data.neglect_change <= 0.05
    assert data.check_transforms > 0
    same = compute(frictional, "same", decision, twin=tmp_path / "first.nc")
    assert (same.line_load == data.line_load).all()
    assert same.transforms.sum() == 0
    assert (same.point_digest != data.point_digest).all()
    nothing = tmp_path / "nothing.json"
    nothing.write_text(json.dumps(json.loads(decision.read_text()) | {"neglected": []}))
    assert compute(frictional, "whole", nothing, twin=tmp_path / "first.nc").transforms.sum() > 0


def test_chapter_5_leaves_the_coupling_out_where_it_is_negligible_and_simulates_such_variants_once():
    plan = Plan.read(ROOT / "config", "standard")
    runs = [run for run in plan.studies["rough_adhesive_auto"].runs() if not run.measures_error]
    for run in runs:
        place = run.coordinates["poisson_ratio"], run.coordinates["work_ratio"]
        if place[0] == 0.45:
            assert "coupling" in expected_neglect(run.setup.scene, 0.05)
        assert bool(plan.twin(run)) == (place == (0.45, 0.5)), place
    assert all(plan.decision(run) for run in runs)


@pytest.mark.parametrize(
    ("section", "key", "allowed"),
    [
        (
            {"effects": {"list": ["glue"], "neglect_within": 0.1, "quantities": ["final_load"]}},
            "effects.list",
            "a list from",
        ),
        (
            {"effects": {"list": ["cohesive_zone"], "neglect_within": 2.0, "quantities": ["final_load"]}},
            "effects.neglect_within",
            "below 1",
        ),
        ({"effects": {"list": ["cohesive_zone"], "neglect_within": 0.1}}, "effects.quantities", "missing"),
        (
            {"effects": {"list": ["cohesive_zone"], "neglect_within": 0.1, "quantities": ["final_load"], "sample": 3}},
            "effects.sample",
            "at most 1",
        ),
        ({"neglect": ["friction"]}, "neglect", "neglected anyway"),
    ],
)
def test_wrong_settings_of_neglect_are_refused(section, key, allowed):
    with refused(key, allowed):
        study(**section)


@pytest.mark.parametrize("dimensions", [1, 2])
def test_a_smoothed_surface_is_the_same_without_its_short_waves(dimensions):
    given = {"length": 64.0, "hurst_exponent": 0.5, "long_cutoff": 32.0, "short_cutoff": 4.0, "rms_gradient": 0.1}
    surface = SelfAffine(**given, dimensions=dimensions, seed=realisation_seed(1, 0.5))
    smooth = SelfAffine(**given, dimensions=dimensions, low_pass_cutoff=8.0, seed=realisation_seed(1, 0.5))
    assert smooth.modes == 7
    whole = np.fft.fftn(surface.heights(64))
    waves = np.fft.fftfreq(64, 1 / 64)
    square = waves**2 if dimensions == 1 else waves[:, None] ** 2 + waves**2
    kept = np.fft.ifftn(np.where(square <= 49, whole, 0)).real
    assert np.allclose(smooth.heights(64), kept, atol=1e-12)
    assert smooth.profile_rms_gradient < surface.profile_rms_gradient
    assert np.array_equal(surface.heights(64), surface.heights(64))
    smooth.check(16)
    with refused("low_pass_cutoff", "below the long cut-off"):
        SelfAffine(**given, low_pass_cutoff=40.0, seed=realisation_seed(1, 0.5))


def test_a_second_body_and_short_waves_are_left_out_where_there_are_such():
    stiff = setup_of(counter_body=ASPERITY["body"] | {"youngs_modulus": 700.0}).scene
    assert simplify(stiff, ["second_body"]).upper.elasticity is None
    soft = setup_of(counter_body=ASPERITY["body"] | {"youngs_modulus": 7.0}).scene
    assert simplify(soft, ["second_body"]).lower.elasticity is None
    assert set(SIMPLIFICATIONS) >= {"second_body", "short_waves"}
