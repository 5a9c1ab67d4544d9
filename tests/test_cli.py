from __future__ import annotations

import numpy as np
import pytest

import contactsim
from conftest import ROOT
from contactsim import cli, dataset, loading
from contactsim.elasticity import HalfSpace
from contactsim.laws import HardWall
from contactsim.scene import Body, Scene
from contactsim.surface import Flat, Sinusoid

SCENE = """
surface: {kind: sinusoid, length: 1000.0, amplitude: 5.0}
body: {kind: half_space, contact_modulus: 70.0}
effects: [hard_wall]
load: {mean_pressure: [0.01, 0.1]}
points: 256
tolerance: 1.0e-4
"""


@pytest.fixture
def scene_file(tmp_path):
    path = tmp_path / "wave.yaml"
    path.write_text(SCENE)
    return path


def test_a_scene_file_is_run_into_a_dataset_equal_to_that_from_python(scene_file, capsys):
    cli.main(["run", str(scene_file)])
    assert "written to" in capsys.readouterr().out
    stored = dataset.read(scene_file.with_suffix(".nc"))
    scene = Scene(
        Body(Flat(1000.0), HalfSpace(70.0)), Body(Sinusoid(1000.0, 5.0)), (HardWall(),), loading.press([0.01, 0.1])
    )
    data = contactsim.simulate(scene, points=256, tolerance=1e-4)
    assert np.array_equal(stored.relative_contact_area, data.relative_contact_area)
    assert np.array_equal(stored.contact_pressure, data.contact_pressure)
    assert dataset.settings_of(stored)["surface"]["amplitude"] == 5.0
    one = contactsim.press(
        scene.heights(256), spacing=1000 / 256, contact_modulus=70.0, mean_pressure=0.1, tolerance=1e-4
    )
    assert one.relative_contact_area == data.relative_contact_area[1]


def test_a_scene_file_is_explained_and_drawn(scene_file, tmp_path, capsys):
    cli.main(["explain", str(scene_file), "--draw", str(tmp_path / "wave.png")])
    said = capsys.readouterr().out
    for part in (
        "wave: 256 points, 1 run",
        "hard_wall",
        "rigid: absent",
        "active_set (chosen)",
        "256 at each of 2 load",
    ):
        assert part in said
    assert (tmp_path / "wave.png").read_bytes().startswith(b"\x89PNG")


def test_a_study_is_explained_by_its_name(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    cli.main(["explain", "rough_line", "--tier", "quick"])
    assert "131072 points, 21 runs" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (("kind: sinusoid", "kind: sawtooth"), ["surface.kind", "'sawtooth'", "sinusoid"]),
        (("[0.01, 0.1]", "[-0.1]"), ["load.mean_pressure", "-0.1", "above 0"]),
        (("points: 256", "points: 1"), ["points", "got 1", "2 or more"]),
        (("tolerance: 1.0e-4", "tolerance: 1e-4"), ["tolerance", "'1e-4'", "1.0e-4"]),
        (("points: 256", "points: 256\nmembers: 3"), ["one run"]),
        (("points: 256", "points: 256\nseed: -1"), ["seed", "-1"]),
        (("points: 256", "pints: 256"), ["pints", "no such key"]),
    ],
)
def test_a_wrong_scene_file_ends_in_one_line_that_names_file_key_value_and_what_is_allowed(scene_file, edit, words):
    scene_file.write_text(SCENE.replace(*edit))
    with pytest.raises(SystemExit) as caught:
        cli.main(["run", str(scene_file)])
    for word in [str(scene_file), *words]:
        assert word in str(caught.value)
    assert not scene_file.with_suffix(".nc").exists()


def test_an_unknown_scene_is_refused_with_the_studies_that_exist(monkeypatch):
    monkeypatch.chdir(ROOT)
    with pytest.raises(SystemExit, match="rough_line"):
        cli.main(["explain", "smoothest_line"])
