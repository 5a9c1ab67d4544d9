from __future__ import annotations

import json
from importlib import metadata

import pytest

from contactsim.provenance import canonical, digest, versions


def test_settings_have_one_text_whatever_the_order_of_their_keys():
    one = {"b": [1, 2], "a": {"y": 0.1, "x": None}}
    other = {"a": {"x": None, "y": 0.1}, "b": [1, 2]}
    assert canonical(one) == canonical(other) == '{"a":{"x":null,"y":0.1},"b":[1,2]}'
    assert digest(one) == digest(other)


def test_the_text_of_settings_reads_back_as_the_same_settings():
    settings = {"pressure": [1e-3, 0.1 + 0.2, 5e-324, 1e300], "title": "κ ≤ 1", "points": 2**60, "solver": None}
    assert json.loads(canonical(settings)) == settings
    assert canonical(json.loads(canonical(settings))) == canonical(settings)


@pytest.mark.parametrize(
    "other", [({"a": [2, 1]},), ({"a": [1, 2]}, None), ({"a": ["1", 2]},), ({"a": [1, 2.0000000000000004]},), ()]
)
def test_other_settings_have_another_digest(other):
    assert digest(*other) != digest({"a": [1, 2]})


def test_the_digest_of_settings_never_changes():
    # The value itself, since files of results are found by it; SHA-256 of `[{"a":1},"b"]`.
    assert digest({"a": 1}, "b") == "459ff8feec8357fd"


def test_versions_are_those_installed():
    found = versions()
    assert found["contactsim"] == metadata.version("contactsim")
    assert set(found) == {"contactsim", "numpy", "scipy", "ducc0", "numba", "xarray", "netCDF4"}
