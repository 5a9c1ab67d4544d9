"""Contact stiffness, that of a flat punch of the same shape, against exact answers and differences of loads."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim as cs
from support.cases import orders, refused, rough, wave


def press(heights, pressure, **options):
    """Press heights of unit spacing on a body of unit modulus, to a tight tolerance."""
    options = {"tolerance": 1e-8, **options}
    return cs.press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=pressure, **options)


def area(points=64):
    """Return a rough surface."""
    return cs.SelfAffine(float(points), 0.8, points / 4, 8.0, 1.0, dimensions=2, seed=1).heights(points)


LAYERS = [(1.0, 0.3), (20.0, 0.3), (10.0, 0.49), (5.0, 0.4999), (1.0, 0.5), (3e2, 0.3), (3e3, 0.45), (1e5, 0.3)]
BODIES = [{}, {"periodic": False}, *({"thickness": thick, "poisson_ratio": ratio} for thick, ratio in LAYERS)]


@pytest.mark.parametrize("options", BODIES)
@pytest.mark.parametrize("pressure", [1e-7, 0.01, 0.1])
@pytest.mark.parametrize("heights", [rough(256), area()], ids=["line", "surface"])
def test_it_is_the_difference_quotient_of_load_and_approach(heights, pressure, options):
    stiffness = cs.contact_stiffness(press(heights, pressure, **options))
    change = 1e-5 * pressure
    below, above = (press(heights, pressure + sign * change, **options).approach for sign in (-1, 1))
    assert stiffness == pytest.approx(2 * change / (above - below), rel=1e-4)


def test_a_sphere_has_twice_radius_and_modulus():
    errors = []
    for points in (32, 64, 128):
        x = (np.arange(points) + 0.5) * 3 / points - 1.5
        heights = -(x[:, None] ** 2 + x**2) / 2
        result = cs.press(heights, spacing=3 / points, contact_modulus=2.0, mean_pressure=8 / 27, periodic=False)
        radius = 3 * np.sqrt(result.relative_contact_area / np.pi)  # that of the points
        errors.append(abs(9 * cs.contact_stiffness(result) / (4 * radius) - 1))
    assert errors[-1] < 4e-3
    assert np.mean(orders(errors)) == pytest.approx(1, abs=0.2)


def test_a_wave_is_as_stiff_as_flat_strips():
    """Strips of half-width a and period λ approach by -2pλ/(πE*) ln sin(πa/λ), of a single one 2P/(πE*) ln(λ/πa)."""
    points = 1024
    pressure = np.pi / points * 0.5  # half of that of full contact
    stiffness = cs.contact_stiffness(press(wave(points), pressure))
    half_width = points / np.pi * np.arcsin(np.sqrt(0.5))
    length = 2 * points / np.pi * -np.log(np.sin(np.pi * half_width / points))
    assert stiffness == pytest.approx(1 / length, rel=5e-3)


def test_without_contact_there_is_none_and_full_contact_does_not_give_way():
    assert cs.contact_stiffness(press(rough(64), 0.0)) == 0.0
    assert cs.contact_stiffness(press(wave(64), 1.0)) == np.inf
    layer = press(wave(64), 1.0, thickness=10.0, poisson_ratio=0.3)
    assert layer.contact.all()
    uniform = layer.scene.compliance(np.zeros(1))[0]
    assert cs.contact_stiffness(layer) == pytest.approx(1 / uniform, rel=1e-12)
    for thickness in (10.0, 1e6):
        assert cs.contact_stiffness(press(wave(64), 1e3, thickness=thickness, poisson_ratio=0.5)) == np.inf


@pytest.mark.parametrize("shape", [(16, 16), (24, 40), (32, 32), (48, 48), (64,)])
def test_full_contact_of_heights_that_are_alone_is_a_flat_punch(shape):
    heights, pressure = np.random.default_rng(0).normal(size=shape), 300.0
    stiffness = cs.contact_stiffness(press(heights, pressure, periodic=False))
    below, above = (press(heights, pressure * (1 + sign * 1e-4), periodic=False) for sign in (-1, 1))
    assert below.contact.all()
    assert stiffness == pytest.approx(2e-4 * pressure / (above.approach - below.approach), rel=1e-5)


@pytest.mark.parametrize("thickness", [1e4, 1e6, 1e9])
def test_a_thick_layer_is_a_half_space_on_a_uniform_spring(thickness):
    options = {"contact_modulus": 2.0, "mean_pressure": 0.05, "spacing": 1.0, "tolerance": 1e-9}
    layer = cs.press(wave(64), **options, thickness=thickness, poisson_ratio=0.3)
    half_space = cs.press(wave(64), **options)
    uniform = float(layer.scene.compliance(np.zeros(1))[0])
    expected = 1 / cs.contact_stiffness(half_space) + uniform
    assert 1 / cs.contact_stiffness(layer) == pytest.approx(expected, rel=1e-6)


def test_a_punch_that_does_not_converge_has_no_stiffness():
    assert np.isnan(cs.contact_stiffness(press(rough(64), 0.05), tolerance=1e-99))


def test_units_and_two_bodies_change_nothing_else():
    one = cs.contact_stiffness(press(rough(128), 0.05))
    other = cs.press(1e3 * rough(128), spacing=1e3, contact_modulus=7.0, mean_pressure=0.35, tolerance=1e-8)
    assert cs.contact_stiffness(other) == pytest.approx(7e-3 * one, rel=1e-6)


def test_a_circular_contact_conducts_as_holm_has_it():
    """Of two half-spaces of conductivity c through a circle of radius a: 2ac."""
    stiffness, modulus = 2 * 3.0 * 5.0, 5.0  # of a circle of radius 3 on E* = 5
    assert cs.conductance(stiffness, modulus, (2.0, 2.0)) == pytest.approx(2 * 3.0 * 2.0)
    several = cs.conductance([stiffness, 2 * stiffness], modulus, (2.0, 2.0))
    assert list(several) == pytest.approx([12.0, 24.0])
    assert cs.conductance(stiffness, modulus, (2.0, np.inf)) == pytest.approx(
        2 * cs.conductance(stiffness, modulus, (2.0, 2.0))
    )


def test_what_has_no_stiffness_is_refused():
    with refused("result", "a Result: press"):
        cs.contact_stiffness(rough(64))
    unsolved = press(rough(1024), 0.05, solver=cs_solver())
    with refused("result", "converged result"):
        cs.contact_stiffness(unsolved)
    for pair in ((1.0,), (0.0, 1.0), (np.inf, np.inf), 2.0, ("a", 1.0)):
        with refused("conductivities", "a pair of positive numbers"):
            cs.conductance(1.0, 1.0, pair)
    with refused("contact_modulus", "positive"):
        cs.conductance(1.0, -1.0, (1.0, 1.0))


def cs_solver():
    """Return a solver that gives up at once."""
    from contactsim.solvers.registry import make_solver

    return make_solver("polonsky_keer", budget=1, batch=1)


def test_a_punch_so_deep_that_the_surface_beside_it_touches_is_pressed_again(monkeypatch):
    options = {"thickness": 10.0, "poisson_ratio": 0.4999}
    expected = cs.contact_stiffness(press(area(), 1e-7, **options))
    monkeypatch.setattr("contactsim.paths.contact_stiffness.THICK", 0.0)
    assert cs.contact_stiffness(press(area(), 1e-7, **options)) == pytest.approx(expected, rel=1e-5)
