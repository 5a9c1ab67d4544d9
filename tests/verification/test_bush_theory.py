"""The theory of Bush, Gibson and Thomas against its limits and against summits drawn at random."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import ellipe, ellipk

from contactsim.reference.bush import _ellipse, bush_area
from support.cases import refused


def test_a_round_summit_is_a_hertzian_sphere():
    area, load = _ellipse(np.array([1e-6]))
    assert area[0] == pytest.approx(np.pi, rel=1e-5)
    assert load[0] == pytest.approx(4 / 3, rel=1e-5)


def test_an_ellipse_has_the_curvatures_of_its_summit():
    """Johnson 1985, Eqs 4.26: its curvatures by the half-axes, from the area and load that are returned."""
    shape = np.array([0.1, 0.5, 0.9])
    area, load = _ellipse(shape)
    for ratio, product, force in zip((1 + shape) / (1 - shape), area / np.pi, load, strict=True):
        squares = np.linspace(1e-6, 0.99999, 200001)
        first, second = ellipk(squares), ellipe(squares)
        square = np.interp(np.log(ratio), np.log((second / (1 - squares) - first) / (first - second)), squares)
        long = np.sqrt(product / np.sqrt(1 - square))
        assert force == pytest.approx(2 * np.pi / 3 * long / ellipk(square), rel=1e-4)  # δ = p₀ b K/E*


@pytest.mark.parametrize("nayak", [1.6, 2.0, 10.0])
def test_the_factor_of_vanishing_load_is_the_root_of_two_pi(nayak):
    pressure = np.logspace(-8, -1, 8)
    distance = 1 - bush_area(pressure, nayak) / pressure / np.sqrt(2 * np.pi)
    assert (np.diff(distance) > 0).all()
    assert (distance > 0).all()
    assert distance[0] == pytest.approx(0, abs={1.6: 0.012, 2.0: 0.015, 10.0: 0.09}[nayak])


@pytest.mark.parametrize("nayak", [2.0, 6.0])
def test_it_is_the_sum_over_random_summits(nayak):
    """Heights and second derivatives of a Gaussian field with m₀ = m₂ = 1 and m₄ = α, weighted by |det H|/(2π)."""
    rng = np.random.default_rng(3)
    covariance = [[1, -1, -1, 0], [-1, nayak, nayak / 3, 0], [-1, nayak / 3, nayak, 0], [0, 0, 0, nayak / 3]]
    z, along, across, mixed = rng.multivariate_normal(np.zeros(4), covariance, 4_000_000).T
    mean, half = -(along + across) / 2, np.hypot((along - across) / 2, mixed)
    is_summit = mean > half
    z, mean, half = z[is_summit], mean[is_summit], half[is_summit]
    overlap = np.maximum(z - 2.0, 0.0)
    nodes = np.linspace(1e-4, 0.9999, 400)
    areas, loads = (np.interp(half / mean, nodes, factor) for factor in _ellipse(nodes))
    weights = (mean**2 - half**2) / (2 * np.pi * is_summit.size)
    area = np.sum(weights * areas * overlap / mean)
    pressure = np.sum(weights * loads * overlap**1.5 / np.sqrt(mean)) / np.sqrt(2)
    assert bush_area(pressure, nayak) == pytest.approx(area, rel=0.01)


def test_what_it_does_not_reach_is_nan_and_no_surface_is_refused():
    assert np.isnan(bush_area(np.array([0.0, 100.0]), 3.0)).all()
    for nayak in (1.5, np.nan, "a"):
        with refused("nayak_parameter", "1.6 or more"):
            bush_area(0.1, nayak)
