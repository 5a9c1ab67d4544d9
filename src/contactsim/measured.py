"""Measured 1D height profiles, read so that they can be pressed like synthetic ones.

A profile comes from a text, numpy or netCDF file and becomes heights at equal spacing, in nm.
Heights point up as in the file: the largest touches first (for the other side, negate them).
The solvers are periodic and a measurement is not, so `prepare` removes form and closes the seam.
"""

from __future__ import annotations

import dataclasses
import re
import unicodedata
from collections.abc import Callable, Mapping
from functools import partial
from numbers import Real
from pathlib import Path

import netCDF4
import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactsim.errors import SceneError

Array = NDArray[np.float64]
Kinds = Mapping[str, Callable[[Array], Array]]

UNITS = {"m": 1e9, "mm": 1e6, "um": 1e3, "\u03bcm": 1e3, "micrometer": 1e3, "nm": 1.0, "angstrom": 0.1}
TEXT = (".csv", ".txt", ".xyz", ".dat")
SUFFIXES = (".npy", *TEXT, ".nc")
TOLERANCE = 1e-3  # of positions, in mean spacings
TAPER = 0.1  # of the length, at each end


@dataclasses.dataclass(frozen=True, eq=False)
class Profile:
    """Heights (n,) in nm, up positive, at equal `spacing` in nm; `source` says where they came from.

    SceneError unless there are two or more finite heights in one dimension and a positive finite spacing.
    """

    heights: Array
    spacing: float
    source: str | None

    def __post_init__(self) -> None:
        """Check both and keep them as float64 and float."""
        object.__setattr__(self, "heights", _finite(self.heights, "heights", self.source))
        object.__setattr__(self, "spacing", _positive(self.spacing, self.source))


def read_profile(
    path: str | Path,
    *,
    spacing: float | None = None,
    unit: str | None = None,
    variable: str | None = None,
    delimiter: str | None = None,
) -> Profile:
    r"""Read a profile from .npy, .csv, .txt, .xyz, .dat or .nc; descending positions are reversed.

    spacing: in nm, for files without positions; where there are positions, theirs is used and this must agree.
    unit: of what the file states no unit for; must agree with the heights' if stated; for .npy "nm" if not given.
    variable: of the heights, .nc only. delimiter: "," ";" tab or " " (any blanks), text only; found if None.
    Text has columns z, or x z, or x y z with constant x or y; units of all in a header line like `x [um], z [nm]`,
    which does not begin with #, as comments do. SceneError, with the file, for all else.
    """
    if not isinstance(path, str | Path) or not Path(path).is_file():
        raise SceneError("path", path, "an existing file", path)
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix not in SUFFIXES:
        raise SceneError("path", file.name, f"a name ending in one of {', '.join(SUFFIXES)}", file)
    for key, value, where in (("variable", variable, (".nc",)), ("delimiter", delimiter, TEXT)):
        if value is not None and suffix not in where:
            raise SceneError(key, value, f"none for {suffix}, only for {', '.join(where)}", file)
    given = None if spacing is None else _positive(spacing, file)
    try:
        if suffix in TEXT:
            read: tuple[Array | None, Array] = _read_text(file, unit, delimiter)
        else:
            read = _read_npy(file, unit) if suffix == ".npy" else _read_netcdf(file, unit, variable)
    except SceneError:
        raise
    except (OSError, RuntimeError, ValueError) as error:
        raise SceneError("path", str(file), f"a readable {suffix} file ({error})", file) from error
    return _profile(*read, given, file)


def _profile(positions: Array | None, heights: Array, given: float | None, file: Path) -> Profile:
    """Join heights (n,) with positions (n,) or else the given spacing, all in nm."""
    if positions is None:
        if given is None:
            raise SceneError("spacing", None, "a spacing in nm, since the file has no positions", file)
        return Profile(heights, given, str(file))
    mean = float(positions[-1] - positions[0]) / (positions.size - 1)
    off = np.abs(np.diff(positions) - mean)
    row = int(np.argmax(off)) + 1
    if mean == 0 or off[row - 1] > TOLERANCE * abs(mean):
        found = f"{off[row - 1]:.6g} nm off the mean step {mean:.6g} nm from row {row} to {row + 1}"
        raise SceneError("positions", found, f"equal steps to {TOLERANCE:g} of the mean step", file)
    if given is not None and abs(given - abs(mean)) > TOLERANCE * abs(mean):
        raise SceneError("spacing", given, f"none, or that of the positions, {abs(mean):.6g} nm", file)
    return Profile(heights if mean > 0 else heights[::-1], abs(mean), str(file))


