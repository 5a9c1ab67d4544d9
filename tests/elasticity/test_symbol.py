"""Symbols of one and two components: products, inverses, held modes, pairs of bodies on a grid."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.elasticity.base import relative_compliance
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.elasticity.symbol import CoupledSymbol, NormalSymbol
from contactsim.errors import InputError
from contactsim.grid import Grid

BOTH, ONE = ("n", "t"), ("n",)
LINE = Grid((64,), (50.0,))


def random_coefficients(rows: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.stack([LINE.forward(rng.normal(size=64)) for _ in range(rows)])


@pytest.fixture(params=[ONE, BOTH], ids=["n", "nt"])
def symbol(request) -> NormalSymbol | CoupledSymbol:
    return relative_compliance(Layer(2.0, 0.2, 9.0), HalfSpace(3.0, 0.4), LINE, request.param)


def test_a_symbol_multiplies_by_its_matrices(symbol):
    coefficients = random_coefficients(len(symbol.components))
    nn = symbol.diagonal[0]
    expected = [nn * coefficients[0]]
    if len(coefficients) == 2:
        expected = [
            nn * coefficients[0] + 1j * symbol.coupling * coefficients[1],
            symbol.diagonal[1] * coefficients[1] - 1j * symbol.coupling * coefficients[0],
        ]
    assert np.allclose(symbol.apply(coefficients), expected, rtol=1e-14)
    buffer = np.empty_like(coefficients)
    assert symbol.apply(coefficients, out=buffer) is buffer
    assert np.array_equal(buffer, symbol.apply(coefficients))
    symbol.apply(coefficients, out=coefficients)
    assert np.array_equal(coefficients, buffer)


@pytest.mark.parametrize("shift", [0.0, 0.3, (0.3, 0.01)])
def test_an_inverse_undoes_the_symbol_plus_its_shift(symbol, shift):
    shift = np.atleast_1d(shift)[: len(symbol.components)]
    coefficients = random_coefficients(len(symbol.components))
    shifted = symbol.apply(coefficients) + shift[..., None] * coefficients
    assert np.allclose(symbol.inverse(shift).apply(shifted), coefficients, rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize("components", [ONE, BOTH])
def test_held_modes_are_left_out_of_every_inverse(components):
    for body in (HalfSpace(1.0, 0.3), Layer(1.0, 0.5, 3.0)):
        compliance = relative_compliance(body, None, LINE, components)
        rows = [True, body.base_depth == np.inf][: len(components)]
        for inverse in (compliance.inverse(), compliance.inverse(0.7), compliance.inverse(0.7).inverse(2.0)):
            assert inverse.held[:, 0].tolist() == rows
            assert not inverse.held[:, 1:].any()
            assert np.isfinite(inverse.diagonal).all()
            answer = inverse.apply(np.ones((len(components), 33), complex))
            assert (answer[:, 0] == 0).tolist() == rows


def test_twice_inverted_is_the_same(symbol):
    again = symbol.inverse().inverse()
    assert np.allclose(again.diagonal, symbol.diagonal, rtol=1e-14)


def test_two_equal_bodies_do_not_slip_under_a_normal_load():
    body = Layer(2.0, 0.1, 9.0)
    pair = relative_compliance(body, body, LINE, BOTH)
    assert not pair.coupling.any()
    one = relative_compliance(body, None, LINE, BOTH)
    assert np.allclose(pair.diagonal, 2 * one.diagonal)


def test_a_pair_moves_as_its_two_bodies_do():
    """The upper body solved as a lower one upside down, and turned back."""
    lower, upper = Layer(2.0, 0.1, 9.0), HalfSpace(1.0, 0.35)
    traction = random_coefficients(2)
    below = relative_compliance(lower, None, LINE, BOTH).apply(traction)
    above = relative_compliance(upper, None, LINE, BOTH).apply(traction * [[1], [-1]]) * [[-1], [1]]
    pair = relative_compliance(lower, upper, LINE, BOTH)
    assert np.allclose(pair.apply(traction), below - above, rtol=1e-14)
    assert np.allclose(pair.inverse().apply(below - above)[:, 1:], traction[:, 1:])
    turned = relative_compliance(upper, lower, LINE, BOTH)
    assert np.allclose(turned.diagonal, pair.diagonal)
    assert np.allclose(turned.coupling, -pair.coupling)


@pytest.mark.parametrize(("points", "coupled"), [(64, False), (63, True)])
def test_the_shortest_wave_of_an_even_grid_is_not_coupled(points, coupled):
    body, grid = Layer(2.0, 0.1, 9.0), Grid((points,), (50.0,))
    for symbol in (relative_compliance(body, None, grid, BOTH), relative_compliance(body, None, grid, BOTH).inverse()):
        assert (symbol.coupling[-1] != 0) == coupled
        assert symbol.coupling[1:-1].all()
    normal = relative_compliance(body, None, grid, ONE).inverse().diagonal[0]
    assert np.allclose(1 / normal, body.compliance(grid.wavenumber), rtol=1e-15)


def test_closed_stiffness_and_inverse_compliance_agree():
    body = Layer(2.0, 0.49, 9.0)
    inverse = relative_compliance(body, None, Grid((63,), (50.0,)), BOTH).inverse()
    closed = body.coupled_stiffness(Grid((63,), (50.0,)).wavenumber)
    assert np.allclose(inverse.diagonal, closed.diagonal, rtol=1e-14)
    assert np.allclose(inverse.coupling, closed.coupling, rtol=1e-13)


@pytest.mark.parametrize("body", [Layer(2.0, 0.1, 9.0), HalfSpace(2.0, 0.1)])
def test_where_no_shear_acts_the_slip_follows_from_the_normal_displacement(body):
    compliance = relative_compliance(body, None, LINE, BOTH)
    traction = random_coefficients(2) * [[1], [0]]
    normal, along = compliance.apply(traction)
    assert np.allclose(compliance.without_shear().apply(traction[:1])[0], normal, rtol=1e-15)
    assert np.allclose(compliance.slip() * normal, along, rtol=1e-14)


def test_a_pressed_surface_is_drawn_towards_the_load():
    """Mirror symmetry, and the sign: next to a pressed strip the surface of a compressible body moves inwards."""
    x = LINE.positions() - 25.0
    pressure = np.exp(-((x / 3) ** 2))
    traction = np.stack([-LINE.forward(pressure), np.zeros(33)])
    normal, along = map(LINE.backward, relative_compliance(HalfSpace(1.0, 0.2), None, LINE, BOTH).apply(traction))
    assert np.allclose(normal[1:], normal[:0:-1], atol=1e-13)
    assert np.allclose(along[1:], -along[:0:-1], atol=1e-13)
    assert normal.argmin() == 32
    assert (along[34:40] < 0).all()


def test_surfaces_have_a_normal_component_alone():
    area, body = Grid((8, 8), (5.0, 5.0)), HalfSpace(1.0, 0.3)
    assert np.allclose(relative_compliance(body, None, area, ONE).diagonal[0], body.compliance(area.wavenumber))
    assert relative_compliance(body, None, area, ONE).inverse().diagonal[0, 0, 0] == 0
    with pytest.raises(InputError, match="surfaces are not modelled") as caught:
        relative_compliance(body, None, area, BOTH)
    assert caught.value.key == "components"
    with pytest.raises(InputError, match="at least one of the two"):
        relative_compliance(None, None, LINE, ONE).inverse()
