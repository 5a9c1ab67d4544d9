"""Summarise slides: static and mean friction, peeling before the onset of sliding, slips and dissipated energy.

The onset is the state of largest tangential force before the first slip or, where sliding is smooth, of the first
maximum of the force. A slide that begins along -x is read in a mirror: its distances, forces and edges count along its
motion.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.observables.peeling import PEELING
from contactsim.observables.polyline import Polyline, average_force, every_second, loop_energy
from contactsim.observables.slide_peeling import peeling_numbers, per_initial_length, regained_lengths
from contactsim.observables.sliding import EVENT, TOUCHING
from contactsim.observables.threshold import fit_thresholds
from contactsim.status import is_solved

ONSET = (
    "static_friction",
    "mean_friction",
    "average_friction",
    "onset_sliding_distance",
    "onset_contact_length",
    "initial_contact_length",
    "initial_load",
    *PEELING,
    "reattached_fraction",
    "regained_fraction",
    "slip_count",
    "reattachment_count",
    "sticking_stiffness",
    "sticking_r_squared",
    "first_force_drop",
    "first_slip_periods",
    "first_slip_released_energy",
    "released_share",
    "stored_energy",
    "loop_energy",
)
"""Numbers that summarise a slide."""
STATE_NUMBERS = (
    *("sliding_distance", "friction_force", "line_load", "contact_length", "mean_gap"),
    *("contact_trailing_edge", "contact_leading_edge", "elastic_energy"),
)
"""Numbers of the states that the summary is computed from."""
EDGES = (("trailing", "leading"), ("leading", "trailing"))
"""Edges of a contact, and which of them each becomes in a mirror."""
SLIDE_INPUTS = (*STATE_NUMBERS, *EVENT)
"""Variables that only a dataset of slides has all of."""
MIN_STATES = 3
"""Smallest number of states that is summarised."""
STORING_SLIDE = 1.0
"""Sliding distance, nm, up to which the stored energy is compared while the contact sticks."""


def summarise_slide(
    columns: Mapping[str, Array], events: Mapping[str, Array], period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the summary of one slide (`ONSET`), and what its increments leave open in each number.

    The error of a force, or of its place, follows from the states beside it. That of any other number is its change
    without every second state, the larger one of both ways to leave them out.

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
    on_slide = np.isfinite(columns["sliding_distance"])
    states = {name: values[on_slide] for name, values in columns.items()}
    if on_slide.sum() < MIN_STATES or np.isnan(states["friction_force"]).any():
        return dict.fromkeys(ONSET, np.nan), dict.fromkeys(ONSET, np.nan)
    states, events = _along_motion(states, events)
    touches_all_over = np.abs(states["mean_gap"]) <= TOUCHING
    states["contact_length"] = np.where(touches_all_over, np.nan, states["contact_length"])
    events = {**events, "event_step": events["event_step"] - np.flatnonzero(on_slide)[0]}
    numbers, errors = _slide_numbers(states, events, period)
    fewer = [_slide_numbers(*every_second(states, events, begin), period)[0] for begin in (1, 2)]
    changes = {name: float(max(abs(numbers[name] - part[name]) for part in fewer)) for name in ONSET}
    return numbers, changes | errors


def _along_motion(
    states: Mapping[str, Array], events: Mapping[str, Array]
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return the states and slips of a slide, in a mirror if it begins along -x."""
    moves = np.diff(states["sliding_distance"])
    if not moves.any() or moves[moves != 0][0] > 0:
        return dict(states), dict(events)
    mirrored = {name: -states[name] for name in ("sliding_distance", "friction_force")}
    mirrored |= {f"contact_{edge}_edge": -states[f"contact_{other}_edge"] for edge, other in EDGES}
    slips = {name: -events[name] for name in ("event_sliding_distance", "event_force_before", "event_force_after")}
    return {**states, **mirrored}, {**events, **slips}


