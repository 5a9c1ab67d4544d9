"""How long what is to be done will take, in words, before it starts; and what a job asks of a cluster."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from contactsim.error_control.effect_maps import neglect_effects
from contactsim.error_control.forecast import Forecast, forecast_run
from contactsim.error_control.neglect import expected_neglect
from contactsim.errors import InputError
from contactsim.provenance import canonical
from contactsim.study.scenes import build_setup
from contactsim.study.study import Run

START = 1.0
"""CPU seconds that a job takes beside what it computes."""
OTHER = 2.5
"""The same of one that gathers or draws."""
UNKNOWN = (
    "solve_trial",
    "measure_work_precision",
    "measure_scaling",
    "measure_effect_map",
    "measure_effects",
    "survey_hazard",
    "select_effects",
)
"""Rules whose jobs solve scenes, of which nothing is forecast."""

EMPTY = 400.0
"""Megabytes of a job beside its arrays: measured are 300."""
ARRAYS = 1.5
"""Megabytes asked for each that is forecast of arrays: measured is 1."""
LONGER = 6.0
"""Seconds asked for each that is forecast: of 600 runs measured one took 5, all others at most 2.6."""
UNKNOWN_MEGABYTES, UNKNOWN_MINUTES = 1000, 15
"""What a run asks for of which nothing is known."""
SHORT = 60.0
"""Seconds up to which runs share a job of a cluster, which takes some ten to start."""


def forecast_for(run: Run) -> Forecast | None:
    """What is forecast of a run, without what the maps find negligible; None of scenes that were not measured."""
    return _forecast(canonical(run.settings))


@cache
def _forecast(text: str) -> Forecast | None:
    settings = json.loads(text)
    setup = build_setup(settings)
    if "auto" in settings:
        setup = neglect_effects(setup, expected_neglect(setup.scene, settings["auto"]["neglect_within"]))
    try:
        return forecast_run(setup)
    except InputError:
        return None


def seconds_of(run: Run, costs: str | Path | None) -> float | None:
    """CPU seconds of a run: as forecast or, of scenes that were not measured, as it took before; None if unknown."""
    found = forecast_for(run)
    return _spent(costs, "cpu_seconds_of_last_run") if found is None else found.seconds


def megabytes_of(run: Run, costs: str | Path | None) -> float | None:
    """Memory of a run's job: as forecast or, of scenes that were not measured, as it took before; None if unknown."""
    found = forecast_for(run)
    return _spent(costs, "peak_memory_of_last_run") if found is None else EMPTY + ARRAYS * found.megabytes


def _spent(costs: str | Path, name: str) -> float | None:
    """A number in the file of a run's costs; None without it."""
    try:
        return float(json.loads(Path(costs).read_text(encoding="utf-8"))[name])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def memory_asked(run: Run, costs: str | Path, attempt: int = 1) -> int:
    """Megabytes that a run's job asks for, generously: each attempt as much again."""
    found = megabytes_of(run, costs)
    return attempt * (UNKNOWN_MEGABYTES if found is None else 100 * math.ceil(found / 100))


def minutes_asked(run: Run, costs: str | Path, attempt: int = 1) -> int:
    """Minutes that a run's job asks for, generously: each attempt as much again."""
    found = seconds_of(run, costs)
    return attempt * (UNKNOWN_MINUTES if found is None else math.ceil(LONGER * (found + START) / 60))


def is_short(run: Run, costs: str | Path | None) -> bool:
    """Whether a run should share a job of a cluster with others; one of which nothing is known is taken to be short."""
    return (seconds_of(run, costs) or 0.0) <= SHORT


def told(runs: Iterable[tuple[Run, str | Path]], rules: Iterable[str], cores: int) -> str:
    """What lies ahead: runs, each with the file of its costs, and the rules of all other jobs, on a number of cores."""
    found, rules = [seconds_of(run, costs) for run, costs in runs], list(rules)
    unknown = sum(seconds is None for seconds in found) + sum(rule in UNKNOWN for rule in rules)
    total = sum(seconds + START for seconds in found if seconds is not None)
    total += OTHER * sum(rule not in UNKNOWN for rule in rules)
    text = f"Predicted for {len(found)} runs and {len(rules)} other jobs: about {_duration(total)} of CPU time"
    text += f", {_duration(total / cores)} on {cores} cores"
    return text + f", and {unknown} jobs of which no time is known beforehand" * bool(unknown) + "."


def _duration(seconds: float) -> str:
    """Seconds in words, to two digits."""
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 1.5 * size:
            return f"{float(f'{seconds / size:.1e}'):g} {unit}"
    return f"{float(f'{seconds:.1e}'):g} s"
