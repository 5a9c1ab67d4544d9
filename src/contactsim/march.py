"""Follow a load path, one `Result` a step, into a dataset.

A hard wall has one solution at each load whatever came before, so every step is solved from scratch and may be taken
from an earlier dataset if the same code made it from the same settings: a list of loads that grew equals, byte for
byte, the list solved at once. Beside the numbers a scene keeps what it is told to: the contact set, the pressure on
it, the Fourier coefficients of the heights, from which any other quantity follows; or heights, pressure and gap as
they are, to be drawn.
"""

from __future__ import annotations

import json
import logging
import os
import resource
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from threadpoolctl import threadpool_limits

from contactsim import dataset
from contactsim.branch import options, simulate_path
from contactsim.build import points_of, scene_of
from contactsim.errors import SceneError
from contactsim.grid import Array, Grid
from contactsim.loading import LoadStep
from contactsim.observables import KEPT, wall_observables
from contactsim.provenance import digest
from contactsim.roughness import rms_curvature, rms_gradient, rms_height
from contactsim.scene import Scene, pose
from contactsim.solvers import solver, usual
from contactsim.solvers.base import Result, Solver, require, sentence, solve
from contactsim.traits import Trait

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Point:
    """One solved load: numbers by name, arrays by name of what is kept, seconds it took."""

    numbers: dict[str, float | int]
    arrays: dict[str, Array]
    seconds: float


def simulate(
    scene: Scene,
    *,
    points: int | None = None,
    tolerance: float = 1e-3,
    method: str | Solver | None = None,
    threads: int = 1,
    keep: Sequence[str] | None = None,
    known: Mapping[int, Point] | None = None,
    **path: object,
) -> xr.Dataset:
    """Follow a scene's load path; the workflow's runs are this function.

    points: of the grid along x, None for those of a measured surface; tolerance: in grid steps; method: a solver or
    the name of one, None for the usual one; keep: of `KEPT`, None for all but the last; known: points that need not be
    solved again, by step.
    Smooth laws are followed along the path (see `simulate_path` for what else that takes), and tolerance is in parts of
    their strength.
    Returns one dataset with dimension `step`: numbers and what is kept; and `seconds`, the one variable that is not
    reproducible.
    """
    method = usual(scene) if method is None else solver(method) if isinstance(method, str) else method
    require(method, scene)
    _refuse_unused(Trait.SMOOTH in scene.traits, {"keep": keep, "known": known or None} | path)
    points = points or scene.upper.surface.points
    if Trait.SMOOTH in scene.traits:
        with threadpool_limits(threads, "blas"):  # on small dense systems more threads would only wait for each other
            return simulate_path(scene, method, points=points, tolerance=tolerance, threads=threads, **path)
    keep, heights = KEPT[:-1] if keep is None else keep, scene.heights(points)

    def solved(step: LoadStep) -> Point:
        """One load on its own."""
        return _point(solve(method, *pose(scene, step, heights, tolerance, threads)), heights, scene.lengths, keep)

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
            *(count + 1, len(steps), step.text, point.numbers["non_uniformity"]),
            *(point.numbers["transforms"], point.seconds, left, sentence(point.numbers["status"])),
        )
    return found


def _refuse_unused(smooth: bool, given: Mapping[str, object]) -> None:
    """SceneError for an option that is unknown or that such a scene has no use for, and for an unknown name to keep."""
    kinds = ("keep", "known"), ("increments", "snapshots", "keep_fields")
    used = ", ".join(("points", "tolerance", "method", "threads", *kinds[smooth]))
    for key, value in given.items():
        if value is not None and key in kinds[not smooth]:
            raise SceneError(key, value, f"none with {'smooth laws' if smooth else 'a hard wall'}, only {used}")
        if key not in kinds[0] + kinds[1]:
            raise SceneError(key, value, f"no such option, but {used}")
    for name in given["keep"] or ():
        if name not in KEPT:
            raise SceneError("keep", name, f"some of {', '.join(KEPT)}")


def run(settings: dict, source: str, target: str | Path, costs: str | Path, threads: int = 1) -> None:
    """Compute a run's dataset and costs, taking over what an earlier dataset of that name already holds.

    settings: of a `contactsim.study.Run`; source: digest of the code that computes it.
    """
    begin = time.process_time()
    scene = scene_of(settings)
    names = [digest(_alone(settings), place, source) for place in _places(settings)]
    earlier = {} if "increments" in settings else _earlier(target, costs)
    data = simulate(
        scene,
        points=points_of(settings, scene.upper.surface),
        tolerance=settings["tolerance"],
        method=solver(**settings["solver"]),
        threads=threads,
        known={step: earlier[name] for step, name in enumerate(names) if name in earlier},
        **chosen(settings),
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


def _places(settings: dict) -> list:
    """Where a run's steps stand along its load; those of a path by their number, as it may come to a value twice."""
    load = settings["load"]
    return load["values"] if "values" in load else list(range(len(scene_of(settings).path.steps)))


def _alone(settings: dict) -> dict:
    """Settings of one point: loads solved on their own do not depend on the others, a path does."""
    return settings | {"load": settings["load"]["name"]} if "values" in settings["load"] else settings


def chosen(settings: dict) -> dict:
    """What a run's simulation is asked for, beside its grid and tolerance: fields to keep, or how a path is walked."""
    return options(settings) if "increments" in settings else {"keep": settings["keep"]}


def peak_memory() -> float:
    """Largest resident memory of this process so far (MiB)."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)


def labelled(data: xr.Dataset, settings: dict, names: list[str]) -> xr.Dataset:
    """A simulation as a run stores it: steps by the study's own load, the name of each point, no times."""
    load, values = settings["load"]["name"], _places(settings)
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


def _point(result: Result, heights: Array, lengths: tuple[float, ...], keep: Sequence[str]) -> Point:
    certificate = result.record.certificate
    contact = result.contact
    spacing = Grid(heights.shape, lengths).spacing
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
    return dataset.described(xr.Dataset(variables))


def _earlier(target: str | Path, costs: str | Path) -> dict[str, Point]:
    """Points of an earlier dataset by the digest that made them; none if there is none or it cannot be read."""
    if not Path(target).exists():
        return {}
    try:
        data = dataset.read(target)
        ends = np.cumsum(data.contact_points.values)
        load = data.status.dims[0]
        seconds = json.loads(Path(costs).read_text())["seconds"] if Path(costs).exists() else {}
        apart = set(data.dims) - {"mean_pressure"} | {"point"}
        names = [name for name, item in data.variables.items() if item.dims == data.status.dims and name not in apart]
        found = {}
        for row, end in enumerate(ends):
            numbers = {name: data[name].values[row].item() for name in names}
            name = str(data.point.values[row])
            arrays = {
                str(key): item.values[row]
                for key, item in data.variables.items()
                if item.ndim > 1 and item.dims[0] == load
            }
            if "contact_pressure" in data:
                arrays["contact_pressure"] = data.contact_pressure.values[end - data.contact_points.values[row] : end]
            found[name] = Point(numbers, arrays, seconds.get(name, float("nan")))
        return found
    except (SceneError, AttributeError, KeyError, TypeError, ValueError) as error:
        logger.warning("%s cannot be reused and is computed anew: %s", target, error)
        return {}
