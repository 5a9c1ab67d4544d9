"""Arguments of public calls, read by their annotations before anything is done with them.

`checked` stands above every public function and class. It reads the annotations at the first call. From then on each
argument that fits is passed on in its plain form: numbers as floats and ints, sequences as tuples. Everything else, a
missing argument and an unknown one too, is an `InputError` in one line. So a function or `__post_init__` never checks
types, only what depends on several arguments.

An annotation may be narrower: `Annotated[float, Only(words, test)]` takes numbers that pass the test, and
`Annotated[stored, given]` takes what fits `given`, where a dataclass keeps another type than it takes.
"""

from __future__ import annotations

import inspect
import types
import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, is_dataclass
from difflib import get_close_matches
from functools import cache, cached_property, wraps
from pathlib import Path
from typing import Annotated, Any, NamedTuple, TypeVar, Union, get_args, get_origin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactsim.errors import LARGEST, NOTHING, NUMBER, POSITIVE, InputError, Words, is_number, is_positive, is_whole

C = TypeVar("C", bound=Callable[..., Any])

REFUSED = object()
"""What a reader returns for a value that does not fit."""
EXAMPLES = {
    "LoadPath": "pressures([0.01, 0.1])",
    "Result": "press(heights, ...)",
    "Topography": "read_topography(path), or Topography(values, spacing)",
    "Surface": "Cylinder(length, radius)",
    "Elasticity": "HalfSpace(contact_modulus)",
    "Effect": "HardWall()",
    "Pairing": "Lattice(lattice_constant)",
    "Increments": "Adaptive()",
    "HardWallSolver": "NestedActiveSet()",
    "CohesiveSolver": "NewtonKrylov()",
    "Dataset": "simulate(scene, ...)",
}
"""What to type for an object of a class, where its constructor is not the usual way to one."""


class Reader(NamedTuple):
    """What fits an annotation, in words, and a function that returns a value as it is passed on, or `REFUSED`."""

    words: str
    read: Callable[[Any], Any]


@dataclass(frozen=True)
class Only:
    """Values that an annotation is narrowed to: in words, and by a test."""

    words: str
    test: Callable[[Any], bool]


Positive = Annotated[float, Only(POSITIVE, is_positive)]
NotNegative = Annotated[float, Only("0 or a positive number", lambda value: is_number(value) and value >= 0)]
Length = Annotated[float, Only(f"{POSITIVE}, in nm", is_positive)]
Modulus = Annotated[float, Only(f"{POSITIVE}, in GPa", is_positive)]
Work = Annotated[float, Only(f"{POSITIVE}, in N/m", is_positive)]
Stiffness = Annotated[float, Only(f"{POSITIVE}, in GPa/nm", is_positive)]
Count = Annotated[int, Only("a whole number, 1 or more", is_whole)]
"""A number of things, such as points or threads."""
Numbers = Annotated[Sequence[float], Only(f"a list of one or more numbers of sizes up to {LARGEST:g}", bool)]
Values = Annotated[ArrayLike, np.ndarray]
"""Numbers of any form; an array once they are read. NumPy's own words for them include text."""
FileName = Annotated[str | Path, Only("the name of a file, a str or Path", bool)]
Gap = Annotated[NDArray[Any], Only("an array of gaps, (1 or 2, n)", lambda gap: gap.ndim == 2 and len(gap) in (1, 2))]
"""Components of the gap in rows."""
Heights = Annotated[NDArray[Any], Only("an array of finite heights", lambda values: values.ndim and _is_finite(values))]
Wavenumbers = Annotated[NDArray[Any], Only("an array of wavenumbers, (n,)", lambda wavenumber: wavenumber.ndim == 1)]
"""Of a line."""


def checked(target: C) -> C:
    """Return a function, or a class with its constructor and public methods, that reads its arguments first."""
    if not isinstance(target, type):
        return _with_reading(target, target)
    for name, member in list(vars(target).items()):
        if name.startswith("_") and name != "__init__":
            continue
        if inspect.isfunction(member):
            setattr(target, name, _with_reading(member, target))
        elif isinstance(member, classmethod):
            setattr(target, name, classmethod(_with_reading(member.__func__, target)))
    return target


