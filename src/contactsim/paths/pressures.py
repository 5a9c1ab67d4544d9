"""Simulate loads on their own at a hard wall.

A hard wall has one solution at each load whatever came before, so every step is solved from scratch. It may be taken
from an earlier dataset if the same code made it from the same settings: a list of loads that grew equals, byte for
byte, the list solved at once. Beside the numbers a run keeps what it is asked to: the contact set, the pressure on it,
and the Fourier coefficients of the heights, from which any other quantity follows; heights, pressure and gap as they
are, to be drawn; distributions of pressure and gap, patches of contact, and the stiffness of the contact.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.contact.hard_wall import WarmStart
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Scene
from contactsim.contact.steps import LoadStep
from contactsim.errors import InputError
from contactsim.grid import Array, Grid
from contactsim.observables.contact import DEFAULT_KEPT, KEPT
from contactsim.paths.reuse import Point
from contactsim.paths.wall_numbers import ARRAY_DIMENSIONS, BIN_CENTRES, height_numbers, read_point
from contactsim.solvers.base import HardWallSolver, solve
from contactsim.status import status_summary

logger = logging.getLogger(__name__)


def simulate_loads(
    scene: Scene,
    method: HardWallSolver,
    *,
    points: int,
    tolerance: float,
    threads: int = 1,
    keep: Sequence[str] = DEFAULT_KEPT,
    solved_points: Mapping[int, Point] | None = None,
    coarse: xr.Dataset | None = None,
) -> xr.Dataset:
    """Press a scene at each of its loads.

    Parameters
    ----------
    scene : Scene
        Scene with a hard wall.
    method : HardWallSolver
        The solver.
    points : int
        Grid points along x.
    tolerance : float
        In grid steps.
    threads : int
        Threads of the transforms.
    keep : sequence of str
        Some of `KEPT`.
    solved_points : mapping, optional
        Points that need not be solved again, by step.
    coarse : xarray.Dataset, optional
        The same scene on a coarser grid with its `fields`, from which a cascade of grids begins.

    Returns
    -------
    xarray.Dataset
        One dataset with dimension `step`.
    """
    for name in keep:
        if name not in KEPT:
            raise InputError("keep", name, f"some of {', '.join(KEPT)}")
    heights = scene.heights(points)
    roughness = height_numbers(scene, heights, keep)

    def solve_step(step: LoadStep) -> Point:
        """Return one load on its own."""
        problem, scale = pose_hard_wall(scene, step, heights, tolerance, threads)
        if coarse is not None:
            start = coarse.isel(step=scene.path.steps.index(step))
            problem.warm_start = WarmStart(start.pressure.values / scale.pressure, start.gap.values / scale.step)
        result = solve(method, problem, scale)
        del problem  # its fields are not needed while the result is read
        return read_point(replace(result, scene=scene), heights, roughness, keep)

    solved = _solve_steps(scene.path.steps, solved_points or {}, solve_step)
    return _join_points(scene, heights, roughness, solved, keep)


def _solve_steps(
    steps: Sequence[LoadStep], solved_points: Mapping[int, Point], solve_step: Callable[[LoadStep], Point]
) -> list[Point]:
    """Return the points of all loads in their order, with a line of the log for each."""
    points, seconds = [], []
    for count, step in enumerate(steps):
        if count in solved_points:
            points.append(solved_points[count])
            logger.info("step %d/%d %s taken over", count + 1, len(steps), step.text)
            continue
        point = solve_step(step)
        points.append(point)
        seconds.append(point.seconds)
        remaining = np.mean(seconds) * sum(later not in solved_points for later in range(count + 1, len(steps)))
        logger.info(
            "step %d/%d %s residual %.1e transforms %.0f %.2f s, %.0f s left: %s",
            *(count + 1, len(steps), step.text, point.numbers["max_contact_gap"]),
            *(point.numbers["transforms"], point.seconds, remaining, status_summary(int(point.numbers["status"]))),
        )
    return points


def _join_points(
    scene: Scene, heights: Array, roughness: Mapping[str, float], points: list[Point], keep: Sequence[str]
) -> xr.Dataset:
    """Return the dataset of all loads."""
    grid = Grid(heights.shape, scene.lengths)
    kinds = {"status": np.int8, "validity_flags": np.int8, "iterations": np.int32, "contact_points": np.int32}
    variables: dict[str, Any] = {
        name: ("step", np.array([point.numbers[name] for point in points], kinds.get(name, float)))
        for name in points[0].numbers
    }
    plane = ("y", "x")[-heights.ndim :]
    for name in points[0].arrays:
        arrays = [point.arrays[name] for point in points]
        joined = np.concatenate(arrays) if name == "contact_pressure" else np.stack(arrays)
        variables[name] = (ARRAY_DIMENSIONS.get(name, ("step", *plane)), joined)
    if "fields" in keep:
        variables["heights"] = (plane, heights)
        variables |= {name: grid.positions(axis) for axis, name in enumerate(plane)}
    variables |= {name: places for part in keep for name, places in BIN_CENTRES.get(part, {}).items()}
    if "profile" in keep:
        half, modes = grid.forward(heights), scene.upper.surface.modes
        half = half if modes is None else half[grid.low_modes(modes)]
        across = ("mode_y", "mode")[-heights.ndim :]
        variables |= {"profile_real": (across, half.real.copy()), "profile_imag": (across, half.imag.copy())}
    variables |= roughness
    variables |= {
        "seconds": ("step", [point.seconds for point in points]),
        "approach_first_touch": -float(heights.max()),
        "points": heights.shape[-1],
        "length": scene.length,
        "contact_modulus": scene.contact_modulus,
    }
    if heights.ndim == 2:
        variables |= {"points_y": heights.shape[0], "length_y": scene.lengths[0]}
    return dataset.describe(xr.Dataset(variables, attrs={"problem": scene.kind.value}))


def read_points(target: str | Path, costs: str | Path) -> dict[str, Point]:
    """Return the points of an earlier dataset by their digests; none where there is no dataset that can be read."""
    if not Path(target).exists():
        return {}
    try:
        data = dataset.load_dataset(target)
        ends = np.cumsum(data.contact_points.values)
        load = data.status.dims[0]
        seconds = json.loads(Path(costs).read_text())["seconds"] if Path(costs).exists() else {}
        apart = set(data.dims) - {"mean_pressure"} | {"point_digest"}
        names = [
            str(name) for name, item in data.variables.items() if item.dims == data.status.dims and name not in apart
        ]
        points = {}
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
            points[name] = Point(numbers, arrays, seconds.get(name, float("nan")))
        return points
    except (InputError, AttributeError, KeyError, TypeError, ValueError) as error:
        logger.warning("%s cannot be reused and is computed anew: %s", target, error)
        return {}
