"""A film goes through even steps, shows both sides of each jump, and marks its state on the curve."""

from __future__ import annotations

import json
from importlib import import_module

import numpy as np
import pytest
import xarray as xr
import yaml
from matplotlib.figure import Figure
from PIL import Image

from contactsim import dataset
from contactsim.errors import InputError
from contactsim.figures import film, layout
from contactsim.figures.parts.states import MARK
from contactsim.study.figure_plan import MAX_FRAMES
from contactsim.study.plan import Plan
from support import rough_study
from support.places import ROOT

PLAN = Plan.read(ROOT / "config", "quick")
FILMS = [name for name, figure in PLAN.figures.items() if figure.settings["film"] is not None]
MAX_BYTES = 300_000
"""Size of a film that a report can hold."""


def stored_path(values, jumps=(), **variables):
    """A path of one member through approaches, fields at some of them: {step of the path: field}."""
    steps = np.arange(len(values))
    jumped = np.isin(steps, jumps).astype(float)
    kept = variables.pop("kept", steps)
    data = {
        "approach": (("member", "step"), np.array([values], float)),
        "jump": (("member", "step"), jumped[None]),
        "normal_gap": (("member", "snapshot", "x"), np.zeros((1, len(kept), 4))),
        "control": "approach",
        "approach_first_touch": -3.0,
    }
    coordinates = {"snapshot": np.asarray(values, float)[kept], "member": [0]}
    attributes = {"settings": json.dumps({"load": {"name": "approach"} | variables})}
    return xr.Dataset(data, coordinates, attributes)


def chosen_values(data, count):
    return data.snapshot.values[film.choose_frames(data, count)]


def test_frames_are_evenly_spaced_where_states_are_stored_at_even_steps():
    data = stored_path(np.arange(61) / 4)
    assert chosen_values(data, 16).tolist() == list(range(16))


def test_of_uneven_states_those_nearest_to_even_steps_are_chosen():
    data = stored_path([0.0, 0.9, 1.0, 2.2, 2.9, 4.0])
    assert chosen_values(data, 5).tolist() == [0.0, 1.0, 2.2, 2.9, 4.0]


def test_steps_are_even_along_the_way_to_and_fro():
    data = stored_path([0.0, 1.0, 2.0, 3.0, 2.5, 1.5, 0.5, -0.5])
    assert chosen_values(data, 4).tolist() == [0.0, 2.0, 1.5, -0.5]  # after 2 and 4.5 nm of 6.5; even: 2.17, 4.33
    assert chosen_values(data, 8).tolist() == data.snapshot.values.tolist()


def test_a_jump_gives_two_successive_frames_its_last_state_before_and_its_first_after():
    data = stored_path(np.arange(101) / 10, jumps=[43], kept=np.array([0, 20, 40, 42, 43, 46, 60, 80, 100]))
    assert chosen_values(data, 6).tolist() == [0.0, 2.0, 4.0, 4.2, 4.3, 6.0, 8.0, 10.0]
    coarse = stored_path(np.arange(101) / 10, jumps=[43], kept=np.arange(0, 101, 5))
    assert {4.0, 4.5} <= set(chosen_values(coarse, 3).tolist())


def test_a_jump_before_the_first_state_with_fields_gives_no_frame():
    data = stored_path(np.arange(101) / 10, jumps=[5], kept=np.arange(10, 101, 10))
    assert film.states_after_jumps(data.isel(member=0)) == []


def test_approaches_of_a_film_count_as_those_of_the_settings():
    values = np.arange(5.0)
    data = stored_path(values, origin="first_touch").assign_coords(snapshot=values + 3.0)  # from touch at -3 nm
    assert film.snapshot_steps(data.isel(member=0)).tolist() == [0, 1, 2, 3, 4]
    with pytest.raises(InputError, match="values of steps of the path"):
        film.snapshot_steps(data.assign_attrs(settings=json.dumps({"load": {}})).isel(member=0))


