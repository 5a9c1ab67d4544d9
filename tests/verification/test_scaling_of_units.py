"""What cannot change the contact of rough lines without friction (Fig. 5.2), and numbers that scale as units say."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim
from contactsim import dataset
from contactsim.observables.derived import combine_runs, summarise_paths
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


POWERS = {"1": (0, 0), "nm": (1, 0), "1/nm": (-1, 0), "GPa": (0, 1), "N/m": (1, 1), "nJ/m": (2, 1), "GPa/nm": (-1, 1)}
POWERS |= {"nm (m/N)^2": (-1, -2)}
"""Powers of length and of modulus in each unit: N/m = GPa nm, nJ/m = GPa nm²."""
AT_A_LENGTH = "stored_energy", "area_at_12nm", "pressure_at_12nm", "area_at_20nm", "pressure_at_20nm"
"""Numbers that are read at a length in nm, which is none of the scene."""
HARD_TO_COME_BY = {"fold_load_before", "dissipated_energy", "event_released_energy", "average_friction"}
HARD_TO_COME_BY |= {"contact_stiffness", "gap_density", "yielding_share", "nayak_parameter"}
HARD_TO_COME_BY |= {"shear_strength", "quadratic_coefficient", "rms_curvature", "pull_off_displacement"}
"""Numbers of a wall, of a whole cycle with its jumps, and of three slides by a lattice constant with their slips."""


def datasets_in_units(length, modulus):
    """A rough line at a wall, an adhesive cycle with a jump each way, and slides at three approaches."""
    law = contactsim.CohesiveZone(2.0 * length * modulus, 1.0, length, length)
    increments = contactsim.Requested(fold_width=0.002 * length)

    def simulate(scene, **options):
        return contactsim.simulate(scene, points=128, tolerance=1e-9, **options).drop_vars("seconds")

    def pressed(upper, body_modulus, height, path, **pairing):
        body = contactsim.Layer(body_modulus * modulus, 0.3, height * length)
        bodies = contactsim.Body(contactsim.Flat.facing(upper)), contactsim.Body(upper, body)
        scene = contactsim.Scene(*bodies, law, path, **pairing)
        return simulate(scene, increments=increments, snapshots=[path.steps[-1].value])

    rough_line = contactsim.SelfAffine(1000.0 * length, 0.8, 500.0 * length, 50.0 * length, rms_gradient=0.1, seed=1)
    loads = contactsim.pressures([0.01 * modulus, 0.1 * modulus])
    wall = contactsim.Scene(
        contactsim.HalfSpace(3.0 * modulus), rough_line, contactsim.HardWall(hardness=0.2 * modulus), loads
    )
    kept = ("contact", "pressure", "distributions", "patches", "stiffness")
    cycle = contactsim.approaches([-8.0 * length, 0.0, -20.0 * length], length)
    asperity = contactsim.Cylinder(10000.0 * length, 25000.0 * length)
    runs = [(pressed(asperity, 77.0, 5000.0, cycle), {"member": 0})]
    probe, slides = contactsim.Cylinder(1000.0 * length, 2500.0 * length), []
    for approach in (2.0, 4.0, 6.0):
        slide = contactsim.sliding([0.0, 9.0 * length], 0.5 * length, approach=approach * length)
        path = contactsim.approaches([approach * length]) >> slide
        run = pressed(probe, 300.0, 1000.0, path, pairing=contactsim.Lattice(2.44 * length))
        slides.append((run, {"member": 0, "slide_approach": approach}))
    return [
        simulate(wall, keep=kept),
        *(dataset.describe(summarise_paths(combine_runs(part))) for part in (runs, slides)),
    ]


def test_every_number_of_a_dataset_scales_as_its_unit_says():
    length, modulus, seen = 4.0, 0.5, set()  # powers of two: rounding stays the same
    for plain, scaled in zip(datasets_in_units(1.0, 1.0), datasets_in_units(length, modulus), strict=True):
        for name, item in plain.data_vars.items():
            if item.dtype.kind in "fiu" and not name.startswith(AT_A_LENGTH):
                of_length, of_modulus = POWERS[item.units]
                expected = item.values * length**of_length * modulus**of_modulus
                within = 1e-9 * np.nanmax(np.abs(expected), initial=0.0)
                np.testing.assert_allclose(scaled[name].values, expected, rtol=1e-6, atol=within, err_msg=name)
                seen |= {name} if expected[np.isfinite(expected)].any() else set()
    assert seen >= HARD_TO_COME_BY
    assert len(seen) > 180
