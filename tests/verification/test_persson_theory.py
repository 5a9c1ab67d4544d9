"""Persson's theory against its own balance of energy, its integrals, and a rough surface that is pressed."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import erf

import contactsim as cs
from contactsim.reference import persson
from contactsim.reference.persson import (
    ENERGY_PART,
    PARTS,
    Spectrum,
    persson_area,
    persson_gap_density,
    persson_mean_gap,
    persson_pressure_density,
)
from support.cases import refused

LENGTH, LONG, SHORT, GRADIENT = 1000.0, 250.0, 31.25, 0.1
WAVES = Spectrum.self_affine(LENGTH, LONG, SHORT, 0.8, GRADIENT)
MODULUS = 2.0


def test_perssons_density_has_his_area_and_the_mean_pressure():
    pressure = np.linspace(0, 10, 200001)
    density = persson_pressure_density(pressure, 0.3, 2.0, 1.2)
    assert np.trapezoid(density, pressure) == pytest.approx(float(persson_area(0.3 / 2.4)), rel=1e-8)
    assert np.trapezoid(density * pressure, pressure) == pytest.approx(0.3, rel=1e-8)
    assert density[0] == 0


@pytest.mark.parametrize("hurst_exponent", [0.2, 0.8])
def test_the_expected_spectrum_is_that_of_surfaces_that_are_drawn(hurst_exponent):
    waves = Spectrum.self_affine(LENGTH, LONG, SHORT, hurst_exponent, GRADIENT)
    assert np.sum(waves.wavenumbers**2 * waves.powers) == pytest.approx(GRADIENT**2)
    drawn = [
        cs.SelfAffine(LENGTH, hurst_exponent, LONG, SHORT, GRADIENT, dimensions=2, seed=seed).heights(128).std()
        for seed in range(40)
    ]
    assert np.mean(drawn) == pytest.approx(waves.rms_height, rel=0.03)
    assert waves.wavenumbers[0] == pytest.approx(2 * np.pi / LENGTH * (1 + np.sqrt(2)) / 2, rel=0.2)
    assert waves.wavenumbers[-1] <= 2 * np.pi / SHORT


def elastic_energy(pressure: float) -> float:
    """Return the elastic energy for each area, summed as it is written in the notes."""
    waves = WAVES.divided(PARTS)
    part = waves.powers * waves.wavenumbers**2
    variance = (MODULUS / 2) ** 2 * (np.cumsum(part) - part / 2)
    area = erf(pressure / np.sqrt(2 * variance))
    parts = area * (ENERGY_PART + (1 - ENERGY_PART) * area**2)
    return MODULUS / 4 * float(np.sum(waves.powers * waves.wavenumbers * parts))


@pytest.mark.parametrize("reduced", [1e-3, 1e-2, 0.1, 0.5, 1.5])
def test_the_load_does_the_work_that_the_bodies_store(reduced):
    low, high = (reduced * MODULUS * GRADIENT * factor for factor in (0.999, 1.001))
    stored = elastic_energy(high) - elastic_energy(low)
    closed = persson_mean_gap(low, WAVES, MODULUS) - persson_mean_gap(high, WAVES, MODULUS)
    assert stored == pytest.approx((low + high) / 2 * closed, rel=2e-3)


def test_the_mean_gap_falls_to_zero_with_the_load():
    loads = np.geomspace(1e-4, 5.0, 20) * MODULUS * GRADIENT
    gaps = [persson_mean_gap(load, WAVES, MODULUS) for load in loads]
    assert all(np.diff(gaps) < 0)
    assert gaps[-1] < 1e-9 * WAVES.rms_height


@pytest.mark.parametrize("reduced", [1e-3, 3e-2, 0.3])
def test_the_density_of_the_gap_is_positive_and_integrates_to_the_area_out_of_contact(reduced):
    pressure = reduced * MODULUS * GRADIENT
    gaps = np.linspace(0, 12 * WAVES.rms_height, 20001)
    density = persson_gap_density(gaps, pressure, WAVES, MODULUS)
    assert (density >= 0).all()
    assert np.trapezoid(density, gaps) == pytest.approx(1 - float(persson_area(reduced)), rel=2e-3)
    assert np.trapezoid(density * gaps, gaps) >= persson_mean_gap(pressure, WAVES, MODULUS)


def test_a_rough_surface_has_about_the_gap_of_the_theory():
    surface = cs.SelfAffine(LENGTH, 0.8, LONG, SHORT, GRADIENT, dimensions=2, seed=3)
    for reduced in (0.01, 0.05):
        pressure = reduced * MODULUS * GRADIENT
        result = cs.press(surface.heights(128), contact_modulus=MODULUS, mean_pressure=pressure, spacing=LENGTH / 128)
        assert float(result.gap.mean()) == pytest.approx(persson_mean_gap(pressure, WAVES, MODULUS), rel=0.1)


def test_parts_of_waves_are_fine_enough(monkeypatch):
    gaps = {}
    for parts in (PARTS, 32 * PARTS):
        monkeypatch.setattr(persson, "PARTS", parts)
        gaps[parts] = [persson_mean_gap(reduced * MODULUS * GRADIENT, WAVES, MODULUS) for reduced in (1e-3, 0.1)]
    assert gaps[PARTS] == pytest.approx(gaps[32 * PARTS], rel=1e-2)


@pytest.mark.parametrize("load", [0.0, -1.0, np.nan, [0.1, 0.2]])
def test_a_load_is_one_number_above_zero(load):
    for theory in (persson_mean_gap, lambda *given: persson_gap_density(1.0, *given)):
        with refused("mean_pressure", "positive"):
            theory(load, WAVES, MODULUS)
    with refused("short_cutoff", "below the length"):
        Spectrum.self_affine(1000.0, 250.0, 1000.0, 0.8, 0.1)
