"""Factors of a process zone: solutions, the number of growing displacements, and the one that grows most."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.solvers.cohesive.zone_factors import GeneralFactors, SymmetricFactors


def made_up(size: int, seed: int, lowest: float) -> tuple[np.ndarray, np.ndarray]:
    """A positive definite compliance, and tangents of both signs."""
    rng = np.random.default_rng(seed)
    half = rng.standard_normal((size, size))
    return half @ half.T / size + 0.1 * np.eye(size), rng.uniform(lowest, 1.0, size)


@pytest.mark.parametrize("lowest", [-3.0, -0.3, -0.01, 0.0])
@pytest.mark.parametrize("size", [1, 2, 7, 80])
@pytest.mark.parametrize("seed", range(3))
def test_the_signs_of_the_factors_count_the_growing_displacements(size, seed, lowest):
    compliance, tangent = made_up(size, seed, lowest)
    factors = SymmetricFactors(tangent, compliance)
    stiffness = np.linalg.inv(compliance) + np.diag(tangent)
    values = np.linalg.eigvalsh(stiffness)
    assert factors.negative == np.count_nonzero(values < 0)
    pull = np.random.default_rng(9).standard_normal((1, size))
    expected = np.linalg.solve(np.eye(size) + tangent[:, None] * compliance, tangent * pull[0])
    assert np.allclose(factors.solve(pull), expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
    traction = factors.growing()
    if values[0] >= 0:
        assert traction is None
    else:
        ((pull,),) = traction
        wave = compliance @ pull  # (K + D) w = μ K w
        assert np.allclose(stiffness @ wave, (wave @ stiffness @ wave) / (wave @ pull) * pull, atol=1e-6)
        assert wave @ stiffness @ wave < 0


@pytest.mark.parametrize("size", [2, 7, 40])
@pytest.mark.parametrize("seed", range(3))
def test_both_kinds_of_factors_solve_alike(size, seed):
    compliance, tangent = made_up(size, seed, -0.3)
    one = SymmetricFactors(tangent, compliance)
    other = GeneralFactors(tangent[None, None], compliance[None, :, None])
    pull = np.random.default_rng(9).standard_normal((1, size))
    assert np.allclose(one.solve(pull), other.solve(pull), rtol=1e-8, atol=1e-8)
    assert (one.growing() is None) == (other.growing() is None)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_equal_displacements_that_grow_together_are_seen_however_far_they_are(count):
    size = 60
    turn = np.linalg.qr(np.random.default_rng(2).standard_normal((size, size)))[0]
    compliance = turn @ np.diag(np.where(np.arange(size) < count, 1.0, 0.02 + 0.4 * np.arange(size) / size)) @ turn.T
    for depth in (0.5, 0.95, 1.05, 1.5, 2.0):  # at -1 as many displacements as that begin to grow
        tangent = np.full(size, -depth)
        general = GeneralFactors(tangent[None, None], compliance[None, :, None])
        for factors in (general, SymmetricFactors(tangent, compliance)):
            assert (factors.growing() is not None) == (depth > 1)


def coupled(asymmetry: float, depth: float) -> GeneralFactors:
    """Two components at one point, with a compliance of one and tangents that are not symmetric."""
    compliance = np.eye(2).reshape(2, 1, 2, 1)
    return GeneralFactors(np.array([[-depth, asymmetry], [-asymmetry, -depth]])[..., None], compliance)


def test_tangents_without_symmetry_grow_where_an_eigenvalue_is_negative():
    assert coupled(5.0, 0.9).is_definite
    assert coupled(5.0, 0.9).growing() is None
    assert coupled(0.0, 1.1).growing() is not None
    skew = GeneralFactors(np.array([[0.0, 4.0], [0.0, 0.0]])[..., None], np.eye(2).reshape(2, 1, 2, 1))
    assert not skew.is_definite  # a disturbance grows at first, and yet decays
    assert skew.growing() is None


@pytest.mark.parametrize(("tangent", "grows"), [((-3.0, -7.0), False), ((1.0, -13.0), True)])
def test_what_swings_while_it_grows_is_judged_by_the_overdamped_motion(tangent, grows):
    compliance = np.diag([1.0, 0.1])
    law = np.array([[tangent[0], 4.0], [-5.0, tangent[1]]])
    motion = np.linalg.eigvals(np.linalg.inv(compliance) + law)
    assert motion.imag.any()
    assert (motion.real.min() < 0) == grows
    assert (np.linalg.eigvals(np.eye(2) + law @ compliance).real.min() < 0) != grows  # those of 1 + D C mislead
    growing = GeneralFactors(law[..., None], compliance.reshape(2, 1, 2, 1)).growing()
    assert (growing is not None) == grows
    if growing is not None:
        real, swung = (compliance @ part.ravel() for part in growing)
        wave = real + 1j * swung
        rate = np.vdot(wave, (np.linalg.inv(compliance) + law) @ wave) / np.vdot(wave, wave)
        assert rate.real == pytest.approx(motion.real.min(), rel=1e-6)
