"""Judge the statements of the thesis: the number, the errors and the verdict of each claim.

A claim of the config names a quantity, its reduction to one number, and the band that the statement allows. The number
comes from the means over members. Its ensemble error is a jackknife over members. Its grid error is its change when
all means move by their grid errors. Of a grid error only the size is stored. The points of one quantity move together,
because the sign of the error was the same at every load and Hurst exponent of rough lines. Of two quantities the worst
combination counts. The grid error of a cylinder comes from rounding two edges to grid points; here the rule
understates the error of a spread.

The rule: let e be both errors in quadrature, and d the distance from the number to the nearest edge of the band. If
e ≥ d, or if e is unknown, the claim is not decidable: a finer grid or more members could change the verdict. Otherwise
it is reproduced inside the band and not reproduced outside. A claim that the whole selection does not reproduce may
still be reproduced with a condition. A claim that the whole selection cannot decide is not reproduced if its condition
is not.

A condition selects loads or variants, or the thesis's own grid. On that grid the number is compared at equal
resolution, and its grid error does not count; a claim about that grid is not decidable on another. Errors are one
standard error, so a number near an edge is judged wrongly about one time in six. Noise adds to every spread, which
works against claims that something is constant. A study without randomness has no ensemble error.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.analysis.reductions import reduction_inputs
from contactsim.analysis.uncertainty import NAN, Estimate, estimate

REPRODUCED, CONDITION = "reproduced", "reproduced with a condition"
NOT_REPRODUCED, NOT_DECIDABLE = "not reproduced", "not decidable"
CONDITION_NUMBERS = ("condition_value", "condition_ensemble_error", "condition_grid_error")


def comparison_text(claim: Mapping) -> str:
    """Return what is compared, in the names of the config."""
    if claim["study"] is None:
        return ""
    inputs = [f" {name} {claim[name]}" for name in reduction_inputs(claim["reduce"])]
    ratio = "" if claim["relative_to"] is None else f" in {claim['study']} over {claim['relative_to']}"
    return f"{claim['reduce']} of {claim['quantity']}{ratio}{''.join(inputs)}"


def band(claim: Mapping) -> tuple[float, float]:
    """Return the smallest and the largest value that the statement allows."""
    if claim["expect"] is not None:
        return claim["expect"] - claim["tolerance"], claim["expect"] + claim["tolerance"]
    low = -np.inf if claim["at_least"] is None else claim["at_least"]
    high = np.inf if claim["at_most"] is None else claim["at_most"]
    return low, high


def band_text(claim: Mapping) -> str:
    """Return the band in words."""
    if claim["expect"] is not None:
        return f"{claim['expect']:g} ± {claim['tolerance']:g}"
    signs = (("at_least", "≥"), ("at_most", "≤"))
    return " ".join(f"{sign} {claim[key]:g}" for key, sign in signs if claim[key] is not None)


def verdict(claim: Mapping, number: Estimate) -> str:
    """Return the verdict on a number: reproduced, not reproduced or not decidable (the rule of the module)."""
    low, high = band(claim)
    distance = min(abs(number.value - low), abs(number.value - high))
    if not distance > math.hypot(number.ensemble_error, number.grid_error):
        return NOT_DECIDABLE
    return REPRODUCED if low < number.value < high else NOT_REPRODUCED


def judge(claim: Mapping, data: Sequence[xr.Dataset]) -> dict[str, object]:
    """Return the number, errors and verdict of a claim, and those of its condition where the condition decides.

    Parameters
    ----------
    claim
        Settings of the claim.
    data
        Datasets of its studies: none, one, or two for a ratio.
    """
    whole = estimate(claim, data) if data else Estimate()
    row = {"verdict": verdict(claim, whole), **vars(whole), "condition": ""} | dict.fromkeys(CONDITION_NUMBERS, NAN)
    if data and claim["condition"] is not None and row["verdict"] != REPRODUCED:
        narrower = estimate(claim, data, claim["condition"])
        decided = {REPRODUCED: CONDITION, NOT_REPRODUCED: NOT_REPRODUCED}.get(verdict(claim, narrower))
        if decided == CONDITION or (decided and row["verdict"] == NOT_DECIDABLE):
            row |= {f"condition_{name}": value for name, value in vars(narrower).items()}
            row |= {"verdict": decided, "condition": claim["condition"]["description"]}
    return row


def judge_claims(claims: Mapping[str, Mapping], data: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """Return a table with one row for each claim of a chapter; data: the dataset of each study."""
    rows = []
    for name, claim in claims.items():
        studies = {key: claim[key] or "" for key in ("study", "relative_to")}
        rows.append(
            {
                "claim": name,
                **{key: claim[key] for key in ("source", "statement")},
                "measure": comparison_text(claim),
                "expected": band_text(claim),
                **judge(claim, [data[study] for study in studies.values() if study]),
                "rationale": claim["rationale"],
                **studies,
            }
        )
    return pd.DataFrame(rows)
