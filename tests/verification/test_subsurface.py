"""Fields inside bodies: Navier's equations, surface and base, exact stresses under a cylinder; their map."""

from __future__ import annotations

from dataclasses import replace

import matplotlib.pyplot as plt
import mpmath
import numpy as np
import pytest

from contactsim.elasticity.base import relative_compliance
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.elasticity.subsurface import SubsurfaceFields, subsurface_fields
from contactsim.errors import InputError
from contactsim.figures.parts import stress
from contactsim.grid import Grid
from contactsim.reference import hard_wall
from support.cases import navier

LINE = Grid((96,), (40.0,))
BODIES = [
    HalfSpace(2.0, 0.3),
    HalfSpace(2.0, 0.5),
    Layer(2.0, 0.0, 7.0),
    Layer(2.0, 0.3, 0.2),
    Layer(2.0, 0.5, 0.5),
    Layer(2.0, 0.5, 20.0),
]


def smooth(rows: int, seed: int = 0, modes: int = 12, grid: Grid = LINE) -> np.ndarray:
    """Random tractions with a mean, without short waves."""
    half = np.zeros((rows, *grid.half_shape), complex)
    rng = np.random.default_rng(seed)
    half[:, : modes + 1] = rng.normal(size=(rows, modes + 1)) + 1j * rng.normal(size=(rows, modes + 1))
    half[:, 0] = half[:, 0].real
    return np.stack([grid.backward(row) for row in half])


def along_x(values: np.ndarray, grid: Grid = LINE) -> np.ndarray:
    """Exact derivative of fields (…, n) along x."""
    return np.fft.irfft(1j * grid.wavenumber * np.fft.rfft(values), grid.shape[0])


def integrated(x: float, ratio: float, heights: list, traction: list) -> np.ndarray:
    """u_n, u_t, σ_xx, σ_zz, σ_xz at heights above the base, q = 1, μ = 1, from the tractions (T_n, T_t)."""
    nu, one = mpmath.mpf(ratio), mpmath.mpc(0, 1)
    up = [mpmath.expm(navier(ratio) * height, method="taylor")[:, 2:4] for height in [mpmath.mpf(x), *heights]]
    base = up[0][2:4, 0:2] ** -1 * mpmath.matrix([traction[1], traction[0]])
    states = [through * base for through in up[1:]]
    values = [[u_z, u_x, (nu * zz + 2 * one * u_x) / (1 - nu), zz, xz] for u_x, u_z, xz, zz in states]
    return np.array([[complex(value) for value in row] for row in values])


@pytest.mark.parametrize("ratio", [-0.5, 0.3, 0.4999999, 0.5])
@pytest.mark.parametrize("x", [1e-5, 0.1, 0.99, 1.01, 4.0])
def test_a_wave_is_right_to_rounding_at_every_depth(ratio, x):
    grid = Grid((8,), (2 * np.pi,))  # q = 1
    body = Layer(2 / (1 - ratio), ratio, x)  # unit shear modulus
    shares = np.array([0.0, 1e-3, 0.3, 0.9, 0.999, 1.0])
    for traction in ([1, 0], [0, 1]):
        surface = np.array(traction)[:, None] * np.cos(grid.positions())
        found = subsurface_fields(body, grid, surface, shares * x)
        waves = np.concatenate([found.displacement, found.stress], axis=1)
        coefficients = np.fft.rfft(waves)[..., 1] / 4
        with mpmath.workdps(40):
            heights = [mpmath.mpf(x) * (1 - mpmath.mpf(share)) for share in shares]
            exact = integrated(x, ratio, heights, traction)
        # transforms leave 1e-16 of each field's largest value; where σ_zz is all pressure, ν near 1/2, of that
        scale = np.abs(exact).max(0)
        scale[2:] = scale[2:].max()
        assert (np.abs(coefficients - exact) / scale).max() < 1e-14


@pytest.mark.parametrize("body", BODIES, ids=str)
@pytest.mark.parametrize("rows", [1, 2])
def test_the_surface_has_the_tractions_and_displacements_given_and_the_base_none(body, rows):
    tractions = np.vstack([smooth(rows), np.zeros((2 - rows, 96))])
    found = subsurface_fields(body, LINE, tractions[:rows], [0.0, min(body.base_depth, 1e3)])
    scale = np.abs(tractions).max()
    assert np.allclose(found.stress[0, 1:], tractions, rtol=0, atol=1e-13 * scale)
    compliance = relative_compliance(body, None, LINE, ("n", "t"))
    surface = compliance.apply(np.stack([LINE.forward(row) for row in tractions]))
    exact = np.stack([LINE.backward(row) for row in surface])
    size = np.abs(exact).max()
    assert np.allclose(found.displacement[0], exact, rtol=0, atol=1e-13 * size)
    bottom = found.displacement[-1]
    if isinstance(body, HalfSpace):  # whose mean sinks with depth
        bottom = bottom - bottom.mean(-1, keepdims=True)
    assert np.abs(bottom).max() < 1e-13 * size


