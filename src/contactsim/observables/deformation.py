"""Numbers of a path that say how the surface deforms while two smooth bodies adhere.

The gap about the largest pull on loading says if the pull drops because points come closer than the law's length. The
normal displacement at the first snapshot says how far the surface is pulled up, and what the rest of it does meanwhile.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.adhesion import TURN_TOLERANCE, legs
from contactsim.status import is_solved

DEFORMATION = (
    "gap_at_pull_off_loading",
    "gap_after_pull_off_loading",
    "peak_displacement",
    "far_displacement",
)
"""Numbers of the deformation along a path."""


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


def summarise_deformation(data: xr.Dataset) -> xr.Dataset:
    """Return paths with the numbers `DEFORMATION`; NaN where a state did not converge or its fields were not kept.

    data: with the summaries of load curves
    """
    at = after = peak = far = xr.full_like(data.pull_off_approach_loading, np.nan)
    if "min_gap" in data:
        at, after = xr.apply_ufunc(
            gaps_about_pull_off,
            data.approach,
            data.min_gap.where(is_solved(data.status)),
            data.pull_off_approach_loading,
            input_core_dims=[["step"], ["step"], []],
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
    return data.assign(dict(zip(DEFORMATION, (at, after, peak, far), strict=True)))
