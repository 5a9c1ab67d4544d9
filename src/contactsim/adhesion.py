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

INTERACTING = {
    "interacting_length_tenth": 1e-1,
    "interacting_length_hundredth": 1e-2,
    "interacting_length_thousandth": 1e-3,
}
"""Parts of the strength beyond which two surfaces interact."""
SUMMARY = (
    "pull_off_load_loading",
    "pull_off_approach_loading",
    "pull_off_load_unloading",
    "pull_off_approach_unloading",
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

    load and friction_force, N/m; repulsive_length, lengths for `INTERACTING`, smallest_gap, nm;
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
    numbers |= {name: float(spacing * (size > level).sum()) for name, level in INTERACTING.items()}
    for row in range(1, len(gap)):
        slip = float(np.abs(gap[row]).max(where=repulsive, initial=0.0))
        numbers["slip"] = slip / min(law.tangential_length for law in problem.laws if "t" in law.reads)
    for row in range(1, len(traction)):
        numbers["friction_force"] = float(traction[row].mean() * length)
    return numbers


def pull_off(approach: Array, load: Array) -> tuple[float, float, float, float]:
    """Largest pull (N/m) and its approach (nm) on loading, then on unloading; NaN where there is no such leg.

    approach, load: (step,). Loading is up to the first largest approach, unloading what follows.
    """
    turn, found = int(np.argmax(approach)) + 1, []
    for leg in (slice(0, turn), slice(turn, None)):
        pull = -load[leg]
        known = pull.size > 0 and not np.isnan(pull).all()
        place = int(np.nanargmax(pull)) if known else 0
        found += [float(pull[place]), float(approach[leg][place])] if known else [np.nan, np.nan]
    return tuple(found)


def summarised(data: xr.Dataset) -> xr.Dataset:
    """A study of paths with what its curves amount to: pull-off, and the contact at the largest approach."""
    converged = data.line_load.where(data.status == 0)
    columns = xr.apply_ufunc(
        pull_off,
        *(data.approach, converged),
        input_core_dims=[["step"], ["step"]],
        output_core_dims=[[]] * 4,
        vectorize=True,
    )
    data = data.assign(dict(zip(SUMMARY[:4], columns, strict=True)))
    last = data.approach.argmax("step")
    return data.assign(
        final_repulsive_length=data.repulsive_length.isel(step=last), final_load=data.line_load.isel(step=last)
    )
