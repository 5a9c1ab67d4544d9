"""What is read off sliding contacts: edges and slip of each state, slips as events, the onset of sliding, and its laws.

A slip is a jump of the surface along a slide, known by the states on both sides of it, a few thousandths of a nanometre
of the slide apart. The onset is the state of largest tangential force before the first one or, where sliding is smooth,
of the first maximum. Up to there the contact peels: its length is held against the square of the force (Eq. 6.8), and
over several approaches lengths and forces of the onset against each other (Eq. 6.9).

Trailing is the edge that the upper body, sliding along x, moves away from; positions are those of the undeformed upper
surface, from its highest point. A contact whose gap is zero to rounding, as of flats, has no length.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from contactsim.adhesion import repulsive_length
from contactsim.grid import Array
from contactsim.interface import InterfaceProblem
from contactsim.solvers.base import solved
from contactsim.walk import Leap

ONSET = (
    "static_friction",
    "mean_friction",
    "average_friction",
    "onset_slide",
    "onset_repulsive_length",
    "initial_repulsive_length",
    "initial_load",
    "peeled",
    "reattached",
    "regained",
    "asymmetry_early",
    "asymmetry",
    "quadratic_coefficient",
    "quadratic_agreement",
    "slips",
    "first_drop",
    "first_periods",
    "first_released_energy",
    "loop_energy",
)
"""What a slide amounts to."""
ERRORS = ("static_friction", "mean_friction", "average_friction", "onset_slide", "first_drop", "loop_energy")
"""Those of which it is known what the increments leave open."""
EVENT = (
    "event_step",
    "event_slide",
    "event_width",
    "event_force_before",
    "event_force_after",
    "event_length_before",
    "event_length_after",
    "event_released_energy",
    "event_slip",
)
"""What is told of each slip, in the order in which they come."""
THRESHOLD = ("shear_strength", "friction_without_contact", "threshold_agreement")
"""Eq. 6.9 fitted over the approaches of a study."""
ALONG = "slide_approach"
"""The dimension along which Eq. 6.9 is fitted."""
COLUMNS = (
    *("slid", "friction_force", "line_load", "repulsive_length", "mean_gap"),
    *("contact_trailing", "contact_leading"),
)
"""Numbers of the states that all of this comes from."""
TOUCHING = 1e-4
"""Mean gap, nm, within which surfaces touch all over, and neither overlap nor are apart."""


def slide_observables(problem: InterfaceProblem, gap: Array, displacement: Array) -> dict[str, float]:
    """Numbers of one state on a slide: gap (2, n), nm; displacement (exerted, m).

    slid, nm; contact_trailing, contact_leading: outermost edges of what is under repulsion, nm, NaN without;
    contact_slip: mean tangential gap where surfaces are closest, nm; elastic_energy of the bodies, nJ/m.
    """
    close = gap[0] <= gap[0].min() + problem.law.reach
    weighted = problem.balanced(np.zeros_like(displacement), displacement) * problem.weights
    trailing, leading = contact_edges(gap[0], problem.shape[0], problem.grid.spacing[0])
    return {
        "slid": problem.slid,
        "contact_trailing": trailing,
        "contact_leading": leading,
        "contact_slip": float(gap[1, close].mean()),
        "elastic_energy": 0.5 * float(np.vdot(displacement, weighted).real) * problem.grid.lengths[0],
    }


def contact_edges(gap: Array, shape: Array, spacing: float) -> tuple[float, float]:
    """First and last place with a negative gap (n,), between nodes, nm from where the undeformed `shape` is least.

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


def slip_numbers(problem: InterfaceProblem, leap: Leap, step: int) -> dict[str, float]:
    """Numbers of one slip (`EVENT`), by the step during which it came.

    event_width: of the slide between both sides, nm; event_slip: how far the contact slipped, nm; the energy, nJ/m, is
    what the bodies release, of which the interface keeps a part.
    """
    sides = []
    for at, state in ((leap.left, leap.before), (leap.step, leap.after)):
        here = problem.at(at)
        numbers = slide_observables(here, state.gap, state.displacement)
        numbers["force"] = (
            float(state.traction[1:].mean() * problem.grid.lengths[0]) if len(state.traction) > 1 else 0.0
        )
        numbers["length"] = repulsive_length(state.gap[0], problem.grid.spacing[0])
        if abs(state.gap[0].mean()) <= TOUCHING:
            numbers["length"] = np.nan
        sides.append(numbers)
    before, after = sides
    return {
        "event_step": step,
        "event_slide": leap.step.slid,
        "event_width": abs(leap.step.slid - leap.left.slid),
        "event_force_before": before["force"],
        "event_force_after": after["force"],
        "event_length_before": before["length"],
        "event_length_after": after["length"],
        "event_released_energy": before["elastic_energy"] - after["elastic_energy"],
        "event_slip": abs(after["contact_slip"] - before["contact_slip"]),
    }


def slips_of(slips: Sequence[Mapping[str, float]]) -> dict[str, tuple[str, Array]]:
    """Variables (event,) of slips; one of NaN where there is none."""
    rows = slips or [dict.fromkeys(EVENT, np.nan)]
    return {name: ("event", np.array([row[name] for row in rows], float)) for name in EVENT}


