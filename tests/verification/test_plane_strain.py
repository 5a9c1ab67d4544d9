"""Coupled stiffness and compliance of layers: against Navier's equations, to rounding, at every wavenumber."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from contactsim.elasticity.plane_strain import bonded_stiffness, both_faces
from contactsim.elasticity.solids import FreeLayer, HalfSpace, Layer
from contactsim.elasticity.symbol import Coupled
from contactsim.errors import InputError
from support.cases import navier

RATIOS = (-0.9, 0.0, 0.25, 0.3, 0.49999, 0.5)
X = np.concatenate([np.geomspace(1e-8, 1e6, 60), np.linspace(0.7, 3, 20)])


def unit_layer(ratio: float, thickness: float = 1.0, kind: type = Layer) -> Layer:
    """A layer of unit shear modulus."""
    return kind(2 / (1 - ratio), ratio, thickness)


def matrices(symbol: Coupled) -> np.ndarray:
    """The 2×2 matrices of a symbol, (m, 2, 2)."""
    (nn, tt), nt = symbol.diagonal, 1j * symbol.coupling
    return np.moveaxis(np.array([[nn, nt], [-nt, tt]]), -1, 0)


def integrated(x: float, ratio: float) -> mpmath.matrix:
    """Stiffness of both faces for q = 1, μ = 1: u_x, u_z, σ_xz, σ_zz carried through a layer of thickness x.

    The order is normal and along x of the upper, then of the lower face; tractions are those from outside.
    """
    through = mpmath.expm(navier(ratio) * mpmath.mpf(x), method="taylor")
    uu, us, su, ss = (through[i : i + 2, j : j + 2] for i in (0, 2) for j in (0, 2))
    inverse = us**-1
    blocks = [[ss * inverse, su - ss * inverse * uu], [-inverse, inverse * uu]]
    swap = (1, 0)
    entries = [[blocks[f][g][swap[i], swap[j]] for g in (0, 1) for j in (0, 1)] for f in (0, 1) for i in (0, 1)]
    return mpmath.matrix(entries)


def closed(x: float, ratio: float) -> tuple[list, list, list]:
    """Entries of both faces' stiffness in μq (k_nn, k_tt, k_nt, across: nn, tt, nt), free and bonded compliance."""
    x, nu = mpmath.mpf(float(x)), mpmath.mpf(ratio)
    k = 3 - 4 * nu
    r, omega, a = 1 / k, 2 * (1 - 2 * nu) / k, 4 * (1 - nu) / k
    s, c = mpmath.sinh(x), mpmath.cosh(x)
    f, g = s**2 - (r * x) ** 2, s**2 - x**2
    whole = [a * (s * c + r * x), a * (s * c - r * x), 2 * (r * x) ** 2 - omega * s**2]
    whole += [-a * (r * x * c + s), a * (r * x * c - s), a * r * x * s]
    free = [(1 - nu) * (s * c + x), (1 - nu) * (s * c - x), (mpmath.mpf(1) / 2 - nu) * s**2 + x**2 / 2]
    below = k * mpmath.cosh(2 * x) + (1 + k**2) / 2 + 2 * x**2
    bonded = [(1 - nu) * (2 * k * (s * c - x) + 4 * (1 - 2 * nu) * x), (1 - nu) * (2 * k * s * c + 2 * x)]
    bonded += [(1 - 2 * nu) * k * s**2 - x**2]
    return [entry / f for entry in whole], [entry / g for entry in free], [entry / below for entry in bonded]


def worst(found: np.ndarray, exact: list) -> float:
    """Largest error of nn, tt and nt over √(k_ii k_jj)."""
    nn, tt = abs(exact[0]), abs(exact[1])
    scales = [nn, tt, mpmath.sqrt(nn * tt)]
    return max(
        float(abs(mpmath.mpf(float(one)) - other) / scale)
        for one, other, scale in zip(found, exact, scales, strict=True)
    )


@pytest.mark.parametrize("ratio", [-0.5, 0.3, 0.5])
@pytest.mark.parametrize("x", [1e-3, 0.6, 2.0, 11.0])
def test_the_closed_forms_solve_naviers_equations(ratio, x):
    with mpmath.workdps(50):
        exact = integrated(x, ratio)
        whole, free, bonded = closed(x, ratio)
        i = mpmath.mpc(0, 1)
        nn, tt, nt, far_nn, far_tt, far_nt = whole
        given = mpmath.matrix(
            [
                [nn, i * nt, far_nn, i * far_nt],
                [-i * nt, tt, i * far_nt, far_tt],
                [far_nn, -i * far_nt, nn, -i * nt],
                [-i * far_nt, far_tt, i * nt, tt],
            ]
        )
        assert mpmath.mnorm(given - exact) < 1e-30 * mpmath.mnorm(exact)
        for compliance, matrix in ((bonded, exact[0:2, 0:2] ** -1), (free, (exact**-1)[0:2, 0:2])):
            entries = mpmath.matrix([[compliance[0], i * compliance[2]], [-i * compliance[2], compliance[1]]])
            assert mpmath.mnorm(entries - matrix) < 1e-30 * mpmath.mnorm(matrix)


