"""Distributions of pressure and gap: their integrals, those of Hertz, and what a run keeps of them."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim as cs
from contactsim.observables.distributions import GAP_BINS, PRESSURE_BINS, Bins, distributions
from support.cases import refused


def test_densities_integrate_to_the_areas_in_and_out_of_contact():
    rng = np.random.default_rng(0)
    pressure = np.maximum(rng.normal(size=(40, 50)), 0.0)
    gap = np.where(pressure > 0, 0.0, rng.uniform(0.1, 7.0, pressure.shape))
    densities = distributions(pressure, gap, 2.0, 1.0)
    contact = (pressure > 0).mean()
    assert densities["pressure_density"].sum() * PRESSURE_BINS.width == pytest.approx(contact, rel=1e-12)
    assert densities["gap_density"].sum() * GAP_BINS.width == pytest.approx(1 - contact, rel=1e-12)


def test_a_value_lies_in_its_bin_and_one_beyond_the_last_in_the_last():
    bins = Bins(2.0, 4)
    assert list(bins.centres) == [0.25, 0.75, 1.25, 1.75]
    assert list(bins.density(np.array([0.6, 0.7, 1.9, 2.5]), 10)) == [0.0, 0.4, 0.0, 0.4]


def test_flat_heights_have_no_unit_and_their_densities_are_unknown():
    densities = distributions(np.ones(4), np.zeros(4), 0.0, 0.0)
    assert all(np.isnan(values).all() for values in densities.values())


def scene():
    """Return a sphere under two loads."""
    surface = cs.Sphere(10.0, 10.0)
    return cs.Scene(cs.HalfSpace(1.0), surface, cs.HardWall(), cs.pressures([1e-3, 1e-2]))


def test_the_density_of_a_sphere_rises_with_the_pressure_and_ends_at_hertz():
    """A sphere's pressure p₀√(1-r²/a²) has the density 2a_rel p/p₀²."""
    data = cs.simulate(scene(), points=1024, tolerance=1e-5, keep=["distributions"])
    unit = float(data.contact_modulus * data.rms_gradient)
    last = data.isel(step=-1)
    largest = 1.5 * float(last.mean_pressure / last.relative_contact_area_subgrid) / unit
    bins = data.pressure_bin.values
    inside = bins < largest - PRESSURE_BINS.width
    exact = 2 * float(last.relative_contact_area_subgrid) * bins / largest**2
    assert inside.sum() >= 5
    assert last.pressure_density.values[inside] == pytest.approx(exact[inside], rel=0.1)
    assert not last.pressure_density.values[bins > largest + PRESSURE_BINS.width].any()


def test_a_run_keeps_what_it_is_asked_for_and_computes_nothing_else(monkeypatch):
    monkeypatch.setattr("contactsim.paths.wall_numbers.contact_stiffness", None)
    monkeypatch.setattr("contactsim.paths.wall_numbers.find_patches", None)
    data = cs.simulate(scene(), points=64, keep=["distributions"])
    assert {"pressure_density", "gap_density", "nayak_parameter"} <= set(data)
    assert not {"contact_stiffness", "patches", "contact_bits", "contact_pressure"} & set(data)


def test_stiffness_and_patches_of_a_run_are_those_of_its_states():
    data = cs.simulate(scene(), points=64, tolerance=1e-6, keep=["stiffness", "patches"])
    states = [
        cs.press(
            cs.Sphere(10.0, 10.0).heights(64), spacing=10 / 64, contact_modulus=1.0, mean_pressure=load, tolerance=1e-6
        )
        for load in (1e-3, 1e-2)
    ]
    assert data.contact_stiffness.values == pytest.approx([cs.contact_stiffness(state) for state in states], rel=1e-6)
    assert list(data.patches.values) == [1, 1]
    assert list(data.largest_patch_share.values) == [1, 1]
    assert not data.spanning.values.any()
    assert data.contact_stiffness.attrs["units"] == "GPa/nm"


def test_what_cannot_be_kept_is_refused():
    with refused("keep", "distributions, patches, stiffness"):
        cs.simulate(scene(), points=64, keep=["stifness"])
