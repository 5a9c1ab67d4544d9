"""Measured heights, along a line or over an area: what reading and preparing them share.

Numbers come from text, numpy and netCDF files and become float64 in nm; a file that misses one is refused.
A shape is removed, and a seam closed, in every direction alike, so a profile and a topography mean the same by it.
"""

from __future__ import annotations

import itertools
import re
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import Any, TextIO

import netCDF4
import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactsim.errors import InputError
from contactsim.grid import Array

UNITS = {"m": 1e9, "mm": 1e6, "um": 1e3, "\u03bcm": 1e3, "micrometer": 1e3, "nm": 1.0, "angstrom": 0.1}
TEXT = (".csv", ".txt", ".xyz", ".dat")
TOLERANCE = 1e-3  # of positions, in mean spacings


def existing_path(path: object) -> Path:
    """Return the path of an existing file; InputError otherwise."""
    if not isinstance(path, str | Path) or not Path(path).is_file():
        raise InputError("path", path, "an existing file", path)
    return Path(path)


def refuse_unused(key: str, value: object, suffixes: tuple[str, ...], file: Path) -> None:
    """Raise an InputError if a value is given that files with this suffix do not use."""
    if value is not None and file.suffix.lower() not in suffixes:
        raise InputError(key, value, f"none for {file.suffix.lower()}, only for {', '.join(suffixes)}", file)


@contextmanager
def report_unreadable(file: Path, *more: type[Exception]) -> Iterator[None]:
    """Turn the errors that a reader raises on a damaged file, and `more`, into an InputError."""
    try:
        yield
    except InputError:
        raise
    except (OSError, RuntimeError, ValueError, *more) as error:
        why = " ".join(str(error).split())[:200]
        raise InputError("path", str(file), f"a readable {file.suffix.lower()} file ({why})", file) from error


def positive_spacing(spacing: object, file: object) -> float:
    """Return a spacing as a float; InputError unless it is a positive finite number."""
    if isinstance(spacing, Real) and not isinstance(spacing, bool) and 0 < spacing < np.inf:
        return float(spacing)
    raise InputError("spacing", spacing, "a positive finite number, in nm", file)


def finite_numbers(values: ArrayLike, key: str, file: object, scale: float = 1.0, dims: int = 1) -> Array:
    """Return a scaled float64 copy of finite numbers, two or more in each of `dims` directions."""
    array = np.ma.asarray(values)
    if array.dtype.kind not in "iuf" or array.ndim != dims or min(array.shape) < 2:
        allowed = f"two or more real numbers{' each way' * (dims > 1)}, in {dims}D"
        raise InputError(key, f"shape {array.shape} of {array.dtype}", allowed, file)
    with np.errstate(over="ignore", invalid="ignore"):
        numbers = array.astype(np.float64).filled(np.nan) * scale
    bad = ~np.isfinite(numbers)
    if bad.any():
        at = np.unravel_index(np.argmax(bad), bad.shape)
        where = ", ".join(f"{name} {place + 1}" for name, place in zip(("row", "column"), at, strict=False))
        found = f"{numbers[at]} in {where}"
        if dims > 1:
            found = f"{bad.sum()} of {bad.size} points missing or not finite, the first {found}"
        raise InputError(key, found, "finite numbers, none missing", file)
    return numbers


def unit_factor(key: str, stated: str | None, unit: str | None, file: Path) -> float:
    """Return the nanometres in the unit that the file states, or else in `unit`; they must not differ."""
    names = [unicodedata.normalize("NFKC", str(name)).strip() for name in (stated or None, unit) if name is not None]
    wrong = [name for name in names if name not in UNITS]
    if wrong or not names:
        allowed = f"for {key} one of {', '.join(UNITS)}, in the file or as `unit`"
        raise InputError("unit", wrong[0] if wrong else None, allowed, file)
    if UNITS[names[0]] != UNITS[names[-1]]:
        raise InputError("unit", unit, f"none, or that in the file, {stated}", file)
    return UNITS[names[0]]


def mean_step(positions: Array, key: str, file: Path) -> float:
    """Return the step of positions (n,), negative if they descend; InputError unless they are equally spaced."""
    mean = float(positions[-1] - positions[0]) / (positions.size - 1)
    off = np.abs(np.diff(positions) - mean)
    row = int(np.argmax(off)) + 1
    if mean == 0 or off[row - 1] > TOLERANCE * abs(mean):
        found = f"{off[row - 1]:.6g} nm off the mean step {mean:.6g} nm from row {row} to {row + 1}"
        raise InputError(key, found, f"equal steps to {TOLERANCE:g} of the mean step", file)
    return mean


def check_spacing(spacing: float, given: float | None, file: Path) -> float:
    """Return the spacing that a file states; InputError if the requested spacing differs."""
    if given is not None and abs(given - spacing) > TOLERANCE * spacing:
        raise InputError("spacing", given, f"none, or that of the positions, {spacing:.6g} nm", file)
    return spacing


def load_npy(file: Path) -> NDArray[Any]:
    """Return the array in a .npy file; pickled objects are not loaded."""
    with file.open("rb") as stream:
        return np.lib.format.read_array(stream, allow_pickle=False)


