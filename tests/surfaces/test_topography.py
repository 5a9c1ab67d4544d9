"""Files of measured heights: what each text, array and netCDF file means, and how a bad one is refused.

Files of instruments go through a stub of the library that reads them.
"""

from __future__ import annotations

import bz2
import gzip
import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace

import netCDF4
import numpy as np
import pytest
from scipy.io import savemat

from contactsim import dataset
from contactsim.errors import InputError
from contactsim.status import Status
from contactsim.study import execute
from contactsim.study.execute import RunFiles
from contactsim.study.reading import keys_of, read
from contactsim.study.study import Study
from contactsim.surfaces.measured import MeasuredSurface
from contactsim.surfaces.preparation import prepare_topography
from contactsim.surfaces.registry import SURFACES
from contactsim.surfaces.scan_files import read_topography
from contactsim.surfaces.topography import Topography
from support.cases import refusal, refused

DY, DX = SPACING = (2.5, 0.5)
HEIGHTS = np.array([[0.0, 1.5, -2.25, 3.0], [0.5, -1.0, 8.0, 4.0], [7.0, 6.0, 5.5, -9.0]])
NY, NX = HEIGHTS.shape
Y, X = 100.0 + DY * np.arange(NY), -3.0 + DX * np.arange(NX)


def same(topography: Topography, heights: np.ndarray = HEIGHTS, spacing: tuple[float, ...] = SPACING) -> None:
    """Assert heights and spacing, to rounding."""
    np.testing.assert_allclose(topography.values, heights, rtol=1e-12)
    assert topography.values.dtype == np.float64
    assert topography.spacing == pytest.approx(spacing, rel=1e-12)
    assert {type(step) for step in topography.spacing} == {float}


def write(folder: Path, text: str, suffix: str = ".csv", encoding: str = "utf-8") -> Path:
    """Write a text; a bar ends a line."""
    file = folder / f"t{suffix}"
    file.write_bytes(text.replace("|", "\n").encode(encoding))
    return file


def npy_file(folder: Path, values: object) -> Path:
    """Write an array."""
    file = folder / "t.npy"
    np.save(file, np.asarray(values))
    return file


def nc_file(
    folder: Path,
    heights: np.ndarray = HEIGHTS,
    units: str | None = "nm",
    order: str = "yx",
    places: dict[str, tuple[np.ndarray, str | None]] | None = None,
    **attributes: object,
) -> Path:
    """Write heights on one-letter dimensions, with coordinates (values, units) named by their dimension's letter."""
    file = folder / "t.nc"
    places = {"y": (Y, "nm"), "x": (X, "nm")} if places is None else places
    with netCDF4.Dataset(str(file), "w") as data:
        for dimension, size in zip(order, heights.shape, strict=True):
            data.createDimension(dimension, size)
        for name, (values, stated) in places.items():
            place = data.createVariable(name, "f8", (name[0],))
            place[:] = values
            if stated is not None:
                place.units = stated
        field = data.createVariable("heights", "f8", tuple(order), fill_value=-999.0)
        field[:] = heights
        if units is not None:
            field.units = units
        field.setncatts(attributes)
    return file


# --- texts --------------------------------------------------------------------------------------------------------

LINE, LINE_STEP = [1.0, 3.0, -2.0], (0.5,)
AREA = [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.5]]
POINTS_TEXT = "0.5 10 2|0 12 5|0.5 12 6|0 10 1|1 12 9|1 10 3"
POINTS = [[1.0, 2.0, 3.0], [5.0, 6.0, 9.0]]

TEXTS = [
    (".csv", "1|3|-2", {"unit": "nm", "spacing": 0.5}, LINE, LINE_STEP),
    (".csv", "z [um]|1e-3|3e-3|-2e-3", {"spacing": 0.5}, LINE, LINE_STEP),
    (".txt", "10,1|10.5,3|11,-2", {"unit": "nm"}, LINE, LINE_STEP),
    (".dat", "10;1|10.5;3|11;-2", {"unit": "nm", "delimiter": ";"}, LINE, LINE_STEP),
    (".xyz", "10\t1|10.5\t3|11\t-2", {"unit": "nm"}, LINE, LINE_STEP),
    (".csv", "10   1|10.5 3 | 11  -2", {"unit": "nm", "spacing": 0.5002}, LINE, LINE_STEP),
    (".csv", "11,-2|10.5,3|10,1", {"unit": "nm"}, LINE, LINE_STEP),
    (".csv", "10,1|10.5002,3|11,-2", {"unit": "nm"}, LINE, LINE_STEP),
    (".csv", "x [um], z [nm]|0.010,1|0.0105,3|0.011,-2", {}, LINE, LINE_STEP),
    (".csv", "place,height|10e-9,1e-9|10.5e-9,3e-9|11e-9,-2e-9", {"unit": "m"}, LINE, LINE_STEP),
    (".xyz", "x [nm] y [nm] z [nm]|10 7 1|10.5 7 3|11 7 -2", {}, LINE, LINE_STEP),
    (".csv", "x (m);y (nm);z (mm)|0;10;1e-6|0;10.5;3e-6|0;11;-2e-6", {}, LINE, LINE_STEP),
    (".txt", '\ufeff# AFM [raw]||"x [nm]","z [nm]"|# here|10,1|  |10.5,3|#1,2|11,-2', {}, LINE, LINE_STEP),
    (".csv", "1,2,3,4|5,6,7,8.5", {"unit": "nm", "spacing": SPACING}, AREA, SPACING),
    (".txt", "z [angstrom]|10 20 30 40|50 60 70 85", {"spacing": [2.5, 0.5]}, AREA, SPACING),
    (".dat", "1;2;3;4|5;6;7;8.5", {"unit": "nm", "spacing": 2}, AREA, (2.0, 2.0)),
    (".csv", "1,2|5,6", {"unit": "nm", "spacing": 1, "dimensions": 2}, [[1, 2], [5, 6]], (1.0, 1.0)),
    (".csv", "1,2,3|5,6,9", {"unit": "nm", "spacing": 1}, POINTS, (1.0, 1.0)),
    (".csv", "0,0,0|0,0,0", {"unit": "nm", "spacing": 1}, np.zeros((2, 3)), (1.0, 1.0)),
    (".xyz", POINTS_TEXT, {"unit": "nm"}, POINTS, (2.0, 0.5)),
    (".xyz", "x [um] y [nm] z [mm]|0 10 1e-6|5e-4 10 2e-6|0 12 5e-6|5e-4 12 6e-6", {}, [[1, 2], [5, 6]], (2.0, 0.5)),
    (".xyz", "0 0 1|1 0.0006 2|0.0008 2 5|1 2 6", {"unit": "nm"}, [[1, 2], [5, 6]], (2.0, 1.0)),
    (".csv", POINTS_TEXT, {"unit": "nm"}, POINTS, (2.0, 0.5)),
    (".csv", "# x [um], z [nm]|0.010,1|0.0105,3|0.011,-2", {}, LINE, LINE_STEP),
    (".txt", "10,0\t1,0|10,5\t3,0|11,0\t-2,0", {"unit": "nm"}, LINE, LINE_STEP),
    (".csv", "10;1|10,5;3|11;-2", {"unit": "nm"}, LINE, LINE_STEP),
    (".txt", "1,0 2,0 3,0 4,0|5,0 6,0 7,0 8,5", {"unit": "nm", "spacing": SPACING}, AREA, SPACING),
    (".csv", "Scan,A|Tip,Radius: 2 um|||Lateral um,Raw Micrometer,|0.010,1e-3,,|0.0105,3e-3,,|0.011,-2e-3,,", {}, LINE,
     LINE_STEP),
    (".txt", "# Channel: Z|# Width: 2 nm|# Height: 5e-3 µm|# Value units: m|1e-9 2e-9 3e-9 4e-9|5e-9 6e-9 7e-9 8.5e-9",
     {}, AREA, SPACING),
    (".txt", "# Breite: 0,002 µm|# Höhe: 5 nm|# Value units: nm|1 2 3 4|5 6 7 8,5", {}, AREA, SPACING),
    (".txt", "h=2 w=4|pixel size=5e-10 m|data unit=rad|height conversion factor (-> m)=2e-9|.5 1 1.5 2|2.5 3 3.5 4.25",
     {}, AREA, (0.5, 0.5)),
]  # fmt: skip


