"""What would decide a statement that is not decidable: more members, a smaller error of the grid, or more onsets."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

from contactsim.analysis.uncertainty import MIN_MARGIN
from contactsim.durations import duration_text


def members_needed(row: Mapping[str, Any]) -> float:
    """Return the number of members with which the same number would be decided; infinite if no number would do.

    The ensemble error falls with the square root of the number of members; that of grid and increments stays.

    Parameters
    ----------
    row
        Number of a statement with `margin`, `ensemble_error`, `grid_error` and `members`.
    """
    ensemble_error, grid_error = row["ensemble_error"], row["grid_error"]
    allowed = distance_to_edge(row) / MIN_MARGIN
    if not ensemble_error or allowed <= grid_error:
        return math.inf
    return math.ceil(row["members"] * ensemble_error**2 / (allowed**2 - grid_error**2))


def distance_to_edge(row: Mapping[str, Any]) -> float:
    """Return the distance of a number to the edge of its band."""
    return float(row["margin"]) * math.hypot(row["ensemble_error"], row["grid_error"])


@dataclass(frozen=True)
class Effort:
    """What the study that decides a statement has cost.

    Attributes
    ----------
    seconds
        CPU time of all its members.
    doubling
        Factor of the CPU time on doubling the points; NaN where no coarse grid tells.
    approaches
        Number of approaches, of a study that has several.
    """

    seconds: float
    doubling: float = math.nan
    approaches: int = 1

    @classmethod
    def of_costs(cls, costs: pd.DataFrame) -> Effort:
        """Return the effort by a study's table of costs."""
        own = costs[~costs.measures_error]
        coarse = costs[costs.measures_error & (costs.points * 2 == own.points.max())]
        doubling = own.seconds.mean() / coarse.seconds.mean() if len(coarse) else math.nan
        approaches = own.slide_approach.nunique() if "slide_approach" in own else 1
        return cls(float(own.seconds.sum()), float(doubling), approaches)


def deciding_text(row: Mapping[str, Any], effort: Effort) -> str:
    """Return in words what would decide a statement, and its cost; nothing where an error is not known.

    row: as in `members_needed`, with `decided_over`, which is "approaches" for a line through the onsets at several and
    "grids" for members on several grids
    """
    if not math.isfinite(distance_to_edge(row)):
        return ""
    most = distance_to_edge(row) / MIN_MARGIN
    if row.get("decided_over") == "approaches":
        each = _time_text(effort.seconds / effort.approaches)
        return f"more approaches ({each} each), until leaving out one changes the number by less than {most:.2g}"
    needed, members = members_needed(row), row["members"]
    if math.isinf(needed):
        doublings = _doublings_text(row, most, effort)
        return f"an error of grid and increments below {most:.2g}; more members alone do not{doublings}"
    cost = (needed / members - 1) * effort.seconds
    cost_text = f", {_time_text(cost)} more" if cost > 0 else ""
    if row.get("decided_over") == "grids":
        return f"{needed / members:.2g} times the members on both grids{cost_text}, if the number stays"
    return f"{needed:.0f} members in place of {members:.0f}{cost_text}, if the number stays"


def _doublings_text(row: Mapping[str, Any], most: float, effort: Effort) -> str:
    """Return in words how often the points are doubled, with how many members, until the error is small enough."""
    if not math.isfinite(effort.doubling):
        return ""
    ensemble_error = min(row["ensemble_error"], most / math.sqrt(2))  # the rest is left to the grid
    doublings = math.ceil(math.log2(row["grid_error"] / math.sqrt(most**2 - ensemble_error**2)))
    members = (row["ensemble_error"] / ensemble_error) ** 2 if ensemble_error else 1.0
    more = f", {members:.2g} times the members" if members > 1 else ""
    cost = _time_text(members * effort.seconds * effort.doubling**doublings)
    return f" (at first order the points doubled {doublings} times{more}, {cost})"


def _time_text(seconds: float) -> str:
    """Return CPU time in words."""
    return f"{duration_text(seconds)} of one core"
