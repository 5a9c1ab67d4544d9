"""The numbers of one load at a hard wall, and the arrays that are kept of it."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from typing import cast

import numpy as np

from contactsim.contact.scene import Scene
from contactsim.grid import Array, Grid
from contactsim.interface.hard_wall import HardWall
from contactsim.observables.contact import yielding_share
from contactsim.observables.distributions import GAP_BINS, PRESSURE_BINS, distributions
from contactsim.observables.hard_wall import wall_observables
from contactsim.observables.patches import AREA_BINS, find_patches
from contactsim.paths.contact_stiffness import contact_stiffness
from contactsim.paths.reuse import Point
from contactsim.solvers.base import Result
from contactsim.status import validity_flags
from contactsim.surfaces.height_statistics import STATISTICS
from contactsim.surfaces.open_statistics import squared_gradient_open
from contactsim.surfaces.spectral_moments import nayak_parameter
from contactsim.surfaces.squared_gradient import squared_gradient_blocks
from contactsim.surfaces.statistics import rms_height

ARRAY_DIMENSIONS = {
    "contact_bits": ("step", "byte"),
    "contact_pressure": ("contact_point",),
    "pressure_density": ("step", "pressure_bin"),
    "gap_density": ("step", "gap_bin"),
    "patches_by_area": ("step", "area_bin"),
}
"""Dimensions of arrays that are no fields."""
BIN_CENTRES = {
    "distributions": {"pressure_bin": PRESSURE_BINS.centres, "gap_bin": GAP_BINS.centres},
    "patches": {"area_bin": AREA_BINS},
}
"""Coordinates of distributions, by what is kept."""


def height_numbers(scene: Scene, heights: Array, keep: Sequence[str]) -> dict[str, float]:
    """Return the statistics of heights, (n,) or (ny, nx), that a run keeps."""
    spacing, statistics = Grid(heights.shape, scene.lengths).spacing, STATISTICS[scene.repeats]
    numbers = {
        "rms_height": rms_height(heights),
        "rms_gradient": statistics.rms_gradient(heights, spacing),
        "rms_curvature": statistics.rms_curvature(heights, spacing),
    }
    if "distributions" in keep:
        numbers["nayak_parameter"] = nayak_parameter(heights, spacing, scene.repeats)
    return numbers


def read_point(result: Result, heights: Array, roughness: Mapping[str, float], keep: Sequence[str]) -> Point:
    """Return the numbers of a solution and the arrays that are kept of it.

    Parameters
    ----------
    result
        The solution, with its scene.
    heights
        Sum of both surfaces' heights (n,) or (ny, nx), nm.
    roughness
        Of `height_numbers`.
    keep
        Some of `contactsim.observables.contact.KEPT`.
    """
    scene, contact, seconds = cast(Scene, result.scene), result.contact, result.seconds
    numbers = _read_numbers(scene, result, heights) | _read_validity(scene, result, roughness)
    if "stiffness" in keep:
        begin = time.process_time()
        numbers["contact_stiffness"] = contact_stiffness(result) if result.status.solved else np.nan
        seconds += time.process_time() - begin
    arrays = {}
    if "patches" in keep:
        patches = find_patches(contact, scene.repeats)
        numbers |= patches.numbers
        arrays["patches_by_area"] = patches.counts_by_area
    if "contact" in keep:
        arrays["contact_bits"] = np.packbits(contact)
    if "pressure" in keep:
        arrays["contact_pressure"] = result.pressure[contact]
    if "fields" in keep:
        arrays |= {"pressure": result.pressure, "gap": result.gap}
    if "distributions" in keep:
        unit = scene.contact_modulus * roughness["rms_gradient"]
        arrays |= distributions(result.pressure, result.gap, unit, roughness["rms_height"])
    return Point(numbers, arrays, seconds)


def _read_numbers(scene: Scene, result: Result, heights: Array) -> dict[str, float]:
    """Return the numbers that every solution has."""
    certificate = result.record.certificate
    spacing, slopes = Grid(heights.shape, scene.lengths).spacing, _squared_gradient(scene, heights)
    return wall_observables(heights, slopes, spacing, result.pressure, result.gap, scene.repeats) | {
        "approach": result.approach,
        "iterations": result.record.iterations,
        "transforms": result.record.transforms,
        "max_contact_gap": certificate.max_contact_gap,
        "penetration": certificate.penetration,
        "min_pressure": float(result.pressure.min()),
        "load_error": certificate.load_error,
        "status": result.status.value[0],
        "contact_points": int(result.contact.sum()),
    }


def _squared_gradient(scene: Scene, heights: Array) -> Iterable[tuple[slice, Array]]:
    """Return the squared gradient of heights, by blocks of rows."""
    if scene.repeats or scene.modes is not None:
        return squared_gradient_blocks(heights, scene.lengths, scene.modes)
    squares = squared_gradient_open(heights, Grid(heights.shape, scene.lengths).spacing)
    return [(slice(None), squares.reshape(-1, heights.shape[-1]))]


def _read_validity(scene: Scene, result: Result, roughness: Mapping[str, float]) -> dict[str, float]:
    """Return what of a state may lie beyond the model, and the bits of what does."""
    numbers = {}
    if scene.modes:
        numbers["wave_step"] = scene.modes / result.pressure.shape[-1]
    hardness = next((effect.hardness for effect in scene.effects if isinstance(effect, HardWall)), None)
    if hardness is not None:
        numbers["yielding_share"] = yielding_share(result.pressure, hardness)
    return numbers | {"validity_flags": validity_flags(numbers | {"rms_gradient": roughness["rms_gradient"]})}
