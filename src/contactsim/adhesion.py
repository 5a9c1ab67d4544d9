"""What is read off a state of smooth laws, and off a path through such states.

Loads are forces per unit thickness (N/m), compression positive (Eq. 4.2). Contact is `repulsive` where the normal gap
is negative, to a fraction of a node, or `interacting` where the traction exceeds a part of the laws' strength. A path
is cut into loading and unloading where the approach turns.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.interface import InterfaceProblem

THRESHOLDS = (1e-1, 1e-2, 1e-3)
"""Parts of the strength beyond which two surfaces interact."""

LEGS = ("loading", "unloading")
SUMMARY = (
    *(f"pull_off_{what}_{leg}" for what in ("load", "approach") for leg in LEGS),
    "final_repulsive_length",
    "final_load",
)
"""What a path amounts to."""


def repulsive_length(gap: Array, spacing: float) -> float:
    """Length, nm, over which the normal gap (n,), nm, is negative; its ends lie between nodes, to second order."""
    after = np.roll(gap, -1)
    inside, crossing = (gap < 0) & (after < 0), (gap < 0) != (after < 0)
    ends = np.minimum(gap, after)[crossing]
    return float(spacing * (inside.sum() + (ends / (ends - np.maximum(gap, after)[crossing])).sum()))


def state_observables(problem: InterfaceProblem, gap: Array, traction: Array) -> dict[str, float]:
    """Numbers of one state; gap (components, n), nm; traction (exerted, n), GPa.

    load and friction_force, N/m; repulsive_length, interacting lengths for `THRESHOLDS`, smallest_gap, nm;
    overclosure: deepest overlap, and slip: largest tangential gap where there is repulsion, over the laws' lengths.
    """
    spacing, length = problem.grid.spacing[0], problem.grid.lengths[0]
    size = np.abs(traction[0]) / problem.strength
    repulsive = gap[0] < 0
    numbers = {
        "line_load": float(-traction[0].mean() * length),
        "repulsive_length": repulsive_length(gap[0], spacing),
        "smallest_gap": float(gap[0].min()),
        "overclosure": float(max(-gap[0].min(), 0.0) / problem.reach),
    }
    numbers |= {f"interacting_length_{level:g}": float(spacing * (size > level).sum()) for level in THRESHOLDS}
    for row in range(1, len(gap)):
        slip = float(np.abs(gap[row]).max(where=repulsive, initial=0.0))
        numbers["slip"] = slip / min(law.tangential_length for law in problem.laws if "t" in law.reads)
    for row in range(1, len(traction)):
        numbers["friction_force"] = float(traction[row].mean() * length)
    return numbers


def pull_off(approach: Array, load: Array) -> dict[str, float]:
    """Largest pull (N/m) and its approach (nm), on loading and on unloading; NaN where there is no such leg.

    approach, load: (step,). Loading is up to the first largest approach, unloading what follows.
    """
    turn = int(np.argmax(approach)) + 1
    found = {}
    for name, part in zip(LEGS, (slice(0, turn), slice(turn, None)), strict=True):
        pull = -load[part]
        known = pull.size > 0 and not np.isnan(pull).all()
        place = int(np.nanargmax(pull)) if known else 0
        found[f"pull_off_load_{name}"] = float(pull[place]) if known else np.nan
        found[f"pull_off_approach_{name}"] = float(approach[part][place]) if known else np.nan
    return found


def summarised(data: xr.Dataset) -> xr.Dataset:
    """A study of paths with what its curves amount to: pull-off, and the contact at the largest approach."""
    names = SUMMARY[:4]

    def per_path(approach: Array, load: Array) -> tuple[float, ...]:
        found = pull_off(approach, load)
        return tuple(found[name] for name in names)

    converged = data.line_load.where(data.status == 0)
    columns = xr.apply_ufunc(
        per_path,
        *(data.approach, converged),
        input_core_dims=[["step"], ["step"]],
        output_core_dims=[[]] * len(names),
        vectorize=True,
    )
    data = data.assign(dict(zip(names, columns, strict=True)))
    last = data.approach.argmax("step")
    return data.assign(
        final_repulsive_length=data.repulsive_length.isel(step=last), final_load=data.line_load.isel(step=last)
    )
