"""Contacts that are pressed and then sheared: exact answers, and Coulomb's law at every point."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim as cs
from contactsim.reference import hard_wall, partial_slip
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
        assert sheared.traction.mean() == pytest.approx(share * FRICTION * load, rel=1e-9)
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
    assert sheared.traction == pytest.approx(20.0)


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
    assert np.abs(none.traction).max() < 1e-9
    assert none.shift == pytest.approx(0.0, abs=1e-9)
    assert all_of_it.relative_stick_area == 0
    assert all_of_it.traction == pytest.approx(FRICTION * result.pressure)
    assert np.isnan(all_of_it.misfit)


def test_what_cannot_be_sheared_is_refused():
    line, plane = press(rough(64), 0.05), press(surface(32), 0.05)
    layer = press(rough(64), 0.05, thickness=10.0, poisson_ratio=0.3)
    good = {"shear_traction": 0.001, "friction_coefficient": FRICTION}
    with refused("result", "a converged result"):
        cs.partial_slip(3, **good)
    with refused("result", "half-space"):
        cs.partial_slip(layer, **good)
    with refused("poisson_ratio", "of a surface"):
        cs.partial_slip(plane, **good)
    with refused("poisson_ratio", "at most 0.5"):
        cs.partial_slip(plane, **good, poisson_ratio=0.6)
    for wrong in (-1e-3, 1.0, np.nan, "much", None):
        with refused("shear_traction", "all slides"):
            cs.partial_slip(line, **good | {"shear_traction": wrong})
    for wrong in (0.0, -0.1, np.inf, "rough"):
        with refused("friction_coefficient", "a positive number"):
            cs.partial_slip(line, **good | {"friction_coefficient": wrong})
