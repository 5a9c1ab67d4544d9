"""Numbers of a path that say how the surface deforms while two smooth bodies adhere.

The gap about the largest pull on loading says if the pull drops because points come closer than the law's length. How
far the surface is pulled up is read at the state with the largest pull, which lies after a jump into contact. The
normal displacement at the first snapshot says what the rest of the surface does meanwhile. The slip at the last
snapshot is read where the pull is largest, at the edge of the contact.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.path_summary import TURN_TOLERANCE, legs
from contactsim.status import is_solved

DEFORMATION = (
    "gap_at_pull_off_loading",
    "gap_after_pull_off_loading",
    "pull_off_displacement",
    "peak_displacement",
    "far_displacement",
    "slip_at_largest_pull",
    "final_contact_share",
)
"""Numbers of the deformation along a path."""
DEFORMATIONS: dict[int, tuple[str, ...]] = {1: DEFORMATION, 2: ()}
"""By the number of dimensions."""
AT_ONE_STATE = DEFORMATION[3:]
"""Those of them that are read at a snapshot, or at the largest approach."""


def gaps_about_pull_off(approach: Array, gap: Array, place: float) -> tuple[float, float]:
    """Return the smallest gap (nm) of the last state up to the largest pull on loading and of the first one after it.

    Parameters
    ----------
    approach, gap
        Approach and smallest gap of each state, nm, (step,).
    place
        Approach at the largest pull, nm; NaN without one.
    """
    loading = legs(approach)[0]
    before = np.flatnonzero(approach[loading] <= place + TURN_TOLERANCE)
    after = np.flatnonzero(approach[loading] > place + TURN_TOLERANCE)
    if not (before.size and after.size):
        return np.nan, np.nan
    return float(gap[loading][before[-1]]), float(gap[loading][after[0]])


def gap_errors_about_pull_off(approach: Array, gap: Array, place: float) -> tuple[float, float]:
    """Return what the increments leave open in the gaps of `gaps_about_pull_off`: their changes to the state beyond.

    approach, gap, place: as there
    """
    loading = legs(approach)[0]
    here, gaps = approach[loading], gap[loading]
    last = int(np.count_nonzero(here <= place + TURN_TOLERANCE)) - 1
    if not 0 <= last < here.size - 1:
        return np.nan, np.nan
    errors = [abs(gaps[last] - gaps[max(last - 1, 0)]), abs(gaps[min(last + 2, here.size - 1)] - gaps[last + 1])]
    return float(errors[0]), float(errors[1])


def displacement_at_largest_pull(approach: Array, gap: Array, load: Array) -> tuple[float, float]:
    """Return how far the surface is pulled up below the peak at the state with the largest pull on loading, nm.

    The second number is what the increments leave open: the least change to a state beside it. Beside a jump that is
    the change on its own branch. Both are NaN where the largest pull is at the first or the last state, or is none.

    Parameters
    ----------
    approach, gap, load
        Approach and smallest gap, nm, and load, N/m, of each state, (step,); gap and load are NaN without a solution.
    """
    loading = legs(approach)[0]
    pull, pulled_up = -load[loading], -(approach + gap)[loading]  # undeformed bodies are -approach apart at the peak
    best = 0 if np.isnan(pull).all() else int(np.nanargmax(pull))
    if not (0 < best < pull.size - 1 and pull[best] > 0):
        return np.nan, np.nan
    return float(pulled_up[best]), float(np.fmin(*np.abs(pulled_up[[best - 1, best + 1]] - pulled_up[best])))


def displacement_numbers(displacement: Array, heights: Array) -> tuple[float, float]:
    """Return the largest normal displacement (nm), and its mean over the half of the period furthest from the peak.

    Parameters
    ----------
    displacement
        Normal displacement of the lower relative to the upper surface, nm, (x,).
    heights
        Heights of the upper surface, nm, (x,); the largest is its peak.
    """
    count = heights.size
    from_peak = np.roll(displacement, count // 2 - int(np.argmax(heights)))
    far = np.concatenate((from_peak[: count // 4], from_peak[count - count // 4 :]))
    return float(displacement.max()), float(far.mean())


def slip_at_largest_pull(traction: Array, slip: Array) -> float:
    """Return the size of the tangential gap (nm) at the node with the largest pull; NaN where fields are unknown.

    Parameters
    ----------
    traction
        Normal traction, GPa, (x,); pull is positive.
    slip
        Tangential gap, nm, (x,).
    """
    return float(abs(slip[int(np.argmax(traction))])) if np.isfinite(traction).all() else np.nan


def summarise_deformation(data: xr.Dataset) -> xr.Dataset:
    """Return paths with the numbers `DEFORMATION`; NaN where a state did not converge or its fields were not kept.

    data: with the summaries of load curves
    """
    unknown = xr.full_like(data.pull_off_approach_loading, np.nan)
    at = after = pulled_up = peak = far = slip = at_error = after_error = pulled_up_error = unknown
    if "min_gap" in data:
        solved = data[["min_gap", "line_load"]].where(is_solved(data.status))
        (at, after), (at_error, after_error) = (
            xr.apply_ufunc(
                function,
                data.approach,
                solved.min_gap,
                data.pull_off_approach_loading,
                input_core_dims=[["step"], ["step"], []],
                output_core_dims=[[], []],
                vectorize=True,
            )
            for function in (gaps_about_pull_off, gap_errors_about_pull_off)
        )
        pulled_up, pulled_up_error = xr.apply_ufunc(
            displacement_at_largest_pull,
            data.approach,
            solved.min_gap,
            solved.line_load,
            input_core_dims=[["step"]] * 3,
            output_core_dims=[[], []],
            vectorize=True,
        )
    if "normal_displacement" in data and "heights" in data:
        peak, far = xr.apply_ufunc(
            displacement_numbers,
            data.normal_displacement.isel(snapshot=0, drop=True),
            data.heights,
            input_core_dims=[["x"], ["x"]],
            output_core_dims=[[], []],
            vectorize=True,
        )
    if {"tangential_gap", "normal_traction"} <= set(data):
        last = data[["normal_traction", "tangential_gap"]].isel(snapshot=-1, drop=True)
        slip = xr.apply_ufunc(
            slip_at_largest_pull,
            last.normal_traction,
            last.tangential_gap,
            input_core_dims=[["x"], ["x"]],
            vectorize=True,
        )
    share = data.final_contact_length / data.length
    data = data.assign(dict(zip(DEFORMATION, (at, after, pulled_up, peak, far, slip, share), strict=True)))
    errors = at_error, after_error, pulled_up_error
    return data.assign({f"{name}_increment_error": error for name, error in zip(DEFORMATION[:3], errors, strict=True)})
