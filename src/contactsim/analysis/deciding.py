"""What would decide a statement that is not decidable: more members, a smaller error of the grid, or more onsets."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from contactsim.analysis.rounding import short_number
from contactsim.analysis.uncertainty import MIN_MARGIN


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


def deciding_text(row: Mapping[str, Any]) -> str:
    """Return in words what would decide a statement, and its cost; nothing where an error is not known.

    row: as in `members_needed`, with `seconds`, the CPU time of the members there are, and `decided_over`, which is
    "approaches" for a line through the onsets at several and "grids" for members on several grids
    """
    if not math.isfinite(distance_to_edge(row)):
        return ""
    needed, members = members_needed(row), row["members"]
    most = distance_to_edge(row) / MIN_MARGIN
    if row.get("decided_over") == "approaches":
        return f"onsets at more approaches, until leaving out one of them changes the number by less than {most:.2g}"
    if row.get("decided_over") == "grids":
        return f"more members on both grids, until the error is below {most:.2g}"
    if math.isinf(needed):
        return f"an error of grid and increments below {most:.2g}; more members alone do not"
    hours = (needed / members - 1) * row["seconds"] / 3600
    cost = f", {short_number(hours)} hours of one core more" if hours > 0 else ""
    return f"{needed:.0f} members in place of {members:.0f}{cost}, if the number stays"
