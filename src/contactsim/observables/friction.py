"""What a slide amounts to: the onset of sliding, friction, peeling and slips.

The onset is the state of largest tangential force before the first slip or, where sliding is smooth, of the first
maximum.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.peeling import ALONG, ERRORS, ONSET, THRESHOLD, asymmetry, quadratic_law, threshold_law
from contactsim.observables.sliding import EVENT, TOUCHING
from contactsim.status import is_solved

COLUMNS = (
    *("sliding_distance", "friction_force", "line_load", "contact_length", "mean_gap"),
    *("contact_trailing_edge", "contact_leading_edge"),
)
"""Numbers of the states that all of this comes from."""


@dataclass(frozen=True)
class Slide:
    """A slide as a line through its states and both sides of its slips.

    sliding_distance (nm), force (N/m), length (nm): (place,); after: whether a place is the far side of a slip,
    (place,); width: of the slide between both sides of it, nm; state: number of the state that a place is or follows.
    """

    sliding_distance: Array
    force: Array
    length: Array
    after: Array
    width: Array
    state: Array

    @classmethod
    def through(cls, columns: Mapping[str, Array], told: Mapping[str, Array], first: int) -> Slide:
        """Through states on a slide (state,) and slips (event,); first: step with which the slide begins."""
        places: list[tuple[float, ...]] = []
        steps = told["event_step"] - first
        for state, (sliding_distance, force, length) in enumerate(zip(*(columns[name] for name in LINE), strict=True)):
            for slip in np.flatnonzero(steps == state):
                here, width = told["event_sliding_distance"][slip], told["event_width"][slip]
                back = here - np.sign(sliding_distance - columns["sliding_distance"][state - 1]) * width
                before, after = (told[f"event_force_{side}"][slip] for side in ("before", "after"))
                lengths = [told[f"event_length_{side}"][slip] for side in ("before", "after")]
                places.append((back, before, lengths[0], 0.0, width, state - 1))
                places.append((here, after, lengths[1], 1.0, width, state - 1))
            places.append((sliding_distance, force, length, 0.0, 0.0, state))
        sliding_distance, force, length, after, width, state = np.array(places).T
        return cls(sliding_distance, force, length, after > 0, width, state.astype(int))

    @property
    def onset(self) -> int | None:
        """The place of largest force before the first slip, or of the first maximum; None if the force still rises."""
        first = np.flatnonzero(self.after)
        if first.size:
            return int(np.argmax(self.force[: first[0]]))
        falling = np.flatnonzero(np.diff(self.force) < 0)
        return int(falling[0]) if falling.size else None

    def blurred(self, place: int) -> float:
        """By how much (N/m) the force at a side of a slip may be off, which lies anywhere within its width."""
        beside = place + 1 if self.after[place] else place - 1
        if (
            not 0 <= beside < self.sliding_distance.size
            or self.sliding_distance[beside] == self.sliding_distance[place]
        ):
            return 0.0
        slope = (self.force[place] - self.force[beside]) / (
            self.sliding_distance[place] - self.sliding_distance[beside]
        )
        return float(self.width[place] * abs(slope))

    def missed(self, place: int) -> float:
        """By how much (N/m) the force may be more extreme between a place and those beside it.

        Before a slip it bends more and more, and stays within the line through the two states before; after one it is
        extreme at the slip itself; else it turns, by an eighth of the second difference.
        """
        if self.after[place]:
            return self.blurred(place)
        if place + 1 < self.sliding_distance.size and self.after[place + 1]:
            if (
                place < 2
                or self.after[place - 1]
                or self.sliding_distance[place - 1] == self.sliding_distance[place - 2]
            ):
                return float(abs(self.force[place] - self.force[place - 1])) + self.blurred(place)
            slope = (self.force[place - 1] - self.force[place - 2]) / (
                self.sliding_distance[place - 1] - self.sliding_distance[place - 2]
            )
            ahead = self.force[place - 1] + slope * (self.sliding_distance[place] - self.sliding_distance[place - 1])
            return float(abs(ahead - self.force[place])) + self.blurred(place)
        beside = [other for other in (place - 1, place + 1) if 0 <= other < self.sliding_distance.size]
        changes = [float(abs(self.force[place] - self.force[other])) for other in beside]
        return sum(changes) / 8 if len(changes) == 2 else min(changes, default=np.nan)

    def work(self) -> tuple[float, float]:
        """Integral of the force over the slide (nJ/m), by the trapezoidal rule, and its error.

        That of a curve is a twelfth of the change of slope; a slip may lie anywhere within its width.
        """
        steps, changes = np.diff(self.sliding_distance), np.diff(self.force)
        found = float(np.sum(steps * (self.force[1:] + self.force[:-1]) / 2))
        moving = np.flatnonzero((np.abs(steps) > 0) & ~self.after[1:])
        slopes = changes[moving] / steps[moving]
        bent = np.abs(np.diff(slopes)) * steps[moving[1:]] ** 2 / 12
        return found, float(bent.sum() + np.sum(self.width[1:] * np.abs(changes) * self.after[1:]) / 2)

    def since(self, begin: int) -> Slide:
        """The part from a place on."""
        return Slide(*(getattr(self, entry.name)[begin:] for entry in fields(self)))


LINE = ("sliding_distance", "friction_force", "contact_length")
"""Columns that a slide is a line through."""


def summed(
    columns: Mapping[str, Array], told: Mapping[str, Array], period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """What one slide amounts to (`ONSET`), and what its increments leave open (`ERRORS`).

    columns: of `COLUMNS`, (step,), NaN before the slide begins and where there is no solution; told: of `EVENT`,
    (event,), NaN where there are no more; period: lattice constant, nm. Unknown where a state is, and, but for what is
    known in the beginning, where the force still rises at the end.
    """
    found, errors = dict.fromkeys(ONSET, np.nan), dict.fromkeys(ERRORS, np.nan)
    known = np.isfinite(columns["sliding_distance"])
    part = {name: values[known] for name, values in columns.items()}
    if known.sum() < 3 or np.isnan(part["friction_force"]).any():
        return found, errors
    part["contact_length"] = np.where(np.abs(part["mean_gap"]) <= TOUCHING, np.nan, part["contact_length"])
    line, lengths = Slide.through(part, told, int(np.flatnonzero(known)[0])), part["contact_length"]
    slips = np.flatnonzero(line.after)
    found |= {
        "initial_contact_length": lengths[0],
        "initial_load": part["line_load"][0],
        "slip_count": float(slips.size),
    }
    onset = line.onset
    if onset is None:
        return found, errors
    state = int(line.state[onset])
    found["static_friction"], errors["static_friction"] = line.force[onset], line.missed(onset)
    found["onset_sliding_distance"] = line.sliding_distance[onset]
    errors["onset_sliding_distance"] = float(line.width[onset] or np.abs(np.diff(part["sliding_distance"])).max())
    found["onset_contact_length"] = line.length[onset]
    ends = [onset + int(how(line.force[onset:])) for how in (np.argmax, np.argmin)]
    found["mean_friction"], errors["mean_friction"] = line.force[ends].mean(), sum(map(line.missed, ends)) / 2
    found["average_friction"], errors["average_friction"] = average_force(line.since(onset), period)
    found["peel_asymmetry"] = asymmetry(part["contact_trailing_edge"], part["contact_leading_edge"], state)
    half = int(np.argmin(np.abs(part["sliding_distance"] - line.sliding_distance[onset] / 2)))
    found["peel_asymmetry_halfway"] = asymmetry(part["contact_trailing_edge"], part["contact_leading_edge"], half)
    fitted = quadratic_law(line.force[: onset + 1], line.length[: onset + 1])
    found["quadratic_coefficient"], found["quadratic_r_squared"] = fitted
    share = 1 / lengths[0] if lengths[0] > 0 else np.nan
    found["peeled_fraction"] = 1 - line.length[onset] * share
    if slips.size:
        first = slips[0]
        found["first_force_drop"] = (line.force[first - 1] - line.force[first]) * np.sign(
            line.sliding_distance[first] or 1.0
        )
        errors["first_force_drop"] = line.blurred(first - 1) + line.blurred(first)
        found["first_slip_periods"] = told["event_slip"][0] / period
        found["first_slip_released_energy"] = told["event_released_energy"][0]
        found["reattached_fraction"] = line.length[first] * share
        found["regained_fraction"] = (line.length[first] - line.length[first - 1]) * share
    found["loop_energy"], errors["loop_energy"] = loop(line)
    return found, errors


def average_force(line: Slide, period: float) -> tuple[float, float]:
    """Mean force (N/m) over the last whole number of lattice constants of a slide in one direction, and its error.

    NaN where there is no whole one, or where the slide turns.
    """
    if (
        line.sliding_distance.size < 2
        or np.any(np.diff(line.sliding_distance) < 0)
        or not line.sliding_distance[-1] - line.sliding_distance[0] >= period
    ):
        return np.nan, np.nan
    span = period * int((line.sliding_distance[-1] - line.sliding_distance[0]) / period + 1e-9)
    begin = line.sliding_distance[-1] - span
    kept = line.since(int(np.searchsorted(line.sliding_distance, begin, "right")))
    force = float(np.interp(begin, line.sliding_distance, line.force))
    first = begin, force, np.nan, False, 0.0, 0
    parts = zip(first, fields(kept), strict=True)
    whole = Slide(*(np.concatenate(([one], getattr(kept, entry.name))) for one, entry in parts))
    work, error = whole.work()
    return work / span, error / span


def loop(line: Slide) -> tuple[float, float]:
    """Energy (nJ/m) that a slide to and fro dissipates between its first turn and the return to it, and its error.

    NaN where the slide does not come back to where it turned.
    """
    ways = np.sign(np.round(np.diff(line.sliding_distance), 9))
    moving = np.flatnonzero(ways)
    turns = moving[1:][np.diff(ways[moving]) != 0]
    if len(turns) < 2 or abs(line.sliding_distance[-1] - line.sliding_distance[turns[0]]) > 1e-9:
        return np.nan, np.nan
    return line.since(int(turns[0])).work()


def slid(data: xr.Dataset) -> xr.Dataset:
    """A study of slides with what they amount to, slips by cell and, over several approaches, Eq. 6.9."""
    converged = is_solved(data.status)
    columns = [data[name].where(converged) for name in COLUMNS]

    def of_one(*values: Array) -> tuple[float, ...]:
        """Numbers and errors of one slide."""
        *rows, period = values
        parts = (dict(zip(COLUMNS, rows, strict=False)), dict(zip(EVENT, rows[len(COLUMNS) :], strict=True)))
        found, errors = summed(*parts, float(period))
        return (*found.values(), *errors.values())

    names = [*ONSET, *(f"{name}_increment_error" for name in ERRORS)]
    values = xr.apply_ufunc(
        of_one,
        *columns,
        *(data[name] for name in EVENT),
        data.lattice_constant,
        input_core_dims=[["step"]] * len(COLUMNS) + [["event"]] * len(EVENT) + [[]],
        output_core_dims=[[]] * len(names),
        vectorize=True,
    )
    data = data.assign(dict(zip(names, values, strict=True)))
    data["event_periods"] = data.event_slip / data.lattice_constant
    if data.sizes.get(ALONG, 0) < 3:
        return data
    fitted = xr.apply_ufunc(
        threshold_law,
        data.onset_contact_length,
        data.static_friction,
        input_core_dims=[[ALONG], [ALONG]],
        output_core_dims=[[]] * len(THRESHOLD),
        vectorize=True,
    )
    return data.assign(dict(zip(THRESHOLD, fitted, strict=True)))
