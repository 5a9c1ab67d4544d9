"""Contacts that are pressed and then sheared: exact answers, and Coulomb's law at every point."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim as cs
from contactsim.reference import hard_wall, partial_slip
from contactsim.solvers.base import Result
from contactsim.status import Status
from support.cases import orders, refused, rough

FRICTION = 0.3


def press(heights, pressure, **options):
    """Press heights of unit spacing on a body of unit modulus, to a tight tolerance."""
    options = {"tolerance": 1e-8, "spacing": 1.0, **options}
    return cs.press(heights, contact_modulus=1.0, mean_pressure=pressure, **options)


def shear(result, share, **options):
    """Shear a contact by a share of the force at which all slides."""
    traction = share * FRICTION * result.mean_pressure
    return cs.partial_slip(result, shear_traction=traction, friction_coefficient=FRICTION, tolerance=1e-8, **options)


def hazard(seed):
    """Return a pressed contact, friction, Poisson's ratio and shear: any offset, load, friction, size and flat tops."""
    rng = np.random.default_rng(seed)
    dimensions = int(rng.integers(1, 3))
    points = int(rng.choice([2, 3, 16, 33] if dimensions == 2 else [2, 3, 16, 129]))
    noise, x = rng.standard_normal((points,) * dimensions), np.arange(points) - points / 2
    hole = np.where(np.arange(noise.size) == 0, -1.0, 0.0).reshape(noise.shape)
    round_top = -(x**2 if dimensions == 1 else x**2 + x[:, None] ** 2) / points
    kinds = [noise, round_top, np.round(noise).clip(-1, 1), hole, 0 * noise]
    heights = kinds[int(rng.integers(5))] + rng.choice([0, 1e6, -1e6, 1e9])
    tolerance = float(rng.choice([1e-3, 1e-6]) if np.ptp(heights) else 1e-2)
    result = press(heights, 10 ** rng.uniform(-6, 2), periodic=bool(rng.integers(2)), tolerance=tolerance)
    friction = float(10 ** rng.choice([-90, -8, -2, -0.5, 0, 6, 90]))
    share = rng.choice([0, 1e-200, 1e-14, 1e-9, 1e-6, 1e-3, 0.1, 0.5, 0.9, 1 - 1e-6, 1 - 1e-12, 1.0])
    return result, friction, float(rng.choice([-0.5, 0, 0.3, 0.5])), share * friction * result.mean_pressure


def displacement(traction):
    """Return the displacement under a periodic traction on a half-space of unit modulus, spacing 1 and ν = 0."""
    frequencies = np.meshgrid(*(2 * np.pi * np.fft.fftfreq(size) for size in traction.shape), indexing="ij")
    wavenumber = np.sqrt(sum(q**2 for q in frequencies))
    wavenumber.flat[0] = np.inf
    return np.fft.ifftn(2 / wavenumber * np.fft.fftn(traction)).real


def surface(points=64):
    """Return a rough surface."""
    return cs.SelfAffine(float(points), 0.8, points / 2, 8.0, 0.5, dimensions=2, seed=1).heights(points)


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
def test_the_stick_area_and_traction_of_cylinders_are_those_of_cattaneo(share):
    radius, period, half_width = 1.0, 1.0, 0.1
    load = hard_wall.cylinder_array_load(half_width, radius, period, 1.0)
    inner = hard_wall.cylinder_array_half_width((1 - share) * load, radius, period, 1.0)
    assert inner / half_width == pytest.approx(partial_slip.cylinder_stick_ratio(share), rel=0.01)  # of one alone
    for points in (256, 512, 1024, 2048):
        x = (np.arange(points) + 0.5) / points - 0.5
        result = press(-(x**2) / (2 * radius), load / period, spacing=1 / points)
        sheared = shear(result, share)
        assert sheared.traction.mean() == pytest.approx(share * FRICTION * load, rel=1e-12)
        stick = sheared.stick.sum() / points / 2
        assert stick == pytest.approx(inner, abs=1 / points)
        assert sheared.misfit < 1e-4
        expected = FRICTION * hard_wall.cylinder_pressure(x, half_width, radius, 1.0)
        assert np.abs(sheared.traction - expected)[sheared.slip].max() < 0.02 * expected.max()  # of one alone


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.3, 0.5])
def test_a_sphere_sticks_and_shifts_as_mindlin_says(poisson_ratio):
    share, errors = 0.5, []
    for points in (32, 64, 128):
        x = (np.arange(points) + 0.5) * 3 / points - 1.5
        result = press(-(x[:, None] ** 2 + x**2) / 2, 4 / 27, spacing=3 / points, periodic=False)  # radii 1
        sheared = shear(result, share, poisson_ratio=poisson_ratio)
        exact = partial_slip.sphere_shift(share, 1.0, 1.0, FRICTION, poisson_ratio)
        errors.append(abs(sheared.shift / exact - 1))
        ratio = np.sqrt(sheared.relative_stick_area / result.relative_contact_area)
        assert ratio == pytest.approx(partial_slip.sphere_stick_ratio(share), abs=1.5 / points)
        assert np.isnan(sheared.misfit)
    assert errors[-1] < 1e-3
    assert np.mean(orders(errors)) > 1


