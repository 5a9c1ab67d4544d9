"""Topographies: every format gives the same heights, bad files are refused by name, and preparing keeps its word.

The files are written by each test; nothing but public functions is used. Files of instruments go through a stub of the
library that reads them, and through the library itself where it is installed.
"""

from __future__ import annotations

import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace

import netCDF4
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from contactsim import dataset
from contactsim.errors import InputError
from contactsim.status import Status
from contactsim.study import execute
from contactsim.study.execute import RunFiles
from contactsim.study.reading import keys_of, read
from contactsim.study.study import Study
from contactsim.surfaces import profile
from contactsim.surfaces.io import UNITS
from contactsim.surfaces.measured import SURFACES, MeasuredSurface
from contactsim.surfaces.preparation import DETREND, PERIODIC, prepare
from contactsim.surfaces.topography import Topography, read_topography
from support.cases import refusal

DY, DX = SPACING = (2.5, 0.5)
HEIGHTS = np.array([[0.0, 1.5, -2.25, 3.0], [0.5, -1.0, 8.0, 4.0], [7.0, 6.0, 5.5, -9.0]])
NY, NX = HEIGHTS.shape
Y, X = 100.0 + DY * np.arange(NY), -3.0 + DX * np.arange(NX)


def lines_file(folder: Path, *lines: str, name: str = "t.csv") -> Path:
    """Write lines as they are."""
    file = folder / name
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def grid_file(folder: Path, heights: np.ndarray = HEIGHTS, *head: str, name: str = "t.csv", mark: str = ",") -> Path:
    """Write heights as rows and columns under a header."""
    rows = [mark.join(repr(float(z)) for z in row) for row in heights]
    return lines_file(folder, *head, *rows, name=name)


def points(heights: np.ndarray = HEIGHTS, y: np.ndarray = Y, x: np.ndarray = X) -> np.ndarray:
    """The points of a grid as rows x y z."""
    return np.stack([*np.meshgrid(x, y), heights], axis=-1).reshape(-1, 3)


def xyz_file(folder: Path, rows: np.ndarray, *head: str) -> Path:
    """Write rows x y z under a header."""
    return grid_file(folder, rows, *head, name="t.xyz", mark=" ")


def npy_file(folder: Path, values: object) -> Path:
    """Write an array."""
    file = folder / "t.npy"
    np.save(file, np.asarray(values))
    return file


def nc_file(
    folder: Path,
    heights: np.ndarray = HEIGHTS,
    units: str | None = "nm",
    places: dict[str, tuple[np.ndarray, str | None]] | None = None,
    order: tuple[str, str] = ("y", "x"),
    name: str = "heights",
    **attributes: str,
) -> Path:
    """Write a 2D variable on dimensions `order` with 1D coordinates (values, units)."""
    file = folder / "t.nc"
    with netCDF4.Dataset(str(file), "w") as data:
        for dimension, size in zip(order, heights.shape, strict=True):
            data.createDimension(dimension, size)
        columns = {"y": (Y, "nm"), "x": (X, "nm")} if places is None else places
        for at, (values, stated) in columns.items():
            dimension = at if at in order else next(each for each in order if data.dimensions[each].size == values.size)
            made = data.createVariable(at, "f8", (dimension,))
            made[:] = values
            if stated is not None:
                made.units = stated
        made = data.createVariable(name, "f8", order, fill_value=-999.0)
        made[:] = heights
        if units is not None:
            made.units = units
        made.setncatts(attributes)
    return file


def same(topography: Topography, heights: np.ndarray = HEIGHTS) -> None:
    """Assert that a topography is HEIGHTS at SPACING, to rounding."""
    np.testing.assert_allclose(topography.heights, heights, rtol=1e-12)
    assert topography.heights.dtype == np.float64
    assert topography.spacing == pytest.approx(SPACING, rel=1e-12)
    assert [type(step) for step in topography.spacing] == [float, float]


# --- the formats agree ------------------------------------------------------------------------------------------


def write_csv(folder: Path) -> Path:
    return grid_file(folder)


def write_txt(folder: Path) -> Path:
    return grid_file(folder, name="t.txt", mark=" ")


def write_dat(folder: Path) -> Path:
    return grid_file(folder, name="t.dat", mark="\t")


def write_npy(folder: Path) -> Path:
    return npy_file(folder, HEIGHTS)


def write_xyz(folder: Path) -> Path:
    return xyz_file(folder, points())


def write_nc(folder: Path) -> Path:
    return nc_file(folder)


def write_nc_alone(folder: Path) -> Path:
    return nc_file(folder, places={})


PLACELESS = [write_csv, write_txt, write_dat, write_npy, write_nc_alone]
PLACED = [write_xyz, write_nc]


