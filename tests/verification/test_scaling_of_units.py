"""What cannot change the contact of rough lines without friction: identities, so no study varies it (Fig. 5.2)."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim
from contactsim.study.plan import Plan
from support.cases import rough
from support.places import ROOT

POINTS, MODULUS = 4096, 1.0
HEIGHTS = rough(POINTS, 0.2)
BODIES = {"half-space": {}, "layer": {"thickness": POINTS / 8, "poisson_ratio": 0.1}}


def pressed(heights, reduced_pressure, modulus=MODULUS, **body):
    """Press heights of unit spacing at p* = p/(ḡE*)."""
    gradient = contactsim.surfaces.statistics.rms_gradient(heights, 1.0)
    pressure = reduced_pressure * gradient * modulus
    return contactsim.press(heights, spacing=1.0, contact_modulus=modulus, mean_pressure=pressure, **body)


def same(one, other, scale=1.0):
    """Whether two results are one contact, the second's pressures `scale` times as large."""
    size = one.pressure.max()
    return np.array_equal(one.contact, other.contact) and np.allclose(
        other.pressure / scale, one.pressure, rtol=0, atol=1e-12 * size
    )


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
@pytest.mark.parametrize("reduced_pressure", [1e-3, 1e-2, 1e-1])
def test_neither_the_scale_of_heights_nor_the_modulus_changes_the_contact(body, reduced_pressure):
    plain = pressed(HEIGHTS, reduced_pressure, **body)
    assert 0 < plain.relative_contact_area < 1
    assert same(plain, pressed(3 * HEIGHTS, reduced_pressure, **body), 3)
    assert same(plain, pressed(HEIGHTS, reduced_pressure, 7.0, **body), 7)


@pytest.mark.parametrize("reduced_pressure", [1e-3, 1e-2, 1e-1])
def test_in_a_layer_as_thick_as_a_half_space_poissons_ratio_does_not_change_the_contact(reduced_pressure):
    plain = pressed(HEIGHTS, reduced_pressure)
    thickness = 1e5 * POINTS  # as in config/ch5.yaml: 1e9 nm on a period of 10240 nm
    for ratio in (0.1, 0.45):
        assert same(plain, pressed(HEIGHTS, reduced_pressure, thickness=thickness, poisson_ratio=ratio))


def test_in_a_layer_half_as_thick_as_the_long_cutoff_poissons_ratio_changes_the_contact():
    found = [pressed(HEIGHTS, 1e-2, thickness=POINTS / 8, poisson_ratio=ratio) for ratio in (0.1, 0.45)]
    assert not same(*found)
    # The thickest of the study is thicker still, the thin one half of the roll-off wavelength.
    study = Plan.read(ROOT / "config", "standard").studies["nonadhesive_compressible"].settings
    thin, thick = study["vary"]["body.thickness"]
    assert thin == study["surface"]["long_cutoff"] / 2
    assert thick / study["surface"]["length"] > 9e4


@pytest.mark.parametrize("scale", [0.1, 3.0])
def test_scaling_heights_and_the_laws_length_together_scales_pressures_and_nothing_else(scale):
    # With φn*/ḡ and δn/h_rms unchanged, curves at large slopes are exactly those of a contact of small slopes.
    points, length = 1024, 1280.0
    heights = rough(points, 0.5) * 5.0
    plain, scaled = (
        contactsim.simulate(
            contactsim.Scene(
                contactsim.HalfSpace(88.0, 0.45),
                contactsim.Topography(size * heights, spacing=length / points),
                contactsim.NormalCohesiveZone(2.0 * size**2, size),
                contactsim.approaches((size * np.arange(-3.0, 9.0, 1.0)).tolist(), from_touch=True),
            ),
            tolerance=1e-10,
        )
        for size in (1.0, scale)
    )
    assert (plain.status == 0).all() and plain.contact_length.max() > 0
    for name in ("contact_length", "interacting_length_0_01", "max_interpenetration"):
        assert np.allclose(scaled[name], plain[name], rtol=1e-6, atol=1e-6)
    assert np.allclose(scaled.mean_pressure, scale * plain.mean_pressure, rtol=1e-6, atol=1e-9)
