"""Scenes with a layer: who solves them, how they are explained and drawn, and what is refused."""

from __future__ import annotations

import tracemalloc

import matplotlib.pyplot as plt
import pytest

import contactsim
from contactsim.contact import loading
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.explanation import Explanation, explain_setup
from contactsim.figures.sketch import plot_sketch
from contactsim.interface.hard_wall import HardWall
from contactsim.paths.options import RunOptions, Setup
from contactsim.solvers.base import check_solver
from contactsim.solvers.hard_wall.active_set import ActiveSet
from contactsim.solvers.registry import make_solver, solver_class
from contactsim.study.scenes import build_scene
from contactsim.surfaces.shapes import Flat, Sinusoid
from contactsim.traits import Trait
from support.cases import ALL, rough


def scene(lower, upper=None, path=None, length=256.0):
    upper = Body(Sinusoid(length, 1.0), upper)
    return Scene(Body(Flat(length), lower), upper, (HardWall(),), path or loading.pressures([0.01]))


def explained(subject: Scene, points: int = 256) -> Explanation:
    return explain_setup(Setup(subject, RunOptions(points, solver=make_solver("active_set"))))


@pytest.mark.parametrize("name", ALL)
def test_every_solver_accepts_a_layer(name):
    assert scene(Layer(1.0, 0.3, 1.0)).traits == {Trait.LINE, Trait.WALL, Trait.LAYER, Trait.MEAN_PRESSURE}
    check_solver(make_solver(name), scene(Layer(1.0, 0.3, 1.0)))


def test_a_solver_that_knows_half_spaces_alone_refuses_a_layer():
    assert Trait.LAYER not in solver_class("tamaas").accepts

    class Elder(ActiveSet):
        accepts = ActiveSet.accepts - {Trait.LAYER}

    with pytest.raises(InputError, match=r"accepts LAYER \(layer on a rigid base"):
        check_solver(Elder(), scene(Layer(1.0, 0.3, 1.0)))


def test_an_explanation_names_the_layer_and_says_where_the_volume_is_fixed():
    explanation = explained(scene(Layer(1.0, 0.3, 100.0)))
    assert explanation.bodies[1] == "Flat, Layer with E* = 1 GPa, Poisson's ratio 0.3, thickness 100 nm"
    assert "mean displacement" not in explanation.missing
    assert {name: explanation.solvers[name] for name in ALL} == dict.fromkeys(ALL, "")
    for ratio, named in ((None, ""), (0.3, ", Poisson's ratio 0.3")):
        bodies = explained(scene(HalfSpace(1.0, ratio))).bodies
        assert bodies[1] == f"Flat, HalfSpace with E* = 1 GPa{named}"
    incompressible = explained(scene(Layer(1.0, 0.5, 100.0)))
    assert incompressible.missing["mean displacement"] == "an incompressible layer keeps its volume"
    free = explained(scene(Layer(1.0, 0.5, 100.0), HalfSpace(1.0)))
    assert free.missing["mean displacement"].startswith("zero by convention")
    compressible = explained(scene(Layer(1.0, 0.3, 100.0), HalfSpace(1.0)))
    assert "mean displacement" not in compressible.missing


def test_peak_memory_on_a_layer_is_within_what_is_explained():
    points, peaks = 2**15, []
    for thickness in (1.0, 1e2, 1e4):
        tracemalloc.start()
        contactsim.press(
            rough(points), spacing=1.0, contact_modulus=1.0, thickness=thickness, poisson_ratio=0.5, mean_pressure=0.3
        )
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    expected = 1e6 * explained(scene(Layer(1.0, 0.5, 1.0)), points).megabytes
    assert 0.6 * expected < max(peaks) < expected


@pytest.mark.parametrize(("thickness", "drawn"), [(2.5, 2.5), (0.01, 0.8), (1e6, 3.2)])
def test_a_layer_is_drawn_to_scale_where_that_can_be_seen_and_says_so_where_not(thickness, drawn):
    figure, axes = plt.subplots()
    plot_sketch(scene(Layer(1.0, 0.3, thickness)), 256, axes)
    words = [text.get_text() for text in axes.texts]
    assert any("not to scale" in text for text in words) == (drawn != thickness)
    assert any(f"{thickness:g} nm" in text for text in words)
    assert min(collection.get_datalim(axes.transData).y0 for collection in axes.collections) < -drawn
    plt.close(figure)


def test_a_ratio_without_a_thickness_and_a_thickness_without_a_ratio_are_refused():
    given_load = {"spacing": 1.0, "contact_modulus": 1.0, "mean_pressure": 0.1}
    with pytest.raises(InputError, match="none without a thickness") as caught:
        contactsim.press([0.0, 1.0], poisson_ratio=0.3, **given_load)
    assert caught.value.key == "poisson_ratio"
    with pytest.raises(InputError, match=r"at most 0\.5") as caught:
        contactsim.press([0.0, 1.0], thickness=1.0, **given_load)
    assert caught.value.key == "poisson_ratio"


def test_a_study_may_have_a_layer_but_not_ask_it_for_the_load_of_a_half_space():
    section = {
        "surface": {"kind": "cylinder", "radius": 100.0, "length": 400.0},
        "body": {"kind": "layer", "contact_modulus": 1.0, "poisson_ratio": 0.4, "thickness": 50.0},
        "effects": ["hard_wall"],
        "load": {"name": "mean_pressure", "values": [0.01]},
    }
    assert build_scene(section).elasticities == (Layer(1.0, 0.4, 50.0),)
    with pytest.raises(InputError, match=r"Eq. 3.5 holds on a half-space"):
        build_scene(section | {"load": {"name": "contact_ratio", "values": [0.1]}})
