"""The half-space without periodic images: known answers, the order of their errors, and two methods that agree."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

import contactsim as cs
from contactsim.elasticity.half_space import FreeHalfSpace
from contactsim.status import Status
from support.cases import orders, refused, rough

LENGTH = 3.0
"""Length of the area, over the radius of the contact."""
TOLERANCE = 1e-4


def places(points, dimensions=2):
    """Return the distance from the middle, in radii of the contact."""
    x = (np.arange(points) + 0.5) * LENGTH / points - LENGTH / 2
    return np.hypot(x[:, None], x) if dimensions == 2 else np.abs(x)


def press(heights, **options):
    """Press heights on a free half-space of unit modulus, or another one."""
    spacing = LENGTH / heights.shape[-1]
    options = {"periodic": False, "tolerance": TOLERANCE, **options}
    result = cs.press(heights, spacing=spacing, contact_modulus=1.0, **options)
    assert result.status is Status.CONVERGED
    return result


def load_of(result):
    """Return the load, per length on lines."""
    return result.mean_pressure * LENGTH**result.pressure.ndim


def test_a_sphere_follows_hertz_to_second_order():
    approaches, pressures = [], []
    for points in (32, 64, 128):
        r = places(points)
        result = press(-(r**2) / 2, mean_pressure=4 / 3 / LENGTH**2)
        approaches.append(abs(result.approach - 1))
        exact = 2 / np.pi * np.sqrt(np.maximum(1 - r**2, 0))
        pressures.append(np.abs(result.pressure - exact).mean())
    assert approaches[-1] < 1e-4
    assert pressures[-1] < 3e-4
    assert np.mean(orders(approaches)) > 1.8
    assert np.mean(orders(pressures)) > 1.3


def test_an_approach_gives_the_load_that_gives_the_approach():
    heights = -(places(64) ** 2) / 2
    loaded = press(heights, mean_pressure=0.15, tolerance=1e-6)
    approached = press(heights, approach=loaded.approach, tolerance=1e-6)
    assert approached.mean_pressure == pytest.approx(0.15, rel=1e-6)
    assert np.array_equal(approached.contact, loaded.contact)


def test_a_cylinder_follows_hertz_to_second_order():
    moved = quad(lambda s: -2 / np.pi * np.sqrt(1 - s**2) * np.log(s / LENGTH), 0, 1)[0]
    approaches, pressures = [], []
    for points in (64, 128, 256, 512):
        x = places(points, 1)
        result = press(-(x**2) / 2, mean_pressure=np.pi / 4 / LENGTH, tolerance=1e-6)
        approaches.append(abs(result.approach / moved - 1))
        pressures.append(np.abs(result.pressure - np.sqrt(np.maximum(1 - x**2, 0)) / 2).mean())
    assert approaches[-1] < 1e-5
    assert np.mean(orders(approaches)) > 1.8
    assert np.mean(orders(pressures)) > 1.3


def test_an_approach_of_a_line_is_counted_from_its_length():
    heights = -(places(128, 1) ** 2) / 2
    loaded = press(heights, mean_pressure=0.2, tolerance=1e-6)
    assert press(heights, approach=loaded.approach, tolerance=1e-6).mean_pressure == pytest.approx(0.2, rel=1e-6)


@pytest.mark.parametrize("heights", [np.zeros(3), np.zeros(40), rough(64)], ids=["few", "flat", "rough"])
def test_a_line_in_full_contact_approaches_as_it_is_loaded(heights):
    loaded = press(heights, mean_pressure=300.0)
    assert loaded.contact.all()
    approached = press(heights, approach=loaded.approach)
    assert approached.contact.all()
    assert approached.mean_pressure == pytest.approx(300.0, rel=1e-5)


@pytest.mark.parametrize("shape", [(512,), (4096,), (300, 300)])
def test_what_is_flat_all_over_is_solved_to_the_default_tolerance(shape):
    result = cs.press(np.zeros(shape), spacing=1.0, contact_modulus=1.0, mean_pressure=0.1, periodic=False)
    assert result.status is Status.CONVERGED
    assert result.record.transforms < 2500
    assert result.contact.all()


def test_a_flat_punch_carries_twice_radius_modulus_and_approach():
    errors = []
    for points in (32, 64, 128, 256):
        result = press(np.where(places(points) < 1, 0.0, -10.0), mean_pressure=0.01)
        radius = LENGTH * np.sqrt(result.relative_contact_area / np.pi)  # that of the punch on its elements
        errors.append(abs(load_of(result) / (2 * radius * result.approach) - 1))
    assert errors[-1] < 2e-3
    assert np.mean(orders(errors)) == pytest.approx(1, abs=0.15)


def test_a_cone_follows_sneddon():
    slope = 0.3
    result = press(-slope * places(128), mean_pressure=np.pi / 2 * slope / LENGTH**2)
    assert result.approach == pytest.approx(np.pi / 2 * slope, rel=1e-4)
    assert result.relative_contact_area * LENGTH**2 == pytest.approx(np.pi, rel=0.02)


def test_images_press_a_sphere_apart():
    """In a periodic cell of four radii the images are felt; in ever larger ones, less and less."""
    shares = []
    for cell in (4, 8, 16):
        x = (np.arange(16 * cell) + 0.5) / 16 - cell / 2
        heights = -(x[:, None] ** 2 + x**2) / 2
        areas = [
            cs.press(heights, spacing=1 / 16, contact_modulus=1.0, mean_pressure=4 / 3 / cell**2, periodic=periodic)
            for periodic in (True, False)
        ]
        depths = [area.pressure.max() for area in areas]
        shares.append(abs(depths[0] / depths[1] - 1))
    assert 0.01 < shares[0] < 0.1
    assert shares[2] < shares[1] / 3 < shares[0] / 9


@pytest.mark.parametrize("pressure", [1e-3, 0.05, 0.5, 3.0])
@pytest.mark.parametrize("shape", [(61,), (128,), (47, 64)])
def test_two_methods_find_the_same_contact_to_the_edges_of_the_area(shape, pressure):
    heights = np.random.default_rng(1).normal(size=shape)
    for axis in range(len(shape)):  # smooth, tilted, and not periodic
        heights = heights + 2 * np.roll(heights, 1, axis) + np.roll(heights, 2, axis)
    heights += 0.5 * np.arange(shape[-1])
    found = [
        cs.press(
            *(heights,),
            **{"spacing": 1.0, "contact_modulus": 1.0, "mean_pressure": pressure, "periodic": False},
            **{"tolerance": 1e-6, "solver": solver},
        )
        for solver in (None, "polonsky_keer")
    ]
    assert all(result.status is Status.CONVERGED for result in found)
    assert found[0].pressure.shape == found[0].gap.shape == shape
    assert np.array_equal(found[0].contact, found[1].contact)
    assert found[0].pressure == pytest.approx(found[1].pressure, abs=1e-4 * found[1].pressure.max())
    assert found[0].mean_pressure == pytest.approx(pressure, rel=1e-12)


def test_grids_that_halve_find_what_one_grid_finds():
    heights = rough(512)[:400]
    one, many = (
        cs.press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=0.02, periodic=False, solver=solver)
        for solver in ("polonsky_keer", None)
    )
    assert np.array_equal(one.contact, many.contact)


def test_twice_the_modulus_bears_twice_the_load_in_any_unit():
    heights = -(places(64) ** 2) / 2
    one = press(heights, mean_pressure=0.1)
    two = cs.press(
        1e3 * heights,
        spacing=1e3 * LENGTH / 64,
        contact_modulus=2e-9,
        mean_pressure=2e-10,
        periodic=False,
        tolerance=TOLERANCE,
    )
    assert two.approach == pytest.approx(1e3 * one.approach, rel=1e-9)
    assert two.pressure == pytest.approx(2e-9 * one.pressure, abs=1e-15)


def test_what_cannot_be_free_is_refused():
    heights = -(places(16) ** 2)
    options = {"spacing": 1.0, "contact_modulus": 1.0, "mean_pressure": 0.1}
    with refused("periodic", "True for a layer"):
        cs.press(heights, **options, periodic=False, thickness=10.0, poisson_ratio=0.3)
    with refused("periodic", "True or False"):
        cs.press(heights, **options, periodic="no")
    with refused("solver", "accepts FREE"):
        cs.press(heights[0], **options, periodic=False, solver="verlet")
    wall = cs.Scene(FreeHalfSpace(1.0), cs.Topography(heights, 1.0), cs.HardWall(), cs.pressures([0.1]))
    with refused("elasticity", "`press` takes a free half-space"):
        cs.simulate(wall, points=16)


def test_a_topography_that_was_made_periodic_repeats():
    raw = cs.Topography(np.cumsum(np.random.default_rng(0).normal(size=64)), 1.0)
    load = {"contact_modulus": 1.0, "mean_pressure": 0.1}
    mirrored = cs.prepare_topography(raw, ends="mirror")
    assert np.array_equal(cs.press(mirrored, **load).pressure, cs.press(mirrored, periodic=True, **load).pressure)
    alone = cs.press(mirrored, periodic=False, **load)
    assert not np.array_equal(alone.contact, cs.press(mirrored, **load).contact)


def test_a_topography_is_free_unless_it_is_said_to_repeat():
    heights = -(places(32) ** 2) / 2
    measured = cs.Topography(heights, LENGTH / 32)
    load = {"contact_modulus": 1.0, "mean_pressure": 0.1}
    free = cs.press(measured, **load)
    assert np.array_equal(free.pressure, cs.press(heights, spacing=LENGTH / 32, periodic=False, **load).pressure)
    periodic = cs.press(measured, periodic=True, **load)
    assert np.array_equal(periodic.pressure, cs.press(heights, spacing=LENGTH / 32, **load).pressure)
    assert cs.press(measured, thickness=1.0, poisson_ratio=0.3, **load).status is Status.CONVERGED
    with refused("spacing", "a topography has its own"):
        cs.press(measured, spacing=1.0, **load)