@pytest.mark.parametrize("body", BODIES, ids=str)
def test_stresses_are_in_equilibrium_and_strains_are_those_of_the_displacement(body):
    """Derivatives along x are exact, those with depth central differences, which converge at second order."""
    depth = 0.4 * min(body.base_depth, 5.0)
    errors = []
    for step in (0.02 * depth, 0.01 * depth):
        found = subsurface_fields(body, LINE, smooth(2), [depth - step, depth, depth + step])
        upwards = [-(values[2] - values[0]) / (2 * step) for values in (found.displacement, found.stress)]
        (u_n, u_t), (xx, zz, xz) = found.displacement[1], found.stress[1]
        (dn, dt), (_, dzz, dxz) = upwards
        shear_modulus, ratio = body.contact_modulus * (1 - body.poisson_ratio) / 2, body.poisson_ratio
        residuals = [along_x(xx) + dxz, along_x(xz) + dzz, xz - shear_modulus * (along_x(u_n) + dt)]
        strains = along_x(u_t), dn
        # 2μ ε = σ - ν tr σ, which holds at ν = 1/2 too
        residuals += [
            2 * shear_modulus * strain - (one - ratio * (xx + zz))
            for strain, one in zip(strains, (xx, zz), strict=True)
        ]
        scales = [np.abs(along_x(xx)).max(), np.abs(along_x(xz)).max()] + 3 * [np.abs(found.stress).max()]
        errors.append([np.abs(residual).max() / scale for residual, scale in zip(residuals, scales, strict=True)])
    coarse, fine = np.array(errors)
    assert fine[:2].max() < 1e-2
    assert (fine < 2e-3).all()
    differenced = coarse > 1e-8
    assert differenced.any()
    assert np.allclose(np.log2(coarse[differenced] / fine[differenced]), 2, atol=0.1)


@pytest.mark.parametrize("ratio", [0.3, 0.5])
def test_a_deep_layer_is_a_half_space_and_the_thickest_does_not_overflow(ratio):
    depths, tractions = [0.0, 0.3, 5.0, 80.0], smooth(2, modes=40)
    exact = subsurface_fields(HalfSpace(2.0, ratio), LINE, tractions, depths)
    for thickness in (600.0, 1e5, 1e100):
        found = subsurface_fields(Layer(2.0, ratio, thickness), LINE, tractions, [*depths, thickness])
        assert np.allclose(found.stress[:-1], exact.stress, rtol=0, atol=1e-13 * np.abs(exact.stress).max())
        sunk = found.displacement[0].mean(-1, keepdims=True)
        if thickness < 1e100:  # above, nothing is left beside it
            assert np.allclose((found.displacement - sunk)[:-1], exact.displacement, rtol=0, atol=1e-9)
        assert np.isfinite(found.stress).all()


def test_the_mean_is_carried_uniformly_and_sinks_linearly():
    body = Layer(2.0, 0.3, 8.0)
    found = subsurface_fields(body, LINE, np.tile([[-0.1], [0.02]], 96), [0.0, 2.0, 8.0])
    assert np.allclose(found.stress, np.reshape([-0.1 * 3 / 7, -0.1, 0.02], (1, 3, 1)))
    normal, along = found.displacement[..., 0].T
    assert np.allclose(normal, -0.1 * 8 / (2 * 0.7**2 / 0.4) * np.array([1, 0.75, 0]))
    assert np.allclose(along, 0.02 * 8 / 0.7 * np.array([1, 0.75, 0]))


def hertz(ratio: float, points: int, period: float, depths: np.ndarray) -> SubsurfaceFields:
    """Under a cylinder's pressure with half-width and peak 1."""
    grid = Grid((points,), (period,))
    pressure = hard_wall.cylinder_pressure(grid.positions() - period / 2, 1.0, 0.5, 1.0)
    return subsurface_fields(HalfSpace(1.0, ratio), grid, -pressure[None], depths)