@pytest.mark.parametrize("seeds", [range(start, start + 50) for start in range(0, 300, 50)])
def test_the_shear_is_the_one_asked_for_and_coulombs_law_holds_whatever_the_contact(seeds):
    for seed in seeds:
        result, friction, poisson_ratio, shear_traction = hazard(seed)
        assert result.status is Status.CONVERGED
        sheared = cs.partial_slip(
            result, shear_traction=shear_traction, friction_coefficient=friction, poisson_ratio=poisson_ratio
        )
        traction, limit = sheared.traction, friction * result.pressure
        assert traction.mean() == pytest.approx(shear_traction, rel=1e-12, abs=0)
        assert sheared.status is Status.CONVERGED
        assert sheared.residual <= 1e-6
        assert np.all(np.abs(traction) <= limit * (1 + 1e-6))
        assert traction[sheared.slip] == pytest.approx(limit[sheared.slip], rel=1e-12, abs=0)
        assert np.all((sheared.stick | sheared.slip) == result.contact)
        assert not np.any(sheared.stick & sheared.slip)
        if result.scene.repeats and sheared.stick.any():
            moved = displacement(traction)
            shift = moved[sheared.stick].mean()
            error = 2e-6 * max(shift, shear_traction)
            assert moved[sheared.stick] == pytest.approx(shift, rel=0, abs=error)
            assert np.all(moved[sheared.slip] <= shift + error)


@pytest.mark.parametrize("heights", [rough(256), surface(32)], ids=["line", "surface"])
@pytest.mark.parametrize("offset", [1e6, -1e6])
def test_an_offset_of_the_heights_changes_nothing(heights, offset):
    for share in (1e-6, 0.5):
        plain, moved = (
            shear(press(heights + height, 0.05, tolerance=1e-6), share, poisson_ratio=0.0) for height in (0.0, offset)
        )
        assert moved.traction == pytest.approx(plain.traction, abs=1e-5 * plain.traction.max())
        assert moved.shift == pytest.approx(plain.shift, rel=1e-5)


@pytest.mark.parametrize("periodic", [True, False])
@pytest.mark.parametrize("size", [1e-12, 1e-9, 1e-3])
def test_a_shear_far_below_the_errors_of_the_pressure_meets_the_stiffness_of_the_contact(periodic, size):
    result = press(rough(256), 0.05, tolerance=1e-3, periodic=periodic)
    sheared = cs.partial_slip(result, shear_traction=size * 0.05 * 1e-3, friction_coefficient=1.0)
    assert sheared.traction.mean() / sheared.shift == pytest.approx(cs.contact_stiffness(result), rel=1e-5)


@pytest.mark.parametrize("part", [1.0, 0.9])
def test_the_status_tells_of_a_solver_that_did_not_solve_and_the_total_is_exact_even_so(monkeypatch, part):
    def leave_uniform(solver, problem, scale):
        """Return the load shared by all points, or part of it."""
        uniform = np.full(problem.shape, part * problem.load * scale.pressure)
        return Result(uniform, uniform, 0.0, Status.CONVERGED, None, 0.0)

    result = press(rough(256), 0.05)
    monkeypatch.setattr("contactsim.paths.partial_slip.solve", leave_uniform)
    sheared = shear(result, 0.5)
    assert sheared.status is Status.INEXACT
    assert sheared.residual > 1e-3
    assert sheared.traction.mean() == pytest.approx(0.5 * FRICTION * result.mean_pressure, rel=1e-12)


def test_a_tolerance_below_rounding_is_not_met_and_the_status_says_so():
    result = press(rough(256), 0.05)
    sheared = cs.partial_slip(result, shear_traction=1e-9, friction_coefficient=FRICTION, tolerance=1e-16)
    assert sheared.status is Status.INEXACT and not sheared.status.solved
    assert 1e-16 < sheared.residual < 1e-6
    assert sheared.traction.mean() == pytest.approx(1e-9, rel=1e-12, abs=0)


@pytest.mark.parametrize("heights", [rough(256), surface()], ids=["line", "surface"])
@pytest.mark.parametrize("share", [0.1, 0.6])
def test_coulombs_law_holds_at_every_point_and_the_stick_area_shifts_as_a_whole(heights, share):
    result = press(heights, 0.05)
    sheared = shear(result, share, poisson_ratio=0.0)
    assert sheared.status is Status.CONVERGED
    limit = FRICTION * result.pressure
    assert np.all(np.abs(sheared.traction) <= limit + 1e-9)
    assert sheared.traction[sheared.slip] == pytest.approx(limit[sheared.slip], rel=1e-12)
    assert np.all(sheared.stick | sheared.slip == result.contact)
    assert 0 < sheared.relative_slip_area < result.relative_contact_area
    assert sheared.misfit < 1e-5


