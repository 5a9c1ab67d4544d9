"""The problem that smooth laws pose: what an equilibrium is, by routes that do not go through its code."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contactsim.contact.coarse_grid import coarsen
from contactsim.contact.loading import approaches
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.contact.steps import LoadStep
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.solvers.cohesive.base import largest_change
from contactsim.solvers.registry import make_solver
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait
from support.cases import refusal
from support.smooth import LAWS, LAYER, LENGTH, RADIUS, along, scene_of, walk

YOUNG = 70.0


def body(kind, ratio, thickness=5000.0, young=YOUNG):
    modulus = young / (1 - ratio**2)
    return HalfSpace(modulus, ratio) if kind is HalfSpace else Layer(modulus, ratio, thickness)


def dense_stiffness(elasticity, points):
    """The real-space stiffness (2n, 2n), normal then along x, by a sum over waves of each node's own response."""
    x = np.arange(points) * LENGTH / points
    waves = np.arange(1, points // 2 + 1)
    q = 2 * np.pi * waves / LENGTH
    symbol = elasticity.coupled_stiffness(np.append(0.0, q))
    weight = np.full(len(waves), 2.0)
    weight[-1] = 1.0  # the shortest wave, once; its sine vanishes on the nodes
    phase = np.multiply.outer(x[:, None] - x, q)
    even, odd = np.cos(phase) * weight / points, np.sin(phase) * weight / points
    symbol.diagonal[:, -1] = 1 / elasticity.coupled_compliance(q[-1:]).diagonal[:, 0]  # the other component is not seen
    normal, along_x = (even @ row[1:] + row[0] / points for row in symbol.diagonal)
    coupling = -odd[..., :-1] @ symbol.coupling[1:-1]  # i·nt e^{iqx} is -nt sin qx
    return np.block([[normal, coupling], [-coupling, along_x]])


@pytest.mark.parametrize("ratio", [0.1, 0.3])
@pytest.mark.parametrize("name", LAWS)
def test_an_equilibrium_balances_in_real_space_too(name, ratio):
    elasticity, law, points = body(Layer, ratio), LAWS[name], 64
    found = walk(scene_of(law, along(-10, 2, 0.5), elasticity), points, tolerance=1e-9)
    gap = found.gap()
    scene = scene_of(law)
    moved = gap[0] + scene.heights(points) + 2.0
    stiffness = dense_stiffness(elasticity, points)
    if len(gap) == 1:  # what slips is condensed from the dense stiffness, not from its symbol
        along_x = np.linalg.solve(stiffness[points:, points:], -stiffness[points:, :points] @ moved)
        traction = law.traction(gap)
    else:
        along_x = gap[1]
        traction = np.zeros((2, points))
        traction[: len(law.exerts)] = law.traction(gap)
    balance = stiffness @ np.concatenate([moved, along_x])
    balance[:points] += traction[0]
    if len(gap) == 2:
        balance[points:] += traction[1]
    # residual 1e-9 of the strength, and the rounding of a stiffness of up to 1 GPa/nm times 10 nm
    assert np.abs(balance).max() <= 3e-9 * law.strength


def test_two_equal_bodies_do_not_slip_so_coupled_is_uncoupled_exactly():
    path = along(-10, 2, 0.5)
    loads = [walk(scene_of(law, path, LAYER, LAYER)).load for law in LAWS.values()]
    coupled = walk(scene_of(LAWS["frictional"], path, LAYER, LAYER))
    assert coupled.problem.unknowns[0] == len(coupled.gap()) == 1  # nothing along x is computed
    for load in loads[1:]:
        assert np.array_equal(load, loads[0])
    for apart in (1e-3, 1e-5):  # bodies all but alike, whose slip is solved for
        nearly = replace(LAYER, poisson_ratio=LAYER.poisson_ratio + apart)
        both = walk(scene_of(LAWS["frictional"], path, LAYER, nearly))
        assert both.problem.unknowns[0] == 2
        assert 0 < np.abs(both.gap()[1]).max() < 5 * apart
        assert np.allclose(both.load, loads[0], rtol=10 * apart, atol=1e-5)


def test_two_equal_bodies_are_one_of_half_the_modulus_where_they_do_not_couple():
    half = replace(LAYER, contact_modulus=LAYER.contact_modulus / 2)
    path = along(-10, 2, 0.5)
    two = walk(scene_of(LAWS["uncoupled"], path, LAYER, LAYER))
    one = walk(scene_of(LAWS["uncoupled"], path, half))
    assert np.allclose(two.load, one.load, rtol=1e-10, atol=1e-12)
    coupled = walk(scene_of(LAWS["frictionless"], path, half))  # one body slips, two equal ones do not
    assert np.abs(coupled.load / two.load - 1).max() > 0.05


def test_incompressible_half_spaces_do_not_couple():
    path = along(-10, 2, 0.5)
    found = [walk(scene_of(law, path, body(HalfSpace, 0.5))) for law in LAWS.values()]
    nearly = walk(scene_of(LAWS["frictional"], path, body(HalfSpace, 0.5 - 1e-6)))
    for one in found:
        assert one.problem.unknowns[0] == len(one.gap()) == 1
        assert np.array_equal(one.load, found[0].load)
        assert np.allclose(one.load, nearly.load, rtol=1e-5, atol=1e-5)


def test_frictionless_is_the_limit_of_little_tangential_work():
    path = along(-10, 4, 0.2)
    limit = walk(scene_of(LAWS["frictionless"], path))
    errors = []
    for ratio in (1e-3, 1e-4):
        both = walk(scene_of(CohesiveZone(2.0, ratio), path))
        assert both.problem.unknowns[0] == 2
        assert limit.problem.unknowns[0] == 1
        errors.append(np.abs(both.load - limit.load).max() / -limit.load.min())
    assert errors[1] < 2e-4
    assert errors[1] == pytest.approx(errors[0] / 10, rel=0.1)


@pytest.mark.parametrize("name", LAWS)
def test_a_stiff_body_carries_the_laws_traction_over_the_undeformed_parabola(name):
    law = LAWS[name]
    stiff = replace(LAYER, contact_modulus=1e9 * LAYER.contact_modulus)
    places = [-3.0, -1.0, 0.0, 2.0]
    found = walk(scene_of(law, approaches(places), stiff), points=4096)

    x = np.linspace(-LENGTH / 2, LENGTH / 2, 200001)
    for place, load in zip(places, found.load, strict=True):
        gap = np.stack([x**2 / (2 * RADIUS) - place, 0 * x][: len(law.reads)])
        assert load == pytest.approx(-np.trapezoid(law.traction(gap)[0], x), rel=2e-6)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("points", [256, 255, 257])
def test_a_symmetric_scene_has_a_symmetric_answer(name, points):
    gap = walk(scene_of(LAWS[name], along(-10, 2, 0.5)), points).gap()
    mirrored = np.roll(gap[:, ::-1], 1, axis=1)  # x → -x, the apex at half the period
    size = np.abs(gap - gap.mean(axis=1, keepdims=True)).max()
    assert np.abs(gap[0] - mirrored[0]).max() < 1e-6 * size
    for row in gap[1:]:
        assert np.abs(row + np.roll(row[::-1], 1)).max() < 1e-6 * np.abs(row).max()


@pytest.mark.parametrize("name", LAWS)
def test_moving_the_scene_by_whole_nodes_moves_the_answer(name):
    scene = scene_of(LAWS[name])
    heights = scene.heights(256)
    fields = []
    for shift in (0, 37):
        problem = pose_cohesive(scene, np.roll(heights, shift), 1e-9)
        state = make_solver("newton").flow_from(
            problem.at(LoadStep(Trait.APPROACH, 1.0)), np.zeros(problem.unknowns, complex)
        )
        assert state.is_stable
        fields.append(np.roll(problem.field(state.displacement), -shift, axis=1))
    assert np.abs(fields[1] - fields[0]).max() < 1e-8


def test_the_answer_does_not_depend_on_the_kind_of_grid():
    loads = [walk(scene_of(LAWS["frictional"], along(-10, 2, 0.5)), points).load[-1] for points in (512, 511, 509, 510)]
    # odd grids have no node at the apex; at 19.5 nm all are far finer than the process zone of 284 nm
    assert np.allclose(loads, loads[0], rtol=2e-5, atol=0)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("control", ["approach", "load"])
@pytest.mark.parametrize("kind", [HalfSpace, Layer])
@pytest.mark.parametrize("points", [64, 63])
def test_the_tangent_is_the_derivative_of_the_residual(name, control, kind, points):
    problem = pose_cohesive(scene_of(LAWS[name], lower=body(kind, 0.3)), scene_of(LAWS[name]).heights(points), 1e-7)
    step = LoadStep(Trait.APPROACH, 0.5) if control == "approach" else LoadStep(Trait.MEAN_PRESSURE, 1e-3)
    problem, rng = problem.at(step), np.random.default_rng(2)
    field = 0.3 * rng.standard_normal((problem.unknowns[0], points))
    change = 1e-6 * rng.standard_normal(field.shape)
    state, change = problem.coefficients(field), problem.coefficients(change)
    ahead, behind = (
        problem.residual(place, problem.traction(problem.gap(place))) for place in (state + change, state - change)
    )
    tangent = problem.tangent(problem.gap(state))[1]
    exact = problem.add_elastic(tangent(change), change)
    assert np.abs((ahead - behind) / 2 - exact).max() < 1e-8 * np.abs(exact).max()


@pytest.mark.parametrize("control", ["approach", "load"])
@pytest.mark.parametrize("points", [64, 63])
def test_the_residual_is_the_derivative_of_the_energy(control, points):
    scene = scene_of(NormalCohesiveZone(2.0))
    problem, rng = pose_cohesive(scene, scene.heights(points), 1e-7), np.random.default_rng(2)
    problem = problem.at(LoadStep(*((Trait.APPROACH, 0.5) if control == "approach" else (Trait.MEAN_PRESSURE, 1e-3))))
    state = problem.coefficients(0.3 * rng.standard_normal((1, points)))
    change = problem.coefficients(1e-4 * rng.standard_normal((1, points)))
    ahead, behind = (problem.energy(place, problem.gap(place)) for place in (state + change, state - change))
    residual = problem.residual(state, problem.traction(problem.gap(state)))
    work = float(np.vdot(residual, change * problem.mode_weights).real)
    assert (ahead - behind) / 2 == pytest.approx(work, rel=1e-6)


@pytest.mark.parametrize("value", [0, -1e-7, float("nan"), "1e-7", None])
def test_a_tolerance_that_is_not_positive_is_refused(value):
    scene = scene_of(LAWS["uncoupled"])

    def pose():
        try:
            pose_cohesive(scene, scene.heights(16), value)
        except InputError as error:
            raise error.located("scene.yaml") from None

    assert refusal("tolerance", "scene.yaml", pose).value is value


def test_a_flat_that_faces_a_flat_gives_way_as_springs_in_series():
    law, place = NormalCohesiveZone(2.0), -0.5
    thin = replace(LAYER, thickness=10.0)  # stiff enough that no jump precedes it
    found = walk(scene_of(law, approaches([place]), thin, surface=Flat(LENGTH)), points=16, tolerance=1e-12)
    gap = found.gap()[0]
    spring = float(LAYER.coupled_stiffness(np.zeros(1)).diagonal[0, 0]) * LAYER.thickness / 10.0
    assert np.ptp(gap) < 1e-12
    assert spring * (gap[0] + place) + law.traction(gap[None, :1])[0, 0] == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("points", [128, 96])
def test_on_fewer_points_the_heights_keep_their_waves_but_the_shortest(points):
    scene = scene_of(LAWS["frictional"])
    whole = pose_cohesive(scene, np.random.default_rng(6).normal(size=points), 1e-7)
    before, after = (
        np.fft.rfft(problem.shape[0], norm="forward") for problem in (whole, coarsen(whole, points // 32, 1e-3))
    )
    assert np.allclose(after[:-1], before[:16], rtol=0, atol=1e-14)
    assert after[-1] == pytest.approx(0, abs=1e-14)  # its phase is lost on the grid


def test_bounds_of_changes_and_residuals_are_never_too_small():
    scene, rng = scene_of(LAWS["frictional"]), np.random.default_rng(7)
    problem = replace(pose_cohesive(scene, scene.heights(32), 1e-7), tolerance=np.inf)  # so that bounds are returned
    for _ in range(50):
        change = problem.coefficients(rng.normal(size=(2, 32)) ** 9)  # some are a single peak
        largest = np.abs(problem.field(change)).max()
        assert largest_change(problem, change) == pytest.approx(largest, rel=1e-12)
        assert largest_change(problem, change, enough=np.inf) >= largest
        assert problem.norm(change) >= largest / problem.strength
