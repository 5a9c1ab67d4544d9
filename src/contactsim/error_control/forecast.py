"""Forecast work, time, memory and error of a run from the measured relations, before anything runs.

Work is counted in transforms, which do not depend on the machine. Seconds are counted in those of one transform, which
is timed here and now.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from contactsim.durations import duration_text
from contactsim.error_control.knobs import EXPECTED, GRID, PATH_TOLERANCE, grid_features
from contactsim.error_control.measured import is_measured
from contactsim.error_control.options import choose_companions, choose_options, expect_error
from contactsim.error_control.relations import Family, scaling_relations
from contactsim.error_control.scaling import QUANTITIES, scene_family
from contactsim.errors import InputError
from contactsim.grid import Grid
from contactsim.paths.options import Setup
from contactsim.paths.requested import Requested
from contactsim.solvers.registry import default_solver_name, make_solver, solver_class
from contactsim.traits import Trait

TIMINGS, UNIT_POINTS, BATCH = 7, 4096, 100
"""How the unit of forecast times is timed: the best of some batches of transforms of a grid."""


FREE_WORK = {1: 2.0, 2: 3.0}
"""Transforms of a product on a free half-space, over those of a periodic one, by dimension."""


@dataclass(frozen=True)
class Forecast:
    """Expected work, time, memory and error of a run.

    Parameters
    ----------
    points : int
        Grid points along x.
    unknowns : int
        Unknowns of one load step.
    steps : int
        Load steps.
    transforms : float
        Transforms in all, in those of the run's grid.
    units : float
        Time in that of one transform of 4096 points.
    megabytes : float
        Memory of all arrays at their peak.
    errors : dict from str to float
        Relative errors by quantity; NaN for measured heights, whose spacing decides them.
    unsure : tuple of str
        Features in which the scene lies beyond all that was measured.
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

    def __str__(self) -> str:
        """Return the forecast in lines of words."""
        return "\n".join(self.lines())

    def lines(self, grid: str = "", before: str = "") -> list[str]:
        """Return the forecast in lines of words; grid, before: what follows the points and the transforms."""
        return [
            f"grid         {self.points} points{grid}",
            f"unknowns     {self.unknowns} at each of {self.steps} load steps",
            f"transforms   {_rounded(self.transforms)} of that grid{before}",
            f"time         {duration_text(self.seconds)} of CPU on one thread",
            f"memory       {_rounded(self.megabytes)} MB of arrays",
            f"error        {_describe_errors(self)}",
            *_describe_guess(self.unsure),
        ]


def forecast_run(setup: Setup) -> Forecast:
    """Forecast a run, to the accuracy that its options ask for or as it is.

    Raises
    ------
    InputError
        For scenes and solvers whose costs were not measured.
    """
    accuracy = setup.options.accuracy
    if accuracy is None:
        return forecast_setup(setup)
    return forecast_to_error(setup, accuracy.error, accuracy.quantities)


def forecast_setup(setup: Setup, quantities: Sequence[str] = ()) -> Forecast:
    """Forecast a run as it is; quantities: whose errors are told, those usual for the scene where empty."""
    scene, options = setup.scene, setup.options
    name_of_family, default = scene_family(scene), default_solver_name(scene)
    if options.solver is not None and type(options.solver) is not solver_class(default):
        allowed = f"{default}: the costs of others were not measured"
        raise InputError("solver.kind", type(options.solver).__name__, allowed)
    relations = scaling_relations()
    family = relations.families[name_of_family]
    size, steps = setup.size, len(scene.path.steps)
    places = [numbers | step_features(setup) for numbers in grid_features(scene, setup.points)]
    factor = 1.0 if scene.repeats else FREE_WORK[len(scene.lengths)]
    transforms, per = factor * sum(family.transforms(numbers) for numbers in places), family.seconds
    seconds = per["step"] * steps + transforms * (per["transform"] + per["point"] * size * math.log2(size))
    method = options.solver or make_solver(default)
    return Forecast(
        points=setup.points,
        unknowns=size * len(scene.exerted),
        steps=steps,
        transforms=transforms,
        units=seconds / relations.unit,
        megabytes=method.fields * len(scene.components) * size * 8 / 1e6,
        errors={name: _expected_error(setup, family, name) for name in quantities or QUANTITIES[name_of_family]},
        unsure=tuple(dict.fromkeys(name for numbers in places for name in family.outside(numbers))),
    )


