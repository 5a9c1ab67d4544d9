"""Hard cases at every severity: the right answer or a clear refusal, never NaN."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls

import contactsim
from contactsim.evaluation.robustness.adhesive import ADHESIVE
from contactsim.evaluation.robustness.adhesive_surfaces import ADHESIVE_SURFACES
from contactsim.evaluation.robustness.attracting_walls import ATTRACTING_WALLS
from contactsim.evaluation.robustness.cases import (
    Case,
    flat_pressure,
    make_case,
    mirror_field,
    point_pressure,
    summit_pressure,
)
from contactsim.evaluation.robustness.judge import judge
from contactsim.evaluation.robustness.outcome import Outcome
from contactsim.evaluation.robustness.registry import GROUPS, HAZARDS
from contactsim.evaluation.robustness.rough import ROUGH
from contactsim.evaluation.robustness.sliding import SLIDING
from contactsim.reference import hard_wall
from contactsim.solvers.registry import solver_class
from contactsim.traits import Trait
from support.cases import ALL, FAST, ON_SURFACES, assert_certified, compliance, press, rough, wave

PATHS = [
    hazard.__name__ for group in (ADHESIVE, ADHESIVE_SURFACES, ATTRACTING_WALLS, ROUGH, SLIDING) for hazard in group
]
WALLS = [hazard for hazard in HAZARDS if hazard not in PATHS]
ON_LINES_ONLY = {name for name in WALLS if HAZARDS[name](0).heights.ndim == 1}


def test_no_two_hazards_have_one_name():
    assert len(HAZARDS) == sum(map(len, GROUPS))


PAIRS = [(hazard, name) for hazard in WALLS for name in (ALL if hazard in ON_LINES_ONLY else ON_SURFACES)]
TIGHT = ("flat", "tight_tolerance", "tight_surface_tolerance")
"""Below what rounding allows at last."""


@pytest.mark.slow
@pytest.mark.parametrize(("hazard", "name"), PAIRS)
@pytest.mark.parametrize("severity", [0, 25, 50, 75, 100])
def test_no_hazard_is_answered_wrongly(hazard, name, severity):
    if name == "polonsky_keer" and hazard not in ON_LINES_ONLY and severity > 50:
        pytest.skip("where it only spends its budget, at length: the map shows it")
    case = HAZARDS[hazard](severity)
    verdict = judge(case, name)
    assert verdict.outcome not in (Outcome.WRONG, Outcome.NON_FINITE), verdict.reason
    if case.refuse:
        assert (verdict.outcome, verdict.reason[:13]) == (Outcome.REFUSED, "mean_pressure")
    elif case.approach is not None and Trait.APPROACH not in solver_class(name).accepts:
        assert verdict.outcome is Outcome.REFUSED
        assert "APPROACH" in verdict.reason
    elif hazard in TIGHT:  # and said so
        assert verdict.outcome in (Outcome.EXACT, Outcome.FAILED)
    else:
        known = case.exact is not None or case.area is not None
        assert verdict.outcome is (Outcome.EXACT if known else Outcome.CERTIFIED)


@pytest.mark.parametrize("hazard", WALLS)
def test_a_solver_of_the_other_dimension_is_refused(hazard):
    name, trait = ("conjugate_gradients", "LINE") if hazard in ON_LINES_ONLY else ("active_set", "SURFACE")
    verdict = judge(HAZARDS[hazard](50), name)
    assert verdict.outcome is Outcome.REFUSED
    assert f"accepts {trait}" in verdict.reason or hazard == "tension"


@pytest.mark.parametrize(("hazard", "severity"), [("few_points", 25), ("few_points", 35), ("low_spike", 25)])
def test_where_no_exact_answer_is_known_a_dense_method_of_another_kind_agrees(hazard, severity):
    case = HAZARDS[hazard](severity)
    result = press(case.heights, case.mean_pressure, tolerance=1e-9)
    top = np.argsort(case.heights)[-257:]  # no other can touch
    below = case.heights[top] - case.heights.max()
    load = case.mean_pressure * case.heights.size
    # the pressure of least energy is the point of a simplex next to another point, which least squares with
    # p ≥ 0 finds: Lawson and Hanson, Solving Least Squares Problems, ch. 23
    factor = np.linalg.cholesky(load * (compliance(case.heights.size) + 1.0)[np.ix_(top, top)]).T
    rows = np.vstack([factor - np.linalg.solve(factor.T, below)[:, None], np.ones(top.size)])
    share, _ = nnls(rows, np.append(np.zeros(top.size), 1.0))
    exact = np.zeros(case.heights.size)
    exact[top] = load * share / share.sum()
    assert np.array_equal(result.contact, exact > 0)
    assert np.allclose(result.pressure, exact, rtol=0, atol=1e-5 * exact.max())


@pytest.mark.parametrize("severity", [0, 37, 100])
@pytest.mark.parametrize("hazard", WALLS)
def test_a_hazard_gives_the_same_case_every_time_symmetric_where_it_says_so(hazard, severity):
    case, again = HAZARDS[hazard](severity), HAZARDS[hazard](severity)
    assert np.isfinite(case.heights).all()
    assert np.array_equal(case.heights, again.heights)
    assert (case.mean_pressure is None) != (case.approach is None)
    if case.mirror is not None:
        assert np.allclose(case.heights, mirror_field(case.heights, case.mirror), rtol=0, atol=1e-12)


def test_a_made_case_has_its_answer_by_a_sum_over_the_dense_compliance():
    field = np.random.default_rng(2).normal(size=30)
    case = make_case(field)
    gap = compliance(30) @ case.exact - case.heights
    assert np.allclose(case.exact, np.maximum(field, 0))
    assert np.allclose(gap, np.maximum(-field, 0), atol=1e-13)
    assert case.mean_pressure == pytest.approx(case.exact.mean())


@pytest.mark.parametrize("spacing", [1.0, (1.0, 2.5)])
def test_a_made_surface_has_its_answer_by_a_sum_over_waves(spacing):
    field = np.random.default_rng(2).normal(size=(6, 7))
    case = make_case(field, spacing=spacing)
    dy, dx = np.broadcast_to(spacing, 2)
    rows, columns = np.indices(field.shape)
    gap = -case.heights
    for ky in range(6):
        for kx in range(1 if ky == 0 else 0, 7):
            q = 2 * np.pi * np.hypot(min(ky, 6 - ky) / (6 * dy), min(kx, 7 - kx) / (7 * dx))
            wave = np.exp(2j * np.pi * (ky * rows / 6 + kx * columns / 7))
            gap = gap + 2 / q * (wave * (case.exact * wave.conj()).mean()).real
    assert np.allclose(case.exact, np.maximum(field, 0))
    assert np.allclose(gap, np.maximum(-field, 0), atol=1e-13)


def test_equal_summits_have_uniform_displacement_and_one_summit_the_pressure_of_a_point():
    heights = np.zeros((9, 8))
    heights[4, 3] = 5.0
    assert np.allclose(summit_pressure(heights, 1e-2), point_pressure(heights, 1e-2), rtol=1e-12)
    heights[4:7, 3:5] = 5.0
    case = Case(heights, 1e-2, exact=summit_pressure(heights, 1e-2), tolerance=1e-9)
    assert case.exact.mean() == pytest.approx(1e-2)
    assert np.array_equal(case.exact > 0, heights > 0)
    assert judge(case, "conjugate_gradients").outcome is Outcome.EXACT
    assert summit_pressure(heights, 1e3) is None  # then what is around touches too


def test_complete_contact_is_that_of_the_analytic_formula():
    heights = rough(64)
    assert np.allclose(flat_pressure(heights, Case(heights).compliance), hard_wall.complete_contact(heights, 64.0, 1.0))


@pytest.mark.parametrize("name", FAST)
@pytest.mark.parametrize("points", [2, 3, 4, 5, 7, 8, 9, 97, 101, 510, 512, 513, 997, 1000])
def test_every_number_of_points_is_accepted(name, points):
    heights = np.random.default_rng(points).normal(size=points)
    for pressure in (1e-4, 0.05, 5.0):
        assert_certified(press(heights, pressure, name))


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("unit", [1e-12, 1e-6, 1.0, 1e6, 1e12])
@pytest.mark.parametrize("modulus", [1e-12, 1.0, 1e12])
def test_the_answer_does_not_depend_on_units(name, unit, modulus):
    heights = rough(256)
    expected = press(heights, 0.03, name)
    result = contactsim.press(
        unit * heights, spacing=unit, contact_modulus=modulus, mean_pressure=0.03 * modulus, solver=name
    )
    assert_certified(result)
    assert np.array_equal(result.contact, expected.contact)
    assert np.allclose(result.pressure / modulus, expected.pressure, rtol=1e-6)
    assert result.record.iterations == expected.record.iterations


@pytest.mark.parametrize("name", FAST)
def test_a_mirrored_or_shifted_profile_has_the_mirrored_or_shifted_answer(name):
    heights = rough(510)
    expected = press(heights, 0.02, name, tolerance=1e-7)
    for change in (lambda field: field[::-1], lambda field: np.roll(field, 123)):
        result = press(np.ascontiguousarray(change(heights)), 0.02, name, tolerance=1e-7)
        assert np.array_equal(result.contact, change(expected.contact))
        assert np.allclose(result.pressure, change(expected.pressure), rtol=0, atol=1e-5 * expected.pressure.max())


def test_the_area_is_the_same_from_every_depth_of_the_cascade_and_with_two_threads():
    heights = rough(4096)
    expected = press(heights, 0.02)
    for threads in (1, 2):
        assert np.array_equal(press(heights, 0.02, threads=threads).contact, expected.contact)
    for coarsest in (64, 1024, 1 << 20):
        method = contactsim.solvers.registry.make_solver("active_set", coarsest=coarsest)
        assert np.array_equal(press(heights, 0.02, method).contact, expected.contact)


POINTS, HEIGHTS, LOADS = (2, 200), 1e6, (-6, 2)
"""Ranges of the search: number of points; heights up to this many spacings; powers of ten of the load in E*·step."""


def lists_of(values):
    return st.integers(*POINTS).flatmap(lambda n: st.lists(values, min_size=n, max_size=n)).map(np.array)


def numbers(limit):
    return st.floats(-limit, limit, allow_nan=False, allow_subnormal=False)


@st.composite
def noises(draw):
    """White noise over up to six decades, a share of it positive: dense where hypothesis's own lists are sparse."""
    points, seed, share = draw(st.integers(*POINTS)), draw(st.integers(0, 1 << 16)), draw(st.floats(0, 0.999))
    random = np.random.default_rng(seed)
    field = random.normal(size=points) * 10 ** random.uniform(-draw(st.floats(0, 6)), 0, points)
    return field - np.quantile(field, share)


