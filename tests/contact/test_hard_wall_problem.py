"""The problem at a hard wall: on fewer points, and what its certificate says of a pressure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contactsim.contact.certificate import Certificate
from contactsim.contact.loading import approaches, pressures
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.interface.hard_wall import HardWall
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.topography import Topography


def posed(heights, spacing, body, path):
    surface = Topography(heights, spacing=spacing)
    scene = Scene(Body(Flat.facing(surface), body), Body(surface), (HardWall(),), path)
    return pose_hard_wall(scene, path.steps[0], heights, 1e-3, 1)


def symbol_of(problem):
    symbol = problem.compliance.symbol
    return symbol if len(problem.shape) == 1 else symbol.rows(0, problem.shape[0])


@pytest.mark.parametrize("path", [pressures([0.3]), approaches([-1.5])], ids=["load", "approach"])
@pytest.mark.parametrize("body", [HalfSpace(2.0), Layer(2.0, 0.3, 5.0)], ids=["half-space", "layer"])
@pytest.mark.parametrize("shape", [(64,), (32, 64)], ids=["line", "surface"])
def test_a_coarser_level_is_the_problem_of_every_second_point(shape, body, path):
    heights = np.random.default_rng(3).normal(size=shape)
    problem, scale = posed(heights, 0.7, body, path)
    level, step = problem.coarser(1e-3), 2 * scale.step
    exact, exact_scale = posed(heights[(slice(None, None, 2),) * len(shape)], 1.4, body, path)
    np.testing.assert_allclose(level.profile[...] * step, exact.profile[...] * exact_scale.step, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(symbol_of(level), symbol_of(exact), rtol=1e-12)
    if exact.approach is None:
        assert level.load * scale.pressure == pytest.approx(exact.load * exact_scale.pressure, rel=1e-12)
    else:
        assert level.approach * step == pytest.approx(exact.approach * exact_scale.step, rel=1e-12)


@pytest.mark.parametrize("body", [HalfSpace(2.0), Layer(2.0, 0.3, 5.0)], ids=["half-space", "layer"])
def test_a_certificate_counts_the_approach_from_the_mean_gap_of_the_contact(body):
    problem, _ = posed(np.random.default_rng(3).normal(size=64), 0.7, body, pressures([0.3]))
    pressure = problem.project(np.random.default_rng(4).normal(size=64))
    certificate, gap = problem.certify(pressure)
    contact = pressure > 0
    assert gap[contact].mean() == pytest.approx(0, abs=1e-12)
    assert certificate.max_contact_gap == np.abs(gap[contact]).max()
    assert certificate.penetration == max(0.0, -gap[~contact].min())
    by_height = problem.compliance(pressure) - problem.heights - certificate.approach
    np.testing.assert_allclose(gap, by_height, atol=1e-12)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("values", [(np.inf, -np.inf), (np.nan, 1.0), (1.5e308, 1.5e308)], ids=["inf", "nan", "large"])
def test_a_pressure_without_bounds_has_no_certificate_and_raises_nothing(values):
    problem, _ = posed(np.random.default_rng(3).normal(size=(1024, 1024)), 0.7, HalfSpace(2.0), pressures([0.3]))
    pressure = np.zeros((1024, 1024))
    pressure[0, 0], pressure[-1, 0] = values  # in different blocks
    assert not problem.certify(pressure)[0].met(1e-3)
    problem.project(pressure)


def test_what_overlaps_pulls_or_carries_another_load_is_no_solution():
    solved = Certificate(max_contact_gap=1e-4, penetration=1e-4, min_pressure=0.0, load_error=1e-13, approach=1.0)
    assert solved.met(1e-3)
    for change in ({"max_contact_gap": 2e-3}, {"penetration": 2e-3}, {"min_pressure": -1e-9}, {"load_error": 1e-9}):
        assert not replace(solved, **change).met(1e-3)
    for name in ("max_contact_gap", "penetration", "min_pressure", "load_error"):
        assert not replace(solved, **{name: float("nan")}).met(1e-3)
