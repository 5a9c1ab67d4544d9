from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

import contactsim
from contactsim.errors import InputError
from contactsim.interface.normal_law import NormalLaw
from contactsim.status import is_solved

GOOD = {"heights": np.array([0.0, 1.0, 0.5, -1.0]), "spacing": 1.0, "contact_modulus": 1.0, "mean_pressure": 0.1}


def test_a_list_of_whole_numbers_will_do():
    result = contactsim.press([0, 1, 2, 1], spacing=1, contact_modulus=1, mean_pressure=0.1)
    assert result.status.name == "CONVERGED"
    assert result.contact.tolist() == [False, False, True, False]
    assert result.relative_contact_area == 0.25


def test_the_given_heights_are_left_alone():
    heights = GOOD["heights"].copy()
    contactsim.press(**GOOD | {"heights": heights})
    assert np.array_equal(heights, GOOD["heights"])


@pytest.mark.parametrize(
    ("change", "key", "allowed"),
    [
        ({"heights": [1.0]}, "heights", "two or more"),
        ({"heights": []}, "heights", "two or more"),
        ({"heights": [0.0, np.nan, 1.0]}, "heights", "finite"),
        ({"heights": [0.0, np.inf, 1.0]}, "heights", "finite"),
        ({"heights": np.zeros((4, 4, 4))}, "heights", "2D"),
        ({"heights": ["a", "b"]}, "heights", "number"),
        ({"spacing": 0.0}, "spacing", "positive"),
        ({"spacing": -1.0}, "spacing", "positive"),
        ({"spacing": "1"}, "spacing", "number"),
        ({"contact_modulus": 0.0}, "contact_modulus", "positive"),
        ({"contact_modulus": "70"}, "contact_modulus", "positive"),
        ({"contact_modulus": None}, "contact_modulus", "positive"),
        ({"mean_pressure": [0.1]}, "mean_pressure", "finite number"),
        ({"mean_pressure": 1j}, "mean_pressure", "finite number"),
        ({"tolerance": "1e-3"}, "tolerance", "positive"),
        ({"threads": True}, "threads", "whole number"),
        ({"contact_modulus": float("nan")}, "contact_modulus", "positive"),
        ({"mean_pressure": -0.1}, "mean_pressure", "0 or more"),
        ({"mean_pressure": float("inf")}, "mean_pressure", "finite"),
        ({"mean_pressure": "0.1"}, "mean_pressure", "finite"),
        ({"mean_pressure": None}, "load", "exactly one"),
        ({"approach": 0.0}, "load", "exactly one"),
        ({"mean_pressure": None, "approach": float("nan")}, "approach", "finite"),
        ({"tolerance": 0.0}, "tolerance", "positive"),
        ({"tolerance": float("nan")}, "tolerance", "positive"),
        ({"solver": "magic"}, "solver", "active_set"),
        ({"threads": 0}, "threads", "1 to 1024"),
    ],
)
def test_bad_input_is_refused_with_key_and_what_is_allowed(change, key, allowed):
    with pytest.raises(InputError) as caught:
        contactsim.press(**GOOD | change)
    assert caught.value.key == key
    assert allowed in caught.value.allowed


@pytest.mark.parametrize(
    ("spacing", "value"),
    [((1, 2, 3), "(1.0, 2.0, 3.0)"), ((1, -2), "-2.0"), (np.array([0, 1]), "0.0"), (np.float64(-1.5), "-1.5")],
)
def test_a_bad_spacing_of_a_surface_is_named_in_plain_numbers(spacing, value):
    with pytest.raises(InputError) as caught:
        contactsim.press(np.eye(4), spacing=spacing, contact_modulus=1.0, mean_pressure=0.1)
    assert str(caught.value).startswith(f"spacing: got {value}; allowed: a positive number")


def test_messages_show_numbers_of_numpy_as_plain_numbers():
    with pytest.raises(InputError, match=r"got \{'mean_pressure': 0.5, 'approach': 2.0\};"):
        contactsim.press(**GOOD | {"mean_pressure": np.float64(0.5), "approach": np.float64(2.0)})


def test_a_record_tells_cost_and_certificate():
    record = contactsim.press(**GOOD).record
    assert record.transforms > 0
    assert record.iterations > 0
    assert record.certificate.met(1e-3)
    assert record.certificate.min_pressure >= 0


@pytest.mark.parametrize(
    ("heights", "key"),
    [
        (np.ma.masked_array([0.0, 9.0, 1.0], [False, True, False]), "heights"),
        ([[1.0, 2.0], [3.0]], "heights"),
    ],
)
def test_heights_that_are_no_row_of_numbers_or_partly_masked_are_refused(heights, key):
    with pytest.raises(InputError) as caught:
        contactsim.press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=0.1)
    assert caught.value.key == key


@pytest.mark.parametrize("method", [3, dict])
def test_what_is_no_solver_is_refused(method):
    with pytest.raises(InputError, match="the name of a solver"):
        contactsim.press([0.0, 1.0], spacing=1.0, contact_modulus=1.0, mean_pressure=0.1, solver=method)


