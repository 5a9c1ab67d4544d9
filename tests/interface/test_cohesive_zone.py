"""Cohesive zones and their sum: derivatives, limits, the numbers of the thesis, refusals."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.errors import InputError
from contactsim.interface.base import potential
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.interface.exponentials import MAX_OVERLAP
from contactsim.interface.superposition import Superposition, superpose
from contactsim.reference import adhesion
from contactsim.traits import Trait
from support.cases import refusal

LAWS = (
    NormalCohesiveZone(2.0),
    NormalCohesiveZone(0.3, 2.5),
    CohesiveZone(2.0),
    CohesiveZone(2.0, 1.0),
    UncoupledCohesiveZone(2.0, 1.0),
    UncoupledCohesiveZone(0.7, 3.0, normal_length=0.4, tangential_length=2.5),
    CohesiveZone(0.7, 3.0, normal_length=0.4, tangential_length=2.5),
)
TWO = Superposition((NormalCohesiveZone(0.5, 2.0), CohesiveZone(1.5, 0.3)))
RNG = np.random.default_rng(5)


def gaps(law, count=200):
    """Gaps from deep overlap to far apart, over the laws' lengths (reads, n)."""
    normal = RNG.uniform(-1.5 * MAX_OVERLAP, 8.0, count) * law.interaction_range
    if "t" not in law.reads:
        return normal[None]
    return np.stack([normal, RNG.uniform(-3.0, 3.0, count) * law.tangential_length])


@pytest.mark.parametrize("law", [*LAWS, TWO], ids=repr)
def test_the_tangent_is_the_derivative_of_the_traction(law):
    gap, step = gaps(law), 1e-5
    traction, tangent = law.tangent(gap)
    assert np.allclose(traction, law.traction(gap), rtol=1e-14, atol=0)
    for column in range(len(gap)):
        ahead, behind = gap.copy(), gap.copy()
        ahead[column] += step
        behind[column] -= step
        slope = (law.traction(ahead) - law.traction(behind)) / (2 * step)
        size = np.abs(tangent[:, column]) + np.abs(traction) + law.stiffness
        # central differences: truncation step²/6 of the third derivative, rounding eps/step; more at the kink of T''
        assert (np.abs(slope - tangent[:, column]) <= 1e-7 * size).all()


def test_laws_together_are_their_sum_and_one_law_is_itself():
    gap = gaps(TWO)
    normal, mixed = TWO.laws
    total = TWO.traction(gap)
    assert np.array_equal(total[0], normal.traction(gap[:1])[0] + mixed.traction(gap)[0])
    assert np.array_equal(total[1], mixed.traction(gap)[1])
    assert (TWO.reads, TWO.exerts, TWO.traits) == (mixed.reads, mixed.exerts, normal.traits | mixed.traits)
    assert (TWO.strength, TWO.interaction_range) == (normal.strength + mixed.strength, 1.0)
    assert TWO.tangential_length == mixed.tangential_length
    assert superpose((mixed,)) is mixed


@pytest.mark.parametrize("law", [law for law in LAWS if Trait.NON_CONSERVATIVE not in law.traits], ids=repr)
def test_the_traction_is_the_derivative_of_the_energy_where_there_is_one(law):
    gap, step = gaps(law), 1e-4
    slope = (law.energy(gap + step) - law.energy(gap - step)) / (2 * step)
    size = np.abs(law.tangent(gap)[1][0, 0]) + np.abs(law.energy(gap)) + law.stiffness
    assert (np.abs(slope - law.traction(gap)[0]) <= 1e-6 * size).all()
    far = np.full((1, 1), 800.0 * law.normal_length)
    assert law.energy(far)[0] == 0
    assert law.energy(0 * far)[0] == -law.work_of_separation


def test_the_energy_of_a_law_without_a_potential_is_refused():
    for law in (LAWS[-1], LAWS[-2], TWO):
        with pytest.raises(InputError, match="potential"):
            potential(law, gaps(law))


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_traction_and_tangent_are_continuous_where_the_exponential_is_continued(law):
    edge = -MAX_OVERLAP * law.normal_length
    normal = edge * np.array([1 - 1e-12, 1 + 1e-12])
    gap = np.stack([normal, np.full(2, 0.7)][: len(law.reads)])
    traction, tangent = law.tangent(gap)
    assert np.allclose(traction[:, 0], traction[:, 1], rtol=1e-9, atol=0)
    assert np.allclose(tangent[..., 0], tangent[..., 1], rtol=1e-9, atol=0)


