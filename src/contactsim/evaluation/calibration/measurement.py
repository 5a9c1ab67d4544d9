"""Measure errors and costs: scenes drawn at random, each solved on a ladder of every knob.

Every error is against a reference outside the ladder. `contactsim.evaluation.calibration.fit` fits relations to them.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import pandas as pd

from contactsim.contact.problem_kind import ProblemKind
from contactsim.error_control.control import COMPANIONS
from contactsim.error_control.forecast import step_features, transform_seconds
from contactsim.error_control.knobs import grid_features
from contactsim.error_control.options import choose_options, coarsen, set_grid
from contactsim.error_control.scaling import (
    COUNTED_AREA,
    LINE,
    PATH,
    QUANTITIES,
    ROUGH_PATH,
    SLIDE,
    SURFACE,
    contact_scale,
    scene_family,
)
from contactsim.error_control.solution import Solution, relative_difference, solve_setup
from contactsim.evaluation.calibration.sampling import FAMILY_RANGES, Ranges, Trials, draw_scene
from contactsim.paths.options import Setup
from contactsim.paths.requested import Requested
from contactsim.solvers.registry import DEFAULT_SOLVERS, solver_module
from contactsim.study.stages import computing_stage_digest

logger = logging.getLogger(__name__)

RESOLUTIONS = {
    LINE: (4.0, 8.0, 16.0, 32.0, 64.0),
    SURFACE: (4.0, 6.0, 8.0, 12.0, 16.0),
    PATH: (1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 32.0),
    ROUGH_PATH: (4.0, 8.0, 16.0, 32.0),
    SLIDE: (1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0),
}
"""Points for each length that contacts are measured by, on the ladder of grids."""
REFERENCE_REFINEMENT = {LINE: 8.0, SURFACE: 2.5, PATH: 4.0, ROUGH_PATH: 4.0, SLIDE: 4.0}
"""Points of the reference over those of the finest grid of the ladder."""
INCREMENTS = {PATH: (2.0, 1.0, 0.5, 0.2), ROUGH_PATH: (4.0, 2.0, 1.0), SLIDE: (1.0, 0.5, 0.25)}
"""Increments of the ladder, in the laws' length."""
REFERENCE_INCREMENTS = {PATH: 0.05, ROUGH_PATH: 0.5, SLIDE: 0.1}
"""Increments of the references and of the ladder of grids, in the laws' length."""
WALL_TOLERANCES, PATH_TOLERANCES = (1e-1, 1e-2, 1e-3), (1e-3, 1e-4, 1e-5)
REFERENCE_TOLERANCE = {ProblemKind.COHESIVE: 1e-6, ProblemKind.HARD_WALL: 1e-4}
MEASURED_QUANTITIES = {
    LINE: (*QUANTITIES[LINE], COUNTED_AREA),
    SURFACE: (*QUANTITIES[SURFACE], COUNTED_AREA),
    PATH: QUANTITIES[PATH],
    ROUGH_PATH: QUANTITIES[ROUGH_PATH],
    SLIDE: (*QUANTITIES[SLIDE], "onset_contact_length"),
}
"""Quantities whose errors are measured, by family."""
WARM_START_ERROR = 0.02
"""Error requested of runs that begin from a coarse grid."""


Ladder = tuple[str, Setup, list[Setup]]
"""Knob, setup of the reference, and those of the ladder."""


def measure_scene(setup: Setup) -> pd.DataFrame:
    """Solve a scene on all ladders.

    Parameters
    ----------
    setup : Setup
        Scene and options; its grid, tolerance and increments do not matter.

    Returns
    -------
    pandas.DataFrame
        One row a setting and load, with its features, errors, transforms and seconds.
    """
    family = scene_family(setup.scene)
    rows = []
    for knob, base, ladder in LADDERS[setup.scene.kind](setup, family):
        reference = solve_setup(base, MEASURED_QUANTITIES[family])
        for rung in ladder:
            rows += _rows(knob, solve_setup(rung, MEASURED_QUANTITIES[family]), reference, family)
    rows += WARM_STARTS[setup.scene.kind](setup, family)
    return pd.DataFrame(rows)


def _warm_start(setup: Setup, family: str) -> list[dict]:
    """Return the rows of a run at a hard wall that begins from its companion."""
    fine = choose_options(setup, WARM_START_ERROR)
    before = solve_setup(COMPANIONS[setup.scene.kind](coarsen(fine)), MEASURED_QUANTITIES[family])
    solution = solve_setup(fine, MEASURED_QUANTITIES[family], before)
    return _rows("warm_start", solution, solution, family)


def _load_ladders(setup: Setup, family: str) -> Iterator[Ladder]:
    """Yield the ladders of loads at a hard wall: grids and tolerances."""
    smallest = min(contact_scale(setup.scene, step.value) for step in setup.scene.path.steps)
    tight = setup.with_options(tolerance=REFERENCE_TOLERANCE[ProblemKind.HARD_WALL])
    grids, finest, middle = _resolutions(family)
    yield "points", _resolve(tight, finest, smallest), [_resolve(tight, value, smallest) for value in grids]
    ladder = [_resolve(setup.with_options(tolerance=value), middle, smallest) for value in WALL_TOLERANCES]
    yield "tolerance", _resolve(tight, middle, smallest), ladder