def test_a_dataset_without_fields_is_refused():
    data = stored_path(np.arange(5.0)).drop_dims("x")
    with pytest.raises(InputError, match=r"film: got .*allowed: a dataset with fields: of a study with `snapshots`"):
        film.choose_frames(data, 5)


def test_few_colours_keep_lines_and_areas_as_they_are():
    flat = [(255, 255, 255), (31, 78, 156), (217, 217, 217), (207, 227, 212), (0, 0, 0)]
    first = np.zeros((40, 50, 3), np.uint8)
    first[:] = np.repeat(flat, 10, axis=0)
    shades = np.zeros((40, 50, 3), np.uint8)
    shades[:] = np.random.default_rng(1).integers(0, 256, (40, 50, 3))
    reduced = film.reduce_colours([first, first, shades])
    assert (np.asarray(reduced[0].convert("RGB")) == first).all()
    assert len(reduced[2].getcolors()) <= film.COLOURS
    assert all(image.getpalette() == reduced[0].getpalette() for image in reduced)


# --- the films of this project ------------------------------------------------------------------------------------


def read_film(made, name):
    """The datasets of a film as the figure shows them, and the numbers of the states that it shows."""
    figure = PLAN.figures[name]
    paths = [made / f"results/quick/datasets/{PLAN.dataset_name(study)}.nc" for study in figure.studies]
    data = [layout.selected(dataset.load_dataset(path), figure.settings["select"]) for path in paths]
    return data, film.choose_frames(data[0], figure.settings["film"]["frames"])


def draw(name, data, frame):
    """The panels of a figure that shows one state."""
    settings = PLAN.figures[name].settings
    panels = list(Figure().subplots(settings["rows"], settings["panels"], squeeze=False).flat)
    plot = getattr(import_module(PLAN.figures[name].module), name)
    plot(*data, panels if len(panels) > 1 else panels[0], frame=frame, **settings["reference"])
    return panels


def test_time_or_load_is_the_story_of_four_films():
    assert {"contact_growth", "jump_and_pull_off", "rough_slide_forces", "peel_and_slip"} <= set(FILMS)


@pytest.mark.parametrize("name", PLAN.figures)
def test_each_figure_that_declares_a_film_has_one_and_no_other_has(made, name):
    file = made / f"results/quick/figures/{name}.gif"
    assert file.exists() == (name in FILMS)


@pytest.mark.parametrize("name", FILMS)
def test_a_film_is_small_and_has_a_frame_for_each_state(made, name):
    file = made / f"results/quick/figures/{name}.gif"
    assert file.stat().st_size <= MAX_BYTES
    _, frames = read_film(made, name)
    assert len(frames) <= MAX_FRAMES
    with Image.open(file) as pictures:
        assert pictures.n_frames == len(frames)
        times = []
        for number in range(pictures.n_frames):
            pictures.seek(number)
            times.append(pictures.info["duration"])
    assert set(times[:-1]) == {10 * (100 // PLAN.figures[name].settings["film"]["frames_per_second"])}
    assert times[-1] == 1000 * film.LAST_SECONDS


@pytest.mark.parametrize("name", FILMS)
def test_the_states_of_a_film_have_even_steps_but_for_those_beside_jumps(made, name):
    data, frames = read_film(made, name)
    path, dim = data[0].isel(member=0), film.frame_dimension(data[0])
    beside = film.states_after_jumps(path) if dim == film.SNAPSHOT else []
    assert all({after - 1, after} <= set(frames) for after in beside)
    values = path[dim].values
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(values)))])
    even = np.linspace(0.0, way[-1], PLAN.figures[name].settings["film"]["frames"])
    away = np.abs(way[frames] - even[:, None]).min(axis=1)
    turns = (np.diff(values) > 0).any() and (np.diff(values) < 0).any()
    assert away.max() <= (0.05 if turns else 1e-9)  # beside a turn states are stored at other approaches than before


