"""Preparing measured heights: a fit leaves what least squares leave, and the seams of lines and areas close."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from contactsim.errors import InputError
from contactsim.surfaces.preparation import prepare_topography
from contactsim.surfaces.topography import Topography
from support.cases import refusal

KINDS = {1: ["mean", "linear", "quadratic"], 2: ["mean", "plane", "quadratic"]}
shapes = array_shapes(min_dims=1, max_dims=2, min_side=2, max_side=60)
fields = arrays(np.float64, array_shapes(min_dims=1, max_dims=2, min_side=2, max_side=9), elements=st.floats(-1e6, 1e6))
lines = arrays(np.float64, st.integers(2, 40), elements=st.floats(-1e6, 1e6))


def prepared(heights: np.ndarray, detrend: str = "none", ends: str = "none") -> np.ndarray:
    """Return prepared heights, at a spacing that must not matter."""
    return prepare_topography(Topography(heights, 2.5), detrend, ends).values


def polynomials(shape: tuple[int, ...], degree: int) -> np.ndarray:
    """Return all products of powers up to a total degree on a grid, (terms, *shape)."""
    axes = np.meshgrid(*(np.linspace(-1, 1, size) for size in shape), indexing="ij")
    powers = [power for power in np.ndindex(*(degree + 1,) * len(shape)) if sum(power) <= degree]
    return np.array([np.prod([x**n for x, n in zip(axes, power, strict=True)], axis=0) for power in powers])


def mean_square_slope(heights: np.ndarray, *, periodic: bool) -> float:
    """Return the mean square of the steps at spacing one."""
    return float(np.mean(np.diff(heights, append=heights[:1] if periodic else heights[:0]) ** 2))


@given(shapes, st.integers(0, 2), st.integers(0, 99))
def test_detrending_removes_any_polynomial_of_its_degree(shape: tuple[int, ...], degree: int, seed: int) -> None:
    terms = polynomials(shape, degree)
    form = 1e3 * np.tensordot(np.random.default_rng(seed).uniform(-1, 1, len(terms)), terms, 1)
    assert np.abs(prepared(form, KINDS[len(shape)][degree])).max() <= 1e-13 * 1e3 * len(terms)


@given(fields, st.integers(0, 2))
def test_detrending_leaves_what_a_least_squares_fit_leaves(heights: np.ndarray, degree: int) -> None:
    terms = polynomials(heights.shape, degree)
    matrix = terms.reshape(len(terms), -1).T
    fit = (matrix @ np.linalg.lstsq(matrix, heights.ravel(), rcond=None)[0]).reshape(heights.shape)
    rounding = 1e-12 * np.abs(heights).max() + np.finfo(float).tiny  # below it numbers have fewer digits
    np.testing.assert_allclose(prepared(heights, KINDS[heights.ndim][degree]), heights - fit, rtol=0, atol=rounding)


@given(fields)
def test_none_changes_nothing_and_gives_a_copy(heights: np.ndarray) -> None:
    topography = Topography(heights, 1.0)
    copy = prepare_topography(topography, "none", "none").values
    assert copy.tolist() == heights.tolist()
    assert not np.shares_memory(copy, topography.values)


@given(fields)
def test_mirror_keeps_every_height_and_is_periodic_and_even(heights: np.ndarray) -> None:
    mirrored = prepared(heights, ends="mirror")
    assert mirrored.shape == tuple(2 * size - 2 for size in heights.shape)
    assert mirrored[tuple(slice(size) for size in heights.shape)].tolist() == heights.tolist()
    for axis in range(heights.ndim):  # even about point 0 of the period
        assert np.roll(np.flip(mirrored, axis), 1, axis).tolist() == mirrored.tolist()


@given(lines)
def test_mirror_keeps_the_rms_slope_of_a_line(heights: np.ndarray) -> None:
    slope = mean_square_slope(prepared(heights, ends="mirror"), periodic=True)
    assert slope == pytest.approx(mean_square_slope(heights, periodic=False), rel=1e-9)


@given(lines)
def test_tilt_subtracts_a_line_and_closes_the_seam(heights: np.ndarray) -> None:
    tilted = prepared(heights, ends="tilt")
    assert tilted[0] == tilted[-1] == 0
    rounding = 1e-14 * 8 * np.abs(heights).max() + 1e-320  # subnormal numbers have few digits
    assert np.abs(np.diff(heights - tilted, n=2)).max(initial=0) <= rounding


@given(fields)
def test_window_keeps_the_shape_and_is_zero_at_all_edges(heights: np.ndarray) -> None:
    tapered = prepared(heights, ends="window")
    assert tapered.shape == heights.shape
    for axis in range(heights.ndim):
        assert not tapered.take([0, -1], axis).any()


def test_window_leaves_the_middle_and_halves_halfway_up_the_taper() -> None:
    heights = 5.0 + np.array([1.0, -1.0] * 100 + [0.0])
    tapered = prepared(heights, ends="window")
    np.testing.assert_allclose(tapered[20:181], (heights - 5)[20:181], rtol=1e-12)
    assert tapered[10] == pytest.approx(0.5)


def test_window_of_an_area_is_the_product_of_those_of_lines() -> None:
    y, x = (np.where(np.arange(size) % 2, 1.0, -1.0) for size in (200, 50))
    expected = np.outer(*(prepared(line, ends="window") for line in (y, x)))
    np.testing.assert_allclose(prepared(np.outer(y, x), ends="window"), expected, atol=1e-13)


def test_window_lowers_the_mean_square_slope_of_short_waves_by_an_eighth() -> None:
    heights = np.random.default_rng(1).standard_normal(200_000)
    after = mean_square_slope(prepared(heights, ends="window"), periodic=True)
    assert after / mean_square_slope(heights, periodic=True) == pytest.approx(0.875, abs=0.005)


@given(fields)
def test_by_default_heights_are_detrended_by_their_dimension_alone(heights: np.ndarray) -> None:
    first_degree = KINDS[heights.ndim][1]
    topography = prepare_topography(Topography(heights, 2.0, "mine"))
    assert topography.values.tolist() == prepared(heights, first_degree).tolist()
    assert (topography.spacing, topography.source) == ((2.0,) * heights.ndim, "mine")


@pytest.mark.parametrize("setting", ["detrend", "ends", "level"])
@pytest.mark.parametrize(("size", "names"), [(1, ["plane", "", "Mirror"]), (2, ["tilt", "linear", ""])])
def test_an_unknown_name_is_refused_with_the_names_that_exist(setting: str, size: int, names: list) -> None:
    topography = Topography(np.ones((3,) * size), 1.0, "mine")
    for name in names:
        error = refusal(setting, "mine", lambda name=name: prepare_topography(topography, **{setting: name}))
        assert error.value == name and error.allowed.startswith("one of none")


def test_scan_lines_that_moved_are_levelled() -> None:
    rng = np.random.default_rng(2)
    smooth = np.outer(np.sin(np.linspace(0, 3, 40)), np.ones(101)) + np.linspace(0, 1, 101)
    moved = smooth + rng.normal(size=(40, 1))
    steps = prepare_topography(Topography(moved, 1.0), "none", level="steps").values
    assert np.allclose(steps, moved[0])
    median = prepare_topography(Topography(moved, 1.0), "none", level="median").values
    assert np.allclose(median, smooth[0] - np.median(smooth[0]))


def test_levelling_by_steps_keeps_a_wide_object_with_oblique_edges_which_medians_do_not() -> None:
    y, x = np.ogrid[:40, :100]
    heights = np.where(np.abs(x - 50) < 2.0 * y, 5.0, 0.0)  # a triangle, four fifths of a row wide in the end
    rng = np.random.default_rng(5)
    moved = Topography(heights + rng.normal(size=(40, 1)), 1.0)
    steps = prepare_topography(moved, "none", level="steps").values
    assert np.allclose(steps - steps[0, 0], heights)
    median = prepare_topography(moved, "none", level="median").values
    assert not np.allclose(median - median[0, 0], heights)


def test_what_is_made_periodic_says_so() -> None:
    raw = Topography(np.random.default_rng(6).normal(size=32), 1.0)
    assert not prepare_topography(raw).periodic
    closed = prepare_topography(raw, ends="window")
    assert closed.periodic
    assert prepare_topography(closed, "none").periodic


def test_what_is_no_topography_is_refused() -> None:
    for value in (np.zeros(9), None, "scan.npy"):
        with pytest.raises(InputError, match=r"topography: prepare_topography needs a Topography: read_topography"):
            prepare_topography(value)
    with pytest.raises(InputError, match="spike: got 3; allowed: no such option"):
        prepare_topography(Topography(np.zeros(9), 1.0), spike=3)


@pytest.mark.parametrize("shape", [(400,), (40, 50)])
def test_spikes_are_replaced_and_nothing_else(shape: tuple[int, ...]) -> None:
    rng = np.random.default_rng(3)
    clean = rng.normal(size=shape)
    places = tuple(rng.integers(5, size - 5, 6) for size in shape)
    spoilt = clean.copy()
    spoilt[places] += np.array([50, -50, 80, 90, -70, 60])
    found = prepare_topography(Topography(spoilt, 1.0), "none", spikes=8)
    assert found.spikes == pytest.approx(len(set(zip(*places, strict=True))) / clean.size)
    assert np.abs(found.values[places]).max() < 4
    untouched = np.ones(shape, bool)
    untouched[places] = False
    assert np.array_equal(found.values[untouched], clean[untouched])
    again = prepare_topography(found, "none")
    assert again.spikes == found.spikes


@pytest.mark.parametrize("digits", [0, 1])
def test_a_spike_on_heights_that_are_flat_or_of_few_digits_is_replaced(digits: int) -> None:
    heights = np.round(digits * np.random.default_rng(7).normal(size=(40, 40)) / 2)
    heights[10, 10], heights[20, 30] = 1000.0, -2000.0
    found = prepare_topography(Topography(heights, 1.0), "none", spikes=10)
    assert found.spikes == 2 / 1600
    assert np.abs(found.values).max() <= 3


def test_heights_without_differences_have_no_spikes() -> None:
    assert prepare_topography(Topography(np.ones((8, 8)), 1.0), "none", spikes=3).spikes == 0


def test_a_threshold_of_spikes_that_is_none_is_refused() -> None:
    for value in (0, -1):
        error = refusal(
            "spikes", "mine", lambda value=value: prepare_topography(Topography(np.ones(8), 1.0, "mine"), spikes=value)
        )
        assert error.allowed.startswith("a positive")
