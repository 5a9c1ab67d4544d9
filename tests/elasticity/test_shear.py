"""Displacements under tractions along x, wave by wave."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.shear import shear_displacements
from contactsim.errors import InputError
from contactsim.grid import Grid

GRID = Grid((24, 40), (3.0, 5.0))


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.5])
@pytest.mark.parametrize(("down", "right"), [(0, 1), (2, 0), (3, 4), (-2, 5)])
def test_a_wave_is_displaced_by_its_direction_and_length(ratio, down, right):
    q = 2 * np.pi * np.array([down / 3.0, right / 5.0])
    y, x = GRID.positions(0)[:, None], GRID.positions(1)
    wave = np.cos(q[0] * y + q[1] * x + 0.4)
    along, across = shear_displacements(HalfSpace(2.0, ratio), GRID, wave)
    length = np.hypot(*q)
    sine, cosine = q / length
    normal = 2 / (2.0 * length) * wave
    assert along == pytest.approx((1 - ratio * cosine**2) / (1 - ratio) * normal, abs=1e-12)
    assert across == pytest.approx(-ratio * sine * cosine / (1 - ratio) * normal, abs=1e-12)


def test_on_a_line_both_components_are_alike_in_plane_strain():
    grid, traction = Grid((64,), (7.0,)), np.random.default_rng(2).normal(size=64)
    along, across = shear_displacements(HalfSpace(2.0), grid, traction)
    symbol = HalfSpace(2.0, 0.3).coupled_compliance(grid.wavenumber)
    assert along == pytest.approx(grid.backward(symbol.diagonal[1] * grid.forward(traction)), abs=1e-12)
    assert not across.any()


def test_a_uniform_traction_displaces_the_mean_alone_which_is_left_out():
    assert not np.any(shear_displacements(HalfSpace(1.0, 0.3), GRID, np.ones(GRID.shape)))


def test_a_surface_needs_a_poissons_ratio():
    with pytest.raises(InputError, match="poisson_ratio"):
        shear_displacements(HalfSpace(1.0), GRID, np.ones(GRID.shape))
