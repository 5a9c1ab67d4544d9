"""Read settings strictly.

Every mapping in a config file is read against a table of keys. An unknown, missing or ill-typed key is a `InputError`
that names the file, the key, the value and what is allowed; nothing is ever silently ignored. A tier's overrides are
laid over a study before it is read, so they are checked by the same table.
"""

from __future__ import annotations

import dataclasses
import functools
import sys
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
import yaml

from contactsim.errors import InputError

REQUIRED = object()


@dataclass(frozen=True)
class Key:
    """One allowed key: kind converts and checks a value or raises ValueError; allowed says what it wants."""

    kind: Callable[[object], object]
    allowed: str
    default: object = REQUIRED


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]  # in C where that is installed
    """Safe YAML, read in C where that is installed, in which a key given twice is an error."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict:
        """Return the mapping; raise an error for a key that stands in it twice."""
        own = [key for key, _ in node.value if key.tag != "tag:yaml.org,2002:merge"]
        keys = [self.construct_object(key, deep=True) for key in own]
        for key in keys:
            if keys.count(key) > 1:
                raise yaml.MarkedYAMLError(problem=f"key {key!r} is given twice", problem_mark=node.start_mark)
        return super().construct_mapping(node, deep)


def load_yaml(path: str | Path) -> dict:
    """Return the mapping in a YAML file."""
    try:
        content = yaml.load(Path(path).read_text(encoding="utf-8"), _Loader)
    except OSError as error:
        raise InputError("file", str(path), "a file that can be read", path) from error
    except (yaml.YAMLError, ValueError) as error:
        raise InputError(
            "YAML", "text that is not", f"valid YAML with each key once ({' '.join(str(error).split())})", path
        ) from error
    if content is None:
        return {}
    if not isinstance(content, dict):
        raise InputError("top level", content, "a mapping of keys to values", path)
    return content


def tiered(file: Path, over: dict, tier: str) -> tuple[dict, str] | None:
    """Return the mapping in a file beside tiers.yaml with the overrides of a tier, and its name for messages.

    None without that file; InputError where a tier overrides a file that does not exist.
    """
    tiers = file.with_name("tiers.yaml")
    if not file.exists():
        if over:
            raise InputError(f"{tier}.{file.stem}", over, f"left out, as there is no {file}", tiers)
        return None
    return overlaid(load_yaml(file), over), named(file, over, tier)


def named(file: Path, over: dict, tier: str) -> str:
    """Return the name for messages of a file beside tiers.yaml, with the tier that overrides it."""
    return f"{file} with tier {tier} of {file.with_name('tiers.yaml')}" if over else str(file)


def read(section: object, keys: Mapping[str, Key], file: object, prefix: str = "") -> dict:
    """Return the section with every value checked and every default filled in."""
    if not isinstance(section, dict):
        raise InputError(prefix or "top level", section, f"a mapping with keys {', '.join(keys)}", file)
    dotted = f"{prefix}." if prefix else ""
    for name in section:
        if name not in keys:
            raise InputError(f"{dotted}{name}", section[name], f"no such key; known keys: {', '.join(keys)}", file)
    values = {}
    for name, key in keys.items():
        if name not in section:
            if key.default is REQUIRED:
                raise InputError(f"{dotted}{name}", "nothing", f"{key.allowed} (the key is missing)", file)
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
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= sys.float_info.max:
        raise ValueError
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
    return number(value)


def whole(least: int) -> Callable[[object], int]:
    """Return a check for whole numbers of at least `least`."""

    def kind(value: object) -> int:
        """Return the value if it is such a number."""
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            raise ValueError
        return value

    return kind


def text(value: object) -> str:
    """Return a piece of text."""
    if not isinstance(value, str):
        raise ValueError
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


def size(value: object) -> list[float]:
    """Return two positive numbers."""
    return [positive(entry) for entry in pair(value)]


def each_way(value: object) -> float | list[float]:
    """Return a positive number for both directions, or one for each."""
    return size(value) if isinstance(value, list) else positive(value)


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


def overlaid(base: dict, over: dict) -> dict:
    """Return `base` with the entries of `over` in their place: mappings are merged, null removes a key."""
    merged = dict(base)
    for name, value in over.items():
        if value is None and name in merged:
            del merged[name]
            continue
        both = isinstance(value, dict) and isinstance(merged.get(name), dict)
        merged[name] = overlaid(merged[name], value) if both else value
    return merged
