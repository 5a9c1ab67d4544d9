"""Measured 1D height profiles, read so that they can be pressed like synthetic ones.

A profile comes from a text, numpy or netCDF file and becomes heights at equal spacing, in nm.
Heights point up as in the file: the largest touches first (for the other side, negate them).
The solvers are periodic and a measurement is not, so `prepare` removes form and closes the seam.
"""

from __future__ import annotations

import dataclasses
from functools import partial
from pathlib import Path

import netCDF4
import numpy as np

from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.surfaces import io
from contactsim.surfaces.io import TEXT, TOLERANCE, Kinds

SUFFIXES = (".npy", *TEXT, ".nc")


@dataclasses.dataclass(frozen=True, eq=False)
class Profile:
    """Heights (n,) in nm, up positive, at equal `spacing` in nm; `source` says where they came from.

    InputError unless there are two or more finite heights in one dimension and a positive finite spacing.
    """

    heights: Array
    spacing: float
    source: str | None

    def __post_init__(self) -> None:
        """Check both and keep them as float64 and float."""
        object.__setattr__(self, "heights", io.finite(self.heights, "heights", self.source))
        object.__setattr__(self, "spacing", io.positive(self.spacing, self.source))


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
    which does not begin with #, as comments do. InputError, with the file, for all else.
    """
    file = io.existing(path)
    suffix = file.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError("path", file.name, f"a name ending in one of {', '.join(SUFFIXES)}", file)
    io.refuse_unused("variable", variable, (".nc",), file)
    io.refuse_unused("delimiter", delimiter, TEXT, file)
    given = None if spacing is None else io.positive(spacing, file)
    with io.readable(file):
        if suffix in TEXT:
            positions, heights = _read_text(file, unit, delimiter)
        elif suffix == ".nc":
            positions, heights = _read_netcdf(file, unit, variable)
        else:
            scale = io.factor("heights", None, "nm" if unit is None else unit, file)
            positions, heights = None, io.finite(io.load_npy(file), "heights", file, scale)
    if positions is None:
        if given is None:
            raise InputError("spacing", None, "a spacing in nm, since the file has no positions", file)
        return Profile(heights, given, str(file))
    step = io.mean_step(positions, "positions", file)
    return Profile(heights if step > 0 else heights[::-1], io.agreeing(abs(step), given, file), str(file))


def _read_text(file: Path, unit: str | None, delimiter: str | None) -> tuple[Array | None, Array]:
    text = io.Text.read(file, delimiter)
    *places, heights = text.table(range(1, 4), "one to three numbers 1.5, as many as in the first row", file).T
    units = text.units(len(places) + 1, file) or [""] * (len(places) + 1)
    placed = [
        io.finite(at, "positions", file, io.factor("positions", of or unit, None, file))
        for at, of in zip(places, units, strict=False)
    ]
    placed.sort(key=np.ptp, reverse=True)  # of x and y the one that runs first
    if len(placed) == 2 and np.ptp(placed[1]) > TOLERANCE * np.ptp(placed[0]) / (heights.size - 1):
        raise InputError("positions", "x and y that both vary", "a line scan: x or y constant", file)
    scale = io.factor("heights", units[-1], unit, file)
    return placed[0] if placed else None, io.finite(heights, "heights", file, scale)


def _read_netcdf(file: Path, unit: str | None, variable: str | None) -> tuple[Array | None, Array]:
    with netCDF4.Dataset(str(file)) as data:
        heights = io.find_heights(data, 1, variable, file)
        place = io.positions_along(heights.dimensions[0], data, heights, unit, file)
        scale = io.factor(heights.name, io.stated_unit(heights), unit, file)
        return place, io.finite(heights[:], heights.name, file, scale)


DETREND: Kinds = {
    "none": np.copy,
    "mean": partial(io.less_fit, 0),
    "linear": partial(io.less_fit, 1),
    "quadratic": partial(io.less_fit, 2),
}
PERIODIC: Kinds = {
    "none": np.copy,
    "window": io.windowed,
    "mirror": io.mirrored,
    "tilt": lambda heights: heights - np.linspace(heights[0], heights[-1], heights.size),
}


def prepare(profile: Profile, detrend: str = "linear", periodic: str = "mirror") -> Profile:
    """Return the profile less its least-squares fit, then made periodic; InputError for other kinds.

    detrend: none, mean, linear or quadratic.
    periodic: none: as it is, (n,); a step at the seam stays and adds step^2 / (n spacing^2) to the mean square slope.
    window: mean-free heights, (n,), tapered by cosines to zero over 10 % at each end; the rms slope of roughness
    much shorter than the length falls by about 6 % (mean square times 0.875), that of longer waves changes more.
    mirror: followed by their reverse, (2n-2,), the ends once; the rms slope is kept.
    tilt: less the line through both ends, (n,), zero there then; the mean square of the n-1 slopes falls by the line's.
    """
    level = io.applied(DETREND, "detrend", detrend, profile.heights, profile.source, 1)
    heights = io.applied(PERIODIC, "periodic", periodic, level, profile.source, 1)
    return dataclasses.replace(profile, heights=heights)
