from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls

import contactsim
from contactsim.contact import loading
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.interface.hard_wall import HardWall
from contactsim.reference import hard_wall
from contactsim.solvers.base import check_solver, solve
from contactsim.solvers.hard_wall.conjugate_gradients import NestedConjugateGradients
from contactsim.solvers.hard_wall.contact_iteration import refine_signed_field
from contactsim.solvers.hard_wall.tamaas import Tamaas, TamaasState
from contactsim.solvers.registry import make_solver
from contactsim.status import Status
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed
from contactsim.surfaces.shapes import Flat, Sinusoid
from support.cases import press as press_line

UNIT = (1.0, 1.0)


class Heights:
    """A surface given by its heights, of unit spacing in both directions or as told."""

    def __init__(self, heights, spacing=(1.0, 1.0)):
        self.given, self.points, self.modes = heights, heights.shape[1], None
        self.lengths = tuple(np.multiply(heights.shape, spacing))

    def shape(self, points):
        return self.given.shape

    def check(self, points):
        assert points == self.points

    def heights(self, points):
        return self.given


def press(
    heights, pressure=None, *, approach=None, body=None, tolerance=1e-6, threads=1, spacing=(1.0, 1.0), **options
):
    surface = heights if hasattr(heights, "heights") else Heights(np.asarray(heights, float), spacing)
    path = loading.pressures([pressure]) if approach is None else loading.approaches([approach])
    scene = Scene(Body(Flat.facing(surface), body or HalfSpace(1.0)), Body(surface), (HardWall(),), path)
    method = make_solver("conjugate_gradients", **options)
    check_solver(method, scene)
    return solve(method, *pose_hard_wall(scene, path.steps[0], scene.heights(surface.points), tolerance, threads))


def rough(points, hurst_exponent=0.8, seed=1):
    surface = SelfAffine(
        points, hurst_exponent, points / 2, 8.0, 1.0, seed=realisation_seed(seed, hurst_exponent), dimensions=2
    )
    return surface.heights(points)


def wavenumber(shape, spacing=UNIT):
    axes = (2 * np.pi * np.fft.fftfreq(n, d) for n, d in zip(shape, spacing, strict=True))
    return np.hypot(*np.meshgrid(*axes, indexing="ij"))


def compliance(shape, spacing=(1.0, 1.0), body=None):
    """The dense compliance matrix, by numpy alone."""
    q = wavenumber(shape, spacing)
    symbol = np.divide(2.0, q, out=np.zeros(shape), where=q > 0) if body is None else body.compliance(q)
    first = np.fft.ifft2(symbol).real
    rows = np.indices(shape).reshape(2, -1)
    apart = (rows[:, :, None] - rows[:, None, :]) % np.array(shape)[:, None, None]
    return first[tuple(apart)]


def dense(heights, pressure, matrix):
    """The solution by non-negative least squares of the optimality conditions' quadratic programme."""
    h = heights.ravel()
    uniform = 1e6 * matrix[0, 0]
    hessian = matrix + uniform  # a load given: the uniform mode is held by a stiff penalty
    factor = np.linalg.cholesky(hessian).T
    target = np.linalg.solve(factor.T, h - h.max() + uniform * pressure * h.size)
    return nnls(factor, target, maxiter=100 * h.size)[0].reshape(heights.shape)


# ---- exact answers


@pytest.mark.parametrize("ratio", [0.01, 0.3, 0.9, 0.999])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_wave_along_either_axis_has_westergaards_area(ratio, axis):
    wave = np.cos(2 * np.pi * np.arange(256) / 256)
    heights = np.broadcast_to(wave if axis else wave[:, None], (256, 256))
    result = press(heights, ratio * hard_wall.full_contact_pressure(1.0, 256.0, 1.0))
    assert result.status is Status.CONVERGED
    assert abs(result.relative_contact_area - hard_wall.sinusoid_area(ratio)) <= 1.5 / 256
    assert np.ptp(result.pressure, axis=1 - axis).max() < 1e-4 * result.pressure.max()


def test_a_wave_on_a_surface_is_that_along_a_line():
    wave = np.cos(2 * np.pi * np.arange(128) / 128) + 0.3 * np.sin(10 * np.pi * np.arange(128) / 128)
    surface = press(np.tile(wave, (64, 1)), 0.004, tolerance=1e-8)
    line = press_line(wave, 0.004, tolerance=1e-8)
    assert (surface.contact == line.contact).all()
    np.testing.assert_allclose(surface.pressure, np.tile(line.pressure, (64, 1)), atol=1e-6 * line.pressure.max())
    assert surface.approach == pytest.approx(line.approach, rel=1e-8)


