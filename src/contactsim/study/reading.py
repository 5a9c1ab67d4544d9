"""Read settings strictly.

Every mapping in a config file is read against a table of keys. An unknown, missing or ill-typed key is a `InputError`
that names the file, the key, the value and what is allowed; nothing is ever silently ignored.
"""

from __future__ import annotations

import dataclasses
import functools
import re
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from types import MappingProxyType

import numpy as np

from contactsim.errors import LARGEST, NOTHING, SMALLEST, InputError, is_number, is_positive

REQUIRED = object()
MAX_WHOLE = 2**63 - 1
"""Largest whole number."""
MAX_ENTRIES = 10_000
"""Most entries of a list."""
MAX_INCHES = 100.0
"""Largest width and height of a figure."""
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")
"""Characters of a text that cannot be printed."""
MAX_TEXT = 5000
"""Most characters of a text."""
SAFE_NAME = re.compile("[A-Za-z0-9_]{1,80}")
"""Form of a name that becomes part of the name of a file or a rule."""
SAFE_NAME_FORM = "1 to 80 letters, digits and underscores"


@dataclass(frozen=True)
class Key:
    """One allowed key: kind converts and checks a value or raises ValueError; allowed says what it wants."""

    kind: Callable[[object], object]
    allowed: str
    default: object = REQUIRED


def read(section: object, keys: Mapping[str, Key], file: object, prefix: str = "") -> dict:
    """Return the section with every value checked and every default filled in."""
    if not isinstance(section, dict):
        raise InputError(prefix or "top level", section, f"a mapping with keys {', '.join(keys)}", file)
    dotted = f"{prefix}." if prefix else ""
    for name in section:
        if name not in keys:
            near = get_close_matches(str(name), keys, 1)
            hint = f", did you mean {near[0]}?" if near else ";"
            raise InputError(f"{dotted}{name}", section[name], f"no such key{hint} known keys: {', '.join(keys)}", file)
    values = {}
    for name, key in keys.items():
        if name not in section:
            if key.default is REQUIRED:
                raise InputError(f"{dotted}{name}", NOTHING, f"{key.allowed} (the key is missing)", file)
            values[name] = key.default
            continue
        try:
            values[name] = key.kind(section[name])
        except ValueError as error:
            hint = f" ({error})" if str(error) else ""
            raise InputError(f"{dotted}{name}", section[name], f"{key.allowed}{hint}", file) from error
    return values


def number(value: object) -> float:
    """Return a finite number; text that only looks like one is refused."""
    if isinstance(value, str):
        try:
            finite = np.isfinite(float(value))
        except ValueError:
            raise ValueError from None
        if not finite:
            raise ValueError
        raise ValueError(
            f"this is text to YAML, which wants a decimal point and a signed exponent: {_with_point(value)}"
        )
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError
    if not is_number(value):
        raise ValueError(f"sizes go up to {LARGEST:g}")
    return float(value)


def _with_point(text: str) -> str:
    """Return a number as YAML reads it: with a decimal point and a signed exponent."""
    mantissa, mark, exponent = text.lower().partition("e")
    mantissa = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"{mantissa}{mark}{exponent if not mark or exponent[:1] in '+-' else '+' + exponent}"


def positive(value: object) -> float:
    """Return a number above zero."""
    if number(value) <= 0:
        raise ValueError
    if not is_positive(value):
        raise ValueError(f"sizes go down to {SMALLEST:g}")
    return number(value)


def whole(least: int, most: int = MAX_WHOLE) -> Callable[[object], int]:
    """Return a check for whole numbers from `least` to `most`."""

    def kind(value: object) -> int:
        """Return the value if it is such a number."""
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            raise ValueError
        if value > most:
            raise ValueError(f"at most {most}")
        return value

    return kind


def text(value: object) -> str:
    """Return a piece of text that can be drawn and written: without control characters, and with no formula."""
    if not isinstance(value, str):
        raise ValueError
    if len(value) > MAX_TEXT or CONTROL.search(value):
        raise ValueError(f"at most {MAX_TEXT} characters that can be printed")
    if value.count("$") > 1:
        raise ValueError("$ at most once: two would enclose a formula")
    return value


def choice(options: Mapping[str, object] | tuple[str, ...]) -> Callable[[object], str]:
    """Return a check for one of the names in `options`."""

    def kind(value: object) -> str:
        """Return the value if it is one of the options."""
        if value not in tuple(options):
            raise ValueError
        return value

    return kind


def mapping(value: object) -> dict:
    """Return a mapping, which is read further where its keys are known."""
    if not isinstance(value, dict):
        raise ValueError
    return value


def listed(kind: Callable[[object], object]) -> Callable[[object], list]:
    """Return a check for lists with at least one entry, each of that kind, none twice."""

    def whole_list(value: object) -> list:
        """Return the entries, each converted."""
        if not isinstance(value, list) or not value:
            raise ValueError
        if len(value) > MAX_ENTRIES:
            raise ValueError(f"at most {MAX_ENTRIES} entries")
        entries = [kind(entry) for entry in value]
        if len({repr(entry) for entry in entries}) < len(entries):
            raise ValueError("an entry is given twice")
        return entries

    return whole_list


def pair(value: object) -> list[float]:
    """Return two numbers."""
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError
    return [number(entry) for entry in value]


def interval(value: object) -> list[float]:
    """Return two numbers, the smaller one first."""
    ends = pair(value)
    if ends[0] > ends[1]:
        raise ValueError
    return ends


def two_positive(value: object) -> list[float]:
    """Return two positive numbers."""
    return [positive(entry) for entry in pair(value)]


def size(value: object) -> list[float]:
    """Return width and height in inches."""
    if max(two_positive(value)) > MAX_INCHES:
        raise ValueError(f"at most {MAX_INCHES:g} each")
    return two_positive(value)


def each_way(value: object) -> float | list[float]:
    """Return a positive number for both directions, or one for each."""
    return two_positive(value) if isinstance(value, list) else positive(value)


_TYPES = {
    float: (number, "a number"),
    int: (whole(1), "a whole number, 1 or more"),
    str: (text, "text"),
    float | None: (number, "a number, or leave the key out"),
    float | list[float] | None: (each_way, "a positive number or a list of two, for y and x, or leave the key out"),
    Sequence[float]: (listed(number), "a list of numbers, none twice"),
    str | None: (text, "text, or leave the key out"),
}


@functools.cache
def keys_of(kind: type) -> Mapping[str, Key]:
    """Return the keys of a dataclass: those of its fields that a config can give, with their types and defaults."""
    hints = typing.get_type_hints(kind)
    keys = {}
    for entry in dataclasses.fields(kind):
        if entry.init and hints[entry.name] in _TYPES:
            convert, allowed = _TYPES[hints[entry.name]]
            # A number with the default None is computed from others in Python; a file must give it.
            required = entry.default is dataclasses.MISSING or (hints[entry.name] is float and entry.default is None)
            default = REQUIRED if required else entry.default
            keys[entry.name] = Key(convert, allowed, default)
    return MappingProxyType(keys)
