"""A body of finite height adds its compression to the approach; load curves on it are compared with each other."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

import contactsim as cs
from contactsim.analysis.body_heights import compare_heights, curve_of_body, largest_difference
from contactsim.reference.hard_wall import body_compression, uniaxial_modulus

MODULUS, RATIO, LENGTH = 70.0, 0.45, 500.0
STEPS = np.arange(0.0, 10.5, 0.5)


def made_paths(pressures: dict[float, np.ndarray]) -> xr.Dataset:
    """Two equal members of paths with given mean pressures over E*, by the work of separation."""
    contact_modulus = MODULUS / (1 - RATIO**2)
    curves = np.array([[values, values] for values in pressures.values()])
    body = {"body": {"youngs_modulus": MODULUS, "poisson_ratio": RATIO}}
    return xr.Dataset(
        {
            "normalised_pressure": (("work_of_separation", "member", "step"), curves),
            "approach": (("member", "step"), np.tile(STEPS, (2, 1))),
            "approach_first_touch": 0.0,
            "status": (("work_of_separation", "member", "step"), np.zeros(curves.shape, int)),
            "contact_modulus": contact_modulus,
            "length": LENGTH,
        },
        {"work_of_separation": list(pressures), "member": [0, 1]},
        {"settings": json.dumps(body)},
    )


def test_the_uniaxial_modulus_is_that_of_textbooks():
    assert uniaxial_modulus(70.0, 0.0) == 70.0
    assert uniaxial_modulus(70.0, 0.45) == pytest.approx(70.0 * 0.55 / (1.45 * 0.1), rel=1e-15)
    assert uniaxial_modulus(1.0, 0.5) == np.inf
    assert body_compression(0.3, 2000.0, 70.0, 0.5) == 0


def test_a_body_as_high_as_the_period_adds_its_uniform_compression_and_nothing_else():
    wave, law = cs.Sinusoid(LENGTH, 2.0), cs.NormalCohesiveZone(1.0)
    path = cs.approaches([2.0, 5.0], 1.0, from_touch=True)
    plane = MODULUS / (1 - RATIO**2)
    bodies = cs.Layer(plane, RATIO, LENGTH), cs.HalfSpace(plane, RATIO)
    layer, half_space = (cs.simulate(cs.Scene(body, wave, law, path), points=256, tolerance=1e-9) for body in bodies)
    added = body_compression(layer.mean_pressure.values, LENGTH, MODULUS, RATIO)
    assert (added > 0.1).all()
    start = cs.approaches((layer.approach.values - added).tolist())
    again = cs.simulate(cs.Scene(bodies[1], wave, law, start), points=256, tolerance=1e-9)
    # the longest wave's compliance differs by 0.05 %
    assert np.allclose(again.mean_pressure, layer.mean_pressure, rtol=2e-3, atol=0)
    assert not np.allclose(half_space.mean_pressure, layer.mean_pressure, rtol=0.1, atol=0)


def test_a_curve_on_a_body_is_shifted_by_its_compression_and_leaves_out_states_passed_in_a_jump():
    paths = made_paths({1.0: np.where(STEPS < 5, 1e-3 * STEPS, 1e-3 * (STEPS - 4)), 2.0: 0 * STEPS})
    one, flat = (paths.isel(work_of_separation=place) for place in (0, 1))
    assert np.array_equal(curve_of_body(one, 0.0)[0], STEPS)
    height = 3e3 * uniaxial_modulus(MODULUS, RATIO) / float(paths.contact_modulus)  # adds 3 nm for each 1e-3
    assert curve_of_body(one, height)[0] == pytest.approx(
        [*(4 * STEPS[STEPS < 5]), *(STEPS + 3 * (STEPS - 4))[STEPS > 7.5]]
    )
    assert np.array_equal(curve_of_body(flat, height)[0], STEPS)


def test_the_largest_difference_is_that_of_any_two_curves_over_the_largest_pressure():
    at = np.linspace(0.0, 10.0, 41)
    curves = [(at, 0.1 * at), (at, 0.1 * at - 0.2), (at[:33], 0.05 * at[:33])]
    assert largest_difference(curves[:1]) == 0
    assert largest_difference(curves[:2]) == pytest.approx(0.2)
    assert largest_difference(curves) == pytest.approx(0.4 / 0.8)  # as far as all of them go


def test_an_infinitely_stiff_height_of_zero_is_the_half_space_and_higher_bodies_are_exact_from_the_period_on():
    adhesive = made_paths({1.0: 1e-3 * STEPS, 2.0: 1e-3 * STEPS - 2e-3})
    repulsive = made_paths({1.0: 1e-3 * STEPS, 2.0: 1e-3 * STEPS})
    wall = made_paths({0.0: 1.2e-3 * STEPS}).isel(work_of_separation=0)
    table = compare_heights((adhesive, wall, repulsive), [0.0, LENGTH / 2, LENGTH])
    assert table.is_exact.tolist() == [True, False, True]
    half_space = table.iloc[0]
    assert half_space[["works", "works_and_wall", "repulsion"]].tolist() == pytest.approx([0.2, 4 / 12, 0.2])
    assert half_space[["works_error", "repulsion_error"]].tolist() == pytest.approx([0, 0], abs=1e-12)