def test_waves_crossed_are_flattened_at_their_pressure_of_complete_contact():
    surface = Sinusoid(64.0, 1.0, dimensions=2)
    surface_points = 64
    flat = np.sqrt(2) * hard_wall.full_contact_pressure(1.0, 64.0, 1.0)  # |q| is √2 times that of one wave
    for factor, full in ((0.999, False), (1.001, True)):
        result = press(surface.heights(surface_points), factor * flat)
        assert result.status is Status.CONVERGED
        assert result.contact.all() == full
    exact = factor * flat + flat * surface.heights(surface_points)
    np.testing.assert_allclose(result.pressure, exact, atol=1e-5 * flat)


# ---- another method


@pytest.mark.parametrize("load", [0.02, 0.3, 2.0])
@pytest.mark.parametrize("spacing", [(1.0, 1.0), (0.5, 1.0)])
@pytest.mark.parametrize("body", [None, Layer(1.0, 0.3, 2.0), Layer(1.0, 0.5, 3.0)])
def test_the_answer_is_that_of_a_dense_quadratic_programme(load, spacing, body):
    heights = rough(32)[:12, :10]
    exact = dense(heights, load, compliance(heights.shape, spacing, body))
    result = press(heights, load, body=body, spacing=spacing, tolerance=1e-9)
    assert result.status is Status.CONVERGED
    np.testing.assert_allclose(result.pressure, exact, atol=1e-4 * exact.max())


@pytest.mark.parametrize("shape", [(2, 2), (3, 5), (17, 31), (7, 64), (130, 129), (96, 480)])
@pytest.mark.parametrize("share", [0.05, 0.6])
def test_made_answers_are_found_on_sizes_of_any_kind(shape, share):
    draw = np.random.default_rng(shape)
    field = draw.standard_normal(shape)
    field -= np.quantile(field, 1 - share) - 1e-3
    pressure, gap = np.maximum(field, 0), np.maximum(-field, 0)
    q = wavenumber(shape)
    symbol = np.divide(2.0, q, out=np.zeros(shape), where=q > 0)
    heights = np.fft.ifft2(np.fft.fft2(pressure) * symbol).real - gap
    result = press(heights, pressure.mean(), tolerance=1e-7)
    assert result.status is Status.CONVERGED
    assert (result.contact == (pressure > 0)).mean() > 0.999
    np.testing.assert_allclose(result.pressure, pressure, atol=1e-4)


# ---- what must not matter


@pytest.mark.parametrize("reduced", [1e-3, 1e-2, 0.1, 1.0, 3.0])
def test_threads_cascade_shift_and_mirror_leave_the_contact_as_it_is(reduced):
    heights = rough(256, 0.5)
    usual = press(heights, reduced)
    assert usual.status is Status.CONVERGED
    undecided = np.abs(usual.gap) < 1e-5  # points that neither carry nor gape to within the tolerance
    undecided &= usual.pressure < 1e-5
    variants = {
        "threads": press(heights, reduced, threads=2).contact,
        "one grid": press(heights, reduced, coarsest=256).contact,
        "two grids": press(heights, reduced, coarsest=128).contact,
        "shifted": np.roll(press(np.roll(heights, (5, 70), (0, 1)), reduced).contact, (-5, -70), (0, 1)),
        "mirrored": press(heights[::-1], reduced).contact[::-1],
        "transposed": press(np.ascontiguousarray(heights.T), reduced).contact.T,
    }
    for name, contact in variants.items():
        assert ((contact == usual.contact) | undecided).all(), name


# ---- approach, layers, hard cases


@pytest.mark.parametrize("layer", [None, Layer(1.0, 0.3, 8.0)], ids=["half-space", "layer"])
def test_an_approach_within_the_tolerance_of_first_touch_takes_one_step(layer):
    heights = np.random.default_rng(3).normal(size=(64, 64))
    grazing = press(heights, approach=-heights.max() + 1e-4, body=layer, tolerance=1e-3)  # grid steps of about √2
    assert (grazing.status, grazing.record.iterations) == (Status.CONVERGED, 1)
    assert not grazing.contact.any() and 0 < grazing.record.certificate.penetration < 1e-3


def test_an_approach_gives_the_load_that_gives_the_approach():
    heights = rough(128)
    for body in (HalfSpace(1.0), Layer(1.0, 0.3, 30.0)):
        pushed = press(heights, 0.05, body=body, tolerance=1e-8)
        moved = press(heights, approach=pushed.approach, body=body, tolerance=1e-8)
        assert moved.status is Status.CONVERGED
        assert moved.mean_pressure == pytest.approx(0.05, rel=1e-6)
        assert (moved.contact == pushed.contact).mean() > 0.999


