"""Contact with bodies of finite thickness: limits, exact answers, agreement of solvers, cost."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls

import contactsim
from contactsim.contact import loading
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.evaluation.robustness.cases import Case, layer_response
from contactsim.evaluation.robustness.judge import judge
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.interface.hard_wall import HardWall
from contactsim.solvers.base import solve
from contactsim.solvers.registry import make_solver
from contactsim.status import Status
from contactsim.surfaces.shapes import Flat, Sinusoid
from contactsim.traits import Trait
from support.cases import ALL, press, rough, wave

UNIAXIAL = 0.7**2 / 0.4
"""C11 at E* = 1 and ν = 0.3."""


def pressed(heights, *, ratio=0.3, thickness, name="active_set", tolerance=1e-6, **load):
    """Press into a layer of unit modulus at unit spacing; only converged answers count."""
    given_load = {"solver": name, "tolerance": tolerance} | load
    result = contactsim.press(
        heights, spacing=1.0, contact_modulus=1.0, thickness=thickness, poisson_ratio=ratio, **given_load
    )
    assert result.status is Status.CONVERGED
    return result


def scene(lower, upper=None, path=None, length=256.0):
    upper = Body(Sinusoid(length, 1.0), upper)
    return Scene(Body(Flat(length), lower), upper, (HardWall(),), path or loading.pressures([0.01]))


def solved(subject, points=256, tolerance=1e-8):
    problem, scale = pose_hard_wall(subject, subject.path.steps[0], subject.heights(points), tolerance, 1)
    result = solve(make_solver("active_set"), problem, scale)
    assert result.status is Status.CONVERGED
    return result


def response(points, ratio, thickness):
    q = 2 * np.pi * np.fft.rfftfreq(points)
    return layer_response(q * thickness, ratio) * thickness


# ---- limits


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("thickness", [1e4, 1e12, 1e100])
def test_a_thick_layer_is_a_half_space(name, ratio, thickness):
    heights = rough(256)
    half_space = press(heights, 0.03, name, tolerance=1e-6)
    layer = pressed(heights, ratio=ratio, thickness=thickness, name=name, mean_pressure=0.03)
    assert np.allclose(layer.pressure, half_space.pressure, rtol=0, atol=1e-12 * half_space.pressure.max())
    assert np.allclose(layer.gap, half_space.gap, rtol=0, atol=1e-11)
    uniform = thickness / UNIAXIAL if ratio == 0.3 else thickness * (1 - 2 * ratio) / (1 - ratio) ** 2
    assert layer.approach == pytest.approx(half_space.approach + uniform * 0.03, rel=1e-12)


@pytest.mark.parametrize("name", ALL)
def test_a_thin_compressible_layer_is_a_row_of_springs(name):
    heights, errors = 10 * wave(512), []
    for thickness in (0.4, 0.2, 0.1, 0.05):
        result = pressed(heights, thickness=thickness, name=name, mean_pressure=3.0 / thickness, tolerance=1e-9)
        springs = UNIAXIAL / thickness * np.maximum(heights + result.approach, 0.0)
        errors.append(np.abs(result.pressure - springs).max() / springs.max())
    # S is even in qh, so on one grid the error falls with its square
    assert errors[0] < 1e-4
    assert np.log2(errors[-2] / errors[-1]) == pytest.approx(2, abs=0.1)


def test_a_very_thin_layer_is_a_row_of_springs_to_many_digits_at_a_given_approach():
    heights = rough(512)
    result = pressed(heights, thickness=1e-7, approach=-1.0, tolerance=1e-8)
    springs = UNIAXIAL / 1e-7 * np.maximum(heights - 1.0, 0.0)
    assert np.allclose(result.pressure, springs, rtol=0, atol=1e-6 * springs.max())


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("ratio", [-0.5, 0.3, 0.5])
@pytest.mark.parametrize("thickness", [1.0, 30.0, 1e3])
def test_a_wave_in_complete_contact_has_the_pressure_height_over_compliance(name, ratio, thickness):
    amplitude = 1 / response(256, ratio, thickness)[3]
    heights = np.cos(2 * np.pi * 3 * np.arange(256) / 256)
    result = pressed(heights, ratio=ratio, thickness=thickness, name=name, mean_pressure=1.01 * amplitude)
    assert result.contact.all()
    assert np.allclose(result.pressure, amplitude * (1.01 + heights), rtol=0, atol=1e-5 * amplitude)
    sunk = response(256, ratio, thickness)[0] * result.mean_pressure
    assert result.approach == pytest.approx(sunk, abs=1e-6 * (1 + sunk))


# ---- agreement


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.49, 0.5])
@pytest.mark.parametrize("thickness", [0.5, 3.0, 12.0, 100.0])
def test_the_answer_is_that_of_a_dense_quadratic_programme(name, ratio, thickness):
    points, load = 48, 0.05
    heights = rough(points, modes=12)
    result = pressed(heights, ratio=ratio, thickness=thickness, name=name, mean_pressure=load, tolerance=1e-8)
    symbol = response(points, ratio, thickness)
    symbol[0] = 0.0  # at a given load it only shifts the gap
    first = np.fft.irfft(symbol, points)
    matrix = first[(np.arange(points)[:, None] - np.arange(points)) % points]
    values, vectors = np.linalg.eigh(matrix)
    keep = values > 1e-9 * values.max()
    root = np.sqrt(values[keep])[:, None] * vectors[:, keep].T
    target = vectors[:, keep].T @ heights / np.sqrt(values[keep])
    exact, _ = nnls(np.vstack([root, 1e5 * np.ones(points)]), np.append(target, 1e5 * load * points))
    assert np.array_equal(result.contact, exact > 1e-9 * exact.max())
    assert np.allclose(result.pressure, exact, rtol=0, atol=1e-4 * exact.max())


@settings(max_examples=150, deadline=None, derandomize=True)
@given(
    st.integers(2, 200),
    st.integers(0, 1 << 16),
    st.floats(0, 0.999),
    st.floats(0, 4),
    st.sampled_from([-0.9, 0.0, 0.3, 0.45, 0.4999, 0.5]),
    st.floats(-6, 2),
)
def test_any_heights_on_any_layer_are_certified(points, seed, share, thickness, ratio, load):
    field = np.random.default_rng(seed).normal(size=points)
    heights = field - np.quantile(field, share)
    step = np.sqrt(np.mean(np.diff(heights, append=heights[0]) ** 2))
    case = Case(heights, 10**load * step, tolerance=1e-3, thickness=10**thickness, poisson_ratio=ratio)
    verdict = judge(case, "active_set")
    assert verdict.outcome is Outcome.CERTIFIED, verdict.reason


# ---- approach


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.499, 0.5])
@pytest.mark.parametrize("thickness", [3.0, 40.0, 1e4])
def test_an_approach_and_the_pressure_that_it_needs_have_the_same_solution(ratio, thickness):
    heights = rough(256)
    for load in (1e-3, 0.05):
        loaded = pressed(heights, ratio=ratio, thickness=thickness, mean_pressure=load, tolerance=1e-8)
        moved = pressed(heights, ratio=ratio, thickness=thickness, approach=loaded.approach, tolerance=1e-8)
        assert moved.mean_pressure == pytest.approx(load, rel=1e-5)
        assert np.array_equal(moved.contact, loaded.contact)


@pytest.mark.parametrize("approach", [1e-9, 1.0, 1e9])
def test_a_plane_pushed_into_a_layer_is_in_uniform_contact(approach):
    result = pressed(np.full(32, 7.0), thickness=5.0, approach=approach - 7.0)
    assert np.allclose(result.pressure, result.mean_pressure, rtol=1e-9)
    assert result.mean_pressure == pytest.approx(approach * UNIAXIAL / 5.0, rel=1e-6)


def test_an_incompressible_layer_keeps_its_volume():
    heights = rough(256) + 2.0
    result = pressed(heights, ratio=0.5, thickness=20.0, mean_pressure=0.05, tolerance=1e-8)
    assert result.gap.mean() == pytest.approx(-result.approach - heights.mean(), abs=1e-9)
    with pytest.raises(InputError, match="an incompressible layer keeps its volume") as caught:
        pressed(heights, ratio=0.5, thickness=20.0, approach=-1.99)
    assert caught.value.key == "approach"
    deep = pressed(heights, ratio=0.5, thickness=20.0, approach=-2.0 - 1e-3, tolerance=1e-8)
    assert 0.5 < deep.relative_contact_area < 1


# ---- two bodies


def test_a_layer_and_a_half_space_in_series_add_what_they_yield():
    both = scene(Layer(2.0, 0.3, 30.0), HalfSpace(3.0))
    q = np.linspace(0, 3, 20)
    parts = Layer(2.0, 0.3, 30.0).compliance(q) + HalfSpace(3.0).compliance(q)
    assert np.array_equal(both.compliance(q), parts)
    assert {Trait.LAYER, Trait.HALF_SPACE} < both.traits
    swapped = scene(HalfSpace(3.0), Layer(2.0, 0.3, 30.0))
    assert np.allclose(solved(both).pressure, solved(swapped).pressure, rtol=1e-12)


def test_on_a_half_space_the_mean_of_the_layer_alone_enters_the_approach():
    both = solved(scene(Layer(2.0, 0.3, 30.0), HalfSpace(3.0)))
    sunk = 30.0 / (2.0 * UNIAXIAL) * both.mean_pressure
    assert both.gap.mean() == pytest.approx(sunk - both.approach, abs=1e-9)  # heights of mean zero
    moved = solved(scene(Layer(2.0, 0.3, 30.0), HalfSpace(3.0), loading.approaches([both.approach])))
    assert moved.mean_pressure == pytest.approx(both.mean_pressure, rel=1e-6)


def test_two_equal_layers_are_one_of_half_the_modulus():
    twice = solved(scene(Layer(2.0, 0.3, 30.0), Layer(2.0, 0.3, 30.0)))
    once = solved(scene(Layer(1.0, 0.3, 30.0)))
    assert np.allclose(twice.pressure, once.pressure, rtol=1e-9)
    assert twice.approach == pytest.approx(once.approach)


# ---- cost


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.45])
def test_no_thickness_costs_much_more_than_a_half_space(ratio):
    heights = rough(2**12, modes=512)
    for height in (-1.0, 0.0):  # of a plane through the profile: what a row of springs would bring into contact
        half_space = contactsim.press(heights, spacing=1.0, contact_modulus=1.0, approach=height - 40.0)
        for thickness in np.geomspace(1.0, 1e6, 7):
            layer = pressed(heights, ratio=ratio, thickness=thickness, approach=height - 40.0, tolerance=1e-3)
            assert layer.record.transforms < 1.5 * half_space.record.transforms


def test_complete_contact_costs_next_to_nothing():
    assert pressed(0.01 * rough(4096), thickness=100.0, mean_pressure=1.0, tolerance=1e-3).record.transforms < 20


# ---- units


def test_units_do_not_matter_to_a_layer():
    heights = rough(256)
    reference = pressed(heights, thickness=20.0, mean_pressure=0.03)
    for unit in (1e-9, 1e9):
        result = contactsim.press(
            unit * heights,
            spacing=unit,
            contact_modulus=7.0,
            thickness=20.0 * unit,
            poisson_ratio=0.3,
            mean_pressure=0.21,
            tolerance=1e-6,
        )
        assert np.allclose(result.pressure / 7, reference.pressure, rtol=1e-6, atol=1e-9)
        assert result.approach == pytest.approx(unit * reference.approach)
