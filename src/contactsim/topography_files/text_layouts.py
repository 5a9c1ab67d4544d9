"""Heights in text files: columns of a line, rows of an area, or points of a grid."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactsim.errors import InputError, Words
from contactsim.grid import Array
from contactsim.topography_files import io
from contactsim.topography_files.io import TOLERANCE, RawHeights
from contactsim.topography_files.missing import MAX_SHARE, REMEDY
from contactsim.topography_files.text import Text

MISSING_ROUNDING = 1e-5
"""Relative rounding of the height that stands for a missing point, in a grid of a geographic system."""


def read_text(
    file: Path, dimensions: int | None, unit: str | None, delimiter: str | None, with_gaps: bool = False
) -> RawHeights:
    """Return the heights of a text file and their spacing; without `dimensions` the columns decide.

    with_gaps: points that a grid lacks are NaN; without it they are refused
    """
    text = Text.read(file, delimiter)
    area = POINTS if io.suffix_of(file) == ".xyz" else GRID
    layout = LINE if dimensions == 1 or (dimensions is None and text.width < 3) else area
    if text.header.has_cells:
        if dimensions == 1:
            raise InputError("dimensions", dimensions, "2: the file is a grid", file)
        layout = CELLS
    table = text.table(layout.widths, layout.allowed)
    if dimensions is None and layout is not CELLS and _is_line_scan(table):
        layout = LINE
    elif layout is GRID and _are_points(text, table):
        layout = POINTS
    return layout.convert(text, table, unit, with_gaps)


def _are_points(text: Text, table: Array) -> bool:
    """Return True for three columns x y z: by their names, or as x and y are the positions of a complete grid."""
    if table.shape[1] != 3:
        return False
    names = re.findall(r"[^\W\d_]+", re.sub(r"[\[(].*?[\])]", "", text.header.named[1].lower()))
    if {*names} >= {"x", "y", "z"} or _fill_a_grid(table[:, 0], table[:, 1]):
        return True
    if any(_fill_a_grid(table[:, place], table[:, 2]) for place in (0, 1)):
        content = Words("three columns, the last of which has positions on a grid")
        raise InputError("heights", content, "rows of heights, or points in the order x y z", text.file)
    return False


def _is_line_scan(table: Array) -> bool:
    """Return True for three columns x y z with x or y constant and the other not."""
    if table.shape[1] != 3 or not np.isfinite(table[:, :2]).all():
        return False
    narrow, wide = sorted(np.ptp(table[:, :2], axis=0).tolist())  # they may be in different units
    return bool(narrow == 0 < wide)


def _convert_line(text: Text, table: Array, unit: str | None, with_gaps: bool) -> RawHeights:
    """Return the heights of columns z, x z or x y z; descending positions are reversed."""
    *places, heights = table.T
    units = text.header.column_units(len(places) + 1) or [""] * (len(places) + 1)
    factors = [io.unit_factor("positions", own or unit, None, text.file) for own in units[:-1]]
    roundings = [half * factor for half, factor in zip(text.roundings(len(places)), factors, strict=True)]
    scaled = [
        io.finite_numbers(place, "positions", text.file, factor) for place, factor in zip(places, factors, strict=True)
    ]
    # Of x and y the one that runs first.
    positions = sorted(zip(scaled, roundings, strict=True), key=lambda entry: float(np.ptp(entry[0])), reverse=True)
    if len(positions) == 2 and np.ptp(positions[1][0]) > TOLERANCE * np.ptp(positions[0][0]) / (heights.size - 1):
        raise InputError("positions", Words("x and y that both vary"), "a line scan: x or y constant", text.file)
    scale = text.header.height_factor(units[-1], unit)
    heights = io.real_numbers(heights, "heights", text.file, scale)
    if not positions:
        return heights, (None,)
    step = io.mean_step(positions[0][0], "positions", text.file, positions[0][1])
    return heights if step > 0 else heights[::-1], (abs(step),)


def _convert_grid(text: Text, table: Array, unit: str | None, with_gaps: bool) -> RawHeights:
    """Return a row of heights for each y."""
    scale = text.header.height_factor(next(iter(text.header.column_units(1)), None), unit)
    return io.real_numbers(table, "heights", text.file, scale, 2), text.header.steps(table.shape, unit)


def _convert_cells(text: Text, table: Array, unit: str | None, with_gaps: bool) -> RawHeights:
    """Return the heights of a grid of a geographic information system, from its last row, the smallest y, on."""
    steps = text.header.steps(table.shape, unit)
    is_missing = np.isclose(table, text.header.missing, rtol=MISSING_ROUNDING, atol=0)
    scale = io.unit_factor("heights", None, unit, text.file)
    heights = io.real_numbers(np.where(is_missing, np.nan, table), "heights", text.file, scale, 2)
    if not with_gaps:
        io.check_finite(heights, "heights", text.file, REMEDY)  # by the rows of the file
    return heights[::-1], steps


def _fill_a_grid(row_places: Array, column_places: Array) -> bool:
    """Return True if two columns of numbers (rows,) are the coordinates of a complete grid, each point once."""
    if not all(np.isfinite(places).all() and np.ptp(places) > 0 for places in (row_places, column_places)):
        return False
    try:
        (row, *_), (column, *_) = (_levels(places, "heights", None) for places in (row_places, column_places))
    except InputError:
        return False
    places = row * (column.max() + 1) + column
    return bool(places.max() + 1 == places.size == np.unique(places).size)


def _convert_points(text: Text, table: Array, unit: str | None, with_gaps: bool) -> RawHeights:
    """Return the heights of points x y z, in any order."""
    file = text.file
    x, y, z = table.T
    units = text.header.column_units(3) or [""] * 3
    (column, left, dx), (row, low, dy) = (
        _levels(io.finite_numbers(places, key, file, io.unit_factor(key, own or unit, None, file)), key, file)
        for key, places, own in (("x", x, units[0]), ("y", y, units[1]))
    )
    scale = text.header.height_factor(units[2], unit)
    nx, ny = int(column.max()) + 1, int(row.max()) + 1
    places, times = np.unique(row * nx + column, return_counts=True)
    doubled = places[times > 1]
    # The first place that is not where it would be if none were missing.
    missing = next(iter(np.flatnonzero(places != np.arange(places.size))), places.size)
    for kind, count, place in (
        ("given more than once", doubled.size, doubled[0] if doubled.size else 0),
        ("missing", nx * ny - places.size, missing),
    ):
        if count and not (with_gaps and kind == "missing"):
            place_text = f"x = {left + place % nx * dx:.6g} nm, y = {low + place // nx * dy:.6g} nm"
            problem = f"{count} of {ny} × {nx} points {kind}, the first at {place_text}"
            raise InputError("positions", Words(problem), "each point of a complete grid once", file)
    if places.size < nx * ny * (1 - MAX_SHARE):
        problem = f"{nx * ny - places.size} of {ny} × {nx} points missing"
        raise InputError("positions", Words(problem), f"at most {MAX_SHARE:.0%} missing, to be filled", file)
    heights = np.full((ny, nx), np.nan)
    heights[row, column] = z
    return io.real_numbers(heights, "heights", file, scale, 2), (dy, dx)


def _levels(places: Array, key: str, file: Path | None) -> tuple[NDArray[np.int64], float, float]:
    """Return the index of each coordinate (n,) among equally spaced levels, the lowest level and their step."""
    steps = np.diff(np.sort(places))
    low, count = places.min(), np.count_nonzero(steps > steps.max() / 10)  # what is smaller is scatter about one level
    step = float(places.max() - low) / max(int(count), 1)
    if step == 0:
        raise InputError(key, Words(f"{low:.6g} nm in every row"), "two or more values on a grid", file)
    index = np.rint((places - low) / step)
    off = np.abs(places - low - index * step)
    if off.max() > TOLERANCE * step:
        row = int(np.argmax(off))
        problem = f"{places[row]:.6g} nm in row {row + 1}, {off[row]:.6g} nm off equal steps of {step:.6g} nm"
        raise InputError(key, Words(problem), f"equal steps to {TOLERANCE:g} of the mean step", file)
    return index.astype(np.int64), float(low), step


class Layout(NamedTuple):
    """Meaning of the columns of a text: their possible numbers, those in words, and the conversion to heights."""

    widths: range
    allowed: str
    convert: Callable[[Text, Array, str | None, bool], RawHeights]


LINE = Layout(range(1, 4), "one to three in each row", _convert_line)
GRID = Layout(range(2, sys.maxsize), "two or more heights in each row", _convert_grid)
CELLS = Layout(GRID.widths, GRID.allowed, _convert_cells)
POINTS = Layout(range(3, 4), "three in each row: x, y and z", _convert_points)
