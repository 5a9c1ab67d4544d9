from __future__ import annotations

import numpy as np
import pytest

import contactsim
from contactsim import cli, commands, dataset, scene_files
from contactsim.contact import loading
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.figures import maps
from contactsim.interface.hard_wall import HardWall
from contactsim.paths.driver import follow_path
from contactsim.surfaces.shapes import Flat, Sinusoid
from support.places import ROOT

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
    stored = dataset.load_dataset(scene_file.with_suffix(".nc"))
    scene = Scene(
        Body(Flat(1000.0), HalfSpace(70.0)), Body(Sinusoid(1000.0, 5.0)), (HardWall(),), loading.pressures([0.01, 0.1])
    )
    data = contactsim.simulate(scene, points=256, tolerance=1e-4)
    assert np.array_equal(stored.relative_contact_area, data.relative_contact_area)
    assert np.array_equal(stored.contact_pressure, data.contact_pressure)
    assert dataset.settings_of(stored)["surface"]["amplitude"] == 5.0
    one = contactsim.press(
        scene.heights(256), spacing=1000 / 256, contact_modulus=70.0, mean_pressure=0.1, tolerance=1e-4
    )
    assert one.relative_contact_area == data.relative_contact_area[1]


def test_a_run_has_its_own_load_and_the_proportionality_factors(scene_file, capsys):
    scene_file.write_text(SCENE.replace("mean_pressure: [0.01, 0.1]", "reduced_pressure: [0.02, 0.2]"))
    cli.main(["run", str(scene_file)])
    told = capsys.readouterr().out
    assert "kappa" in told and "kappa_r" in told and "reduced_pressure" in told
    stored = dataset.load_dataset(scene_file.with_suffix(".nc"))
    assert stored.reduced_pressure.values.tolist() == [0.02, 0.2]
    assert np.allclose(stored.kappa, stored.relative_contact_area / stored.reduced_pressure, rtol=1e-15)
    gradient = stored.mean_pressure / (stored.contact_modulus * stored.reduced_pressure)
    assert np.allclose(stored.kappa_r / stored.kappa, stored.rms_gradient_contact / gradient, rtol=1e-12)
    assert stored.kappa_r.attrs["units"] == "1"


def test_units_stand_between_the_names_and_the_numbers_of_their_columns(scene_file, capsys):
    cli.main(["run", str(scene_file)])
    *_, broken, names, units, first, second, _ = capsys.readouterr().out.splitlines()
    gaps = dataset.load_dataset(scene_file.with_suffix(".nc")).mean_gap.values
    end = {name: names.index(name) + len(name) for name in ("mean_pressure", "mean_gap")}
    for line, pressure, gap in (
        (units, "GPa", "nm"),
        (first, "0.01", f"{gaps[0]:.4g}"),
        (second, "0.1", f"{gaps[1]:.4g}"),
    ):
        assert line[: end["mean_pressure"]].split()[-1] == pressure
        assert line[: end["mean_gap"]].split()[-1] == gap
    assert len(units) == names.index("approach") + len("approach")  # what comes after has no unit
    assert names.split()[-1] == "status" and first.endswith("  converged")
    assert broken.endswith("contact_area_") and names[: len(broken)].endswith("subgrid")


def test_a_run_keeps_what_its_scene_file_says_and_its_fields_can_be_mapped(scene_file):
    scene_file.write_text(SCENE.replace("5.0}", "5.0, dimensions: 2}").replace("256", "32") + "keep: [fields]\n")
    cli.main(["run", str(scene_file)])
    stored = dataset.load_dataset(scene_file.with_suffix(".nc"))
    assert {"heights", "pressure", "gap"} <= set(stored)
    assert not {"contact_bits", "contact_pressure", "profile_real"} & set(stored)
    image = maps.plot_maps(stored.isel(mean_pressure=-1)).axes[0].images[0]
    assert image.get_array().mean() == stored.relative_contact_area[-1]


ADHESIVE = """
surface: {kind: cylinder, radius: 25000.0, length: 10000.0}
body: {kind: layer, youngs_modulus: 70.0, poisson_ratio: 0.3, thickness: 5000.0}
effects: [cohesive_zone]
cohesive_zone: {work_of_separation: 2.0}
path: {approach: [-10.0, -4.0], increment: 0.5}
points: 128
tolerance: 1.0e-7
"""