@pytest.mark.parametrize("law", LAWS, ids=repr)
@pytest.mark.parametrize("size", [1e4, 1e150, 1e300])
def test_tractions_are_finite_at_any_gap(law, size):
    values = np.array([-size, 0.0, size])
    gap = np.stack(np.meshgrid(*[values] * len(law.reads))).reshape(len(law.reads), -1)
    traction, tangent = law.tangent(gap)
    assert np.isfinite(traction).all() and np.isfinite(tangent).all()
    assert np.array_equal(traction, law.traction(gap))
    assert (np.abs(traction[:, gap[0] == size]) < 1e-150).all()


def test_the_continued_traction_repels_in_proportion_to_the_overlap():
    law = NormalCohesiveZone(2.0)
    far = law.traction(np.array([[-1e4, -2e4, -3e4]]))[0]
    assert far[2] - far[1] == pytest.approx(far[1] - far[0], rel=1e-12)
    assert (far < 0).all()


def test_the_largest_pull_is_the_strength_and_the_steepest_tangent_without_overlap_the_stiffness():
    for law in LAWS:
        normal = np.linspace(0, 10, 100001) * law.normal_length
        gap = np.stack([normal, 0 * normal][: len(law.reads)])
        traction, tangent = law.tangent(gap)
        assert traction[0].max() == pytest.approx(law.strength, rel=1e-8)
        assert np.abs(tangent).max() == pytest.approx(law.stiffness, rel=1e-12)


def test_at_the_approach_where_chapter_6_begins_the_traction_is_a_thousandth_of_the_strength():
    law = CohesiveZone(2.0, 1.0)
    traction = law.traction(np.array([[10.0], [0.0]]))[0, 0]
    assert traction / law.strength == pytest.approx(10 * np.exp(-9), rel=1e-12)


def test_the_tangential_strength_is_that_of_eq_2_18():
    law = CohesiveZone(2.0, 0.7, tangential_length=1.7)
    sideways = np.linspace(0, 5, 200001)
    traction = law.traction(np.stack([0 * sideways + 0.3, sideways]))[1]
    expected = law.tangential_work / law.tangential_length / np.sqrt(0.5 * np.e) * np.exp(-0.3)
    assert traction.max() == pytest.approx(expected, rel=1e-8)


def test_friction_falls_as_eq_2_17_however_far_the_slip():
    law, slip = CohesiveZone(2.0, 0.7, tangential_length=1.7), np.linspace(-8.0, 8.0, 401)
    traction = law.traction(np.stack([0 * slip + 0.3, 1.7 * slip]))[1]
    exact = 2 * law.tangential_work / 1.7 * slip * np.exp(-(slip**2) - 0.3)
    assert np.allclose(traction, exact, rtol=1e-12, atol=0)


def test_the_mixed_law_has_no_potential_and_lacks_it_by_the_amount_derived():
    law = CohesiveZone(2.0, 0.6, normal_length=0.8, tangential_length=1.3)
    gap = gaps(law)
    gap[0] = np.abs(gap[0])
    tangent = law.tangent(gap)[1]
    normal, sideways = gap[0] / 0.8, gap[1] / 1.3
    decay = np.exp(-normal - sideways**2)
    # the docstring's ∂T_n/∂Δt - ∂T_t/∂Δn
    expected = 2 * gap[1] / (0.8 * 1.3**2) * decay * (law.tangential_work - law.work_of_separation * normal)
    assert np.allclose(tangent[0, 1] - tangent[1, 0], expected, rtol=1e-11, atol=1e-14)
    assert np.abs(expected).max() > 0.1


def test_without_tangential_gap_the_mixed_law_is_the_uncoupled_one():
    gap = gaps(LAWS[0])
    for ratio in (0.0, 1.0):
        mixed = CohesiveZone(2.0, ratio).traction(np.concatenate([gap, 0 * gap]))
        assert np.allclose(mixed[0], LAWS[0].traction(gap)[0], rtol=1e-15, atol=0)
        assert not mixed[1:].any()


