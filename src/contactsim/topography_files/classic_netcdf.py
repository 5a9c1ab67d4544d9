"""The length that a netCDF file in the classic format must have: a shorter one would be read with zeros at its end.

The format: https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html
"""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import IO

MAGIC = b"CDF"
"""First bytes of a file in the classic format; the version follows."""
WIDTHS = {1: (">i", ">i"), 2: (">i", ">q"), 5: (">q", ">q")}
"""Forms of a count and of a place in the file, by the version."""
SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}
"""Bytes of a value by its type."""


def least_length(file: Path) -> int:
    """Return the number of bytes up to the last value of a file in the classic format; 0 for other formats.

    Raises struct.error or KeyError where the header itself is cut off or damaged.
    """
    with file.open("rb") as stream:
        start = stream.read(4)
        if start[:3] != MAGIC or start[3:] not in (bytes([version]) for version in WIDTHS):
            return 0
        return _Header(stream, *WIDTHS[start[3]]).least_length()


class _Header:
    """The header, read from its beginning to its end."""

    def __init__(self, stream: IO[bytes], count: str, place: str) -> None:
        self._stream, self._count, self._place = stream, count, place

    def least_length(self) -> int:
        """Return the place behind the last value of all variables."""
        records = self._number(self._count)  # -1 where it is unknown, in a file that was written as a stream
        sizes = [self._dimension() for _ in range(self._entries())]
        self._skip_attributes()
        variables = [self._variable(sizes) for _ in range(self._entries())]
        ends = [begin + size for begin, size, is_record in variables if not is_record]
        repeated = [(begin, size) for begin, size, is_record in variables if is_record]
        if repeated and records > 0:
            record = sum(size if len(repeated) == 1 else _padded(size) for _, size in repeated)
            ends += [begin + (records - 1) * record + size for begin, size in repeated]
        return max(ends, default=0)

    def _number(self, form: str) -> int:
        """Return the next number."""
        return int(struct.unpack(form, self._stream.read(struct.calcsize(form)))[0])

    def _entries(self) -> int:
        """Return the number of entries of a list, behind its tag."""
        self._number(">i")
        return self._number(self._count)

    def _skip(self, length: int) -> None:
        """Pass bytes, which end at a multiple of four."""
        self._stream.seek(_padded(length), 1)

    def _dimension(self) -> int:
        """Return the length of a dimension, 0 for that of the records."""
        self._skip(self._number(self._count))
        return self._number(self._count)

    def _skip_attributes(self) -> None:
        """Pass a list of attributes."""
        for _ in range(self._entries()):
            self._skip(self._number(self._count))
            kind = self._number(">i")
            self._skip(SIZES[kind] * self._number(self._count))

    def _variable(self, sizes: list[int]) -> tuple[int, int, bool]:
        """Return where the values of a variable begin, their bytes (in a record), and whether there are records."""
        self._skip(self._number(self._count))
        shape = [sizes[self._number(self._count)] for _ in range(self._number(self._count))]
        self._skip_attributes()
        kind = self._number(">i")
        self._number(self._count)  # its size, which may be too large to be stored
        is_record = bool(shape) and shape[0] == 0
        return self._number(self._place), SIZES[kind] * math.prod(shape[1:] if is_record else shape), is_record


def _padded(length: int) -> int:
    """Return a length up to the next multiple of four."""
    return -(-length // 4) * 4
