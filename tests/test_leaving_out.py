"""What a scene is asked to leave out is left out, and what that costs is measured."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contactsim import aggregate, march
from contactsim.elasticity import HalfSpace
from contactsim.errors import SceneError
from contactsim.laws import CohesiveZone, NormalCohesiveZone
from contactsim.leaving_out import LEFT_OUT, left_out
from contactsim.study import Study
from smooth import LAYER, scene_of

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
    "leave_out": ["coupling"],
    "whole": {"members": 1},
}


@pytest.mark.parametrize(
    ("name", "effect", "body"),
    [
        ("coupling", NormalCohesiveZone(2.0, 1.5), LAYER),
        ("friction", CohesiveZone(2.0, 0.0, 1.5, 2.0), LAYER),
        ("height", SCENE.effects[0], HalfSpace(LAYER.contact_modulus, LAYER.poisson_ratio)),
        ("compressibility", SCENE.effects[0], replace(LAYER, poisson_ratio=0.5)),
    ],
)
def test_each_changes_one_thing_of_a_scene(name, effect, body):
    less = left_out(SCENE, [name])
    assert less.effects == (effect,)
    assert less.lower.elasticity == body
    assert less.upper == SCENE.upper
    with pytest.raises(SceneError, match=rf"leave_out: got '{name}'; allowed: effects that the scene has"):
        left_out(less, [name])


def test_all_of_them_together_leave_a_normal_scene():
    less = left_out(SCENE, ["friction", "height", "compressibility", "coupling"])
    assert less.components == less.exerted == ("n",)
    assert set(LEFT_OUT) == {"friction", "height", "compressibility", "coupling"}


def test_the_error_of_leaving_out_is_that_of_runs_with_nothing_left_out(tmp_path):
    study = Study.read("asperity", ASPERITY, "ch9.yaml", 1)
    listed = []
    for run in study.runs():
        path = tmp_path / f"{run.variant}_{run.error}.nc"
        march.run(run.settings, run.source, path, path.with_suffix(".json"))
        place = {"coordinates": run.coordinates, "member": run.member, "companion": run.companion, "error": run.error}
        listed.append({"path": path} | place)
    assert [run.error for run in study.runs()] == ["", "", "left_out", "left_out"]
    assert ["leave_out" in run.settings for run in study.runs()] == [True, True, False, False]
    data = aggregate.aggregate(listed, study.settings | {"tier": "quick", "name": "asperity"}, "abc")
    assert float(np.ptp(data.pull_off_load_loading.values)) == 0.0  # without coupling friction changes nothing
    error = data.pull_off_load_loading_left_out_error
    whole = [aggregate.summarised(_member(run)).pull_off_load_loading for run in listed if run["companion"]]
    assert np.allclose(error, [abs(float(one) - float(data.pull_off_load_loading[0, 0])) for one in whole])
    assert (error > 5).all()


def test_runs_with_nothing_left_out_measure_nothing_where_nothing_is():
    section = {name: value for name, value in ASPERITY.items() if name != "leave_out"}
    with pytest.raises(SceneError, match=r"whole: got .*; allowed: none, for the study has no leave_out"):
        Study.read("asperity", section, "ch9.yaml", 1)


def _member(run):
    return aggregate.dataset.read(run["path"])


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"leave_out": ["height", "rain"]}, "leave_out"),
        ({"whole": {"members": 2}}, "whole.members"),
        ({"leave_out": ["coupling", "coupling"]}, "leave_out"),
    ],
)
def test_what_cannot_be_left_out_is_refused_with_its_key(changes, key):
    with pytest.raises(SceneError) as caught:
        Study.read("asperity", ASPERITY | changes, "ch9.yaml", 1)
    assert (caught.value.file, caught.value.key) == ("ch9.yaml", f"studies.asperity.{key}")
