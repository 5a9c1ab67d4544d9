"""Checks that the readers of measured heights share: paths, units, spacings and finite numbers in nm."""

from __future__ import annotations

import math
import unicodedata
import zipfile
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactsim.errors import LARGEST, NUMBER, POSITIVE, InputError, Words, is_positive
from contactsim.grid import Array

UNITS = {
    "m": 1e9,
    "mm": 1e6,
    "um": 1e3,
    "\u03bcm": 1e3,
    "micrometer": 1e3,
    "micron": 1e3,
    "microns": 1e3,
    "nm": 1.0,
    "angstrom": 0.1,
    "\u00c5": 0.1,
    "pm": 1e-3,
    "inch": 2.54e7,
}
TEXT = (".csv", ".txt", ".xyz", ".dat")
COMPRESSED = {".gz": "gzip", ".bz2": "bz2"}
"""Modules that open a compressed text, by its suffix."""
MATRICES = {"double", "single", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))}
"""Kinds of full matrices of numbers in .mat files."""
HDF5 = (".nc", ".h5", ".hdf5")
NAMED = (".npz", ".mat", *HDF5)
"""Files that hold several arrays by their names."""
SUFFIXES = (".npy", *NAMED, *TEXT)
MAX_HEIGHTS = 2**28
"""Most heights of a measurement: 2 GiB."""
TOLERANCE = 1e-3
"""Tolerance of positions, in mean spacings."""
MIN_ROUNDED = 100
"""Fewest positions that may be rounded: fewer could have any steps."""

UNREADABLE = (
    *(EOFError, MemoryError, OSError, OverflowError, RuntimeError, ValueError),
    *(zipfile.BadZipFile, zlib.error),
)
"""What readers raise on a damaged file."""

RawHeights = tuple[Array, tuple[float | None, ...]]
"""Heights (n,) or (ny, nx), and the spacing in each direction, x last, None where the file states none; nm."""


def existing_path(path: str | Path) -> Path:
    """Return the path of an existing file; InputError otherwise."""
    if not Path(path).is_file():
        raise InputError("path", path, "an existing file", path)
    return Path(path)


def suffix_of(file: Path) -> str:
    """Return the suffix of a file in small letters, of a compressed text that of the text."""
    suffix = file.suffix.lower()
    inner = Path(file.stem).suffix.lower()
    return inner if suffix in COMPRESSED and inner in TEXT else suffix


def refuse_unused(key: str, value: object, suffixes: tuple[str, ...], file: Path) -> None:
    """Raise an InputError if a value is given that files with this suffix do not use."""
    if value is not None and suffix_of(file) not in suffixes:
        raise InputError(key, value, f"none for {suffix_of(file)}, only for {', '.join(suffixes)}", file)


@contextmanager
def report_unreadable(file: Path, *more: type[Exception]) -> Iterator[None]:
    """Turn the errors that a reader raises on a damaged file, and `more`, into an InputError."""
    errors: tuple[type[Exception], ...] = (*UNREADABLE, *more)
    try:
        yield
    except InputError:
        raise
    except errors as error:
        why = " ".join(str(error).split())[:200]
        raise InputError("path", str(file), f"a readable {suffix_of(file)} file ({why})", file) from error


def positive_spacing(spacing: object, file: object) -> float:
    """Return a spacing as a float; InputError unless it is a positive finite number."""
    if is_positive(spacing):
        return float(spacing)
    raise InputError("spacing", spacing, f"{POSITIVE}, in nm", file)


def real_numbers(values: ArrayLike, key: str, file: object, scale: float = 1.0, dims: int = 1) -> Array:
    """Return a scaled float64 copy of numbers, two or more in each of `dims` directions; NaN where one is masked."""
    array: np.ma.MaskedArray[Any, Any] = np.ma.asarray(values)
    if array.dtype.kind not in "iuf" or array.ndim != dims or min(array.shape) < 2:
        allowed = f"two or more real numbers{' each way' * (dims > 1)}, in {dims}D"
        raise InputError(key, Words(f"shape {array.shape} of {array.dtype}"), allowed, file)
    with np.errstate(over="ignore", invalid="ignore"):
        numbers: Array = np.ma.filled(array.astype(np.float64), np.nan) * scale
        largest = float(np.abs(numbers).max(where=np.isfinite(numbers), initial=0.0))
    if largest > LARGEST:
        raise InputError(key, Words(f"{largest:g} nm"), f"{NUMBER}, in nm", file)
    return numbers


def finite_numbers(values: ArrayLike, key: str, file: object, scale: float = 1.0, dims: int = 1) -> Array:
    """Return a scaled float64 copy of finite numbers, two or more in each of `dims` directions."""
    numbers = real_numbers(values, key, file, scale, dims)
    check_finite(numbers, key, file)
    return numbers


def check_finite(numbers: Array, key: str, file: object, remedy: str = "") -> None:
    """Raise an InputError for numbers that are missing or not finite; remedy: what else may be done."""
    bad = ~np.isfinite(numbers)
    if not bad.any():
        return
    at = np.unravel_index(np.argmax(bad), bad.shape)
    where = ", ".join(f"{name} {place + 1}" for name, place in zip(("row", "column"), at, strict=False))
    problem = f"{numbers[at]} in {where}"
    if numbers.ndim > 1:
        problem = f"{bad.sum()} of {bad.size} points missing or not finite, the first {problem}"
    raise InputError(key, Words(problem), f"finite numbers, none missing{remedy}", file)


