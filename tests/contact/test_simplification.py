"""What a scene is asked to leave out is left out, and what that costs is measured."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
import yaml

from contactsim import cli, dataset
from contactsim.analysis.aggregate import aggregate
from contactsim.contact.simplification import SIMPLIFICATIONS, simplify
from contactsim.elasticity.half_space import HalfSpace
from contactsim.errors import InputError
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.observables.path_summary import summarise_load_curves
from contactsim.study import execute
from contactsim.study.execute import RunFiles
from contactsim.study.study import Study
from support.smooth import LAYER, scene_of

SCENE = scene_of(CohesiveZone(2.0, 0.5, 1.5, 2.0))
ASPERITY = {
    "title": "Asperity",
    "surface": {"kind": "cylinder", "radius": 25000.0, "length": 10000.0},
    "body": {"kind": "layer", "youngs_modulus": 70.0, "poisson_ratio": 0.1, "thickness": 5000.0},
    "effects": ["cohesive_zone"],
    "cohesive_zone": {"work_of_separation": 2.0},
    "vary": {"cohesive_zone.work_ratio": [0.0, 1.0]},
    "path": {"approach": [-8.0, 0.0], "increment": 0.5},
    "points": 128,
    "tolerance": 1.0e-7,
    "neglect": ["coupling"],
    "full_model": {"members": 1},
}


@pytest.mark.parametrize(
    ("name", "effect", "body"),
    [
        ("coupling", UncoupledCohesiveZone(2.0, 0.5, 1.5, 2.0), LAYER),
        ("friction", CohesiveZone(2.0, 0.0, 1.5, 2.0), LAYER),
        ("height", SCENE.effects[0], HalfSpace(LAYER.contact_modulus, LAYER.poisson_ratio)),
        ("compressibility", SCENE.effects[0], replace(LAYER, poisson_ratio=0.5)),
    ],
)
def test_each_simplification_changes_one_thing_of_a_scene(name, effect, body):
    less = simplify(SCENE, [name])
    assert less.effects == (effect,)
    assert less.lower.elasticity == body
    assert less.upper == SCENE.upper
    assert simplify(less, [name]) == less


def test_all_simplifications_in_any_order_leave_a_normal_only_scene():
    found = [simplify(SCENE, names) for names in itertools.permutations(SIMPLIFICATIONS)]
    assert all(less == found[0] for less in found)
    assert found[0].components == found[0].exerted == ("n",)
    assert set(SIMPLIFICATIONS) == {"friction", "height", "compressibility", "coupling", "second_body", "short_waves"}


def test_an_effect_that_no_variant_has_is_refused_and_one_that_some_have_is_not():
    for names in (["friction", "coupling"], ["coupling", "friction"]):
        assert Study.read("asperity", ASPERITY | {"neglect": names}, "ch9.yaml", 1).runs()
    deep = {"body": {"kind": "half_space", "youngs_modulus": 70.0, "poisson_ratio": 0.1}, "neglect": ["height"]}
    with pytest.raises(InputError, match=r"neglect: got 'height'; allowed: effects that the study has"):
        Study.read("asperity", ASPERITY | deep, "ch9.yaml", 1)


def test_what_is_left_out_is_explained(tmp_path, capsys):
    file = tmp_path / "scene.yaml"
    section = {name: value for name, value in ASPERITY.items() if name not in ("full_model", "title", "vary")}
    file.write_text(yaml.safe_dump(section | {"neglect": ["height"]}), encoding="utf-8")
    cli.main(["explain", str(file)])
    told = capsys.readouterr().out
    assert "height: as the study asks" in told
    assert "HalfSpace" in told


def test_a_wall_on_a_path_has_the_error_of_what_is_left_out(tmp_path):
    wall = {"effects": ["hard_wall"], "path": {"approach": [0.0, 3.0], "increment": 1.0}, "neglect": ["height"]}
    given = {name: value for name, value in ASPERITY.items() if name not in ("cohesive_zone", "vary")}
    study = Study.read("asperity", given | wall | {"tolerance": 1e-3}, "ch9.yaml", 1)
    data = _aggregated(study, tmp_path)
    assert (data.normalised_pressure_neglect_error > 0).any()


def test_the_error_of_leaving_out_is_that_of_runs_with_nothing_left_out(tmp_path):
    study = Study.read("asperity", ASPERITY, "ch9.yaml", 1)
    assert [run.error for run in study.runs()] == ["", "", "neglect", "neglect"]
    assert ["neglect" in run.settings for run in study.runs()] == [True, True, False, False]
    data = _aggregated(study, tmp_path)
    assert float(np.ptp(data.pull_off_load_loading.values)) > 5  # friction is kept
    error = data.pull_off_load_loading_neglect_error
    files = [tmp_path / f"{run.variant}_neglect.nc" for run in study.runs() if run.measures_error]
    whole = [summarise_load_curves(dataset.load_dataset(file)).pull_off_load_loading for file in files]
    assert np.allclose(
        error.values.ravel(), np.abs([float(one) for one in whole] - data.pull_off_load_loading.values[:, 0])
    )
    assert (error > 1).all()


def test_friction_is_left_out_with_the_coupling_where_both_are_asked_for():
    less = simplify(SCENE, ["coupling", "friction"])
    assert less.effects == (NormalCohesiveZone(2.0, 1.5),)
    assert less == simplify(SCENE, ["friction", "coupling"])


def test_runs_with_nothing_left_out_measure_nothing_where_nothing_is():
    section = {name: value for name, value in ASPERITY.items() if name != "neglect"}
    with pytest.raises(InputError, match=r"full_model: got .*; allowed: none, for the study has no neglect"):
        Study.read("asperity", section, "ch9.yaml", 1)


def _aggregated(study, folder):
    """All runs of a study, made, as one dataset."""
    listed = []
    for run in study.runs():
        path = folder / f"{run.variant}_{run.error}.nc"
        execute.run(run.settings, run.source, RunFiles(path, path.with_suffix(".json")))
        place = {
            "coordinates": run.coordinates,
            "member": run.member,
            "measures_error": run.measures_error,
            "error": run.error,
        }
        listed.append({"path": path} | place)
    return aggregate(listed, study.settings | {"tier": "quick", "name": "asperity"}, "abc")


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"neglect": ["height", "rain"]}, "neglect"),
        ({"full_model": {"members": 2}}, "full_model.members"),
        ({"neglect": ["coupling", "coupling"]}, "neglect"),
    ],
)
def test_what_cannot_be_left_out_is_refused_with_its_key(changes, key):
    with pytest.raises(InputError) as caught:
        Study.read("asperity", ASPERITY | changes, "ch9.yaml", 1)
    assert (caught.value.file, caught.value.key) == ("ch9.yaml", f"studies.asperity.{key}")
