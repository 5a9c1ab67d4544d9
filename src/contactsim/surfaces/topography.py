"""Measured 2D topographies, read so that they can be pressed like synthetic ones.

A topography is a grid of heights in nm, rows along y and columns along x: element (0, 0) has the smallest x and y.
Heights point up as in the file: the largest touches first (for the other side, negate them).
The solvers are periodic and a measurement is not: `contactsim.surfaces.preparation.prepare` removes form and closes the
seams.

Text, numpy and netCDF files are read here; the formats of instruments by the library SurfaceTopography where it is
installed. Its heights have x first, so they are transposed.
"""

from __future__ import annotations

import dataclasses
import importlib
import itertools
import re
import sys
from pathlib import Path

import netCDF4
import numpy as np
from numpy.typing import NDArray

from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.surfaces import io
from contactsim.surfaces.io import TEXT, TOLERANCE

SUFFIXES = (".npy", *TEXT, ".nc")
LIBRARY = "SurfaceTopography"

Pair = tuple[float, float]
Read = tuple[Array, tuple[float | None, float | None]]
"""Heights (ny, nx) and the spacing (dy, dx), None where the file states none; nm."""


@dataclasses.dataclass(frozen=True, eq=False)
class Topography:
    """Heights (ny, nx) in nm, up positive, rows along y; `spacing` (dy, dx) in nm; `source` says where from.

    InputError unless there are two or more finite heights in each direction and two positive finite spacings.
    """

    heights: Array
    spacing: Pair
    source: str | None

    def __post_init__(self) -> None:
        """Check both and keep them as float64 and floats."""
        object.__setattr__(self, "heights", io.finite_numbers(self.heights, "heights", self.source, dims=2))
        object.__setattr__(self, "spacing", _pair(self.spacing, self.source))


def read_topography(
    path: str | Path,
    *,
    spacing: float | Pair | None = None,
    unit: str | None = None,
    variable: str | None = None,
    delimiter: str | None = None,
) -> Topography:
    r"""Read a topography from .npy, .csv, .txt, .dat, .xyz or .nc; from other files if SurfaceTopography is installed.

    spacing: in nm, of both directions or (dy, dx), for files without positions; theirs is used and this must agree.
    unit: of what the file states no unit for; must agree with the heights' if stated; for .npy "nm" if not given.
    variable: of the heights in .nc, the channel in files of instruments. delimiter: "," ";" tab or " ", text only.
    .npy, .csv, .txt, .dat hold a row for each y, from the smallest, with a column for each x; .xyz three columns x y z,
    the points of a complete grid in any order. A unit in a header line like `z [um]`, of .xyz like `x [um] y [um]
    z [nm]`. InputError, with the file, for all else.
    """
    file = io.existing_path(path)
    if file.suffix.lower() in SUFFIXES:
        io.refuse_unused("variable", variable, (".nc",), file)
    io.refuse_unused("delimiter", delimiter, TEXT, file)
    given = (None, None) if spacing is None else _pair(spacing, file)
    heights, found = _read(file, unit, variable, delimiter)
    if None in found and None in given:
        raise InputError("spacing", None, "a spacing in nm, or a pair (dy, dx), since the file states none", file)
    both = zip(found, given, strict=True)
    dy, dx = (asked if own is None else io.check_spacing(own, asked, file) for own, asked in both)
    return Topography(heights, (dy, dx), str(file))


def _pair(spacing: object, file: object) -> Pair:
    """(dy, dx) from one spacing or two."""
    both = list(spacing) if isinstance(spacing, list | tuple | np.ndarray) and np.ndim(spacing) == 1 else [spacing] * 2
    if len(both) != 2:
        raise InputError("spacing", spacing, "a positive finite number, in nm, or a pair (dy, dx) of them", file)
    return io.positive_spacing(both[0], file), io.positive_spacing(both[1], file)


def _read(file: Path, unit: str | None, variable: str | None, delimiter: str | None) -> Read:
    suffix = file.suffix.lower()
    if suffix not in SUFFIXES:
        return _read_instrument(file, unit, variable)
    with io.report_unreadable(file):
        if suffix == ".nc":
            return _read_netcdf(file, unit, variable)
        if suffix == ".npy":
            scale = io.unit_factor("heights", None, "nm" if unit is None else unit, file)
            return io.finite_numbers(io.load_npy(file), "heights", file, scale, 2), (None, None)
        text = io.Text.read(file, delimiter)
        return _read_points(text, unit, file) if suffix == ".xyz" else _read_grid(text, unit, file)


def _read_grid(text: io.Text, unit: str | None, file: Path) -> Read:
    """A row of heights for each y; InputError for points x y z, which look like three columns of heights."""
    table = text.table(range(2, sys.maxsize), "two or more heights 1.5, as many as in the first row", file)
    names = set(re.findall(r"[^\W\d_]+", re.sub(r"[\[(].*?[\])]", "", text.header[1].lower())))
    if table.shape[1] == 3 and (names >= {"x", "y", "z"} or _has_positions(table)):
        found = "three columns, of which two are positions on a grid"
        raise InputError("heights", found, "heights alone; name a file of points x y z .xyz", file)
    scale = io.unit_factor("heights", next(iter(text.units(1, file)), None), unit, file)
    return io.finite_numbers(table, "heights", file, scale, 2), (None, None)