def neighbours(depth: np.ndarray, period: float) -> tuple[np.ndarray, np.ndarray]:
    """σ_xx and σ_zz on the axis due to the line loads π/2 of all other periods (Flamant)."""
    x = np.arange(1, 4000)[:, None] * period
    common = -2 * depth / (x**2 + depth**2) ** 2
    return (common * x**2).sum(0), (common * depth**2).sum(0)


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.5])
def test_the_stress_below_a_cylinder_is_hertzs(ratio):
    period, depths, errors = 64.0, np.linspace(0, 2, 11), []
    along, normal = hard_wall.cylinder_stress_on_axis(depths, 1.0, 1.0)
    beside = neighbours(depths, period)
    # no strain along x on average, while distant line loads would leave the mean pressure as stress along x
    confined = (1 - ratio / (1 - ratio)) * np.pi / 2 / period
    for points in (2048, 4096, 8192):
        found = hertz(ratio, points, period, depths).stress[..., points // 2]
        expected = along + beside[0] + confined, normal + beside[1]
        errors.append(max(np.abs(found[:, 0] - expected[0]).max(), np.abs(found[:, 1] - expected[1]).max()))
        assert np.abs(found[:, 2]).max() < 1e-14
    assert errors[-1] < 1e-4
    assert np.log2(errors[0] / errors[-1]) / 2 == pytest.approx(1.5, abs=0.1)  # the edge's root


def test_the_largest_shear_below_a_cylinder_is_where_it_should_be():
    depths = np.linspace(0.7, 0.9, 41)
    along, normal, shear = np.moveaxis(hertz(0.5, 16384, 256.0, depths).stress, 1, 0)
    largest_shear = np.hypot((along - normal) / 2, shear)
    shear = largest_shear[:, 16384 // 2]
    assert shear.max() == pytest.approx(0.300, abs=5e-4)
    assert depths[shear.argmax()] == pytest.approx(0.786, abs=0.006)
    assert largest_shear.max() == shear.max()
    along, normal = hard_wall.cylinder_stress_on_axis(np.array([0.786]), 1.0, 1.0)
    assert (along - normal)[0] / 2 == pytest.approx(0.300, abs=5e-4)


@pytest.mark.parametrize(
    ("traction", "depths", "key"),
    [
        (np.zeros((1, 96)), [8.0], "depths"),
        (np.zeros((1, 96)), [-1.0], "depths"),
        (np.zeros((1, 96)), [np.nan], "depths"),
        (np.zeros((3, 96)), [0.0], "traction"),
        (np.zeros(96), [0.0], "traction"),
        (np.zeros((1, 95)), [0.0], "traction"),
    ],
)
def test_what_is_not_inside_or_no_traction_is_refused(traction, depths, key):
    with pytest.raises(InputError) as caught:
        subsurface_fields(Layer(1.0, 0.3, 7.0), LINE, traction, depths)
    assert caught.value.key == key


def test_a_body_without_a_ratio_is_refused():
    with pytest.raises(InputError, match="poisson_ratio"):
        subsurface_fields(HalfSpace(1.0), LINE, np.zeros((1, 96)), [1.0])


def test_a_part_of_the_fields_is_what_lies_between():
    found = hertz(0.3, 256, 8.0, np.linspace(0, 3, 12))
    part = found.between(2.0, 6.0)
    assert part.position.min() == 2.0 and part.position.max() == 6.0
    assert np.array_equal(part.stress, found.stress[..., 64:193])
    assert np.array_equal(part.displacement, found.displacement[..., 64:193])


def test_a_map_shows_each_stress_on_a_scale_symmetric_about_zero():
    found = hertz(0.3, 256, 8.0, np.linspace(0, 3, 12))
    figure, axes = plt.subplots(1, 3)
    shown = stress.plot_stress(found, axes, scale=2.0, unit="$2 p_0$")
    for panel, name, component in zip(axes, stress.STRESSES, range(3), strict=True):
        mesh = panel.collections[0]
        least, most = mesh.get_clim()
        assert least == -most == pytest.approx(-np.abs(found.stress[:, component]).max() / 2)
        assert np.allclose(shown[name], found.stress[:, component].ravel() / 2)
        assert "(nm)" in panel.get_xlabel() and "(nm)" in panel.get_ylabel()
        assert panel.get_ylim() == (3.0, 0.0)
    assert [bar.get_xlabel() for bar in figure.axes[3:]] == [f"{name} ($2 p_0$)" for name in stress.STRESSES.values()]
    nothing = replace(found, stress=np.zeros_like(found.stress))
    stress.plot_stress(nothing, plt.subplots(1, 3)[1])
    plt.close("all")
