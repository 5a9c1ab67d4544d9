"""Result datasets: dimensions, units, attributes, provenance; the only reader and writer of netCDF.

Everything written is reproducible bit for bit at one number of threads, so times and memory are kept elsewhere. A file
appears under its name only when it is complete.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from contactsim.arguments import FileName, checked
from contactsim.errors import InputError
from contactsim.files import write_atomically
from contactsim.provenance import canonical, versions
from contactsim.status import FLAGS, Status
from contactsim.variables import base_name, find_variable

ALONG_LOAD = {"snapshot", "increment"}
"""Variables in nm along approaches and slides, in GPa where the mean pressure is prescribed."""


def describe(data: xr.Dataset) -> xr.Dataset:
    """Add units and long_name to every variable of a dataset, and return it.

    A variable that aggregation derived inherits those of the one that it comes from.
    """
    for name in data.variables:
        base, suffix = base_name(str(name))
        variable = find_variable(base)
        data[name].attrs.update(units=variable.unit, long_name=f"{variable.long_name}{suffix}")
    if "control" in data and "sliding_distance" not in data and bool((data["control"] == "mean_pressure").all()):
        for name in ALONG_LOAD & set(data.variables):
            data[name].attrs["units"] = "GPa"
    if "status" in data:
        values = [status.value[0] for status in Status]
        meanings = " ".join(status.name.lower() for status in Status)
        data["status"].attrs.update(flag_values=np.array(values, np.int8), flag_meanings=meanings)
    if "validity_flags" in data:
        masks = np.array(list(FLAGS.values()), np.int8)
        data["validity_flags"].attrs.update(flag_masks=masks, flag_meanings=" ".join(FLAGS))
    return data


def stamp(data: xr.Dataset, title: str, settings: object, source: str) -> xr.Dataset:
    """Add the provenance to a dataset, and return it: title, settings as JSON, digest of the source, versions."""
    data.attrs |= {
        "title": title,
        "settings": canonical(settings),
        "source_digest": source,
        "versions": canonical(versions()),
        "Conventions": "CF-1.11",
    }
    return data


def write(data: xr.Dataset, path: str | Path) -> None:
    """Write a dataset, large arrays compressed, in one move: a reader sees the old file or the new one."""
    encoding: dict[str, dict[str, object]] = {}
    for name, item in data.variables.items():
        if item.dtype.kind in "fiu":
            encoding[str(name)] = {"_FillValue": None, "fletcher32": item.ndim > 0}  # checksums: damage is an error
            if item.nbytes > 1 << 14:
                encoding[str(name)] |= {"zlib": True, "complevel": 1}
    write_atomically(path, lambda file: data.to_netcdf(file, engine="netcdf4", format="NETCDF4", encoding=encoding))


@checked
def load_dataset(path: FileName) -> xr.Dataset:
    """Read a dataset into memory and close the file."""
    try:
        return xr.load_dataset(path, engine="netcdf4")
    except (OSError, RuntimeError, ValueError) as error:
        raise InputError("dataset", Path(path), f"a readable netCDF file ({error})") from error


def settings_of(data: xr.Dataset) -> dict[str, Any]:
    """Return the settings stored with a dataset."""
    return json.loads(data.attrs["settings"])
