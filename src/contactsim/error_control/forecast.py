"""What a run will cost and how far off it will be, from relations that were measured, before anything runs.

Work is in transforms, which do not depend on the machine; seconds are counted in those of one transform, which is timed
here and now.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from contactsim.error_control.options import PATH_TOLERANCE, chosen, coarser, left_open, on_grid, paced_part, size_of
from contactsim.error_control.scaling import MEASURES, Kind, kind_of, relations
from contactsim.errors import SceneError
from contactsim.grid import Grid
from contactsim.solvers.registry import default_solver_name, make_solver
from contactsim.study.keys import is_smooth
from contactsim.study.scenes import scene_of

REPEATS, UNIT_POINTS, BATCH = 7, 4096, 100
"""How the unit of predicted times is timed: the best of some batches of transforms of a grid."""


@dataclass(frozen=True)
class Forecast:
    """What is expected of a run.

    points: of its grid along x; unknowns: of a step; transforms: in those of its grid; units: of time, what a transform
    of 4096 points takes;
    megabytes: of all arrays at their peak; errors: relative, by quantity; unsure: features in which the scene is beyond
    all that was measured.
    """

    points: int
    unknowns: int
    steps: int
    transforms: float
    units: float
    megabytes: float
    errors: dict[str, float]
    unsure: tuple[str, ...]

    @property
    def seconds(self) -> float:
        """CPU seconds on one thread, here and now."""
        return self.units * transform_seconds()


def forecast(settings: dict, of: Sequence[str] = ()) -> Forecast:
    """What a run with these settings will cost, and how far off its quantities will be.

    of: names of quantities, the usual ones where empty. SceneError for scenes and solvers that were not measured.
    """
    scene, points = scene_of(settings), settings["points"]
    kind, default = kind_of(scene), default_solver_name(scene)
    if settings["solver"]["kind"] != default:
        raise SceneError("solver.kind", settings["solver"]["kind"], f"{default}: the costs of others were not measured")
    told = relations()
    known = told.kinds[kind]
    places = [one | walk_features(settings) for one in on_grid(scene, points)]
    size, steps = size_of(scene, points), len(scene.path.steps)
    transforms, per = sum(known.transforms(one) for one in places), known.seconds
    seconds = per["step"] * steps + transforms * (per["transform"] + per["point"] * size * math.log2(size))
    return Forecast(
        points=points,
        unknowns=size * len(scene.exerted),
        steps=steps,
        transforms=transforms,
        units=seconds / told.unit,
        megabytes=make_solver(**settings["solver"]).fields * len(scene.components) * size * 8 / 1e6,
        errors={name: _left_open(settings, places, known, name) for name in of or MEASURES[kind]},
        unsure=tuple(dict.fromkeys(name for one in places for name in known.outside(one))),
    )


def _left_open(settings: dict, places: list[dict[str, float]], known: Kind, name: str) -> float:
    """The largest relative error that is expected of a quantity."""
    if is_smooth(settings):
        return left_open(settings, known, name)
    return max(known.errors["points"][name](one) for one in places)


def walk_features(settings: dict) -> dict[str, float]:
    """Features of how a run is solved: its tolerance, looser and tighter than usual, and whether every increment is."""
    tolerance = math.log(settings["tolerance"] / PATH_TOLERANCE)
    every = settings.get("increments", {}).get("kind") == "requested"
    return {
        "tolerance": math.log(settings["tolerance"]),
        "loose": max(tolerance, 0.0),
        "tight": max(-tolerance, 0.0),
        "every": float(every),
    }


def forecast_to(settings: dict, error: float, of: Sequence[str] = ()) -> Forecast:
    """What a run to an accuracy is expected to cost, its companion included, in transforms of its own grid."""
    found = chosen(settings, error, of)
    scene, own, other = scene_of(found), forecast(found, of), forecast(coarser(found), of)
    before = other.transforms * size_of(scene, other.points) / size_of(scene, own.points)
    part = relations().kinds[kind_of(scene)].begun
    return replace(own, transforms=part * own.transforms + before, units=part * own.units + other.units)


def forecast_of(settings: dict) -> Forecast:
    """What a run is expected to cost, to the accuracy that it asks for or as it is."""
    if "accuracy" in settings:
        return forecast_to(settings, **settings["accuracy"])
    return forecast(settings)


def expectation(runs: list[dict], expected: list[Forecast]) -> str:
    """Forecasts of runs in words: what the first is to be and costs, and all of them together."""
    first, settings = expected[0], runs[0]
    part = settings[paced_part(settings)]
    grid = f"{first.points} points, tolerance {settings['tolerance']:.2g}"
    grid += f", increments of {part['increment']:g} {settings['increments']['kind']}" if "increment" in part else ""
    errors = ", ".join(f"{name} {error:.2g}" for name, error in first.errors.items())
    before = ", a coarser run before included" * ("accuracy" in settings)
    lines = [
        f"grid         {grid}",
        f"unknowns     {first.unknowns} at each of {first.steps} load steps",
        f"transforms   {first.transforms:.3g} of that grid{before}",
        f"seconds      {first.seconds:.2g} of CPU on one thread",
        f"memory       {first.megabytes:.3g} MB of arrays",
        f"error        {errors} (relative, as expected of such scenes)",
    ]
    if len(runs) > 1:
        total = sum(one.seconds for one in expected)
        lines.append(f"all {len(runs):4d} runs {total:.3g} s, {sum(one.transforms for one in expected):.3g} transforms")
    unsure = dict.fromkeys(name for one in expected for name in one.unsure)
    lines += [f"beyond what was measured, so a guess: {', '.join(unsure)}"] * bool(unsure)
    lines += ["with all effects: what is negligible is found out by the run"] * ("auto" in settings)
    return "\n".join(lines) + "\n"


@cache
def transform_seconds() -> float:
    """Seconds that a real transform of 4096 points takes here and now, the unit of predicted times."""
    grid = Grid((UNIT_POINTS,), (1.0,))
    field, times = np.sin(np.arange(float(UNIT_POINTS))), []
    for _ in range(REPEATS):
        begin = time.process_time()
        for _ in range(BATCH):
            grid.forward(field)
        times.append((time.process_time() - begin) / BATCH)
    return min(times)
