"""The lines of a text file, compressed or not, in UTF-8 or UTF-16."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from io import TextIOWrapper
from pathlib import Path
from typing import IO, NamedTuple

from contactsim.errors import InputError
from contactsim.topography_files import io

MAX_TEXT, CHUNK = 32 * io.MAX_HEIGHTS, 2**20
"""Most bytes of a text, and how many of a compressed one are counted at a time."""
UTF_16 = (b"\xff\xfe", b"\xfe\xff")
"""First bytes of a text in UTF-16."""


class Line(NamedTuple):
    """A line that is not blank: its number, its text without the sign of a comment, and whether it is one."""

    number: int
    text: str
    is_comment: bool


def _open_bytes(file: Path) -> IO[bytes]:
    """Open the bytes of a text file, compressed or not."""
    module = io.COMPRESSED.get(file.suffix.lower())
    stream: IO[bytes] = file.open("rb") if module is None else import_module(module).open(file)
    return stream


def open_text(file: Path) -> TextIOWrapper:
    """Open a text file, compressed or not, in UTF-16 or UTF-8.

    A byte-order mark is dropped, and bytes that are not UTF-8 are kept.
    """
    with _open_bytes(file) as stream:
        start = stream.read(2)
    stream = _open_bytes(file)
    if start in UTF_16:
        return TextIOWrapper(stream, encoding="utf-16", errors="replace")
    return TextIOWrapper(stream, encoding="utf-8-sig", errors="surrogateescape")


def check_size(file: Path) -> None:
    """Raise an InputError for a text that is too long, before memory is taken for its numbers."""
    size = file.stat().st_size
    if file.suffix.lower() in io.COMPRESSED:
        with _open_bytes(file) as stream:
            size = 0
            while size <= MAX_TEXT and (chunk := stream.read(CHUNK)):
                size += len(chunk)
    if size > MAX_TEXT:
        raise InputError("path", str(file), f"a text of at most {MAX_TEXT / 2**30:g} GiB", file)


def read_lines(file: Path) -> Iterator[Line]:
    """Yield the lines that are not blank."""
    with open_text(file) as stream:
        for number, text in enumerate(stream, 1):
            line = text.replace("\udcb5", "\u03bc").strip()  # latin-1 micro sign
            if line:
                yield Line(number, line.lstrip("#").strip(), line.startswith("#"))
