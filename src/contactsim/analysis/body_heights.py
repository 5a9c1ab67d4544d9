"""Load curves of rough contacts on bodies of finite height, from those on a half-space.

On a half-space the mean displacement is zero by convention. A body of height h adds p h/C11 to the approach, and at
given approach its contacts are compressed less.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr
from scipy.interpolate import PchipInterpolator

from contactsim import dataset
from contactsim.analysis.ensemble import converged
from contactsim.analysis.rough_paths import with_indentation
from contactsim.analysis.scales import body_settings
from contactsim.grid import Array
from contactsim.observables.body_readings import CHAPTER_4_HEIGHT, is_beyond_all_before
from contactsim.reference import hard_wall

SAMPLES = 241
"""Approaches at which curves are compared."""
Curve = tuple[Array, Array]
"""Approach beyond first touch, nm, and mean pressure over E*, both (step,)."""
Studies = tuple[xr.Dataset, xr.Dataset, xr.Dataset]
"""Paths with adhesion, against a hard wall, and by repulsion alone."""
DIFFERENCES = ("works", "works_and_wall", "repulsion")
"""Kinds of difference between load curves."""


def curve_of_body(data: xr.Dataset, height: float) -> Curve:
    """Return the mean load curve of one variant on a body of a height, nm; 0 stands for a half-space.

    States that the body passes in a jump, because it is more compliant than the contact, are left out: the approach
    never falls back.
    """
    data, body = with_indentation(data), body_settings(data)
    pressure = converged(data.normalised_pressure, data).mean("member", skipna=False).values
    mean_pressure = pressure * float(np.mean(data.contact_modulus))
    compression = hard_wall.body_compression(mean_pressure, height, body["youngs_modulus"], body["poisson_ratio"])
    approach = data.indentation.values + compression
    is_known = np.isfinite(approach)
    approach, pressure = approach[is_known], pressure[is_known]
    rises = is_beyond_all_before(approach)
    return approach[rises], pressure[rises]


def largest_difference(curves: Sequence[Curve]) -> float:
    """Return the largest difference of pressure between any two curves at one approach, over the largest pressure.

    Curves are compared from first touch on, as far as all of them go, with the largest pressure of any of them there.
    """
    last = min(float(approach[-1]) for approach, _ in curves)
    at = np.linspace(0.0, last, SAMPLES)
    pressures = np.array([PchipInterpolator(*curve)(at) for curve in curves])
    return float(np.ptp(pressures, axis=0).max() / pressures.max())


def heights_to_compare(data: xr.Dataset) -> list[float]:
    """Return 0 for the half-space, then the roll-off wavelength, Chapter 4's height, the period and twice it, nm."""
    length = float(np.max(data.length))
    roll_off = float(dataset.settings_of(data)["surface"]["long_cutoff"])
    return [0.0, roll_off, CHAPTER_4_HEIGHT, length, 2 * length]


def compare_heights(studies: Studies, heights: Sequence[float]) -> pd.DataFrame:
    """Return the largest differences between load curves, one row a height, with jackknife errors over the members.

    Parameters
    ----------
    studies
        Paths with adhesion, against a hard wall, and by repulsion alone, the first and the last for the same works of
        separation.
    heights
        Heights of the body, nm; 0 stands for a half-space.

    Returns
    -------
    Columns: height; is_exact, False where the height is below the period, so that p h/C11 is not all that it adds;
    the largest differences between any two works, any two works or the wall, and a work and its repulsion alone:
    `works`, `works_and_wall`, `repulsion`, each with its `_error`.
    """
    members, length, rows = studies[0].member.values, float(np.max(studies[0].length)), []
    for height in heights:
        row = {"height": height, "is_exact": height == 0 or height >= length}
        parts = [_without_member(studies, member) for member in members]
        without = [_differences(part, height) for part in parts] if members.size > 1 else [[np.nan] * 3]
        errors = np.sqrt((members.size - 1) * np.var(without, axis=0))
        for name, value, error in zip(DIFFERENCES, _differences(studies, height), errors, strict=True):
            row |= {name: value, f"{name}_error": error}
        rows.append(row)
    return pd.DataFrame(rows)


def _without_member(studies: Studies, member: int) -> Studies:
    """Return the studies without one member."""
    adhesive, wall, repulsive = (study.sel(member=study.member != member) for study in studies)
    return adhesive, wall, repulsive


def _differences(studies: Studies, height: float) -> list[float]:
    """Return the differences of `compare_heights` for one height."""
    adhesive, wall, repulsive = studies
    works = adhesive.work_of_separation.values
    curves = [curve_of_body(adhesive.sel(work_of_separation=work), height) for work in works]
    alone = [curve_of_body(repulsive.sel(work_of_separation=work), height) for work in works]
    pairs = zip(curves, alone, strict=True)
    return [
        largest_difference(curves),
        largest_difference([*curves, curve_of_body(wall, height)]),
        max(largest_difference(pair) for pair in pairs),
    ]