def _expected_error(setup: Setup, family: Family, name: str) -> float:
    """Return the expected relative error of a quantity; NaN for measured heights, whose spacing decides it."""
    if is_measured(setup.scene):
        return math.nan
    return expect_error(setup, family, name, GRID if setup.scene.sliding else EXPECTED)


def step_features(setup: Setup) -> dict[str, float]:
    """Return the features of how a run is solved: its tolerance, and 1 where every increment is solved."""
    tolerance = math.log(setup.options.tolerance / PATH_TOLERANCE)
    return {
        "tolerance": math.log(setup.options.tolerance),
        "loose": max(tolerance, 0.0),
        "tight": max(-tolerance, 0.0),
        "every": float(setup.options.increments == Requested()),
    }


def forecast_to_error(setup: Setup, error: float, quantities: Sequence[str] = ()) -> Forecast:
    """Forecast a run to a wanted error, its companions included, in transforms of its own grid."""
    chosen = choose_options(setup, error, quantities)
    run = forecast_setup(chosen, quantities)
    part = scaling_relations().families[scene_family(chosen.scene)].warm_start
    transforms, units = part * run.transforms, part * run.units
    for companion in choose_companions(chosen):
        before = forecast_setup(companion, quantities)
        transforms += before.transforms * companion.size / chosen.size
        units += before.units
    return replace(run, transforms=transforms, units=units)


@cache
def transform_seconds() -> float:
    """Return the seconds of a real transform of 4096 points here and now, the unit of forecast times."""
    grid = Grid((UNIT_POINTS,), (1.0,))
    field, times = np.sin(np.arange(float(UNIT_POINTS))), []
    for _ in range(TIMINGS):
        begin = time.process_time()
        for _ in range(BATCH):
            grid.forward(field)
        times.append((time.process_time() - begin) / BATCH)
    return min(times)


def describe_forecasts(setups: Sequence[Setup], forecasts: Sequence[Forecast]) -> str:
    """Return forecasts in words: grid and cost of the first run, and the cost of all together."""
    first, setup = forecasts[0], setups[0]
    grid = f", tolerance {setup.options.tolerance:.2g}"
    if setup.scene.path.increment is not None:
        increments = type(setup.options.increments).__name__.lower()
        unit = "GPa" if setup.scene.path.steps[-1].control is Trait.MEAN_PRESSURE else "nm"
        grid += f", increments of {setup.scene.path.increment:g} {unit}, {increments}"
    before = ", a coarser run before included" * (setup.options.accuracy is not None)
    unsure = tuple(dict.fromkeys(name for forecast in forecasts for name in forecast.unsure))
    lines = replace(first, unsure=()).lines(grid, before)
    if len(setups) > 1:
        seconds = sum(forecast.seconds for forecast in forecasts)
        transforms = sum(forecast.transforms for forecast in forecasts)
        lines.append(f"all {len(setups)} runs: {duration_text(seconds)}, {_rounded(transforms)} transforms")
    return "\n".join([*lines, *_describe_guess(unsure)]) + "\n"


def _rounded(number: float) -> str:
    """Return a number as text, to three digits and without a power of ten."""
    return f"{float(f'{number:.3g}'):.0f}" if number >= 100 else f"{number:.3g}"


def _describe_guess(unsure: Sequence[str]) -> list[str]:
    """Return a line on the features in which scenes lie beyond all that was measured; none where there are none."""
    return [f"beyond what was measured, so a guess: {', '.join(unsure)}"] if unsure else []


def _describe_errors(forecast: Forecast) -> str:
    """Return the expected errors in words."""
    if any(map(math.isnan, forecast.errors.values())):
        return "known after the run: what leaving out every second measured point changes"
    errors = ", ".join(f"{name} {error:.2g}" for name, error in forecast.errors.items())
    return f"{errors} (relative, as expected of such scenes)"
