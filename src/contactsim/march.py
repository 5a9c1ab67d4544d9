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
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.errors import SceneError
from contactsim.grid import Array, Grid
from contactsim.observables import wall_observables
from contactsim.provenance import digest
from contactsim.roughness import rms_curvature, rms_gradient, rms_height
from contactsim.scene import Scene, pose
from contactsim.solvers import solver
from contactsim.solvers.base import Result, solve
from contactsim.study import points_of, scene_of

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Point:
    """One solved load: numbers by name, the contact set (packed bits) and the pressure on it; seconds it took."""

    numbers: dict[str, float | int | str]
    bits: Array
    pressure: Array
    seconds: float


def run(settings: dict, source: str, target: str | Path, costs: str | Path, threads: int = 1) -> None:
    """Compute a run's dataset and costs, taking over what an earlier dataset of that name already holds.

    settings: of a `contactsim.study.Run`; source: digest of the code that computes it.
    """
    begin = time.process_time()
    scene = scene_of(settings)
    values = settings["load"]["values"]
    apart = settings | {"load": settings["load"]["name"]}
    names = [digest(apart, value, source) for value in values]
    known = _earlier(target, costs)
    heights = scene.heights(points_of(settings, scene.upper.surface))
    method = solver(**settings["solver"])
    points, spent, solved = [], 0.0, 0
    for count, (name, value, step) in enumerate(zip(names, values, scene.path.steps, strict=True), 1):
        if name in known:
            points.append(known[name])
            logger.info("step %d/%d %s=%g taken over", count, len(values), settings["load"]["name"], value)
            continue
        result = solve(method, *pose(scene, step, heights, settings["tolerance"], threads))
        points.append(_point(name, result, heights, scene.length / heights.size))
        spent, solved = spent + result.seconds, solved + 1
        left = spent / solved * sum(name not in known for name in names[count:])
        logger.info(
            "step %d/%d %s=%g residual %.1e transforms %.0f %.2f s, %.0f s left: %s",
            *(count, len(values), settings["load"]["name"], value, points[-1].numbers["non_uniformity"]),
            *(result.record.transforms, result.seconds, left, result.status.sentence),
        )
    data = _collected(settings, scene, heights, values, points)
    dataset.write(dataset.stamped(data, f"contactsim run of {settings['study']}", settings, source), target)
    price = {
        "seconds": {name: point.seconds for name, point in zip(names, points, strict=True)},
        "cpu_seconds_of_last_run": time.process_time() - begin,
    }
    write_text(json.dumps(price, indent=1), costs)


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


def _point(name: str, result: Result, heights: Array, spacing: float) -> Point:
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
        "point": name,
    }
    return Point(numbers, np.packbits(contact), result.pressure[contact].astype(np.float32), result.seconds)


def _collected(settings: dict, scene: Scene, heights: Array, values: list[float], points: list[Point]) -> xr.Dataset:
    load, spacing = settings["load"]["name"], scene.length / heights.size
    kinds = {"status": np.int8, "iterations": np.int32, "contact_points": np.int32, "point": object}
    variables = {
        name: (load, np.array([point.numbers[name] for point in points], kinds.get(name, float)))
        for name in points[0].numbers
        if name != load
    }
    half = Grid((heights.size,), (scene.length,)).forward(heights)
    half = half[: getattr(scene.upper.surface, "modes", half.size) + 1]
    variables |= {
        "rms_height": rms_height(heights),
        "rms_gradient": rms_gradient(heights, spacing),
        "rms_curvature": rms_curvature(heights, spacing),
        "approach_first_touch": -float(heights.max()),
        "seed": settings["seed"],
        "contact_bits": ((load, "byte"), np.stack([point.bits for point in points])),
        "contact_pressure": ("contact_point", np.concatenate([point.pressure for point in points])),
        "profile_real": ("mode", half.real.copy()),
        "profile_imag": ("mode", half.imag.copy()),
        "points": heights.size,
        "length": scene.length,
        "contact_modulus": scene.contact_modulus,
    }
    return dataset.described(xr.Dataset(variables, {load: values}))


def _earlier(target: str | Path, costs: str | Path) -> dict[str, Point]:
    """Points of an earlier dataset by the digest that made them; none if there is none or it cannot be read."""
    if not Path(target).exists():
        return {}
    try:
        data = dataset.read(target)
        ends = np.cumsum(data.contact_points.values)
        seconds = json.loads(Path(costs).read_text())["seconds"] if Path(costs).exists() else {}
        names = [
            name for name, item in data.variables.items() if item.dims == data.status.dims and name not in data.dims
        ]
        found = {}
        for row, end in enumerate(ends):
            numbers = {name: data[name].values[row].item() for name in names if name != "point"}
            name = str(data.point.values[row])
            pressure = data.contact_pressure.values[end - data.contact_points.values[row] : end]
            bits = data.contact_bits.values[row]
            found[name] = Point(numbers | {"point": name}, bits, pressure, seconds.get(name, float("nan")))
        return found
    except (SceneError, AttributeError, KeyError, TypeError, ValueError) as error:
        logger.warning("%s cannot be reused and is computed anew: %s", target, error)
        return {}