def test_poissons_ratio_makes_the_stick_area_shift_unevenly_and_the_misfit_tells():
    result = press(surface(), 0.05)
    misfits = [shear(result, 0.5, poisson_ratio=ratio).misfit for ratio in (0.0, 0.1, 0.3)]
    assert misfits[0] < 1e-5 < misfits[1] < misfits[2] < 0.15


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.3, 0.5])
def test_ridges_on_a_surface_are_sheared_as_a_line_across_and_more_easily_along(poisson_ratio):
    profile = 2 * np.cos(2 * np.pi * np.arange(32) / 32)
    line = shear(press(profile, 0.05), 0.5)
    for plane, factor in ((profile + np.zeros((32, 1)), 1.0), (profile[:, None] + np.zeros(32), 1 - poisson_ratio)):
        sheared = shear(press(plane, 0.05), 0.5, poisson_ratio=poisson_ratio)
        assert sheared.shift * factor == pytest.approx(line.shift, rel=1e-4)
        assert sheared.misfit < 1e-4
        assert sheared.slip_angle < 1e-2


def test_on_a_round_contact_slip_is_not_everywhere_against_the_traction():
    x = (np.arange(64) + 0.5) / 64 - 0.5
    result = press(-(x[:, None] ** 2 + x**2) / 2, 0.003, spacing=1 / 64)
    angles = [shear(result, 0.5, poisson_ratio=ratio).slip_angle for ratio in (0.0, 0.3, 0.5)]
    assert angles[0] < 0.1 < angles[1] < angles[2] < 20


@pytest.mark.parametrize("periodic", [True, False])
def test_without_contact_nothing_moves(periodic):
    heights = rough(64)
    apart = cs.press(heights, spacing=1.0, contact_modulus=1.0, approach=-2 * heights.max(), periodic=periodic)
    sheared = cs.partial_slip(apart, shear_traction=0.0, friction_coefficient=FRICTION)
    assert (sheared.shift, sheared.relative_stick_area, sheared.relative_slip_area) == (0.0, 0.0, 0.0)
    assert np.isnan(sheared.misfit)


def test_in_full_contact_only_the_mean_is_displaced():
    sheared = cs.partial_slip(press(rough(64), 100.0), shear_traction=20.0, friction_coefficient=FRICTION)
    assert sheared.relative_stick_area == 1
    assert sheared.shift == 0 and np.isnan(sheared.misfit)
    assert sheared.traction == pytest.approx(20.0, rel=1e-9)


def test_a_state_pressed_to_a_loose_tolerance_gives_the_same_traction():
    heights = surface(32)
    loose, tight = (shear(press(heights, 0.05, tolerance=value), 1e-3, poisson_ratio=0.0) for value in (1e-3, 1e-9))
    assert loose.traction == pytest.approx(tight.traction, abs=1e-3 * tight.traction.max())


def test_a_small_shear_meets_the_stiffness_of_the_contact():
    result = press(rough(256), 0.05)
    sheared = shear(result, 1e-4)
    assert sheared.traction.mean() / sheared.shift == pytest.approx(cs.contact_stiffness(result), rel=1e-3)


def test_without_shear_all_sticks_and_under_the_largest_all_slides():
    result = press(surface(32), 0.05)
    none, all_of_it = (shear(result, share, poisson_ratio=0.2) for share in (0.0, 1.0))
    assert none.relative_stick_area == result.relative_contact_area
    assert np.all(none.traction == 0) and none.shift == 0 and none.residual == 0
    assert all_of_it.relative_stick_area == 0
    assert all_of_it.traction == pytest.approx(FRICTION * result.pressure)
    assert np.isnan(all_of_it.misfit)


def test_what_cannot_be_sheared_is_refused():
    line, plane = press(rough(64), 0.05), press(surface(32), 0.05)
    layer = press(rough(64), 0.05, thickness=10.0, poisson_ratio=0.3)
    good = {"shear_traction": 0.001, "friction_coefficient": FRICTION}
    with refused("result", "a Result: press"):
        cs.partial_slip(3, **good)
    with refused("result", "half-space"):
        cs.partial_slip(layer, **good)
    with refused("poisson_ratio", "of a surface"):
        cs.partial_slip(plane, **good)
    with refused("poisson_ratio", "at most 0.5"):
        cs.partial_slip(plane, **good, poisson_ratio=0.6)
    for wrong in (-1e-3, 0.015 * (1 + 1e-9), 1.0):
        with refused("shear_traction", "all slides"):
            cs.partial_slip(line, **good | {"shear_traction": wrong})
    for wrong in (0.0, -0.1, np.inf, "rough"):
        for name in ("friction_coefficient", "tolerance"):
            with refused(name, "a positive number"):
                cs.partial_slip(line, **good | {name: wrong})