def test_a_scene_of_smooth_laws_is_run_along_its_path(scene_file, capsys):
    scene_file.write_text(ADHESIVE)
    cli.main(["run", str(scene_file)])
    told = capsys.readouterr().out
    assert "line_load" in told and "relative_contact_area" not in told
    stored = dataset.load_dataset(scene_file.with_suffix(".nc"))
    assert np.allclose(stored.approach, np.arange(-9.5, -3.9, 0.5))
    assert stored.line_load.min() < -200 and (stored.jump > 1).sum() == 1
    assert not [name for name in stored if name.startswith("tangential_traction")]


def test_a_frictionless_law_is_explained_as_one_field_that_another_follows(scene_file, capsys):
    scene_file.write_text(ADHESIVE)
    cli.main(["explain", str(scene_file)])
    told = capsys.readouterr().out
    assert "128 at each of 12 load steps" in told
    assert "tangential displacement" in told and "tangential traction" not in told
    assert "the displacement follows the normal one, wave by wave" in told
    assert "energy_minimisation: not made for a law without a potential" in told
    scene_file.write_text(ADHESIVE.replace("2.0}", "2.0, work_ratio: 0.5}"))
    cli.main(["explain", str(scene_file)])
    assert "256 at each of 12 load steps" in capsys.readouterr().out


def test_a_wall_that_is_to_pull_is_refused_when_its_scene_is_read(scene_file):
    scene_file.write_text(
        SCENE.replace("load: {mean_pressure: [0.01, 0.1]}", "path: {mean_pressure: [0.1, -0.1], increment: 0.1}")
    )
    with pytest.raises(SystemExit, match="without adhesion nothing can pull"):
        cli.main(["run", str(scene_file)])


def test_a_scene_file_is_explained_and_drawn(scene_file, tmp_path, capsys):
    cli.main(["explain", str(scene_file), "--draw", str(tmp_path / "wave.png")])
    said = capsys.readouterr().out
    for part in (
        "wave: 256 points\n",
        "hard_wall",
        "deformation of the upper body: it is rigid",
        "solver\n  active_set\n",
        "256 at each of 2 load",
    ):
        assert part in said
    assert (tmp_path / "wave.png").read_bytes().startswith(b"\x89PNG")


def test_a_study_is_explained_by_its_name(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    cli.main(["explain", "rough_line", "--tier", "quick"])
    assert "131072 points, the first of 21 runs" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (("kind: sinusoid", "kind: sawtooth"), ["surface.kind", "got sawtooth;", "sinusoid"]),
        (("[0.01, 0.1]", "[-0.1]"), ["load.mean_pressure", "-0.1", "above 0"]),
        (("points: 256", "points: 1"), ["points", "got 1", "2 or more"]),
        (("tolerance: 1.0e-4", "tolerance: 1e-4"), ["tolerance", "line 7: tolerance: got 1e-4;", "1.0e-4"]),
        (("points: 256", "points: 256\nmembers: 3"), ["one run"]),
        (("points: 256", "points: 256\nseed: -1"), ["seed", "-1"]),
        (("points: 256", "pints: 256"), ["pints", "no such key"]),
        (
            ("points: 256", "points: 256\ntight_tolerance: {tolerance: 1.0e-6, members: 1}"),
            ["tight_tolerance", "one run"],
        ),
        (("points: 256", "points: 256\nvary: {surface.amplitude: [5.0]}"), ["vary", "one run"]),
    ],
)
def test_a_wrong_scene_file_ends_in_one_line_that_names_file_key_value_and_what_is_allowed(scene_file, edit, words):
    scene_file.write_text(SCENE.replace(*edit))
    with pytest.raises(SystemExit) as caught:
        cli.main(["run", str(scene_file)])
    for word in [str(scene_file), *words]:
        assert word in str(caught.value)
    assert "\n" not in str(caught.value)
    assert "studies." not in str(caught.value)  # keys as they stand in the file
    assert not scene_file.with_suffix(".nc").exists()


def test_an_unknown_scene_is_refused_with_the_studies_that_exist(monkeypatch):
    monkeypatch.chdir(ROOT)
    with pytest.raises(SystemExit, match="rough_line"):
        cli.main(["explain", "smoothest_line"])


def test_a_load_step_that_does_not_converge_is_stored_named_and_ends_in_an_error(scene_file, capsys):
    scene_file.write_text(SCENE.replace("1.0e-4", "1.0e-18"))
    with pytest.raises(SystemExit, match="2 of 2 load steps did not converge"):
        cli.main(["run", str(scene_file)])
    assert "max_iterations" in capsys.readouterr().out
    assert (dataset.load_dataset(scene_file.with_suffix(".nc")).status == 1).all()


