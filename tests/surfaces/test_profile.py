"""Measured profiles: every format gives the same heights, bad files are refused by name, and preparing keeps its word.

The files are written by each test; nothing but public functions is used.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactsim.errors import InputError
from contactsim.surfaces.io import UNITS
from contactsim.surfaces.preparation import DETREND, PERIODIC, prepare
from contactsim.surfaces.profile import Profile, read_profile
from support.cases import refusal

SPACING = 2.5
HEIGHTS = np.array([0.0, 1.5, -2.25, 3.0, 0.5, -1.0])
POSITIONS = 100.0 + SPACING * np.arange(HEIGHTS.size)


def text_file(folder: Path, *columns: np.ndarray, name: str = "p.csv", head: str = "", mark: str = ",") -> Path:
    """Write columns of numbers under a header."""
    file = folder / name
    rows = [mark.join(repr(float(value)) for value in row) for row in zip(*columns, strict=True)]
    file.write_text("\n".join(([head] if head else []) + rows) + "\n", encoding="utf-8")
    return file


def lines_file(folder: Path, *lines: str) -> Path:
    """Write lines as they are."""
    file = folder / "p.txt"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def npy_file(folder: Path, values: object) -> Path:
    """Write an array."""
    file = folder / "p.npy"
    np.save(file, np.asarray(values))
    return file


Columns = dict[str, tuple[np.ndarray, str | None]]


def nc_file(folder: Path, columns: Columns, dimension: str = "x", **attributes: str) -> Path:
    """Write named 1D variables (values, units) on one dimension; attributes go to the last."""
    file = folder / "p.nc"
    with netCDF4.Dataset(str(file), "w") as data:
        data.createDimension(dimension, len(next(iter(columns.values()))[0]))
        for name, (values, units) in columns.items():
            made = data.createVariable(name, values.dtype, (dimension,))
            made[:] = values
            if units is not None:
                made.units = units
        for name, value in attributes.items():
            setattr(made, name, value)
    return file


def same(profile: Profile, spacing: float = SPACING) -> None:
    """Assert that a profile is HEIGHTS at a spacing, to rounding."""
    np.testing.assert_allclose(profile.heights, HEIGHTS, rtol=1e-12)
    assert profile.heights.dtype == np.float64
    assert profile.spacing == pytest.approx(spacing, rel=1e-12)


# --- the formats agree ------------------------------------------------------------------------------------------


def write_npy(folder: Path) -> Path:
    """Heights only."""
    return npy_file(folder, HEIGHTS)


def write_one_column(folder: Path) -> Path:
    """Heights only."""
    return text_file(folder, HEIGHTS, head="z [nm]")


def write_two_columns(folder: Path) -> Path:
    """Positions and heights."""
    return text_file(folder, POSITIONS, HEIGHTS, head="x [nm], z [nm]")


def write_three_columns(folder: Path) -> Path:
    """A line scan along x."""
    return text_file(folder, POSITIONS, 0 * HEIGHTS + 7, HEIGHTS, name="p.xyz", head="x [nm] y [nm] z [nm]", mark=" ")


def write_scan_along_y(folder: Path) -> Path:
    """A line scan along y."""
    return text_file(
        folder, 0 * HEIGHTS + 7, POSITIONS, HEIGHTS, name="p.dat", head="x (nm)\ty (nm)\tz (nm)", mark="\t"
    )


def write_nc(folder: Path) -> Path:
    """A variable and its coordinate."""
    return nc_file(folder, {"x": (POSITIONS, "nm"), "heights": (HEIGHTS, "nm")})


def write_nc_alone(folder: Path) -> Path:
    """A variable without coordinate."""
    return nc_file(folder, {"heights": (HEIGHTS, "nm")})


WRITERS = [
    write_npy,
    write_one_column,
    write_two_columns,
    write_three_columns,
    write_scan_along_y,
    write_nc,
    write_nc_alone,
]


@pytest.mark.parametrize("write", WRITERS)
def test_every_format_gives_the_same_profile(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    file = write(tmp_path)
    profile = read_profile(file, spacing=SPACING)
    same(profile)
    assert profile.source == str(file)


@pytest.mark.parametrize("write", WRITERS)
def test_a_path_may_be_a_string_and_its_suffix_in_capitals(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    file = write(tmp_path)
    loud = file.rename(file.with_suffix(file.suffix.upper()))
    same(read_profile(str(loud), spacing=SPACING))


@pytest.mark.parametrize("suffix", [".csv", ".txt", ".xyz", ".dat"])
@pytest.mark.parametrize("mark", [",", ";", "\t", " ", " , ", "   ", " \t "])
def test_any_separator_is_found_in_any_text_file(tmp_path: Path, suffix: str, mark: str) -> None:
    same(read_profile(text_file(tmp_path, POSITIONS, HEIGHTS, name=f"p{suffix}", mark=mark), unit="nm"))


@pytest.mark.parametrize("mark", [",", ";", "\t", " "])
def test_a_separator_may_be_given(tmp_path: Path, mark: str) -> None:
    same(read_profile(text_file(tmp_path, POSITIONS, HEIGHTS, mark=mark), unit="nm", delimiter=mark))


def test_a_separator_given_is_the_only_one_used(tmp_path: Path) -> None:
    file = text_file(tmp_path, POSITIONS, HEIGHTS, mark=";")
    refusal("line 1", file, lambda: read_profile(file, unit="nm", delimiter=","))


def test_comments_blank_lines_and_a_byte_order_mark_are_skipped(tmp_path: Path) -> None:
    rows = [f"{x},{z}" for x, z in zip(POSITIONS, HEIGHTS, strict=True)]
    file = lines_file(
        tmp_path, "\ufeff# AFM [raw]", "", '"x [nm]","z [nm]"', "# here", *rows[:3], "  ", "#1,2", *rows[3:]
    )
    same(read_profile(file))


def test_descending_positions_are_reversed_with_their_heights(tmp_path: Path) -> None:
    same(read_profile(text_file(tmp_path, POSITIONS[::-1], HEIGHTS[::-1]), unit="nm"))
    same(read_profile(nc_file(tmp_path, {"x": (POSITIONS[::-1], "nm"), "z": (HEIGHTS[::-1], "nm")})))


def test_positions_off_by_less_than_a_thousandth_of_the_spacing_count_as_equal(tmp_path: Path) -> None:
    wobble = POSITIONS + SPACING * 4e-4 * np.array([0, 1, -1, 1, -1, 0])
    same(read_profile(text_file(tmp_path, wobble, HEIGHTS), unit="nm"))


def test_a_spacing_that_agrees_with_the_positions_is_accepted_and_theirs_used(tmp_path: Path) -> None:
    same(read_profile(text_file(tmp_path, POSITIONS, HEIGHTS), unit="nm", spacing=SPACING * 1.0005))


@pytest.mark.parametrize("kind", ["<f4", ">f8", "<i2", ">u2", "f2"])
def test_numbers_of_any_kind_become_float64(tmp_path: Path, kind: str) -> None:
    profile = read_profile(npy_file(tmp_path, np.array([3, 1, 2]).astype(kind)), spacing=np.float32(2))
    assert profile.heights.tolist() == [3.0, 1.0, 2.0]
    assert profile.heights.dtype == np.dtype("float64")
    assert type(profile.spacing) is float


# --- units ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("unit", "scale"), [*UNITS.items(), ("\u00b5m", 1e3)])
def test_a_file_in_any_unit_equals_the_file_in_nm(tmp_path: Path, unit: str, scale: float) -> None:
    x, z = POSITIONS / scale, HEIGHTS / scale
    same(read_profile(text_file(tmp_path, x, z, head=f"x [{unit}], z [{unit}]")))
    same(read_profile(text_file(tmp_path, x, z), unit=unit))
    same(read_profile(npy_file(tmp_path, z), unit=unit, spacing=SPACING))
    same(read_profile(nc_file(tmp_path, {"x": (x, unit), "z": (z, unit)})))
    same(read_profile(nc_file(tmp_path, {"x": (x, None), "z": (z, None)}), unit=unit))


def test_the_units_are_lengths_in_nm() -> None:
    known = {"m": 1e9, "mm": 1e6, "um": 1e3, "\u03bcm": 1e3, "micrometer": 1e3, "nm": 1.0, "angstrom": 0.1}
    assert known == UNITS


def test_each_column_has_the_unit_of_its_own_header(tmp_path: Path) -> None:
    same(read_profile(text_file(tmp_path, POSITIONS / 1e3, HEIGHTS, head="x [um], z [nm]")))
    same(read_profile(text_file(tmp_path, 0 * HEIGHTS, POSITIONS, HEIGHTS / 1e6, head="x (m);y (nm);z (mm)")))
    same(read_profile(nc_file(tmp_path, {"x": (POSITIONS / 1e9, "m"), "z": (HEIGHTS * 10, "angstrom")})))


def test_a_unit_given_serves_the_variable_that_states_none(tmp_path: Path) -> None:
    same(read_profile(nc_file(tmp_path, {"x": (POSITIONS / 1e3, "um"), "z": (HEIGHTS, None)}), unit="nm"))
    same(read_profile(nc_file(tmp_path, {"x": (POSITIONS, None), "z": (HEIGHTS, "nm")}), unit="nm"))


def test_a_header_without_units_leaves_them_to_the_caller(tmp_path: Path) -> None:
    same(read_profile(text_file(tmp_path, POSITIONS / 1e3, HEIGHTS / 1e3, head="position,height"), unit="um"))


def test_the_micro_sign_of_a_latin1_file_is_understood(tmp_path: Path) -> None:
    file = text_file(tmp_path, POSITIONS / 1e3, HEIGHTS / 1e3, head="x [\u00b5m], z [\u00b5m]")
    file.write_bytes(file.read_text(encoding="utf-8").encode("latin-1"))
    same(read_profile(file))


def test_a_spacing_given_is_nm_whatever_the_unit_of_the_heights(tmp_path: Path) -> None:
    same(read_profile(text_file(tmp_path, HEIGHTS / 1e3), unit="um", spacing=SPACING))


def test_npy_heights_are_nm_unless_told(tmp_path: Path) -> None:
    same(read_profile(npy_file(tmp_path, HEIGHTS), spacing=SPACING))


def test_a_unit_nobody_gives_is_refused(tmp_path: Path) -> None:
    for file in (
        text_file(tmp_path, POSITIONS, HEIGHTS),
        text_file(tmp_path, POSITIONS, HEIGHTS, head="# x [nm], z [nm]", name="comment.csv"),
        nc_file(tmp_path, {"x": (POSITIONS, "nm"), "z": (HEIGHTS, None)}),
    ):
        error = refusal("unit", file, lambda file=file: read_profile(file))
        assert error.value is None
        assert "angstrom" in error.allowed and "`unit`" in error.allowed


def test_a_coordinate_without_unit_is_refused(tmp_path: Path) -> None:
    file = nc_file(tmp_path, {"x": (POSITIONS, None), "z": (HEIGHTS, "nm")})
    assert refusal("unit", file, lambda: read_profile(file)).allowed.startswith("for x ")


@pytest.mark.parametrize("unit", ["furlong", "Mm", "s", "", " "])
def test_an_unknown_unit_is_refused_wherever_it_stands(tmp_path: Path, unit: str) -> None:
    plain = text_file(tmp_path, POSITIONS, HEIGHTS)
    headed = text_file(tmp_path, POSITIONS, HEIGHTS, head=f"x [nm], z [{unit}]", name="headed.csv")
    npy = npy_file(tmp_path, HEIGHTS)
    nc = nc_file(tmp_path, {"x": (POSITIONS, unit), "z": (HEIGHTS, "nm")})
    for file, call in (
        (plain, lambda: read_profile(plain, unit=unit)),
        (headed, lambda: read_profile(headed)),
        (npy, lambda: read_profile(npy, unit=unit, spacing=SPACING)),
        (nc, lambda: read_profile(nc)),
    ):
        assert "nm" in refusal("unit", file, call).allowed


def test_a_unit_that_is_no_text_is_refused(tmp_path: Path) -> None:
    file = npy_file(tmp_path, HEIGHTS)
    assert refusal("unit", file, lambda: read_profile(file, unit=3, spacing=SPACING)).value == "3"


def test_a_unit_that_contradicts_that_of_the_heights_is_refused(tmp_path: Path) -> None:
    text = text_file(tmp_path, POSITIONS, HEIGHTS, head="x [um], z [nm]")
    nc = nc_file(tmp_path, {"x": (POSITIONS, "um"), "z": (HEIGHTS, "nm")})
    for file in (text, nc):
        error = refusal("unit", file, lambda file=file: read_profile(file, unit="um"))
        assert error.value == "um" and "nm" in error.allowed


def test_a_header_with_units_for_some_columns_only_is_refused(tmp_path: Path) -> None:
    file = text_file(tmp_path, POSITIONS, HEIGHTS, head="x, z [nm]")
    assert refusal("line 1", file, lambda: read_profile(file, unit="nm")).value == "x, z [nm]"


# --- netCDF variables -------------------------------------------------------------------------------------------


def test_the_named_variable_is_read(tmp_path: Path) -> None:
    file = nc_file(tmp_path, {"x": (POSITIONS, "nm"), "a": (HEIGHTS, "nm"), "height": (HEIGHTS + 1, "nm")})
    same(read_profile(file, variable="a"))


def test_the_only_float_variable_beside_the_coordinate_is_read(tmp_path: Path) -> None:
    flags = np.arange(HEIGHTS.size, dtype="i4")
    same(read_profile(nc_file(tmp_path, {"x": (POSITIONS, "nm"), "flag": (flags, None), "trace": (HEIGHTS, "nm")})))


@pytest.mark.parametrize("name", ["heights", "height", "z"])
def test_of_several_variables_the_one_named_like_heights_is_read(tmp_path: Path, name: str) -> None:
    file = nc_file(tmp_path, {"x": (POSITIONS, "nm"), "quality": (HEIGHTS + 1, "nm"), name: (HEIGHTS, "nm")})
    same(read_profile(file))


def test_a_coordinate_may_be_named_by_the_attribute(tmp_path: Path) -> None:
    columns: Columns = {"where": (POSITIONS, "nm"), "trace": (HEIGHTS, "nm")}
    same(read_profile(nc_file(tmp_path, columns, dimension="i", coordinates="where")))


def test_a_coordinate_of_another_dimension_gives_no_positions(tmp_path: Path) -> None:
    file = nc_file(tmp_path, {"trace": (HEIGHTS, "nm")}, coordinates="time")
    with netCDF4.Dataset(str(file), "a") as data:
        data.createDimension("t", 2)
        data.createVariable("time", "f8", ("t",))[:] = [0.0, 1.0]
    same(read_profile(file, spacing=SPACING))


def test_packed_heights_are_unpacked(tmp_path: Path) -> None:
    file = tmp_path / "p.nc"
    with netCDF4.Dataset(str(file), "w") as data:
        data.createDimension("x", HEIGHTS.size)
        packed = data.createVariable("z", "i2", ("x",))
        packed.scale_factor, packed.units = 0.25, "nm"
        packed[:] = HEIGHTS
    same(read_profile(file, spacing=SPACING))


def test_missing_netcdf_values_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "p.nc"
    with netCDF4.Dataset(str(file), "w") as data:
        data.createDimension("x", 4)
        made = data.createVariable("z", "f8", ("x",), fill_value=-999.0)
        made.units = "nm"
        made[:] = np.array([1.0, 2.0, -999.0, 4.0])
    error = refusal("z", file, lambda: read_profile(file, spacing=1))
    assert error.value == "nan in row 3"


@pytest.mark.parametrize("variable", ["y", "", 3])
def test_a_variable_not_in_the_file_is_refused_with_those_that_are(tmp_path: Path, variable: object) -> None:
    file = nc_file(tmp_path, {"x": (POSITIONS, "nm"), "trace": (HEIGHTS, "nm")})
    error = refusal("variable", file, lambda: read_profile(file, variable=variable))
    assert error.value == variable and "'trace'" in error.allowed


@pytest.mark.parametrize("names", [("a", "b"), ("height", "z")])
def test_heights_that_cannot_be_told_apart_are_refused(tmp_path: Path, names: tuple[str, str]) -> None:
    file = nc_file(tmp_path, dict.fromkeys(names, (HEIGHTS, "nm")))
    error = refusal("variable", file, lambda: read_profile(file, spacing=SPACING))
    assert all(name in error.allowed for name in names)


def test_a_map_in_netcdf_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "p.nc"
    with netCDF4.Dataset(str(file), "w") as data:
        data.createDimension("x", 3)
        data.createVariable("x", "f8", ("x",))[:] = np.arange(3.0)
        data.createVariable("heights", "f8", ("x", "x"))[:] = np.eye(3)
    for variable in (None, "heights"):
        error = refusal("variable", file, lambda variable=variable: read_profile(file, variable=variable, unit="nm"))
        assert "1D" in error.allowed


def test_netcdf_text_is_refused(tmp_path: Path) -> None:
    file = nc_file(tmp_path, {"z": (np.array([b"a", b"b", b"c"], dtype="S1"), "nm")})
    refusal("z", file, lambda: read_profile(file, spacing=1))


# --- bad files --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["p.npy", "p.csv", "p.nc", "p.tif"])
def test_a_missing_file_is_refused(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    assert refusal("path", file, lambda: read_profile(file, spacing=1)).value == file


@pytest.mark.parametrize("path", [None, 3, ["p.csv"]])
def test_a_path_that_is_none_is_refused(path: object) -> None:
    with pytest.raises(InputError, match=r"path: got .*; allowed: an existing file") as caught:
        read_profile(path)
    assert caught.value.value == path


def test_a_folder_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "p.csv"
    folder.mkdir()
    refusal("path", folder, lambda: read_profile(folder, spacing=1))


@pytest.mark.parametrize("name", ["p.tif", "p.npz", "p", "p.csv.gz"])
def test_an_unknown_suffix_is_refused_with_the_known_ones(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_text("1\n2\n")
    error = refusal("path", file, lambda: read_profile(file, spacing=1))
    assert error.value == name
    assert all(suffix in error.allowed for suffix in (".npy", ".csv", ".txt", ".xyz", ".dat", ".nc"))


@pytest.mark.parametrize("suffix", [".npy", ".nc"])
@pytest.mark.parametrize("content", [b"", b"1\n2\n3\n", b"\x93NUMPY\x01\x00", b"\x89HDF\r\n\x1a\n", b"CDF\x01"])
def test_a_file_that_is_not_what_its_suffix_says_is_refused(tmp_path: Path, suffix: str, content: bytes) -> None:
    file = tmp_path / f"p{suffix}"
    file.write_bytes(content)
    error = refusal("path", file, lambda: read_profile(file, spacing=1))
    assert error.value == str(file) and suffix in error.allowed


def test_a_truncated_npy_file_is_refused(tmp_path: Path) -> None:
    file = npy_file(tmp_path, HEIGHTS)
    file.write_bytes(file.read_bytes()[:-4])
    refusal("path", file, lambda: read_profile(file, spacing=1))


def test_pickled_objects_are_never_loaded(tmp_path: Path) -> None:
    file = npy_file(tmp_path, np.array([1, None], dtype=object))
    refusal("path", file, lambda: read_profile(file, spacing=1))


@pytest.mark.parametrize("values", [["a", "b"], [True, False], [1j, 2j], [[1.0, 2.0], [3.0, 4.0]], 5.0, [1.0], []])
def test_arrays_other_than_two_or_more_real_numbers_in_1d_are_refused(tmp_path: Path, values: object) -> None:
    file = npy_file(tmp_path, values)
    error = refusal("heights", file, lambda: read_profile(file, spacing=1))
    assert str(np.asarray(values).shape) in str(error.value)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_heights_that_are_not_finite_are_refused_with_their_row(tmp_path: Path, bad: float) -> None:
    values = HEIGHTS.copy()
    values[3] = bad
    for file in (npy_file(tmp_path, values), text_file(tmp_path, values)):
        error = refusal("heights", file, lambda file=file: read_profile(file, spacing=1, unit="nm"))
        assert error.value == f"{bad} in row 4"


def test_a_first_row_that_is_not_finite_is_not_taken_for_a_header(tmp_path: Path) -> None:
    file = lines_file(tmp_path, "nan", "1", "2")
    assert refusal("heights", file, lambda: read_profile(file, spacing=1, unit="nm")).value == "nan in row 1"


def test_numbers_too_large_for_nm_are_refused(tmp_path: Path) -> None:
    file = npy_file(tmp_path, [1e305, 0.0])
    assert refusal("heights", file, lambda: read_profile(file, spacing=1, unit="m")).value == "inf in row 1"


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_positions_that_are_not_finite_are_refused(tmp_path: Path, bad: float) -> None:
    places = POSITIONS.copy()
    places[1] = bad
    text = text_file(tmp_path, places, HEIGHTS)
    refusal("positions", text, lambda: read_profile(text, unit="nm"))
    nc = nc_file(tmp_path, {"x": (places, "nm"), "z": (HEIGHTS, "nm")})
    refusal("x", nc, lambda: read_profile(nc))


@pytest.mark.parametrize("lines", [[], ["# only this"], ["z [nm]"], ["z [nm]", "1.0"], ["1.0"]])
def test_fewer_than_two_rows_are_refused(tmp_path: Path, lines: list[str]) -> None:
    file = lines_file(tmp_path, *lines)
    assert "two or more" in refusal("heights", file, lambda: read_profile(file, unit="nm", spacing=1)).allowed


BAD_ROWS = ["2,abc", "2,", "2", "2,3,4", "2;3", "2 3", "2,3 # why", "1_0,2", "x [nm], z [nm]", "2,1.O5"]


@pytest.mark.parametrize("row", BAD_ROWS)
def test_a_row_that_does_not_parse_is_refused_with_its_line(tmp_path: Path, row: str) -> None:
    file = lines_file(tmp_path, "# comment", "x [nm], z [nm]", "0,1", "", "1,1", row, "3,1")
    error = refusal("line 6", file, lambda: read_profile(file))
    assert error.value == row


@pytest.mark.parametrize("row", ["1.O5", "1,5;2,3", "1;2;3;4", "[nm]", "-"])
def test_a_first_row_that_does_not_parse_is_not_taken_for_a_header(tmp_path: Path, row: str) -> None:
    file = lines_file(tmp_path, row, "1", "2", "3")
    assert refusal("line 1", file, lambda: read_profile(file, unit="nm", spacing=1)).value == row


def test_more_than_three_columns_are_refused(tmp_path: Path) -> None:
    file = text_file(tmp_path, POSITIONS, POSITIONS, HEIGHTS, HEIGHTS)
    refusal("line 1", file, lambda: read_profile(file, unit="nm"))


def test_unequal_spacing_is_refused_with_the_largest_deviation_and_its_row(tmp_path: Path) -> None:
    places = POSITIONS.copy()
    places[4:] += 5.0  # mean step 3.5, the step from row 4 to 5 is 7.5
    text = text_file(tmp_path, places, HEIGHTS)
    nc = nc_file(tmp_path, {"x": (places, "nm"), "z": (HEIGHTS, "nm")})
    for file in (text, nc):
        error = refusal("positions", file, lambda file=file: read_profile(file, unit="nm"))
        assert error.value == "4 nm off the mean step 3.5 nm from row 4 to 5"
        assert "0.001" in error.allowed


def test_a_deviation_just_over_a_thousandth_of_the_spacing_is_refused(tmp_path: Path) -> None:
    places = POSITIONS.copy()
    places[2] += 1.1e-3 * SPACING
    file = text_file(tmp_path, places, HEIGHTS)
    refusal("positions", file, lambda: read_profile(file, unit="nm"))


def test_positions_that_stand_still_are_refused(tmp_path: Path) -> None:
    two = text_file(tmp_path, 0 * HEIGHTS, HEIGHTS)
    refusal("positions", two, lambda: read_profile(two, unit="nm"))
    three = text_file(tmp_path, 0 * HEIGHTS, 0 * HEIGHTS, HEIGHTS)
    refusal("positions", three, lambda: read_profile(three, unit="nm"))


def test_a_scan_along_neither_axis_is_refused(tmp_path: Path) -> None:
    file = text_file(tmp_path, POSITIONS, 2 * POSITIONS, HEIGHTS)
    assert "line scan" in refusal("positions", file, lambda: read_profile(file, unit="nm")).allowed


# --- bad settings -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("write", [write_npy, write_one_column, write_nc_alone])
def test_a_file_without_positions_needs_a_spacing(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    file = write(tmp_path)
    assert refusal("spacing", file, lambda: read_profile(file)).value is None


@pytest.mark.parametrize("write", WRITERS)
@pytest.mark.parametrize("spacing", [0, -1.0, np.nan, np.inf, "2.5", True, [2.5], 1j, np.array([2.5, 2.5])])
def test_a_spacing_that_is_no_positive_number_is_refused(
    tmp_path: Path, write: Callable[[Path], Path], spacing: object
) -> None:
    file = write(tmp_path)
    assert refusal("spacing", file, lambda: read_profile(file, spacing=spacing)).value is spacing


@pytest.mark.parametrize("write", [write_two_columns, write_three_columns, write_scan_along_y, write_nc])
@pytest.mark.parametrize("factor", [0.99, 1.01, 1000])
def test_a_spacing_that_contradicts_the_positions_is_refused(
    tmp_path: Path, write: Callable[[Path], Path], factor: float
) -> None:
    file = write(tmp_path)
    error = refusal("spacing", file, lambda: read_profile(file, spacing=SPACING * factor))
    assert error.value == SPACING * factor and "2.5 nm" in error.allowed


@pytest.mark.parametrize("delimiter", ["", "|", ", ", 3])
def test_an_unknown_separator_is_refused(tmp_path: Path, delimiter: object) -> None:
    file = write_two_columns(tmp_path)
    assert refusal("delimiter", file, lambda: read_profile(file, delimiter=delimiter)).value == delimiter


def test_settings_of_another_format_are_refused_not_ignored(tmp_path: Path) -> None:
    npy, text, nc = write_npy(tmp_path), write_one_column(tmp_path), write_nc(tmp_path)
    for file in (npy, text):
        error = refusal("variable", file, lambda file=file: read_profile(file, spacing=SPACING, variable="z"))
        assert error.value == "z" and ".nc" in error.allowed
    for file in (npy, nc):
        error = refusal("delimiter", file, lambda file=file: read_profile(file, spacing=SPACING, delimiter=","))
        assert error.value == "," and ".csv" in error.allowed


def test_a_profile_made_by_hand_is_checked_too() -> None:
    refusal("heights", "mine", lambda: Profile(np.array([1.0, np.nan]), 1.0, "mine"))
    refusal("heights", "mine", lambda: Profile(np.eye(2), 1.0, "mine"))
    refusal("heights", "mine", lambda: Profile(np.ma.array([1.0, 2.0], mask=[0, 1]), 1.0, "mine"))
    refusal("spacing", "mine", lambda: Profile(HEIGHTS, 0.0, "mine"))


def test_a_profile_owns_its_heights() -> None:
    mine = HEIGHTS.copy()
    profile = Profile(mine, SPACING, "mine")
    mine[:] = 0
    assert profile.heights.tolist() == HEIGHTS.tolist()


# --- preparing --------------------------------------------------------------------------------------------------

DEGREES = {"mean": 0, "linear": 1, "quadratic": 2}
signed = st.floats(-1, 1)
amplitudes = st.floats(-9, 9).map(lambda power: 10.0**power)
lists = st.lists(st.floats(-1e9, 1e9), min_size=2, max_size=40).map(np.array)


def detrend(heights: np.ndarray, kind: str) -> np.ndarray:
    """Heights of a profile that is only detrended."""
    return prepare(Profile(heights, SPACING, "mine"), detrend=kind, periodic="none").heights


def make_periodic(heights: np.ndarray, kind: str) -> np.ndarray:
    """Heights of a profile that is only made periodic."""
    return prepare(Profile(heights, SPACING, "mine"), detrend="none", periodic=kind).heights


def mean_square_slope(heights: np.ndarray, *, periodic: bool) -> float:
    """Mean square of the steps, at spacing one."""
    return float(np.mean(np.diff(heights, append=heights[:1] if periodic else heights[:0]) ** 2))


@given(st.sampled_from(list(DEGREES)), st.integers(2, 3000), st.tuples(signed, signed, signed), amplitudes)
def test_detrending_removes_any_polynomial_of_its_degree(
    kind: str, n: int, coefficients: tuple[float, float, float], amplitude: float
) -> None:
    form = amplitude * np.polynomial.Polynomial(coefficients[: DEGREES[kind] + 1])(np.linspace(0, 1, n))
    assert np.abs(detrend(form, kind)).max() <= 1e-13 * amplitude


@given(st.sampled_from(list(DEGREES)), lists)
def test_what_detrending_leaves_has_no_trend_and_is_what_a_fit_leaves(kind: str, heights: np.ndarray) -> None:
    u = np.linspace(-1, 1, heights.size)
    degree = min(DEGREES[kind], heights.size - 1)
    fit = np.polynomial.Polynomial.fit(u, heights, degree, domain=[-1, 1])
    rounding = 1e-12 * np.abs(heights).max() + np.finfo(float).tiny  # below it numbers have fewer digits
    left = detrend(heights, kind)
    np.testing.assert_allclose(left, heights - fit(u), rtol=0, atol=rounding)
    np.testing.assert_allclose(detrend(left, kind), left, rtol=0, atol=rounding)


def test_a_trend_is_removed_and_the_roughness_kept() -> None:
    u = np.linspace(-1, 1, 1001)
    rough = np.cos(40 * np.pi * u)
    left = detrend(rough + 1e3 * u**2 - 500 * u + 7, "quadratic")
    assert np.abs(left - rough).max() < 0.02
    assert np.abs(detrend(rough + 1e3 * u**2, "linear") - rough).max() > 300


@given(lists)
def test_none_changes_nothing_and_gives_a_copy(heights: np.ndarray) -> None:
    for result in (detrend(heights, "none"), make_periodic(heights, "none")):
        assert result.tolist() == heights.tolist()
        assert not np.shares_memory(result, heights)


@given(lists)
def test_mirror_keeps_every_height_and_is_periodic_without_doubled_ends(heights: np.ndarray) -> None:
    n = heights.size
    result = make_periodic(heights, "mirror")
    assert result.size == 2 * n - 2
    assert result[:n].tolist() == heights.tolist()
    around = np.append(result, result[0])
    assert around[n - 1 :].tolist() == heights[::-1].tolist()


@given(lists)
def test_mirror_keeps_the_rms_slope(heights: np.ndarray) -> None:
    kept = mean_square_slope(make_periodic(heights, "mirror"), periodic=True)
    assert kept == pytest.approx(mean_square_slope(heights, periodic=False), rel=1e-9)


@given(lists)
def test_tilt_keeps_n_and_closes_the_seam(heights: np.ndarray) -> None:
    result = make_periodic(heights, "tilt")
    assert result.size == heights.size
    assert result[0] == result[-1] == 0
    line = heights - result
    assert np.abs(np.diff(line, n=2)).max(initial=0) <= 1e-14 * 8 * np.abs(heights).max()


@given(lists)
def test_tilt_takes_the_squared_slope_of_its_line(heights: np.ndarray) -> None:
    before = mean_square_slope(heights, periodic=False)
    line = (heights[-1] - heights[0]) / (heights.size - 1)
    after = mean_square_slope(make_periodic(heights, "tilt"), periodic=False)
    rounding = 1e-12 * float(np.abs(heights).max()) ** 2 + np.finfo(float).tiny
    assert after == pytest.approx(before - line**2, abs=rounding)


def test_none_leaves_the_step_at_the_seam_in_the_slope() -> None:
    ramp = np.arange(100.0)
    assert mean_square_slope(make_periodic(ramp, "none"), periodic=True) == pytest.approx((99 + 99**2) / 100)


@given(lists)
def test_window_keeps_n_and_is_zero_at_both_ends(heights: np.ndarray) -> None:
    result = make_periodic(heights, "window")
    assert result.size == heights.size
    assert result[0] == result[-1] == 0


def test_window_leaves_the_middle_and_halves_halfway_up_the_taper() -> None:
    heights = 5.0 + np.array([1.0, -1.0] * 100 + [0.0])
    result = make_periodic(heights, "window")
    np.testing.assert_allclose(result[20:181], (heights - 5)[20:181], rtol=1e-12)
    assert result[10] == pytest.approx(0.5)
    assert np.all(np.abs(result[1:20]) < 1)
    np.testing.assert_allclose(np.abs(result[:100]), np.abs(result[:100:-1]), atol=0.02)


def test_window_takes_an_eighth_of_the_mean_square_slope_of_short_waves() -> None:
    heights = np.random.default_rng(1).standard_normal(200_000)
    before = mean_square_slope(heights, periodic=True)
    after = mean_square_slope(make_periodic(heights, "window"), periodic=True)
    assert after / before == pytest.approx(0.875, abs=0.005)


@given(st.sampled_from(list(DETREND[1])), st.sampled_from(list(PERIODIC[1])), lists)
def test_preparing_detrends_then_makes_periodic(kind: str, periodic: str, heights: np.ndarray) -> None:
    result = prepare(Profile(heights, SPACING, "mine"), detrend=kind, periodic=periodic)
    assert result.heights.tolist() == make_periodic(detrend(heights, kind), periodic).tolist()
    assert (result.spacing, result.source) == (SPACING, "mine")


def test_preparing_takes_a_line_and_mirrors_unless_told() -> None:
    profile = Profile(HEIGHTS, SPACING, "mine")
    expected = prepare(profile, detrend="linear", periodic="mirror")
    assert prepare(profile).heights.tolist() == expected.heights.tolist()
    assert profile.heights.tolist() == HEIGHTS.tolist()


@pytest.mark.parametrize("kind", ["cubic", "", 1, ["mean"], "Linear"])
def test_unknown_kinds_are_refused_with_the_known_ones(kind: object) -> None:
    profile = Profile(HEIGHTS, SPACING, "mine")
    for key, known, call in (
        ("detrend", DETREND[1], lambda: prepare(profile, detrend=kind)),
        ("periodic", PERIODIC[1], lambda: prepare(profile, periodic=kind)),
    ):
        error = refusal(key, "mine", call)
        assert error.value == kind
        assert error.allowed == f"one of {', '.join(known)}"


@pytest.mark.parametrize("heights", [[1.0], [], [1.0, np.nan], [[1.0, 2.0]], ["a", "b"], 3.0])
def test_heights_that_are_no_profile_are_refused(heights: object) -> None:
    with pytest.raises(InputError, match=r"^mine: heights: got "):
        Profile(heights, SPACING, "mine")
