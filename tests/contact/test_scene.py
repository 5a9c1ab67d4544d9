"""The grid step, by which tolerances are counted, the modulus of two bodies, and the steps of a path."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.contact.grid_step import SAMPLE_SIZE, grid_step
from contactsim.contact.loading import approaches, pressures, sliding
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.errors import InputError
from contactsim.interface.cohesive_zone import NormalCohesiveZone
from contactsim.interface.frictional_repulsion import FrictionalRepulsiveZone
from contactsim.interface.hard_wall import HardWall
from contactsim.interface.repulsion import RepulsiveZone
from contactsim.surfaces.shapes import Cylinder, Flat
from contactsim.traits import Trait


def texture(points, period, along_both):
    raised = np.arange(points) % period < period // 2
    both = raised[:, None] & raised if along_both else np.repeat(raised[:, None], points, 1)
    return both.astype(float)


@pytest.mark.parametrize("along_both", [True, False], ids=["pillars", "ridges"])
@pytest.mark.parametrize(("points", "period"), [(1024, 4), (1440, 20), (2048, 16)])
def test_where_a_periodic_texture_begins_does_not_change_the_grid_step(points, period, along_both):
    heights = texture(points, period, along_both)
    rms = np.sqrt(np.mean([(heights - np.roll(heights, 1, axis)) ** 2 for axis in (0, 1)]))
    found = [grid_step(np.roll(heights, rows, 0)) for rows in range(5)]
    np.testing.assert_allclose(found, rms, rtol=0.03)  # the fewest edges are an eighth of 2^18 samples: 0.6 %


def test_of_a_small_surface_all_points_count():
    heights = np.zeros((16, 2 * SAMPLE_SIZE // 16 - 1))
    heights[3, 5] = 1.0  # one pit of 2^19 points, which a sample would most likely miss
    assert grid_step(heights) == pytest.approx(np.sqrt(4 / (2 * heights.size)), rel=1e-12)


@pytest.mark.parametrize("shape", [(2**16,), (200, 300)])
def test_of_gaussian_heights_the_median_difference_says_as_much_as_the_rms(shape):
    heights = np.random.default_rng(5).normal(size=shape)
    heights.flat[1000] = 300.0  # the rms alone would follow one pit
    assert grid_step(heights) == pytest.approx(np.sqrt(2), rel=0.02)


def test_two_half_spaces_give_way_as_one_of_the_modulus_of_the_pair():
    surface, wave = Cylinder(100.0, 1000.0), np.array([0.1, 1.0])
    bodies = Body(Flat.facing(surface), HalfSpace(2.0)), Body(surface, HalfSpace(3.0))
    pair = Scene(*bodies, HardWall(), pressures([0.1]))
    assert pair.contact_modulus == pytest.approx(1.2)
    np.testing.assert_allclose(pair.compliance(wave), HalfSpace(pair.contact_modulus).compliance(wave), rtol=1e-14)


def test_increments_divide_a_leg_also_where_their_number_is_whole_but_for_rounding():
    places = [step.value for step in approaches([0.0, 0.3, -0.4], 0.1).steps]  # 0.3 / 0.1 is a little below 3
    assert places == pytest.approx([0.1, 0.2, 0.3, 0.2, 0.1, 0.0, -0.1, -0.2, -0.3, -0.4], abs=1e-12)
    assert [step.value for step in approaches([0.0, 1.0], 0.3).steps] == pytest.approx([1 / 3, 2 / 3, 1.0])


PATHS = {
    "loads": pressures([0.1, 0.4, 0.2]),
    "sweep of loads": pressures([0.5, 0.1, 0.3], 0.07),
    "approaches": approaches([-1.0, 2.0], 0.5) >> approaches([1.0]),
    "slide under a load": sliding([0.0, 1.0, -1.0], 0.3, mean_pressure=0.2),
    "slide at an approach": approaches([-1.0, 0.5], 0.5) >> sliding([0.0, 1.0], 0.5, approach=0.5),
}


@pytest.mark.parametrize("path", PATHS.values(), ids=PATHS)
def test_controls_and_extreme_loads_of_a_path_are_those_of_its_steps(path):
    held = [step.normal for step in path.steps]
    loads = [step.value for step in held if step.control is Trait.MEAN_PRESSURE]
    assert path.traits == {step.control for step in [*path.steps, *held]}
    for extreme in (min, max):
        assert extreme(path.mean_pressures, default=0.0) == pytest.approx(extreme(loads, default=0.0))


@pytest.mark.parametrize("law", [RepulsiveZone(1.0), FrictionalRepulsiveZone(1.0, 0.3)])
def test_a_pull_is_refused_of_laws_that_do_not_pull(law):
    surface = Cylinder(100.0, 1000.0)
    with pytest.raises(
        InputError, match=r"mean_pressure: got -0.1; allowed: 0 or more, in GPa: these laws do not pull"
    ):
        Scene(HalfSpace(1.0, 0.3), surface, law, pressures([0.1, -0.1]))
    Scene(HalfSpace(1.0, 0.3), surface, (law, NormalCohesiveZone(0.1)), pressures([0.1, -0.1]))