@pytest.mark.parametrize(("suffix", "text", "options", "heights", "spacing"), TEXTS)
def test_a_text_means_these_heights_and_this_spacing(tmp_path, suffix, text, options, heights, spacing) -> None:
    file = write(tmp_path, text, suffix)
    topography = read_topography(file, **options)
    same(topography, heights, spacing)
    assert topography.source == str(file)
    loud = file.rename(file.with_suffix(suffix.upper()))
    same(read_topography(str(loud), **options), heights, spacing)


NM = {"unit": "nm", "spacing": 1.0}
LINE_NM, AREA_NM = NM | {"dimensions": 1}, NM | {"dimensions": 2}
BAD_TEXTS = [
    (".csv", "1,2|3,4", {}, "unit", None, "`unit`"),
    (".csv", "x [nm], z [furlong]|1,2|2,4", {}, "unit", "furlong", "angstrom"),
    (".csv", "x [um], z [nm]|1,2|2,4", {"unit": "um"}, "unit", "um", "that in the file, nm"),
    (".csv", "1,2|3,4", {"unit": "Mm"}, "unit", "Mm", "nm"),
    (".csv", "# x, z [nm or so]|1,2|2,4", {}, "unit", None, "`unit`"),
    (".csv", "x, z [nm]|1,2|2,4", NM, "line 1", "x, z [nm]", "each of 2 columns"),
    (".csv", "a [nm], b [um], c [nm], d [nm]|1,2,3,4|1,2,3,4", NM, "line 1", None, "each of 1 columns"),
    (".csv", "1|2", {"unit": "nm"}, "spacing", None, "a spacing in nm, since"),
    (".csv", "1,2,3,4|1,2,3,4", {"unit": "nm"}, "spacing", None, "(dy, dx)"),
    (".csv", "1,2|2,4", {"unit": "nm", "spacing": 1.01}, "spacing", 1.01, "1 nm"),
    (".xyz", POINTS_TEXT, {"unit": "nm", "spacing": (0.5, 2.0)}, "spacing", 0.5, "2 nm"),
    (".csv", "", NM, "heights", "no row of numbers", "two or more rows"),
    (".csv", "z [nm]|1.0", NM, "heights", "one row of numbers", "two or more rows"),
    (".csv", "1;2|2;4", NM | {"delimiter": ","}, "line 1, column 1", "1;2", "a number"),
    (".csv", "1;2|2;4", NM | {"delimiter": "|"}, "delimiter", "|", "tab"),
    (".csv", "1,2|2,4", NM | {"variable": "z"}, "variable", "z", "only for .npz, .mat, .nc"),
    (".csv", "nan|1|2", NM, "heights", "nan in row 1", "finite"),
    (".csv", "1|2|inf", NM, "heights", "inf in row 3", "finite"),
    (".csv", "1,2|inf,3|3,4", NM, "positions", "inf in row 2", "finite"),
    (".csv", "0,1|1,1|2,1|7.5,1", {"unit": "nm"}, "positions",
     "3 nm off the mean step 2.5 nm from row 3 to 4", "0.001"),
    (".csv", "0,1|1.0011,1|2,1|3,1", {"unit": "nm"}, "positions", None, "0.001"),
    (".csv", "7,1|7,2|7,3", {"unit": "nm"}, "positions", None, "equal steps"),
    (".csv", "1,2,1|2,4,1|3,6,1", LINE_NM, "positions", "x and y that both vary", "line scan"),
    (".csv", "1,2,3,4|1,2,3,4", LINE_NM, "line 1", "4 numbers", "one to three"),
    (".csv", "1|2|3", AREA_NM, "line 1", "1 number", "two or more heights"),
    (".csv", "1,2,nan,4|1,inf,3,4", NM, "heights",
     "2 of 8 points missing or not finite, the first nan in row 1, column 3", "none"),
    (".csv", "1 0 0|2 0 1|5 1 0|4 1 1", NM, "heights", None, "in the order x y z"),
    (".txt", "X;Y;Z|0;0;1|1;0;2|0;1;3", NM, "positions", "1 of 2 × 2 points missing, the first at x = 1 nm, y = 1 nm",
     "once"),
    (".txt", "Width: 5|1 2|3 4", {"unit": "nm", "dimensions": 2}, "line 1", "5", "a number and its unit"),
    (".txt", "Width: 5 parsec|1 2|3 4", {"unit": "nm", "dimensions": 2}, "unit", "parsec", "for width one of"),
    (".txt", "# h=3 w=2|1 2|3 4", {"unit": "nm", "dimensions": 2}, "heights", "2 rows", "3, as line 1 says"),
    (".txt", "Value units: rad|1 2|3 4", {"spacing": 1, "dimensions": 2}, "unit", "rad", "for heights one of"),
    (".txt", "a|b|" * 600 + "1 2", NM, "heights", "1001 lines of words", "rows of numbers"),
    (".xyz", "1 2 3 4|1 2 3 4", NM, "line 1", "4 numbers", "x, y and z"),
    (".xyz", "1 2|3 4", AREA_NM, "line 1", "2 numbers", "x, y and z"),
    (".xyz", POINTS_TEXT[:-7], NM, "positions", "1 of 2 × 3 points missing, the first at x = 1 nm, y = 10 nm", "once"),
    (".xyz", "0 10 1|0 12 2|1 10 3|1 12 4|1 10 5", NM, "positions",
     "1 of 2 × 2 points given more than once, the first at x = 1 nm, y = 10 nm", "once"),
    (".xyz", "0 0 1|1 0 2|2.1 0 3|0 1 4|1 1 5|2 1 6", NM, "x", None, "equal steps"),
    (".xyz", "7 0 1|7 1 2|7 2 3", AREA_NM, "x", "7 nm in every row", "grid"),
    (".csv", "1|2", NM | {"dimensions": 3}, "dimensions", 3, "1, a line"),
    (".csv", "1|2", NM | {"delimiter": "", "spacing": 1}, "delimiter", "", "tab"),
]  # fmt: skip