def _slide_numbers(
    states: Mapping[str, Array], events: Mapping[str, Array], period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the summary of a slide, and errors that follow from neighbouring states; arguments as of `Polyline`."""
    numbers: dict[str, float] = dict.fromkeys(ONSET, np.nan)
    errors: dict[str, float] = {}
    line = Polyline.from_states(states, events)
    numbers["initial_contact_length"], numbers["initial_load"] = states["contact_length"][0], states["line_load"][0]
    numbers["slip_count"], numbers["stored_energy"] = float(line.slips.size), _stored_energy(line, states)
    gains = regained_lengths(line)
    numbers["reattachment_count"] = np.nan if np.isnan(gains).any() else float(np.count_nonzero(gains > 0))
    onset = line.onset
    if onset is None:
        return numbers, errors
    numbers |= peeling_numbers(line, states, onset) | _sticking_numbers(line, onset)
    for more_numbers, more_errors in (
        _friction_numbers(line, states, onset, period),
        _slip_numbers(line, states, events, period),
    ):
        numbers |= more_numbers
        errors |= more_errors
    numbers["released_share"] = _released_share(line, states, events)
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
    if line.width[onset]:  # at a slip, which no state decides
        errors["onset_contact_length"] = line.slip_error(onset, line.length)
        errors["peeled_fraction"] = errors["onset_contact_length"] * per_initial_length(states)
    return numbers, errors


def _sticking_numbers(line: Polyline, onset: int) -> dict[str, float]:
    """Return slope (GPa) and R² of the straight line through the forces up to the onset of sliding."""
    distance, force = line.sliding_distance[: onset + 1], line.force[: onset + 1]
    if force.size < MIN_STATES or not np.ptp(force):
        return {}
    slope, offset = np.polyfit(distance, force, 1)
    squares = np.sum((force - slope * distance - offset) ** 2)
    r_squared = 1 - squares / np.sum((force - force.mean()) ** 2)
    return {"sticking_stiffness": float(slope), "sticking_r_squared": float(r_squared)}


def _stored_energy(line: Polyline, states: Mapping[str, Array]) -> float:
    """Return the elastic energy (nJ/m) that a slide by `STORING_SLIDE` adds; NaN if the contact slips before."""
    end = line.slips[0] if line.slips.size else -1
    if not line.sliding_distance[end] > STORING_SLIDE:
        return np.nan
    stored = np.interp(STORING_SLIDE, states["sliding_distance"], states["elastic_energy"])
    return float(stored - states["elastic_energy"][0])


def _slip_numbers(
    line: Polyline, states: Mapping[str, Array], events: Mapping[str, Array], period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Return the force drop, distance and energy of the first slip, and their errors; nothing without a slip."""
    if not line.slips.size:
        return {}, {}
    first = line.slips[0]
    following = int(line.state[first]) + 1
    direction = np.sign(states["sliding_distance"][following] - states["sliding_distance"][following - 1])
    numbers = {
        "first_force_drop": (line.force[first - 1] - line.force[first]) * direction,
        "first_slip_periods": events["event_slip"][0] / period,
        "first_slip_released_energy": events["event_released_energy"][0],
    }
    lengths = [line.slip_error(place, line.length) * per_initial_length(states) for place in (first - 1, first)]
    errors = {
        "first_force_drop": line.slip_error(first - 1) + line.slip_error(first),
        "reattached_fraction": lengths[1],
        "regained_fraction": sum(lengths),
        "first_slip_released_energy": float(abs(line.force[first - 1]) * line.width[first]),
    }
    return numbers, errors


def _released_share(line: Polyline, states: Mapping[str, Array], events: Mapping[str, Array]) -> float:
    """Return the elastic energy that the first slip releases over that which the slide has added up to it.

    The energy after the slip follows from the three states after it, by a parabola: there the path is smooth, while it
    is steep before a slip. NaN without a slip and three states after it in one direction, and where the slide adds no
    energy.
    """
    if not line.slips.size:
        return np.nan
    first = line.slips[0]
    energy, distance = states["elastic_energy"], states["sliding_distance"]
    beyond = slice(line.state[first] + 1, line.state[first] + 1 + MIN_STATES)
    ahead = distance[beyond] - line.sliding_distance[first]
    moves = np.diff(ahead)
    if ahead.size < MIN_STATES or not ((moves > 0).all() or (moves < 0).all()):
        return np.nan
    after = float(np.polyfit(ahead, energy[beyond], 2)[-1])
    released = events["event_released_energy"][0]
    added = after + released - energy[0]
    return float(released / added) if added > 0 else np.nan


def summarise_slides(data: xr.Dataset) -> xr.Dataset:
    """Return slides with their summaries, slips in lattice constants and, over several approaches, Eq. 6.9."""
    converged = is_solved(data.status)

    def summary(*values: Array) -> tuple[float, ...]:
        """Return the numbers and errors of one slide."""
        *rows, period = values
        columns = dict(zip(STATE_NUMBERS, rows, strict=False))
        events = dict(zip(EVENT, rows[len(STATE_NUMBERS) :], strict=True))
        return tuple(part[name] for part in summarise_slide(columns, events, float(period)) for name in ONSET)

    names = [*ONSET, *(f"{name}_increment_error" for name in ONSET)]
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
    return fit_thresholds(data)
