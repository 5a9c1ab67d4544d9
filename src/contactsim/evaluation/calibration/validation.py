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
from contactsim.contact.scene import ProblemKind
from contactsim.error_control.control import (
    Controlled,
    Solution,
    relative_difference,
    solve_setup,
    solve_to_error,
)
from contactsim.error_control.forecast import forecast_to_error
from contactsim.error_control.options import choose_options, coarsen, scale_increment, set_grid
from contactsim.error_control.scaling import FAMILIES, FILE, LINE, QUANTITIES, SURFACE
from contactsim.errors import InputError
from contactsim.evaluation.calibration.sampling import draw
from contactsim.paths.options import Setup
from contactsim.provenance import computing_digest, digest, source_digest
from contactsim.solvers.registry import DEFAULT_SOLVERS, solver_module

GRIDS = (1 / 8, 1 / 5.7, 1 / 4, 1 / 2.8, 1 / 2, 1 / 1.4, 1.0, 1.4, 2.0)
"""Grids of the ladder, over the final one's points."""
FACTORS = {
    ProblemKind.HARD_WALL: ((1.0,), (10.0, 1.0)),
    ProblemKind.COHESIVE: ((4.0, 2.0, 1.0), (1.0,)),
}
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
    return settings["errors"][(count + sorted(FAMILIES).index(kind)) % len(settings["errors"])]


def trial(settings: dict, kind: str, count: int) -> tuple[xr.Dataset, dict]:
    """One scene on trial: what is reproducible, and seconds predicted and spent."""
    run = draw(kind, settings["kinds"][kind], settings["trial"]["seed"], count)
    setup, wanted = run.setup, error_asked(settings, kind, count)
    expected = forecast_to_error(setup, wanted)
    solve_setup(coarsen(choose_options(setup, wanted)), QUANTITIES[kind])  # loads what is compiled
    result = solve_to_error(setup, wanted)
    names = QUANTITIES[kind]
    reference = solve_setup(REFERENCES[setup.scene.kind](result.last.setup, kind), names)
    tried = [(solution, _error(solution, reference)) for solution in _ladder(result, names)]
    met = [solution for solution, error in tried if error <= wanted]
    least = min(met, key=lambda solution: solution.transforms * solution.size, default=None)
    work = result.work * result.last.size
    row = {
        "requested_error": wanted,
        "true_error": _error(result.last, reference),
        "predicted_error": max(float(values.max()) for values in result.errors.values()),
        "solve_count": len(result.before) + 1,
        "points": result.last.points,
        "predicted_points": expected.points,
        "work": work,
        "predicted_work": expected.transforms * setup.with_options(points=expected.points).size,
        "min_work": least.transforms * least.size if least else np.nan,
        "min_work_points": least.points if least else -1,
        "settings_tried": len(tried),
        "settings_within_error": len(met),
    }
    coordinates = {"scene": [f"{kind} {count}"], "kind": ("scene", [kind])}
    data = xr.Dataset({name: ("scene", [value]) for name, value in row.items()}, coordinates)
    data = data.assign(description=("scene", [_words(run.settings)]))
    spent = {"predicted": expected.seconds, "seconds": result.seconds, "least": least.seconds if least else math.nan}
    return dataset.described(data), spent


def _error(solution: Solution, reference: Solution) -> float:
    """Return the largest relative error of all quantities."""
    return max(float(relative_difference(reference, solution, name).max()) for name in solution.values)


def _load_reference(setup: Setup, kind: str) -> Setup:
    """Return a finer grid and a tighter tolerance for loads at a hard wall."""
    tight = setup.with_options(tolerance=setup.options.tolerance * TIGHTER)
    return set_grid(tight, setup.points * FINER[kind])


def _path_reference(setup: Setup, kind: str) -> Setup:
    """Return a finer grid, shorter increments and a tighter tolerance for a path of cohesive laws."""
    tight = scale_increment(setup.with_options(tolerance=setup.options.tolerance * TIGHTER), PACE)
    return set_grid(tight, setup.points * PATH_FINER)


REFERENCES = {ProblemKind.HARD_WALL: _load_reference, ProblemKind.COHESIVE: _path_reference}


def _ladder(result: Controlled, names: tuple[str, ...]) -> list[Solution]:
    """Return every setting about the final one, solved on its own."""
    last = result.last.setup
    tried = {}
    for grid, pace, tolerance in itertools.product(GRIDS, *FACTORS[last.scene.kind]):
        setup = last.with_options(tolerance=last.options.tolerance * tolerance)
        setup = set_grid(scale_increment(setup, pace), last.points * grid)
        tried[setup.points, pace, tolerance] = setup
    return [solution for solution in (_solved(setup, names) for setup in tried.values()) if solution]


def _solved(setup: Setup, names: tuple[str, ...]) -> Solution | None:
    """Return a setting solved; None where it cannot be posed, as on a grid that is too coarse for its path."""
    try:
        return solve_setup(setup, names)
    except InputError:
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
