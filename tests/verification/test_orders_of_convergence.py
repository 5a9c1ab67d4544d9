"""Observed orders of convergence at a hard wall on lines and surfaces, half-spaces and layers; solvers that agree."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim
from contactsim.observables.contact import relative_contact_area_subgrid
from contactsim.reference import hard_wall
from contactsim.surfaces.statistics import rms_gradient, rms_gradient_pairs
from support.cases import ALL, FAST, ON_SURFACES, orders, press, wave


def half_contact(points: int) -> float:
    """Return p_c/2, which puts the edges of a wave's contact halfway between points on grids of powers of two."""
    return 0.5 * hard_wall.full_contact_pressure(1.0, points, 1.0)


@pytest.mark.parametrize(
    ("name", "rows"), [*((name, None) for name in ALL), *((name, 4) for name in ON_SURFACES)], ids=str
)
def test_mean_gap_of_a_wave_converges_at_second_order_on_lines_and_surfaces(name, rows):
    errors = []
    for points in (64, 128, 256):
        heights = wave(points) if rows is None else np.tile(wave(points), (rows, 1))
        result = press(heights, half_contact(points), name, tolerance=1e-8)
        errors.append(abs(result.gap.mean() - hard_wall.sinusoid_mean_gap(0.5, 1.0)))
    assert orders(errors) == pytest.approx([2, 2], abs=0.1)


@pytest.mark.parametrize("name", ALL)
def test_pressure_of_a_wave_converges_as_the_root_at_its_edges_lets_it(name):
    errors = []
    for points in (64, 128, 256):
        mean = half_contact(points)
        exact = hard_wall.sinusoid_pressure(np.pi * np.arange(points) / points, 0.5, mean)
        error = np.abs(press(wave(points), mean, name, tolerance=1e-8).pressure - exact) / mean
        errors.append([error.mean(), np.sqrt(np.mean(error**2)), error.max()])
    assert np.mean(orders(errors), axis=0) == pytest.approx([1.5, 1, 0.5], abs=0.02)


@pytest.mark.parametrize("ratio", [0.3, 0.5])
@pytest.mark.parametrize("thickness", [0.02, 0.1, 0.5])
def test_approach_and_area_on_a_layer_converge_at_second_order(thickness, ratio):
    loads = np.linspace(0.2, 0.4, 8) * np.pi * (4 if thickness < 0.05 else 1)
    body = {"contact_modulus": 1.0, "thickness": thickness, "poisson_ratio": ratio}

    def numbers(points: int) -> np.ndarray:
        results = [
            contactsim.press(wave(points), spacing=1 / points, mean_pressure=load, tolerance=1e-8, **body)
            for load in loads
        ]
        return np.array([[r.approach, relative_contact_area_subgrid(r.pressure, r.gap)] for r in results])

    exact = numbers(4096)
    coarse, fine = (np.sqrt(np.mean((numbers(points) - exact) ** 2, axis=0)) for points in (64, 512))
    assert np.log2(coarse / fine) / 3 == pytest.approx([2, 2], abs=0.35)


def test_cylinder_area_converges_at_first_order():
    worst = []
    radius, length = 1.0, 64.0
    for points in (2**12, 2**14, 2**16):
        x = np.arange(points) * length / points - length / 2
        errors = []
        for half_width in np.linspace(0.5, 0.9, 13):
            load = hard_wall.cylinder_load(half_width, radius, 1.0)
            result = contactsim.press(
                -(x**2) / (2 * radius), spacing=length / points, contact_modulus=1.0, mean_pressure=load / length
            )
            errors.append(abs(result.relative_contact_area * length / 2 - half_width))
        worst.append(max(errors))
    assert worst[0] <= 64.0 / 2**12  # half a point at each edge, and the neighbours 64 radii apart
    assert np.log2(worst[0] / worst[1]) / 2 == pytest.approx(1, abs=0.35)


@pytest.mark.parametrize("name", FAST)
def test_edges_of_a_wave_are_placed_to_a_hundredth_of_a_step(name):
    for points in (64, 256, 1024):
        errors = []
        for ratio in np.linspace(0.2, 0.4, 7):
            heights = np.cos(2 * np.pi * (np.arange(points) + ratio) / points)
            result = press(heights, ratio * hard_wall.full_contact_pressure(1.0, points, 1.0), name, tolerance=1e-6)
            found = [relative_contact_area_subgrid(result.pressure, result.gap), result.relative_contact_area]
            errors.append(points * np.abs(found - hard_wall.sinusoid_area(ratio)))
        worst, counted = np.max(errors, axis=0)
        assert worst < 0.015 + 4 / points  # two edges; a coarse grid sees how the gap bends
        assert counted > 0.4


def test_cylinder_width_between_points_shows_the_neighbours_that_counting_hides():
    points, length = 2**12, 64.0
    x = np.arange(points) * length / points - length / 2
    for half_width in (0.5, 0.7, 0.9):
        load = hard_wall.cylinder_load(half_width, 1.0, 1.0) / length
        result = contactsim.press(
            -(x**2) / 2, spacing=length / points, contact_modulus=1.0, mean_pressure=load, tolerance=1e-5
        )
        found = relative_contact_area_subgrid(result.pressure, result.gap) * length / 2
        neighbours = (np.pi * half_width / length) ** 2 / 12  # narrower by this part, to leading order
        assert found == pytest.approx(half_width * (1 - neighbours), abs=0.015 * length / points)


