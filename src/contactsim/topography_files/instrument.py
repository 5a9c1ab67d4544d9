"""Heights in the files of instruments, read by the package SurfaceTopography where it is installed."""

from __future__ import annotations

import importlib
from pathlib import Path

from contactsim.errors import InputError
from contactsim.topography_files import io
from contactsim.topography_files.io import RawHeights

LIBRARY = "SurfaceTopography"


def read_instrument(file: Path, dimensions: int | None, unit: str | None, variable: str | None) -> RawHeights:
    """Return the heights of a channel and their spacing; the package has x first, so an area is transposed."""
    try:
        library = importlib.import_module(LIBRARY)
    except ImportError as error:
        allowed = f"a name ending in one of {', '.join(io.SUFFIXES)}; for others install {LIBRARY}"
        raise InputError("path", file.name, f"{allowed} (pip install {LIBRARY})", file) from error
    with io.report_unreadable(file, Exception), library.open_topography(str(file)) as reader:
        channels = {entry.channel_id: entry for entry in reader.channels if entry.is_height_channel}
        default = reader.default_channel.channel_id
        only = next(iter(channels)) if len(channels) == 1 else default  # the default may hold a phase
        usual = default if default in channels else only
        name = usual if variable is None else variable
        if name not in channels:
            raise InputError("variable", name, f"a channel of heights, of those: {list(channels)}", file)
        channel = channels[name]
        io.check_count(channel.nb_grid_pts, "heights", file)
        sized = channel.physical_sizes is not None
        scan = channel.topography() if sized else channel.topography(physical_sizes=channel.nb_grid_pts)
        if scan.unit is not None and unit is not None:
            raise InputError("unit", unit, f"none, the file states {scan.unit}", file)
        scale = io.unit_factor("heights", None, unit, file) if scan.unit is None else 1.0
        scan = scan if scan.unit is None else scan.to_unit("nm")
        heights = io.real_numbers(scan.heights().T, "heights", file, scale, dimensions or channel.dim)
        steps = tuple(float(step) * scale if sized else None for step in scan.pixel_size)
        return heights, steps[::-1]
