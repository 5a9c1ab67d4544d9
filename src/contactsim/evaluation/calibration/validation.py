"""Accuracy on trial: scenes drawn at random are solved to an error asked for, and judged by finer runs.

The true error is against a run with every knob finer than in any that is judged. The cheapest setting is the one of
least work, transforms times points, on a ladder of all knobs about the final one that is within the error in truth;
who does not know it beforehand cannot choose it.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.error_control.control import Outcome, Reached, difference, outcome, reach
from contactsim.error_control.forecast import forecast_to
from contactsim.error_control.options import chosen, coarser, on_points, rescaled, size_of
from contactsim.error_control.scaling import FILE, KINDS, LINE, MEASURES, SURFACE
from contactsim.errors import SceneError
from contactsim.evaluation.calibration.sampling import draw
from contactsim.provenance import computing_digest, digest, source_digest
from contactsim.solvers.registry import DEFAULT_SOLVERS, solver_module
from contactsim.study.keys import is_smooth
from contactsim.study.scenes import scene_of

GRIDS = (1 / 8, 1 / 5.7, 1 / 4, 1 / 2.8, 1 / 2, 1 / 1.4, 1.0, 1.4, 2.0)
"""Grids of the ladder, over the final one's points."""
PACES, TOLERANCES = (4.0, 2.0, 1.0), (10.0, 1.0)
"""Increments and tolerances of the ladder, over the final ones."""
SYMBOLS = {"reduced_pressure": "p*", "contact_ratio": "c/R"}
"""Loads in words."""
FINER = {LINE: 6.0, SURFACE: 3.0}
"""How many times finer the grid of the reference is than the final one; along paths three times."""
PATH_FINER, PACE, TIGHTER = 3.0, 0.25, 0.1
"""Of a reference along a path: its grid's points, increments, tolerance, over the final ones."""


def names(settings: dict) -> list[str]:
    """Of all trials, as files have them."""
    return [f"{kind}_{count}" for kind in settings["kinds"] for count in range(settings["trial"]["scenes"])]


def plan(settings: dict, kind: str, count: int) -> dict:
    """What one trial depends on."""
    solvers = [solver_module(name) for name in DEFAULT_SOLVERS.values()]
    source = digest(
        computing_digest("contactsim.evaluation.calibration.validation", *solvers), FILE.read_text(encoding="utf-8")
    )
    drawn = {"kinds": settings["kinds"], "trial": {"seed": settings["trial"]["seed"]}, "errors": settings["errors"]}
    return {"settings": drawn, "kind": kind, "count": count, "source": source}


def figure(settings: dict, tier: str) -> dict:
    """What the figure of all trials depends on."""
    data = [plan(settings, kind, count) for kind in settings["kinds"] for count in range(settings["trial"]["scenes"])]
    shown = {key: settings[key] for key in ("title", "caption", "size")}
    code = source_digest("contactsim.figures.diagnostics.trials")
    return {"settings": shown, "tier": tier, "seed": settings["trial"]["seed"], "source": code, "data": digest(data)}


def error_asked(settings: dict, kind: str, count: int) -> float:
    """The error asked of a scene: by turns those of the list, another at first for each kind."""
    return settings["errors"][(count + sorted(KINDS).index(kind)) % len(settings["errors"])]


def trial(settings: dict, kind: str, count: int) -> tuple[xr.Dataset, dict]:
    """One scene on trial: what is reproducible, and seconds predicted and spent."""
    run = draw(kind, settings["kinds"][kind], settings["trial"]["seed"], count).settings
    asked = error_asked(settings, kind, count)
    expected = forecast_to(run, asked)
    outcome(coarser(chosen(run, asked)), MEASURES[kind])  # loads what is compiled
    found = reach(run, asked)
    names = MEASURES[kind]
    reference = outcome(_finer(found.last, kind), names)
    tried = [(one, _error(one, reference)) for one in _ladder(found, names)]
    met = [one for one, error in tried if error <= asked]
    least = min(met, key=lambda one: one.transforms * one.size, default=None)
    work = found.work * found.last.size
    row = {
        "requested_error": asked,
        "true_error": _error(found.last, reference),
        "predicted_error": max(float(values.max()) for values in found.errors.values()),
        "solve_count": len(found.before) + 1,
        "points": found.last.points,
        "predicted_points": expected.points,
        "work": work,
        "predicted_work": expected.transforms * size_of(scene_of(run), expected.points),
        "min_work": least.transforms * least.size if least else np.nan,
        "min_work_points": least.points if least else -1,
        "settings_tried": len(tried),
        "settings_within_error": len(met),
    }
    coordinates = {"scene": [f"{kind} {count}"], "kind": ("scene", [kind])}
    data = xr.Dataset({name: ("scene", [value]) for name, value in row.items()}, coordinates)
    data = data.assign(description=("scene", [_words(run)]))
    spent = {"predicted": expected.seconds, "seconds": found.seconds, "least": least.seconds if least else math.nan}
    return dataset.described(data), spent


def _error(one: Outcome, reference: Outcome) -> float:
    """The largest relative error of all quantities."""
    return max(float(difference(reference, one, name).max()) for name in one.values)


def _finer(last: Outcome, kind: str) -> dict:
    """The settings of the reference."""
    settings = last.settings
    if not is_smooth(settings):
        return on_points(settings | {"tolerance": settings["tolerance"] * TIGHTER}, last.points * FINER[kind])
    settings = settings | {"tolerance": settings["tolerance"] * TIGHTER} | rescaled(settings, PACE)
    return on_points(settings, last.points * PATH_FINER)


def _ladder(found: Reached, names: tuple[str, ...]) -> list[Outcome]:
    """Every setting about the final one, solved on its own."""
    settings = found.last.settings
    paces = PACES if is_smooth(settings) else (1.0,)
    tolerances = TOLERANCES if not is_smooth(settings) else (1.0,)
    tried = {}
    for grid, pace, tolerance in itertools.product(GRIDS, paces, tolerances):
        one = settings | {"tolerance": settings["tolerance"] * tolerance}
        one = on_points(one | rescaled(settings, pace) if is_smooth(settings) else one, found.last.points * grid)
        tried[one["points"], pace, tolerance] = one
    return [one for one in (_solved(one, names) for one in tried.values()) if one]


def _solved(settings: dict, names: tuple[str, ...]) -> Outcome | None:
    """A setting solved, or None where it cannot be posed, as on a grid that is too coarse for its path."""
    try:
        return outcome(settings, names)
    except SceneError:
        return None


def _words(run: dict) -> str:
    """A scene in a few words: what was drawn."""
    surface, load, body = run["surface"], run["load"], run.get("counter_body") or run["body"]
    if "hurst" in surface:
        parts = [
            f"H {surface['hurst']:.2g}",
            f"λr/λs {surface['rolloff_wavelength'] / surface['shortest_wavelength']:.0f}",
        ]
    else:
        parts = [f"{surface['kind']} R {surface['radius'] / 1000:.3g} µm"]
    if "values" in load:
        parts.append(f"{SYMBOLS[load['name']]} {load['values'][0]:.2g}")
    law = next((run[name] for name in run["effects"] if run.get(name)), None)
    if law is not None:
        deepest = run["slide"]["approach"] if "slide" in run else load["through"][-1]
        parts += [f"φn {law['work_of_separation']:.2g} N/m", f"φt/φn {law['work_ratio']:.2g}"]
        parts += [f"ν {body['poisson_ratio']:.2g}", f"δ {deepest:.3g} nm"]
    return ", ".join(parts)
