"""What a text file of heights states before its numbers: sizes, spacing, units.

Statements are lines like `# Width: 12.3 µm`, `h=305 w=75` or `Value units: m`, in comments or not, as Gwyddion,
interferometers and profilers write them, in English or German. A line that names the columns, like `x [um], z [nm]` or
`Lateral um,Raw Micrometer`, comes last.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from contactsim.errors import InputError, Words
from contactsim.surfaces import io

WIDTH, HEIGHT = ("width", "breite"), ("height", "höhe")
"""Names of the length along x and along y."""
COLUMNS, ROWS = ("w",), ("h",)
"""Names of the number of points along x and along y."""
SPACING = ("pixel size",)
"""Names of the distance between points."""
UNIT = ("value units", "data unit")
"""Names of the unit of heights."""
FACTOR = re.compile(r"height conversion factor \(-> (?P<unit>\S+)\)")
"""Name of what a height is multiplied by."""
STATEMENT = re.compile(r"(?P<name>[^:=]+?)\s*[:=]\s*(?P<value>.+)")
PAIRS = re.compile(r"(\w+)\s*=\s*(\S+)")
LENGTH = re.compile(r"(?P<number>[-+]?[\d.,]+(?:[eE][-+]?\d+)?)\s*(?P<unit>[^\W\d]\S*)")
IN_BRACKETS = re.compile(r"[\[(]([^\])]*)[\])]")


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
    def _statements(self) -> dict[str, tuple[int, str]]:
        """Number of the line and value of each statement, by its name in small letters."""
        return {name.strip().lower(): (line, value.strip()) for line, name, value in self._read_statements()}

    def _read_statements(self) -> Iterator[tuple[int, str, str]]:
        """Yield the line, name and value of each statement; several stand in a line like `h=305 w=75`."""
        for line, text in self.lines:
            pairs = PAIRS.findall(text)
            statement = STATEMENT.fullmatch(text)
            if len(pairs) > 1:
                yield from ((line, *pair) for pair in pairs)
            elif statement:
                yield line, statement["name"], statement["value"]

    def _statement(self, names: Sequence[str]) -> tuple[int, str] | None:
        """Return the line and value of a statement by one of its names, or None."""
        return next((self._statements[name] for name in names if name in self._statements), None)

    def _length(self, names: Sequence[str]) -> float | None:
        """Return a length that is stated with its unit, nm, or None."""
        stated = self._statement(names)
        if stated is None:
            return None
        line, text = stated
        length = LENGTH.fullmatch(text)
        if length is None:
            raise InputError(f"line {line}", text, "a number and its unit, like 12.3 µm", self.file)
        value = self._number(line, length["number"]) * io.unit_factor(names[0], length["unit"], None, self.file)
        return io.positive_spacing(value, self.file)

    def _number(self, line: int, text: str) -> float:
        """Return a number with a decimal point or comma."""
        try:
            return float(text.replace(",", ".") if "." not in text else text)
        except ValueError:
            raise InputError(f"line {line}", text, "a number", self.file) from None

    def steps(self, shape: tuple[int, ...]) -> tuple[float | None, ...]:
        """Return the stated spacing along y and x of heights of a shape (ny, nx), nm; None where none is stated."""
        for names, points, key in ((ROWS, shape[0], "rows"), (COLUMNS, shape[1], "columns")):
            stated = self._statement(names)
            if stated is not None and self._number(*stated) != points:
                raise InputError(
                    "heights", Words(f"{points} {key}"), f"{stated[1]}, as line {stated[0]} says", self.file
                )
        lengths = self._length(HEIGHT), self._length(WIDTH)
        spacing = self._length(SPACING)
        return tuple(
            spacing if length is None else length / points for length, points in zip(lengths, shape, strict=True)
        )

    def column_units(self, columns: int) -> list[str]:
        """Return the units of all columns where they are named, like `x [um]` or `Lateral um`; InputError for some."""
        line, text = self.named
        units = bracketed_units(text) or self._last_words(columns)
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

    def height_factor(self, stated: str | None, unit: str | None) -> float:
        """Return the nanometres in a height: by a stated factor, a stated unit, or else by `unit`."""
        for name, (line, text) in self._statements.items():
            factor = FACTOR.fullmatch(name)
            if factor:
                return self._number(line, text) * io.unit_factor("heights", factor["unit"], unit, self.file)
        named = self._statement(UNIT)
        return io.unit_factor("heights", stated or (named[1] if named else None), unit, self.file)


def bracketed_units(text: str) -> list[str]:
    """Return what stands in brackets in the names of columns, like `x [um]`."""
    return IN_BRACKETS.findall(text)
