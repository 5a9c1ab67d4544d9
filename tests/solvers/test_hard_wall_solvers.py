"""What every solver of the hard wall promises, and what the default one promises besides."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import nnls

import contactsim
from contactsim.contact import loading
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.evaluation.robustness.cases import layer_response
from contactsim.explanation import explain_setup
from contactsim.interface.hard_wall import HardWall
from contactsim.paths.options import RunOptions, Setup
from contactsim.reference import hard_wall
from contactsim.solvers.base import State, check_solver, solve
from contactsim.solvers.hard_wall.active_set import ActiveSet
from contactsim.solvers.hard_wall.negative_gap_preconditioner import BlockStiffness, GapExtension
from contactsim.solvers.registry import SOLVERS, make_solver
from contactsim.status import Status
from contactsim.surfaces.preparation import prepare_topography
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed
from contactsim.surfaces.shapes import Flat
from contactsim.surfaces.topography import Topography
from contactsim.traits import Trait
from support.cases import ALL, ON_SURFACES, assert_certified, compliance, press, rough, wave


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("pressure", [3e-3, 3e-2, 0.3, 3.0])
def test_the_answer_is_that_of_a_dense_quadratic_programme(name, pressure):
    points = 48
    heights = rough(points, modes=12)
    result = press(heights, pressure, name, tolerance=1e-6)
    # minimise |R p - R⁻ᵀ h|² + w (Σp - load)² over p ≥ 0, with S = RᵀR on the zero-mean space: an independent route
    matrix = compliance(points)
    values, vectors = np.linalg.eigh(matrix)
    keep = values > 1e-12
    root = np.sqrt(values[keep])[:, None] * vectors[:, keep].T
    target = vectors[:, keep].T @ heights / np.sqrt(values[keep])
    weight = 1e6
    exact, _ = nnls(np.vstack([root, weight * np.ones(points)]), np.append(target, weight * pressure * points))
    assert_certified(result, 1e-6)
    assert np.array_equal(result.contact, exact > 1e-9 * exact.max())
    assert np.allclose(result.pressure, exact, rtol=0, atol=2e-5 * exact.max())


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("hurst_exponent", [0.2, 0.8])
def test_solvers_agree_on_a_rough_line(name, hurst_exponent):
    heights = rough(1024, hurst_exponent)
    for pressure in (3e-3, 0.1):
        ours = press(heights, pressure, tolerance=1e-6)
        other = press(heights, pressure, name, tolerance=1e-6)
        assert_certified(other, 1e-6)
        assert np.array_equal(other.contact, ours.contact)
        assert np.allclose(other.pressure, ours.pressure, rtol=0, atol=1e-4 * ours.pressure.max())


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("ratio", [1e-4, 1e-2, 0.3, 0.5, 0.9, 0.9999, 1.0, 1.001, 10.0])
def test_westergaard_area_is_right_to_one_and_a_half_points(name, ratio):
    points = 256
    full = hard_wall.full_contact_pressure(1.0, points, 1.0)
    result = press(wave(points), ratio * full, name, tolerance=1e-5)
    assert_certified(result, 1e-5)
    assert abs(result.relative_contact_area - hard_wall.sinusoid_area(ratio)) <= 1.5 / points


# ---- approach


@pytest.mark.parametrize("pressure", [1e-3, 1e-2, 0.1, 1.0])
@pytest.mark.parametrize("points", [256, 1001])
def test_an_approach_and_the_pressure_that_it_needs_have_the_same_solution(pressure, points):
    heights = rough(points)
    loaded = press(heights, pressure, tolerance=1e-8)
    moved = contactsim.press(heights, spacing=1.0, contact_modulus=1.0, approach=loaded.approach, tolerance=1e-8)
    assert_certified(moved, 1e-8)
    assert moved.mean_pressure == pytest.approx(pressure, rel=1e-5)
    assert np.array_equal(moved.contact, loaded.contact)


def test_before_first_touch_nothing_is_solved():
    heights = rough(64)
    result = contactsim.press(heights, spacing=1.0, contact_modulus=1.0, approach=-heights.max() - 2.0)
    assert result.record.iterations == 0
    assert not result.contact.any()
    assert result.gap.min() == pytest.approx(2.0)


@pytest.mark.parametrize("solver", ["polonsky_keer", "verlet"])
def test_a_solver_that_cannot_take_an_approach_says_so(solver):
    with pytest.raises(InputError, match=r"accepts APPROACH \(load step given by an approach\)"):
        contactsim.press(rough(64), spacing=1.0, contact_modulus=1.0, approach=0.0, solver=solver)


def test_an_approach_beyond_full_contact_is_refused():
    with pytest.raises(InputError, match="full contact") as caught:
        contactsim.press(wave(64), spacing=1.0, contact_modulus=1.0, approach=0.1)
    assert caught.value.key == "approach"


# ---- registry and refusals


@pytest.mark.parametrize("name", ALL)
def test_each_solver_accepts_every_trait_it_claims_and_refuses_the_rest(name):
    method = make_solver(name)
    paths = {Trait.MEAN_PRESSURE: loading.pressures([0.1]), Trait.APPROACH: loading.approaches([-0.5])}
    for trait, path in paths.items():
        scene = Scene(Body(Flat(8.0), HalfSpace(1.0)), Body(Flat(8.0)), (HardWall(),), path)
        assert scene.traits == {Trait.LINE, Trait.WALL, Trait.HALF_SPACE, trait}
        if trait in method.accepts:
            check_solver(method, scene)
        else:
            with pytest.raises(InputError, match=trait.name):
                check_solver(method, scene)


@pytest.mark.parametrize("thickness", [None, 3.0])
@pytest.mark.parametrize("pressure", [1e-4, 0.03, 0.5])
def test_polonsky_keer_finds_the_same_contact_of_a_surface(pressure, thickness):
    heights = SelfAffine(48, 0.5, 16.0, 6.0, 1.0, dimensions=2, seed=realisation_seed(3, 0.5)).heights(48)[:40]
    layer = {} if thickness is None else {"thickness": thickness, "poisson_ratio": 0.3}
    given = {"spacing": (1.0, 1.5), "contact_modulus": 1.0, "mean_pressure": pressure, "tolerance": 1e-6} | layer
    found, other = (contactsim.press(heights, solver=name, **given) for name in ON_SURFACES)
    assert found.status is Status.CONVERGED
    assert np.array_equal(found.contact, other.contact)
    assert np.allclose(found.pressure, other.pressure, rtol=0, atol=1e-5 * other.pressure.max())


def test_an_unknown_solver_is_refused_with_those_that_exist():
    with pytest.raises(InputError, match=", ".join(sorted(SOLVERS))):
        press(rough(64), 0.1, "conjugate_dreams")


@pytest.mark.parametrize(("options", "key"), [({"time_step": 1.0}, "time_step"), ({"damping": 0.0}, "damping")])
def test_verlet_refuses_options_that_blow_up_or_never_settle(options, key):
    with pytest.raises(InputError) as caught:
        make_solver("verlet", **options)
    assert caught.value.key == key


def test_a_spent_budget_is_an_honest_status_and_still_a_certificate():
    scene = Scene(Body(Flat(256.0), HalfSpace(1.0)), Body(Flat(256.0)), (HardWall(),), loading.pressures([0.1]))
    heights = rough(256)
    problem, scale = pose_hard_wall(scene, scene.path.steps[0], heights, 1e-9, 1)
    result = solve(ActiveSet(budget=1, direct_points=0), problem, scale)
    assert result.status is Status.MAX_ITERATIONS
    assert result.record.iterations == 1
    assert result.record.certificate.max_contact_gap > 1e-9
    assert result.pressure.min() >= 0
    assert result.mean_pressure == pytest.approx(0.1)


def test_what_a_solver_believes_is_not_believed_until_it_is_certified():
    scene = Scene(Body(Flat(256.0), HalfSpace(1.0)), Body(Flat(256.0)), (HardWall(),), loading.pressures([0.1]))
    problem, scale = pose_hard_wall(scene, scene.path.steps[0], rough(256), 1e-9, 1)
    exact = solve(ActiveSet(), problem, scale).pressure / scale.pressure
    spoiled = problem.project(exact * (1 + 1e-3 * np.cos(np.arange(256))))
    error = problem.certify(spoiled)[0]

    class Believing(ActiveSet):
        def start(self, problem, guess=None):
            return State(spoiled, False)

        def step(self, problem, state):
            return State(spoiled, True)

    worst = max(error.max_contact_gap, error.penetration)
    for share, status in ((1.01, Status.CONVERGED), (0.99, Status.MAX_ITERATIONS), (0.2, Status.MAX_ITERATIONS)):
        assert solve(Believing(budget=3), replace(problem, tolerance=share * worst), scale).status is status


def test_a_value_that_is_not_finite_is_caught_and_the_last_good_state_kept():
    class Breaking(ActiveSet):
        def step(self, problem, state):
            following = super().step(problem, state)
            if following.count > 1:
                following.pressure[0] = np.nan
            return following

    scene = Scene(Body(Flat(256.0), HalfSpace(1.0)), Body(Flat(256.0)), (HardWall(),), loading.pressures([0.1]))
    problem, scale = pose_hard_wall(scene, scene.path.steps[0], rough(256), 1e-9, 1)
    result = solve(Breaking(direct_points=0), problem, scale)
    assert result.status is Status.NON_FINITE
    assert np.isfinite(result.pressure).all()


# ---- the parts of the active set


@pytest.mark.parametrize("points", [2, 3, 4, 9, 64, 101])
def test_the_stiffness_is_an_m_matrix_on_every_grid(points):
    row = np.fft.ifft(np.abs(np.fft.fftfreq(points))).real
    assert row[0] > 0
    assert (row[1:] <= 1e-15).all()


@pytest.mark.parametrize("contacts", [[3], [0, 1, 2, 3, 4, 5, 6, 7], [0, 4, 5], [7], [1, 6]])
@pytest.mark.parametrize("decay", [None, 0.3, 30.0, 1e4])
def test_a_gap_extension_keeps_the_contact_and_restriction_is_its_adjoint(contacts, decay):
    index = np.array(contacts)
    both = GapExtension(index, 8) if decay is None else GapExtension(index, 8, decay)
    rng = np.random.default_rng(0)
    values, field = rng.normal(size=len(contacts)), rng.normal(size=8)
    extended = np.empty(8)
    both.extend(values, extended, np.empty(8))
    rolled = np.roll(extended, contacts[0])
    assert np.allclose(rolled[contacts], values)
    assert np.dot(extended, field) == pytest.approx(np.dot(values, both.restrict(field.copy())))
    if decay is None:  # linear between contacts
        assert np.allclose(rolled, np.interp(np.arange(8), contacts, values, period=8))
        assert both.restrict(field).sum() == pytest.approx(field.sum())
    else:
        assert both.share(field).sum() == pytest.approx(field.sum())
    if decay == 30.0:
        assert np.abs(np.delete(rolled, contacts)).max(initial=0.0) < 1e-12


@pytest.mark.parametrize("points", [63, 512, 4096])
def test_the_preconditioners_stiffness_is_close_to_the_true_one_and_kills_constants(points):
    scene = Scene(Body(Flat(points), HalfSpace(1.0)), Body(Flat(points)), (HardWall(),), loading.pressures([0.1]))
    problem, _ = pose_hard_wall(scene, scene.path.steps[0], rough(64 if points < 64 else points)[:points], 1e-3, 1)
    stiffness = BlockStiffness(problem.compliance, uniform=True)
    scratch = np.empty(points)

    def apply(values):
        stiffness.field[:] = values
        return stiffness(np.empty(points), scratch)

    assert np.abs(apply(np.ones(points))).max() < 1e-13
    for mode in (1, 2, points // 20, points // 5, points // 3, points // 2 - 1):
        q = 2 * np.pi * mode / points
        sine = np.sin(q * np.arange(points))
        exact = 0 if points < 512 else 0.35  # blocks of eight smear a wave of their own length; a CG needs no more
        assert sine @ apply(sine) == pytest.approx(q / 2 * (sine @ sine), rel=max(exact, 1e-9))


@pytest.mark.parametrize(("ratio", "thickness"), [(0.3, 1.0), (0.3, 10.0), (0.3, 100.0), (0.5, 10.0), (0.5, 100.0)])
def test_the_preconditioners_stiffness_is_close_to_that_of_the_layer(ratio, thickness):
    points = 512
    response = layer_response(2 * np.pi * np.fft.rfftfreq(points) * thickness, ratio) * thickness
    flat = Flat(float(points))
    layer = Body(flat, Layer(1.0, ratio, thickness))
    subject = Scene(layer, Body(flat), (HardWall(),), loading.pressures([0.1]))
    problem, _ = pose_hard_wall(subject, subject.path.steps[0], rough(points), 1e-3, 1)
    stiffness = BlockStiffness(problem.compliance, uniform=True)
    for mode in (1, 5, points // 5, points // 3, points // 2 - 1):
        sine = np.sin(2 * np.pi * mode / points * np.arange(points))
        stiffness.field[:] = sine
        exact = 1 / response[mode]
        assert sine @ stiffness(np.empty(points), np.empty(points)) / (sine @ sine) == pytest.approx(exact, rel=0.35)


# ---- cost


def test_a_sweep_of_the_thesis_takes_few_transforms_and_hardly_more_on_finer_grids():
    spent = {}
    for points in (2**14, 2**16):
        heights = rough(points, modes=4095)
        results = [press(heights, pressure) for pressure in np.geomspace(1e-3, 1e-1, 12)]
        for result in results:
            assert_certified(result)
        spent[points] = sum(result.record.transforms for result in results)
    assert spent[2**14] <= 1500
    assert spent[2**16] <= 1.3 * spent[2**14]


def test_the_cascade_costs_less_than_starting_on_the_fine_grid():
    heights = rough(4096)
    scene = Scene(Body(Flat(4096.0), HalfSpace(1.0)), Body(Flat(4096.0)), (HardWall(),), loading.pressures([0.01]))
    work = {}
    for name, method in (("nested", make_solver("active_set")), ("plain", ActiveSet())):
        problem, scale = pose_hard_wall(scene, scene.path.steps[0], heights, 1e-3, 1)
        result = solve(method, problem, scale)
        assert_certified(result)
        work[name] = result.record.transforms
    assert work["nested"] < 0.8 * work["plain"]


# ---- hard for rounding


@pytest.mark.parametrize("load", [1e-10, 1e-20, 1e-200])
def test_a_load_far_below_the_rounding_of_the_gaps_stands_on_one_point(load):
    heights = np.random.default_rng(1).standard_normal(4096)
    result = contactsim.press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=load)
    assert result.status is Status.CONVERGED
    assert result.contact.nonzero()[0].tolist() == [heights.argmax()]


@pytest.mark.parametrize("name", ALL)
def test_a_profile_that_is_flat_but_for_rounding_is_in_full_contact(name):
    plane = prepare_topography(Topography(np.linspace(0.0, 50.0, 1000), 2.0), detrend="linear")
    assert 0 < np.ptp(plane.values) < 1e-12
    result = contactsim.press(plane.values, spacing=2.0, contact_modulus=70.0, mean_pressure=0.1, solver=name)
    assert result.status is Status.CONVERGED
    assert result.contact.all()


@pytest.mark.parametrize("load", [0.003, 0.03, 0.3])
def test_tamaas_finds_the_same_solution_and_its_transforms_are_counted(load):
    pytest.importorskip("tamaas")
    heights = rough(512, 0.5)
    options = {"spacing": 1.0, "contact_modulus": 2.0, "mean_pressure": load * 1e-2, "tolerance": 1e-8}
    ours, theirs = (contactsim.press(heights, solver=name, **options) for name in ("active_set", "tamaas"))
    assert theirs.status is Status.CONVERGED
    assert (theirs.contact == ours.contact).all()
    assert theirs.approach == pytest.approx(ours.approach, rel=1e-6)
    assert theirs.record.transforms % 2 == 0
    assert theirs.record.transforms > 20


def test_a_peer_that_is_not_installed_is_refused_and_said_to_be_missing(monkeypatch):
    monkeypatch.setattr("contactsim.solvers.registry.find_spec", lambda name: None)
    with pytest.raises(InputError, match="pip install tamaas"):
        make_solver("tamaas")
    scene = Scene(Body(Flat(1.0), HalfSpace(1.0)), Body(Flat(1.0)), (HardWall(),), loading.pressures([1.0]))
    assert "tamaas: not installed" in explain_setup(Setup(scene, RunOptions(64))).text


def test_one_solver_serves_several_threads_at_once():
    heights = np.random.default_rng(1).standard_normal(4096)
    shared = make_solver("active_set")

    def area(load):
        pressed = contactsim.press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=load, solver=shared)
        return pressed.relative_contact_area

    loads = [0.01, 0.02, 0.05, 0.1] * 4
    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(area, loads)) == [area(load) for load in loads]


@pytest.mark.parametrize("load", [{"mean_pressure": 3e-4}, {"mean_pressure": 3e-2}, {"approach": -8.0}])
@pytest.mark.parametrize("thickness", [None, 20.0])
def test_elimination_and_conjugate_gradients_find_the_same_pressure(load, thickness):
    layer = {} if thickness is None else {"thickness": thickness, "poisson_ratio": 0.3}
    results = [
        contactsim.press(
            rough(256),
            spacing=1.0,
            contact_modulus=1.0,
            tolerance=1e-9,
            solver=make_solver("active_set", direct_points=most),
            **layer,
            **load,
        )
        for most in (0, 96)
    ]
    assert [result.status for result in results] == [Status.CONVERGED] * 2
    assert np.array_equal(*(result.contact for result in results))
    assert np.allclose(*(result.pressure for result in results), rtol=0, atol=1e-7 * results[0].pressure.max())
    assert results[1].record.transforms < results[0].record.transforms / 2


@pytest.mark.parametrize("points", [64, 256, 1024])
def test_few_contact_points_take_few_transforms(points):
    assert press(rough(points), 1e-3).record.transforms <= 16


@pytest.mark.parametrize("direct_points", [0, 160])
def test_a_set_that_shrinks_to_one_point_carries_the_load_exactly(direct_points):
    heights = -0.5 * (np.arange(64) - 20.0) ** 2
    result = press(heights, 1e-12, make_solver("active_set", direct_points=direct_points))
    assert result.contact.sum() == 1
    assert result.record.certificate.load_error <= 1e-15


@pytest.mark.parametrize("points", [131, 201, 255, 257])
@pytest.mark.parametrize("missing", [1e-2, 1e-5])
def test_an_approach_just_short_of_complete_contact_is_solved_on_odd_grids(points, missing):
    for seed in range(4):
        heights = np.random.default_rng(seed).normal(size=points)
        approach = -heights.max() + (heights.max() - heights.mean()) * (1 - missing)
        result = contactsim.press(heights, spacing=1.0, contact_modulus=1.0, approach=approach)
        assert result.status is Status.CONVERGED