@dataclass(frozen=True)
class Slide:
    """A slide as a line through its states and both sides of its slips.

    slid (nm), force (N/m), length (nm): (place,); after: whether a place is the far side of a slip, (place,); width: of
    the slide between both sides of it, nm; state: number of the state, on the slide, that a place is or comes after.
    """

    slid: Array
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
        for state, (slid, force, length) in enumerate(zip(*(columns[name] for name in LINE), strict=True)):
            for slip in np.flatnonzero(steps == state):
                here, width = told["event_slide"][slip], told["event_width"][slip]
                back = here - np.sign(slid - columns["slid"][state - 1]) * width
                before, after = (told[f"event_force_{side}"][slip] for side in ("before", "after"))
                lengths = [told[f"event_length_{side}"][slip] for side in ("before", "after")]
                places.append((back, before, lengths[0], 0.0, width, state - 1))
                places.append((here, after, lengths[1], 1.0, width, state - 1))
            places.append((slid, force, length, 0.0, 0.0, state))
        slid, force, length, after, width, state = np.array(places).T
        return cls(slid, force, length, after > 0, width, state.astype(int))

    @property
    def onset(self) -> int | None:
        """The place of largest force before the first slip, or of the first maximum; None if the force still rises."""
        first = np.flatnonzero(self.after)
        if first.size:
            return int(np.argmax(self.force[: first[0]]))
        falling = np.flatnonzero(np.diff(self.force) < 0)
        return int(falling[0]) if falling.size else None

    def missed(self, place: int) -> float:
        """By how much (N/m) the force may be more extreme than at a place, within what is known of it.

        Next to a slip it goes on as before for no more than the width of that; else it turns, by an eighth of the
        second difference.
        """
        beside = [other for other in (place - 1, place + 1) if 0 <= other < self.slid.size]
        slipped = [other for other in beside if self.after[max(place, other)]]
        changes = [abs(self.force[place] - self.force[other]) for other in beside if other not in slipped]
        spans = [abs(self.slid[place] - self.slid[other]) for other in beside if other not in slipped]
        if slipped:
            return max((self.width[place] * c / s for c, s in zip(changes, spans, strict=True) if s > 0), default=0.0)
        return sum(changes) / 8 if len(changes) == 2 else min(changes, default=np.nan)

    def work(self) -> tuple[float, float]:
        """Integral of the force over the slide (nJ/m), by the trapezoidal rule, and its error.

        That of a curve is a twelfth of the change of slope; a slip may lie anywhere within its width.
        """
        steps, changes = np.diff(self.slid), np.diff(self.force)
        found = float(np.sum(steps * (self.force[1:] + self.force[:-1]) / 2))
        moving = np.flatnonzero((np.abs(steps) > 0) & ~self.after[1:])
        slopes = changes[moving] / steps[moving]
        bent = np.abs(np.diff(slopes)) * steps[moving[1:]] ** 2 / 12
        return found, float(bent.sum() + np.sum(self.width[1:] * np.abs(changes) * self.after[1:]) / 2)

    def since(self, begin: int) -> Slide:
        """The part from a place on."""
        return Slide(*(getattr(self, name)[begin:] for name in ("slid", "force", "length", "after", "width", "state")))


LINE = ("slid", "friction_force", "repulsive_length")
"""Columns that a slide is a line through."""


def quadratic_law(force: Array, length: Array) -> tuple[float, float]:
    """ζ of Eq. 6.8, l = l0 - ζF² with l0 the first length, and R² of the fit; force (N/m), length (nm): (step,).

    ζ is in nm (m/N)². NaN for fewer than three states, or of a length that does not change.
    """
    if force.size < 3 or not np.ptp(length) > 0 or not np.ptp(force) > 0:
        return np.nan, np.nan
    square, lost = force**2, length[0] - length
    coefficient = float((square @ lost) / (square @ square))
    left = np.sum((lost - coefficient * square) ** 2)
    return coefficient, float(1 - left / np.sum((length - length.mean()) ** 2))


def threshold_law(length: Array, force: Array) -> tuple[float, float, float]:
    """Slope (GPa), intercept (N/m) and R² of Eq. 6.9, F = τl + F0, through onsets (approach,), nm and N/m.

    Those without contact, of which there is one force for each approach, are left out. NaN for fewer than three others.
    """
    known = np.isfinite(force) & (length > 0)
    if known.sum() < 3 or not np.ptp(length[known]) > 0:
        return np.nan, np.nan, np.nan
    slope, offset = np.polyfit(length[known], force[known], 1)
    left = np.sum((force[known] - slope * length[known] - offset) ** 2)
    return float(slope), float(offset), float(1 - left / np.sum((force[known] - force[known].mean()) ** 2))


