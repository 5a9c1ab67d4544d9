"""Numbers of states of sliding contacts, and of their slips.

A slip is a jump of the surface along a slide, known by the states on both sides of it, a few thousandths of a nanometre
of the slide apart. Trailing is the edge that the upper body, sliding along x, moves away from; positions are those of
the undeformed upper surface, from its highest point. A contact whose gap is zero to rounding all over, as of flats, has
no length.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from contactsim.grid import Array

if TYPE_CHECKING:
    from contactsim.contact.cohesive import CohesiveProblem

EVENT = (
    "event_step",
    "event_sliding_distance",
    "event_width",
    "event_force_before",
    "event_force_after",
    "event_length_before",
    "event_length_after",
    "event_released_energy",
    "event_slip",
)
"""Numbers of each slip."""
TOUCHING = 1e-4
"""Mean gap, nm, within which surfaces touch all over, and neither overlap nor are apart."""


def slide_observables(problem: CohesiveProblem, gap: Array, displacement: Array) -> dict[str, float]:
    """Return the numbers of one state on a slide.

    Parameters
    ----------
    problem : CohesiveProblem
        The problem that it solves.
    gap : array, shape (2, n)
        Gap, nm.
    displacement : array, shape (exerted, m)
        Coefficients of the displacement, nm.

    Returns
    -------
    dict
        sliding_distance, nm; contact_trailing_edge and contact_leading_edge, the outermost edges under repulsion, nm,
        NaN without; contact_slip, the mean tangential gap where surfaces are closest, nm; elastic_energy, nJ/m.
    """
    close = gap[0] <= gap[0].min() + problem.law.interaction_range
    weighted = problem.elastic(displacement) * problem.mode_weights
    trailing, leading = contact_ends(gap[0], problem.shape[0], problem.grid.spacing[0])
    return {
        "sliding_distance": problem.sliding_distance,
        "contact_trailing_edge": trailing,
        "contact_leading_edge": leading,
        "contact_slip": float(gap[1, close].mean()),
        "elastic_energy": 0.5 * float(np.vdot(displacement, weighted).real) * problem.grid.lengths[0],
    }


def contact_ends(gap: Array, shape: Array, spacing: float) -> tuple[float, float]:
    """Return the first and the last place with a negative gap (n,), between nodes, nm from the least `shape`.

    NaN where there is none; minus and plus half a period where there is contact all over.
    """
    count = gap.size
    middle = int(np.argmin(shape))
    here = np.roll(gap, count // 2 - middle)
    inside = np.flatnonzero(here < 0)
    if not inside.size:
        return np.nan, np.nan
    ends = []
    for place, beside in ((inside[0], inside[0] - 1), (inside[-1], inside[-1] + 1)):
        share = 0.5 if not 0 <= beside < count else here[place] / (here[place] - here[beside])
        ends.append((place + (beside - place) * share - count // 2) * spacing)
    return float(ends[0]), float(ends[1])


def join_slips(slips: Sequence[Mapping[str, float]]) -> xr.Dataset:
    """Return slips along dimension `event`; one of NaN where there is none."""
    rows = slips or [dict.fromkeys(EVENT, np.nan)]
    columns = {name: ("event", np.array([row[name] for row in rows], float)) for name in EVENT}
    return xr.Dataset(columns, {"event": np.arange(len(rows))})
