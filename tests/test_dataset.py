from __future__ import annotations

import os
import re
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import contactsim
from contactsim import dataset, provenance
from contactsim.analysis.quantities import ERROR_BARS
from contactsim.dataset import describe, settings_of, stamp
from contactsim.errors import InputError
from contactsim.observables.contact_readings import READINGS
from contactsim.observables.path_summary import SUMMARIES
from contactsim.solvers.registry import SOLVERS, solver_class
from contactsim.status import Status
from contactsim.study.keys import SECTION_KINDS
from contactsim.study.reading import keys_of
from contactsim.variables import RESULTS, SETTINGS, SUFFIXES, dimension_name

SOURCE = Path(contactsim.__file__).parent


@pytest.fixture
def data():
    """A dataset with numbers of every kind, text, a scalar, and arrays small and large enough to be compressed."""
    draw = np.random.default_rng(0)
    made = xr.Dataset(
        {
            "relative_contact_area": (("hurst_exponent", "reduced_pressure"), [[0.1, np.nan], [0.2, 0.3]]),
            "status": (("hurst_exponent", "reduced_pressure"), np.array([[0, 1], [2, 0]], np.int8)),
            "iterations": ("reduced_pressure", np.array([3, 4], np.int32)),
            "point_digest": ("reduced_pressure", np.array(["one", "two"], object)),
            "contact_bits": (("reduced_pressure", "byte"), draw.integers(0, 256, (2, 20000), np.uint8)),
            "contact_pressure": ("contact_point", draw.random(5000, np.float32)),
            "length": 160000.0,
        },
        {"hurst_exponent": [0.2, 0.8], "reduced_pressure": [0.01, 0.1]},
    )
    return stamp(describe(made), "A title with κ", {"b": None, "a": [0.1, True]}, "abc")


def names_written():
    """Return the composed names, and every word that a module other than the table has as a string or as a keyword."""
    words = {*READINGS, *ERROR_BARS, *(name for names in SUMMARIES.values() for name in names)}
    for module in set(SOURCE.rglob("*.py")) - {SOURCE / "variables.py"}:
        code = re.sub(r'"""[\s\S]*?"""', "", module.read_text(encoding="utf-8"))
        words.update(word for pair in re.findall(r'"(\w+)"|\b(\w+)=', code) for word in pair)
    return words


def test_every_variable_in_the_table_is_written_by_some_module():
    written = names_written()
    assert "relative_contact_area" in written
    assert [name for name in RESULTS if name not in written] == []


def test_every_variable_has_a_unit_and_a_long_name_of_its_own():
    texts = [variable.long_name for variable in RESULTS.values()]
    assert all(text and text == text.strip() for text in texts)
    assert len(set(texts)) == len(texts)


def test_described_variables_and_coordinates_have_units_and_a_long_name(data):
    for name, item in data.variables.items():
        assert (item.attrs["units"], item.attrs["long_name"]) == (SETTINGS | RESULTS)[name][:2], name
    assert data.relative_contact_area.long_name == "relative contact area"
    assert data.length.units == "nm"


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_aggregation_derives_inherits_the_unit_and_says_what_it_is(suffix):
    name = f"mean_gap{suffix}"
    made = describe(xr.Dataset({name: 1.0}))
    assert made[name].units == "nm"
    assert made[name].long_name == "mean gap" + SUFFIXES[suffix]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("half_width", "half-width of the contact"),
        ("fit_b1_half_width", "parameter b1 of Eq. 3.11: half-width of the 95 %"),
        ("fit_limit", "largest reduced pressure that a fit uses"),
        ("kappa_limit", "extrapolated to the limit on finer grids"),
    ],
)
def test_a_name_that_ends_like_a_derived_quantity_is_not_taken_for_one(name, words):
    assert words in describe(xr.Dataset({name: 1.0}))[name].long_name


def test_every_key_that_can_be_varied_gets_a_dimension_that_no_result_has_with_its_unit():
    dimensions = {}
    for section, (known, class_of) in SECTION_KINDS.items():
        for kind in known:
            for key in ["kind", *keys_of(class_of(kind))]:
                dimensions[section, key] = dimension_name(f"{section}.{key}")
    assert not set(dimensions.values()) & set(RESULTS)
    assert len(set(dimensions.values())) == len({(section, key) for section, key in dimensions})
    for (section, key), name in dimensions.items():
        made = describe(xr.Dataset(coords={name: [1.0]}))
        if section not in ("solver", "increments"):
            assert (made[name].units, made[name].long_name) == SETTINGS[key][:2], name
        else:
            assert made[name].units == "1"


def test_the_status_says_what_its_numbers_mean(data):
    flags = dict(zip(data.status.flag_values.tolist(), data.status.flag_meanings.split(), strict=True))
    assert flags == {status.value[0]: status.name.lower() for status in Status}
    assert data.status.flag_values.dtype == data.status.dtype


