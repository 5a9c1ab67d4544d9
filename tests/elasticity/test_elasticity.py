"""The layer's compliance against Navier's equations, its limits, and what it refuses."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.elasticity.registry import ELASTICITIES
from contactsim.errors import InputError
from contactsim.evaluation.robustness.cases import layer_response
from contactsim.grid import Grid
from contactsim.reference.hard_wall import complete_contact
from contactsim.traits import Trait

RATIOS = (-0.5, 0.0, 0.1, 0.3, 0.45, 0.49999, 0.5)


def at(layer: Layer, q: float) -> float:
    return float(layer.compliance(np.array([q]))[0])


def integrated(x: float, ratio: float) -> mpmath.mpf:
    """E* S/h at x = |q|h, h = 1, by carrying u_x, u_z, σ_xz, σ_zz from a held base to a surface without shear.

    Fields (u_x, σ_xz) ~ sin qx and (u_z, σ_zz) ~ cos qx obey y' = A y in plane strain; with Young's modulus 1.
    """
    q, nu = mpmath.mpf(x), mpmath.mpf(ratio)
    shear = 1 / (2 * (1 + nu))
    side = nu / (1 - nu)
    uniaxial = (1 - 2 * nu) / (2 * shear * (1 - nu))
    navier = mpmath.matrix(
        [
            [0, q, 1 / shear, 0],
            [-side * q, 0, 0, uniaxial],
            [2 * shear * q**2 / (1 - nu), 0, 0, side * q],
            [0, 0, -q, 0],
        ]
    )
    through = mpmath.expm(navier, method="taylor")
    base = mpmath.lu_solve(through[2:4, 2:4], mpmath.matrix([0, 1]))
    return (through[1, 2] * base[0] + through[1, 3] * base[1]) / (1 - nu**2)


def closed(x: float, ratio: float) -> mpmath.mpf:
    """The same by the closed form, to the present number of digits."""
    x, nu = mpmath.mpf(x), mpmath.mpf(ratio)
    k = 3 - 4 * nu
    above = k * (mpmath.sinh(2 * x) - 2 * x) + 2 * x * (2 - 4 * nu)
    return 2 / x * above / (k * mpmath.cosh(2 * x) + (1 + k**2) / 2 + 2 * x**2)


@pytest.mark.parametrize("ratio", [-0.9, *RATIOS])
def test_the_closed_form_solves_naviers_equations(ratio):
    with mpmath.workdps(60):
        for x in (1e-6, 1e-2, 0.5, 1.0, 3.0, 20.0):
            assert abs(integrated(x, ratio) / closed(x, ratio) - 1) < 1e-40


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_compliance_is_right_to_rounding_at_every_wavenumber(ratio):
    layer = Layer(1.0, ratio, 0.7)
    with mpmath.workdps(60):
        for q in np.concatenate([np.geomspace(1e-8, 1e6, 120), np.linspace(1.2, 4, 60)]) / 0.7:
            x = mpmath.mpf(q) * mpmath.mpf(0.7)
            exact = closed(x, ratio) * mpmath.mpf(0.7) if x < 3000 else 2 / mpmath.mpf(q)
            assert abs(float(at(layer, q) / exact - 1)) < 1e-15


@pytest.mark.parametrize("ratio", RATIOS)
def test_a_uniform_pressure_meets_the_uniaxial_modulus(ratio):
    young = 1 - ratio**2  # E* = 1
    stiffness = np.inf if ratio == 0.5 else young * (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio))
    assert at(Layer(1.0, ratio, 3.0), 0.0) == pytest.approx(3.0 / stiffness, rel=1e-10, abs=0)
    if ratio < 0.5:
        assert at(Layer(1.0, ratio, 3.0), 1e-12) == pytest.approx(3.0 / stiffness, rel=1e-10)


@pytest.mark.parametrize("ratio", RATIOS)
def test_short_waves_do_not_see_the_base(ratio):
    q = np.geomspace(1e-3, 1e300, 30)
    assert np.allclose(Layer(2.0, ratio, 1e5).compliance(q), HalfSpace(2.0).compliance(q), rtol=1e-15, atol=0)


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_answers_for_hazards_come_from_another_formula_and_are_the_same(ratio):
    x = np.append(np.geomspace(1e-4, 1e6, 300), 0.0)
    assert np.allclose(layer_response(x, ratio), Layer(1.0, ratio, 1.0).compliance(x), rtol=3e-13, atol=0)


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"poisson_ratio": 0.5000001}, "poisson_ratio"),
        ({"poisson_ratio": -1.0}, "poisson_ratio"),
        ({"poisson_ratio": None}, "poisson_ratio"),
        ({"poisson_ratio": float("nan")}, "poisson_ratio"),
        ({"thickness": 0.0}, "thickness"),
        ({"thickness": float("inf")}, "thickness"),
        ({"thickness": True}, "thickness"),
        ({"contact_modulus": -1.0}, "contact_modulus"),
    ],
)
def test_what_is_no_layer_is_refused(change, key):
    with pytest.raises(InputError) as caught:
        ELASTICITIES["layer"](**{"contact_modulus": 1.0, "poisson_ratio": 0.3, "thickness": 1.0} | change)
    assert caught.value.key == key


def test_each_body_declares_what_it_demands_of_a_solver():
    assert HalfSpace(1.0).traits == {Trait.HALF_SPACE}
    assert Layer(1.0, 0.3, 1.0).traits == {Trait.LAYER}


@pytest.mark.parametrize("points", [64, 63])
def test_the_pressure_of_complete_contact_displaces_a_half_space_by_the_heights(points):
    heights, grid = np.random.default_rng(8).normal(size=points), Grid((points,), (50.0,))
    pressure = complete_contact(heights, 50.0, 3.0)
    displacement = grid.backward(grid.forward(pressure) * HalfSpace(3.0).compliance(grid.wavenumber))
    np.testing.assert_allclose(displacement, heights - heights.mean(), atol=1e-13)
