"""Coupled stiffness and compliance of layers: against Navier's equations, to rounding, at every wavenumber."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.elasticity.plane_strain import bonded_stiffness
from contactsim.elasticity.symbol import CoupledSymbol
from contactsim.errors import InputError
from support.cases import navier

RATIOS = (-0.9, 0.0, 0.25, 0.3, 0.49999, 0.5)
X = np.concatenate([np.geomspace(1e-8, 1e6, 60), np.linspace(0.7, 3, 20)])


def unit_layer(ratio: float) -> Layer:
    """Return a layer of unit shear modulus and thickness."""
    return Layer(2 / (1 - ratio), ratio, 1.0)


def matrices(symbol: CoupledSymbol) -> np.ndarray:
    """The 2×2 matrices of a symbol, (m, 2, 2)."""
    (nn, tt), nt = symbol.diagonal, 1j * symbol.coupling
    return np.moveaxis(np.array([[nn, nt], [-nt, tt]]), -1, 0)


def integrated(x: float, ratio: float) -> mpmath.matrix:
    """Return the stiffness of the surface for q = 1, μ = 1: u_x, u_z, σ_xz, σ_zz carried up from the base over x.

    The order is normal, then along x.
    """
    through = mpmath.expm(navier(ratio) * mpmath.mpf(x), method="taylor")
    matrix = through[2:4, 2:4] * through[0:2, 2:4] ** -1
    return mpmath.matrix([[matrix[1, 1], matrix[1, 0]], [matrix[0, 1], matrix[0, 0]]])


def closed(x: float, ratio: float) -> tuple[list, list]:
    """Return the entries nn, tt, nt of the stiffness in μq and of the compliance in 1/(μq)."""
    x, nu = mpmath.mpf(float(x)), mpmath.mpf(ratio)
    k = 3 - 4 * nu
    r, omega, a = 1 / k, 2 * (1 - 2 * nu) / k, 4 * (1 - nu) / k
    s, c = mpmath.sinh(x), mpmath.cosh(x)
    f = s**2 - (r * x) ** 2
    stiffness = [a * (s * c + r * x), a * (s * c - r * x), 2 * (r * x) ** 2 - omega * s**2]
    below = k * mpmath.cosh(2 * x) + (1 + k**2) / 2 + 2 * x**2
    compliance = [(1 - nu) * (2 * k * (s * c - x) + 4 * (1 - 2 * nu) * x), (1 - nu) * (2 * k * s * c + 2 * x)]
    compliance += [(1 - 2 * nu) * k * s**2 - x**2]
    return [entry / f for entry in stiffness], [entry / below for entry in compliance]


def worst(entries: np.ndarray, exact: list) -> float:
    """Return the largest error of nn, tt and nt over √(k_ii k_jj)."""
    nn, tt = abs(exact[0]), abs(exact[1])
    scales = [nn, tt, mpmath.sqrt(nn * tt)]
    return max(
        float(abs(mpmath.mpf(float(entry)) - other) / scale)
        for entry, other, scale in zip(entries, exact, scales, strict=True)
    )


@pytest.mark.parametrize("ratio", [-0.5, 0.3, 0.5])
@pytest.mark.parametrize("x", [1e-3, 0.6, 2.0, 11.0])
def test_the_closed_forms_solve_naviers_equations(ratio, x):
    with mpmath.workdps(50):
        exact = integrated(x, ratio)
        i = mpmath.mpc(0, 1)
        for (nn, tt, nt), matrix in zip(closed(x, ratio), (exact, exact**-1), strict=True):
            entries = mpmath.matrix([[nn, i * nt], [-i * nt, tt]])
            assert mpmath.mnorm(entries - matrix) < 1e-30 * mpmath.mnorm(matrix)


@pytest.mark.parametrize("ratio", RATIOS)
def test_compliance_and_stiffness_are_right_to_rounding_at_every_wavenumber(ratio):
    stiffness, compliance = bonded_stiffness(X, ratio), unit_layer(ratio).coupled_compliance(X)
    inverse = compliance.inverse()
    with mpmath.workdps(50):
        for place, x in enumerate(X):
            stiff, soft = closed(min(x, 1e3), ratio)  # beyond which e^{-2x} is zero to 50 digits and more
            assert worst(stiffness[:, place], stiff) < 1e-15
            for symbol, exact, unit, error in (
                (compliance, soft, 1 / mpmath.mpf(x), 1e-15),
                (inverse, stiff, mpmath.mpf(x), 3e-15),
            ):
                entries = [*symbol.diagonal[:, place], symbol.coupling[place]]
                assert worst(entries, [entry * unit for entry in exact]) < error


@pytest.mark.parametrize("ratio", RATIOS)
def test_deep_layers_are_half_spaces(ratio):
    q = np.geomspace(1e-3, 1e3, 30)
    half_space = HalfSpace(2.0, ratio)
    for name in ("coupled_compliance", "coupled_stiffness"):
        symbol, exact = getattr(Layer(2.0, ratio, 1e6), name)(q), getattr(half_space, name)(q)
        assert np.allclose(matrices(symbol), matrices(exact), rtol=3e-15, atol=0)
    assert np.allclose(matrices(half_space.coupled_compliance(q).inverse()), matrices(half_space.coupled_stiffness(q)))


def test_an_incompressible_half_space_has_no_coupling_and_its_entry_is_half_the_contact_modulus():
    stiffness = HalfSpace(3.0, 0.5).coupled_stiffness(np.array([0.0, 2.0]))
    assert not stiffness.coupling.any()
    assert np.allclose(stiffness.diagonal, [[0.0, 3.0], [0.0, 3.0]])


@pytest.mark.parametrize("ratio", RATIOS)
def test_without_shear_the_coupled_compliance_is_the_normal_one(ratio):
    q = np.append(0.0, X / 0.7)
    for body in (Layer(1.3, ratio, 0.7), HalfSpace(1.3, ratio), HalfSpace(1.3)):
        known = body if body.poisson_ratio is not None else HalfSpace(1.3, ratio)
        assert np.array_equal(known.coupled_compliance(q).without_shear().diagonal[0], body.compliance(q))
        # and by another way: what holding u_t at -S_tn/S_tt takes away from the stiffness
        (nn, tt), nt = (lambda k: (k.diagonal, k.coupling))(known.coupled_stiffness(q[1:]))
        assert np.allclose(1 / (nn - nt**2 / tt), body.compliance(q[1:]), rtol=1e-13, atol=0)


@pytest.mark.parametrize("ratio", [0.1, 0.3])
def test_a_held_surface_is_stiffer_than_one_that_slips_by_what_is_known(ratio):
    body, q = HalfSpace(1.0, ratio), np.array([1.0])
    held = body.coupled_stiffness(q).diagonal[0] * body.compliance(q)
    assert held[0] - 1 == pytest.approx({0.1: 0.246, 0.3: 0.089}[ratio], abs=1e-3)


@pytest.mark.parametrize("ratio", RATIOS)
def test_a_uniform_traction_meets_springs(ratio):
    layer = Layer(1.0, ratio, 3.0)
    uniaxial = (1 - ratio) ** 2 / (1 - 2 * ratio) if ratio < 0.5 else np.inf
    q = np.array([0.0, 1e-100 if ratio == 0.5 else 1e-12])
    stiffness, compliance = layer.coupled_stiffness(q), layer.coupled_compliance(q)
    expected = [uniaxial / 3 if ratio < 0.5 else 0.0, (1 - ratio) / 2 / 3]
    assert np.allclose(stiffness.diagonal, np.transpose([expected, expected]), rtol=1e-10)
    assert np.allclose(compliance.diagonal[:, 0], [3 / uniaxial, 6 / (1 - ratio)], rtol=1e-14)
    assert stiffness.coupling[0] == compliance.coupling[0] == 0
    for symbol in (stiffness, compliance, compliance.inverse()):
        assert symbol.held[:, 0].tolist() == [ratio == 0.5, False]


def test_neither_a_stretched_unit_of_length_nor_of_modulus_matters():
    q = np.geomspace(1e-6, 1e3, 40)
    reference = matrices(Layer(1.0, 0.4, 2.0).coupled_stiffness(q))
    for length in (1e-12, 1e12):
        scaled = matrices(Layer(7.0, 0.4, 2.0 * length).coupled_stiffness(q / length)) * length / 7
        assert np.allclose(scaled, reference, rtol=1e-13, atol=0)


def test_a_half_space_without_a_ratio_is_refused_where_it_matters():
    with pytest.raises(InputError, match=r"poisson_ratio: got None; .* along x") as caught:
        HalfSpace(1.0).coupled_compliance(np.ones(1))
    assert caught.value.key == "poisson_ratio"
    with pytest.raises(InputError, match=r"at most 0\.5"):
        HalfSpace(1.0, 0.6)