@pytest.mark.parametrize(("name", "failures"), [("active_set", False), ("polonsky_keer", True)])
def test_any_heights_under_any_load_are_certified_or_fail_honestly(name, failures):
    @settings(max_examples=300 if name == "active_set" else 100, deadline=None, derandomize=True)
    @given(lists_of(numbers(HEIGHTS)) | noises(), st.floats(*LOADS))
    def search(heights, exponent):
        step = np.sqrt(np.mean(np.diff(heights, append=heights[0]) ** 2)) or 1.0
        verdict = judge(Case(heights, 10**exponent * step, tolerance=1e-3), name)
        allowed = (Outcome.CERTIFIED, Outcome.FAILED) if failures else (Outcome.CERTIFIED,)
        assert verdict.outcome in allowed, verdict.reason

    search()


@pytest.mark.parametrize(("name", "failures"), [("active_set", False), ("polonsky_keer", True)])
def test_any_pressure_and_gap_are_found_again_from_the_heights_that_they_make(name, failures):
    @settings(max_examples=200 if name == "active_set" else 100, deadline=None, derandomize=True)
    @given((lists_of(numbers(1e3)) | noises()).filter(lambda field: field.max() > 1e-3), st.integers(-6, 6))
    def search(field, exponent):
        verdict = judge(make_case(field, scale=10.0**exponent, tolerance=1e-6), name)
        allowed = (Outcome.EXACT, Outcome.FAILED) if failures else (Outcome.EXACT,)
        assert verdict.outcome in allowed, verdict.reason

    search()


def test_a_wave_on_a_very_long_line_keeps_its_area():
    result = press(wave(2**18), 0.3 * hard_wall.full_contact_pressure(1.0, 2**18, 1.0))
    assert_certified(result)
    assert abs(result.relative_contact_area - hard_wall.sinusoid_area(0.3)) <= 1.5 / 2**18
