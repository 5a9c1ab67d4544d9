"""Summarise slides: static and mean friction, peeling before the onset of sliding, slips and dissipated energy.

The onset is the state of largest tangential force before the first slip or, where sliding is smooth, of the first
maximum of the force.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.peeling import (
    ALONG,
    ERRORS,
    ONSET,
    THRESHOLD,
    fit_quadratic_law,
    fit_threshold_law,
    peel_asymmetry,
)
from contactsim.observables.sliding import EVENT, TOUCHING
from contactsim.status import is_solved

STATE_NUMBERS = (
    *("sliding_distance", "friction_force", "line_load", "contact_length", "mean_gap"),
    *("contact_trailing_edge", "contact_leading_edge"),
)
"""Numbers of the states that the summary is computed from."""
SLIDE_INPUTS = (*STATE_NUMBERS, *EVENT)
"""Variables that only a dataset of slides has all of."""
MIN_STATES = 3
"""Smallest number of states, or of slides, that is summarised."""


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
    def from_states(cls, states: Mapping[str, Array], events: Mapping[str, Array], first_step: int) -> Polyline:
        """Return the line through the states (state,) and slips (event,) of a slide that begins at a step."""
        distance = states["sliding_distance"]
        count = distance.size
        with np.errstate(invalid="ignore"):
            of_state = events["event_step"] - first_step  # number of the state after a slip
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

    def slope(self, first: int, second: int) -> float | None:
        """Return the slope of the force between two places, N/m/nm; None if there is no distance between them."""
        step = self.sliding_distance[first] - self.sliding_distance[second]
        return None if step == 0 else (self.force[first] - self.force[second]) / step

    def slip_error(self, place: int) -> float:
        """Return the error (N/m) of the force at a side of a slip, which may lie anywhere within its width."""
        neighbour = place + 1 if self.is_after_slip[place] else place - 1
        if not 0 <= neighbour < self.force.size:
            return 0.0
        slope = self.slope(place, neighbour)
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


def summarise_slide(
    columns: Mapping[str, Array], events: Mapping[str, Array], period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the summary of one slide (`ONSET`), and what its increments leave open (`ERRORS`).

    Parameters
    ----------
    columns
        `STATE_NUMBERS`, (step,); NaN before the slide begins and where there is no solution.
    events
        `EVENT`, (event,); NaN where there are no more slips.
    period
        Lattice constant, nm.

    Returns
    -------
    Numbers and errors; NaN where a state is unknown, and after the onset if the force still rises at the end.
    """
    numbers, errors = dict.fromkeys(ONSET, np.nan), dict.fromkeys(ERRORS, np.nan)
    on_slide = np.isfinite(columns["sliding_distance"])
    states = {name: values[on_slide] for name, values in columns.items()}
    if on_slide.sum() < MIN_STATES or np.isnan(states["friction_force"]).any():
        return numbers, errors
    touches_all_over = np.abs(states["mean_gap"]) <= TOUCHING
    states["contact_length"] = np.where(touches_all_over, np.nan, states["contact_length"])
    line = Polyline.from_states(states, events, int(np.flatnonzero(on_slide)[0]))
    numbers["initial_contact_length"], numbers["initial_load"] = states["contact_length"][0], states["line_load"][0]
    numbers["slip_count"] = float(line.slips.size)
    onset = line.onset
    if onset is None:
        return numbers, errors
    numbers |= _peeling_numbers(line, states, onset)
    for more_numbers, more_errors in (
        _friction_numbers(line, states, onset, period),
        _slip_numbers(line, events, period),
    ):
        numbers |= more_numbers
        errors |= more_errors
    numbers["loop_energy"], errors["loop_energy"] = loop_energy(line)
    return numbers, errors


