"""What is read off sliding contacts: edges and slip of each state, slips as events, the onset of sliding, and its laws.

A slip is a jump of the surface along a slide. The onset is the state of largest tangential force before the first one,
or, where sliding is smooth, of the first maximum. Up to there the contact peels: its area is held against the square of
the force (Eq. 6.8), and over several approaches areas and forces of the onset against each other (Eq. 6.9).

Trailing is the edge that the upper body, sliding along x, moves away from; positions are those of the undeformed upper
surface, from its highest point.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.interface import InterfaceProblem
from contactsim.solvers.base import solved

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
    "event_slide",
    "event_drop",
    "event_length_before",
    "event_length_after",
    "event_released_energy",
    "event_periods",
)
"""What is told of each slip, in the order in which they come."""
THRESHOLD = ("shear_strength", "friction_without_contact", "threshold_agreement")
"""Eq. 6.9 fitted over the approaches of a study."""
ALONG = "slide_approach"
"""The dimension along which Eq. 6.9 is fitted."""
COLUMNS = ("slid", "friction_force", "line_load", "repulsive_length", "contact_trailing", "contact_leading") + (
    ("contact_slip", "elastic_energy", "jump", "jumped_at")
)
"""Numbers of the states that all of this comes from."""


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


def onset_step(force: Array, jump: Array) -> int:
    """The step of largest force before the first slip; of a smooth slide, of its first maximum, or its last step."""
    first = np.flatnonzero(jump > 0)
    end = first[0] if first.size else force.size
    if not first.size:
        falling = np.flatnonzero(np.diff(force) < 0)
        end = falling[0] + 1 if falling.size else force.size
    return int(np.argmax(force[:end])) if end else 0


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


def summed(columns: dict[str, Array], period: float) -> tuple[dict[str, float], dict[str, float]]:
    """What one slide amounts to (`ONSET`), and what its increments leave open (`ERRORS`).

    columns: of `COLUMNS`, (step,), NaN before the slide begins and where there is no solution; period: lattice
    constant, nm.
    """
    slide = np.isfinite(columns["slid"])
    slid, force, load, length, trailing, leading, slip, energy, jump, _ = (columns[name][slide] for name in COLUMNS)
    found, errors = dict.fromkeys(ONSET, np.nan), dict.fromkeys(ERRORS, np.nan)
    if slid.size < 3 or np.isnan(force).any():
        return found, errors
    onset, slips = onset_step(force, jump), np.flatnonzero(jump > 0)
    step = float(np.abs(np.diff(slid)).max())
    found["static_friction"], errors["static_friction"] = force[onset], missed(force, jump, onset)
    found["onset_slide"], errors["onset_slide"] = slid[onset], step
    if onset + 1 < slid.size:
        ends = [onset + int(how(force[onset:])) for how in (np.argmax, np.argmin)]
        found["mean_friction"] = force[ends].mean()
        errors["mean_friction"] = sum(missed(force, jump, end) for end in ends) / 2
    found["average_friction"], errors["average_friction"] = average_force(slid[onset:], force[onset:], period)
    found |= {"onset_repulsive_length": length[onset], "initial_repulsive_length": length[0], "initial_load": load[0]}
    if length[0] > 0:
        found["peeled"] = 1 - length[onset] / length[0]
    found["asymmetry"] = asymmetry(trailing, leading, onset)
    found["asymmetry_early"] = asymmetry(trailing, leading, int(np.argmin(np.abs(slid - slid[onset] / 2))))
    fitted = quadratic_law(force[: onset + 1], length[: onset + 1])
    found["quadratic_coefficient"], found["quadratic_agreement"] = fitted
    found["slips"] = float(slips.size)
    if slips.size and slips[0]:
        first = slips[0]
        found["first_drop"], errors["first_drop"] = (
            force[first - 1] - force[first],
            (missed(force, jump, first - 1) + missed(force, jump, first)),
        )
        found["first_periods"] = abs(slip[first] - slip[first - 1]) / period
        found["first_released_energy"] = energy[first - 1] - energy[first]
        if length[0] > 0:
            found["reattached"] = length[first] / length[0]
            found["regained"] = (length[first] - length[first - 1]) / length[0]
    found["loop_energy"], errors["loop_energy"] = loop(slid, force, jump)
    return found, errors


def missed(force: Array, jump: Array, step: int) -> float:
    """By how much (N/m) a force (step,) may be more extreme than at a step, between it and the states beside it.

    Next to a slip it may change as much as in the increment on the other side; else it turns, by an eighth of the
    second difference.
    """
    before = abs(force[step] - force[step - 1]) if step else np.inf
    after = abs(force[step + 1] - force[step]) if step + 1 < force.size else np.inf
    if jump[step] > 0:
        return float(after if np.isfinite(after) else before)
    if step + 1 < force.size and jump[step + 1] > 0:
        return float(before if np.isfinite(before) else after)
    return float((before + after) / 8 if np.isfinite(before + after) else min(before, after))


def asymmetry(trailing: Array, leading: Array, step: int) -> float:
    """By which part more has peeled at the trailing than at the leading edge, -1 to 1; edges (step,), nm."""
    behind, ahead = trailing[step] - trailing[0], leading[0] - leading[step]
    return float((behind - ahead) / (abs(behind) + abs(ahead))) if behind or ahead else np.nan


def average_force(slid: Array, force: Array, period: float) -> tuple[float, float]:
    """Mean force (N/m) over the last whole number of lattice constants of a slide in one direction, and its error.

    By the trapezoidal rule, whose error is taken as that of a slip anywhere within a step. NaN where there is no whole
    one, or where the slide turns.
    """
    if slid.size < 2 or np.any(np.diff(slid) <= 0) or not slid[-1] - slid[0] >= period:
        return np.nan, np.nan
    span = period * int((slid[-1] - slid[0]) / period + 1e-9)
    begin = slid[-1] - span
    inside = slid > begin
    places = np.concatenate(([begin], slid[inside]))
    values = np.concatenate(([np.interp(begin, slid, force)], force[inside]))
    steps, drops = np.diff(places), np.diff(values)
    return float(np.sum(steps * (values[1:] + values[:-1]) / 2) / span), float(np.abs(steps * drops).max() / 2 / period)


def loop(slid: Array, force: Array, jump: Array) -> tuple[float, float]:
    """Energy (nJ/m) that a slide to and fro dissipates between its first turn and the return to it, and its error.

    slid (nm), force (N/m), jump: (step,). NaN where the slide does not come back to where it turned.
    """
    turns = np.flatnonzero(np.diff(slid)[1:] * np.diff(slid)[:-1] < 0) + 1
    if len(turns) < 2 or abs(slid[-1] - slid[turns[0]]) > 1e-9:
        return np.nan, np.nan
    part = slice(turns[0], None)
    steps, changes = np.diff(slid[part]), np.diff(force[part])
    found = np.sum(steps * (force[part][1:] + force[part][:-1]) / 2)
    return float(found), float(np.sum(np.abs(steps * changes)[jump[part][1:] > 0]) / 2)


def events(columns: dict[str, Array], period: float) -> dict[str, Array]:
    """Every slip of a slide (`EVENT`): (slip,); columns and period as in `summed`.

    Drops of the force are counted along the motion; the energy is what the bodies release, of which the interface keeps
    a part; periods: how far the contact slipped, in lattice constants.
    """
    slide = np.isfinite(columns["slid"])
    slid, force, _, length, _, _, slip, energy, jump, jumped_at = (columns[name][slide] for name in COLUMNS)
    places = np.flatnonzero(jump > 0)
    places = places[places > 0]
    before = places - 1
    values = (
        jumped_at[places],
        (force[before] - force[places]) * np.sign(slid[places] - slid[before]),
        length[before],
        length[places],
        energy[before] - energy[places],
        np.abs(slip[places] - slip[before]) / period,
    )
    return dict(zip(EVENT, values, strict=True))


def slid(data: xr.Dataset) -> xr.Dataset:
    """A study of slides with what they amount to, their events and, over several approaches, Eq. 6.9."""
    converged = solved(data.status)
    columns = [data[name].where(converged) for name in COLUMNS]
    most = max(int((data.jump.where(np.isfinite(data.slid)) > 0).sum("step").max()), 1)

    def of_one(*values: Array) -> tuple[float | Array, ...]:
        """Numbers, errors and events of one slide."""
        *rows, period = values
        rows = dict(zip(COLUMNS, rows, strict=True))
        found, errors = summed(rows, float(period))
        told = events(rows, float(period))
        padded = [np.concatenate((one, np.full(most - one.size, np.nan))) for one in told.values()]
        return (*found.values(), *errors.values(), *padded)

    names: Sequence[str] = [*ONSET, *(f"{name}_increment_error" for name in ERRORS), *EVENT]
    values = xr.apply_ufunc(
        of_one,
        *columns,
        data.lattice_constant,
        input_core_dims=[["step"]] * len(COLUMNS) + [[]],
        output_core_dims=[[]] * (len(names) - len(EVENT)) + [["event"]] * len(EVENT),
        vectorize=True,
    )
    data = data.assign(dict(zip(names, values, strict=True)))
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