@pytest.mark.parametrize(
    ("command", "options", "words"),
    [
        ("run", ["--output", "."], ["--output", "folder"]),
        ("run", ["--threads", "0"], ["threads", "got 0"]),
        ("explain", ["--draw", "wave.bmp"], ["--draw", "wave.bmp", ".png"]),
        ("explain", ["--draw", "nowhere/wave.png"], ["nowhere/wave.png", "No such file"]),
        ("explain", ["--tier", "quick"], ["--tier", "quick", "scene file"]),
    ],
)
def test_a_wrong_option_ends_in_one_line(scene_file, command, options, words):
    with pytest.raises(SystemExit) as caught:
        cli.main([command, str(scene_file), *options])
    for word in words:
        assert word in str(caught.value)
    assert "\n" not in str(caught.value)


def test_options_of_the_solver_seed_and_tolerance_of_a_scene_file_reach_the_run(scene_file, monkeypatch):
    scene_file.write_text(SCENE + "seed: 7\nsolver: {kind: polonsky_keer, batch: 5}\n")
    setups = []

    def follow(setup):
        setups.append(setup)
        return follow_path(setup)

    monkeypatch.setattr(commands, "follow_path", follow)
    cli.main(["run", str(scene_file)])
    (options,) = (setup.options for setup in setups)
    assert (type(options.solver).__name__, options.solver.batch) == ("PolonskyKeer", 5)
    assert (options.tolerance, options.points) == (1e-4, 256)
    assert dataset.load_dataset(scene_file.with_suffix(".nc")).attrs["settings"]
    assert scene_files.read_scene(str(scene_file)).seed == 7


@pytest.mark.parametrize(
    ("change", "places", "value"),
    [
        ("surface.amplitude=2.5", ["surface", "amplitude"], 2.5),
        ("load={mean_pressure: [0.5]}", ["load", "values"], [0.5]),
        ("solver.kind=polonsky_keer", ["solver", "kind"], "polonsky_keer"),
    ],
)
def test_a_key_of_a_scene_file_is_changed_for_one_command(scene_file, change, places, value):
    before = scene_file.read_text()
    settings = scene_files.read_scene(str(scene_file), [change]).runs()[0].settings
    for place in places:
        settings = settings[place]
    assert settings == value
    assert scene_file.read_text() == before


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("points", ["--set", "KEY=VALUE"]),
        ("=3", ["--set", "KEY=VALUE"]),
        ("points.x=3", ["--set", "points"]),
        ("points=[1", ["--set", "plain YAML"]),
        ("pints=3", ["pints", "no such key"]),
        ("tolerance=1e-4", ["tolerance", "1.0e-4"]),
    ],
)
def test_a_change_that_means_nothing_is_refused_in_one_line(scene_file, change, words):
    with pytest.raises(SystemExit) as caught:
        cli.main(["run", str(scene_file), "--set", change])
    for word in words:
        assert word in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("kind", sorted(file.stem for file in scene_files.TEMPLATES.glob("*.yaml")))
def test_a_new_scene_file_can_be_explained_and_replaces_none(kind, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    np.savetxt("profile.csv", np.c_[np.arange(64.0), np.sin(np.arange(64.0))], delimiter=",", header="x [nm], z [nm]")
    cli.main(["new", kind])
    cli.main(["explain", f"{kind}.yaml"])
    assert "points" in capsys.readouterr().out
    with pytest.raises(SystemExit, match="does not exist yet"):
        cli.main(["new", kind])


def test_the_kinds_of_new_scenes_are_listed_with_what_they_are(capsys):
    cli.main(["new"])
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(list(scene_files.TEMPLATES.glob("*.yaml"))) >= 5
    assert any(line.startswith("rough_line ") and "half-space" in line for line in lines)
    with pytest.raises(SystemExit, match="rough_line"):
        cli.main(["new", "rough_lines"])


def test_a_study_of_many_runs_is_left_to_the_workflow(monkeypatch):
    monkeypatch.chdir(ROOT)
    with pytest.raises(SystemExit, match="snakemake --cores 2 rough_line"):
        cli.main(["run", "rough_line"])
    with pytest.raises(SystemExit, match="change it in"):
        cli.main(["explain", "rough_line", "--set", "points=64"])


def test_the_version_is_told(capsys):
    with pytest.raises(SystemExit) as caught:
        cli.main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out == f"contactsim {contactsim.__version__}\n"