@pytest.mark.parametrize(
    "change",
    [
        {"contact_modulus": 1e-308, "spacing": 100.0},
        {"contact_modulus": 1e308, "spacing": 1e-4},
        {"spacing": 1e-320},
        {"heights": [1.7e308, -1.7e308, 0.0]},
        {"mean_pressure": 1.7e308},
    ],
)
def test_units_beyond_floating_point_are_refused(change):
    given = {"heights": [0.0, 1.0, 0.5], "spacing": 1.0, "contact_modulus": 1.0, "mean_pressure": 0.1} | change
    with pytest.raises(InputError, match=r"range of floating point|to 1e\+100"):
        contactsim.press(given.pop("heights"), **given)


@pytest.mark.parametrize(
    ("function", "options", "allowed"),
    [
        ("press", GOOD | {"presure": 0.1}, "contact_modulus, mean_pressure, approach"),
        ("simulate", {"scene": None, "tolerence": 1e-6}, "points, tolerance, accuracy"),
        ("estimate_cost", {"scene": None, "solver": "newton"}, "points, tolerance, accuracy"),
        ("neglect", {"scene": None, "accuracy": 0.1}, "within, quantities, points"),
        ("explain", {"scene": None, "tolerance": 1e-6}, "points, solver, increments"),
    ],
)
def test_an_unknown_option_is_named_with_those_that_there_are(function, options, allowed):
    with pytest.raises(InputError) as caught:
        getattr(contactsim, function)(**options)
    assert (caught.value.key, caught.value.value) == list(options.items())[-1]
    assert caught.value.allowed.startswith(f"no such option, but {allowed}")


@pytest.mark.parametrize("body", [contactsim.Layer(77.0, 0.3, 5000.0), contactsim.HalfSpace(77.0)], ids=repr)
@pytest.mark.parametrize(
    "path", [contactsim.approaches([-1.0, 3.0]), contactsim.pressures([0.0, 0.01])], ids=["h", "p"]
)
def test_the_stored_gap_is_what_heights_approach_and_displacement_leave(path, body):
    cylinder, law = contactsim.Cylinder(10000.0, 25000.0), contactsim.NormalCohesiveZone(2.0)
    scene = contactsim.Scene(body, cylinder, law, path)
    data = contactsim.simulate(scene, points=64, tolerance=1e-10, snapshots=[path.steps[-1].value])
    gap = -data.heights - data.approach[-1] - data.normal_displacement[0]
    np.testing.assert_allclose(data.normal_gap[0], gap, atol=1e-12 * np.ptp(data.heights.values))
    mean = body.compliance(np.zeros(1))[0] * data.mean_pressure[-1]
    assert float(data.normal_displacement.mean()) == pytest.approx(-float(mean), abs=1e-6)


LAYERED = contactsim.Scene(
    contactsim.Layer(contact_modulus=70.0, poisson_ratio=0.3, thickness=5e3),
    contactsim.Cylinder(radius=2.5e4, length=1e4),
    contactsim.CohesiveZone(work_of_separation=0.8, work_ratio=0.5),
    contactsim.approaches([-2.0, 1.0], 0.5),
)


@pytest.mark.parametrize(
    ("options", "key"),
    [
        ({"within": 1.5}, "within"),
        ({"within": 0.0}, "within"),
        ({"within": "0.1"}, "within"),
        ({"quantities": "final_contact_length"}, "quantities"),
        ({"quantities": ["final_length"]}, "quantities"),
        ({"quantities": ["relative_contact_area_subgrid"]}, "quantities"),
    ],
)
def test_what_cannot_be_neglected_is_refused_before_anything_is_solved(options, key):
    given = {"within": 0.05, "quantities": ["final_contact_length"], "points": 256}
    with pytest.raises(InputError, match=key):
        contactsim.neglect(LAYERED, **given | options)


def test_a_law_without_a_name_in_the_config_is_explained_by_its_class():
    @dataclass(frozen=True)
    class Weak(NormalLaw):
        strength = 1.0
        stiffness = 1.0

        def traction(self, gap):
            return 0.0 * gap

        def tangent(self, gap):
            return 0.0 * gap, 0.0 * gap[None]

        def energy(self, gap):
            return 0.0 * gap[0]

    laws = (contactsim.HardWall(), Weak(work_of_separation=1.0, normal_length=1.0))
    scene = contactsim.Scene(LAYERED.lower, LAYERED.upper, laws, LAYERED.path)
    assert "Weak" in contactsim.explain(scene, points=256).text


def test_states_without_a_solution_have_no_numbers():
    path = contactsim.pressures([-1e-5, 1e-4, -1e-1, -2e-1])  # far beyond the pull-off in the end
    law = contactsim.NormalCohesiveZone(work_of_separation=0.05, normal_length=0.5)
    scene = contactsim.Scene(contactsim.HalfSpace(1.0), contactsim.Cylinder(8000.0, 1e4), law, path)
    data = contactsim.simulate(scene, points=256)
    solved = is_solved(data.status)
    assert solved.values.tolist() == [True, True, False, False]
    for name in ("approach", "mean_pressure", "contact_length", "max_tensile_traction", "mean_gap"):
        assert np.array_equal(np.isfinite(data[name]), solved)
