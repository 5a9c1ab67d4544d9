"""Text files of numbers: their header, separator, decimal sign, and table."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from contactsim.errors import NOTHING, InputError, Words
from contactsim.grid import Array
from contactsim.topography_files import io
from contactsim.topography_files.text_header import CELLS, Header, bracketed_units, units_behind_slashes
from contactsim.topography_files.text_lines import Line, check_size, open_text, read_lines

MAX_HEADER_LINES = 1000
"""Most lines before the numbers."""
MAX_LINE = 1000
"""Most letters of the first line that are looked at."""
SHOWN_ROWS = 100
"""Rows that show the separator, the decimal sign and how positions are rounded."""
DECIMAL_COMMA = re.compile(r"[-+]?\d+(,\d*)?([eE][-+]?\d+)?")
WITH_FRACTION = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
"""Numbers that may have a decimal comma, and those that surely have one if they stand between blanks."""
WHOLE, FRACTION = re.compile(r"[-+]?\d+([eE][-+]?\d+)?"), re.compile(r"0\d+([eE][-+]?\d+)?")
"""Numbers without a fraction, and what stands behind a decimal comma but hardly alone, such as 05."""


@dataclass(frozen=True)
class Text:
    """A text file of numbers.

    `header` is what stands before them, `first` the number of the first row's line, `width` the number of its fields,
    `mark` the separator, and `decimal` the sign before a fraction.
    """

    file: Path
    header: Header
    first: int
    width: int
    mark: str
    decimal: str

    @classmethod
    def read(cls, file: Path, delimiter: str | None) -> Text:
        """Return the text of a file; without a delimiter its first rows show the separator."""
        if delimiter not in (None, ",", ";", "\t", " "):
            raise InputError("delimiter", delimiter, 'one of "," ";" tab " "', file)
        check_size(file)
        before: list[Line] = []
        rows: list[Line] = []
        for line in read_lines(file):
            if not rows and (line.is_comment or _is_words(line.text, delimiter)):
                before.append(line)
                if len(before) > MAX_HEADER_LINES:
                    raise InputError("heights", Words(f"{len(before)} lines of words"), "rows of numbers", file)
            elif not line.is_comment:
                rows.append(line)
                if len(rows) == SHOWN_ROWS:
                    break
        if len(rows) < 2:
            count = {0: "no row", 1: "one row"}[len(rows)]
            raise InputError("heights", Words(f"{count} of numbers"), "two or more rows", file)
        mark, decimal = _style([line.text for line in rows], delimiter)
        if delimiter is None and mark == ",":
            _check_commas((field for line in rows for field in _fields(line.text, mark)), file)
        header = Header(file, [(line.number, line.text) for line in before], _names_of_columns(before, mark), mark)
        return cls(file, header, rows[0].number, len(_numbers(rows[0].text, mark, decimal)), mark, decimal)

    def table(self, widths: range, allowed: str) -> Array:
        """Return the numbers (rows, columns); InputError for a line whose number of columns is not in `widths`."""
        table = self._load_at_once()
        if table is not None and table.shape[1] in widths:
            return table
        rows: list[Array] = []
        for line in read_lines(self.file):
            if line.number < self.first or line.is_comment:
                continue
            rows.append(np.array(self._row(line), dtype=np.float64))
            count, first = rows[-1].size, rows[0].size
            if count not in widths or count != first:
                as_many = f", as many as in line {self.first}: {first}" if count != first else ""
                value = Words(f"{count} number{'s' * (count > 1)}")
                raise InputError(f"line {line.number}", value, allowed + as_many, self.file)
        return np.array(rows)

    def _row(self, line: Line) -> list[float | None]:
        """Return the numbers of a line; InputError for a field that is none."""
        values = _numbers(line.text, self.mark, self.decimal)
        if None in values:
            column = values.index(None)
            key, field = f"line {line.number}, column {column + 1}", _fields(line.text, self.mark)[column]
            raise InputError(key, field or NOTHING, f"a number, like 1{self.decimal}5", self.file)
        return values

    def _load_at_once(self) -> Array | None:
        """Return all numbers, much faster than line by line; None if a line is anything else, such as a comment."""
        mark = None if self.mark == " " else self.mark
        with open_text(self.file) as stream:
            text: Iterable[str] = itertools.islice(stream, self.first - 1, None)
            if self.decimal != ".":
                text = map(_with_points, text)
            try:
                return np.loadtxt(text, delimiter=mark, comments=None, ndmin=2)
            except ValueError:
                return None

    def roundings(self, columns: int) -> list[float]:
        """Return half of the last digit that is written of each column, in its unit, by the first rows."""
        digits = [0] * columns
        rows = (line for line in read_lines(self.file) if line.number >= self.first and not line.is_comment)
        for line in itertools.islice(rows, SHOWN_ROWS):
            for column, field in enumerate(_fields(line.text, self.mark)[:columns]):
                mantissa, _, exponent = field.lower().partition("e")
                fraction = len(mantissa.partition(self.decimal)[2])
                if exponent.lstrip("+-").isdigit():
                    fraction -= int(exponent)
                digits[column] = max(digits[column], fraction)
        return [0.5 * 10.0**-count for count in digits]


def is_cell_grid(file: Path) -> bool:
    """Return True for a text that begins as a grid of a geographic information system."""
    with open_text(file) as stream:
        return CELLS.fullmatch(stream.readline(MAX_LINE).strip()) is not None


def _is_words(line: str, delimiter: str | None) -> bool:
    """Return True for a line before the numbers: it begins like a name, so that a mistyped row, `1.O5`, is none."""
    if not (line[0].isalpha() or line[0] in "\"'"):
        return False
    return None in _numbers(line, *_style([line], delimiter))  # nan and inf are numbers


def _names_of_columns(before: Sequence[Line], mark: str) -> tuple[int, str]:
    """Return the number and text of the line that names the columns: the last one, without a number; 0 without."""
    candidates = [line for line in before if not line.is_comment] or before
    if candidates:
        number, text, is_comment = candidates[-1]
        units = bracketed_units(text) or units_behind_slashes(text, mark)
        is_named = not is_comment or (bool(units) and all(unit in io.UNITS for unit in units))
        if is_named and "=" not in text and set(_numbers(text, mark, ".")) == {None}:
            return number, text
    return 0, ""


def _style(rows: Sequence[str], delimiter: str | None) -> tuple[str, str]:
    """Return the separator and the decimal sign that rows show.

    A semicolon separates, else a comma, else blanks. A comma is a decimal sign where something else separates and more
    fields have commas than points, and in numbers like 1,5 that blanks separate; some rows may be mistyped.
    """
    mark = delimiter
    if mark is None:
        fields = [field for row in rows for field in row.split()]
        most = 2 * sum(len([*filter(WITH_FRACTION.fullmatch, row.split())]) > 1 for row in rows) > len(rows)
        are_decimal = len(fields) > len(rows) and (most or all(map(DECIMAL_COMMA.fullmatch, fields)))
        last = rows[1] if len(rows) > 1 else rows[0]
        mark = ";" if ";" in last else " " if are_decimal or "," not in last else ","
    commas, points = (sum(sign in field for row in rows for field in _fields(row, mark)) for sign in ",.")
    return mark, "," if mark != "," and commas > points else "."


def _with_points(line: str) -> str:
    """Return a line of numbers with decimal commas with decimal points; ValueError where it has some already."""
    if "." in line:
        raise ValueError("a decimal point among decimal commas")
    return line.replace(",", ".")


def _check_commas(fields: Iterable[str], file: Path) -> None:
    """Raise an InputError for fields that are halves of numbers with a decimal comma, such as 3 and 05."""
    has_fraction = False
    for field in fields:
        if not WHOLE.fullmatch(field):
            return
        has_fraction = has_fraction or bool(FRACTION.fullmatch(field))
    if has_fraction:
        problem = Words("commas that may be decimal signs")
        allowed = 'semicolons, tabs or blanks between such numbers; or `delimiter`, "," where commas separate'
        raise InputError("delimiter", problem, f'{allowed}, " " where each line is one', file)


def _fields(line: str, mark: str) -> list[str]:
    """Return the fields of a line, without empty ones at its end; the mark " " stands for any blanks."""
    fields = line.split() if mark == " " else [field.strip() for field in line.split(mark)]
    while len(fields) > 2 and not fields[-1]:
        fields.pop()
    return fields


def _numbers(line: str, mark: str, decimal: str) -> list[float | None]:
    """Return the numbers of a line, None for a field that is not a number."""
    values: list[float | None] = []
    for field in _fields(line, mark):
        try:
            is_mistyped = "_" in field or (decimal != "." and "." in field)
            values.append(None if is_mistyped else float(field.replace(decimal, ".")))
        except ValueError:
            values.append(None)
    return values