def _friction_numbers(
    line: Polyline, states: Mapping[str, Array], onset: int, period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the static, mean and average friction and the place of the onset, and their errors."""
    ends = [onset + int(extreme(line.force[onset:])) for extreme in (np.argmax, np.argmin)]
    average, average_error = average_force(line.since(onset), period)
    numbers = {
        "static_friction": line.force[onset],
        "onset_sliding_distance": line.sliding_distance[onset],
        "onset_contact_length": line.length[onset],
        "mean_friction": line.force[ends].mean(),
        "average_friction": average,
    }
    errors = {
        "static_friction": line.extreme_error(onset),
        "onset_sliding_distance": float(line.width[onset] or np.abs(np.diff(states["sliding_distance"])).max()),
        "mean_friction": sum(map(line.extreme_error, ends)) / 2,
        "average_friction": average_error,
    }
    return numbers, errors


def _peeling_numbers(line: Polyline, states: Mapping[str, Array], onset: int) -> dict[str, float]:
    """Return how the contact peels up to the onset."""
    edges = states["contact_trailing_edge"], states["contact_leading_edge"]
    halfway = int(np.argmin(np.abs(states["sliding_distance"] - line.sliding_distance[onset] / 2)))
    coefficient, r_squared = fit_quadratic_law(line.force[: onset + 1], line.length[: onset + 1])
    return {
        "peel_asymmetry": peel_asymmetry(*edges, int(line.state[onset])),
        "peel_asymmetry_halfway": peel_asymmetry(*edges, halfway),
        "quadratic_coefficient": coefficient,
        "quadratic_r_squared": r_squared,
        "peeled_fraction": 1 - line.length[onset] * _per_initial_length(states),
    } | _reattachment(line, states)


def _reattachment(line: Polyline, states: Mapping[str, Array]) -> dict[str, float]:
    """Return the parts of the initial contact after the first slip, and regained at it; nothing without a slip."""
    if not line.slips.size:
        return {}
    first, share = line.slips[0], _per_initial_length(states)
    return {
        "reattached_fraction": line.length[first] * share,
        "regained_fraction": (line.length[first] - line.length[first - 1]) * share,
    }


def _per_initial_length(states: Mapping[str, Array]) -> float:
    """Return one over the contact length before the slide, 1/nm; NaN without contact."""
    length = states["contact_length"][0]
    return 1 / length if length > 0 else np.nan


def _slip_numbers(
    line: Polyline, events: Mapping[str, Array], period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the force drop, distance and energy of the first slip, and the error of the drop; nothing without one."""
    if not line.slips.size:
        return {}, {}
    first = line.slips[0]
    direction = np.sign(line.sliding_distance[first] or 1.0)
    numbers = {
        "first_force_drop": (line.force[first - 1] - line.force[first]) * direction,
        "first_slip_periods": events["event_slip"][0] / period,
        "first_slip_released_energy": events["event_released_energy"][0],
    }
    return numbers, {"first_force_drop": line.slip_error(first - 1) + line.slip_error(first)}


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


def summarise_slides(data: xr.Dataset) -> xr.Dataset:
    """Return slides with their summaries, slips in lattice constants and, over several approaches, Eq. 6.9."""
    converged = is_solved(data.status)

    def summary(*values: Array) -> tuple[float, ...]:
        """Return the numbers and errors of one slide."""
        *rows, period = values
        columns = dict(zip(STATE_NUMBERS, rows, strict=False))
        events = dict(zip(EVENT, rows[len(STATE_NUMBERS) :], strict=True))
        numbers, errors = summarise_slide(columns, events, float(period))
        return (*(numbers[name] for name in ONSET), *(errors[name] for name in ERRORS))

    names = [*ONSET, *(f"{name}_increment_error" for name in ERRORS)]
    values = xr.apply_ufunc(
        summary,
        *(data[name].where(converged) for name in STATE_NUMBERS),
        *(data[name] for name in EVENT),
        data.lattice_constant,
        input_core_dims=[["step"]] * len(STATE_NUMBERS) + [["event"]] * len(EVENT) + [[]],
        output_core_dims=[[]] * len(names),
        vectorize=True,
    )
    data = data.assign(dict(zip(names, values, strict=True)))
    data["event_periods"] = data.event_slip / data.lattice_constant
    if data.sizes.get(ALONG, 0) < MIN_STATES:
        return data
    fitted = xr.apply_ufunc(
        fit_threshold_law,
        data.onset_contact_length,
        data.static_friction,
        input_core_dims=[[ALONG], [ALONG]],
        output_core_dims=[[]] * len(THRESHOLD),
        vectorize=True,
    )
    return data.assign(dict(zip(THRESHOLD, fitted, strict=True)))