@pytest.mark.parametrize("ratio", RATIOS)
def test_all_is_right_to_rounding_at_every_wavenumber(ratio):
    stiffness, whole = bonded_stiffness(X, ratio), both_faces(X, ratio)
    far = [whole[0, 2].real, whole[1, 3].real, whole[0, 3].imag]
    bonded, free = (unit_layer(ratio, 1.0, kind).coupled_compliance(X) for kind in (Layer, FreeLayer))
    relative = unit_layer(ratio).coupled_compliance(X).inverse()
    with mpmath.workdps(50):
        for place, x in enumerate(X):
            entries, loose, held = closed(min(x, 1e3), ratio)  # beyond which e^{-2x} is zero to 50 digits and more
            scale = [*entries[:2], mpmath.sqrt(entries[0] * entries[1])]
            assert worst(stiffness[:, place], entries[:3]) < 1e-15
            across = [float(one[place]) - other for one, other in zip(far, entries[3:], strict=True)]
            assert max(abs(error / size) for error, size in zip(across, scale, strict=True)) < 1e-15
            for symbol, exact, within in ((bonded, held, 1e-15), (free, loose, 1e-15), (relative, entries[:3], 3e-15)):
                unit = mpmath.mpf(x) if symbol is relative else 1 / mpmath.mpf(x)
                found = [*symbol.diagonal[:, place], symbol.coupling[place]]
                assert worst(found, [entry * unit for entry in exact]) < within


@pytest.mark.parametrize("ratio", RATIOS)
def test_deep_layers_are_half_spaces(ratio):
    q = np.geomspace(1e-3, 1e3, 30)
    half_space = HalfSpace(2.0, ratio)
    for kind in (Layer, FreeLayer):
        layer = kind(2.0, ratio, 1e6)
        for name in ("coupled_compliance", "coupled_stiffness"):
            found, exact = getattr(layer, name)(q), getattr(half_space, name)(q)
            assert np.allclose(matrices(found), matrices(exact), rtol=3e-15, atol=0)
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
    loose = FreeLayer(1.0, ratio, 3.0).coupled_compliance(q[:1])
    assert np.allclose(loose.diagonal[:, 0], compliance.diagonal[:, 0])


@pytest.mark.parametrize("ratio", RATIOS)
def test_both_faces_condense_to_a_held_and_to_a_free_face(ratio):
    x = np.geomspace(0.02, 20, 25)
    whole = np.moveaxis(unit_layer(ratio).both_faces(x), -1, 0)
    assert np.array_equal(whole, np.conj(np.swapaxes(whole, 1, 2)))
    scale = np.sqrt(np.einsum("mii->mi", whole).real)
    assert np.linalg.eigvalsh(whole / (scale[:, :, None] * scale[:, None, :])).min() > -1e-14
    top, across, back, far = whole[:, :2, :2], whole[:, :2, 2:], whole[:, 2:, :2], whole[:, 2:, 2:]
    assert np.array_equal(top, matrices(unit_layer(ratio).coupled_stiffness(x)))
    condensed = top - across @ np.linalg.solve(far, back)
    loose = matrices(unit_layer(ratio, 1.0, FreeLayer).coupled_stiffness(x))
    # the Schur complement, not the closed form, loses digits for thin layers, which resist bending with x³ alone
    sizes = np.sqrt(np.einsum("mii->mi", top).real)
    assert np.abs((condensed - loose) / (sizes[:, :, None] * sizes[:, None, :])).max() < 1e-12


@pytest.mark.parametrize("ratio", [-0.5, 0.3, 0.5])
def test_a_free_layer_is_a_plate_for_long_waves_and_no_rigid_motion_costs_anything(ratio):
    x = np.array([1e-6, 1e-4, 1e-2])
    layer = unit_layer(ratio, 1.0, FreeLayer)
    bending = 1 / (6 * (1 - ratio)) * x**4
    assert np.allclose(layer.compliance(x) * bending, 1, rtol=x.max() ** 2)
    stiffness = matrices(layer.coupled_stiffness(x))
    assert (np.linalg.eigvalsh(stiffness) > -1e-15 * np.linalg.norm(stiffness, axis=(1, 2))[:, None]).all()
    assert (np.abs(stiffness) < 10 * x[:, None, None] ** 2).all()
    springs = unit_layer(0.3).both_faces(np.zeros(1))[..., 0]
    for rigid in ([1, 0, 1, 0], [0, 1, 0, 1]):
        assert not (springs @ rigid).any()
    assert np.isinf(unit_layer(0.5).both_faces(np.zeros(1))[0, 0, 0])


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
