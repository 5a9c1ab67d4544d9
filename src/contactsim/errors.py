"""The error that a user meets: an input that has to be mended.

An `InputError` names the file, if there is one, the key, its value and what is allowed. Numerical failure is not an
error: it is a `Status`, stored with the result.

Numbers are fractions and those of numpy, of any precision, too. They are bounded, so that their squares and cubes are
neither infinite nor zero.
"""

from __future__ import annotations

from numbers import Real
from pathlib import PurePath
from typing import TypeGuard

import numpy as np

MAX_VALUE_LENGTH, MAX_ALLOWED_LENGTH = 80, 2000
"""Most letters of a value, and of what is allowed, in a message."""
LARGEST, SMALLEST = 1e100, 1e-100
"""Largest size of a number, and smallest positive number."""
POSITIVE = f"a positive number, {SMALLEST:g} to {LARGEST:g}"
"""What is allowed, in words."""
NUMBER = f"a finite number, in size up to {LARGEST:g}"
"""The same for numbers of either sign."""


class Words(str):
    """Words in the place of a value that nobody typed as it stands there, such as "nothing"; shown without quotes."""

    __slots__ = ()

    def __repr__(self) -> str:
        return "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in self)


NOTHING = Words("nothing")
"""In the place of a value that is not given."""


class InputError(ValueError):
    """An input that cannot be used, with what would be accepted.

    Parameters
    ----------
    key : str
        Name of the setting.
    value : object
        Its value.
    allowed : str
        The values that are accepted, in words.
    file : path or str, optional
        File that holds the setting.
    caller : str, optional
        Function or class that needs the value.
    """

    def __init__(self, key: str, value: object, allowed: str, file: object = None, caller: str = "") -> None:
        self.key, self.value, self.allowed, self.file, self.caller = key, value, allowed, file, caller
        place = f"{file}: " if file is not None else ""
        allowed = allowed if len(allowed) <= MAX_ALLOWED_LENGTH else f"{allowed[: MAX_ALLOWED_LENGTH - 3]}..."
        got = f"got {_value_text(value)}"
        text = f"{caller} needs {allowed}; {got}" if caller else f"{got}; allowed: {allowed}"
        super().__init__(repr(Words(f"{place}{key}: {text}")))

    def __reduce__(self) -> tuple[type[InputError], tuple[str, object, str, object, str]]:
        """Return what another process needs to make the same error."""
        return InputError, (self.key, self.value, self.allowed, self.file, self.caller)

    def located(self, file: object, section: str = "") -> InputError:
        """Return the same error with its file and the section that holds the key.

        A file that is known already is kept.
        """
        key = f"{section}.{self.key}" if section else self.key
        return InputError(key, self.value, self.allowed, self.file if self.file is not None else file)

    def renamed(self, start: str, other: str) -> InputError:
        """Return the same error with another start of its key, where the key begins so."""
        key = other + self.key.removeprefix(start) if self.key.startswith(start) else self.key
        return InputError(key, self.value, self.allowed, self.file)


def is_number(value: object) -> TypeGuard[float]:
    """Return True for one real number that is not too large; text, booleans and arrays are none."""
    usual = type(value) is float or type(value) is int  # the abstract class is slow to ask
    if not (usual or (isinstance(value, Real) and not isinstance(value, bool))):
        return False
    return bool(abs(value if isinstance(value, int) else float(value)) <= LARGEST)  # type: ignore[arg-type]


def is_positive(value: object) -> TypeGuard[float]:
    """Return True for one number above zero that is neither too small nor too large."""
    return is_number(value) and value >= SMALLEST


def is_whole(value: object, least: int = 1) -> TypeGuard[int]:
    """Return True for one whole number of at least some size; numbers with a fraction of zero are whole too."""
    return is_number(value) and value >= least and value == int(value)


def _value_text(value: object) -> str:
    """Return a value as short text: long text is cut, an array gives its shape."""
    if isinstance(value, PurePath):
        return repr(str(value))
    shape = getattr(value, "shape", None)
    if shape and isinstance(shape, tuple):
        return f"array of shape {tuple(shape)}"
    try:
        with np.printoptions(legacy="1.25"):  # a number of numpy as a plain one, also within lists
            text = repr(value)
    except (ValueError, RecursionError):  # a whole number of very many digits, a list nested very deep
        text = f"{type(value).__name__} too long to be shown"
    return text if len(text) <= MAX_VALUE_LENGTH else text[: MAX_VALUE_LENGTH - 3] + "..."
