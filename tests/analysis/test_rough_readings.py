"""Which studies are paths through rough contacts, and of what kind."""

from __future__ import annotations

import pytest

from contactsim.analysis.rough_readings import rough_path_of
from contactsim.reference.hard_wall import uniaxial_modulus

BODY = {"kind": "half_space", "youngs_modulus": 1.5, "poisson_ratio": 0.3}
SETTINGS = {
    "surface": {"kind": "self_affine"},
    "path": {"control": "approach"},
    "effects": ["normal_cohesive_zone"],
    "body": BODY,
    "vary": {},
}


def test_a_rough_path_has_the_stiffness_of_its_one_half_space():
    path = rough_path_of(SETTINGS, slips=True)
    assert (path.adheres, path.slips) == (True, True)
    assert path.uniaxial_modulus == pytest.approx(uniaxial_modulus(1.5, 0.3))
    assert not rough_path_of(SETTINGS | {"effects": ["hard_wall"]}, slips=False).adheres


@pytest.mark.parametrize(
    "change",
    [
        {"body": BODY | {"kind": "layer"}},
        {"body": {"kind": "half_space", "contact_modulus": 1.0}},
        {"vary": {"body.poisson_ratio": [0.1, 0.3]}},
    ],
)
def test_several_bodies_and_those_of_unknown_stiffness_have_none(change):
    assert rough_path_of(SETTINGS | change, slips=False).uniaxial_modulus is None


@pytest.mark.parametrize("change", [{"surface": {"kind": "cylinder"}}, {"path": None}])
def test_other_studies_are_no_rough_paths(change):
    assert rough_path_of(SETTINGS | change, slips=False) is None
