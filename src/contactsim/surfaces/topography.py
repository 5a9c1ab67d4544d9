"""Measured heights along a line or over an area, read so that they can be pressed like synthetic ones.

Heights point up as in the file: the largest touches first (for the other side, negate them). A measurement does not
repeat: it is pressed alone on a half-space, or `contactsim.prepare_topography` makes it periodic.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from contactsim.errors import POSITIVE, InputError
from contactsim.grid import Array
from contactsim.surfaces import io
from contactsim.surfaces.instrument import read_instrument
from contactsim.surfaces.io import HDF5, SUFFIXES, TEXT, RawHeights
from contactsim.surfaces.missing import WAYS, fill_missing
from contactsim.surfaces.netcdf import read_netcdf
from contactsim.surfaces.text_layouts import read_text


@dataclasses.dataclass(frozen=True, eq=False)
class Topography:
    """Measured heights along a line or over an area: a surface with its own number of points.

    Parameters
    ----------
    values : array, shape (n,) or (ny, nx)
        Heights in nm, up positive; element (0, 0) has the smallest x and y.
    spacing : float or (float, ...)
        Distance between points in nm, one for all directions or one for each, x last; kept as a tuple.
    source : str, optional
        Where the heights come from; errors name it.
    filled, spikes : float
        Share of the points that were missing and have been filled, and of those that were spikes and replaced.
    periodic : bool
        Whether the heights repeat; a measurement does not, unless it is made to.

    Raises
    ------
    InputError
        If there are not two or more finite heights in each of one or two directions, or a spacing is not positive.
    """

    values: Array = dataclasses.field(repr=False)
    spacing: tuple[float, ...]
    source: str | None = None
    filled: float = 0.0
    spikes: float = 0.0
    periodic: bool = False
    modes = None

    def __post_init__(self) -> None:
        """Check both and keep them as float64 and floats."""
        values = io.finite_numbers(self.values, "heights", self.source, dims=_dimensions_of(self.values))
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "spacing", _read_spacing(self.spacing, values.ndim, self.source))

    def __repr__(self) -> str:
        """Return number of points, size, range of heights, and what was done to them, in one line."""
        points = " × ".join(map(str, self.values.shape))
        size = " × ".join(f"{length:.6g}" for length in self.lengths)
        text = f"{points} points on {size} nm, heights from {self.values.min():.6g} to {self.values.max():.6g} nm"
        shares = {"filled": self.filled, "replaced as spikes": self.spikes}
        text += "".join(f", {share:.2%} {words}" for words, share in shares.items() if share)
        text += ", periodic" if self.periodic else ""
        return f"<Topography: {text}{f', of {self.source}' if self.source else ''}>"

    @property
    def points(self) -> int:
        """Number of heights along x."""
        return int(self.values.shape[-1])

    @property
    def lengths(self) -> tuple[float, ...]:
        """Length in each direction, x last: number of points times spacing, nm."""
        return tuple(size * step for size, step in zip(self.values.shape, self.spacing, strict=True))

    def shape(self, points: int) -> tuple[int, ...]:
        """Return the shape of the heights, which does not depend on `points`."""
        return self.values.shape

    def check(self, points: int) -> None:
        """Raise an InputError for another number of points along x: a measurement is not resampled."""
        if points != self.points:
            raise InputError("points", points, f"{self.points}, the number of points of the measurement")

    def heights(self, points: int) -> Array:
        """Return the heights in nm; `points` must be their number along x."""
        self.check(points)
        return self.values

    def even_part(self) -> Topography:
        """Return the topography without the last point in each direction that has an odd number of them."""
        values = self.values[tuple(slice(0, size - size % 2) for size in self.values.shape)]
        return self if values.shape == self.values.shape else dataclasses.replace(self, values=values)

    def every_second(self) -> Topography:
        """Return the topography with every second point in each direction, from the first."""
        values = self.values[(slice(None, None, 2),) * self.values.ndim]
        return dataclasses.replace(self, values=values, spacing=tuple(2 * step for step in self.spacing))


def read_topography(
    path: str | Path,
    *,
    dimensions: int | None = None,
    spacing: float | Sequence[float] | None = None,
    unit: str | None = None,
    variable: str | None = None,
    delimiter: str | None = None,
    fill: str | None = None,
) -> Topography:
    """Read measured heights along a line or over an area.

    Parameters
    ----------
    path : str or Path
        - ``.npy``, ``.npz``: heights (n,) or (ny, nx).
        - ``.csv``, ``.txt``, ``.dat``, also with ``.gz``: one column z, two columns x z, or three columns x y z with x
          or y constant are a line; otherwise there is a row for each y, from the smallest, and a column for each x.
          Sizes and units are read from lines before the numbers, such as ``# Width: 12.3 µm``. Three columns that are
          the points x y z of a complete grid, in any order, are an area.
        - ``.xyz``: the same for a line; over an area the points x y z of a grid.
        - ``.nc``, ``.h5``, ``.hdf5``: a variable with one or two dimensions.
        - others: files of instruments, if the package SurfaceTopography is installed.
    dimensions : int, optional
        1 for a line, 2 for an area; as the file has by default.
    spacing : float or (float, float), optional
        Distance between points in nm, of all directions or (dy, dx). Only files without positions need it; positions
        in the file are used first, and `spacing` must agree with them.
    unit : str, optional
        Unit of all that the file states no unit for; it must agree with the heights' if they have one. Heights in
        ``.npy`` are in nm by default. In a text a header line like ``x [um], z [nm]`` states the units of all columns.
    variable : str, optional
        Name of the heights in ``.npz``, ``.nc`` and ``.h5``, of the channel in a file of an instrument.
    delimiter : {",", ";", tab, " "}, optional
        Separator in a text, " " for any blanks; the rows show it by default.
    fill : {"linear", "nearest", "lowest"}, optional
        How points that are missing or not finite are filled, at most half of them: between the points around a hole,
        as the nearest point, or as the lowest of all. Without it they are refused.

    Returns
    -------
    Topography
        Heights (n,) or (ny, nx) in nm; descending positions are reversed. `filled` is the share of points filled.

    Raises
    ------
    InputError
        For a file that cannot be read, lacks a height or a unit, or has unequal steps.
    """
    file = io.existing_path(path)
    if dimensions not in (None, 1, 2):
        raise InputError("dimensions", dimensions, "1, a line, or 2, an area; as the file has without it", file)
    if io.suffix_of(file) in SUFFIXES:
        io.refuse_unused("variable", variable, (".npz", *HDF5), file)
    io.refuse_unused("delimiter", delimiter, TEXT, file)
    heights, steps = _read(file, dimensions, unit, variable, delimiter, fill is not None)
    filled = 0.0
    if fill is None:
        io.check_finite(heights, "heights", file, f"; or `fill` as one of {', '.join(WAYS)}")
    else:
        heights, filled = fill_missing(heights, fill, file)
    requested = (None,) * heights.ndim if spacing is None else _read_spacing(spacing, heights.ndim, file)
    if None in steps and None in requested:
        pair = ", or a pair (dy, dx)" * (heights.ndim == 2)
        raise InputError("spacing", None, f"a spacing in nm{pair}, since the file has no positions", file)
    pairs = zip(steps, requested, strict=True)
    spacings = tuple(_agreed_step(step, asked, file) for step, asked in pairs)
    return Topography(heights, spacings, str(file), filled)


def _read(
    file: Path,
    dimensions: int | None,
    unit: str | None,
    variable: str | None,
    delimiter: str | None,
    with_gaps: bool,
) -> RawHeights:
    """Return the heights and their spacing by the reader of the suffix."""
    suffix = io.suffix_of(file)
    if suffix not in SUFFIXES:
        return read_instrument(file, dimensions, unit, variable)
    with io.report_unreadable(file):
        if suffix in HDF5:
            return read_netcdf(file, dimensions, unit, variable)
        if suffix in TEXT:
            return read_text(file, dimensions, unit, delimiter, with_gaps)
        scale = io.unit_factor("heights", None, "nm" if unit is None else unit, file)
        array = io.load_npy(file) if suffix == ".npy" else io.load_npz(file, variable)
        heights = io.real_numbers(array, "heights", file, scale, dimensions or _dimensions_of(array))
        return heights, (None,) * heights.ndim


def _dimensions_of(values: object) -> int:
    """Return the dimensions to expect of heights: 1 for a list of numbers, 2 otherwise."""
    return 1 if np.ndim(np.ma.asarray(values)) == 1 else 2


def _agreed_step(step: float | None, requested: float | None, file: Path) -> float:
    """Return the spacing that the file has, or else the requested one; InputError if they differ."""
    if step is None:
        assert requested is not None  # one of the two was checked to be there
        return requested
    return io.check_spacing(step, requested, file)


def _read_spacing(spacing: object, dimensions: int, file: object) -> tuple[float, ...]:
    """Return the spacing in each direction from one number, or one for each direction."""
    values = list(spacing) if isinstance(spacing, list | tuple | np.ndarray) and np.ndim(spacing) == 1 else None
    values = [spacing] * dimensions if values is None else values
    if len(values) != dimensions:
        allowed = f"{POSITIVE}, in nm" + ", or a pair (dy, dx) of them" * (dimensions == 2)
        raise InputError("spacing", spacing, allowed, file)
    return tuple(io.positive_spacing(value, file) for value in values)
