"""Numbers that a user gives: what counts as one, and how they are kept.

Fractions and numbers of numpy, of any precision, are numbers too. They are kept as floats, so that no formula meets
another kind. Numbers are bounded, so that their squares and cubes are neither infinite nor zero.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from numbers import Real
from typing import Any, TypeGuard

import numpy as np

from contactsim.errors import InputError

LARGEST, SMALLEST = 1e100, 1e-100
"""Largest size of a number, and smallest positive number."""
POSITIVE = f"a positive number, {SMALLEST:g} to {LARGEST:g}"
"""What is allowed, in words."""
NUMBER = f"a finite number, in size up to {LARGEST:g}"
"""The same for numbers of either sign."""


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
    for entry in fields(instance):
        value = getattr(instance, entry.name)
        if entry.type in ("float", "float | None") and value is not None and type(value) is not float:
            object.__setattr__(instance, entry.name, float(value))


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
