"""Files that appear under their name only when they are complete: a reader sees the old one or the new one."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from contactsim.errors import InputError


def write_atomically(path: str | Path, save: Callable[[Path], object]) -> None:
    """Save under a temporary name in the same folder, which is made if need be, and move it into place.

    save: writes a whole file to the path it is given, which ends like `path`: some formats follow from the ending.
    What it raises is passed on, and nothing is left of the temporary file.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        save(temporary)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def prepare_target(path: str | Path, option: str) -> None:
    """Make the folder of a file to be written, before anything is solved; InputError where that is impossible."""
    path = Path(path)
    if path.is_dir():
        raise InputError(option, str(path), "the name of a file; this is a folder")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(option, str(path), f"a file in a folder that can be made ({error.strerror})") from error
    if not os.access(path.parent, os.W_OK):
        raise InputError(option, str(path), "a file in a folder that can be written to")


def write_text(text: str, path: str | Path) -> None:
    """Write a small text file, in UTF-8, in one move."""
    write_atomically(path, lambda file: file.write_text(text, encoding="utf-8"))