def _with_reading(function: Any, owner: Any) -> Any:
    """Return a function that reads its arguments; owner: its class, or itself."""
    is_method, makes = isinstance(owner, type), function.__name__ == "__init__"
    parameters = _Parameters(function, owner, is_method)

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        """Read the arguments, then call the function."""
        caller = type(args[0]).__name__ if makes else function.__name__
        passed, named = parameters.read(caller, args[is_method:], kwargs)
        return function(*args[:is_method], *passed, **named)

    return call


class _Parameters:
    """Parameters of a function, with the readers of their annotations."""

    def __init__(self, function: Any, owner: Any, is_method: bool) -> None:
        self.function, self.owner = function, owner
        parameters = list(inspect.signature(function).parameters.values())[is_method:]
        self.order = [each.name for each in parameters if each.kind is not each.KEYWORD_ONLY]
        self.defaults = {each.name: each.default for each in parameters}
        self.options = [each.name for each in parameters if each.kind is each.KEYWORD_ONLY] or self.order
        self.required = [each.name for each in parameters if each.default is each.empty]

    @cached_property
    def readers(self) -> dict[str, Reader]:
        """Reader of each annotation; made at the first call, when all that they name is defined."""
        is_of_fields = is_dataclass(self.owner) and vars(self.owner)["__dataclass_params__"].init
        told_by = self.owner if is_of_fields and self.function.__name__ == "__init__" else self.function
        hints = typing.get_type_hints(told_by, include_extras=True)  # fields of a base by the names of its module
        return {name: read_hint(hints.get(name, Any)) for name in self.defaults}

    def read(self, caller: str, given: tuple[Any, ...], kwargs: dict[str, Any]) -> tuple[list[Any], dict[str, Any]]:
        """Return the arguments, by place and by name, as they are passed on."""
        readers, named = self.readers, dict(zip(self.order, given, strict=False))
        if len(given) > len(named):
            words = f"at most {len(named)} without a name: {', '.join(self.order) or 'none'}"
            raise InputError("arguments", Words(str(len(given))), words, caller=caller)
        for name, value in kwargs.items():
            if name not in readers:
                close = "".join(f"; did you mean {near}?" for near in get_close_matches(name, readers, 1))
                raise InputError(name, value, f"no such option, but {', '.join(self.options) or 'none'}{close}")
            if name in named:
                raise InputError(name, value, "it once, by its place or by its name", caller=caller)
        named |= kwargs
        for name in self.required:
            if name not in named:
                raise InputError(name, NOTHING, readers[name].words, caller=caller)
        for name, value in named.items():
            if value is not self.defaults[name]:
                named[name] = readers[name].read(value)
                if named[name] is REFUSED:
                    raise InputError(name, value, readers[name].words, caller=caller)
        return [named.pop(name) for name in self.order[: len(given)]], named


@cache
def read_hint(hint: Any) -> Reader:
    """Return the reader of an annotation; what it does not know is passed on as it is."""
    origin, inner = get_origin(hint), get_args(hint)
    if hint in PLAIN:
        return PLAIN[hint]
    if origin is Annotated:
        return _narrowed(*inner) if isinstance(inner[1], Only) else read_hint(inner[1])
    if origin in (Union, types.UnionType):
        return _any_of(inner)
    if origin in (tuple, Sequence):
        return _sequence(inner)
    kind = origin or hint
    if not isinstance(kind, type):
        return Reader("anything", lambda value: value)
    if kind is np.ndarray:
        return ARRAY
    return Reader(_example(kind), _protocol_test(kind) if getattr(kind, "_is_protocol", False) else _class_test(kind))


def _is_finite(values: NDArray[Any]) -> bool:
    """Return True for numbers all of which are finite."""
    return bool(values.size and np.isfinite(values).all())


def _where(value: object, fits: bool, form: Callable[[Any], Any] = lambda value: value) -> object:
    """Return a value in its form if it fits."""
    return form(value) if fits else REFUSED


def _read_array(value: object) -> object:
    """Return real numbers as an array, which an array is already."""
    if not isinstance(value, np.ndarray):
        try:
            value = np.asarray(value)
        except (TypeError, ValueError):  # rows of different lengths
            return REFUSED
    return _where(value, value.dtype.kind in "fbiu")


