"""The parts of Newton-Krylov: the linear solver, its preconditioner, and what the whole refuses."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.contact.cohesive import Tangent
from contactsim.contact.loading import approaches, pressures
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.paths.adaptive import Adaptive
from contactsim.solvers.base import check_solver
from contactsim.solvers.cohesive.gmres import gmres
from contactsim.solvers.cohesive.linearised import find_growth
from contactsim.solvers.cohesive.zone_preconditioner import COARSENING, ZonePreconditioner
from contactsim.solvers.registry import make_solver, solver_class
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.surfaces.shapes import Cylinder, Flat, Sinusoid
from support.cases import refusal
from support.smooth import LAWS, RADIUS, along, scene_of, walk


def real_linear(seed, size, shape):
    """A map on complex arrays that is linear over the real numbers alone, and its matrix."""
    rng = np.random.default_rng(seed)
    matrix = np.eye(2 * size) * 3 + rng.standard_normal((2 * size, 2 * size)) / np.sqrt(2 * size)
    return matrix, lambda x: (matrix @ x.reshape(-1).view(float)).view(complex).reshape(shape)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("shape", [(1, 9), (2, 6)])
def test_gmres_solves_maps_that_are_linear_over_the_reals(seed, shape):
    size = shape[0] * shape[1]
    matrix, product = real_linear(seed, size, shape)
    rough = real_linear(seed + 100, size, shape)[1]
    target = np.random.default_rng(seed).standard_normal((*shape, 2)).view(complex)[..., 0]
    exact = np.linalg.solve(matrix, target.reshape(-1).view(float)).view(complex).reshape(shape)
    for precondition in (lambda x: x, rough):
        found, count = gmres(product, precondition, target, 1e-12, 2 * size)
        assert count <= 2 * size
        assert np.allclose(found, exact, rtol=0, atol=1e-10 * np.abs(exact).max())


def test_gmres_stops_at_the_residual_asked_for_and_returns_the_best_within_its_budget():
    product = real_linear(0, 40, (2, 20))[1]
    target = np.random.default_rng(1).standard_normal((2, 20, 2)).view(complex)[..., 0]
    counts, residuals = [], []
    for tolerance in (1e-1, 1e-4, 1e-8):
        found, count = gmres(product, lambda x: x, target, tolerance, 80)
        residuals.append(np.linalg.norm(product(found) - target) / np.linalg.norm(target))
        assert residuals[-1] <= tolerance * (1 + 1e-6)
        counts.append(count)
    assert counts == sorted(set(counts))
    short, count = gmres(product, lambda x: x, target, 1e-8, 3)
    assert count == 3
    assert np.linalg.norm(product(short) - target) < np.linalg.norm(target)


def test_gmres_survives_a_map_that_is_zero_or_exact_at_once():
    target = np.array([[1.0 + 2.0j, -1.0j]])
    found, _ = gmres(lambda x: 2 * x, lambda x: x, target, 1e-14, 5)
    assert np.allclose(found, target / 2, rtol=1e-14, atol=0)
    found, _ = gmres(lambda x: 0 * x, lambda x: x, target, 1e-14, 5)
    assert np.isfinite(found).all()
    found, count = gmres(lambda x: x, lambda x: x, 0 * target, 1e-14, 5)
    assert count == 0 and not found.any()


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("shift", [0.0, 0.7])
def test_the_preconditioner_is_exact_for_long_waves_if_the_tangent_is_long_and_within_the_zone(name, shift):
    # a short period, so that the laws act everywhere, and a field of the longest waves
    scene = scene_of(LAWS[name], surface=Cylinder(length=200.0, radius=25000.0))
    problem = pose_cohesive(scene, scene.heights(256), 1e-7)
    displacement = np.zeros(problem.unknowns, complex)
    tangent = problem.tangent(problem.gap(displacement))[1]
    smooth = np.zeros_like(tangent.values) + tangent.values.mean(axis=-1, keepdims=True)
    tangent = Tangent(problem, smooth)  # uniform: long waves stay long
    precondition = ZonePreconditioner(problem, tangent, shift)
    low = 256 // COARSENING // 2
    change = np.zeros(problem.unknowns, complex)
    change[:, :low] = np.random.default_rng(3).standard_normal((len(change), low, 2)).view(complex)[..., 0]
    change[:, 0] = change[:, 0].real
    residual = problem.add_elastic(tangent(change) + shift * change, change)
    assert np.abs(residual[:, low:]).max() < 1e-12 * np.abs(residual).max()
    residual[:, low:] = 0
    assert np.allclose(precondition(residual), change, rtol=0, atol=1e-9 * np.abs(change).max())


def matrix_of(product, problem):
    """A linear map of coefficients as a matrix of their real and imaginary parts; the shortest wave is real."""
    rows, held = problem.unknowns[0], problem.regularised_stiffness.held[:, 0]
    uniform = [(row, 0, 1.0) for row in range(rows) if not held[row]]
    *waves, last = range(1, problem.unknowns[1])
    places = uniform + [(row, wave, phase) for row in range(rows) for wave in waves for phase in (1.0, 1j)]
    places += [(row, last, 1.0) for row in range(rows)]
    columns = []
    for row, wave, phase in places:
        unit = np.zeros(problem.unknowns, complex)
        unit[row, wave] = phase
        found = product(unit)
        columns.append([(found[r, w] * np.conj(p)).real for r, w, p in places])
    return np.array(columns).T


@pytest.mark.parametrize("lower", [HalfSpace(77.0, 0.3), Layer(70.0, 0.3, 5000.0)])
@pytest.mark.parametrize("path", [approaches([0.0]), pressures([0.01])])
@pytest.mark.parametrize("name", LAWS)
def test_the_preconditioner_is_the_inverse_on_a_small_grid_whatever_tangents_a_zone_has(name, path, lower):
    scene = scene_of(LAWS[name], path, lower)
    problem = pose_cohesive(scene, scene.heights(128), 1e-7).at(scene.path.steps[0])
    shape = problem.tangent(problem.gap(np.zeros(problem.unknowns, complex)))[1].values.shape[:2]
    values = np.zeros((*shape, 128))
    scattered = np.random.default_rng(0).uniform(-0.3, 0.3, (*shape, 20))
    values[..., 50:70] = problem.law_stiffness * (scattered + 0.5 * np.eye(*shape)[..., None])
    tangent = Tangent(problem, values)
    stiffness = matrix_of(lambda u: problem.add_elastic(tangent(u), u), problem)
    for shift in (0.0, 0.7):
        forward = stiffness + shift * np.eye(len(stiffness))
        inverse = matrix_of(ZonePreconditioner(problem, tangent, shift), problem)
        assert np.abs(inverse @ forward - np.eye(len(forward))).max() <= 1e-11


@pytest.mark.parametrize("points", [63, 64])
@pytest.mark.parametrize("name", ["frictionless", "frictional"])
def test_waves_that_grow_are_seen_down_to_the_shortest_that_a_grid_carries(name, points):
    scene = scene_of(LAWS[name], approaches([0.0]))
    problem = pose_cohesive(scene, scene.heights(points), 1e-7).at(scene.path.steps[0])
    shape = problem.tangent(problem.gap(np.zeros(problem.unknowns, complex)))[1].values.shape[:2]
    shortest = problem.stiffness.diagonal[0, -1].real
    softens = np.arange(points) == 7  # a single point, whose displacement has all waves
    seen = []
    for depth in np.geomspace(0.01, 3.0, 200):
        values = np.zeros((*shape, points)) + 0.1 * shortest * np.eye(*shape)[..., None]
        values[0, 0] = shortest * np.where(softens, -depth, 0.1)
        tangent = Tangent(problem, values)
        growth = find_growth(tangent, ZonePreconditioner(problem, tangent))
        rates = np.linalg.eigvals(matrix_of(lambda u, t=tangent: problem.add_elastic(t(u), u), problem)).real
        assert (growth is not None) == (rates.min() < 0)
        seen.append(growth is not None)
    assert set(seen) == {False, True}


def test_the_shortest_waves_of_a_small_surface_can_grow():
    surface = SelfAffine(2000.0, 0.8, 2000.0, 500.0, rms_height=5.0, dimensions=2)
    law = NormalCohesiveZone(1.0, 1.0)
    scene = Scene(Body(Flat.facing(surface), HalfSpace(1.0)), Body(surface, None), law, approaches([0.0]))
    problem = pose_cohesive(scene, scene.heights(12), 1e-7).at(scene.path.steps[0])
    units = np.eye(144)[:, None]
    columns = [problem.coefficients(unit) for unit in units]
    elastic = np.array([problem.field(problem.add_elastic(np.zeros_like(one), one))[0] for one in columns])
    assert np.allclose(elastic, elastic.T, atol=1e-12 * np.abs(elastic).max())
    largest, seen = np.linalg.eigvalsh(elastic)[-1], []
    softens = np.arange(144) == 77  # a single point, whose displacement has all waves
    away = np.eye(144) - 1 / 144  # an approach holds the uniform displacement
    for depth in np.geomspace(0.1, 2.0, 200):
        values = largest * np.where(softens, -depth, 0.1)[None, None]
        tangent = Tangent(problem, values)
        rates = np.linalg.eigvalsh(away @ (elastic + np.diag(values[0, 0])) @ away)
        assert (find_growth(tangent, ZonePreconditioner(problem, tangent)) is not None) == (rates[0] < -1e-9 * largest)
        seen.append(rates[0] < 0)
    assert set(seen) == {False, True}


@pytest.mark.parametrize(("path", "grows"), [(approaches([0.0]), False), (pressures([0.01]), True)])
@pytest.mark.parametrize("name", LAWS)
def test_bodies_that_soften_all_over_part_under_a_load_and_stay_under_an_approach(name, path, grows):
    scene = scene_of(LAWS[name], path)
    problem = pose_cohesive(scene, scene.heights(64), 1e-7).at(scene.path.steps[0])
    shape = problem.tangent(problem.gap(np.zeros(problem.unknowns, complex)))[1].values.shape[:2]
    values = np.zeros((*shape, 64)) + 0.1 * problem.law_stiffness * np.eye(*shape)[..., None]
    values[0, 0] = -0.1 * min(problem.law_stiffness, problem.stiffness.diagonal[0, 1])
    tangent = Tangent(problem, values)
    growth = find_growth(tangent, ZonePreconditioner(problem, tangent))
    assert (growth is not None) is grows
    if growth is not None:
        assert growth.rate == pytest.approx(-values[0, 0, 0])
        assert np.abs(growth.wave).argmax() == 0


@pytest.mark.parametrize("kind", ["newton", "damped_verlet", "mass_weighted_verlet", "energy_minimisation"])
@pytest.mark.parametrize("trait", LAWS)
def test_a_law_without_potential_is_refused_by_the_minimiser_alone(kind, trait):
    scene = scene_of(LAWS[trait])
    if kind == "energy_minimisation" and trait != "uncoupled":
        error = refusal("solver", None, lambda: _require(kind, scene))
        assert "NON_CONSERVATIVE" in error.allowed
    else:
        check_solver(make_solver(kind), scene)


def _require(kind, scene):
    try:
        check_solver(make_solver(kind), scene)
    except ValueError as error:
        raise error.located("None") from None


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        ("newton", "flow_step"),
        ("newton", "trust_radius"),
        ("damped_verlet", "time_step"),
        ("damped_verlet", "damping"),
        ("mass_weighted_verlet", "damping"),
        ("mass_weighted_verlet", "time_step"),
    ],
)
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan")])
def test_options_out_of_range_are_refused(kind, name, value):
    with pytest.raises(ValueError, match=rf"^{name}: got {value}; allowed: "):
        solver_class(kind)(**{name: value})


def test_a_time_step_beyond_the_limit_of_stability_is_refused():
    scene = scene_of(LAWS["uncoupled"])
    problem = pose_cohesive(scene, scene.heights(64), 1e-7)
    with pytest.raises(ValueError, match=r"^time_step: got 9.0; allowed: below .* limit of stability"):
        make_solver("damped_verlet", time_step=9.0).flow_from(problem, np.zeros(problem.unknowns, complex))
    with pytest.raises(ValueError, match=r"^time_step: got 1.0; allowed: "):
        make_solver("mass_weighted_verlet", time_step=1.0)


UNSTABLE = [
    (-0.5, 0.5, 8.0, 0.5),
    (-0.5, 0.1, 8.0, 0.0),
    (0.3, 0.3, 8.0, 0.0),
    (0.3, 0.1, 8.0, 0.1),
    (0.0, 0.1, 2.0, 0.1),
]
"""Poisson's ratio, δt, φn and c of contacts that part from their symmetry on a coarse grid."""


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "length", "work", "friction"), UNSTABLE)
def test_every_state_of_a_path_is_stable_against_small_disturbances(ratio, length, work, friction):
    law = CohesiveZone(work, friction, 1.0, length)
    body = Layer(70.0 / (1 - ratio**2), ratio, 5000.0)
    found = walk(scene_of(law, along(-10, 10, 0.5), body), points=128)
    assert found.statuses == {"CONVERGED"}
    for state in found.states:
        here = state.problem
        _, tangent = here.tangent(here.gap(state.displacement))
        assert np.linalg.eigvals(_dense(here, tangent)).real.min() > 0