def test_a_stamp_says_title_settings_source_and_versions(data):
    assert data.attrs["title"] == "A title with κ"
    assert data.attrs["settings"] == '{"a":[0.1,true],"b":null}'
    assert data.attrs["source_digest"] == "abc"
    assert data.attrs["versions"] == provenance.canonical(provenance.versions())
    assert settings_of(data) == {"a": [0.1, True], "b": None}


def test_what_is_written_is_read_back_the_same(data, tmp_path):
    dataset.write(data, tmp_path / "new" / "folder" / "data.nc")
    found = dataset.load_dataset(tmp_path / "new" / "folder" / "data.nc")
    xr.testing.assert_identical(found, data)
    for name in data.variables.keys() - {"point_digest"}:  # text has no width in a file
        assert found[name].dtype == data[name].dtype, name


def test_writing_twice_gives_the_same_bytes_at_another_time(data, tmp_path):
    one, other = tmp_path / "one.nc", tmp_path / "other.nc"
    dataset.write(data, one)
    time.sleep(1.1)  # HDF5 counts times in seconds, if it notes them at all
    dataset.write(data.copy(deep=True), other)
    assert one.read_bytes() == other.read_bytes()


@pytest.mark.parametrize("failing", ["to_netcdf", "replace"])
def test_a_failure_leaves_the_old_file_and_no_other(data, tmp_path, monkeypatch, failing):
    path = tmp_path / "data.nc"
    dataset.write(data, path)
    before = path.read_bytes()

    def fail(self_or_source, target_or_path, **options):
        Path(target_or_path if failing == "to_netcdf" else self_or_source).write_bytes(b"half a file")
        raise OSError("disk full")

    monkeypatch.setattr(*((xr.Dataset, "to_netcdf") if failing == "to_netcdf" else (os, "replace")), fail)
    with pytest.raises(OSError, match="disk full"):
        dataset.write(data.assign(length=1.0), path)
    assert [file.name for file in tmp_path.iterdir()] == ["data.nc"]
    assert path.read_bytes() == before


def test_what_netcdf_cannot_hold_leaves_no_file(tmp_path):
    made = xr.Dataset({"length": ((), np.array({"a": 1}, object))})
    with pytest.raises((TypeError, ValueError)):
        dataset.write(made, tmp_path / "data.nc")
    assert list(tmp_path.iterdir()) == []


def test_a_reader_never_sees_a_file_that_is_being_written(data, tmp_path, monkeypatch):
    path, seen = tmp_path / "data.nc", []
    to_netcdf = xr.Dataset.to_netcdf

    def watched(self, target, **options):
        to_netcdf(self, target, **options)
        seen.append(path.exists())

    monkeypatch.setattr(xr.Dataset, "to_netcdf", watched)
    dataset.write(data, path)
    assert seen == [False]
    assert path.exists()


@pytest.mark.parametrize("share", [0.0, 0.01, 0.3, 0.6, 0.9, 0.999])
def test_a_truncated_file_is_an_error_that_names_it(data, tmp_path, share):
    path = tmp_path / ("far" * 30) / "data.nc"
    path.parent.mkdir()
    dataset.write(data, path)
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(InputError, match=r"^dataset: got .*data\.nc.*allowed: a readable netCDF file"):
        dataset.load_dataset(path)


@pytest.mark.parametrize("length", [500, 50000])
def test_damage_to_the_numbers_is_an_error_whether_they_are_compressed_or_not(tmp_path, length):
    path = tmp_path / "data.nc"
    numbers = np.random.default_rng(0).normal(size=length)
    dataset.write(xr.Dataset({"heights": ("x", numbers)}), path)
    content = bytearray(path.read_bytes())
    place = len(content) * 6 // 10 if length > 2048 else content.index(numbers[250].tobytes())
    content[place] ^= 0xFF
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"^dataset: got .*data\.nc"):
        dataset.load_dataset(path)


@pytest.mark.parametrize("content", [None, b"", b"not a dataset"])
def test_what_is_no_dataset_is_an_error_that_names_it(tmp_path, content):
    path = tmp_path / "data.nc"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=r"^dataset: got .*data\.nc"):
        dataset.load_dataset(path)


def test_a_solver_has_no_option_named_like_a_key_of_a_surface_or_a_body():
    # Their dimensions would have one name, and the option the other's unit.
    for kind in SOLVERS:
        assert not set(keys_of(solver_class(kind))) & set(SETTINGS)


@pytest.mark.parametrize(
    ("control", "sliding_distance", "unit"),
    [("approach", False, "nm"), ("mean_pressure", False, "GPa"), ("mean_pressure", True, "nm")],
)
def test_values_along_a_path_are_in_the_unit_of_what_is_prescribed(control, sliding_distance, unit):
    data = xr.Dataset({"control": control}, {"snapshot": [0.1, 0.2], "increment": [0.1]})
    found = dataset.describe(data.assign(sliding_distance=("snapshot", [1.0, 2.0])) if sliding_distance else data)
    assert found.snapshot.attrs["units"] == found.increment.attrs["units"] == unit
