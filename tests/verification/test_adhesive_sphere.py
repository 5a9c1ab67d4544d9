"""An adhesive sphere alone on a half-space: JKR, DMT, and Maugis between them; equilibrium by a sum over elements."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim as cs
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.elasticity.free_response import rectangle_response
from contactsim.observables.path_summary import summarise_load_curves
from contactsim.observables.surface_adhesion import negative_area
from contactsim.reference import adhesive_sphere
from support.cases import orders, refused

MODULUS, WORK, RADIUS = 1.0, 1.0, 1000.0
NEAR_PULL_OFF = (0.0, -2.0, -4.0, -6.0, -7.0, -8.0, -9.0, -10.0)


def strength(size):
    """Return the strength of a law by Maugis's parameter."""
    return size / adhesive_sphere.maugis_parameter(WORK, RADIUS, MODULUS, 1.0)


def pulled(size, points, approaches=NEAR_PULL_OFF, *, length=360.0, body=None, **options):
    """Pull a sphere off a half-space alone; Maugis's parameter is that of the law."""
    law = cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=WORK / (np.e * strength(size)))
    body = cs.FreeHalfSpace(MODULUS) if body is None else body
    scene = cs.Scene(body, cs.Sphere(radius=RADIUS, length=length), law, cs.approaches(approaches))
    data = cs.simulate(scene, points=points, **{"tolerance": 1e-5, **options})
    assert (data.status == 0).all()
    return data


def test_a_product_on_the_padded_grid_is_that_of_the_hard_wall():
    rng = np.random.default_rng(4)
    heights = rng.normal(size=(12, 20))
    law = cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=1.0)
    scene = cs.Scene(cs.FreeHalfSpace(2.0), cs.Topography(heights, (3.0, 2.0)), law, cs.approaches([0.0]))
    problem = pose_cohesive(scene, scene.heights(20), 1e-4)
    pressure = rng.normal(size=(12, 20))
    padded = np.zeros(problem.grid.shape)
    padded[:12, :20] = pressure
    moved = problem.field(problem.coefficients(padded.reshape(1, -1)) / problem.stiffness.diagonal)
    y, x = np.arange(12) * 1.5, np.arange(20.0)
    response = rectangle_response(y, x, 1.5) * 2.0 / 2.0  # spacing along x over the modulus
    rows, columns = np.indices((12, 20)).reshape(2, -1)
    whole = response[np.abs(rows[:, None] - rows), np.abs(columns[:, None] - columns)]
    assert problem.on_heights(moved)[0] == pytest.approx(whole @ pressure.ravel(), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("sides", [(slice(12), slice(12, 24)), (slice(12, 24), slice(12, 24))])
def test_what_is_left_beyond_the_heights_counts_as_what_would_move_them_as_much(sides):
    scene = cs.Scene(
        cs.FreeHalfSpace(2.0),
        cs.Topography(np.zeros((12, 12)), (3.0, 3.0)),
        cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=1.0),
        cs.approaches([0.0]),
    )
    problem = pose_cohesive(scene, scene.heights(12), 1e-9)
    left = np.zeros(problem.grid.shape)
    left[sides] = problem.strength
    residual = problem.coefficients(left.reshape(1, -1))
    moved = problem.on_heights(problem.field(residual / problem.stiffness.diagonal))[0]
    response = rectangle_response(np.arange(12), np.arange(12), 1.0) * 3.0 / 2.0
    rows, columns = np.indices((12, 12)).reshape(2, -1)
    whole = response[np.abs(rows[:, None] - rows), np.abs(columns[:, None] - columns)]
    alike = np.abs(np.linalg.solve(whole, moved)).max() / problem.strength
    assert 1.5 < alike <= problem.norm(residual)


def test_the_stored_state_is_in_equilibrium_by_a_sum_over_elements():
    data = pulled(1.0, 24, (0.0, -4.0), snapshots=[-4.0], tolerance=1e-8)
    state, step = data.isel(snapshot=-1), 360.0 / 24
    response = rectangle_response(np.arange(24.0), np.arange(24.0), 1.0) * step / MODULUS
    rows, columns = np.indices((24, 24)).reshape(2, -1)
    whole = response[np.abs(rows[:, None] - rows), np.abs(columns[:, None] - columns)]
    displacement = whole @ -state.normal_traction.values.ravel()
    expected = displacement - state.heights.values.ravel() - (-4.0)
    assert state.normal_gap.values.ravel() == pytest.approx(expected, abs=1e-6)


def test_the_force_converges_to_second_order():
    forces = [float(pulled(1.0, points, (0.0,), length=800.0).normal_force[0]) for points in (40, 80, 160, 320)]
    assert np.mean(orders(np.abs(np.diff(forces)))) > 1.7


def test_the_contact_radius_of_a_soft_sphere_is_that_of_jkr():
    """Maugis's parameter is 3; the contact ends where the traction is largest, at a gap of δn."""
    data = pulled(3.0, 96, (0.0, -4.0, -7.0), length=360.0, snapshots=[-7.0])
    gap = data.normal_gap.isel(snapshot=-1).values - WORK / (np.e * strength(3.0))
    radius = np.sqrt(negative_area(gap, (360.0 / 96,) * 2) / np.pi)
    sizes = np.linspace(120.0, 220.0, 2001)
    jkr = np.interp(-7.0, adhesive_sphere.jkr_approach(sizes, WORK, RADIUS, MODULUS), sizes)
    assert radius == pytest.approx(jkr, rel=0.005)


@pytest.mark.parametrize(("size", "length"), [(0.5, 1000.0), (1.0, 800.0), (2.0, 450.0), (3.0, 360.0)])
def test_from_dmt_to_jkr_the_pull_off_is_near_that_of_maugis(size, length):
    """The tail of the exponential law is longer than Dugdale's, so it pulls up to 4 % more."""
    ends = (0.0, -4.0, -6.0, -8.0, -9.0, -10.0, -12.0, -14.0, -18.0)
    found = pulled(size, 80, ends, length=length).normal_force.values
    maugis = adhesive_sphere.maugis_pull_off(WORK, RADIUS, MODULUS, strength(size))
    assert 0 < found.argmin() < found.size - 1
    assert maugis < -found.min() < 1.05 * maugis


@pytest.mark.parametrize("begin", [-2.0, -3.2])
def test_the_pull_off_of_a_soft_sphere_is_near_that_of_jkr_within_the_error_of_its_steps(begin):
    """The largest pull comes long before the jump; Maugis's parameter is 3, and the law's tail pulls 2.5 % more."""
    ends = np.arange(begin, -13.0, -3.0).tolist()
    found = summarise_load_curves(pulled(3.0, 48, ends))
    jkr = 1.025 * adhesive_sphere.jkr_pull_off(WORK, RADIUS)
    error = float(found.pull_off_force_unloading_increment_error)
    assert float(found.pull_off_force_unloading) == pytest.approx(jkr, abs=error)
    assert error < 0.05 * jkr


def test_neighbours_a_period_away_pull_more():
    ends = np.arange(8.0, -30.0, -1.0).tolist()
    alone, beside = (
        -float(pulled(1.0, 64, ends, length=700.0, body=body).normal_force.min())
        for body in (cs.FreeHalfSpace(MODULUS), cs.HalfSpace(MODULUS))
    )
    assert alone < beside < 1.05 * alone


def test_what_is_not_solved_on_a_free_half_space_is_refused():
    law = cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=1.0)
    with refused("mean_pressure", "approaches"):
        cs.Scene(cs.FreeHalfSpace(1.0), cs.Sphere(radius=100.0, length=50.0), law, cs.pressures([0.1]))
