"""The response of a half-space to single elements, and its sum over many."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import dblquad, quad

from contactsim.elasticity import free_operator as free_operator_module
from contactsim.elasticity import free_response
from contactsim.elasticity.fourier_operator import RadialSymbol
from contactsim.elasticity.free_operator import FreeSurfaceOperator, free_operator, padded_size
from contactsim.elasticity.free_response import rectangle_response, strip_response
from contactsim.grid import Grid, TransformCounter


@pytest.mark.parametrize("distance", [0.0, 0.5, 1.0, -2.0, 7.0])
def test_a_strip_acts_as_the_integral_of_line_loads(distance):
    inside = [distance] if abs(distance) <= 0.5 else None
    exact = quad(lambda s: -2 / np.pi * np.log(abs(distance - s) / 9.0), -0.5, 0.5, points=inside)[0]
    assert strip_response(np.array([distance]), 9.0)[0] == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize("height", [1.0, 0.3])
@pytest.mark.parametrize("place", [(0.0, 1.0), (1.0, 0.0), (1.0, 2.0), (0.7, 3.0)])
def test_a_rectangle_acts_as_the_integral_of_point_loads(place, height):
    y, x = place
    exact = dblquad(lambda s, t: 1 / np.pi / np.hypot(x - s, y - t), -height / 2, height / 2, -0.5, 0.5)[0]
    assert rectangle_response(np.array([y]), np.array([x]), height)[0, 0] == pytest.approx(exact, rel=1e-9)


def test_the_centre_of_a_square_moves_as_love_has_it():
    assert rectangle_response(np.zeros(1), np.zeros(1), 1.0)[0, 0] == pytest.approx(
        4 * np.log(1 + np.sqrt(2)) / np.pi, rel=1e-14
    )


@pytest.mark.parametrize("height", [1000.0, 1e-3])
def test_long_elements_act_as_the_sum_of_their_parts(height):
    """Along the shorter side, further away than the moments of a part would ask for."""
    parts = 1000
    if height > 1:
        whole = rectangle_response(np.zeros(1), np.array([700.0]), height)[0, 0]
        places = np.abs(np.arange(parts) + 0.5 - parts / 2)
        summed = rectangle_response(places, np.array([700.0]), 1.0).sum()
    else:
        whole = rectangle_response(np.array([0.7]), np.zeros(1), height)[0, 0]
        places = np.abs(np.arange(parts) + 0.5 - parts / 2)
        summed = rectangle_response(np.array([700.0]), places, 1.0).sum() / parts
    assert whole == pytest.approx(summed, rel=1e-7)


@pytest.mark.parametrize("height", [1.0, 0.3])
def test_far_away_the_moments_give_what_the_formula_gives(height, monkeypatch):
    places = np.array([0.0, 40.0, 80.0])
    exact = rectangle_response(places * height, places, height)
    monkeypatch.setattr(free_response, "FAR_DISTANCE", 20.0)
    far = rectangle_response(places * height, places, height)
    assert far[0, 0] == exact[0, 0]
    assert far == pytest.approx(exact, rel=2e-6)
    assert (far != exact).sum() >= 7


def test_a_point_load_moves_the_surface_as_boussinesq_has_it():
    far = np.array([1e4])
    assert rectangle_response(np.zeros(1), far, 1.0)[0, 0] == pytest.approx(1 / (np.pi * 1e4), rel=1e-8)


@pytest.mark.parametrize("columns", [2**18, 40])
@pytest.mark.parametrize("shape", [(9,), (16,), (5, 8), (7, 6), (12, 31)])
def test_the_operator_sums_the_responses(shape, columns, monkeypatch):
    monkeypatch.setattr(free_operator_module, "COLUMN_BLOCK", columns)
    grid = Grid(shape, tuple(1.5 * size if size == shape[0] else float(size) for size in shape))
    pressure = np.random.default_rng(0).normal(size=shape)
    operator = free_operator(grid, None, TransformCounter(grid.size))
    apart = [np.abs(np.subtract.outer(np.arange(size), np.arange(size))) for size in shape]
    if len(shape) == 1:
        exact = strip_response(np.arange(shape[0]), shape[0])[apart[0]] @ pressure
    else:
        aspect = grid.spacing[0] / grid.spacing[1]
        table = rectangle_response(np.arange(shape[0]) * aspect, np.arange(shape[1]), aspect)
        exact = np.einsum("ijkl,jl->ik", table[apart[0][:, :, None, None], apart[1]], pressure)
    size = np.abs(exact).max()
    assert operator(pressure) == pytest.approx(exact, abs=1e-13 * size)
    if len(shape) == 1:
        assert operator(pressure, out=pressure) is pressure
        assert pressure == pytest.approx(exact, abs=1e-13 * size)
        return
    field, scratch, out = np.zeros((3, *grid.wide_shape), np.float32)
    field[:, : shape[1]] = pressure
    operator.in_single_precision()(field, scratch, out)
    assert out[:, : shape[1]] == pytest.approx(exact, abs=1e-5 * size)


@pytest.mark.parametrize("size", [*range(2, 60), 1021, 1031])
def test_zeros_are_added_up_to_an_even_number_without_large_factors(size):
    padded = padded_size(size)
    assert padded >= 2 * size
    assert padded % 2 == 0
    assert padded <= 2.4 * size + 4
    for factor in (2, 3, 5, 7, 11):
        while padded % factor == 0:
            padded //= factor
    assert padded == 1


def test_a_coarser_operator_has_the_same_response_in_units_of_its_spacing():
    grid = Grid((8, 12), (8.0, 12.0))
    symbol = RadialSymbol(grid, lambda q: 2 / np.maximum(q, 1e-9), 0.0)
    coarse = FreeSurfaceOperator(grid, symbol, TransformCounter(grid.size)).coarser((4, 6))
    pressure = np.random.default_rng(0).normal(size=(4, 6))
    own = FreeSurfaceOperator(Grid((4, 6), (4.0, 6.0)), symbol, TransformCounter(24))
    assert coarse(pressure) == pytest.approx(own(pressure), rel=1e-13)
    assert coarse.counter.transforms == pytest.approx(own.counter.transforms / 4)