@pytest.mark.parametrize("name", FILMS)
def test_the_curve_is_marked_at_the_state_of_the_picture(made, name):
    data, frames = read_film(made, name)
    path, dim = data[0].isel(member=0), film.frame_dimension(data[0])
    for frame in (frames[0], frames[len(frames) // 2], frames[-1]):
        marked = 0
        for panel in draw(name, data, frame):
            for mark in (line for line in panel.lines if line.get_gid() == MARK):
                (x,), (y,) = mark.get_data()
                assert x == pytest.approx(float(path[dim][frame]), abs=1e-9)
                points = np.concatenate([line.get_xydata() for line in panel.lines if line.get_gid() != MARK])
                assert np.abs(points - [x, y]).max(axis=1).min() < 1e-9
                marked += 1
        assert marked >= 1


@pytest.mark.parametrize("name", FILMS)
def test_limits_and_curves_stay_from_frame_to_frame_and_the_picture_changes(made, name):
    data, frames = read_film(made, name)
    first, last = (draw(name, data, frame) for frame in (frames[0], frames[-2]))
    for one, other in zip(first, last, strict=True):
        assert one.get_xlim() == other.get_xlim()
        assert one.get_ylim() == other.get_ylim()
    left, right = (one.images[0].get_array() if one.images else one.lines[0].get_ydata() for one in (first[0], last[0]))
    assert not np.array_equal(left, right)


# --- what is refused ----------------------------------------------------------------------------------------------

STUDY = {
    "title": "Rough",
    "surface": rough_study.ROUGH["surface"] | {"dimensions": 2},
    "body": {"kind": "half_space", "contact_modulus": 1.0},
    "effects": ["hard_wall"],
    "load": {"reduced_pressure": [0.1, 0.2, 0.3]},
    "keep": ["fields"],
    "points": 64,
    "tolerance": 1e-3,
}
FIGURE = {
    "study": "rough",
    "module": "moving_contacts",
    "title": "Film",
    "caption": "What it shows.",
    "size": [6.0, 3.0],
    "panels": 2,
    "film": {"frames": 3, "frames_per_second": 8.0},
}


def read_config(folder, study=(), **figure):
    """A plan of one study and one figure with a film."""
    name = figure.pop("name", "contact_growth")
    files = {
        "config.yaml": {"seed": 1, "tier": "plain", "results": "made"},
        "tiers.yaml": {"plain": {}},
        "ch3.yaml": {"studies": {"rough": STUDY | dict(study)}, "figures": {name: FIGURE | figure}},
    }
    for file, content in files.items():
        (folder / file).write_text(yaml.safe_dump(content, sort_keys=False))
    return Plan.read(folder)


def test_a_film_is_one_more_file_of_its_figure(tmp_path):
    assert read_config(tmp_path).figures["contact_growth"].endings == ("png", "pdf", "svg", "csv", "gif")


@pytest.mark.parametrize(
    ("study", "figure", "key", "allowed"),
    [
        ({"keep": ["contact"]}, {}, ".frames", "at most 0, the states of rough with fields: add `snapshots`, or loads"),
        ({}, {"film": {"frames": 4, "frames_per_second": 8.0}}, ".frames", "at most 3, the states of rough with"),
        ({"members": 2}, {}, "", "rough varies something or has several members"),
        ({"vary": {"surface.hurst_exponent": [0.2, 0.8]}}, {}, "", "rough varies something or has several members"),
        ({}, {"name": "fig_3_3", "module": "ch3"}, "", "a function with the keyword `frame`"),
        ({}, {"film": 6.0}, "", "a mapping with frames and frames_per_second"),
        ({}, {"film": {"frames": 61, "frames_per_second": 8.0}}, ".frames", "from 2 to 60"),
        ({}, {"film": {"frames": 3}}, ".frames_per_second", "the key is missing"),
    ],
)
def test_a_film_that_cannot_be_is_refused_with_what_is_wrong(tmp_path, study, figure, key, allowed):
    name = figure.get("name", "contact_growth")
    with pytest.raises(InputError) as caught:
        read_config(tmp_path, study, **figure)
    assert caught.value.key == f"figures.{name}.film{key}"
    assert allowed in str(caught.value)
