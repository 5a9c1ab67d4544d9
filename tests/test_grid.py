from __future__ import annotations

import numpy as np
import pytest

from contactsim.elasticity.fourier_operator import FourierOperator, RadialSymbol
from contactsim.errors import InputError
from contactsim.grid import Grid, OutOfWorkError, TransformCounter

SIZES = (2, 3, 8, 101, 1024)


@pytest.mark.parametrize("points", SIZES)
def test_the_zeroth_coefficient_is_the_mean(points):
    values = np.random.default_rng(0).normal(size=points)
    half = Grid((points,), (3.0,)).forward(values)
    assert half[0] == pytest.approx(values.mean(), abs=1e-15)


@pytest.mark.parametrize("points", SIZES)
def test_backward_undoes_forward(points):
    grid = Grid((points,), (3.0,))
    values = np.random.default_rng(1).normal(size=points)
    assert np.allclose(grid.backward(grid.forward(values)), values, rtol=0, atol=1e-14)


@pytest.mark.parametrize("points", SIZES)
def test_wavenumbers_are_those_of_numpy(points):
    grid = Grid((points,), (5.0,))
    assert np.allclose(grid.wavenumber, 2 * np.pi * np.arange(points // 2 + 1) / 5.0, rtol=1e-14)


def test_an_operator_multiplies_a_wave_by_its_symbol_and_counts_two_transforms():
    grid, counter = Grid((64,), (64.0,)), TransformCounter(128)
    operator = FourierOperator(grid, grid.wavenumber**2, counter)
    wave = np.sin(2 * np.pi * 3 * np.arange(64) / 64)
    assert np.allclose(operator(wave), (2 * np.pi * 3 / 64) ** 2 * wave, atol=1e-14)
    assert counter.transforms == 1.0  # two on half as many points as the finest grid


def test_an_operator_works_in_place():
    grid = Grid((32,), (32.0,))
    operator = FourierOperator(grid, np.ones(17), TransformCounter(32))
    values = np.random.default_rng(2).normal(size=32)
    result = values.copy()
    assert operator(result, out=result) is result
    assert np.allclose(result, values)


def test_the_number_of_threads_does_not_change_a_transform():
    values = np.random.default_rng(3).normal(size=4096)
    one, two = (Grid((4096,), (1.0,), threads).forward(values) for threads in (1, 2))
    assert np.array_equal(one, two)


@pytest.mark.parametrize(
    ("shape", "lengths", "threads", "key"),
    [
        ((1,), (1.0,), 1, "points"),
        ((8,), (-1.0,), 1, "length"),
        ((8,), (np.nan,), 1, "length"),
        ((8,), (1.0,), 0, "threads"),
    ],
)
def test_an_impossible_grid_is_refused_by_key(shape, lengths, threads, key):
    with pytest.raises(InputError) as caught:
        Grid(shape, lengths, threads)
    assert caught.value.key == key


@pytest.mark.parametrize("shape", [(2, 6), (3, 8), (8, 7), (9, 5)])
def test_a_radial_symbol_by_rows_folded_and_held_is_the_whole_one(shape):
    grid = Grid(shape, (2.0, 3.0))
    symbol = RadialSymbol(grid, lambda q: 1 / (1 + q), 0.25)
    whole = grid.of_wavenumber(lambda q: 1 / (1 + q))
    whole[0, 0] = 0.25
    np.testing.assert_array_equal(symbol.rows(0, shape[0]), whole)
    folded = np.empty_like(whole)
    for place, values in symbol.folded():
        folded[place] = values
    np.testing.assert_array_equal(folded, whole)
    field = np.random.default_rng(3).standard_normal(shape)
    operator = FourierOperator(grid, symbol, TransformCounter(grid.size))
    before = operator(field)
    operator.hold_symbol()
    np.testing.assert_array_equal(operator(field), before)
    np.testing.assert_allclose(before, grid.backward(grid.forward(field) * whole), atol=1e-14)


def test_dense_matrices_are_paid_from_the_work_granted_but_count_as_no_transforms():
    counter = TransformCounter(1024)
    counter.add_factors(40)
    few, spent = counter.spent, counter.spent
    counter.add_factors(80)
    assert counter.spent - spent == pytest.approx(8 * few)  # an unknown cubed
    assert counter.transforms == 0
    with counter.granted(10):
        counter.add(5, 1024)
        counter.add_factors(1000)
        with pytest.raises(OutOfWorkError):
            counter.add(1, 1024)
    counter.add(1000, 1024)  # nothing is limited any more
