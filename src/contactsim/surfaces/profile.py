"""Measured 1D height profiles, read so that they can be pressed like synthetic ones.

A profile comes from a text, numpy or netCDF file and becomes heights at equal spacing, in nm.
Heights point up as in the file: the largest touches first (for the other side, negate them).
The solvers are periodic and a measurement is not: `contactsim.surfaces.preparation.prepare` removes form and closes the
seams.
"""

from __future__ import annotations

import dataclasses
from pathlib import Path

import netCDF4
import numpy as np

from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.surfaces import io
from contactsim.surfaces.io import TEXT, TOLERANCE

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
        object.__setattr__(self, "heights", io.finite_numbers(self.heights, "heights", self.source))
        object.__setattr__(self, "spacing", io.positive_spacing(self.spacing, self.source))


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
    file = io.existing_path(path)
    suffix = file.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError("path", file.name, f"a name ending in one of {', '.join(SUFFIXES)}", file)
    io.refuse_unused("variable", variable, (".nc",), file)
    io.refuse_unused("delimiter", delimiter, TEXT, file)
    given = None if spacing is None else io.positive_spacing(spacing, file)
    with io.report_unreadable(file):
        if suffix in TEXT:
            positions, heights = _read_text(file, unit, delimiter)
        elif suffix == ".nc":
            positions, heights = _read_netcdf(file, unit, variable)
        else:
            scale = io.unit_factor("heights", None, "nm" if unit is None else unit, file)
            positions, heights = None, io.finite_numbers(io.load_npy(file), "heights", file, scale)
    if positions is None:
        if given is None:
            raise InputError("spacing", None, "a spacing in nm, since the file has no positions", file)
        return Profile(heights, given, str(file))
    step = io.mean_step(positions, "positions", file)
    return Profile(heights if step > 0 else heights[::-1], io.check_spacing(abs(step), given, file), str(file))


def _read_text(file: Path, unit: str | None, delimiter: str | None) -> tuple[Array | None, Array]:
    text = io.Text.read(file, delimiter)
    *places, heights = text.table(range(1, 4), "one to three numbers 1.5, as many as in the first row", file).T
    units = text.units(len(places) + 1, file) or [""] * (len(places) + 1)
    placed = [
        io.finite_numbers(at, "positions", file, io.unit_factor("positions", of or unit, None, file))
        for at, of in zip(places, units, strict=False)
    ]
    placed.sort(key=np.ptp, reverse=True)  # of x and y the one that runs first
    if len(placed) == 2 and np.ptp(placed[1]) > TOLERANCE * np.ptp(placed[0]) / (heights.size - 1):
        raise InputError("positions", "x and y that both vary", "a line scan: x or y constant", file)
    scale = io.unit_factor("heights", units[-1], unit, file)
    return placed[0] if placed else None, io.finite_numbers(heights, "heights", file, scale)


def _read_netcdf(file: Path, unit: str | None, variable: str | None) -> tuple[Array | None, Array]:
    with netCDF4.Dataset(str(file)) as data:
        heights = io.find_heights(data, 1, variable, file)
        place = io.positions_along(heights.dimensions[0], data, heights, unit, file)
        scale = io.unit_factor(heights.name, io.stated_unit(heights), unit, file)
        return place, io.finite_numbers(heights[:], heights.name, file, scale)
