"""The header of a text file of heights, before its numbers: sizes, spacing, units.

Statements are lines like `# Width: 12.3 µm`, `h=305 w=75` or `Value units: m`, in comments or not, as Gwyddion,
interferometers and profilers write them, in English or German. A line that names the columns, like `x [um], z [nm]` or
`Lateral um,Raw Micrometer`, comes last.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from contactsim.errors import InputError, Words
from contactsim.topography_files import io

WIDTH, HEIGHT = ("width", "breite"), ("height", "höhe")
"""Names of the length along x and along y."""
COLUMNS, ROWS = ("w", "ncols"), ("h", "nrows")
"""Names of the number of points along x and along y."""
SPACING = ("pixel size",)
"""Names of the distance between points."""
CELL, CELL_ALONG_X, CELL_ALONG_Y = ("cellsize",), ("dx",), ("dy",)
"""Names of the distance between points in grids of geographic systems."""
MISSING, USUALLY_MISSING = ("nodata_value", "nodata"), -9999.0
"""Names of the height of points that are missing there, and that height where none is stated."""
UNIT = ("value units", "data unit")
"""Names of the unit of heights."""
FACTOR = re.compile(r"height conversion factor \(-> (?P<unit>\S+)\)")
"""Name of what a height is multiplied by."""
STATEMENT = re.compile(r"(?P<name>[^:=]+?)\s*[:=]\s*(?P<value>.+)")
CELLS = re.compile(r"(?P<name>ncols|nrows|cellsize|dx|dy|nodata_value|nodata)\s+(?P<value>\S+)", re.IGNORECASE)
PAIRS = re.compile(r"(\w+)\s*=\s*(\S+)")
LENGTH = re.compile(r"(?P<number>[-+]?[\d.,]+(?:[eE][-+]?\d+)?)\s*(?P<unit>[^\W\d]\S*)")
IN_BRACKETS, BEHIND_SLASH = re.compile(r"[\[(]([^\])]*)[\])]"), re.compile(r"\w+\s*/\s*(\w+)")


@dataclass(frozen=True)
class Header:
    """The lines before the numbers.

    Parameters
    ----------
    file
        The file, for messages.
    lines
        Number and text of each line, without the sign of a comment.
    named
        Number and text of the line that may name the columns; 0 and nothing where there is none.
    mark
        Separator of columns; " " stands for any blanks.
    """

    file: Path
    lines: Sequence[tuple[int, str]]
    named: tuple[int, str]
    mark: str

    @cached_property
    def _statements(self) -> dict[str, list[tuple[int, str]]]:
        """Number of the line and value of all statements with a name, by that name in small letters."""
        statements: dict[str, list[tuple[int, str]]] = {}
        for line, name, value in self._read_statements():
            statements.setdefault(name.strip().lower(), []).append((line, value.strip()))
        return statements

    def _read_statements(self) -> Iterator[tuple[int, str, str]]:
        """Yield the line, name and value of each statement; several stand in a line like `h=305 w=75`."""
        for line, text in self.lines:
            pairs = PAIRS.findall(text)
            statement = STATEMENT.fullmatch(text) or CELLS.fullmatch(text)
            if len(pairs) > 1:
                yield from ((line, *pair) for pair in pairs)
            elif statement:
                yield line, statement["name"], statement["value"]

    def _statement(self, names: Sequence[str]) -> tuple[int, str] | None:
        """Return the line and value of the last statement by one of its names, or None."""
        return next((self._statements[name][-1] for name in names if name in self._statements), None)

    def _length(self, names: Sequence[str]) -> float | None:
        """Return a length that is stated with its unit, nm, or None."""
        stated = self._statement(names)
        if stated is None:
            return None
        line, text = stated
        length = LENGTH.fullmatch(text)
        if length is None:
            raise InputError(f"line {line}", text, "a number and its unit, like 12.3 µm", self.file)
        number = self._number(line, length["number"])
        if not number > 0:
            raise InputError(f"line {line}", text, "a positive length", self.file)
        return number * io.unit_factor(names[0], length["unit"], None, self.file)

    def _number(self, line: int, text: str) -> float:
        """Return a number with a decimal point or comma."""
        try:
            return float(text.replace(",", ".") if "." not in text else text)
        except ValueError:
            raise InputError(f"line {line}", text, "a number", self.file) from None

    @property
    def has_cells(self) -> bool:
        """Whether the heights are a grid of a geographic information system, whose first row has the largest y."""
        return "ncols" in self._statements and "nrows" in self._statements

    @property
    def missing(self) -> float:
        """Height that stands for points that are missing in such a grid."""
        stated = self._statement(MISSING)
        return USUALLY_MISSING if stated is None else self._number(*stated)

    def steps(self, shape: tuple[int, ...], unit: str | None) -> tuple[float | None, ...]:
        """Return the stated spacing along y and x of heights of a shape (ny, nx), nm; None where none is stated."""
        for names, points, key in ((ROWS, shape[0], "rows"), (COLUMNS, shape[1], "columns")):
            stated = self._statement(names)
            if stated is not None and self._number(*stated) != points:
                raise InputError(
                    "heights", Words(f"{points} {key}"), f"{stated[1]}, as line {stated[0]} says", self.file
                )
        lengths = self._length(HEIGHT), self._length(WIDTH)
        if self.has_cells:
            return tuple(self._cell_size(names, unit) for names in (CELL + CELL_ALONG_Y, CELL + CELL_ALONG_X))
        spacing = self._length(SPACING)
        return tuple(
            spacing if length is None else length / points for length, points in zip(lengths, shape, strict=True)
        )

    def _cell_size(self, names: Sequence[str], unit: str | None) -> float | None:
        """Return the distance between points of a grid of a geographic system, nm; None where none is stated."""
        stated = self._statement(names)
        if stated is None:
            return None
        number = self._number(*stated)
        if not number > 0:
            raise InputError(f"line {stated[0]}", stated[1], "a positive length", self.file)
        return number * io.unit_factor(names[0], None, unit, self.file)

    def column_units(self, columns: int) -> list[str]:
        """Return the units of all columns where they are named, like `x [um]` or `Lateral um`; InputError for some."""
        line, text = self.named
        units = bracketed_units(text) or units_behind_slashes(text, self.mark) or self._last_words(columns)
        if len(units) not in (0, columns):
            raise InputError(f"line {line}", text, f"a unit for each of {columns} columns, or none", self.file)
        return units

    def _last_words(self, columns: int) -> list[str]:
        """Return the units that names of as many columns end with."""
        fields = [field.split() for field in self.named[1].split(self.mark)] if self.mark != " " else []
        while fields and not fields[-1]:
            fields.pop()
        if len(fields) != columns:
            return []
        return [words[-1].lower() for words in fields if len(words) > 1 and words[-1].lower() in io.UNITS]

    def _check_units(self) -> None:
        """Raise an InputError for two units of heights that differ."""
        stated = [entry for name in UNIT for entry in self._statements.get(name, []) if entry[1] in io.UNITS]
        for line, unit in stated[1:]:
            if io.UNITS[unit] != io.UNITS[stated[0][1]]:
                raise InputError(f"line {line}", unit, f"{stated[0][1]}, as line {stated[0][0]} says", self.file)

    def height_factor(self, stated: str | None, unit: str | None) -> float:
        """Return the nanometres in a height: by a stated factor, a stated unit, or else by `unit`."""
        for name in self._statements:
            factor = FACTOR.fullmatch(name)
            if factor:
                return self._number(*self._statements[name][0]) * io.unit_factor(
                    "heights", factor["unit"], unit, self.file
                )
        named = self._statement(UNIT)
        self._check_units()
        return io.unit_factor("heights", stated or (named[1] if named else None), unit, self.file)


def bracketed_units(text: str) -> list[str]:
    """Return what stands in brackets in the names of columns, like `x [um]`."""
    return IN_BRACKETS.findall(text)


def units_behind_slashes(text: str, mark: str) -> list[str]:
    """Return the units of two or more names like `x/um`; none where a field is anything else."""
    fields = text.split(None if mark == " " else mark)
    found = [BEHIND_SLASH.fullmatch(unicodedata.normalize("NFKC", field).strip()) for field in fields]
    units = [match[1] for match in found if match is not None]
    return units if len(units) == len(fields) > 1 and all(unit in io.UNITS for unit in units) else []