def test_a_thick_layer_is_a_half_space_and_a_thin_one_a_row_of_springs():
    heights = rough(64)
    thick = press(heights, 0.05, body=Layer(1.0, 0.3, 1e6), tolerance=1e-8)
    half = press(heights, 0.05, tolerance=1e-8)
    assert (thick.contact == half.contact).all()
    thin = Layer(1.0, 0.2, 1e-3)
    springs = press(heights, 0.05, body=thin, tolerance=1e-8)
    overlap = np.maximum(springs.approach + heights, 0)
    expected = overlap / thin.compliance(np.zeros(1))[0]
    assert springs.status is Status.CONVERGED
    np.testing.assert_allclose(springs.pressure, expected, atol=2e-3 * expected.max())


@pytest.mark.parametrize(
    ("heights", "load"),
    [(np.zeros((32, 32)), 0.3), (1e3 * rough(64), 1e2), (1e-12 * rough(64), 1e-13)],
    ids=["flat", "steep", "small units"],
)
def test_flat_and_steep_surfaces_and_small_units_are_certified(heights, load):
    result = press(heights, load)
    assert result.status is Status.CONVERGED
    assert np.isfinite(result.pressure).all()
    assert result.mean_pressure == pytest.approx(load, rel=1e-12)


def test_without_load_nothing_is_iterated():
    result = press(rough(64), 0.0)
    assert result.record.iterations == 0
    assert not result.contact.any()


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 40), st.integers(2, 40), st.floats(-6, 1), st.floats(-3, 3), st.integers(0, 1000), st.booleans())
def test_any_heights_under_any_load_are_certified_or_fail_honestly(ny, nx, load, height, seed, noisy):
    heights = np.random.default_rng(seed).standard_normal((ny, nx))
    if not noisy:
        heights = np.cumsum(np.cumsum(heights - heights.mean(), 0), 1)
    result = press(10**height * heights, 10**load, tolerance=1e-4)
    assert np.isfinite(result.pressure).all()
    assert np.isfinite(result.gap).all()
    certificate = result.record.certificate
    if result.status is Status.CONVERGED:
        assert max(certificate.max_contact_gap, certificate.penetration) <= 1e-4
    assert result.status is not Status.NON_FINITE


def test_a_line_is_refused():
    with pytest.raises(InputError, match="LINE"):
        press_line(np.arange(8.0), 0.1, solver="conjugate_gradients")


@pytest.mark.parametrize("options", [{"wavelength": 0.0}, {"coarsest": 1}, {"coarse_tolerance": 0.0}])
def test_bad_options_are_refused(options):
    with pytest.raises(InputError, match=next(iter(options))):
        NestedConjugateGradients(**options)


def test_work_hardly_grows_with_the_grid():
    counts = [press(rough(points), 0.01).record.transforms for points in (128, 256, 512)]
    assert max(counts) < 70


# ---- another code


def test_tamaas_finds_the_same_solution_of_a_surface_whatever_its_shape():
    pytest.importorskip("tamaas")
    for spacing, cut in ((UNIT, np.s_[:, :]), ((0.5, 1.0), np.s_[:48, :]), ((1.3, 0.7), np.s_[:, :45])):
        for load in (1e-3, 0.3):
            given = {"spacing": spacing, "contact_modulus": 2.0, "mean_pressure": load, "tolerance": 1e-8}
            ours, theirs = (contactsim.press(rough(64)[cut], solver=name, **given) for name in (None, "tamaas"))
            assert theirs.status is Status.CONVERGED
            assert (theirs.contact == ours.contact).all()
            assert theirs.approach == pytest.approx(ours.approach, rel=1e-6)
            assert theirs.record.transforms > 20


def test_tamaas_is_refused_where_its_wavenumbers_are_wrong():
    pytest.importorskip("tamaas")
    with pytest.raises(InputError, match="an even number of rows"):
        contactsim.press(rough(64)[:45], spacing=1.0, contact_modulus=1.0, mean_pressure=0.1, solver="tamaas")


class FailingMethod:
    """A solver of tamaas that fails as it does on a contact of a single point."""

    def solve(self, load):
        raise FloatingPointError("division by zero")


class FailingTamaas(Tamaas):
    """Our solver around it, without tamaas itself."""

    def start(self, problem, guess=None):
        return TamaasState(np.zeros(problem.shape), False, FailingMethod(), SimpleNamespace(iterations=0), 1e-2)


def test_an_error_of_tamaas_is_a_solution_that_is_not_finite():
    result = contactsim.press(rough(64), spacing=UNIT, contact_modulus=2.0, mean_pressure=0.1, solver=FailingTamaas())
    assert result.status is Status.NON_FINITE
    assert np.isfinite(result.pressure).all()


def test_a_smooth_pressure_is_refined_to_the_fourth_order():
    def field(points):
        x = 2 * np.pi * np.arange(points) / points
        return 2.0 + np.sin(x + 0.3)[:, None] * np.cos(x - 0.7)

    errors = [np.abs(refine_signed_field(field(n), (2 * n, 2 * n), 1) - field(2 * n)).max() for n in (16, 32, 64)]
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx([4, 4], abs=0.1)
