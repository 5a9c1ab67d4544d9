"""Rules that admit a candidate for the cell of the probe: by contact mechanics, before any statement is judged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.analysis.candidate_shares import DRAWN, SETS
from contactsim.analysis.scales import LawScales, radius
from contactsim.grid import Array
from contactsim.reference import adhesion


@dataclass(frozen=True)
class Limits:
    """Limits of what admits a candidate, as `admit` in config/identification.yaml says."""

    friction: float
    replicas: float
    slope: float
    start: float
    min_isolated: int
    pulls_to: float
    presses_from: float


@dataclass(frozen=True)
class AdmissionNumbers:
    """Numbers that admit a candidate; NaN where a state is unknown.

    Attributes
    ----------
    friction
        Largest static friction over the longest contact before the slide times the strength of a spring.
    replicas
        Largest change of load and contact length before the slide on doubling the period, over the largest of each.
    slope
        Slope of the probe at the edge of its longest contact.
    start
        Load at the first state, δ0, over the largest load before a slide.
    """

    friction: float
    replicas: float
    slope: float
    start: float

    @classmethod
    def of(cls, strong: xr.Dataset, doubled: xr.Dataset) -> AdmissionNumbers:
        """Return the numbers of a candidate from its strong interface, in its own and in the doubled period."""
        strong, doubled = (data.isel(member=0) for data in (strong, doubled))
        length, load = strong.initial_contact_length.values, strong.initial_load.values
        law = LawScales.of(strong)
        strength = float(adhesion.tangential_strength(law.tangential_work, law.tangential_length, 0.0))
        changes = [
            _relative_change(strong[name].values, doubled[name].values)
            for name in ("initial_load", "initial_contact_length")
        ]
        longest = float(length.max())
        forces = strong.static_friction.values[np.isfinite(strong.static_friction.values)]
        largest = float(forces.max()) if forces.size else np.nan
        start = np.abs(strong.line_load.isel(step=0).values).max()
        with np.errstate(divide="ignore", invalid="ignore"):
            return cls(
                float(np.divide(largest, longest * strength)),
                float(np.max(changes)),
                longest / 2 / radius(strong),
                float(np.divide(start, np.abs(load).max())),
            )

    def is_sound(self, limits: Limits) -> bool:
        """Return True with friction, small slopes and no traction at the start; an unknown number is not sound."""
        return self.friction >= limits.friction and self.slope < limits.slope and self.start < limits.start

    def is_isolated(self, limits: Limits) -> bool:
        """Return True if replicas do not interact; not if it is unknown."""
        return self.replicas < limits.replicas


def _relative_change(values: Array, others: Array) -> float:
    """Return the largest difference over the largest value; both may cross zero."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.divide(np.abs(values - others).max(), np.abs(values).max()))


def admit(candidates: pd.DataFrame, min_isolated: int) -> pd.DataFrame:
    """Return a table of candidates with the columns `SETS`.

    Parameters
    ----------
    candidates
        With the columns candidate, sound, isolated and signs; a candidate may have several rows.
    min_isolated
        Number of sound and isolated drawn candidates below which those that are not isolated are admitted too.
    """
    apart = candidates.sound & candidates.isolated
    drawn = candidates.candidate.str.fullmatch(DRAWN)
    few = candidates.candidate[apart & drawn].nunique() < min_isolated
    admitted = candidates.sound if few else apart
    return candidates.assign(**dict(zip(SETS, (admitted, admitted & candidates.signs, apart), strict=True)))


def has_signs_of_text(strong: xr.Dataset, limits: Limits) -> bool:
    """Return True if the load before the slide pulls and presses at the approaches at which the text says so."""
    load, approach = strong.initial_load.isel(member=0).values, strong.slide_approach.values
    return bool((load[approach <= limits.pulls_to] < 0).all() and (load[approach >= limits.presses_from] > 0).all())