def _read_npy(file: Path, unit: str | None) -> tuple[None, Array]:
    with file.open("rb") as stream:
        values = np.lib.format.read_array(stream, allow_pickle=False)
    return None, _to_nm(values, "heights", "", "nm" if unit is None else unit, file)


def _read_text(file: Path, unit: str | None, delimiter: str | None) -> tuple[Array | None, Array]:
    if delimiter not in (None, ",", ";", "\t", " "):
        raise SceneError("delimiter", delimiter, 'one of "," ";" tab " "', file)
    text = file.read_text("utf-8-sig", errors="surrogateescape").replace("\udcb5", "\u03bc")  # latin-1 micro sign
    numbered = ((number, line.strip()) for number, line in enumerate(text.splitlines(), 1))
    rows = [(number, line) for number, line in numbered if line and not line.startswith("#")]
    # The second row, surely no header, has the separator: a semicolon, else a comma, else blanks.
    mark = delimiter or next((each for each in ";," if any(each in line for _, line in rows[1:2])), " ")
    # A header begins like a name and has no number, so that a mistyped first row, `1.O5`, is not taken for one.
    named = bool(rows) and (rows[0][1][0].isalpha() or rows[0][1][0] in "\"'")
    header = rows.pop(0) if named and set(_numbers(rows[0][1], mark)) == {None} else (0, "")
    if len(rows) < 2:
        raise SceneError("heights", f"{len(rows)} rows", "two or more rows of numbers", file)
    *places, heights = _table(rows, mark, file)
    units = re.findall(r"[\[(]([^\])]*)[\])]", header[1]) or [""] * (len(places) + 1)
    if len(units) != len(places) + 1:
        raise SceneError(f"line {header[0]}", header[1], f"a unit for each of {len(places) + 1} columns, or none", file)
    placed = [_to_nm(at, "positions", of or unit or "", None, file) for at, of in zip(places, units, strict=False)]
    placed.sort(key=np.ptp, reverse=True)  # of x and y the one that runs first
    if len(placed) == 2 and np.ptp(placed[1]) > TOLERANCE * np.ptp(placed[0]) / (len(rows) - 1):
        raise SceneError("positions", "x and y that both vary", "a line scan: x or y constant", file)
    return placed[0] if placed else None, _to_nm(heights, "heights", units[-1], unit, file)


def _numbers(line: str, mark: str) -> list[float | None]:
    """Return the numbers of a line, None for what is none; the mark " " is any blanks."""
    values: list[float | None] = []
    for field in line.split() if mark == " " else line.split(mark):
        try:
            values.append(None if "_" in field else float(field))
        except ValueError:
            values.append(None)
    return values


def _table(rows: list[tuple[int, str]], mark: str, file: Path) -> Array:
    """Return the one to three columns (., n) of numbered lines."""
    table = [_numbers(line, mark) for _, line in rows]
    for (number, line), values in zip(rows, table, strict=True):
        if None in values or len(values) != len(table[0]) or len(values) > 3:
            raise SceneError(f"line {number}", line, "one to three numbers 1.5, as many as in the first row", file)
    return np.array(table, dtype=np.float64).T


def _read_netcdf(file: Path, unit: str | None, variable: str | None) -> tuple[Array | None, Array]:
    with netCDF4.Dataset(str(file)) as data:
        lines = {name: each for name, each in data.variables.items() if each.ndim == 1}
        near = {key: [*v.dimensions, *str(getattr(v, "coordinates", "")).split()] for key, v in data.variables.items()}
        free = [name for name in lines if not any(name in others for others in near.values())]
        named = [name for name in free if name in ("heights", "height", "z")]
        floats = [name for name in free if np.dtype(lines[name].dtype).kind == "f"]
        found = [str(variable)] if variable is not None else named if len(named) == 1 else floats
        if len(found) != 1 or found[0] not in lines:
            raise SceneError("variable", variable, f"the name of the 1D heights, of those: {list(lines)}", file)
        heights = lines.pop(found[0])
        ats = [lines[at] for at in near[heights.name] if at in lines and lines[at].dimensions == heights.dimensions]
        units = [str(getattr(each, "units", "")) for each in (heights, *ats)]
        place = _to_nm(ats[0][:], ats[0].name, units[1] or unit or "", None, file) if ats else None
        return place, _to_nm(heights[:], heights.name, units[0], unit, file)