@pytest.mark.parametrize("periods", [3, 5])
def test_equal_asperities_jump_one_by_one_where_jumping_together_would_be_unstable(periods):
    wave = Sinusoid(length=10000.0, amplitude=20.0, periods=periods)
    path = along(-30, -19, 0.1) >> along(-19.1, -32, 0.1)
    found = walk(scene_of(NormalCohesiveZone(2.0), path, HalfSpace(77.0, 0.3), surface=wave), points=128)
    for state in found.states[::2]:
        here = state.problem
        _, tangent = here.tangent(here.gap(state.displacement))
        matrix = _dense(here, tangent)[1:, 1:]  # the mean is held
        assert np.linalg.eigvals(matrix).real.min() > -1e-6
    turn = int(np.argmax([state.step.value for state in found.states])) + 1
    jumps = np.array([state.jump > 0 for state in found.states])
    assert jumps[:turn].sum() >= periods - 1 and jumps[turn:].sum() >= periods - 1


def test_a_contact_leaves_its_symmetry_where_that_is_unstable():
    body = Layer(70.0 / 0.91, -0.5, 3000.0)
    found = walk(scene_of(CohesiveZone(2.0, 0.3, 1.0, 0.3), along(-10, -3, 0.1), body), points=128)
    gaps = [found.gap(count)[0] for count in range(len(found.states))]
    skew = np.array([np.abs(gap - np.roll(gap[::-1], 1)).max() for gap in gaps])
    assert (skew > 0.1).any() and skew[0] < 1e-6  # on which side is left to the solver