@pytest.mark.parametrize("write", [*PLACELESS, *PLACED])
def test_every_format_gives_the_same_topography(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    file = write(tmp_path)
    topography = read_topography(file, spacing=SPACING, unit="nm")
    same(topography)
    assert topography.source == str(file)


@pytest.mark.parametrize("write", [*PLACELESS, *PLACED])
def test_a_path_may_be_a_string_and_its_suffix_in_capitals(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    file = write(tmp_path)
    loud = file.rename(file.with_suffix(file.suffix.upper()))
    same(read_topography(str(loud), spacing=list(SPACING), unit="nm"))


@pytest.mark.parametrize("write", PLACED)
def test_positions_give_the_spacing(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    same(read_topography(write(tmp_path), unit="nm"))
    same(read_topography(write(tmp_path), unit="nm", spacing=np.array(SPACING) * 1.0005))


def test_one_spacing_serves_both_directions(tmp_path: Path) -> None:
    assert read_topography(write_npy(tmp_path), spacing=2).spacing == (2.0, 2.0)


def test_the_first_row_has_the_smallest_y_and_the_first_column_the_smallest_x(tmp_path: Path) -> None:
    rising = 10.0 * Y[:, None] + X  # known everywhere from its place
    for file in (grid_file(tmp_path, rising), npy_file(tmp_path, rising), xyz_file(tmp_path, points(rising))):
        same(read_topography(file, spacing=SPACING, unit="nm"), rising)


@pytest.mark.parametrize("suffix", [".csv", ".txt", ".dat"])
@pytest.mark.parametrize("mark", [",", ";", "\t", " ", " , ", "   "])
def test_any_separator_is_found_in_any_text_grid(tmp_path: Path, suffix: str, mark: str) -> None:
    same(read_topography(grid_file(tmp_path, name=f"t{suffix}", mark=mark), spacing=SPACING, unit="nm"))


def test_a_separator_given_is_the_only_one_used(tmp_path: Path) -> None:
    file = grid_file(tmp_path, mark=";")
    same(read_topography(file, spacing=SPACING, unit="nm", delimiter=";"))
    refusal("line 1", file, lambda: read_topography(file, spacing=1, unit="nm", delimiter=","))


def test_comments_and_blank_lines_are_skipped(tmp_path: Path) -> None:
    rows = [",".join(map(str, row)) for row in HEIGHTS]
    file = lines_file(tmp_path, "\ufeff# scan", "", "z [nm]", rows[0], "# here", *rows[1:], "  ")
    same(read_topography(file, spacing=SPACING))


def test_points_may_come_in_any_order(tmp_path: Path) -> None:
    for seed in range(5):
        rows = np.random.default_rng(seed).permutation(points())
        same(read_topography(xyz_file(tmp_path, rows, "x [nm] y [nm] z [nm]")))


def test_points_off_the_grid_by_less_than_a_thousandth_of_the_spacing_count_as_on_it(tmp_path: Path) -> None:
    off = np.random.default_rng(0).uniform(-4e-4, 4e-4, (NY * NX, 3)) * [DX, DY, 0]
    off[[0, -1]] = 0  # the corners give the mean spacing
    topography = read_topography(xyz_file(tmp_path, points() + off), unit="nm")
    np.testing.assert_array_equal(topography.heights, HEIGHTS)
    assert topography.spacing == pytest.approx(SPACING, rel=1e-3)


def test_a_large_grid_of_points_keeps_every_height_in_its_place(tmp_path: Path) -> None:
    heights = np.random.default_rng(0).standard_normal((7, 300))
    rows = points(heights, 0.1 * np.arange(7), 0.3 * np.arange(300))
    topography = read_topography(xyz_file(tmp_path, rows[::-1]), unit="nm")
    np.testing.assert_array_equal(topography.heights, heights)


def test_descending_coordinates_are_reversed_with_their_heights(tmp_path: Path) -> None:
    same(read_topography(nc_file(tmp_path, HEIGHTS[::-1], places={"y": (Y[::-1], "nm"), "x": (X, "nm")})))
    same(read_topography(nc_file(tmp_path, HEIGHTS[:, ::-1], places={"y": (Y, "nm"), "x": (X[::-1], "nm")})))


def test_a_netcdf_variable_with_x_first_is_turned(tmp_path: Path) -> None:
    same(read_topography(nc_file(tmp_path, HEIGHTS.T, order=("x", "y"))))


def test_a_netcdf_coordinate_of_one_direction_leaves_the_other_to_the_caller(tmp_path: Path) -> None:
    file = nc_file(tmp_path, places={"x": (X, "nm")})
    same(read_topography(file, spacing=SPACING))
    assert refusal("spacing", file, lambda: read_topography(file)).value is None
    refusal("spacing", file, lambda: read_topography(file, spacing=DY))  # serves x too, and is not its own


def test_a_netcdf_coordinate_may_be_named_by_the_attribute(tmp_path: Path) -> None:
    places = {"down": (Y, "nm"), "across": (X, "nm")}
    same(read_topography(nc_file(tmp_path, places=places, order=("i", "j"), coordinates="across down")))


@pytest.mark.parametrize("kind", ["<f4", ">f8", "<i2", ">u2"])
def test_numbers_of_any_kind_become_float64(tmp_path: Path, kind: str) -> None:
    topography = read_topography(npy_file(tmp_path, np.array([[3, 1], [2, 4]]).astype(kind)), spacing=1)
    assert topography.heights.tolist() == [[3.0, 1.0], [2.0, 4.0]]
    assert topography.heights.dtype == np.dtype("float64")


# --- units ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("unit", "scale"), [*UNITS.items(), ("\u00b5m", 1e3)])
def test_a_file_in_any_unit_equals_the_file_in_nm(tmp_path: Path, unit: str, scale: float) -> None:
    z, rows = HEIGHTS / scale, points() / scale
    places = {"y": (Y / scale, unit), "x": (X / scale, unit)}
    same(read_topography(grid_file(tmp_path, z, f"height [{unit}]"), spacing=SPACING))
    same(read_topography(grid_file(tmp_path, z), unit=unit, spacing=SPACING))
    same(read_topography(npy_file(tmp_path, z), unit=unit, spacing=SPACING))
    same(read_topography(xyz_file(tmp_path, rows, f"x [{unit}] y [{unit}] z [{unit}]")))
    same(read_topography(xyz_file(tmp_path, rows), unit=unit))
    same(read_topography(nc_file(tmp_path, z, unit, places)))
    same(read_topography(nc_file(tmp_path, z, None, {at: (y, None) for at, (y, _) in places.items()}), unit=unit))


def test_each_column_and_each_variable_has_its_own_unit(tmp_path: Path) -> None:
    rows = points() / [1e3, 1.0, 1e6]
    same(read_topography(xyz_file(tmp_path, rows, "x (um) y (nm) z (mm)")))
    same(read_topography(nc_file(tmp_path, HEIGHTS * 10, "angstrom", {"y": (Y / 1e9, "m"), "x": (X / 1e6, "mm")})))


def test_a_netcdf_unit_may_be_written_in_the_singular(tmp_path: Path) -> None:
    file = nc_file(tmp_path, HEIGHTS / 1e3, None, unit="\u00b5m")
    same(read_topography(file))


def test_npy_heights_are_nm_unless_told(tmp_path: Path) -> None:
    same(read_topography(write_npy(tmp_path), spacing=SPACING))


@pytest.mark.parametrize("write", [write_csv, write_xyz])
def test_a_unit_nobody_gives_is_refused(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    file = write(tmp_path)
    error = refusal("unit", file, lambda: read_topography(file, spacing=SPACING))
    assert error.value is None and "`unit`" in error.allowed


def test_a_netcdf_variable_without_unit_is_refused_by_its_name(tmp_path: Path) -> None:
    bare = nc_file(tmp_path, units=None)
    assert "heights" in refusal("unit", bare, lambda: read_topography(bare)).allowed
    places = nc_file(tmp_path, places={"y": (Y, None), "x": (X, "nm")})
    assert refusal("unit", places, lambda: read_topography(places)).allowed.startswith("for y ")


def test_a_unit_that_is_unknown_or_contradicts_the_file_is_refused(tmp_path: Path) -> None:
    for file in (
        grid_file(tmp_path, HEIGHTS, "z [nm]"),
        xyz_file(tmp_path, points(), "x [um] y [um] z [nm]"),
        write_nc(tmp_path),
    ):
        for unit in ("um", "furlong"):
            error = refusal("unit", file, lambda file=file, unit=unit: read_topography(file, spacing=1, unit=unit))
            assert error.value == unit and "nm" in error.allowed


@pytest.mark.parametrize("head", ["x [nm], y [nm], z [nm]", "a [nm], b [um]"])
def test_a_grid_whose_header_has_units_for_columns_is_refused(tmp_path: Path, head: str) -> None:
    file = grid_file(tmp_path, HEIGHTS, head)
    assert refusal("line 1", file, lambda: read_topography(file, spacing=1)).value == head


@pytest.mark.parametrize("suffix", [".csv", ".txt", ".dat"])
@pytest.mark.parametrize("head", [[], ["x,y,z"], ["# x,y,z"]])
@pytest.mark.parametrize("order", [[0, 1, 2], [2, 0, 1]])
def test_points_that_a_name_says_are_a_grid_are_refused(tmp_path: Path, suffix: str, head: list, order: list) -> None:
    file = grid_file(tmp_path, points()[:, order], *head, name=f"t{suffix}")
    error = refusal("heights", file, lambda: read_topography(file, spacing=1, unit="nm"))
    assert ".xyz" in error.allowed


def test_a_header_names_points_even_where_some_are_missing(tmp_path: Path) -> None:
    file = grid_file(tmp_path, points()[:-1], "X;Y;Z", mark=";")
    assert ".xyz" in refusal("heights", file, lambda: read_topography(file, spacing=1, unit="nm")).allowed


def test_three_columns_of_heights_are_a_grid(tmp_path: Path) -> None:
    for heights in (HEIGHTS[:, :3], np.zeros((4, 3)), np.random.default_rng(1).normal(size=(12, 3))):
        file = grid_file(tmp_path, heights)
        assert np.array_equal(read_topography(file, spacing=1, unit="nm").heights, heights)


def test_a_file_of_points_is_read_in_the_memory_of_its_numbers(tmp_path: Path) -> None:
    heights = np.random.default_rng(2).normal(size=(128, 128))
    rows = points(heights, np.arange(128.0), np.arange(128.0))
    file = tmp_path / "t.xyz"
    np.savetxt(file, rows, header="x [nm] y [nm] z [nm]", comments="")
    read_topography(file)  # imports and caches
    tracemalloc.start()
    found = read_topography(file)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert np.allclose(found.heights, heights, rtol=1e-15)
    assert peak < 200 * heights.size  # line by line it was 340 bytes a point


# --- missing points ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_missing_heights_are_counted_and_the_first_is_named(tmp_path: Path, bad: float) -> None:
    holes = HEIGHTS.copy()
    holes[[1, 1, 2], [2, 3, 0]] = bad
    for file in (grid_file(tmp_path, holes), npy_file(tmp_path, holes), xyz_file(tmp_path, points(holes)[::-1])):
        error = refusal("heights", file, lambda file=file: read_topography(file, spacing=SPACING, unit="nm"))
        assert error.value == f"3 of 12 points missing or not finite, the first {bad} in row 2, column 3"


def test_masked_netcdf_heights_are_counted_and_the_first_is_named(tmp_path: Path) -> None:
    holes = HEIGHTS.copy()
    holes[2, 1:3] = -999.0  # the fill value
    file = nc_file(tmp_path, holes)
    found = "2 of 12 points missing or not finite, the first nan in row 3, column 2"
    assert refusal("heights", file, lambda: read_topography(file)).value == found


def test_masked_heights_are_refused() -> None:
    masked = np.ma.array(HEIGHTS, mask=HEIGHTS == 6.0)
    error = refusal("heights", "mine", lambda: Topography(masked, SPACING, "mine"))
    assert error.value == "1 of 12 points missing or not finite, the first nan in row 3, column 2"


@pytest.mark.parametrize("gone", [[0], [5], [11], [4, 5, 10], [0, 1, 2, 4, 5, 6]])
def test_points_missing_from_a_grid_are_counted_and_the_first_is_named(tmp_path: Path, gone: list[int]) -> None:
    file = xyz_file(tmp_path, np.delete(points(), gone, axis=0))
    error = refusal("positions", file, lambda: read_topography(file, unit="nm"))
    x, y, _ = points()[gone[0]]
    assert error.value == f"{len(gone)} of 3 × 4 points missing, the first at x = {x:g} nm, y = {y:g} nm"


def test_doubled_points_are_counted_and_the_first_is_named(tmp_path: Path) -> None:
    rows = points()
    file = xyz_file(tmp_path, np.concatenate([rows, rows[[7, 6, 6]]]))
    error = refusal("positions", file, lambda: read_topography(file, unit="nm"))
    assert error.value == "2 of 3 × 4 points given more than once, the first at x = -2 nm, y = 102.5 nm"


def test_scattered_points_are_refused_with_their_row(tmp_path: Path) -> None:
    rows = points()
    rows[9, 0] += 0.1 * DX
    file = xyz_file(tmp_path, rows)
    error = refusal("x", file, lambda: read_topography(file, unit="nm"))
    assert "row 10" in str(error.value) and "off equal steps" in str(error.value)
    random = xyz_file(tmp_path, np.random.default_rng(0).uniform(size=(1000, 3)))
    refusal("x", random, lambda: read_topography(random, unit="nm"))


@pytest.mark.parametrize(("column", "key"), [(0, "x"), (1, "y")])
def test_points_on_one_line_are_refused(tmp_path: Path, column: int, key: str) -> None:
    rows = points()
    rows[:, column] = 7.0
    file = xyz_file(tmp_path, rows)
    assert "7 nm in every row" in str(refusal(key, file, lambda: read_topography(file, unit="nm")).value)


def test_a_diagonal_of_points_is_refused_without_the_memory_of_its_square(tmp_path: Path) -> None:
    line = np.arange(20_000.0)
    file = xyz_file(tmp_path, np.stack([line, line, line], axis=1))
    error = refusal("positions", file, lambda: read_topography(file, unit="nm"))
    assert error.value == "399980000 of 20000 × 20000 points missing, the first at x = 1 nm, y = 0 nm"


# --- bad files and settings -------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", [None, 3, "none.npy", "none.tif"])
def test_a_missing_file_is_refused(path: object) -> None:
    with pytest.raises(InputError, match=r"path: got .*; allowed: an existing file"):
        read_topography(path, spacing=1)


@pytest.mark.parametrize("suffix", [".npy", ".nc"])
@pytest.mark.parametrize("content", [b"", b"1 2\n3 4\n", b"\x93NUMPY\x01\x00", b"\x89HDF\r\n\x1a\n"])
def test_a_file_that_is_not_what_its_suffix_says_is_refused(tmp_path: Path, suffix: str, content: bytes) -> None:
    file = tmp_path / f"t{suffix}"
    file.write_bytes(content)
    assert suffix in refusal("path", file, lambda: read_topography(file, spacing=1)).allowed


def test_pickled_objects_are_never_loaded(tmp_path: Path) -> None:
    file = npy_file(tmp_path, np.array([[1, None], [2, 3]], dtype=object))
    refusal("path", file, lambda: read_topography(file, spacing=1))


@pytest.mark.parametrize(
    "values", [[1.0, 2.0], [[1.0, 2.0]], [[1.0], [2.0]], np.ones((2, 2, 2)), [[1j, 2], [3, 4]], 5.0]
)
def test_arrays_other_than_two_or_more_real_numbers_each_way_are_refused(tmp_path: Path, values: object) -> None:
    file = npy_file(tmp_path, values)
    error = refusal("heights", file, lambda: read_topography(file, spacing=1))
    assert str(np.asarray(values).shape) in str(error.value) and "2D" in error.allowed


@pytest.mark.parametrize("row", ["1,2,3", "1,2,3,4,5", "1,,3,4", "1,2,3,x", "1;2;3;4"])
def test_a_row_that_does_not_fit_is_refused_with_its_line(tmp_path: Path, row: str) -> None:
    file = lines_file(tmp_path, "# scan", "1,2,3,4", "5,6,7,8", row)
    assert refusal("line 4", file, lambda: read_topography(file, spacing=1, unit="nm")).value == row


def test_a_grid_of_one_column_or_row_is_refused(tmp_path: Path) -> None:
    column = lines_file(tmp_path, "1", "2", "3")
    refusal("line 1", column, lambda: read_topography(column, spacing=1, unit="nm"))
    row = lines_file(tmp_path, "1,2,3")
    refusal("heights", row, lambda: read_topography(row, spacing=1, unit="nm"))


@pytest.mark.parametrize("row", ["1 2", "1 2 3 4"])
def test_points_of_other_than_three_columns_are_refused(tmp_path: Path, row: str) -> None:
    file = lines_file(tmp_path, row, row, name="t.xyz")
    assert "x, y and z" in refusal("line 1", file, lambda: read_topography(file, unit="nm")).allowed


@pytest.mark.parametrize("write", PLACELESS)
def test_a_file_without_positions_needs_a_spacing(tmp_path: Path, write: Callable[[Path], Path]) -> None:
    file = write(tmp_path)
    error = refusal("spacing", file, lambda: read_topography(file, unit="nm"))
    assert error.value is None and "(dy, dx)" in error.allowed


@pytest.mark.parametrize("spacing", [0, -1.0, np.nan, np.inf, "2", True, [1.0], [1, 2, 3], (1, 0), [1, "2"], [[1, 2]]])
def test_a_spacing_that_is_not_one_or_two_positive_numbers_is_refused(tmp_path: Path, spacing: object) -> None:
    for file in (write_npy(tmp_path), write_nc(tmp_path)):
        refusal("spacing", file, lambda file=file: read_topography(file, spacing=spacing))


@pytest.mark.parametrize("write", PLACED)
@pytest.mark.parametrize("spacing", [(DX, DY), (DY, DX * 1.01), DY])
def test_a_spacing_that_contradicts_the_positions_is_refused(
    tmp_path: Path, write: Callable[[Path], Path], spacing: object
) -> None:
    file = write(tmp_path)
    error = refusal("spacing", file, lambda: read_topography(file, spacing=spacing, unit="nm"))
    assert "that of the positions" in error.allowed


def test_netcdf_coordinates_with_unequal_steps_are_refused_by_name(tmp_path: Path) -> None:
    file = nc_file(tmp_path, places={"y": (Y, "nm"), "x": (np.array([0.0, 1.0, 2.0, 4.0]), "nm")})
    assert "from row 3 to 4" in str(refusal("x", file, lambda: read_topography(file)).value)


def test_the_netcdf_variable_is_named_or_found(tmp_path: Path) -> None:
    file = nc_file(tmp_path, name="trace")
    same(read_topography(file))
    with netCDF4.Dataset(str(file), "a") as data:
        data.createVariable("other", "f8", ("y", "x"))[:] = 1.0
    same(read_topography(file, variable="trace"))
    for variable in (None, "none", "x"):
        error = refusal("variable", file, lambda variable=variable: read_topography(file, variable=variable))
        assert error.value == variable and "2D" in error.allowed and "'trace', 'other'" in error.allowed


def test_settings_of_another_format_are_refused_not_ignored(tmp_path: Path) -> None:
    for write in (write_npy, write_csv, write_xyz):
        file = write(tmp_path)
        error = refusal("variable", file, lambda file=file: read_topography(file, spacing=1, variable="z"))
        assert error.value == "z" and ".nc" in error.allowed
    for write in (write_npy, write_nc):
        file = write(tmp_path)
        refusal("delimiter", file, lambda file=file: read_topography(file, spacing=1, delimiter=","))


def test_a_topography_made_by_hand_is_checked_and_owns_its_heights() -> None:
    refusal("heights", "mine", lambda: Topography(np.arange(4.0), SPACING, "mine"))
    refusal("spacing", "mine", lambda: Topography(HEIGHTS, (1.0, 0.0), "mine"))
    mine = HEIGHTS.copy()
    topography = Topography(mine, SPACING, "mine")
    mine[:] = 0
    same(topography)


# --- files of instruments ---------------------------------------------------------------------------------------


class Channel:
    """A channel as SurfaceTopography 1.27 gives it: heights (nx, ny), sizes and unit as the file states them."""

    dim, is_height_channel = 2, True

    def __init__(self, heights=HEIGHTS.T, sizes=(NX * DX, NY * DY), unit="nm", name="Height") -> None:
        self._heights, self.physical_sizes, self.unit, self.channel_id = heights, sizes, unit, name
        self.nb_grid_pts = heights.shape

    def topography(self, physical_sizes=None):
        assert (physical_sizes is None) == (self.physical_sizes is not None)
        return self._made(self._heights, physical_sizes or self.physical_sizes, self.unit)

    def _made(self, heights, sizes, unit):
        def to_unit(wanted):
            factor = {"nm": 1.0, "µm": 1e3, "Å": 0.1}[unit]
            return self._made(heights * factor, [size * factor for size in sizes], wanted)

        steps = np.array(sizes, float) / heights.shape
        return SimpleNamespace(heights=lambda: heights, pixel_size=steps, unit=unit, to_unit=to_unit)


@pytest.fixture
def instrument(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Path]:
    """Write a file that a stub of SurfaceTopography reads as the channels given."""

    def write(*channels: Channel, error: Exception | None = None) -> Path:
        class Reader:
            def __init__(self, path: str) -> None:
                assert path == str(file)
                if error is not None:
                    raise error
                self.channels, self.default_channel = channels, channels[0]

            def __enter__(self):
                return self

            def __exit__(self, *error: object) -> None:
                pass

        library = ModuleType("SurfaceTopography")
        library.open_topography = Reader
        monkeypatch.setitem(sys.modules, "SurfaceTopography", library)
        file = tmp_path / "scan.al3d"
        file.write_bytes(b"instrument")
        return file

    return write


def test_an_instrument_file_is_read_turned_and_brought_to_nm(instrument) -> None:
    same(read_topography(instrument(Channel())))
    for unit, scale in (("µm", 1e3), ("Å", 0.1)):
        sizes = (NX * DX / scale, NY * DY / scale)
        same(read_topography(instrument(Channel(HEIGHTS.T / scale, sizes, unit)), spacing=SPACING))


def test_a_unit_and_a_spacing_serve_the_instrument_file_without(instrument) -> None:
    bare = Channel(HEIGHTS.T / 1e3, None, None)
    file = instrument(bare)
    same(read_topography(file, unit="um", spacing=SPACING))
    assert refusal("unit", file, lambda: read_topography(file, spacing=SPACING)).value is None
    assert refusal("spacing", file, lambda: read_topography(file, unit="um")).value is None
    sized = instrument(Channel(HEIGHTS.T / 1e3, (NX * DX / 1e3, NY * DY / 1e3), None))
    same(read_topography(sized, unit="um"))


def test_a_unit_or_spacing_other_than_the_instruments_is_refused(instrument) -> None:
    file = instrument(Channel())
    assert refusal("unit", file, lambda: read_topography(file, unit="um")).allowed == "none, the file states nm"
    refusal("spacing", file, lambda: read_topography(file, spacing=3.0))


def test_a_channel_is_named_or_the_default(instrument) -> None:
    phase = Channel(name="Phase")
    phase.is_height_channel = False
    file = instrument(Channel(HEIGHTS.T + 1), phase, Channel(name="Back"))
    same(read_topography(file), HEIGHTS + 1)
    same(read_topography(file, variable="Back"))
    error = refusal("variable", file, lambda: read_topography(file, variable="Phase"))
    assert error.value == "Phase" and "['Height', 'Back']" in error.allowed
    lone = instrument(phase)
    assert refusal("variable", lone, lambda: read_topography(lone)).value == "Phase"


def test_points_missing_from_an_instrument_file_are_refused(instrument) -> None:
    file = instrument(Channel(np.ma.array(HEIGHTS, mask=HEIGHTS < 0).T))
    found = "3 of 12 points missing or not finite, the first nan in row 1, column 3"
    assert refusal("heights", file, lambda: read_topography(file)).value == found


def test_a_line_scan_of_an_instrument_is_refused(instrument) -> None:
    file = instrument(Channel(HEIGHTS[0], (NX * DX,)))
    assert "2D" in refusal("heights", file, lambda: read_topography(file)).allowed


@pytest.mark.parametrize("error", [KeyError("header"), ValueError("tried\n" * 1000), NotImplementedError("version")])
def test_whatever_the_library_raises_names_the_file(instrument, error: Exception) -> None:
    file = instrument(error=error)
    allowed = refusal("path", file, lambda: read_topography(file)).allowed
    assert "a readable .al3d file" in allowed and len(allowed) < 300


def test_without_the_library_its_files_are_refused_with_what_to_install(instrument, monkeypatch) -> None:
    file = instrument()
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    error = refusal("path", file, lambda: read_topography(file))
    assert error.value == file.name
    assert "pip install SurfaceTopography" in error.allowed
    assert all(suffix in error.allowed for suffix in (".npy", ".csv", ".txt", ".dat", ".xyz", ".nc"))


@pytest.mark.filterwarnings("default")
def test_the_library_itself_reads_the_same(tmp_path: Path) -> None:
    pytest.importorskip("SurfaceTopography")
    head = [f"# Width: {NX * DX / 1e3} µm", f"# Height: {NY * DY / 1e3} µm", "# Value units: m"]
    rows = [" ".join(repr(z / 1e9) for z in row) for row in HEIGHTS.tolist()]
    same(read_topography(lines_file(tmp_path, *head, *rows, name="t.asc")))
    bare = lines_file(tmp_path, *rows, name="bare.asc")
    same(read_topography(bare, unit="m", spacing=SPACING))
    holes = lines_file(tmp_path, *head, *rows[:2], rows[2].replace("7e-09", "nan"), name="holes.asc")
    assert "1 of 12" in str(refusal("heights", holes, lambda: read_topography(holes)).value)
    junk = lines_file(tmp_path, "no instrument", name="junk.al3d")
    refusal("path", junk, lambda: read_topography(junk))


# --- preparing --------------------------------------------------------------------------------------------------

POWERS = {"mean": [(0, 0)], "plane": [(0, 0), (1, 0), (0, 1)]}
POWERS["quadratic"] = [*POWERS["plane"], (2, 0), (1, 1), (0, 2)]
fields = arrays(np.float64, array_shapes(min_dims=2, max_dims=2, min_side=2, max_side=9), elements=st.floats(-1e6, 1e6))


def prepared(heights: np.ndarray, detrend: str, periodic: str = "none") -> np.ndarray:
    """The heights prepared, at a spacing that must not matter."""
    return prepare(Topography(heights, SPACING, "mine"), detrend, periodic).heights


def polynomials(shape: tuple[int, int], kind: str) -> np.ndarray:
    """x^i y^j on a grid for the powers of a kind, (terms, ny, nx)."""
    y, x = np.meshgrid(*(np.linspace(-1, 1, size) for size in shape), indexing="ij")
    return np.array([x**i * y**j for i, j in POWERS[kind]])


@given(
    st.sampled_from(list(POWERS)), array_shapes(min_dims=2, max_dims=2, min_side=2, max_side=200), st.integers(0, 99)
)
def test_detrending_removes_any_polynomial_of_its_degree(kind: str, shape: tuple[int, int], seed: int) -> None:
    terms = polynomials(shape, kind)
    form = 1e3 * np.tensordot(np.random.default_rng(seed).uniform(-1, 1, len(terms)), terms, 1)
    assert np.abs(prepared(form, kind)).max() <= 1e-13 * 1e3 * len(terms)


@given(st.sampled_from(list(POWERS)), fields)
def test_what_detrending_leaves_is_what_a_least_squares_fit_leaves(kind: str, heights: np.ndarray) -> None:
    terms = polynomials(heights.shape, kind).reshape(len(POWERS[kind]), -1).T
    fit = (terms @ np.linalg.lstsq(terms, heights.ravel(), rcond=None)[0]).reshape(heights.shape)
    allowed = 1e-12 * np.abs(heights).max() + np.finfo(float).tiny
    np.testing.assert_allclose(prepared(heights, kind), heights - fit, rtol=0, atol=allowed)


def test_a_plane_leaves_curvature_and_a_paraboloid_leaves_nothing_of_a_sphere_cap() -> None:
    y, x = np.meshgrid(DY * np.arange(40), DX * np.arange(30), indexing="ij")
    rough = np.cos(2 * np.pi * x / 5) * np.cos(2 * np.pi * y / 20)
    bowl = 0.3 * (x - 4) ** 2 - 0.1 * x * y + 0.2 * (y - 9) ** 2
    assert np.abs(prepared(bowl + rough, "quadratic") - rough).max() < 0.1
    assert np.abs(prepared(bowl + rough, "plane") - rough).max() > 100
    assert np.abs(prepared(2 * x - 3 * y + 7, "plane")).max() < 1e-11


@given(fields)
def test_none_changes_nothing_and_gives_a_copy(heights: np.ndarray) -> None:
    topography = Topography(heights, SPACING, "mine")
    result = prepare(topography, "none", "none")
    assert result.heights.tolist() == heights.tolist()
    assert not np.shares_memory(result.heights, topography.heights)


@given(fields)
def test_mirror_keeps_every_height_and_is_periodic_and_even_in_both_directions(heights: np.ndarray) -> None:
    ny, nx = heights.shape
    result = prepared(heights, "none", "mirror")
    assert result.shape == (2 * ny - 2, 2 * nx - 2)
    assert result[:ny, :nx].tolist() == heights.tolist()
    for axis in (0, 1):  # even about point 0 of the period
        assert np.roll(np.flip(result, axis), 1, axis).tolist() == result.tolist()


@given(fields, st.sampled_from([0, 1]))
def test_mirror_keeps_the_rms_slope_along_lines(heights: np.ndarray, axis: int) -> None:
    lines = prepared(heights, "none", "mirror")
    around = np.diff(lines, axis=axis, append=lines.take([0], axis))
    ny, nx = heights.shape
    kept = around[:ny] if axis == 1 else around[:, :nx]
    assert np.mean(kept**2) == pytest.approx(np.mean(np.diff(heights, axis=axis) ** 2), rel=1e-9)


@pytest.mark.parametrize("periodic", ["mirror", "window"])
def test_the_step_at_the_seams_is_no_larger_than_elsewhere(periodic: str) -> None:
    y, x = np.meshgrid(np.linspace(0, 1, 60), np.linspace(0, 1, 90), indexing="ij")
    result = prepared(np.exp(x) * (1 + y**3), "mean", periodic)
    for axis in (0, 1):
        inside = np.abs(np.diff(result, axis=axis)).max()
        assert np.abs(result.take(0, axis) - result.take(-1, axis)).max() <= inside


@given(fields)
def test_window_keeps_the_shape_and_is_zero_at_all_edges(heights: np.ndarray) -> None:
    result = prepared(heights, "none", "window")
    assert result.shape == heights.shape
    assert not np.any([result[0].any(), result[-1].any(), result[:, 0].any(), result[:, -1].any()])


def test_window_is_the_product_of_those_of_profiles() -> None:
    y, x = (np.where(np.arange(size) % 2, 1.0, -1.0) for size in (200, 50))
    result = prepared(np.outer(y, x), "none", "window")
    expected = np.outer(*(prepare(profile.Profile(line, 1.0, None), "none", "window").heights for line in (y, x)))
    np.testing.assert_allclose(result, expected, atol=1e-13)
    np.testing.assert_array_equal(result[20:180, 5:45], np.outer(y, x)[20:180, 5:45])


@pytest.mark.parametrize("setting", ["detrend", "periodic"])
@pytest.mark.parametrize("kind", ["tilt", "linear", "Mirror", "", 2, ["none"]])
def test_an_unknown_kind_is_refused_with_the_known_ones(setting: str, kind: object) -> None:
    error = refusal(setting, "mine", lambda: prepare(Topography(HEIGHTS, SPACING, "mine"), **{setting: kind}))
    assert error.allowed == f"one of {', '.join((DETREND if setting == 'detrend' else PERIODIC)[2])}"


def test_preparing_takes_a_plane_and_mirrors_unless_told() -> None:
    topography = Topography(HEIGHTS, SPACING, "mine")
    assert prepare(topography).heights.tolist() == prepared(HEIGHTS, "plane", "mirror").tolist()
    assert (prepare(topography).spacing, prepare(topography).source) == (SPACING, "mine")


# --- as a surface -----------------------------------------------------------------------------------------------


def test_a_measured_surface_has_its_own_points_and_periods_in_both_directions(tmp_path: Path) -> None:
    surface = MeasuredSurface(str(write_nc(tmp_path)), "none", "none")
    assert (surface.points, surface.lengths, surface.modes) == (NX, (NY * DY, NX * DX), None)
    np.testing.assert_array_equal(surface.heights(NX), HEIGHTS)
    with pytest.raises(InputError, match=rf"points: got {NY}; allowed: {NX}, the number of points"):
        surface.heights(NY)


def test_a_measured_surface_is_detrended_and_made_periodic_by_the_named_options(tmp_path: Path) -> None:
    file = str(write_npy(tmp_path))
    surface = MeasuredSurface(file, spacing=[DY, DX])
    assert surface.lengths == (4 * DY, 6 * DX)
    np.testing.assert_array_equal(surface.heights(6), prepared(HEIGHTS, "plane", "mirror"))
    tapered = MeasuredSurface(file, "quadratic", "window", 2.0, "um")
    np.testing.assert_array_equal(tapered.heights(NX), prepared(HEIGHTS * 1e3, "quadratic", "window"))
    assert tapered.lengths == (2.0 * NY, 2.0 * NX)


def test_a_measured_surface_can_be_configured() -> None:
    keys = keys_of(SURFACES["measured_surface"])
    assert list(keys) == ["file", "detrend", "periodic", "spacing", "unit", "variable"]
    for spacing in (2.0, [2.5, 0.5], [2, 1]):
        assert read({"file": "t.npy", "spacing": spacing}, keys, "ch9.yaml")["spacing"] == spacing
    for spacing in (0, [1.0], [1.0, -1.0], [1, 2, 3], "2", "1e-6", True, {}):
        with pytest.raises(
            InputError, match=r"ch9.yaml: surface.spacing: got .*; allowed: a positive number or a list"
        ):
            read({"file": "t.npy", "spacing": spacing}, keys, "ch9.yaml", "surface")


def area(file: Path) -> Study:
    """A study that presses a measured surface."""
    section = {
        "title": "An area",
        "surface": {"kind": "measured_surface", "file": str(file), "spacing": [DY, DX]},
        "body": {"kind": "half_space", "contact_modulus": 1.0},
        "effects": ["hard_wall"],
        "load": {"reduced_pressure": [1e-2]},
        "tolerance": 1e-3,
    }
    return Study.read("area", section, "ch9.yaml", 1)


def test_a_measured_surface_whose_file_changes_makes_another_run(tmp_path: Path) -> None:
    (before,) = area(write_npy(tmp_path)).runs()
    (after,) = area(npy_file(tmp_path, HEIGHTS + 1)).runs()
    assert before.settings["surface"] == after.settings["surface"]
    assert before.digest != after.digest


def test_a_measured_surface_is_pressed_on_its_own_grid(tmp_path: Path) -> None:
    heights = np.random.default_rng(0).standard_normal((24, 16))
    (run,) = area(npy_file(tmp_path, heights)).runs()
    execute.run(run.settings, run.source, RunFiles(tmp_path / "run.nc", tmp_path / "run.json"))
    data = dataset.load_dataset(tmp_path / "run.nc")
    assert data.status == Status.CONVERGED.value[0]
    assert (int(data.points), int(data.points_y), float(data.length), float(data.length_y)) == (30, 46, 15.0, 115.0)
    assert float(data.rms_height) == pytest.approx(prepared(heights, "plane", "mirror").std(), rel=1e-12)


def test_a_measured_surface_with_a_hole_stops_the_study(tmp_path: Path) -> None:
    file = npy_file(tmp_path, np.where(HEIGHTS == 8.0, np.nan, HEIGHTS))
    error = refusal("studies.area.heights", file, lambda: area(file))
    assert error.value == "1 of 12 points missing or not finite, the first nan in row 2, column 3"
