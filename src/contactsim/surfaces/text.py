"""Heights in text files: columns of a line, rows of an area, or points of a grid."""

from __future__ import annotations

import itertools
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, TextIO

import numpy as np
from numpy.typing import NDArray

from contactsim.errors import InputError, Words
from contactsim.grid import Array
from contactsim.surfaces import io
from contactsim.surfaces.io import TOLERANCE, RawHeights


def read_text(file: Path, dimensions: int | None, unit: str | None, delimiter: str | None) -> RawHeights:
    """Return the heights of a text file and their spacing; without `dimensions` the columns decide."""
    text = Text.read(file, delimiter)
    area = POINTS if file.suffix.lower() == ".xyz" else GRID
    layout = LINE if dimensions == 1 or (dimensions is None and text.width < 3) else area
    table = text.table(layout.widths, layout.allowed)
    if dimensions is None and _is_line_scan(table):
        layout = LINE
    return layout.convert(text, table, unit)


def _is_line_scan(table: Array) -> bool:
    """Return True for three columns x y z with x or y constant and the other not."""
    if table.shape[1] != 3 or not np.isfinite(table[:, :2]).all():
        return False
    narrow, wide = sorted(np.ptp(table[:, :2], axis=0).tolist())  # they may be in different units
    return bool(narrow == 0 < wide)


@dataclass(frozen=True)
class Text:
    """A text file of numbers.

    `header` is the number and the text of its header line, `first` the number of the first row's line, `width` the
    number of its fields, and `mark` the separator.
    """

    file: Path
    header: tuple[int, str]
    first: int
    width: int
    mark: str

    @classmethod
    def read(cls, file: Path, delimiter: str | None) -> Text:
        """Return the text of a file; without a delimiter its first rows show the separator."""
        if delimiter not in (None, ",", ";", "\t", " "):
            raise InputError("delimiter", delimiter, 'one of "," ";" tab " "', file)
        rows = list(itertools.islice(_rows(file), 3))
        # The second row, surely no header, has the separator: a semicolon, else a comma, else blanks.
        mark = delimiter or next((sign for sign in ";," if any(sign in line for _, line in rows[1:2])), " ")
        # A header begins like a name and has no number, so that a mistyped first row, `1.O5`, is not taken for one.
        named = bool(rows) and (rows[0][1][0].isalpha() or rows[0][1][0] in "\"'")
        header = rows.pop(0) if named and set(_numbers(rows[0][1], mark)) == {None} else (0, "")
        if len(rows) < 2:
            raise InputError("heights", Words(f"{len(rows)} rows"), "two or more rows of numbers", file)
        return cls(file, header, rows[0][0], len(_numbers(rows[0][1], mark)), mark)

    def units(self, columns: int) -> list[str]:
        """Return the units of all columns in the header, like `x [um]`, or no unit; InputError for units of some."""
        units = re.findall(r"[\[(]([^\])]*)[\])]", self.header[1])
        if len(units) not in (0, columns):
            allowed = f"a unit for each of {columns} columns, or none"
            raise InputError(f"line {self.header[0]}", self.header[1], allowed, self.file)
        return units

    def table(self, widths: range, allowed: str) -> Array:
        """Return the numbers (rows, columns); InputError for a line whose number of columns is not in `widths`."""
        table = self._load_at_once()
        if table is not None and table.shape[1] in widths:
            return table
        rows: list[Array] = []
        for number, line in _rows(self.file):
            if number < self.first:
                continue
            values = _numbers(line, self.mark)
            if None in values or len(values) not in widths or len(values) != len(rows[0] if rows else values):
                raise InputError(f"line {number}", line, allowed, self.file)
            rows.append(np.array(values, dtype=np.float64))
        return np.array(rows)

    def _load_at_once(self) -> Array | None:
        """Return all numbers, much faster than line by line; None if a line is anything else, such as a comment."""
        mark = None if self.mark == " " else self.mark
        with _open_text(self.file) as stream:
            try:
                return np.loadtxt(stream, delimiter=mark, comments=None, skiprows=self.first - 1, ndmin=2)
            except ValueError:
                return None


def _open_text(file: Path) -> TextIO:
    """Open a text file; a byte-order mark is dropped and bytes that are not UTF-8 are kept."""
    return file.open(encoding="utf-8-sig", errors="surrogateescape")