@pytest.mark.parametrize(("suffix", "text", "options", "key", "value", "allowed"), BAD_TEXTS)
def test_a_bad_text_is_refused_with_its_place(tmp_path, suffix, text, options, key, value, allowed) -> None:
    file = write(tmp_path, text, suffix)
    error = refusal(key, file, lambda: read_topography(file, **options))
    assert allowed in error.allowed
    if value is not None or key in ("unit", "spacing"):
        assert error.value == value


BAD_ROWS = [
    *(("2,abc", ", column 2", "abc"), ("2,", ", column 2", "nothing"), ("2,3 # why", ", column 2", "3 # why")),
    *(("2;3", ", column 1", "2;3"), ("2 3", "", "2 numbers"), ("1_0,2", ", column 1", "1_0")),
    *(("x [nm], z [nm]", ", column 1", "x [nm]"), ("2,1.O5", ", column 2", "1.O5")),
    *(("2", "", "1 number"), ("2,3,4", "", "3 numbers")),
]


@pytest.mark.parametrize(("row", "column", "value"), BAD_ROWS)
def test_a_row_that_does_not_parse_is_refused_with_its_line(tmp_path: Path, row: str, column: str, value: str) -> None:
    file = write(tmp_path, f"# comment|x [nm], z [nm]|0,1||1,1|{row}|3,1")
    assert refusal(f"line 6{column}", file, lambda: read_topography(file)).value == value


@pytest.mark.parametrize("mark", [";", "\t", " "])
@pytest.mark.parametrize("field", ["1.9", "1.2.3", "1.O5", "n/a", "--1", "1_5"])
def test_a_mistyped_field_among_decimal_commas_is_told_with_its_place(tmp_path: Path, mark: str, field: str) -> None:
    rows = [["0,0", "1,5"], ["0,1", "1,7"], ["0,2", "1,6"], ["0,3", field], ["0,4", "1,5"]]
    file = write(tmp_path, "|".join(map(mark.join, rows)), ".txt")
    assert refusal("line 4, column 2", file, lambda: read_topography(file, unit="um")).value == field


def test_what_is_wrong_in_a_wide_row_is_told(tmp_path: Path) -> None:
    wide = ";".join(["1.25"] * 40)
    file = write(tmp_path, f"{wide}|{wide[:-5]}")
    assert "as many as in line 1: 40" in refusal("line 2", file, lambda: read_topography(file, **AREA_NM)).allowed


def test_commas_in_the_numbers_and_between_them_are_refused(tmp_path: Path) -> None:
    file = write(tmp_path, "-3,05,2,75|1,5,-2,25")
    assert '"," where commas separate' in refusal("delimiter", file, lambda: read_topography(file, **AREA_NM)).allowed
    assert read_topography(file, **AREA_NM, delimiter=",").values.shape == (2, 4)
    refusal("delimiter", write(tmp_path, "3,05e-3,2,75e-3|1,2,3,4"), lambda: read_topography(file, **AREA_NM))
    whole = read_topography(write(tmp_path, "3,5,2,75|1,5,-2,25"), **AREA_NM)  # may be so
    assert whole.values.shape == (2, 4)


def test_a_text_in_utf_16_is_read_as_it_is(tmp_path: Path) -> None:
    file = tmp_path / "t.txt"
    file.write_text("# Value units: µm\n1\t2\n3\t4,5\n", encoding="utf-16")
    np.testing.assert_allclose(read_topography(file, dimensions=2, spacing=1.0).values, [[1e3, 2e3], [3e3, 4.5e3]])


GRID = "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 30\nNODATA_value -9999\n1 2 3\n4 -9999 6\n"