def _path_ladders(setup: Setup, family: str) -> Iterator[Ladder]:
    """Yield the ladders of a path of cohesive laws: grids, increments and tolerances."""
    smallest = contact_scale(setup.scene)
    fine = setup.with_options(tolerance=REFERENCE_TOLERANCE[ProblemKind.COHESIVE]).with_increment(
        REFERENCE_INCREMENTS[family]
    )
    grids, finest, middle = _resolutions(family)
    yield "points", _resolve(fine, finest, smallest), [_resolve(fine, value, smallest) for value in grids]
    rest = setup.with_options(tolerance=1e-4)
    ladder = [_resolve(rest.with_increment(value), middle, smallest) for value in INCREMENTS[family]]
    if family in (PATH, ROUGH_PATH):  # the same with every increment solved, for their cost
        ladder += [rung.with_options(increments=Requested()) for rung in ladder[1:2]]
    yield "increment", _resolve(rest.with_increment(REFERENCE_INCREMENTS[family]), middle, smallest), ladder
    tolerances = [_resolve(fine.with_options(tolerance=value), middle, smallest) for value in PATH_TOLERANCES]
    yield "tolerance", _resolve(fine, middle, smallest), tolerances


def _resolutions(family: str) -> tuple[tuple[float, ...], float, float]:
    """Return points for each contact length: those of the ladder, of its reference, and of other knobs' ladders."""
    resolutions = RESOLUTIONS[family]
    return resolutions, REFERENCE_REFINEMENT[family] * resolutions[-1], resolutions[len(resolutions) // 2]


def _resolve(setup: Setup, resolution: float, length: float) -> Setup:
    """Return a setup with that many points for each contact length (nm)."""
    return set_grid(setup, resolution * setup.scene.length / length)


LADDERS = {ProblemKind.HARD_WALL: _load_ladders, ProblemKind.COHESIVE: _path_ladders}
WARM_STARTS = {ProblemKind.HARD_WALL: _warm_start, ProblemKind.COHESIVE: lambda setup, family: []}


def _rows(knob: str, solution: Solution, reference: Solution, family: str) -> list[dict]:
    """Return one row a load, or one for a path."""
    setup = solution.setup
    loads = bool(solution.resolved.size)
    rows = []
    for count, numbers in enumerate(grid_features(setup.scene, solution.points)):
        row = {"kind": family, "knob": knob, **numbers, **step_features(setup), "points": solution.points}
        row["increment"] = math.log(setup.scene.path.increment or 1.0)
        row["resolved"] = math.log(max(solution.resolved[count], 1e-9)) if loads else np.nan
        for name in MEASURED_QUANTITIES[family]:
            row[f"error_{name}"] = relative_difference(reference, solution, name)[count]
        row["count"] = 1 if loads else solution.data.step.size
        row["transforms"] = float(solution.data.transforms[count]) if loads else solution.transforms
        row["seconds"] = float(solution.data.seconds[count]) if loads else solution.seconds
        row["total"] = solution.size
        rows.append(row)
    return rows


@dataclass(frozen=True)
class ScalingJob:
    """The measurements of one family: its ranges, and the seed and number of its scenes."""

    kind: str
    ranges: Ranges
    seed: int
    scenes: int

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> ScalingJob:
        """Return the job from its JSON, of `scaling_job`."""
        kind, scenes = settings["kind"], settings["drawn"]
        return cls(kind, FAMILY_RANGES[kind](**scenes["ranges"]), scenes["seed"], scenes["scenes"])


def scaling_job(trials: Trials, kind: str) -> dict[str, Any]:
    """Return what the measurements of one family depend on.

    They do not depend on the scaling relations that they start from: else fitting would never settle.
    """
    scenes = {"ranges": asdict(trials.kinds[kind]), **asdict(trials.calibration)}
    source = computing_stage_digest("measure_scaling", *(solver_module(name) for name in DEFAULT_SOLVERS.values()))
    return {"kind": kind, "drawn": scenes, "source": source}


def measure_scaling(job: ScalingJob) -> pd.DataFrame:
    """Measure all scenes of one family on all ladders.

    Parameters
    ----------
    job : ScalingJob
        The family and its scenes.

    Returns
    -------
    pandas.DataFrame
        The rows of `measure_scene`, with the number of the scene and the seconds of the transform in which times are
        counted.
    """
    tables = []
    for count in range(job.scenes):
        run = draw_scene(job.kind, job.ranges, job.seed, count)
        tables.append(measure_scene(run.setup).assign(scene=count))
        logger.info("scene %d of %d", count + 1, job.scenes)
    return pd.concat(tables, ignore_index=True).assign(unit=transform_seconds())