def _has_positions(table: Array) -> bool:
    """Whether two of the columns (rows, 3) are the coordinates of a complete grid."""
    for pair in itertools.combinations(table.T, 2):
        if all(np.isfinite(at).all() and np.ptp(at) > 0 for at in pair):
            try:
                (one, *_), (two, *_) = (_levels(at, "heights", None) for at in pair)
            except InputError:
                continue
            both = one * (two.max() + 1) + two
            if both.max() + 1 == both.size == np.unique(both).size:
                return True
    return False


def _read_points(text: io.Text, unit: str | None, file: Path) -> Read:
    """A line x y z for each point, in any order."""
    x, y, z = text.table(range(3, 4), "three numbers 1.5: x, y and z", file).T
    units = text.units(3, file) or [None] * 3
    (column, left, dx), (row, low, dy) = (
        _levels(io.finite_numbers(at, key, file, io.unit_factor(key, of or unit, None, file)), key, file)
        for key, at, of in (("x", x, units[0]), ("y", y, units[1]))
    )
    scale = io.unit_factor("heights", units[2], unit, file)
    nx, ny = int(column.max()) + 1, int(row.max()) + 1
    places, times = np.unique(row * nx + column, return_counts=True)
    doubled = places[times > 1]
    # The first place that is not where it would be if none were missing.
    missing = next(iter(np.flatnonzero(places != np.arange(places.size))), places.size)
    for kind, count, place in (
        ("given more than once", doubled.size, doubled[0] if doubled.size else 0),
        ("missing", nx * ny - places.size, missing),
    ):
        if count:
            at = f"x = {left + place % nx * dx:.6g} nm, y = {low + place // nx * dy:.6g} nm"
            found = f"{count} of {ny} × {nx} points {kind}, the first at {at}"
            raise InputError("positions", found, "each point of a complete grid once", file)
    heights = np.empty((ny, nx))
    heights[row, column] = z
    return io.finite_numbers(heights, "heights", file, scale, 2), (dy, dx)


def _levels(at: Array, key: str, file: Path) -> tuple[NDArray[np.int64], float, float]:
    """Index of each coordinate (n,) among equally spaced levels, the lowest level and their step."""
    steps = np.diff(np.sort(at))
    low, count = at.min(), np.count_nonzero(steps > steps.max() / 10)  # what is smaller is scatter about one level
    step = float(at.max() - low) / max(count, 1)
    if step == 0:
        raise InputError(key, f"{low:.6g} nm in every row", "two or more values on a grid", file)
    index = np.rint((at - low) / step)
    off = np.abs(at - low - index * step)
    if off.max() > TOLERANCE * step:
        row = int(np.argmax(off))
        found = f"{at[row]:.6g} nm in row {row + 1}, {off[row]:.6g} nm off equal steps of {step:.6g} nm"
        raise InputError(key, found, f"equal steps to {TOLERANCE:g} of the mean step", file)
    return index.astype(np.int64), float(low), step


def _read_netcdf(file: Path, unit: str | None, variable: str | None) -> Read:
    """A variable with y and x as dimensions, in any order, else rows and columns."""
    with netCDF4.Dataset(str(file)) as data:
        found = io.find_heights(data, 2, variable, file)
        steps: list[float | None] = []
        for name in found.dimensions:
            places = io.positions_along(name, data, found, unit, file)
            steps.append(None if places is None else io.mean_step(places, name, file))
        scale = io.unit_factor(found.name, io.stated_unit(found), unit, file)
        heights = io.finite_numbers(found[:], found.name, file, scale, 2)
        heights = heights[tuple(slice(None, None, -1 if step and step < 0 else 1) for step in steps)]
        dy, dx = (step and abs(step) for step in steps)
        return (heights.T, (dx, dy)) if found.dimensions == ("x", "y") else (heights, (dy, dx))


def _read_instrument(file: Path, unit: str | None, variable: str | None) -> Read:
    """What the library SurfaceTopography reads: heights (nx, ny) and sizes in one unit."""
    try:
        library = importlib.import_module(LIBRARY)
    except ImportError as error:
        allowed = f"a name ending in one of {', '.join(SUFFIXES)}; for others install {LIBRARY} (pip install {LIBRARY})"
        raise InputError("path", file.name, allowed, file) from error
    with io.report_unreadable(file, Exception), library.open_topography(str(file)) as reader:
        channels = {each.channel_id: each for each in reader.channels if each.is_height_channel}
        name = reader.default_channel.channel_id if variable is None else variable
        if name not in channels:
            raise InputError("variable", name, f"a channel of heights, of those: {list(channels)}", file)
        channel = channels[name]
        sized = channel.physical_sizes is not None
        read = channel.topography() if sized else channel.topography(physical_sizes=channel.nb_grid_pts)
        if read.unit is not None and unit is not None:
            raise InputError("unit", unit, f"none, the file states {read.unit}", file)
        scale = io.unit_factor("heights", None, unit, file) if read.unit is None else 1.0
        read = read if read.unit is None else read.to_unit("nm")
        heights = io.finite_numbers(read.heights().T, "heights", file, scale, 2)
        dx, dy = (float(step) * scale for step in read.pixel_size)
        return heights, (dy, dx) if sized else (None, None)