def test_gradient_in_the_contact_of_a_cylinder_converges_at_first_order():
    errors, length = [], 64.0
    for points in (2**10, 2**12, 2**14):
        heights = -((np.arange(points) * length / points - length / 2) ** 2) / 2
        found = []
        for half_width in np.linspace(0.5, 0.9, 9):
            load = hard_wall.cylinder_load(half_width, 1.0, 1.0) / length
            body = {"spacing": length / points, "contact_modulus": 1.0}
            result = contactsim.press(heights, mean_pressure=load, **body)
            gradient = rms_gradient(heights, length / points, result.contact)
            found.append(gradient / hard_wall.cylinder_rms_gradient(half_width, 1.0) - 1)
            peak = hard_wall.cylinder_pressure(0.0, half_width, 1.0, 1.0)
            assert result.pressure.max() == pytest.approx(peak, rel=10 / points + 2e-3)  # and the neighbours
        errors.append(np.sqrt(np.mean(np.square(found))))
    assert orders(errors) / 2 == pytest.approx([1, 1], abs=0.15)


def indented(
    points: int, contact_radius: float, centre: tuple[float, float] = (0.0, 0.0)
) -> tuple[float, float, float]:
    """Contact radius found between points and by counting, and largest pressure over Hertz's, of a sphere of radius 1.

    The period is 1. The neighbours' displacements bend the half-space by Σ 1/R³ = 9.0336/L³ over the square lattice,
    which makes the contact of a load smaller by 0.639 (c/L)³ and its pressure larger by twice that; to c/L = 0.1 these
    are 6e-4 and 1.3e-3, here taken out.
    """
    along = [(np.arange(points) - points // 2 - start) / points for start in centre]
    heights = -(along[0][:, None] ** 2 + along[1] ** 2) / 2
    load = hard_wall.sphere_load(contact_radius, 1.0, 1.0)
    result = contactsim.press(heights, spacing=1 / points, contact_modulus=1.0, mean_pressure=load, tolerance=1e-5)
    neighbours = 9.0336 / (1.5 * np.pi) / 3 * contact_radius**3
    areas = relative_contact_area_subgrid(result.pressure, result.gap), result.relative_contact_area
    radii = [np.sqrt(area / np.pi) / (1 - neighbours) for area in areas]
    exact = hard_wall.sphere_pressure(0.0, contact_radius, 1.0, 1.0)
    return *radii, result.pressure.max() / exact / (1 + 2 * neighbours)


def test_hertz_radius_between_points_converges_at_second_order_and_by_counting_at_first():
    cases = [(0.093, (0.1, 0.7)), (0.1, (0.6, 0.3)), (0.107, (0.2, 0.25)), (0.098, (0.9, 0.45))]
    errors = []
    for points in (64, 128, 256):
        found = [np.divide(indented(points, radius, centre)[:2], radius) - 1 for radius, centre in cases]
        errors.append(np.sqrt(np.mean(np.square(found), axis=0)))
    placed, counted = np.transpose(errors)
    assert placed[-1] < 2e-4
    assert np.mean(orders(placed)) == pytest.approx(2, abs=0.4)
    assert counted[-1] > 4e-3
    assert np.mean(orders(counted)) == pytest.approx(1, abs=0.3)


@pytest.mark.parametrize(("gradient", "order"), [(rms_gradient, 1.3), (rms_gradient_pairs, 1.0)])
def test_gradient_in_the_contact_of_a_sphere_converges_at_first_order_or_faster(gradient, order):
    errors, centres = [], np.random.default_rng(0).random((8, 2))
    for points in (64, 128, 256):
        found = []
        for radius, centre in zip(np.linspace(0.09, 0.11, 8), centres, strict=True):
            y, x = ((np.arange(points) - points // 2 - start) / points for start in centre)
            heights, load = -(y[:, None] ** 2 + x**2) / 2, hard_wall.sphere_load(radius, 1.0, 1.0)
            body = {"spacing": 1 / points, "contact_modulus": 1.0}
            result = contactsim.press(heights, mean_pressure=load, tolerance=1e-4, **body)
            measured = gradient(heights, (1 / points, 1 / points), result.contact)
            found.append(measured / hard_wall.sphere_rms_gradient(radius, 1.0) - 1)
        errors.append(np.sqrt(np.mean(np.square(found))))
    assert np.mean(orders(errors)) == pytest.approx(order, abs=0.25)


def test_hertz_radius_and_pressure_at_small_contact_are_right_to_a_thousandth():
    found = np.array([indented(points, 0.05) for points in (256, 512)])
    between, _, pressure = found.T
    assert between[1] == pytest.approx(0.05, rel=1e-3)
    assert (4 * between[1] - between[0]) / 3 == pytest.approx(0.05, rel=1e-3)  # Richardson, second order
    assert pressure[1] == pytest.approx(1, rel=1e-3)


def test_a_single_point_and_complete_contact_have_an_area_between_points():
    point, all_of_it = np.zeros((8, 8)), np.ones((8, 8))
    point[3, 4] = 1.0
    assert relative_contact_area_subgrid(all_of_it, np.zeros((8, 8))) == 1.0
    assert relative_contact_area_subgrid(0 * point, np.ones((8, 8))) == 0.0
    assert 0 < relative_contact_area_subgrid(point, 1 - point) < 1 / 64
    assert relative_contact_area_subgrid(point[3], 1 - point[3]) == pytest.approx(0.62 / 8)


def test_a_tighter_tolerance_brings_the_pressure_closer_at_the_same_rate():
    heights = wave(512) + 0.3 * np.cos(2 * np.pi * 7 * np.arange(512) / 512)
    exact = press(heights, 0.002, tolerance=1e-10).pressure
    errors = [
        np.abs(press(heights, 0.002, tolerance=tolerance).pressure - exact).max() / exact.max()
        for tolerance in (1e-2, 1e-4, 1e-6)
    ]
    assert errors[1] < 0.05 * errors[0] + 1e-12
    assert errors[2] < 0.05 * errors[1] + 1e-12
