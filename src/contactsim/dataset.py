"""Result datasets: dimensions, units, attributes, provenance; the only reader and writer of netCDF.

Everything written is reproducible bit for bit at one number of threads, so times and memory are kept elsewhere. A file
appears under its name only when it is complete.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from contactsim.errors import InputError
from contactsim.files import write_atomically
from contactsim.provenance import canonical, versions
from contactsim.status import FLAGS, Status
from contactsim.variables import SUFFIXES, VARIABLES

SETTINGS = {
    "hurst_exponent": ("1", "Hurst exponent"),
    "length": ("nm", "period"),
    "long_cutoff": ("nm", "long cut-off (roll-off) wavelength"),
    "short_cutoff": ("nm", "short cut-off wavelength of the roughness"),
    "rms_gradient": ("1", "rms gradient prescribed"),
    "rms_height": ("nm", "rms height prescribed"),
    "low_pass_cutoff": ("nm", "wavelength of the low-pass filter: shorter waves are left out"),
    "amplitudes": ("1", "distribution of the amplitudes"),
    "width": ("nm", "period along y"),
    "dimensions": ("1", "dimensions of the surface"),
    "radius": ("nm", "radius of the cylinder or sphere"),
    "amplitude": ("nm", "amplitude of the wave"),
    "periods": ("1", "number of waves in a period"),
    "increment": ("nm", "increment asked for"),
    "height": ("nm", "height of the plane"),
    "file": ("1", "file of a measured profile or surface"),
    "detrend": ("1", "how a measured profile or surface is detrended"),
    "periodic": ("1", "how a measured profile or surface is made periodic"),
    "spacing": ("nm", "spacing of a measured profile or surface"),
    "unit": ("1", "unit of a measured profile's or surface's file"),
    "variable": ("1", "variable of a measured profile's or surface's file"),
    "contact_modulus": ("GPa", "contact modulus E*"),
    "poisson_ratio": ("1", "Poisson's ratio"),
    "thickness": ("nm", "thickness"),
    "kind": ("1", "kind"),
    "youngs_modulus": ("GPa", "Young's modulus"),
    "work_of_separation": ("N/m", "normal work of separation"),
    "work_ratio": ("1", "tangential over normal work of separation"),
    "normal_length": ("nm", "normal characteristic length"),
    "tangential_length": ("nm", "tangential characteristic length"),
    "lattice_constant": ("nm", "lattice constant of the sites that springs join"),
    "tangential_cutoff": ("1", "tangential cutoff of the lattice, over the tangential characteristic length"),
    "normal_cutoff": ("1", "largest gap that springs bridge, over the normal characteristic length"),
    "weight": ("1", "weight of a spring"),
    "approach": ("nm", "approach at which surfaces slide"),
    "mean_pressure": ("GPa", "mean pressure under which surfaces slide"),
}
"""Unit and long name of the keys of a study that can be varied; a solver's options have unit 1."""


ALONG_LOAD = {"snapshot", "increment"}
"""Variables in nm along approaches and slides, in GPa where the mean pressure is prescribed."""


def described(data: xr.Dataset) -> xr.Dataset:
    """The dataset with units and long_name on every variable; a derived one inherits those of its base name."""
    for name in data.variables:
        base, kind = base_name(str(name))
        unit, text = (
            VARIABLES.get(base)
            or SETTINGS.get(re.sub("^(surface|body|counter_body|solver|increments|pairing|slide)_", "", base))
            or ("1", f"option {base}")
        )
        data[name].attrs.update(units=unit, long_name=f"{text}{kind}")
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


def dimension(key: str) -> str:
    """Name of the dimension along which a key of a study is varied: its last part, unless something else has it."""
    section, _, last = key.rpartition(".")
    own = last in VARIABLES or last == "kind" or section in ("counter_body", "increments")
    return f"{section}_{last}" if section and own else last


def base_name(name: str) -> tuple[str, str]:
    """A variable's name without what aggregation has added, and how that is put in words."""
    if name in VARIABLES:
        return name, ""
    for suffix, text in SUFFIXES.items():
        if name.endswith(suffix):
            return name.removesuffix(suffix), text
    return name, ""


def stamped(data: xr.Dataset, title: str, settings: object, source: str) -> xr.Dataset:
    """The dataset with its provenance: title, settings as JSON, digest of the source, versions."""
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


def load_dataset(path: str | Path) -> xr.Dataset:
    """Read a dataset into memory and close the file."""
    try:
        return xr.load_dataset(path, engine="netcdf4")
    except (OSError, RuntimeError, ValueError) as error:
        raise InputError("dataset", Path(path), f"a readable netCDF file ({error})") from error


def settings_of(data: xr.Dataset) -> dict[str, Any]:
    """The settings stored with a dataset."""
    return json.loads(data.attrs["settings"])