def _rows(file: Path) -> Iterator[tuple[int, str]]:
    """Yield the lines other than comments and blank ones, with their numbers."""
    with _open_text(file) as stream:
        for number, text in enumerate(stream, 1):
            line = text.replace("\udcb5", "\u03bc").strip()  # latin-1 micro sign
            if line and not line.startswith("#"):
                yield number, line


def _numbers(line: str, mark: str) -> list[float | None]:
    """Return the numbers of a line, None for a field that is not a number; the mark " " stands for any blanks."""
    values: list[float | None] = []
    for field in line.split() if mark == " " else line.split(mark):
        try:
            values.append(None if "_" in field else float(field))
        except ValueError:
            values.append(None)
    return values


def _convert_line(text: Text, table: Array, unit: str | None) -> RawHeights:
    """Return the heights of columns z, x z or x y z; descending positions are reversed."""
    *places, heights = table.T
    units = text.units(len(places) + 1) or [""] * (len(places) + 1)
    positions = [
        io.finite_numbers(place, "positions", text.file, io.unit_factor("positions", own or unit, None, text.file))
        for place, own in zip(places, units, strict=False)
    ]
    positions.sort(key=lambda place: float(np.ptp(place)), reverse=True)  # of x and y the one that runs first
    if len(positions) == 2 and np.ptp(positions[1]) > TOLERANCE * np.ptp(positions[0]) / (heights.size - 1):
        raise InputError("positions", Words("x and y that both vary"), "a line scan: x or y constant", text.file)
    scale = io.unit_factor("heights", units[-1], unit, text.file)
    heights = io.finite_numbers(heights, "heights", text.file, scale)
    if not positions:
        return heights, (None,)
    step = io.mean_step(positions[0], "positions", text.file)
    return heights if step > 0 else heights[::-1], (abs(step),)


def _convert_grid(text: Text, table: Array, unit: str | None) -> RawHeights:
    """Return a row of heights for each y; InputError for points x y z, which look like three columns of heights."""
    names = set(re.findall(r"[^\W\d_]+", re.sub(r"[\[(].*?[\])]", "", text.header[1].lower())))
    if table.shape[1] == 3 and (names >= {"x", "y", "z"} or _has_positions(table)):
        content = "three columns, of which two are positions on a grid"
        raise InputError("heights", content, "heights alone; name a file of points x y z .xyz", text.file)
    scale = io.unit_factor("heights", next(iter(text.units(1)), None), unit, text.file)
    return io.finite_numbers(table, "heights", text.file, scale, 2), (None, None)


def _has_positions(table: Array) -> bool:
    """Return True if two of the columns (rows, 3) are the coordinates of a complete grid."""
    for pair in itertools.combinations(table.T, 2):
        if all(np.isfinite(column).all() and np.ptp(column) > 0 for column in pair):
            try:
                (row, *_), (column, *_) = (_levels(place, "heights", None) for place in pair)
            except InputError:
                continue
            places = row * (column.max() + 1) + column
            if places.max() + 1 == places.size == np.unique(places).size:
                return True
    return False


def _convert_points(text: Text, table: Array, unit: str | None) -> RawHeights:
    """Return the heights of points x y z, in any order."""
    file = text.file
    x, y, z = table.T
    units = text.units(3) or [""] * 3
    (column, left, dx), (row, low, dy) = (
        _levels(io.finite_numbers(places, key, file, io.unit_factor(key, own or unit, None, file)), key, file)
        for key, places, own in (("x", x, units[0]), ("y", y, units[1]))
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
            place_text = f"x = {left + place % nx * dx:.6g} nm, y = {low + place // nx * dy:.6g} nm"
            problem = f"{count} of {ny} × {nx} points {kind}, the first at {place_text}"
            raise InputError("positions", Words(problem), "each point of a complete grid once", file)
    heights = np.empty((ny, nx))
    heights[row, column] = z
    return io.finite_numbers(heights, "heights", file, scale, 2), (dy, dx)


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
    convert: Callable[[Text, Array, str | None], RawHeights]


LINE = Layout(range(1, 4), "one to three numbers 1.5, as many as in the first row", _convert_line)
GRID = Layout(range(2, sys.maxsize), "two or more heights 1.5, as many as in the first row", _convert_grid)
POINTS = Layout(range(3, 4), "three numbers 1.5: x, y and z", _convert_points)
