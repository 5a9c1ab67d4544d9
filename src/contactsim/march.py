"""Follow a load path, one `Result` a step, into a dataset.

A hard wall has one solution at each load whatever came before, so every step is solved from scratch and may be taken
from an earlier dataset if the same code made it from the same settings: a list of loads that grew equals, byte for
byte, the list solved at once. The contact set and the pressure on it are kept beside the numbers, with the profile's
Fourier coefficients, so that any other quantity follows from the file alone.
"""

from __future__ import annotations

import json
import logging
import os
import resource
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.build import points_of, scene_of
from contactsim.errors import SceneError
from contactsim.grid import Array, Grid
from contactsim.observables import wall_observables
from contactsim.provenance import digest
from contactsim.roughness import rms_curvature, rms_gradient, rms_height
from contactsim.scene import Scene, pose
from contactsim.solvers import solver
from contactsim.solvers.base import Result, Solver, require, solve

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Point:
    """One solved load: numbers by name, the contact set (packed bits) and the pressure on it; seconds it took."""

    numbers: dict[str, float | int]
    bits: Array
    pressure: Array
    seconds: float


def simulate(
    scene: Scene,
    *,
    points: int | None = None,
    tolerance: float = 1e-3,
    method: str | Solver = "active_set",
    threads: int = 1,
    known: Mapping[int, Point] | None = None,
) -> xr.Dataset:
    """Follow a scene's load path; the workflow's runs are this function.

    points: of the grid, None for those of a measured surface; tolerance: in grid steps; method: name of a solver or a
    solver; known: points that need not be solved again, by step. Returns one dataset with dimension `step`: numbers,
    contact sets, pressures on them, the profile's Fourier coefficients; and `seconds`, the one variable that is not
    reproducible.
    """
    known = known or {}
    heights = scene.heights(points or scene.upper.surface.points)
    method = solver(method) if isinstance(method, str) else method
    require(method, scene)
    steps, found, spent = scene.path.steps, [], []
    for count, step in enumerate(steps):
        if count in known:
            found.append(known[count])
            logger.info("step %d/%d %s taken over", count + 1, len(steps), step.text)
            continue
        result = solve(method, *pose(scene, step, heights, tolerance, threads))
        found.append(_point(result, heights, scene.length / heights.size))
        spent.append(result.seconds)
        left = np.mean(spent) * sum(later not in known for later in range(count + 1, len(steps)))
        logger.info(
            "step %d/%d %s residual %.1e transforms %.0f %.2f s, %.0f s left: %s",
            *(count + 1, len(steps), step.text, found[-1].numbers["non_uniformity"]),
            *(result.record.transforms, result.seconds, left, result.status.sentence),
        )
    return _collected(scene, heights, found)


def run(settings: dict, source: str, target: str | Path, costs: str | Path, threads: int = 1) -> None:
    """Compute a run's dataset and costs, taking over what an earlier dataset of that name already holds.

    settings: of a `contactsim.study.Run`; source: digest of the code that computes it.
    """
    begin = time.process_time()
    scene = scene_of(settings)
    load, values = settings["load"]["name"], settings["load"]["values"]
    names = [digest(settings | {"load": load}, value, source) for value in values]
    earlier = _earlier(target, costs)
    data = simulate(
        scene,
        points=points_of(settings, scene.upper.surface),
        tolerance=settings["tolerance"],
        method=solver(**settings["solver"]),
        threads=threads,
        known={step: earlier[name] for step, name in enumerate(names) if name in earlier},
    )
    seconds = data.seconds.values.tolist()
    title = f"contactsim run of {settings['study']}"
    dataset.write(dataset.stamped(labelled(data, settings, names), title, settings, source), target)
    price = {
        "seconds": dict(zip(names, seconds, strict=True)),
        "cpu_seconds_of_last_run": time.process_time() - begin,
        "peak_memory_of_last_run": peak_memory(),
    }
    write_text(json.dumps(price, indent=1), costs)


def peak_memory() -> float:
    """Largest resident memory of this process so far (MiB)."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)


def labelled(data: xr.Dataset, settings: dict, names: list[str]) -> xr.Dataset:
    """A simulation as a run stores it: steps by the study's own load, the name of each point, no times."""
    load, values = settings["load"]["name"], settings["load"]["values"]
    data = data.drop_vars(["seconds", load], errors="ignore").rename(step=load).assign_coords({load: values})
    return dataset.described(data.assign(seed=settings["seed"], point=(load, np.array(names, object))))


def write_text(text: str, path: str | Path) -> None:
    """Write a small text file in one move."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        temporary.write_text(text, encoding="utf-8")
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def _point(result: Result, heights: Array, spacing: float) -> Point:
    certificate = result.record.certificate
    contact = result.contact
    numbers = wall_observables(heights, spacing, result.pressure, result.gap) | {
        "approach_found": result.approach,
        "iterations": result.record.iterations,
        "transforms": result.record.transforms,
        "non_uniformity": certificate.non_uniformity,
        "penetration": certificate.penetration,
        "smallest_pressure": float(result.pressure.min()),
        "load_error": certificate.load_error,
        "status": result.status.value[0],
        "contact_points": int(contact.sum()),
    }
    return Point(numbers, np.packbits(contact), result.pressure[contact], result.seconds)


def _collected(scene: Scene, heights: Array, found: list[Point]) -> xr.Dataset:
    spacing = scene.length / heights.size
    kinds = {"status": np.int8, "iterations": np.int32, "contact_points": np.int32}
    variables = {
        name: ("step", np.array([point.numbers[name] for point in found], kinds.get(name, float)))
        for name in found[0].numbers
    }
    half = Grid((heights.size,), (scene.length,)).forward(heights)
    half = half[: getattr(scene.upper.surface, "modes", half.size) + 1]
    variables |= {
        "seconds": ("step", [point.seconds for point in found]),
        "rms_height": rms_height(heights),
        "rms_gradient": rms_gradient(heights, spacing),
        "rms_curvature": rms_curvature(heights, spacing),
        "approach_first_touch": -float(heights.max()),
        "contact_bits": (("step", "byte"), np.stack([point.bits for point in found])),
        "contact_pressure": ("contact_point", np.concatenate([point.pressure for point in found])),
        "profile_real": ("mode", half.real.copy()),
        "profile_imag": ("mode", half.imag.copy()),
        "points": heights.size,
        "length": scene.length,
        "contact_modulus": scene.contact_modulus,
    }
    return dataset.described(xr.Dataset(variables))


def _earlier(target: str | Path, costs: str | Path) -> dict[str, Point]:
    """Points of an earlier dataset by the digest that made them; none if there is none or it cannot be read."""
    if not Path(target).exists():
        return {}
    try:
        data = dataset.read(target)
        ends = np.cumsum(data.contact_points.values)
        seconds = json.loads(Path(costs).read_text())["seconds"] if Path(costs).exists() else {}
        apart = set(data.dims) - {"mean_pressure"} | {"point"}
        names = [name for name, item in data.variables.items() if item.dims == data.status.dims and name not in apart]
        found = {}
        for row, end in enumerate(ends):
            numbers = {name: data[name].values[row].item() for name in names}
            name = str(data.point.values[row])
            pressure = data.contact_pressure.values[end - data.contact_points.values[row] : end]
            bits = data.contact_bits.values[row]
            found[name] = Point(numbers, bits, pressure, seconds.get(name, float("nan")))
        return found
    except (SceneError, AttributeError, KeyError, TypeError, ValueError) as error:
        logger.warning("%s cannot be reused and is computed anew: %s", target, error)
        return {}
