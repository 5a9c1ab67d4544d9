"""Predict the time and memory of jobs before they start, in words and as requests to a cluster."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from contactsim.durations import duration_text
from contactsim.error_control.effect_maps import neglect_effects
from contactsim.error_control.forecast import Forecast, forecast_run
from contactsim.error_control.neglect import expected_neglect
from contactsim.errors import InputError
from contactsim.provenance import canonical
from contactsim.study.run import Run
from contactsim.study.scenes import build_setup

START_SECONDS = 1.0
"""CPU seconds that a job takes beside its computation."""
OTHER_JOB_SECONDS = 2.5
"""CPU seconds of a job that gathers or draws."""
UNPREDICTED_RULES = (
    "solve_trial",
    "measure_work_precision",
    "measure_price",
    "measure_scaling",
    "measure_effect_map",
    "measure_effects",
    "survey_hazard",
    "select_effects",
)
"""Rules whose jobs solve scenes without a forecast."""

BASE_MEGABYTES = 400.0
"""Megabytes requested for a job beside its arrays: 300 were measured."""
ARRAY_FACTOR = 1.5
"""Megabytes requested for each forecast megabyte of arrays: 1 was measured."""
TIME_FACTOR = 6.0
"""Seconds requested for each forecast second: of 600 measured runs one took 5, all others at most 2.6."""
UNKNOWN_MEGABYTES, UNKNOWN_MINUTES = 1000, 15
"""Requests of a run that was neither forecast nor measured."""
MAX_SHORT_SECONDS = 60.0
"""Seconds up to which runs share a job of a cluster, which takes about ten seconds to start."""


def find_forecast(run: Run) -> Forecast | None:
    """Return the forecast of a run without the effects that the maps neglect; None outside the measured scenes."""
    return _forecast(canonical(run.settings))


@cache
def _forecast(text: str) -> Forecast | None:
    """Return the forecast of a run from the JSON of its settings."""
    settings = json.loads(text)
    setup = build_setup(settings)
    if "auto" in settings:
        setup = neglect_effects(setup, expected_neglect(setup.scene, settings["auto"]["neglect_within"]))
    try:
        return forecast_run(setup)
    except InputError:
        return None


def predict_seconds(run: Run, costs: str | Path | None) -> float | None:
    """Return the CPU seconds of a run: its forecast, else what it took before; None if neither is known."""
    prediction = find_forecast(run)
    return _read_cost(costs, "cpu_seconds_of_last_run") if prediction is None else prediction.seconds


def predict_megabytes(run: Run, costs: str | Path | None) -> float | None:
    """Return the megabytes of a run's job: its forecast, else what it took before; None if neither is known."""
    prediction = find_forecast(run)
    return (
        _read_cost(costs, "peak_memory_of_last_run")
        if prediction is None
        else BASE_MEGABYTES + ARRAY_FACTOR * prediction.megabytes
    )


def _read_cost(costs: str | Path | None, name: str) -> float | None:
    """Return a number from the file of a run's costs; None without it."""
    if costs is None:
        return None
    try:
        return float(json.loads(Path(costs).read_text(encoding="utf-8"))[name])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def request_memory(run: Run, costs: str | Path, attempt: int = 1) -> int:
    """Return the megabytes that a run's job requests with a margin; each attempt adds as much again."""
    prediction = predict_megabytes(run, costs)
    return attempt * (UNKNOWN_MEGABYTES if prediction is None else 100 * math.ceil(prediction / 100))


def request_minutes(run: Run, costs: str | Path, attempt: int = 1) -> int:
    """Return the minutes that a run's job requests with a margin; each attempt adds as much again."""
    prediction = predict_seconds(run, costs)
    return attempt * (
        UNKNOWN_MINUTES if prediction is None else math.ceil(TIME_FACTOR * (prediction + START_SECONDS) / 60)
    )


def is_short(run: Run, costs: str | Path | None) -> bool:
    """Return True where a run should share a job of a cluster; a run without prediction counts as short."""
    return (predict_seconds(run, costs) or 0.0) <= MAX_SHORT_SECONDS


def predict_run(run: Run, costs: str | Path | None) -> float | None:
    """Return the CPU seconds of a run's job with its start; None if they are not known."""
    prediction = predict_seconds(run, costs)
    return None if prediction is None else prediction + START_SECONDS


def predict_other_job(rule: str) -> float | None:
    """Return the CPU seconds of a job that is no run, by its rule; None if they are not known."""
    return None if rule in UNPREDICTED_RULES else OTHER_JOB_SECONDS


def summarise_jobs(runs: Sequence[float | None], others: Sequence[float | None], cores: int) -> str:
    """Return a sentence about the time that jobs will take together.

    Parameters
    ----------
    runs, others : sequence of float or None
        CPU seconds of each run and of each other job, None if not known.
    cores : int
        Cores that share the jobs.
    """
    known = [seconds for seconds in (*runs, *others) if seconds is not None]
    total, unknown = sum(known), len(runs) + len(others) - len(known)
    text = f"Predicted for {len(runs)} runs and {len(others)} other jobs: "
    text += f"about {duration_text(total)} of CPU time, {duration_text(total / cores)} on {cores} cores"
    return text + f", and {unknown} jobs of unknown time" * bool(unknown) + "."
