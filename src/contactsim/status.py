"""Status of a solution, and the limits within which its model describes reality."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from enum import Enum

import numpy as np
import xarray as xr

logger = logging.getLogger(__name__)


class Status(Enum):
    """End of a solution; the number is stored in datasets, the sentence explains it."""

    CONVERGED = (0, "converged: the certificate, recomputed from scratch, is within the tolerance")
    MAX_ITERATIONS = (1, "not converged: the largest number of iterations is reached")
    NON_FINITE = (2, "failed: a value that is not finite appeared")
    NO_EQUILIBRIUM = (
        3,
        "no equilibrium: the load pulls the bodies apart or presses them through each other, "
        "or the approach is larger than the mean gap",
    )
    SKIPPED = (4, "skipped: the path ended at an earlier step")
    INTERPOLATED = (5, "interpolated: between two solutions, to the error allowed for increments")
    NO_REST = (6, "no rest: under a held load the surfaces move on and on, as friction without a potential allows")
    INEXACT = (7, "not exact: the residual, recomputed from scratch, is larger than the tolerance")
    OVER_BUDGET = (8, "over budget: the state takes more transforms than granted; earlier states are kept")
    UNLOCATED = (
        9,
        "not located: an equilibrium, but no work was left to locate the jumps on the way; "
        "shorter increments may lead elsewhere",
    )

    @property
    def sentence(self) -> str:
        """Meaning of the status."""
        return self.value[1]

    @property
    def solved(self) -> bool:
        """True where there is a solution, or one interpolated between solutions."""
        return self in (Status.CONVERGED, Status.INTERPOLATED, Status.UNLOCATED)

    @property
    def summary(self) -> str:
        """Meaning in a word where there is a solution, else in a sentence."""
        return self.sentence.partition(":")[0] if self.solved else self.sentence


def status_summary(number: int) -> str:
    """Return the meaning of the number of a status; see `Status.summary`."""
    return next(status.summary for status in Status if status.value[0] == number)


def is_solved(numbers: xr.DataArray) -> xr.DataArray:
    """Return True where the number of a status stands for a solution, bool."""
    return numbers.isin([status.value[0] for status in Status if status.solved])


LIMITS = {
    "max_interpenetration": (3.0, "overlap over the laws' length"),
    "slip": (2.0, "slip under repulsion over the laws' length"),
    "process_zone_step": (0.2, "grid spacing over the process zone"),
    "rms_gradient": (0.45, "rms slope"),
    "wave_step": (0.25, "grid spacing over the shortest wavelength"),
    "yielding_share": (0.0, "share of the contact above the hardness"),
}
"""Largest value of each number, and its name in words.

Beyond that overlap the laws' repulsion grows too slowly; beyond that slip shear removes the repulsion of a coupled law.
With steps of a fifth of the process zone e²E*δn²/φn the pull-off is off by 0.02 %; with longer ones it jumps from point
to point. Small slopes leave out half of their square, a tenth at this limit. With four points to the shortest
wavelength the corrected contact area of rough surfaces changes by 0.5 to 14 % when the grid is halved (H from 0.8 to
0.2, p* from 0.4 to 0.001).
"""
FLAGS = {name: 1 << place for place, name in enumerate(LIMITS)}
"""Bits of `validity_flags`, one for each limit."""


def process_zone(contact_modulus: float, strength: float, interaction_range: float) -> float:
    """Return the length (nm) over which tractions fall, e²E*δn²/φn.

    Parameters
    ----------
    contact_modulus : float
        E*, GPa.
    strength : float
        φn/(e δn), GPa.
    interaction_range : float
        δn, nm.
    """
    return float(np.e * contact_modulus * interaction_range / strength)


def validity_flags(numbers: Mapping[str, float]) -> int:
    """Return the limits that a state's numbers exceed, as bits of `FLAGS`; a missing number exceeds none."""
    return sum(FLAGS[name] for name, (limit, _) in LIMITS.items() if numbers.get(name, 0.0) > limit)


def warn_of_excess(data: xr.Dataset) -> None:
    """Warn where solved states of a dataset are beyond what the model describes."""
    for words in describe_excess(data):
        logger.warning("beyond what the model describes: %s of the states", words)


def describe_excess(data: xr.Dataset) -> list[str]:
    """Return in words which limits the solved states of a dataset exceed, by how much, and how many do."""
    texts = []
    solved = is_solved(data.status)
    flags = data.validity_flags.where(solved, 0).fillna(0).astype(int)
    for name, (limit, words) in LIMITS.items():
        count, solutions = int(((flags & FLAGS[name]) > 0).sum()), int(solved.sum())
        if count:
            part = "all" if count == solutions else f"{100 * count / solutions:.3g} %"
            largest = float(data[name].where(solved).max())
            texts.append(f"{words} up to {largest:.2g} (limit {limit:g}) in {part}")
    return texts
