"""Loads on their own at a hard wall, as a dataset.

A hard wall has one solution at each load whatever came before, so every step is solved from scratch and may be taken
from an earlier dataset if the same code made it from the same settings: a list of loads that grew equals, byte for
byte, the list solved at once. Beside the numbers a scene keeps what it is told to: the contact set, the pressure on
it, the Fourier coefficients of the heights, from which any other quantity follows; or heights, pressure and gap as
they are, to be drawn.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.contact.hard_wall import WarmStart
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Scene
from contactsim.contact.steps import LoadStep
from contactsim.errors import InputError
from contactsim.grid import Array, Grid
from contactsim.observables.contact import KEPT, wall_observables
from contactsim.solvers.base import HardWallSolver, Result, solve
from contactsim.status import status_sentence
from contactsim.surfaces.statistics import rms_curvature, rms_gradient, rms_height

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Point:
    """One solved load: numbers by name, arrays by name of what is kept, seconds it took."""

    numbers: dict[str, float | int]
    arrays: dict[str, Array]
    seconds: float


def simulate_loads(
    scene: Scene,
    method: HardWallSolver,
    *,
    points: int,
    tolerance: float,
    threads: int = 1,
    keep: Sequence[str] = KEPT[:-1],
    known: Mapping[int, Point] | None = None,
    begun: xr.Dataset | None = None,
) -> xr.Dataset:
    """Press a scene at each of its loads and return one dataset with dimension `step`.

    tolerance: in grid steps; keep: of `KEPT`; known: points that need not be solved again, by step; begun: the same
    scene on a coarser grid with its `fields`, which a cascade of grids begins from.
    """
    for name in keep:
        if name not in KEPT:
            raise InputError("keep", name, f"some of {', '.join(KEPT)}")
    heights = scene.heights(points)

    def solved(step: LoadStep) -> Point:
        """One load on its own."""
        problem, scale = pose_hard_wall(scene, step, heights, tolerance, threads)
        if begun is not None:
            coarse = begun.isel(step=scene.path.steps.index(step))
            problem.warm_start = WarmStart(coarse.pressure.values / scale.pressure, coarse.gap.values / scale.step)
        return _point(solve(method, problem, scale), heights, scene.lengths, keep)

    return _collected(scene, heights, _loads(scene.path.steps, known or {}, solved), keep)


def _loads(steps: Sequence[LoadStep], known: Mapping[int, Point], solved: Callable[[LoadStep], Point]) -> list[Point]:
    """The points of all loads, in order: known ones taken over, the others solved; a line of the log for each."""
    found, spent = [], []
    for count, step in enumerate(steps):
        if count in known:
            found.append(known[count])
            logger.info("step %d/%d %s taken over", count + 1, len(steps), step.text)
            continue
        point = solved(step)
        found.append(point)
        spent.append(point.seconds)
        left = np.mean(spent) * sum(later not in known for later in range(count + 1, len(steps)))
        logger.info(
            "step %d/%d %s residual %.1e transforms %.0f %.2f s, %.0f s left: %s",
            *(count + 1, len(steps), step.text, point.numbers["max_contact_gap"]),
            *(point.numbers["transforms"], point.seconds, left, status_sentence(point.numbers["status"])),
        )
    return found


def _point(result: Result, heights: Array, lengths: tuple[float, ...], keep: Sequence[str]) -> Point:
    certificate = result.record.certificate
    contact = result.contact
    spacing = Grid(heights.shape, lengths).spacing
    numbers = wall_observables(heights, spacing, result.pressure, result.gap) | {
        "approach": result.approach,
        "iterations": result.record.iterations,
        "transforms": result.record.transforms,
        "max_contact_gap": certificate.max_contact_gap,
        "penetration": certificate.penetration,
        "min_pressure": float(result.pressure.min()),
        "load_error": certificate.load_error,
        "status": result.status.value[0],
        "contact_points": int(contact.sum()),
    }
    arrays = {}
    if "contact" in keep:
        arrays["contact_bits"] = np.packbits(contact)
    if "pressure" in keep:
        arrays["contact_pressure"] = result.pressure[contact]
    if "fields" in keep:
        arrays |= {"pressure": result.pressure, "gap": result.gap}
    return Point(numbers, arrays, result.seconds)


DIMS = {"contact_bits": ("step", "byte"), "contact_pressure": ("contact_point",)}


def _collected(scene: Scene, heights: Array, found: list[Point], keep: Sequence[str]) -> xr.Dataset:
    grid = Grid(heights.shape, scene.lengths)
    kinds = {"status": np.int8, "iterations": np.int32, "contact_points": np.int32}
    variables = {
        name: ("step", np.array([point.numbers[name] for point in found], kinds.get(name, float)))
        for name in found[0].numbers
    }
    plane = ("y", "x")[-heights.ndim :]
    for name in found[0].arrays:
        arrays = [point.arrays[name] for point in found]
        joined = np.concatenate(arrays) if name == "contact_pressure" else np.stack(arrays)
        variables[name] = (DIMS.get(name, ("step", *plane)), joined)
    if "fields" in keep:
        variables["heights"] = (plane, heights)
    if "profile" in keep:
        half, modes = grid.forward(heights), scene.upper.surface.modes
        half = half if modes is None else half[grid.low_modes(modes)]
        across = ("mode_y", "mode")[-heights.ndim :]
        variables |= {"profile_real": (across, half.real.copy()), "profile_imag": (across, half.imag.copy())}
    variables |= {
        "seconds": ("step", [point.seconds for point in found]),
        "rms_height": rms_height(heights),
        "rms_gradient": rms_gradient(heights, grid.spacing),
        "rms_curvature": rms_curvature(heights, grid.spacing),
        "approach_first_touch": -float(heights.max()),
        "points": heights.shape[-1],
        "length": scene.length,
        "contact_modulus": scene.contact_modulus,
    }
    if heights.ndim == 2:
        variables |= {"points_y": heights.shape[0], "length_y": scene.lengths[0]}
    return dataset.described(xr.Dataset(variables, attrs={"problem": scene.kind.value}))


def earlier(target: str | Path, costs: str | Path) -> dict[str, Point]:
    """Points of an earlier dataset by the digest that made them; none if there is none or it cannot be read."""
    if not Path(target).exists():
        return {}
    try:
        data = dataset.load_dataset(target)
        ends = np.cumsum(data.contact_points.values)
        load = data.status.dims[0]
        seconds = json.loads(Path(costs).read_text())["seconds"] if Path(costs).exists() else {}
        apart = set(data.dims) - {"mean_pressure"} | {"point_digest"}
        names = [name for name, item in data.variables.items() if item.dims == data.status.dims and name not in apart]
        found = {}
        for row, end in enumerate(ends):
            numbers = {name: data[name].values[row].item() for name in names}
            name = str(data.point_digest.values[row])
            arrays = {
                str(key): item.values[row]
                for key, item in data.variables.items()
                if item.ndim > 1 and item.dims[0] == load
            }
            if "contact_pressure" in data:
                arrays["contact_pressure"] = data.contact_pressure.values[end - data.contact_points.values[row] : end]
            found[name] = Point(numbers, arrays, seconds.get(name, float("nan")))
        return found
    except (InputError, AttributeError, KeyError, TypeError, ValueError) as error:
        logger.warning("%s cannot be reused and is computed anew: %s", target, error)
        return {}