def unit_factor(key: str, stated: str | None, unit: str | None, file: Path) -> float:
    """Return the nanometres in the unit that the file states, or else in `unit`; they must not differ."""
    names = [unicodedata.normalize("NFKC", str(name)).strip() for name in (stated or None, unit) if name is not None]
    wrong = [name for name in names if name not in UNITS]
    if wrong or not names:
        allowed = f"for {key} one of {', '.join(UNITS)}, in the file or as `unit`"
        raise InputError("unit", wrong[0] if wrong else None, allowed, file)
    if UNITS[names[0]] != UNITS[names[-1]]:
        raise InputError("unit", unit, f"none, or that in the file, {stated}", file)
    return UNITS[names[0]]


def mean_step(positions: Array, key: str, file: Path, rounding: float = 0.0) -> float:
    """Return the step of positions (n,), negative if they descend; InputError unless they are equally spaced.

    Many positions may be off by the rounding to the last digit that is written, which is at most half of that digit.
    """
    mean = float(positions[-1] - positions[0]) / (positions.size - 1)
    off = np.abs(np.diff(positions) - mean)
    row = int(np.argmax(off)) + 1
    drift = np.abs(positions - np.linspace(positions[0], positions[-1], positions.size)).max()
    is_rounded = positions.size >= MIN_ROUNDED and drift <= 2.1 * rounding  # of the position and of the ends
    if mean == 0 or (off[row - 1] > TOLERANCE * abs(mean) and not is_rounded):
        problem = f"{off[row - 1]:.6g} nm off the mean step {mean:.6g} nm from row {row} to {row + 1}"
        raise InputError(key, Words(problem), f"equal steps to {TOLERANCE:g} of the mean step", file)
    return mean


def check_spacing(spacing: float, given: float | None, file: Path) -> float:
    """Return the spacing that a file states; InputError if the requested spacing differs."""
    if given is not None and abs(given - spacing) > TOLERANCE * spacing:
        raise InputError("spacing", given, f"none, or that of the positions, {spacing:.6g} nm", file)
    return spacing


def load_npy(file: Path) -> NDArray[Any]:
    """Return the array in a .npy file, mapped, so that nothing is read before its size is known; no pickled objects."""
    array = np.lib.format.open_memmap(file, mode="r")
    check_count(array.shape, "heights", file)
    return array


def load_npz(file: Path, variable: str | None) -> NDArray[Any]:
    """Return the array in a .npz file, by its name if there are several; its size is known before it is read."""
    with zipfile.ZipFile(file) as archive:
        shapes = {Path(name).stem: _stored_shape(archive, name) for name in archive.namelist() if name.endswith(".npy")}
        names = [name for name, shape in shapes.items() if len(shape) in (1, 2)] if variable is None else [variable]
        if len(names) != 1 or names[0] not in shapes:
            raise InputError("variable", variable, f"the name of the heights, of those: {list(shapes)}", file)
        check_count(shapes[names[0]], "heights", file)
        with archive.open(f"{names[0]}.npy") as stream:
            array: NDArray[Any] = np.lib.format.read_array(stream, allow_pickle=False)
    return array


def load_mat(file: Path, variable: str | None) -> NDArray[Any]:
    """Return the matrix in a .mat file, with a row for each y, by its name if there are several; a vector is a line."""
    from scipy.io import loadmat, whosmat  # slow to import

    with report_unreadable(file, Exception):  # what scipy raises is of many kinds
        try:
            shapes = {name: shape for name, shape, kind in whosmat(file) if len(shape) == 2 and kind in MATRICES}
        except NotImplementedError as error:  # of version 7.3
            allowed = "a .mat file of version 7 or less (in MATLAB: save -v7), or heights in .h5"
            raise InputError("path", str(file), allowed, file) from error
        matrices = [name for name, shape in shapes.items() if min(shape) > 1]
        names = [variable] if variable is not None else matrices or [name for name in shapes if max(shapes[name]) > 1]
        if len(names) != 1 or names[0] not in shapes:
            raise InputError("variable", variable, f"the name of the heights, of those: {list(shapes)}", file)
        check_count(shapes[names[0]], "heights", file)
        matrix: NDArray[Any] = loadmat(file, variable_names=names)[names[0]]
    return matrix if min(matrix.shape) > 1 else matrix.ravel()


def _stored_shape(archive: zipfile.ZipFile, name: str) -> tuple[int, ...]:
    """Return the shape of an array in an archive, from its header alone."""
    with archive.open(name) as stream:
        version = np.lib.format.read_magic(stream)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        return read(stream)[0]


def check_count(shape: Sequence[int], key: str, file: object) -> None:
    """Raise an InputError for more numbers than a measurement may have, before memory is taken for them."""
    if math.prod(map(int, shape)) > MAX_HEIGHTS:
        raise InputError(key, Words(f"shape {tuple(shape)}"), f"at most {MAX_HEIGHTS} numbers", file)


LOADERS: dict[str, Callable[[Path, str | None], NDArray[Any]]] = {
    ".npy": lambda file, variable: load_npy(file),
    ".npz": load_npz,
    ".mat": load_mat,
}
"""Readers of files of arrays by their suffix."""
