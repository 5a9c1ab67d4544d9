"""The problem at a hard wall on fewer points: that of the sampled heights, whatever its unit of length."""

from __future__ import annotations

import numpy as np
import pytest

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