def _narrowed(hint: Any, rule: Only) -> Reader:
    """Return the reader of numbers or arrays that pass a test."""
    if hint in (int, float):  # tested before it is a float or an int
        return Reader(rule.words, lambda value: _where(value, rule.test(value), hint))
    plain = read_hint(hint).read

    def read(value: Any) -> Any:
        """Return a value that passes in its plain form."""
        value = plain(value)
        return _where(value, value is not REFUSED and rule.test(value))

    return Reader(rule.words, read)


def _any_of(hints: tuple[Any, ...]) -> Reader:
    """Return the reader of the first annotation that fits."""
    readers = [read_hint(hint) for hint in hints]
    words = [reader.words for reader in readers if reader is not NONE]
    words = ["a list of them" if other == f"a list, each {words[0]}" else other for other in dict.fromkeys(words)]

    def read(value: object) -> object:
        """Return the value as the first reader does that takes it."""
        return next((used for reader in readers if (used := reader.read(value)) is not REFUSED), REFUSED)

    return Reader(", or ".join(words), read)


def _sequence(inner: tuple[Any, ...]) -> Reader:
    """Return the reader of a tuple or sequence: of any length, or with an annotation for each entry."""
    any_length = len(inner) == 1 or inner[1] is Ellipsis
    readers = [read_hint(hint) for hint in (inner[:1] if any_length else inner)]

    def read(value: object) -> object:
        """Return the entries in a tuple."""
        if isinstance(value, str | bytes | Mapping | set | frozenset) or not isinstance(value, Iterable):
            return REFUSED
        if getattr(value, "ndim", 1) != 1:  # an array
            return REFUSED
        entries = tuple(value)
        if not any_length and len(entries) != len(readers):
            return REFUSED
        each = readers * len(entries) if any_length else readers
        used = tuple(reader.read(entry) for reader, entry in zip(each, entries, strict=True))
        return REFUSED if any(entry is REFUSED for entry in used) else used

    words = ", ".join(reader.words for reader in readers)
    return Reader(f"a list, each {words}" if any_length else f"({words})", read)


def _class_test(kind: type) -> Callable[[object], object]:
    """Return the reader of objects of a class."""
    return lambda value: _where(value, isinstance(value, kind))


def _protocol_test(kind: type) -> Callable[[object], object]:
    """Return the reader of objects that have what a protocol lists; a class has forgotten its brackets."""
    bases = [base for base in kind.__mro__ if getattr(base, "_is_protocol", False)]
    names = {name for base in bases for name in vars(base) if not name.startswith("_")}

    def read(value: object) -> object:
        """Return an object with all attributes; none is computed."""
        own = getattr(value, "__dict__", ())
        return _where(value, not isinstance(value, type) and all(hasattr(type(value), n) or n in own for n in names))

    return read


def _example(kind: type) -> str:
    """Return what an object of a class is called, and what to type for one."""
    name = kind.__name__
    article = "an" if name[0] in "AEIOU" else "a"
    if name not in EXAMPLES and not kind.__module__.startswith("contactsim."):
        return f"{article} {name}"
    parameters = inspect.signature(kind).parameters.values()
    required = ", ".join(each.name for each in parameters if each.default is each.empty)
    return f"{article} {name}: {EXAMPLES.get(name, f'{name}({required})')}"


ARRAY = Reader("an array of real numbers", _read_array)
NONE = Reader("None", lambda value: _where(value, value is None))
PLAIN: dict[Any, Reader] = {
    Any: Reader("anything", lambda value: value),
    object: Reader("anything", lambda value: value),
    None: NONE,
    type(None): NONE,
    float: Reader(NUMBER, lambda value: _where(value, is_number(value), float)),
    int: Reader("a whole number", lambda value: _where(value, is_number(value) and value == int(value), int)),
    bool: Reader("True or False", lambda value: _where(value, isinstance(value, bool | np.bool_), bool)),
    str: Reader("text", lambda value: _where(value, isinstance(value, str))),
}
"""Readers of plain types."""