def summed(
    columns: Mapping[str, Array], told: Mapping[str, Array], period: float
) -> tuple[dict[str, float], dict[str, float]]:
    """What one slide amounts to (`ONSET`), and what its increments leave open (`ERRORS`).

    columns: of `COLUMNS`, (step,), NaN before the slide begins and where there is no solution; told: of `EVENT`,
    (event,), NaN where there are no more; period: lattice constant, nm. Unknown where a state is, and, but for what is
    known in the beginning, where the force still rises at the end.
    """
    found, errors = dict.fromkeys(ONSET, np.nan), dict.fromkeys(ERRORS, np.nan)
    known = np.isfinite(columns["slid"])
    part = {name: values[known] for name, values in columns.items()}
    if known.sum() < 3 or np.isnan(part["friction_force"]).any():
        return found, errors
    part["repulsive_length"] = np.where(np.abs(part["mean_gap"]) <= TOUCHING, np.nan, part["repulsive_length"])
    line, lengths = Slide.through(part, told, int(np.flatnonzero(known)[0])), part["repulsive_length"]
    slips = np.flatnonzero(line.after)
    found |= {"initial_repulsive_length": lengths[0], "initial_load": part["line_load"][0], "slips": float(slips.size)}
    onset = line.onset
    if onset is None:
        return found, errors
    state = int(line.state[onset])
    found["static_friction"], errors["static_friction"] = line.force[onset], line.missed(onset)
    found["onset_slide"] = line.slid[onset]
    errors["onset_slide"] = float(line.width[onset] or np.abs(np.diff(part["slid"])).max())
    found["onset_repulsive_length"] = line.length[onset]
    ends = [onset + int(how(line.force[onset:])) for how in (np.argmax, np.argmin)]
    found["mean_friction"], errors["mean_friction"] = line.force[ends].mean(), sum(map(line.missed, ends)) / 2
    found["average_friction"], errors["average_friction"] = average_force(line.since(onset), period)
    found["asymmetry"] = asymmetry(part["contact_trailing"], part["contact_leading"], state)
    half = int(np.argmin(np.abs(part["slid"] - line.slid[onset] / 2)))
    found["asymmetry_early"] = asymmetry(part["contact_trailing"], part["contact_leading"], half)
    fitted = quadratic_law(line.force[: onset + 1], line.length[: onset + 1])
    found["quadratic_coefficient"], found["quadratic_agreement"] = fitted
    share = 1 / lengths[0] if lengths[0] > 0 else np.nan
    found["peeled"] = 1 - line.length[onset] * share
    if slips.size:
        first = slips[0]
        found["first_drop"] = (line.force[first - 1] - line.force[first]) * np.sign(line.slid[first] or 1.0)
        errors["first_drop"] = line.missed(first - 1) + line.missed(first)
        found["first_periods"] = told["event_slip"][0] / period
        found["first_released_energy"] = told["event_released_energy"][0]
        found["reattached"] = line.length[first] * share
        found["regained"] = (line.length[first] - line.length[first - 1]) * share
    found["loop_energy"], errors["loop_energy"] = loop(line)
    return found, errors


def asymmetry(trailing: Array, leading: Array, step: int) -> float:
    """By which part more has peeled at the trailing than at the leading edge, -1 to 1; edges (step,), nm."""
    behind, ahead = trailing[step] - trailing[0], leading[0] - leading[step]
    return float((behind - ahead) / (abs(behind) + abs(ahead))) if behind or ahead else np.nan


def average_force(line: Slide, period: float) -> tuple[float, float]:
    """Mean force (N/m) over the last whole number of lattice constants of a slide in one direction, and its error.

    NaN where there is no whole one, or where the slide turns.
    """
    if line.slid.size < 2 or np.any(np.diff(line.slid) < 0) or not line.slid[-1] - line.slid[0] >= period:
        return np.nan, np.nan
    span = period * int((line.slid[-1] - line.slid[0]) / period + 1e-9)
    begin = line.slid[-1] - span
    kept = line.since(int(np.searchsorted(line.slid, begin, "right")))
    force = float(np.interp(begin, line.slid, line.force))
    first = begin, force, np.nan, False, 0.0, 0
    names = ("slid", "force", "length", "after", "width", "state")
    whole = Slide(*(np.concatenate(([one], getattr(kept, name))) for one, name in zip(first, names, strict=True)))
    work, error = whole.work()
    return work / span, error / span


def loop(line: Slide) -> tuple[float, float]:
    """Energy (nJ/m) that a slide to and fro dissipates between its first turn and the return to it, and its error.

    NaN where the slide does not come back to where it turned.
    """
    ways = np.sign(np.round(np.diff(line.slid), 9))
    moving = np.flatnonzero(ways)
    turns = moving[1:][np.diff(ways[moving]) != 0]
    if len(turns) < 2 or abs(line.slid[-1] - line.slid[turns[0]]) > 1e-9:
        return np.nan, np.nan
    return line.since(int(turns[0])).work()


def slid(data: xr.Dataset) -> xr.Dataset:
    """A study of slides with what they amount to, slips by cell and, over several approaches, Eq. 6.9."""
    converged = solved(data.status)
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
        data.onset_repulsive_length,
        data.static_friction,
        input_core_dims=[[ALONG], [ALONG]],
        output_core_dims=[[]] * len(THRESHOLD),
        vectorize=True,
    )
    return data.assign(dict(zip(THRESHOLD, fitted, strict=True)))
