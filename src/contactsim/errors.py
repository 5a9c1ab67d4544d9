"""The error that a user meets: an input that has to be mended.

An `InputError` names the file, if there is one, the key, its value and what is allowed. Numerical failure is not an
error: it is a `Status`, stored with the result.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import signature
from pathlib import PurePath
from typing import ParamSpec, TypeVar

import numpy as np

P = ParamSpec("P")
R = TypeVar("R")

MAX_VALUE_LENGTH = 80


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
        super().__init__(f"{place}{key}: got {_value_text(value)}; allowed: {allowed}")

    def __reduce__(self) -> tuple[type[InputError], tuple[str, object, str, object]]:
        """Return what another process needs to make the same error."""
        return InputError, (self.key, self.value, self.allowed, self.file)

    def located(self, file: object, section: str = "") -> InputError:
        """Return the same error with its file and the section that holds the key.

        A file that is known already is kept.
        """
        key = f"{section}.{self.key}" if section else self.key
        return InputError(key, self.value, self.allowed, self.file if self.file is not None else file)


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


def _value_text(value: object) -> str:
    """Return a value as short text: long text is cut, an array gives its shape."""
    if isinstance(value, PurePath):
        return repr(str(value))
    shape = getattr(value, "shape", None)
    if shape:
        return f"array of shape {tuple(shape)}"
    with np.printoptions(legacy="1.25"):  # a number of numpy as a plain one, also within lists
        text = repr(value)
    return text if len(text) <= MAX_VALUE_LENGTH else text[: MAX_VALUE_LENGTH - 3] + "..."
