"""Numbers of how the contact peels up to the onset of sliding, and how much of it comes back at slips."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from contactsim.grid import Array
from contactsim.observables.peeling import (
    edge_peel,
    edge_shift,
    fit_exponent,
    fit_quadratic_law,
    peel_asymmetry,
    peel_rate_ratio,
)
from contactsim.observables.polyline import Polyline

SHRINKING = {"quarter": 0.25, "three_quarters": 0.75}
"""Parts of the length lost up to the onset of sliding at which the shift of the contact is read."""


def peeling_numbers(line: Polyline, states: Mapping[str, Array], onset: int) -> dict[str, float]:
    """Return how the contact peels up to the onset; its laws are fitted to the states with contact."""
    force, length = line.force[: onset + 1], line.length[: onset + 1]
    contact = length > 0
    coefficient, r_squared = fit_quadratic_law(force[contact], length[contact])
    return {
        "quadratic_coefficient": coefficient,
        "quadratic_r_squared": r_squared,
        "quadratic_r_squared_all": fit_quadratic_law(force, length)[1],
        "peel_rate_ratio": peel_rate_ratio(force[contact], length[contact]),
        "peel_exponent": fit_exponent(force[contact], length[contact]),
        "peeled_fraction": 1 - line.length[onset] * per_initial_length(states),
    } | (_edge_numbers(line, states, onset) | _reattachment(line, states))


def _edge_numbers(line: Polyline, states: Mapping[str, Array], onset: int) -> dict[str, float]:
    """Return what peels at each edge and how far the centre shifts, half way to the onset and at the state before."""
    last = int(line.state[onset])
    trailing, leading = (states[f"contact_{edge}_edge"][: last + 1] for edge in ("trailing", "leading"))
    distance = states["sliding_distance"][: last + 1]
    numbers = {
        f"contact_shift_{name}": edge_shift(trailing, leading, share) * per_initial_length(states)
        for name, share in SHRINKING.items()
    }
    for suffix, place in (("_halfway", line.sliding_distance[onset] / 2), ("", float(distance[-1]))):
        behind, ahead = edge_peel(trailing, leading, distance, place)
        numbers |= {
            f"trailing_peel{suffix}": behind,
            f"leading_peel{suffix}": ahead,
            f"peel_asymmetry{suffix}": peel_asymmetry(behind, ahead),
            f"contact_shift{suffix}": (behind - ahead) / 2 * per_initial_length(states),
        }
    return numbers


def _reattachment(line: Polyline, states: Mapping[str, Array]) -> dict[str, float]:
    """Return the parts of the initial contact after the first slip, and regained at it; nothing without a slip.

    A contact that is lost after the slip has no reattached part.
    """
    if not line.slips.size:
        return {}
    first, share = line.slips[0], per_initial_length(states)
    return {
        "reattached_fraction": line.length[first] * share if line.length[first] > 0 else np.nan,
        "regained_fraction": regained_lengths(line)[0] * share,
    }


def regained_lengths(line: Polyline) -> Array:
    """Return the length (nm) by which the contact grows at each slip; NaN of flats."""
    return line.length[line.slips] - line.length[line.slips - 1]


def per_initial_length(states: Mapping[str, Array]) -> float:
    """Return one over the contact length before the slide, 1/nm; NaN without contact."""
    length = states["contact_length"][0]
    return 1 / length if length > 0 else np.nan