def test_the_law_without_coupling_differs_from_the_coupled_one_by_the_slip_in_its_normal_traction_alone():
    coupled = CohesiveZone(0.7, 3.0, normal_length=0.4, tangential_length=2.5)
    law, gap = coupled.without_coupling(), gaps(coupled)
    assert law == UncoupledCohesiveZone(0.7, 3.0, 0.4, 2.5)
    (normal, tangential), tangent = law.tangent(gap)
    near = gap[0] >= -MAX_OVERLAP * 0.4  # above the overlap from which both laws are continued
    y = gap[0, near] / 0.4
    assert np.allclose(normal[near], 0.7 / 0.4 * y * np.exp(-y), rtol=1e-13, atol=0)  # Eq. 4.1
    assert not tangent[0, 1].any()  # ∂T_n/∂Δt
    assert np.array_equal(tangential, coupled.traction(gap)[1])  # Eq. 2.17
    assert np.array_equal(tangent[1], coupled.tangent(gap)[1][1])
    assert np.abs(normal - coupled.traction(gap)[0]).max() > 0.1 * law.strength
    assert np.abs(tangent[1, 0]).max() > 0.1 * law.stiffness  # no potential: ∂T_t/∂Δn is not zero


def test_without_a_slip_the_laws_with_and_without_coupling_are_the_same():
    gap = gaps(CohesiveZone(2.0))
    gap[1] = 0.0
    for ratio in (0.1, 1.0, 10.0):
        coupled, uncoupled = CohesiveZone(2.0, ratio).tangent(gap), UncoupledCohesiveZone(2.0, ratio).tangent(gap)
        for one, other in zip(coupled, uncoupled, strict=True):
            assert np.allclose(one, other, rtol=1e-15, atol=0)


def test_what_is_left_of_a_law_without_coupling_friction_or_slip():
    coupled, uncoupled = CohesiveZone(2.0, 0.5, 1.5, 2.0), UncoupledCohesiveZone(2.0, 0.5, 1.5, 2.0)
    normal = NormalCohesiveZone(2.0, 1.5)
    assert coupled.without_coupling() == uncoupled == uncoupled.without_coupling()
    assert coupled.without_friction().without_coupling() == normal == uncoupled.without_friction()
    assert coupled.without_slip() == normal == uncoupled.without_slip()


@pytest.mark.parametrize("value", [0, -1.0, float("nan"), float("inf"), "2", None, True])
@pytest.mark.parametrize("name", ["work_of_separation", "normal_length", "tangential_length"])
def test_works_and_lengths_that_are_not_positive_are_refused(name, value):
    options = {"work_of_separation": 2.0} | {name: value}
    friction = {"work_ratio": 0.5}
    kinds = {CohesiveZone: {}, UncoupledCohesiveZone: friction, NormalCohesiveZone: {}}
    if name == "tangential_length":
        del kinds[NormalCohesiveZone]
    for kind, more in kinds.items():
        error = refusal(name, "scene.yaml", lambda kind=kind, more=more: _read(kind, options | more))
        assert error.value is value
        assert "positive" in error.allowed


@pytest.mark.parametrize("value", [-1e-9, float("nan"), float("inf"), "0.1", None])
def test_a_work_ratio_below_zero_is_refused(value):
    assert refusal("work_ratio", "scene.yaml", lambda: _read(CohesiveZone, {"work_ratio": value})).value is value


def test_the_law_that_drops_the_coupling_alone_needs_friction():
    error = refusal("work_ratio", "scene.yaml", lambda: _read(UncoupledCohesiveZone, {"work_ratio": 0.0}))
    assert "normal_cohesive_zone" in error.allowed


def _read(kind, given):
    try:
        return kind(**({"work_of_separation": 2.0} | given))
    except ValueError as error:
        raise error.located("scene.yaml") from None


def test_the_strength_of_the_bsg_law_falls_under_overclosure_and_changes_its_sign():
    closure = np.array([0.0, -0.5, -1.0, -2.0])
    strength = adhesion.bsg_factor(closure) * adhesion.tangential_strength(1.0, 1.0, closure)
    assert (np.diff(strength) < 0).all()
    assert strength[2] == 0
    assert strength[3] < 0 < strength[1]
