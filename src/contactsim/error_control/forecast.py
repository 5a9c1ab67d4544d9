"""Forecast work, time and memory of a run from the measured relations, before anything runs.

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
from contactsim.error_control.options import choose_options, coarser_setups, refine
from contactsim.error_control.scaling import cost_relations, features, run_family
from contactsim.errors import InputError
from contactsim.grid import Grid
from contactsim.paths.options import Setup
from contactsim.solvers.registry import default_solver_name, make_solver, solver_class
from contactsim.traits import Trait

TIMINGS, UNIT_POINTS, BATCH = 7, 4096, 100
"""How the unit of forecast times is timed: the best of some batches of transforms of a grid."""
REFINEMENT = 3.0
"""Grid of most final runs over the one that is expected to do, as estimates lie above most errors."""


@dataclass(frozen=True)
class Forecast:
    """Expected work, time and memory of a run.

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
    unsure : tuple of str
        Features in which the scene lies beyond all that was measured.
    """

    points: int
    unknowns: int
    steps: int
    transforms: float
    units: float
    megabytes: float
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


def forecast_setup(setup: Setup) -> Forecast:
    """Forecast a run as it is."""
    scene, options = setup.scene, setup.options
    default = default_solver_name(scene)
    if options.solver is not None and type(options.solver) is not solver_class(default):
        allowed = f"{default}: the costs of others were not measured"
        raise InputError("solver.kind", type(options.solver).__name__, allowed)
    family, places = cost_relations()[run_family(scene)], features(setup)
    size, steps = setup.size, len(scene.path.steps)
    transforms, per = sum(family.work(numbers) for numbers in places), family.units
    units = per["step"] * steps + transforms * (per["transform"] + per["point"] * size * math.log2(size))
    method = options.solver or make_solver(default)
    return Forecast(
        points=setup.points,
        unknowns=size * len(scene.exerted),
        steps=steps,
        transforms=transforms,
        units=units,
        megabytes=method.fields * len(scene.components) * size * 8 / 1e6,
        unsure=tuple(dict.fromkeys(name for numbers in places for name in family.outside(numbers))),
    )


def forecast_to_error(setup: Setup, error: float, quantities: Sequence[str] = ()) -> Forecast:
    """Forecast a run to a wanted error, on the grid at which most scenes end, with the coarser runs before it."""
    expected = choose_options(setup, error, quantities)
    chosen = refine(expected, REFINEMENT, error)
    run = forecast_setup(chosen)
    coarser = [*coarser_setups(expected), expected]
    before = [(forecast_setup(coarse), coarse.size / chosen.size) for coarse in coarser]
    transforms = run.transforms + sum(forecast.transforms * part for forecast, part in before)
    return replace(run, transforms=transforms, units=run.units + sum(forecast.units for forecast, _ in before))


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
    before = ", coarser runs before included" * (setup.options.accuracy is not None)
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
