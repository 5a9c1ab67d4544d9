"""Whatever is given to a public constructor is right, or refused in a sentence: no other error, no warning."""

from __future__ import annotations

import contextlib
import decimal
import fractions
import warnings

import numpy as np
import pytest

import contactsim
from contactsim import (
    CohesiveZone,
    Cylinder,
    HalfSpace,
    HardWall,
    InputError,
    Layer,
    NormalCohesiveZone,
    Scene,
    approaches,
    pressures,
    simulate,
    sliding,
)
from contactsim.errors import LARGEST, SMALLEST, is_number, is_positive, is_whole

STRANGE = [
    "x", "", None, fractions.Fraction(1, 3), decimal.Decimal("0.5"), np.float16(0.5), np.float32(0.5), [], [1.0, 2.0],
    {}, (), np.nan, np.inf, -np.inf, 0, -1, 1e-300, 1e300, 1e-12, True, 1j, np.array([1.0]), np.array(2.0), object(),
    b"x", 10**400, np.int64(3), -0.0, 5e-324,
]  # fmt: skip
LAW = {"work_of_separation": 0.5, "normal_length": 1.0}
MIXED = LAW | {"work_ratio": 0.3, "tangential_length": 1.0}
GOOD = {
    "HalfSpace": {"contact_modulus": 1.0, "poisson_ratio": 0.3},
    "Layer": {"contact_modulus": 1.0, "poisson_ratio": 0.3, "thickness": 100.0},
    "Flat": {"length": 1000.0, "height": 1.0, "width": 1000.0},
    "Cylinder": {"length": 1000.0, "radius": 5000.0},
    "Sphere": {"length": 1000.0, "radius": 5000.0},
    "Sinusoid": {"length": 1000.0, "amplitude": 1.0, "periods": 2, "dimensions": 1},
    "SelfAffine": {
        "length": 1000.0, "hurst_exponent": 0.8, "long_cutoff": 250.0, "short_cutoff": 40.0, "rms_gradient": 0.1,
        "amplitudes": "gaussian", "dimensions": 1, "low_pass_cutoff": 50.0, "seed": 1,
    },
    "Topography": {"values": np.sin(np.arange(64) / 10.2), "spacing": (1.0,), "source": "x"},
    "CohesiveZone": MIXED,
    "NormalCohesiveZone": LAW,
    "UncoupledCohesiveZone": MIXED,
    "RepulsiveZone": LAW,
    "StiffCohesiveZone": LAW | {"contact_stiffness": 1.0},
    "FrictionalRepulsiveZone": LAW | {"friction_coefficient": 0.3, "tangential_length": 1.0},
    "StiffMixedZone": MIXED | {"contact_stiffness": 1.0},
    "Lattice": {"lattice_constant": 10.0, "tangential_cutoff": 5.0, "normal_cutoff": 40.0, "weight": 1.0},
    "Requested": {"fold_width": 0.002, "budget": 1e4},
    "Adaptive": {"error": 1e-3, "least": 0.01, "most": 2.0, "fold_width": 0.002, "budget": 1e4},
    "Nested": {
        "full_grid_at": [0.0], "coarse_ratio": 4, "intermediate_ratio": 2, "coarse_tolerance": 1e-3,
        "intermediate_tolerance": 1e-4, "budget": 1e4,
    },
    "pressures": {"values": [0.1, 0.2], "increment": None, "labels": ("a", "b"), "from_touch": False},
    "approaches": {"values": [0.0, 1.0], "increment": 0.5, "from_touch": False},
    "sliding": {"turning_points": [0.0, 5.0], "increment": 0.5, "approach": 1.0, "from_touch": False},
    "LoadPath": {"parts": (), "from_touch": False},
}  # fmt: skip


@pytest.mark.parametrize("name", GOOD)
def test_a_strange_value_makes_an_object_or_an_input_error(name):
    for key in GOOD[name]:
        for value in STRANGE:
            with contextlib.suppress(InputError):
                getattr(contactsim, name)(**GOOD[name] | {key: value})


