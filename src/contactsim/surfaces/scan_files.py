"""Read measured heights from files of any layout; heights point up as in the file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from contactsim.arguments import FileName, checked
from contactsim.errors import InputError
from contactsim.surfaces.topography import Topography, dimensions_of, read_spacing
from contactsim.topography_files import io
from contactsim.topography_files.instrument import read_instrument
from contactsim.topography_files.io import HDF5, NAMED, SUFFIXES, TEXT, RawHeights
from contactsim.topography_files.missing import REMEDY, fill_missing
from contactsim.topography_files.netcdf import read_netcdf
from contactsim.topography_files.text import is_cell_grid
from contactsim.topography_files.text_layouts import read_text


@checked
def read_topography(
    path: FileName,
    *,
    dimensions: int | None = None,
    spacing: float | Sequence[float] | None = None,
    unit: str | None = None,
    variable: str | None = None,
    delimiter: str | None = None,
    fill: str | None = None,
) -> Topography:
    """Read measured heights along a line or over an area.

    Parameters
    ----------
    path : str or Path
        - ``.npy``, ``.npz``, ``.mat``: heights (n,) or (ny, nx).
        - ``.csv``, ``.txt``, ``.dat``, also with ``.gz`` or ``.bz2``: one column z, two columns x z, or three
          columns x y z with x or y constant are a line; otherwise there is a row for each y, from the smallest, and a
          column for each x. Sizes and units are read from lines before the numbers, such as ``# Width: 12.3 µm``. Three
          columns that are the points x y z of a complete grid, in any order, are an area.
        - ``.asc``, ``.txt``: a grid of a geographic information system (first line: ``ncols 100``), the row of the
          largest y first; `unit` is that of all its lengths.
        - ``.xyz``: the same for a line; over an area the points x y z of a grid.
        - ``.nc``, ``.h5``, ``.hdf5``: a variable with one or two dimensions.
        - others: files of instruments, if the package SurfaceTopography is installed.
    dimensions : int, optional
        1 for a line, 2 for an area; as the file has by default.
    spacing : float or (float, float), optional
        Distance between points in nm, of all directions or (dy, dx). Only files without positions need it; positions
        in the file are used first, and `spacing` must agree with them.
    unit : str, optional
        Unit of all that the file states no unit for; it must agree with the heights' if they have one. Heights in
        ``.npy``, ``.npz`` and ``.mat`` are in nm by default. In a text a header line like ``x [um], z [nm]`` states the
        units of all columns.
    variable : str, optional
        Name of the heights in ``.npz``, ``.mat``, ``.nc`` and ``.h5``, of the channel in a file of an instrument.
    delimiter : {",", ";", tab, " "}, optional
        Separator in a text, " " for any blanks; the rows show it by default.
    fill : {"linear", "nearest", "lowest"}, optional
        How points that are missing or not finite are filled, at most half of them: between the points around a hole,
        as the nearest point, or as the lowest of all. Without it they are refused.

    Returns
    -------
    Topography
        Heights (n,) or (ny, nx) in nm; descending positions are reversed. `filled` is the share of points filled.

    Raises
    ------
    InputError
        For a file that cannot be read, lacks a height or a unit, or has unequal steps.
    """
    file = io.existing_path(path)
    if dimensions not in (None, 1, 2):
        raise InputError("dimensions", dimensions, "1, a line, or 2, an area; as the file has without it", file)
    if io.suffix_of(file) in SUFFIXES:
        io.refuse_unused("variable", variable, NAMED, file)
    io.refuse_unused("delimiter", delimiter, TEXT, file)
    heights, steps = _read(file, dimensions, unit, variable, delimiter, fill is not None)
    filled = 0.0
    if fill is None:
        io.check_finite(heights, "heights", file, REMEDY)
    else:
        heights, filled = fill_missing(heights, fill, file)
    requested = (None,) * heights.ndim if spacing is None else read_spacing(spacing, heights.ndim, file)
    if None in steps and None in requested:
        pair = ", or a pair (dy, dx)" * (heights.ndim == 2)
        raise InputError("spacing", None, f"a spacing in nm{pair}, since the file has no positions", file)
    pairs = zip(steps, requested, strict=True)
    spacings = tuple(_agreed_step(step, asked, file) for step, asked in pairs)
    return Topography(heights, spacings, str(file), filled)


def _read(
    file: Path,
    dimensions: int | None,
    unit: str | None,
    variable: str | None,
    delimiter: str | None,
    with_gaps: bool,
) -> RawHeights:
    """Return the heights and their spacing by the reader of the suffix."""
    suffix = io.suffix_of(file)
    if suffix == ".asc" and is_cell_grid(file):  # other files with this ending are of instruments
        suffix = ".txt"
    if suffix not in SUFFIXES:
        return read_instrument(file, dimensions, unit, variable)
    with io.report_unreadable(file):
        if suffix in HDF5:
            return read_netcdf(file, dimensions, unit, variable)
        if suffix in TEXT:
            return read_text(file, dimensions, unit, delimiter, with_gaps)
        scale = io.unit_factor("heights", None, "nm" if unit is None else unit, file)
        array = io.LOADERS[suffix](file, variable)
        heights = io.real_numbers(array, "heights", file, scale, dimensions or dimensions_of(array))
        return heights, (None,) * heights.ndim


def _agreed_step(step: float | None, requested: float | None, file: Path) -> float:
    """Return the spacing that the file has, or else the requested one; InputError if they differ."""
    if step is None:
        assert requested is not None  # one of the two was checked to be there
        return requested
    return io.check_spacing(step, requested, file)
