"""The command `contactsim press`: from a file of measured heights to numbers with errors, and a figure."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.characterisation import characterise
from contactsim.code_digest import source_digest
from contactsim.commands import DRAWN
from contactsim.errors import InputError
from contactsim.evaluation.estimate import align_right
from contactsim.files import prepare_target
from contactsim.status import Status, describe_excess, is_solved
from contactsim.surfaces.preparation import USUAL_DETREND, prepare_topography
from contactsim.surfaces.scan_files import read_topography
from contactsim.surfaces.topography import Topography

COLUMNS = {
    "relative_contact_area_subgrid": ("area", ""),
    "contact_stiffness": ("stiffness", "GPa/nm"),
    "contact_conductance": ("conductance", "W/(m K nm)"),
    "mean_gap": ("mean gap", "nm"),
    "max_pressure": ("largest pressure", "GPa"),
    "yielding_share": ("yielding", "of the contact"),
}
"""Numbers that are printed of heights that were pressed: their heads and units."""
MANY_SPIKES = 0.01
"""Share of the points above which they are hardly spikes."""
FEW_POINTS = 10
"""Points in contact below which their spacing decides every number."""
UNEQUAL = 1e-3
"""Relative difference of the spacings along y and x from which on it is told."""
PLAIN_EXPONENTS = range(-3, 5)
"""Powers of ten of numbers that are written without them."""


def press_file(options: argparse.Namespace) -> None:
    """Press a file of measured heights; print the numbers with their errors, draw and write them if asked to."""
    if options.figure and Path(options.figure).suffix not in DRAWN:
        raise InputError("--figure", options.figure, f"a name ending in one of {', '.join(DRAWN)}")
    if options.output and Path(options.output).suffix != ".nc":
        raise InputError("--output", options.output, "a name ending in .nc")
    try:
        _press_file(options)
    except InputError as error:
        raise _in_options(error, options) from error


def _in_options(error: InputError, options: argparse.Namespace) -> InputError:
    """Return an error with the names that arguments of functions have as options."""
    names = {"mean_pressures": "mean_pressure"} | {name: name for name in vars(options)}
    key = f"--{names[error.key].replace('_', '-')}" if error.key in names else error.key
    allowed = re.sub(r"`(\w+)`", lambda name: f"--{name[1].replace('_', '-')}", error.allowed)
    return InputError(key, error.value, allowed, error.file)


def _press_file(options: argparse.Namespace) -> None:
    """Press a file as checked options say."""
    heights = _read_heights(options.file, options, options.unit)
    if options.other is None and options.other_unit is not None:
        raise InputError("other_unit", options.other_unit, "none without --other")
    other = None if options.other is None else _mirror(_read_other(options))
    for option in ("figure", "output"):
        if getattr(options, option):
            prepare_target(getattr(options, option), f"--{option}")
    try:
        data = characterise(
            heights,
            other,
            contact_modulus=options.contact_modulus,
            mean_pressures=options.mean_pressure,
            offset=_one_or_pair(options.offset),
            hardness=options.hardness,
            conductivities=options.conductivities,
            periodic=options.periodic or None,
            thickness=options.thickness,
            poisson_ratio=options.poisson_ratio,
        )
    except InputError as error:
        renamed = error.renamed("other", f"--other {options.other}").renamed("topography", Path(options.file).name)
        raise renamed from error
    described = _describe_heights([heights, other], data), _describe_pressing(heights, options)
    sys.stdout.write("\n".join([*described, *_doubts(heights, data), _press_table(data)]) + "\n")
    if options.output:
        title, source = f"Contact of {_files_text(options)}", source_digest("contactsim.characterisation")
        settings = {key: value for key, value in vars(options).items() if key not in ("module", "command")}
        dataset.write(dataset.stamp(data, title, settings, source), options.output)
        sys.stdout.write(f"written to {options.output}\n")
    if options.figure:
        from contactsim.figures.characterisation import plot_characterisation

        plot_characterisation(data, title=_files_text(options)).savefig(options.figure)
        sys.stdout.write(f"drawn in {options.figure}\n")
    failed = int((~is_solved(data.status)).sum())
    if failed:
        sys.exit(f"Error: {failed} of {data.status.size} loads did not converge")


def _files_text(options: argparse.Namespace) -> str:
    """Return the names of the files of heights, and that of the channel that is read."""
    files = " and ".join(Path(file).name for file in (options.file, options.other) if file is not None)
    return files if options.variable is None else f"{files}, {options.variable}"


def _read_heights(file: str, options: argparse.Namespace, unit: str | None) -> Topography:
    """Return the heights of a file, prepared as the options say."""
    raw = read_topography(
        file,
        spacing=_one_or_pair(options.spacing),
        unit=unit,
        variable=options.variable,
        delimiter=options.delimiter,
        fill=options.fill,
    )
    return prepare_topography(raw, options.detrend, options.ends, options.level, options.spikes)


def _read_other(options: argparse.Namespace) -> Topography:
    """Return the heights of the other file, whose unit is that of the first one unless it is given."""
    if options.other_unit is None:
        return _read_heights(options.other, options, options.unit)
    try:
        return _read_heights(options.other, options, options.other_unit)
    except InputError as error:
        raise error.renamed("unit", "other_unit") from error


def _one_or_pair(values: list[Any] | None) -> Any:
    """Return the only value of a list, several as a tuple, and None for none."""
    return values[0] if values and len(values) == 1 else values and tuple(values)


def _mirror(heights: Topography) -> Topography:
    """Return heights mirrored along x: those of a body that is turned over."""
    return replace(heights, values=heights.values[..., ::-1])


def _describe_heights(scans: Sequence[Topography | None], data: xr.Dataset) -> str:
    """Return size, roughness and repairs of the heights of one body or two in words."""
    bodies = [heights for heights in scans if heights is not None]
    text = "; ".join(_describe_scan(heights) for heights in bodies)
    size = " × ".join(f"{float(data[name]):.4g}" for name in ("length_y", "length") if name in data)
    text += f"; they face each other on {size} nm, over which pressures are means:" if len(bodies) > 1 else ";"
    text += f" rms height {_with_error(data, 'rms_height')} nm, rms gradient {_with_error(data, 'rms_gradient')}"
    return "\n".join(
        [text, *(f"Beyond what the model holds for: {words} of the loads" for words in describe_excess(data))]
    )


def _describe_scan(heights: Topography) -> str:
    """Return points, size and repairs of heights in words."""
    size = " × ".join(f"{length:.4g}" for length in heights.lengths)
    text = f"{' × '.join(map(str, heights.values.shape))} points on {size} nm"
    if max(heights.spacing) > (1 + UNEQUAL) * min(heights.spacing):
        text += f", {' × '.join(f'{step:.4g}' for step in heights.spacing)} nm apart"
    repairs = {"filled": heights.filled, "replaced as spikes": heights.spikes}
    return text + "".join(f", {share:.2%} of the points {what}" for what, share in repairs.items() if share)


def _describe_pressing(heights: Topography, options: argparse.Namespace) -> str:
    """Return how heights are pressed, in words."""
    repeats = heights.periodic or options.periodic or options.thickness is not None
    body = "a half-space" if options.thickness is None else f"a layer of {options.thickness:g} nm on a rigid base"
    ends = f"on {body}, repeated without end" if repeats else f"alone on {body}, not repeated"
    detrend = options.detrend or USUAL_DETREND[heights.values.ndim]
    removed = "" if detrend == "none" else f", {detrend} subtracted"
    return f"E* {options.contact_modulus:g} GPa{removed}, pressed {ends}"


def _doubts(heights: Topography, data: xr.Dataset) -> list[str]:
    """Return in words what is probably not meant: many spikes, a contact of few points, too large a pressure."""
    doubts = []
    if heights.spikes > MANY_SPIKES:
        doubts.append(f"{heights.spikes:.2%} of the points are no spikes: a larger threshold may be meant")
    lengths = [float(data[name]) for name in ("length_y", "length") if name in data]  # where two scans face each other
    size = np.prod([length / step for length, step in zip(lengths, heights.spacing, strict=True)])
    points = data.relative_contact_area_subgrid.values * size
    few = data.mean_pressure.values[points < FEW_POINTS]
    if few.size:
        doubts.append(f"fewer than {FEW_POINTS} points in contact up to {few.max():g} GPa: their spacing decides all")
    ratio = data.max_pressure / data.contact_modulus
    strained = ratio[ratio > 1].sortby("mean_pressure")
    if strained.size:
        words = f"a largest pressure of {float(strained[0]):.3g} E* at {float(strained.mean_pressure[0]):g} GPa"
        doubts.append(f"{words}: strains are not small; pressures and E* are in GPa")
    if np.isinf(data.mean_gap_grid_error.values[is_solved(data.status).values]).any():
        doubts.append("± inf: not known, as this load has no solution on fewer points")
    closed = data.mean_pressure[data.relative_contact_area_subgrid.values >= 1]
    if closed.size:
        first = float(closed.min())
        words = f"contact everywhere at {first:g} GPa and more, which is {first / float(data.contact_modulus):.3g} E*"
        doubts.append(f"{words}: pressures are in GPa")
    return doubts


def _press_table(data: xr.Dataset) -> str:
    """Return a line for each load: its numbers, each with its error."""
    columns = {name: words for name, words in COLUMNS.items() if name in data}
    heads, units = (list(column) for column in zip(("pressure", "GPa"), *columns.values(), strict=True))
    heads, units = [*heads, "patches", "status"], [*units, "", ""]
    words = {status.value[0]: status.name.lower() for status in Status}
    rows = [
        [
            f"{float(load.mean_pressure):.4g}",
            *(_with_error(load, name) for name in columns),
            f"{float(load.patches):.0f}",
            words[int(load.status)],
        ]
        for load in (data.isel(mean_pressure=count) for count in range(data.mean_pressure.size))
    ]
    widths = [max(map(len, column)) for column in zip(heads, units, *rows, strict=True)]
    lines = [align_right(row, widths).rstrip() for row in (heads, units, *rows)]
    return "\n".join([*lines, "±: estimated from one point in four, in two, and all; not a bound"])


def _with_error(data: xr.Dataset, name: str) -> str:
    """Return a number and its error as text."""
    value, error = float(data[name]), float(data[f"{name}_grid_error"])
    if np.isinf(value):
        return f"{value:g}"
    if not (np.isfinite(value) and 0 < error < np.inf):
        return f"{value:.4g} ± {error:.2g}"
    digits = max(int(np.floor(np.log10(abs(value) or error))) - int(np.floor(np.log10(error))) + 1, 0)
    mantissa, _, exponent = f"{value:.{digits}e}".partition("e")
    if -4 < int(exponent) < 5:
        decimals = max(digits - int(exponent), 0)
        return f"{value:.{decimals}f} ± {error:.{decimals}f}"
    return f"({mantissa} ± {error / 10.0 ** int(exponent):.{digits}f})e{int(exponent)}"
