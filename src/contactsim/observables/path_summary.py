"""Summary of a path through states of cohesive laws: largest pulls, jumps, and the state at the largest approach.

A path is cut into loading and unloading where the approach turns first, and second.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.adhesion import CRITERION
from contactsim.observables.load_curve import CURVES, LoadCurve, curve_inputs, dimensions_of
from contactsim.observables.surface_adhesion import INTERACTING_AREA
from contactsim.status import is_solved

FINAL = {
    "final_contact_length": "contact_length",
    "final_interacting_length": CRITERION,
    "final_load": "line_load",
    "final_repulsive_load": "repulsive_load",
    "final_adhesive_load": "adhesive_load",
    "final_max_pressure": "max_pressure",
    "final_max_tensile_traction": "max_tensile_traction",
    "final_slip": "slip",
}
"""Numbers at the largest approach on a line, by the number of a state that they are."""
SURFACE_FINAL = {
    "final_contact_area": "contact_area",
    "final_interacting_area": INTERACTING_AREA,
    "final_force": "normal_force",
    "final_repulsive_force": "repulsive_force",
    "final_adhesive_force": "adhesive_force",
    "final_max_pressure": "max_pressure",
    "final_max_tensile_traction": "max_tensile_traction",
}
"""The same on a surface."""
FINALS = {1: FINAL, 2: SURFACE_FINAL}
"""By the number of dimensions."""
TURN_TOLERANCE = 1e-6
"""Changes of approach (nm) that do not turn a path."""
LEGS = ("loading", "unloading")
JUMPS = ("max_jump_loading", "max_jump_unloading")
"""Largest jumps of a path."""


def pull_off_names(word: str) -> tuple[str, ...]:
    """Return the names of the largest pulls and of their approaches; word: what the load is called there."""
    return tuple(f"pull_off_{quantity}_{leg}" for quantity in (word, "approach") for leg in LEGS)


SUMMARIES = {
    dimensions: (*pull_off_names(names.word), *JUMPS, *FINALS[dimensions]) for dimensions, names in CURVES.items()
}
"""Summary of a path by the number of dimensions; the slip only where a law reads the tangential gap."""
SUMMARY, SURFACE_SUMMARY = SUMMARIES.values()
"""On a line, and on a surface."""


def pull_off(curve: LoadCurve, word: str = "load") -> dict[str, float]:
    """Return the largest pull and its approach (nm) on loading and on unloading, with their errors.

    Both sides of a jump count as states. A leg that begins or ends with its largest pull does not pass it. A leg that
    ends without a solution passes it, as under a load that pulls the bodies apart. The increments leave an
    `_increment_error`, of `LoadCurve.extreme_errors`.

    Parameters
    ----------
    curve
        Load against approach.
    word
        What the load is called in the names of the numbers.

    Returns
    -------
    dict
        NaN where a leg does not pass its largest pull.
    """
    numbers = {}
    for name, leg in zip(LEGS, legs(curve.approach), strict=True):
        part = curve.part(slice(max(leg.start - 1, 0), leg.stop))  # from the turn on
        pull = -part.load
        best = 0 if np.isnan(pull).all() else int(np.nanargmax(pull))
        is_passed = 0 < best < pull.size - 1 and pull[best] > 0
        values = float(pull[best]), float(part.approach[best])
        errors = part.extreme_errors(best) if is_passed else (np.nan, np.nan)
        for quantity, value, error in zip((word, "approach"), values, errors, strict=True):
            numbers[f"pull_off_{quantity}_{name}"] = value if is_passed else np.nan
            numbers[f"pull_off_{quantity}_{name}_increment_error"] = error
    return numbers


def legs(approach: Array) -> tuple[slice, slice]:
    """Return the steps of loading, while the approach (step,) grows, and of unloading, until it grows again."""
    changes = np.diff(approach)
    back = np.flatnonzero(changes < -TURN_TOLERANCE)
    turn = int(back[0]) + 1 if back.size else approach.size
    again = np.flatnonzero(changes[turn:] > TURN_TOLERANCE)
    return slice(0, turn), slice(turn, turn + int(again[0]) + 1 if again.size else approach.size)


def largest_jumps(approach: Array, jump: Array) -> dict[str, float]:
    """Return the largest jump (nm) on loading and on unloading; zero without a jump, NaN without such a leg."""
    parts = zip(LEGS, (jump[part] for part in legs(approach)), strict=True)
    return {f"max_jump_{name}": float(np.nanmax(part)) if np.isfinite(part).any() else np.nan for name, part in parts}


def summarise_load_curves(data: xr.Dataset) -> xr.Dataset:
    """Return a study of paths with their summaries (`SUMMARIES`); states that did not converge do not count."""
    dimensions = dimensions_of(data)
    word = CURVES[dimensions].word
    pulls = pull_off_names(word)
    names = (*pulls, *JUMPS, *(f"{name}_increment_error" for name in pulls))

    def per_path(approach: Array, load: Array, jump: Array, *folds: Array) -> tuple[float, ...]:
        """Return the summary of one path, in the order of `names`."""
        curve = LoadCurve.from_states(approach, load, jump, folds)
        numbers = pull_off(curve, word) | largest_jumps(approach, np.where(np.isnan(load), np.nan, jump))
        return tuple(numbers[name] for name in names)

    inputs, core = curve_inputs(data)
    converged = is_solved(data.status)
    columns = xr.apply_ufunc(
        per_path,
        *inputs,
        input_core_dims=core,
        output_core_dims=[[]] * len(names),
        vectorize=True,
    )
    last = data.approach.argmax("step")
    final = {name: data[of].where(converged).isel(step=last) for name, of in FINALS[dimensions].items() if of in data}
    return data.assign(dict(zip(names, columns, strict=True)) | final)
