"""How long what is to be done will take, in words, before it starts."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

from contactsim.errors import SceneError
from contactsim.forecast import forecast_of
from contactsim.negligible import foreseen
from contactsim.study import Run

START = 1.0
"""CPU seconds that a job takes beside what it computes."""
OTHER = 2.5
"""The same of one that gathers or draws."""
UNKNOWN = ("trial", "price", "measure_relations", "measure_map", "measure_effects", "hazard", "decide")
"""Rules whose jobs solve scenes, of which nothing is forecast."""


def seconds_of(run: Run, costs: str | Path) -> float | None:
    """CPU seconds of a run: as forecast or, of scenes that were not measured, as it took before; None if unknown."""
    settings = run.settings
    if "auto" in settings:
        settings = settings | {"leave_out": foreseen(settings, settings["auto"]["within"])}
    try:
        return forecast_of(settings).seconds
    except SceneError:
        try:
            return float(json.loads(Path(costs).read_text(encoding="utf-8"))["cpu_seconds_of_last_run"])
        except (OSError, ValueError, KeyError, TypeError):
            return None


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
