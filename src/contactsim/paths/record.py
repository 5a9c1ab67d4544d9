"""Simulate a path through states of cohesive laws: numbers at every step, fields at some."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset, status
from contactsim.contact.coarse_grid import prolong
from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.contact.scene import Scene
from contactsim.grid import Array
from contactsim.observables.adhesion import OPENINGS, PULLS, histograms
from contactsim.observables.load_curve import join_folds
from contactsim.observables.sliding import join_slips, slide_observables
from contactsim.paths.increments import Increments
from contactsim.paths.jump_numbers import approach_of, fold_numbers, slip_numbers
from contactsim.paths.state import PathState
from contactsim.paths.state_numbers import STATE_READERS, StateReader
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.surfaces.height_statistics import STATISTICS

logger = logging.getLogger(__name__)

GAPS = ("normal_gap", "tangential_gap")
DISPLACEMENTS = ("normal_displacement", "tangential_displacement")
TRACTIONS = ("normal_traction", "tangential_traction")
BINS = {"normal_gap_share": ("normal_gap_bin", OPENINGS), "normal_traction_share": ("normal_traction_bin", PULLS)}
"""Dimension of each histogram, and the edges of its bins."""
LOG_LINES = 40
"""About how many lines a path writes into its log."""


def simulate_path(
    scene: Scene,
    method: CohesiveSolver,
    *,
    points: int,
    tolerance: float,
    threads: int = 1,
    increments: Increments,
    snapshots: Sequence[float] | None = None,
    keep_fields: bool = True,
    until_complete: bool = False,
) -> xr.Dataset:
    """Follow a scene's load path.

    Parameters
    ----------
    scene : Scene
        Scene of cohesive laws.
    method : CohesiveSolver
        The solver.
    points : int
        Grid points along x.
    tolerance : float
        In parts of the laws' strength.
    threads : int
        Threads of the transforms.
    increments : Increments
        One of `contactsim.paths.increments.INCREMENTS`.
    snapshots : sequence of float, optional
        Sliding distances (nm) of a path that slides, else approaches (nm) or mean pressures (GPa). The first steps near
        them keep histograms and fields.
    keep_fields : bool
        False to keep histograms alone.
    until_complete : bool
        True to end the path at the first state in which every gap is closed.

    Returns
    -------
    xarray.Dataset
        One dataset with dimension `step`; NaN where there is no solution.
    """
    heights, steps = scene.heights(points), scene.path.steps
    problem = pose_cohesive(scene, heights, tolerance, threads)
    snapshot_steps = {scene.path.nearest(value) for value in snapshots or ()}
    reader = STATE_READERS[len(scene.lengths)](problem)
    fields: dict[int, dict[str, Array]] = {}
    rows, folds, slips, begin, total, marks = [], [], [], time.process_time(), 0.0, [0.0]
    for count, state in enumerate(increments.follow(problem, method, steps)):
        total += state.transforms
        marks.append(time.process_time() - begin)
        rows.append(_state_numbers(scene, state, reader))
        folds += [fold_numbers(problem, jump, count) for jump in state.jumps if not jump.step.held]
        slips += [slip_numbers(problem, jump, count) for jump in state.jumps if jump.step.held]
        if count in snapshot_steps:
            fields[count] = _state_fields(problem.at(state.step), state, keep_fields)
        if count % max(len(steps) // LOG_LINES, 1) == 0 or state.jump or count == len(steps) - 1:
            _log_progress(state, count, len(steps), total, marks[-1])
        if until_complete and state.status.solved and reader.is_complete(rows[-1]):
            break
    data = _join_states(scene, problem, rows, fields).merge(join_folds(folds, len(scene.lengths)))
    data = dataset.describe(data.merge(join_slips(slips)) if scene.sliding else data)
    return data.assign(seconds=("step", np.diff(marks)))


def _state_numbers(scene: Scene, state: PathState, reader: StateReader) -> dict[str, float]:
    """Return the numbers of a state, NaN where there is no solution, and how the state was found."""
    problem = state.problem
    gap, traction = map(problem.on_heights, state.fields())
    numbers: dict[str, float] = {
        "approach": approach_of(problem, state.displacement),
        **reader.numbers(problem, state.displacement, gap, traction),
    }
    if scene.sliding:
        numbers = {"friction_force": 0.0} | numbers | slide_observables(problem, gap, state.displacement)
    if not state.status.solved:
        numbers = dict.fromkeys(numbers, np.nan)
    if scene.sliding:
        numbers["sliding_distance"] = state.step.sliding_distance if state.step.held else np.nan
    zone = status.process_zone(scene.contact_modulus, problem.strength, problem.interaction_range)
    numbers["process_zone_step"] = problem.grid.spacing[-1] / zone
    return numbers | {
        "validity_flags": status.validity_flags(numbers),
        "residual": state.residual,
        "status": state.status.value[0],
        "solved_points": state.points,
        "jump": state.jump,
        "iterations": state.iterations,
        "transforms": state.transforms,
    }


def _state_fields(problem: CohesiveProblem, state: PathState, keep_fields: bool) -> dict[str, Array]:
    """Return histograms and, if kept, gap, traction and displacement by component, each (n,), on the whole grid."""
    if state.points < problem.heights.size:
        displacement = prolong(problem, state.problem.grid, state.displacement)
        state = replace(state, problem=problem, displacement=displacement, solution=None)
    gap, traction = map(problem.on_heights, state.fields())
    fields = histograms(problem, gap, traction)
    if keep_fields:
        displacement = problem.on_heights(problem.field(state.displacement))
        if problem.load is not None:  # its uniform mode is the gap's, approach included
            displacement[0] += problem.mean_displacement - state.displacement[0, 0].real
        parts = ((GAPS, gap), (DISPLACEMENTS, -displacement), (TRACTIONS, traction))
        fields |= {name: row for names, rows in parts for name, row in zip(names, rows, strict=False)}
    return fields if state.status.solved else {name: np.full_like(row, np.nan) for name, row in fields.items()}


def _log_progress(state: PathState, count: int, steps: int, transforms: float, seconds: float) -> None:
    """Log how far a path of some steps is, and how long it is expected to take."""
    logger.info(
        "step %d/%d %s residual %.1e transforms %.0f %.2f s, %.0f s left: %s%s",
        *(count + 1, steps, state.step.text, state.residual, transforms, seconds),
        seconds / (count + 1) * (steps - count - 1),
        state.status.summary,
        f"; jumped {state.jump:.3g} nm" if state.jump else "",
    )


def _join_states(
    scene: Scene, problem: CohesiveProblem, rows: list[dict[str, float]], fields: dict[int, dict[str, Array]]
) -> xr.Dataset:
    """Return the dataset of a path; fields: at snapshots, by step."""
    grid = problem.heights
    heights, plane = -problem.on_heights(problem.shape[0]).reshape(grid.shape), ("y", "x")[-len(grid.shape) :]
    kinds = {"status": np.int8, "validity_flags": np.int8, "iterations": np.int32, "solved_points": np.int32}
    variables: dict[str, Any] = {
        name: ("step", np.array([row[name] for row in rows], kinds.get(name, float))) for name in rows[0]
    }
    coordinates = {}
    if fields:
        for name in next(iter(fields.values())):
            rows_of_name = np.stack([snapshot[name] for snapshot in fields.values()])
            if name in BINS:
                variables[name] = (("snapshot", BINS[name][0]), rows_of_name)
            else:
                variables[name] = (("snapshot", *plane), rows_of_name.reshape(-1, *grid.shape))
        coordinates = {"snapshot": np.array([scene.path.steps[count].value for count in fields])}
        coordinates |= {name: (edges[1:] + edges[:-1]) / 2 for name, edges in BINS.values()}
        if GAPS[0] in variables:
            variables["heights"] = (plane, heights)
            coordinates |= {name: grid.positions(axis) for axis, name in enumerate(plane)}
    variables |= {
        "points": grid.shape[-1],
        "length": scene.length,
        "approach_first_touch": -float(heights.max()),
        "contact_modulus": scene.contact_modulus,
        "control": scene.path.steps[0].control.name.lower(),
        "strength": sum(law.strength for law in scene.laws),
    }
    if len(grid.shape) == 2:
        variables |= {"points_y": grid.shape[0], "length_y": scene.lengths[0]}
        variables["rms_curvature"] = STATISTICS[scene.repeats].rms_curvature(heights, grid.spacing)
    if scene.sliding:
        lattice = problem.lattice_constant
        variables["lattice_constant"] = lattice if np.isfinite(lattice) else np.nan
    return xr.Dataset(variables, coordinates, {"problem": scene.kind.value})
