"""Heights in netCDF and HDF5 files: a variable along a line or over an area, and its coordinates if it has any."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np

from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.topography_files import io
from contactsim.topography_files.classic_netcdf import least_length
from contactsim.topography_files.io import RawHeights


def read_netcdf(file: Path, dimensions: int | None, unit: str | None, variable: str | None) -> RawHeights:
    """Return the heights of a netCDF or HDF5 file and their spacing.

    Without `dimensions`, those of the named variable count, and else an area is preferred. The dimensions of an area
    are y and x, in any order, or else rows and columns.
    """
    _check_length(file)
    with netCDF4.Dataset(str(file)) as data:
        entries = _all_variables(data)
        if dimensions is None:
            candidates = [entries[variable]] if variable in entries else list(entries.values())
            dimensions = 2 if any(entry.ndim == 2 for entry in candidates) else 1
        field = _find_heights(entries, dimensions, variable, file)
        steps: list[float | None] = []
        for name in field.dimensions:
            places = _positions_along(name, field, unit, file)
            steps.append(None if places is None else io.mean_step(places, name, file))
        scale = io.unit_factor(field.name, _stated_unit(field), unit, file)
        io.check_count(field.shape, field.name, file)
        heights = io.real_numbers(field[:], field.name, file, scale, dimensions)
        heights = heights[tuple(slice(None, None, -1 if step and step < 0 else 1) for step in steps)]
        spacing = tuple(step and abs(step) for step in steps)
        return (heights.T, spacing[::-1]) if field.dimensions == ("x", "y") else (heights, spacing)


def _check_length(file: Path) -> None:
    """Raise an InputError for a file in the classic format that is cut off: it would be read with zeros."""
    try:
        is_whole = least_length(file) <= file.stat().st_size
    except (IndexError, KeyError, struct.error):
        is_whole = False
    if not is_whole:
        raise InputError("path", str(file), f"a whole {file.suffix} file; this one is cut off", file)


def _all_variables(data: netCDF4.Dataset, path: str = "") -> dict[str, netCDF4.Variable[Any]]:
    """Return the variables of a file or group, and of the groups in it, by their paths."""
    entries = {f"{path}{name}": entry for name, entry in data.variables.items()}
    for name, group in data.groups.items():
        entries |= _all_variables(group, f"{path}{name}/")
    return entries


def _find_heights(
    entries: dict[str, netCDF4.Variable[Any]], dimensions: int, variable: str | None, file: Path
) -> netCDF4.Variable[Any]:
    """Return the heights in a netCDF file: `variable`, or the one named like heights, or the only floats."""
    fields = {name: entry for name, entry in entries.items() if entry.ndim == dimensions}
    coordinates = {name for entry in entries.values() for name in _coordinate_names(entry)}
    free = [name for name in fields if name not in coordinates]
    named = [name for name in free if name.rpartition("/")[2] in ("heights", "height", "z")]
    floats = [name for name in free if np.dtype(fields[name].dtype).kind == "f"]
    names = [str(variable)] if variable is not None else named if len(named) == 1 else floats
    if len(names) != 1 or names[0] not in fields:
        kind = "heights along a line" if dimensions == 1 else "heights over an area"
        raise InputError("variable", variable, f"the name of {kind}, of those: {list(fields)}", file)
    return fields[names[0]]


def _positions_along(dimension: str, heights: netCDF4.Variable[Any], unit: str | None, file: Path) -> Array | None:
    """Return the coordinate (n,) of the heights along a dimension, in nm, or None."""
    beside = heights.group().variables
    names = [name for name in _coordinate_names(heights) if name in beside and name != heights.name]
    for place in (beside[name] for name in names):
        if place.dimensions == (dimension,):
            scale = io.unit_factor(place.name, _stated_unit(place) or unit, None, file)
            io.check_count(place.shape, place.name, file)
            return io.finite_numbers(place[:], place.name, file, scale)
    return None


def _stated_unit(variable: netCDF4.Variable[Any]) -> str:
    """Return the unit that a netCDF variable states as `units` or, as some writers do, `unit`; empty if none."""
    return str(getattr(variable, "units", getattr(variable, "unit", "")))


def _coordinate_names(variable: netCDF4.Variable[Any]) -> list[str]:
    """Return the names that coordinates of a variable may have."""
    return [*variable.dimensions, *str(getattr(variable, "coordinates", "")).split()]
