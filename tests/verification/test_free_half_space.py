"""The half-space without periodic images: known answers, the order of their errors, and two methods that agree."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

import contactsim as cs
from contactsim.elasticity.half_space import FreeHalfSpace
from contactsim.paths.driver import follow_path
from contactsim.paths.options import Setup
from contactsim.status import Status
from contactsim.study.study import Study
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
    with refused("elasticity", "two free half-spaces, or two bodies that repeat"):
        bodies = (
            cs.Body(cs.Flat(16.0), FreeHalfSpace(1.0)),
            cs.Body(cs.Sphere(radius=16.0, length=16.0), cs.HalfSpace(1.0)),
        )
        cs.Scene(*bodies, cs.HardWall(), cs.pressures([0.1]))
    law = cs.NormalCohesiveZone(work_of_separation=0.1, normal_length=1.0)
    with refused("elasticity", "HalfSpace or Layer under smooth laws on a line"):
        cs.Scene(FreeHalfSpace(1.0), cs.Cylinder(radius=16.0, length=16.0), law, cs.approaches([0.0, 1.0], 0.5))


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


def sphere_scene(body, loads, length=4.0):
    """Return a sphere of radius 10 under loads."""
    return cs.Scene(body, cs.Sphere(radius=10.0, length=length), cs.HardWall(), cs.pressures(loads))


@pytest.mark.parametrize("dimensions", [1, 2])
def test_a_run_is_the_states_of_single_loads(dimensions):
    surface = cs.SelfAffine(64.0, 0.8, 32.0, 8.0, 0.5, dimensions=dimensions, seed=2)
    loads = [0.01, 0.1]
    data = cs.simulate(cs.Scene(FreeHalfSpace(2.0), surface, cs.HardWall(), cs.pressures(loads)), points=64)
    for step, load in enumerate(loads):
        state = cs.press(surface.heights(64), spacing=1.0, contact_modulus=2.0, mean_pressure=load, periodic=False)
        assert data.approach.values[step] == state.approach
        assert data.relative_contact_area.values[step] == state.relative_contact_area
    assert (data.status == 0).all()


def test_contact_that_reaches_the_ends_has_no_edge_there():
    flat = cs.simulate(cs.Scene(FreeHalfSpace(1.0), cs.Flat(8.0), cs.HardWall(), cs.pressures([0.1])), points=32)
    assert flat.relative_contact_area.item() == flat.relative_contact_area_corrected.item() == 1
    assert flat.contact_edges.item() == 0
    slope = cs.Topography(np.arange(16.0), 1.0)
    tilted = cs.simulate(cs.Scene(FreeHalfSpace(1.0), slope, cs.HardWall(), cs.pressures([1e-3])))
    assert tilted.rms_gradient.item() == tilted.rms_gradient_contact_subgrid.item() == pytest.approx(1)
    assert tilted.contact_edges.item() == 1


def test_a_run_of_a_sphere_follows_hertz_and_a_period_of_four_radii_does_not():
    """Contact radius 1 of a sphere of radius 10 and E* = 1: load 4/30. Images 4 apart take up approach and area."""
    load = 4 / 30 / 16
    free, periodic = (
        cs.simulate(sphere_scene(body, [load]), points=256, tolerance=1e-5)
        for body in (FreeHalfSpace(1.0), cs.HalfSpace(1.0))
    )
    radii = [4 * np.sqrt(data.relative_contact_area_subgrid.item() / np.pi) for data in (free, periodic)]
    assert radii[0] == pytest.approx(1, rel=1e-3)
    assert free.approach.item() == pytest.approx(0.1, rel=1e-3)
    assert radii[1] < 0.99
    assert free.max_pressure.item() == pytest.approx(1.5 * load * 16 / np.pi, rel=5e-3)


def test_accuracy_is_kept_on_a_free_half_space_and_its_cost_foreseen():
    scene = sphere_scene(FreeHalfSpace(1.0), [4 / 30 / 16])
    data = cs.simulate(scene, accuracy=0.01)
    exact = np.pi / 16
    assert data.accuracy_reached.item() == 1
    error = abs(data.relative_contact_area_subgrid.item() / exact - 1)
    assert error < 0.01
    forecast = cs.estimate_cost(scene, accuracy=0.01)
    work = data.transforms.sum().item() + data.coarse_run_transforms.item()
    assert 0.3 < work / forecast.transforms < 3
    half, whole = (forecast_of(body) for body in (cs.HalfSpace(1.0), FreeHalfSpace(1.0)))
    assert whole == pytest.approx(3 * half, rel=0.01)


def forecast_of(body):
    """Return the transforms that a sphere on a body is expected to take."""
    return cs.estimate_cost(sphere_scene(body, [4 / 30 / 16]), points=64).transforms


def test_free_and_periodic_bodies_have_different_fingerprints():
    free, periodic = (Setup(sphere_scene(body, [0.1])).fingerprint for body in (FreeHalfSpace(1.0), cs.HalfSpace(1.0)))
    assert free != periodic


def test_a_study_has_a_free_half_space():
    section = {
        "title": "Sphere",
        "surface": {"kind": "sphere", "radius": 10.0, "length": 4.0},
        "body": {"kind": "free_half_space", "contact_modulus": 1.0},
        "effects": ["hard_wall"],
        "load": {"contact_ratio": [0.05, 0.1]},
        "points": 64,
        "tolerance": 1e-4,
    }
    (run,) = Study.read("sphere", section, "ch3.yaml", 1).runs()
    data = follow_path(run.setup)
    radii = 4 * np.sqrt(data.relative_contact_area_subgrid.values / np.pi)
    assert radii == pytest.approx([0.5, 1.0], rel=0.02)