def _dense(problem, tangent):
    """K + T' as a matrix of real numbers."""
    rows, modes = problem.unknowns
    real = [(row, wave, 1.0) for row in range(rows) for wave in range(modes)]
    units = real + [(row, wave, 1j) for row in range(rows) for wave in range(1, modes - 1)]
    columns = []
    for row, wave, phase in units:
        unit = np.zeros((rows, modes), complex)
        unit[row, wave] = phase
        moved = problem.add_elastic(tangent(unit), unit)
        columns.append(np.concatenate([moved.real.ravel(), moved[:, 1:-1].imag.ravel()]))
    return np.array(columns).T


def test_a_flow_that_does_not_come_to_rest_goes_on_in_smaller_steps():
    law, cylinder = UncoupledCohesiveZone(2.002, 0.1), Cylinder(length=5000.0, radius=RADIUS)
    scene = scene_of(
        law, approaches(np.linspace(-10, 10, 542)[1:].tolist()), Layer(70.0, 0.0, 5000.0), surface=cylinder
    )
    coarse, fine = (walk(scene, points, increments=Adaptive(), tolerance=5e-5) for points in (144, 288))
    assert coarse.statuses | fine.statuses == {"CONVERGED", "INTERPOLATED"}
    assert coarse.load[-1] == pytest.approx(fine.load[-1], rel=0.01)
