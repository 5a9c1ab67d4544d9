"""The error that a user meets: an input that has to be mended.

An `InputError` names the file, if there is one, the key, its value and what is allowed. Numerical failure is not an
error: it is a `Status`, stored with the result.

Numbers are fractions and those of numpy, of any precision, too. They are kept as floats, so that no formula meets
another kind, and bounded, so that their squares and cubes are neither infinite nor zero.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import fields
from functools import cache, wraps
from inspect import signature
from numbers import Real
from pathlib import PurePath
from typing import Any, ParamSpec, TypeGuard, TypeVar

import numpy as np

P = ParamSpec("P")
R = TypeVar("R")

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
    """

    def __init__(self, key: str, value: object, allowed: str, file: object = None) -> None:
        self.key, self.value, self.allowed, self.file = key, value, allowed, file
        place = f"{file}: " if file is not None else ""
        allowed = allowed if len(allowed) <= MAX_ALLOWED_LENGTH else f"{allowed[: MAX_ALLOWED_LENGTH - 3]}..."
        super().__init__(repr(Words(f"{place}{key}: got {_value_text(value)}; allowed: {allowed}")))

    def __reduce__(self) -> tuple[type[InputError], tuple[str, object, str, object]]:
        """Return what another process needs to make the same error."""
        return InputError, (self.key, self.value, self.allowed, self.file)

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


def check_option_names(function: Callable[P, R]) -> Callable[P, R]:
    """Return a function that raises InputError for an option it does not have, with the names of those it has."""
    parameters = signature(function).parameters
    options = [name for name, parameter in parameters.items() if parameter.kind is parameter.KEYWORD_ONLY]

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        """Check the names of the options, then call the function."""
        for name, value in kwargs.items():
            if name not in parameters:
                raise InputError(name, value, f"no such option, but {', '.join(options)}")
        return function(*args, **kwargs)

    return call


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


def keep_floats(instance: Any) -> None:
    """Keep the numbers of a frozen dataclass as floats: those of its fields that are said to be floats."""
    for name in _float_fields(instance.__class__):
        value = getattr(instance, name)
        if value is not None and type(value) is not float:
            object.__setattr__(instance, name, float(value))


@cache
def _float_fields(kind: Any) -> tuple[str, ...]:
    """Return the names of a dataclass's fields that are said to be floats."""
    return tuple(entry.name for entry in fields(kind) if entry.type in ("float", "float | None"))


def read_numbers(key: str, values: object, least: int = 1) -> tuple[float, ...]:
    """Return a list of numbers as floats.

    Parameters
    ----------
    key
        Its name in an error.
    values
        A list, tuple or array of numbers.
    least
        Least length.

    Raises
    ------
    InputError
        For anything else.
    """
    is_list = isinstance(values, Iterable) and not isinstance(values, str | bytes | dict | set)
    if isinstance(values, np.ndarray) and values.ndim != 1:
        is_list = False
    numbers = list(values) if is_list else []  # type: ignore[call-overload]
    if len(numbers) < least or not all(map(is_number, numbers)):
        raise InputError(key, values, f"a list of {least} or more numbers of sizes up to {LARGEST:g}")
    return tuple(map(float, numbers))


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