def _to_nm(values: ArrayLike, key: str, stated: str, unit: str | None, file: Path) -> Array:
    """Return values (n,) in nm, from the unit the file states or else the one given; they must not differ."""
    names = [unicodedata.normalize("NFKC", str(name)).strip() for name in (stated or None, unit) if name is not None]
    wrong = [name for name in names if name not in UNITS]
    if wrong or not names:
        allowed = f"for {key} one of {', '.join(UNITS)}, in the file or as `unit`"
        raise SceneError("unit", wrong[0] if wrong else None, allowed, file)
    if UNITS[names[0]] != UNITS[names[-1]]:
        raise SceneError("unit", unit, f"none, or that in the file, {stated}", file)
    return _finite(values, key, file, UNITS[names[0]])


def _finite(values: ArrayLike, key: str, file: object, scale: float = 1.0) -> Array:
    """Return a scaled float64 copy of two or more finite numbers in one dimension."""
    array = np.ma.asarray(values)
    if array.dtype.kind not in "iuf" or array.ndim != 1 or array.size < 2:
        raise SceneError(key, f"shape {array.shape} of {array.dtype}", "two or more real numbers, in 1D", file)
    with np.errstate(over="ignore", invalid="ignore"):
        numbers = array.astype(np.float64).filled(np.nan) * scale
    bad = np.flatnonzero(~np.isfinite(numbers))
    if bad.size:
        raise SceneError(key, f"{numbers[bad[0]]} in row {bad[0] + 1}", "finite numbers, none missing", file)
    return numbers


def _positive(spacing: object, file: object) -> float:
    if isinstance(spacing, Real) and not isinstance(spacing, bool) and 0 < spacing < np.inf:
        return float(spacing)
    raise SceneError("spacing", spacing, "a positive finite number, in nm", file)


def _fit(degree: int, heights: Array) -> Array:
    """Subtract the least-squares polynomial, in an orthonormal basis."""
    basis = np.linalg.qr(np.polynomial.legendre.legvander(np.linspace(-1, 1, heights.size), degree)).Q
    return heights - basis @ (basis.T @ heights)


def _windowed(heights: Array) -> Array:
    edge = np.minimum(np.arange(heights.size), np.arange(heights.size)[::-1]) / (heights.size - 1)
    return (heights - heights.mean()) * (0.5 - 0.5 * np.cos(np.pi * np.minimum(edge / TAPER, 1)))


DETREND: Kinds = {"none": np.copy, "mean": partial(_fit, 0), "linear": partial(_fit, 1), "quadratic": partial(_fit, 2)}
PERIODIC: Kinds = {
    "none": np.copy,
    "window": _windowed,
    "mirror": lambda heights: np.concatenate([heights, heights[-2:0:-1]]),
    "tilt": lambda heights: heights - np.linspace(heights[0], heights[-1], heights.size),
}


def _applied(kinds: Kinds, key: str, kind: str, heights: ArrayLike, source: object = None) -> Array:
    if not isinstance(kind, str) or kind not in kinds:
        raise SceneError(key, kind, f"one of {', '.join(kinds)}", source)
    return kinds[kind](_finite(heights, "heights", source))


def detrend(heights: ArrayLike, kind: str) -> Array:
    """Return heights (n,), in any unit, less their least-squares fit of a kind in `DETREND`; SceneError else."""
    return _applied(DETREND, "detrend", kind, heights)


def make_periodic(heights: ArrayLike, kind: str) -> Array:
    """Return one period of heights (n,), in any unit, made by a kind in `PERIODIC`; SceneError else.

    none: as they are, (n,); a step at the seam stays and adds step^2 / (n spacing^2) to the mean square slope.
    window: mean-free heights, (n,), tapered by cosines to zero over 10 % at each end; the rms slope of roughness
    much shorter than the length falls by about 6 % (mean square times 0.875), that of longer waves changes more.
    mirror: followed by their reverse, (2n-2,), the ends once; the rms slope is kept.
    tilt: less the line through both ends, (n,), zero there then; the mean square of the n-1 slopes falls by the line's.
    """
    return _applied(PERIODIC, "periodic", kind, heights)


def prepare(profile: Profile, detrend: str = "linear", periodic: str = "mirror") -> Profile:
    """Return the profile detrended, then made periodic, as `DETREND` and `PERIODIC` name it; SceneError else."""
    level = _applied(DETREND, "detrend", detrend, profile.heights, profile.source)
    return dataclasses.replace(profile, heights=_applied(PERIODIC, "periodic", periodic, level, profile.source))