def test_a_grid_of_a_geographic_system_is_read_from_its_lowest_row_with_what_is_missing(tmp_path: Path) -> None:
    file = tmp_path / "elevation.asc"
    file.write_text(GRID)
    grid = read_topography(file, unit="m", fill="nearest")
    assert (grid.spacing, grid.filled) == ((3e10, 3e10), pytest.approx(1 / 6))
    np.testing.assert_array_equal(grid.values[1], [1e9, 2e9, 3e9])
    refusal("heights", file, lambda: read_topography(file, unit="m"))
    refusal("unit", file, lambda: read_topography(file))
    refusal("spacing", file, lambda: read_topography(file, unit="m", fill="nearest", spacing=10.0))


@pytest.mark.parametrize("names", ["x/um z/nm", "# x/um z/nm", "x / um, z / nm"])
def test_units_behind_a_slash_are_those_of_the_columns(tmp_path: Path, names: str) -> None:
    mark = "," if "," in names else " "
    file = write(tmp_path, f"{names}|0{mark}1|0.5{mark}2|1{mark}4", ".txt")
    same(read_topography(file), np.array([1.0, 2.0, 4.0]), (500.0,))


def test_a_negative_width_is_refused_with_its_line(tmp_path: Path) -> None:
    file = write(tmp_path, "# Width: -320 nm|1 2|3 4", ".txt")
    assert refusal("line 1", file, lambda: read_topography(file, **AREA_NM)).value == "-320 nm"


@pytest.mark.parametrize(
    ("grid", "values"),
    [
        ("ncols 2\nnrows 2\ncellsize 30\n1 2\n3 -9999\n", [[3, np.nan], [1, 2]]),
        ("ncols 3\nnrows 2\ndx 30\ndy 30\nnodata -1\n1 1 1\n1 0 -1\n", [[1, 0, np.nan], [1, 1, 1]]),
        (
            "ncols 2\nnrows 2\ncellsize 30\nnodata_value -3.4028234663852886e+38\n1 2\n3 -3.40282e+38\n",
            [[3, np.nan], [1, 2]],
        ),
        (
            "NCOLS 2\nNROWS 2\nCELLSIZE 30\nNODATA_VALUE -3.4028234663852886e+38\n1 2\n3 -3.40282346639e+38\n",
            [[3, np.nan], [1, 2]],
        ),
    ],
)
@pytest.mark.parametrize("suffix", [".asc", ".txt"])
def test_a_small_grid_is_a_grid_and_what_is_missing_may_be_rounded(tmp_path: Path, grid, values, suffix) -> None:
    file = tmp_path / f"grid{suffix}"
    file.write_text(grid)
    read = read_topography(file, unit="nm", fill="nearest")
    known = np.isfinite(values)
    np.testing.assert_array_equal(read.values[known], np.array(values)[known])
    assert (read.spacing, read.filled) == ((30.0, 30.0), pytest.approx(1 / np.size(values)))
    refusal("dimensions", file, lambda: read_topography(file, unit="nm", dimensions=1))
    file.write_text(grid.replace("2\n", "3\n", 1))
    with pytest.raises(InputError):
        read_topography(file, unit="nm", fill="nearest")


def test_another_asc_file_is_one_of_an_instrument(tmp_path: Path) -> None:
    file = tmp_path / "scan.asc"
    file.write_text("x-pixels = 2\n1 2\n3 4\n")
    assert "SurfaceTopography" in str(refusal("path", file, lambda: read_topography(file)))


@pytest.mark.parametrize("words", ["# Spring constant 0.2 N/m", "# N/m", "# data/m", "# Field 3 kV/mm"])
def test_other_units_in_words_before_the_numbers_are_not_those_of_columns(tmp_path: Path, words: str) -> None:
    file = write(tmp_path, f"{words}|1,2,3|4,5,6")
    assert read_topography(file, **AREA_NM | {"spacing": 1.0}).values[1, 2] == 6
    refusal("unit", file, lambda: read_topography(file, dimensions=2, spacing=1.0))


def test_two_statements_that_differ_are_refused(tmp_path: Path) -> None:
    file = write(tmp_path, "# Value units: um|# Value units: nm|1 2|3 4", ".txt")
    assert (
        "um, as line 1 says"
        in refusal("line 2", file, lambda: read_topography(file, dimensions=2, spacing=1.0)).allowed
    )


def test_a_matrix_of_matlab_has_a_row_for_each_y(tmp_path: Path) -> None:
    file = tmp_path / "m.mat"
    savemat(file, {"z": HEIGHTS, "dx": 10.0})
    same(read_topography(file, spacing=SPACING))
    savemat(file, {"z": HEIGHTS[0], "dx": 10.0})
    same(read_topography(file, spacing=1.0), HEIGHTS[0], (1.0,))
    savemat(file, {"z": HEIGHTS, "mask": HEIGHTS > 0, "words": np.array([["a", "b"], ["c", "d"]], object)})
    same(read_topography(file, spacing=SPACING))
    savemat(file, {"a": HEIGHTS, "b": HEIGHTS})
    refusal("variable", file, lambda: read_topography(file, spacing=1.0))
    same(read_topography(file, spacing=SPACING, variable="b"))
    for content in (b"", b"abc"):
        file.write_bytes(content)
        refusal("path", file, lambda: read_topography(file, spacing=1.0, variable="b"))


FORMATS = "NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"


@pytest.mark.parametrize("records", [False, True])
@pytest.mark.parametrize("form", FORMATS)
def test_a_classic_netcdf_file_that_is_cut_off_is_refused(tmp_path: Path, form: str, records: bool) -> None:
    file = tmp_path / "t.nc"
    with netCDF4.Dataset(file, "w", format=form) as data:
        data.mode, data.variables_seen = "tapping", np.array([3, 4], "i2")
        for name, size in (("y", None if records else 3), ("x", 4), ("n", 5)):
            data.createDimension(name, size)
        data.createVariable("odd", "i1", ("n",))[:] = 1
        entry = data.createVariable("z", float, ("y", "x"))
        entry[:], entry.units = HEIGHTS, "nm"
        data.createVariable("row", "i2", ("y",))[:] = [1, 2, 3]
    same(read_topography(file, spacing=SPACING, variable="z"))
    whole = file.read_bytes()
    for cut in (8, 40, 100, len(whole) - 30):
        file.write_bytes(whole[:-cut])
        refusal("path", file, lambda: read_topography(file, spacing=SPACING, variable="z"))


