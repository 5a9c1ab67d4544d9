"""A slide as a line through its states and slips: its onset, its forces with their errors, and its work."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from contactsim.grid import Array


@dataclass(frozen=True)
class Polyline:
    """A slide as a line through its states and both sides of its slips.

    Attributes
    ----------
    sliding_distance, force, length
        Sliding distance (nm), tangential force (N/m) and contact length (nm), (place,).
    is_after_slip
        True at the far side of a slip, (place,).
    width
        Sliding distance between both sides of a slip, nm; zero at a state, (place,).
    state
        Number of the state at a place, or of the state before it, (place,).
    """

    sliding_distance: Array
    force: Array
    length: Array
    is_after_slip: Array
    width: Array
    state: Array

    @classmethod
    def from_states(cls, states: Mapping[str, Array], events: Mapping[str, Array]) -> Polyline:
        """Return the line through the states (state,) and slips (event,) of a slide.

        `event_step` is the number of the state after a slip; NaN where there are no more slips.
        """
        distance = states["sliding_distance"]
        count, of_state = distance.size, events["event_step"]
        with np.errstate(invalid="ignore"):
            slips = np.flatnonzero(np.isin(of_state, np.arange(count)))
        following = of_state[slips].astype(int)
        width, after = events["event_width"][slips], events["event_sliding_distance"][slips]
        before = after - np.sign(distance[following] - distance[following - 1]) * width
        order = np.lexsort(
            (
                np.concatenate((2 * slips, 2 * slips + 1, np.full(count, 2 * of_state.size))),
                np.concatenate((following, following, np.arange(count))),
            )
        )

        def ordered(at_before: Array, at_after: Array, at_states: Array) -> Array:
            """Return values before slips, after slips and at states in the order of the line."""
            return np.concatenate((at_before, at_after, at_states))[order]

        zeros, no_slip = np.zeros(count), np.zeros(slips.size, bool)
        return cls(
            ordered(before, after, distance),
            ordered(events["event_force_before"][slips], events["event_force_after"][slips], states["friction_force"]),
            ordered(
                events["event_length_before"][slips], events["event_length_after"][slips], states["contact_length"]
            ),
            ordered(no_slip, ~no_slip, zeros.astype(bool)),
            ordered(width, width, zeros),
            ordered(following - 1, following - 1, np.arange(count)),
        )

    @property
    def slips(self) -> Array:
        """Places on the far side of slips."""
        return np.flatnonzero(self.is_after_slip)

    @property
    def onset(self) -> int | None:
        """The place of largest force before the first slip, or of the first maximum; None if the force still rises."""
        if self.slips.size:
            return int(np.argmax(self.force[: self.slips[0]]))
        falling = np.flatnonzero(np.diff(self.force) < 0)
        return int(falling[0]) if falling.size else None

    def slope(self, first: int, second: int, values: Array | None = None) -> float | None:
        """Return the slope of the force (N/m/nm), or of other values, between two places; None without a distance."""
        values = self.force if values is None else values
        step = self.sliding_distance[first] - self.sliding_distance[second]
        return None if step == 0 else (values[first] - values[second]) / step

    def slip_error(self, place: int, values: Array | None = None) -> float:
        """Return the error of the force (N/m), or of other values, at a side of a slip: it lies within its width."""
        neighbour = place + 1 if self.is_after_slip[place] else place - 1
        if not 0 <= neighbour < self.force.size:
            return 0.0
        slope = self.slope(place, neighbour, values)
        return 0.0 if slope is None else float(self.width[place] * abs(slope))

    def extreme_error(self, place: int) -> float:
        """Return the error (N/m) of an extreme force, which may lie between a place and its neighbours.

        Before a slip the force bends more and more, and stays below the line through the two states before. After a
        slip it is extreme at the slip itself. Elsewhere it turns, by an eighth of the second difference.
        """
        if self.is_after_slip[place]:
            return self.slip_error(place)
        if place + 1 < self.force.size and self.is_after_slip[place + 1]:
            slope = None if place < 2 or self.is_after_slip[place - 1] else self.slope(place - 1, place - 2)
            if slope is None:
                return float(abs(self.force[place] - self.force[place - 1])) + self.slip_error(place)
            step = self.sliding_distance[place] - self.sliding_distance[place - 1]
            extrapolated = self.force[place - 1] + slope * step
            return float(abs(extrapolated - self.force[place])) + self.slip_error(place)
        neighbours = [other for other in (place - 1, place + 1) if 0 <= other < self.force.size]
        changes = [float(abs(self.force[place] - self.force[other])) for other in neighbours]
        return sum(changes) / 8 if len(changes) == 2 else min(changes, default=np.nan)

    def work(self) -> tuple[float, float]:
        """Return the integral of the force over the slide (nJ/m), by the trapezoidal rule, and its error.

        The error of a smooth curve is a twelfth of the change of slope; a slip may lie anywhere within its width.
        """
        steps, changes = np.diff(self.sliding_distance), np.diff(self.force)
        work = float(np.sum(steps * (self.force[1:] + self.force[:-1]) / 2))
        moving = np.flatnonzero((np.abs(steps) > 0) & ~self.is_after_slip[1:])
        slopes = changes[moving] / steps[moving]
        curved = np.abs(np.diff(slopes)) * steps[moving[1:]] ** 2 / 12
        return work, float(curved.sum() + np.sum(self.width[1:] * np.abs(changes) * self.is_after_slip[1:]) / 2)

    def since(self, begin: int) -> Polyline:
        """Return the part from a place on."""
        return Polyline(*(getattr(self, entry.name)[begin:] for entry in fields(self)))

    def with_start(self, sliding_distance: float) -> Polyline:
        """Return the part beyond a sliding distance, which begins with an interpolated force there."""
        rest = self.since(int(np.searchsorted(self.sliding_distance, sliding_distance, "right")))
        force = float(np.interp(sliding_distance, self.sliding_distance, self.force))
        start = Polyline(*(np.array([value]) for value in (sliding_distance, force, np.nan, False, 0.0, 0)))
        parts = ((getattr(start, entry.name), getattr(rest, entry.name)) for entry in fields(self))
        return Polyline(*(np.concatenate(pair) for pair in parts))


def every_second(
    states: Mapping[str, Array], events: Mapping[str, Array], begin: int
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return the states and slips of a slide without every second state; the first and the last state stay.

    Slips stay, as they are known apart from the states.

    Parameters
    ----------
    states, events
        As of `Polyline.from_states`.
    begin
        1 to keep the states with odd numbers, 2 for even ones.
    """
    count = states["sliding_distance"].size
    kept = np.unique([0, *range(begin, count, 2), count - 1])
    numbers = events["event_step"]
    after = np.where(np.isnan(numbers) | (numbers < 0), numbers, np.searchsorted(kept, numbers))
    return {name: values[kept] for name, values in states.items()}, {**events, "event_step": after}


def average_force(line: Polyline, period: float) -> tuple[float, float]:
    """Return the mean force (N/m) over the last whole number of lattice constants of a slide, and its error.

    NaN if the slide is shorter than one lattice constant (nm), or turns.
    """
    distance = line.sliding_distance
    if distance.size < 2 or np.any(np.diff(distance) < 0) or not distance[-1] - distance[0] >= period:
        return np.nan, np.nan
    span = period * int((distance[-1] - distance[0]) / period + 1e-9)
    work, error = line.with_start(distance[-1] - span).work()
    return work / span, error / span


def loop_energy(line: Polyline) -> tuple[float, float]:
    """Return the energy (nJ/m) that a slide to and fro dissipates between its first turn and the return to it.

    Also returns its error. NaN if the slide does not return to where it turned.
    """
    directions = np.sign(np.round(np.diff(line.sliding_distance), 9))
    moving = np.flatnonzero(directions)
    turns = moving[1:][np.diff(directions[moving]) != 0]
    if len(turns) < 2 or abs(line.sliding_distance[-1] - line.sliding_distance[turns[0]]) > 1e-9:
        return np.nan, np.nan
    return line.since(int(turns[0])).work()