@pytest.mark.parametrize("value", [fractions.Fraction(1, 4), np.float16(0.25), np.float32(0.25), np.float64(0.25)])
def test_numbers_of_every_kind_are_kept_as_floats(value):
    body = HalfSpace(value, value)
    assert type(body.contact_modulus) is type(body.poisson_ratio) is float
    assert body == HalfSpace(0.25, 0.25)
    (step,) = pressures([value]).steps
    assert type(step.value) is float
    assert type(Cylinder(1, 2).radius) is float


def test_numbers_are_bounded_so_that_squares_are_neither_zero_nor_infinite():
    assert is_number(LARGEST) and not is_number(LARGEST * 1.001)
    assert is_number(10**99) and not is_number(10**400)
    assert is_positive(SMALLEST) and not is_positive(SMALLEST / 1.001)
    assert not any(is_number(value) for value in (True, "1", None, np.nan, 1j, [1.0], np.array(1.0)))
    assert is_whole(2.0) and is_whole(np.int8(2)) and not any(is_whole(value) for value in (1.5, 0, "2", True))
    assert is_whole(0, least=0)
    assert np.isfinite([LARGEST**3, SMALLEST**-3]).all()


def test_lists_of_numbers_are_lists_and_have_a_least_length():
    assert [step.value for step in pressures(value for value in (1, 2)).steps] == [1.0, 2.0]
    for values in ("12", b"12", {1: 2}, {1, 2}, 3.0, None, [1.0, None], np.ones((2, 2)), [], [np.inf]):
        with pytest.raises(InputError, match=r"^values: pressures needs a list of one or more numbers"):
            pressures(values)
    with pytest.raises(InputError, match=r"^turning_points: .* two or more numbers"):
        sliding([1.0], 1.0, approach=0.0)


PATH = approaches([-2.0, 0.0])


def scene_with(part):
    """A scene of which one part is given: a body, a cylinder or a law."""
    if isinstance(part, HalfSpace | Layer):
        return Scene(part, Cylinder(1000.0, 5000.0), CohesiveZone(0.5, 0.3), PATH)
    if isinstance(part, Cylinder):
        return Scene(HalfSpace(70.0, 0.3), part, NormalCohesiveZone(0.5), PATH)
    return Scene(Layer(70.0, 0.3, 1000.0), Cylinder(1000.0, 5000.0), part, PATH)


@pytest.mark.parametrize("name", ["HalfSpace", "Layer", "Cylinder", "CohesiveZone", "NormalCohesiveZone"])
@pytest.mark.parametrize("factor", [1e-12, 1e-6, 1e6])
def test_an_extreme_scene_is_refused_or_every_state_is_finite_or_told(name, factor):
    for key, usual in GOOD[name].items():
        try:
            scene = scene_with(getattr(contactsim, name)(**GOOD[name] | {key: usual * factor}))
        except InputError:
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            data = simulate(scene, points=32, keep_fields=False)
        solved = data.status.values <= 0
        for number in ("mean_pressure", "contact_length", "mean_gap"):
            assert np.isfinite(data[number].values[solved]).all(), (key, number)


def test_a_pressure_that_laws_cannot_bear_and_lengths_that_rounding_hides_are_refused():
    body, cylinder = HalfSpace(70.0, 0.3), Cylinder(1000.0, 5000.0)
    with pytest.raises(InputError, match=r"mean_pressure: got 0\.01; allowed: at most .* overlap by 100 lengths"):
        Scene(body, cylinder, NormalCohesiveZone(1e-12), pressures([0.01]))
    with pytest.raises(InputError, match=r"tangential_length: got 1e-12; allowed: 1e-06 to 1e\+12 nm"):
        Scene(body, cylinder, CohesiveZone(0.5, 0.3, tangential_length=1e-12), PATH)
    with pytest.raises(InputError, match=r"radius: got .* of the period"):
        Cylinder(1.0, 1e-12)
    Scene(body, cylinder, HardWall(), pressures([0.01]))
    assert sliding([0, 5], 1, approach=0).steps[-1].value == 5.0