def test_heights_beyond_all_sizes_and_what_is_no_file_are_refused(tmp_path: Path) -> None:
    file = write(tmp_path, "1e301 2|3 4", ".txt")
    refusal("heights", file, lambda: read_topography(file, **AREA_NM))
    with refused("path", "the name of a file"):
        read_topography(HEIGHTS)


@pytest.mark.parametrize("text", ["1 2 3 4|5 6 7 8.5", "1;2;3;4|5;6;7;8.5"])
@pytest.mark.parametrize(("suffix", "compress"), [("gz", gzip.compress), ("bz2", bz2.compress)])
def test_a_compressed_text_is_read_as_it_is(tmp_path: Path, text: str, suffix: str, compress) -> None:
    file = tmp_path / f"t.txt.{suffix}"
    file.write_bytes(compress(text.replace("|", "\n").encode()))
    same(read_topography(file, unit="nm", spacing=SPACING), AREA)
    file.write_bytes(file.read_bytes()[:-9])
    refusal("path", file, lambda: read_topography(file, unit="nm", spacing=SPACING))


def test_a_compressed_text_that_grows_too_long_is_refused(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr("contactsim.topography_files.text_lines.MAX_TEXT", 10**6)
    file = tmp_path / "t.txt.gz"
    file.write_bytes(gzip.compress(b"1 2\n" * 10**6))
    assert "a text of at most" in refusal("path", file, lambda: read_topography(file, unit="nm", spacing=1)).allowed


def test_positions_rounded_to_their_last_digit_are_equally_spaced_where_there_are_many(tmp_path: Path) -> None:
    step, count = 0.15624544, 400
    rows = [f"{number * step:.1f},1.5" for number in range(count)]
    topography = read_topography(write(tmp_path, "|".join(rows)), unit="um")
    assert topography.spacing[0] == pytest.approx(1e3 * step, rel=1e-3)
    rows[200] = f"{200 * step + 0.3:.1f},1.5"
    file = write(tmp_path, "|".join(rows))
    refusal("positions", file, lambda: read_topography(file, unit="um"))
    rows[200] = f"{200 * step:.1f},1.5"
    after = write(tmp_path, "|".join(["a, b", *["", "# c"] * 300, *rows]))  # blank lines do not count as rows
    assert read_topography(after, unit="um").spacing[0] == pytest.approx(1e3 * step, rel=1e-3)
    few = write(tmp_path, "0,1|1,1|2,1|4,1")
    refusal("positions", few, lambda: read_topography(few, unit="um"))


@pytest.mark.parametrize("row", ["1.O5", "1,5;2,3", "[nm]", "-"])
def test_a_first_row_that_does_not_parse_is_not_taken_for_a_header(tmp_path: Path, row: str) -> None:
    file = write(tmp_path, f"{row}|1|2|3", ".txt")
    assert refusal("line 1, column 1", file, lambda: read_topography(file, dimensions=1, **NM)).value == row


def test_the_micro_sign_of_a_latin1_file_is_understood(tmp_path: Path) -> None:
    file = write(tmp_path, "x [\u00b5m], z [\u00b5m]|0,1|1,2", encoding="latin-1")
    same(read_topography(file), [1e3, 2e3], (1e3,))


def test_a_file_of_points_is_read_in_the_memory_of_its_numbers_and_each_height_keeps_its_place(tmp_path: Path) -> None:
    heights = np.random.default_rng(2).normal(size=(100, 150))
    rows = np.stack([*np.meshgrid(np.arange(150.0), 0.3 * np.arange(100)), heights], axis=-1).reshape(-1, 3)
    file = tmp_path / "t.xyz"
    np.savetxt(file, rows[::-1], header="x [nm] y [nm] z [nm]", comments="")
    read_topography(file)  # imports and caches
    tracemalloc.start()
    topography = read_topography(file)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    same(topography, heights, (0.3, 1.0))
    assert peak < 200 * heights.size  # line by line it was 340 bytes a point


def test_a_diagonal_of_points_is_refused_without_the_memory_of_its_square(tmp_path: Path) -> None:
    file = write(tmp_path, "|".join(f"{i} {i} {i}" for i in range(20_000)), ".xyz")
    error = refusal("positions", file, lambda: read_topography(file, unit="nm"))
    assert error.value == "399980000 of 20000 × 20000 points missing, the first at x = 1 nm, y = 0 nm"


# --- missing points -----------------------------------------------------------------------------------------------

HOLED = np.where((HEIGHTS == -1.0) | (HEIGHTS == 3.0), np.nan, HEIGHTS)


@pytest.mark.parametrize(("way", "corner"), [("nearest", -2.25), ("linear", -2.25), ("lowest", -9.0)])
def test_missing_points_are_filled_by_the_named_way_and_the_share_is_told(tmp_path, way, corner):
    heights = HEIGHTS.copy()
    heights[0, 3], heights[1, 3] = np.nan, -2.25
    topography = read_topography(npy_file(tmp_path, heights), spacing=1.0, fill=way)
    assert topography.filled == pytest.approx(1 / 12)
    np.testing.assert_array_equal(topography.values[np.isfinite(heights)], heights[np.isfinite(heights)])
    assert topography.values[0, 3] == corner


def test_a_plane_with_holes_is_filled_linearly(tmp_path: Path) -> None:
    plane = 2.0 * np.arange(12)[:, None] - 3.0 * np.arange(9)
    holed = plane.copy()
    holed[3:6, 4:7] = holed[9, 2] = np.nan
    filled = read_topography(npy_file(tmp_path, holed), spacing=1.0, fill="linear")
    np.testing.assert_allclose(filled.values, plane, atol=1e-9)
    assert filled.filled == pytest.approx(10 / plane.size)
    plane[-2:] = np.nan  # beyond a single row of points
    edge = read_topography(npy_file(tmp_path, plane), spacing=1.0, fill="linear")
    np.testing.assert_array_equal(edge.values[-2:], plane[[-3, -3]])
    line = np.append(plane[0], np.nan)
    line[3] = np.nan
    filled = read_topography(npy_file(tmp_path, line), spacing=1.0, fill="linear")
    np.testing.assert_allclose(filled.values, [*plane[0], plane[0, -1]])


def test_points_that_a_grid_lacks_are_filled_where_that_is_asked_for(tmp_path: Path) -> None:
    file = write(tmp_path, POINTS_TEXT[:-7], ".xyz")
    topography = read_topography(file, unit="nm", fill="nearest")
    assert topography.filled == pytest.approx(1 / 6)
    np.testing.assert_array_equal(topography.values[np.isfinite(POINTS)].shape, (6,))
    sparse = write(tmp_path, "0 0 1|1 1 2|2 2 3", ".xyz")
    error = refusal("positions", sparse, lambda: read_topography(sparse, unit="nm", fill="nearest"))
    assert "50% missing" in error.allowed


def test_a_hole_is_refused_with_the_ways_to_fill_it_and_half_of_the_points_cannot_be_filled(tmp_path: Path) -> None:
    file = npy_file(tmp_path, HOLED)
    assert (
        "`fill` as one of linear, nearest, lowest"
        in refusal("heights", file, lambda: read_topography(file, spacing=1)).allowed
    )
    assert refusal("fill", file, lambda: read_topography(file, spacing=1, fill="zero")).value == "zero"
    empty = npy_file(tmp_path, np.where(HEIGHTS > 0, np.nan, HEIGHTS))
    error = refusal("heights", empty, lambda: read_topography(empty, spacing=1, fill="lowest"))
    assert "at most 50% missing" in error.allowed


# --- arrays -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["<f4", ">f8", "<i2", ">u2", "f2"])
def test_an_array_of_any_kind_becomes_float64_in_nm(tmp_path: Path, kind: str) -> None:
    for values, spacing in (([3, 1, 2], (2.0,)), ([[3, 1], [2, 4]], (2.0, 2.0))):
        file = npy_file(tmp_path, np.array(values).astype(kind))
        same(read_topography(file, spacing=np.float32(2)), values, spacing)
        same(read_topography(file, spacing=2, unit="\u00b5m"), np.multiply(values, 1e3), spacing)


@pytest.mark.parametrize(
    "values", [["a", "b"], [True, False], [1j, 2j], 5.0, [1.0], [], [[1.0, 2.0]], np.ones((2, 2, 2)), [[1j, 2], [3, 4]]]
)
def test_arrays_other_than_two_or_more_real_numbers_each_way_are_refused(tmp_path: Path, values: object) -> None:
    file = npy_file(tmp_path, values)
    error = refusal("heights", file, lambda: read_topography(file, spacing=1))
    assert str(np.asarray(values).shape) in str(error.value)


def test_an_array_of_other_dimensions_than_requested_is_refused(tmp_path: Path) -> None:
    for values, dimensions in ((HEIGHTS, 1), (HEIGHTS[0], 2)):
        file = npy_file(tmp_path, values)
        error = refusal("heights", file, lambda: read_topography(file, spacing=1, dimensions=dimensions))  # noqa: B023
        assert f"{dimensions}D" in error.allowed


def test_an_array_in_an_archive_is_read_as_the_array_itself(tmp_path: Path) -> None:
    file = tmp_path / "t.npz"
    np.savez(file, elevation=HEIGHTS, dx=DX)
    same(read_topography(file, spacing=SPACING))
    np.savez_compressed(file, elevation=HEIGHTS, other=HEIGHTS[0])
    same(read_topography(file, spacing=SPACING, variable="elevation"))
    assert "['elevation', 'other']" in refusal("variable", file, lambda: read_topography(file, spacing=1)).allowed
    np.savez(file, a=np.array([1, None], dtype=object))
    refusal("path", file, lambda: read_topography(file, spacing=1, variable="a"))
    file.write_bytes(file.read_bytes()[:-40])
    refusal("path", file, lambda: read_topography(file, spacing=1))


def test_heights_too_large_for_nm_and_objects_and_short_files_are_refused(tmp_path: Path) -> None:
    file = npy_file(tmp_path, [1e305, 0.0])
    assert refusal("heights", file, lambda: read_topography(file, spacing=1, unit="m")).value == "inf in row 1"
    npy_file(tmp_path, np.array([1, None], dtype=object))
    refusal("path", file, lambda: read_topography(file, spacing=1))
    npy_file(tmp_path, HEIGHTS)
    file.write_bytes(file.read_bytes()[:-4])
    refusal("path", file, lambda: read_topography(file, spacing=1))


@pytest.mark.parametrize(
    "shape", [(10**12,), (10**6, 10**6), (2**28 + 1,), (10**30,), (-5,), (0,)], ids=lambda shape: str(shape)
)
def test_a_header_that_claims_more_than_there_is_takes_no_memory(tmp_path: Path, shape: tuple[int, ...]) -> None:
    file = tmp_path / "t.npy"
    with file.open("wb") as stream:
        np.lib.format.write_array_header_1_0(stream, {"descr": "<f8", "fortran_order": False, "shape": shape})
        stream.write(b"\0" * 80)
    tracemalloc.start()
    with pytest.raises(InputError) as caught:
        read_topography(file, spacing=1)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 1e6
    assert caught.value.file == file


def test_a_netcdf_file_that_claims_a_terabyte_takes_no_memory(tmp_path: Path) -> None:
    file = tmp_path / "t.nc"
    with netCDF4.Dataset(str(file), "w") as data:
        data.createDimension("y", 10**6)
        data.createDimension("x", 10**6)
        data.createVariable("heights", "f8", ("y", "x"), chunksizes=(100, 100), zlib=True).units = "nm"
    error = refusal("heights", file, lambda: read_topography(file, spacing=1))
    assert str(error.value) == "shape (1000000, 1000000)"
    assert error.allowed == "at most 268435456 numbers"


@pytest.mark.parametrize("spacing", [0, -1.0, [1.0], [1, 2, 3], (1, 0)])
def test_a_spacing_that_is_not_one_or_two_positive_numbers_is_refused(tmp_path: Path, spacing: object) -> None:
    for file in (npy_file(tmp_path, HEIGHTS), nc_file(tmp_path)):
        refusal("spacing", file, lambda: read_topography(file, spacing=spacing))  # noqa: B023


@pytest.mark.parametrize("path", [None, 3, "none.npy", "none.tif", "."])
def test_a_path_without_a_file_is_refused(path: object) -> None:
    with pytest.raises(InputError, match=r"path: .* (an existing file|the name of a file)"):
        read_topography(path, spacing=1)


@pytest.mark.parametrize("suffix", [".npy", ".nc"])
@pytest.mark.parametrize("content", [b"", b"1 2\n3 4\n", b"\x93NUMPY\x01\x00", b"\x89HDF\r\n\x1a\n", b"CDF\x01"])
def test_a_file_that_is_not_what_its_suffix_says_is_refused(tmp_path: Path, suffix: str, content: bytes) -> None:
    file = tmp_path / f"t{suffix}"
    file.write_bytes(content)
    assert suffix in refusal("path", file, lambda: read_topography(file, spacing=1)).allowed
    assert refusal("delimiter", file, lambda: read_topography(file, spacing=1, delimiter=",")).value == ","


def test_heights_made_by_hand_are_checked_and_owned() -> None:
    refusal("heights", "mine", lambda: Topography(np.array([1.0, np.nan]), 1.0, "mine"))
    refusal("spacing", "mine", lambda: Topography(HEIGHTS, (1.0, 0.0), "mine"))
    masked = np.ma.array(HEIGHTS, mask=HEIGHTS == 6.0)
    error = refusal("heights", "mine", lambda: Topography(masked, SPACING, "mine"))
    assert error.value == "1 of 12 points missing or not finite, the first nan in row 3, column 2"
    mine = HEIGHTS.copy()
    topography = Topography(mine, SPACING, "mine")
    mine[:] = 0
    same(topography)


# --- netCDF -------------------------------------------------------------------------------------------------------

BARE: dict[str, tuple[np.ndarray, str | None]] = {}
NETCDF = [
    ({}, {}),
    ({"places": BARE}, {"spacing": SPACING}),
    ({"places": {"x": (X, "nm")}}, {"spacing": SPACING}),
    ({"heights": HEIGHTS[::-1], "places": {"y": (Y[::-1], "nm"), "x": (X, "nm")}}, {}),
    ({"heights": HEIGHTS[:, ::-1], "places": {"y": (Y, "nm"), "x": (X[::-1], "nm")}}, {}),
    ({"heights": HEIGHTS.T, "order": "xy"}, {}),
    ({"order": "ij", "places": {"i_down": (Y, "nm"), "j_along": (X, "nm")}, "coordinates": "j_along i_down"}, {}),
    ({"heights": HEIGHTS * 10, "units": "angstrom", "places": {"y": (Y / 1e9, "m"), "x": (X / 1e6, "mm")}}, {}),
    ({"heights": HEIGHTS / 1e3, "units": None, "unit": "\u00b5m"}, {}),
    ({"units": None, "places": {"y": (Y / 1e3, "um"), "x": (X, None)}}, {"unit": "nm"}),
]


@pytest.mark.parametrize(("content", "options"), NETCDF)
def test_a_netcdf_file_means_these_heights(tmp_path: Path, content: dict, options: dict) -> None:
    same(read_topography(nc_file(tmp_path, **content), **options))


def test_a_netcdf_file_of_a_line_is_a_line_reversed_where_positions_descend(tmp_path: Path) -> None:
    same(read_topography(nc_file(tmp_path, HEIGHTS[0], "nm", "x", {"x": (X, "nm")})), HEIGHTS[0], (DX,))
    same(read_topography(nc_file(tmp_path, HEIGHTS[0], "nm", "x", {"x": (X[::-1], "nm")})), HEIGHTS[0, ::-1], (DX,))


BAD_NETCDF = [
    ({"units": None}, {}, "unit", None, "heights"),
    ({"places": {"y": (Y, None), "x": (X, "nm")}}, {}, "unit", None, "for y "),
    ({}, {"unit": "um"}, "unit", "um", "nm"),
    ({"places": {"x": (X, "nm")}}, {}, "spacing", None, "(dy, dx)"),
    ({}, {"spacing": (DX, DY)}, "spacing", DX, "2.5 nm"),
    ({"places": {"x": (X**3, "nm")}}, {}, "x", None, "equal steps"),
    ({"heights": np.where(HEIGHTS == 6, -999.0, HEIGHTS)}, {}, "heights",
     "1 of 12 points missing or not finite, the first nan in row 3, column 2", "none missing"),
    ({}, {"dimensions": 1}, "variable", None, "along a line"),
    ({}, {"variable": "none"}, "variable", "none", "heights"),
    ({"heights": HEIGHTS[0], "order": "x", "places": BARE}, {"dimensions": 2}, "variable", None, "over an area"),
]  # fmt: skip


@pytest.mark.parametrize(("content", "options", "key", "value", "allowed"), BAD_NETCDF)
def test_a_bad_netcdf_file_is_refused(tmp_path: Path, content, options, key, value, allowed) -> None:
    file = nc_file(tmp_path, **content)
    error = refusal(key, file, lambda: read_topography(file, **options))
    assert allowed in error.allowed
    assert value is None or error.value == value


def test_the_netcdf_variable_is_named_or_looks_like_heights(tmp_path: Path) -> None:
    file = nc_file(tmp_path)
    with netCDF4.Dataset(str(file), "a") as data:
        for name, kind, factor in (("other", "f8", 2), ("packed", "i2", 1), ("flag", "i4", 0)):
            field = data.createVariable(name, kind, ("y", "x"))
            if kind == "i2":
                field.scale_factor = 0.25
            field.units = "nm"
            field[:] = factor * HEIGHTS
        data["x"].axis = "X"
    same(read_topography(file))
    same(read_topography(file, variable="other"), 2 * HEIGHTS)
    same(read_topography(file, variable="packed"))
    with netCDF4.Dataset(str(file), "a") as data:
        data.renameVariable("heights", "trace")
    error = refusal("variable", file, lambda: read_topography(file))
    assert "'trace', 'other'" in error.allowed or "'other'" in error.allowed


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


def test_an_instrument_file_is_read_turned_and_converted_to_nm(instrument) -> None:
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
    same(read_topography(instrument(phase, Channel())))
    both = instrument(phase, Channel(), Channel(name="Back"))
    assert "['Height', 'Back']" in refusal("variable", both, lambda: read_topography(both)).allowed
    lone = instrument(phase)
    assert refusal("variable", lone, lambda: read_topography(lone)).value == "Phase"


def test_points_missing_from_an_instrument_file_are_refused(instrument) -> None:
    file = instrument(Channel(np.ma.array(HEIGHTS, mask=HEIGHTS < 0).T))
    found = "3 of 12 points missing or not finite, the first nan in row 1, column 3"
    assert refusal("heights", file, lambda: read_topography(file)).value == found


def test_a_line_scan_of_an_instrument_is_a_line_and_refused_as_an_area(instrument) -> None:
    line = Channel(HEIGHTS[0], (NX * DX,))
    line.dim = 1
    file = instrument(line)
    same(read_topography(file), HEIGHTS[0], (DX,))
    assert "2D" in refusal("heights", file, lambda: read_topography(file, dimensions=2)).allowed


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
    same(read_topography(write(tmp_path, "|".join([*head, *rows]), ".asc")))
    bare = write(tmp_path, "|".join(rows), ".asc")
    same(read_topography(bare, unit="m", spacing=SPACING))
    holes = write(tmp_path, "|".join([*head, *rows]).replace("7e-09", "nan"), ".asc")
    assert "1 of 12" in str(refusal("heights", holes, lambda: read_topography(holes)).value)
    junk = write(tmp_path, "no instrument", ".al3d")
    refusal("path", junk, lambda: read_topography(junk))


# --- as a surface -----------------------------------------------------------------------------------------------


def test_a_measured_surface_has_its_own_points_and_periods_in_both_directions(tmp_path: Path) -> None:
    surface = MeasuredSurface(str(nc_file(tmp_path)), "none", "none")
    assert (surface.points, surface.lengths, surface.modes) == (NX, (NY * DY, NX * DX), None)
    np.testing.assert_array_equal(surface.heights(NX), HEIGHTS)
    with pytest.raises(InputError, match=rf"points: got {NY}; allowed: {NX}, the number of points"):
        surface.heights(NY)


def test_a_measured_surface_is_detrended_and_made_periodic_by_the_named_options(tmp_path: Path) -> None:
    file = str(npy_file(tmp_path, HEIGHTS))
    surface = MeasuredSurface(file, spacing=[DY, DX])
    assert surface.lengths == (4 * DY, 6 * DX)
    np.testing.assert_array_equal(
        surface.heights(6), prepare_topography(Topography(HEIGHTS, SPACING), ends="mirror").values
    )
    tapered = MeasuredSurface(file, "quadratic", "window", 2.0, "um")
    np.testing.assert_array_equal(
        tapered.heights(NX), prepare_topography(Topography(HEIGHTS * 1e3, SPACING), "quadratic", "window").values
    )
    assert tapered.lengths == (2.0 * NY, 2.0 * NX)


def test_a_measured_surface_can_be_configured() -> None:
    keys = keys_of(SURFACES["measured_surface"])
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
    (before,) = area(npy_file(tmp_path, HEIGHTS)).runs()
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
    assert float(data.rms_height) == pytest.approx(
        prepare_topography(Topography(heights, SPACING), ends="mirror").values.std(), rel=1e-12
    )


def test_a_measured_surface_with_a_hole_stops_the_study(tmp_path: Path) -> None:
    file = npy_file(tmp_path, np.where(HEIGHTS == 8.0, np.nan, HEIGHTS))
    error = refusal("studies.area.heights", file, lambda: area(file))
    assert error.value == "1 of 12 points missing or not finite, the first nan in row 2, column 3"


def test_an_hdf5_file_without_positions_is_read_by_the_name_of_its_heights(tmp_path: Path) -> None:
    values = np.random.default_rng(0).normal(size=(6, 8))
    with netCDF4.Dataset(str(tmp_path / "surface.h5"), "w") as data:
        data.createDimension("rows", 6)
        data.createDimension("columns", 8)
        data.createVariable("surface", "f8", ("rows", "columns"))[:] = values
    topography = read_topography(tmp_path / "surface.h5", variable="surface", unit="um", spacing=12.0)
    assert np.allclose(topography.values, 1e3 * values, rtol=1e-15)
    assert topography.spacing == (12.0, 12.0)
    with refused("unit", "nm"):
        read_topography(tmp_path / "surface.h5", variable="surface", spacing=12.0)


def test_heights_in_a_group_of_an_hdf5_file_are_named_by_their_path(tmp_path: Path) -> None:
    values = np.random.default_rng(0).normal(size=(6, 8))
    with netCDF4.Dataset(str(tmp_path / "scan.h5"), "w") as data:
        group = data.createGroup("scans").createGroup("first")
        group.createDimension("y", 6)
        group.createDimension("x", 8)
        group.createVariable("data", "f8", ("y", "x"))[:] = values
        group.createVariable("other", "f8", ("y", "x"))[:] = 0
    options = {"unit": "nm", "spacing": 1.0}
    assert np.array_equal(read_topography(tmp_path / "scan.h5", variable="scans/first/data", **options).values, values)
    with refused("variable", "scans/first/data"):
        read_topography(tmp_path / "scan.h5", **options)