@dataclass(frozen=True)
class Text:
    """A text file of numbers: its header and its number in the file, the line of its first row, and the separator."""

    file: Path
    header: tuple[int, str]
    first: int
    mark: str

    @classmethod
    def read(cls, file: Path, delimiter: str | None) -> Text:
        """Look at the first rows of a file; the separator is found if None."""
        if delimiter not in (None, ",", ";", "\t", " "):
            raise InputError("delimiter", delimiter, 'one of "," ";" tab " "', file)
        rows = list(itertools.islice(_rows(file), 3))
        # The second row, surely no header, has the separator: a semicolon, else a comma, else blanks.
        mark = delimiter or next((each for each in ";," if any(each in line for _, line in rows[1:2])), " ")
        # A header begins like a name and has no number, so that a mistyped first row, `1.O5`, is not taken for one.
        named = bool(rows) and (rows[0][1][0].isalpha() or rows[0][1][0] in "\"'")
        header = rows.pop(0) if named and set(_numbers(rows[0][1], mark)) == {None} else (0, "")
        if len(rows) < 2:
            raise InputError("heights", f"{len(rows)} rows", "two or more rows of numbers", file)
        return cls(file, header, rows[0][0], mark)

    def units(self, columns: int, file: Path) -> list[str]:
        """The units in the header, like `x [um]`, of all columns; none if there are none; InputError if of some."""
        units = re.findall(r"[\[(]([^\])]*)[\])]", self.header[1])
        if len(units) not in (0, columns):
            found = f"a unit for each of {columns} columns, or none"
            raise InputError(f"line {self.header[0]}", self.header[1], found, file)
        return units

    def table(self, widths: range, allowed: str, file: Path) -> Array:
        """The numbers (rows, columns), of a number of columns in `widths`; InputError with the line else."""
        found = self._at_once()
        if found is not None and found.shape[1] in widths:
            return found
        table: list[Array] = []
        for number, line in _rows(self.file):
            if number < self.first:
                continue
            values = _numbers(line, self.mark)
            if None in values or len(values) not in widths or len(values) != len(table[0] if table else values):
                raise InputError(f"line {number}", line, allowed, file)
            table.append(np.array(values, dtype=np.float64))
        return np.array(table)

    def _at_once(self) -> Array | None:
        """All numbers, many times faster than line by line; None where a line is anything else, be it a comment."""
        mark = None if self.mark == " " else self.mark
        with _opened(self.file) as stream:
            try:
                return np.loadtxt(stream, delimiter=mark, comments=None, skiprows=self.first - 1, ndmin=2)
            except ValueError:
                return None


def _opened(file: Path) -> TextIO:
    return file.open(encoding="utf-8-sig", errors="surrogateescape")


def _rows(file: Path) -> Iterator[tuple[int, str]]:
    """Yield the lines other than comments and blank ones, with their numbers."""
    with _opened(file) as stream:
        for number, text in enumerate(stream, 1):
            line = text.replace("\udcb5", "\u03bc").strip()  # latin-1 micro sign
            if line and not line.startswith("#"):
                yield number, line


def _numbers(line: str, mark: str) -> list[float | None]:
    """Return the numbers of a line, None for what is none; the mark " " is any blanks."""
    values: list[float | None] = []
    for field in line.split() if mark == " " else line.split(mark):
        try:
            values.append(None if "_" in field else float(field))
        except ValueError:
            values.append(None)
    return values


def find_heights(data: netCDF4.Dataset, dims: int, variable: str | None, file: Path) -> netCDF4.Variable:
    """Return the heights in a netCDF file: `variable`, or the one named like heights, or the only floats."""
    fields = {name: each for name, each in data.variables.items() if each.ndim == dims}
    near = {name for each in data.variables.values() for name in _near(each)}
    free = [name for name in fields if name not in near]
    named = [name for name in free if name in ("heights", "height", "z")]
    floats = [name for name in free if np.dtype(fields[name].dtype).kind == "f"]
    found = [str(variable)] if variable is not None else named if len(named) == 1 else floats
    if len(found) != 1 or found[0] not in fields:
        raise InputError("variable", variable, f"the name of the {dims}D heights, of those: {list(fields)}", file)
    return fields[found[0]]


def positions_along(
    dimension: str, data: netCDF4.Dataset, heights: netCDF4.Variable, unit: str | None, file: Path
) -> Array | None:
    """Return the coordinate (n,) of the heights along a dimension, in nm, or None."""
    others = [data.variables[name] for name in _near(heights) if name in data.variables and name != heights.name]
    for each in others:
        if each.dimensions == (dimension,):
            return finite_numbers(
                each[:], each.name, file, unit_factor(each.name, stated_unit(each) or unit, None, file)
            )
    return None


def stated_unit(variable: netCDF4.Variable) -> str:
    """Return the unit that a netCDF variable states as `units` or, as some writers do, `unit`; empty if none."""
    return str(getattr(variable, "units", getattr(variable, "unit", "")))


def _near(variable: netCDF4.Variable) -> list[str]:
    return [*variable.dimensions, *str(getattr(variable, "coordinates", "")).split()]
