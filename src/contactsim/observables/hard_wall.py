"""The numbers of one state at a hard wall."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from contactsim.grid import Array
from contactsim.observables.contact import contact_edges, relative_contact_area_subgrid, touching
from contactsim.observables.edge_correction import ContactGradient, corrected_area
from contactsim.surfaces.height_statistics import STATISTICS


def wall_observables(
    heights: Array,
    squared_gradient: Iterable[tuple[slice, Array]],
    spacing: Sequence[float],
    pressure: Array,
    gap: Array,
    periodic: bool = True,
) -> dict[str, float]:
    """Return the numbers of one hard-wall state.

    Parameters
    ----------
    heights, pressure, gap : array, shape (n,) or (ny, nx)
        In nm, GPa and nm.
    squared_gradient : iterable of (slice, array)
        Squared gradient of the heights, by blocks of rows.
    spacing : sequence of float
        Distance between points in each direction, nm.
    periodic : bool
        Whether the contact goes on at the other end of the heights.

    Returns
    -------
    dict
        Relative contact area by points, corrected for the mean excess of edges, and with edges between points; pairs of
        points at edges; rms gradient over the contact (Eqs 3.8-3.9), of pairs with both ends in contact, and over the
        two other areas, NaN without contact; mean gap, nm; mean and largest pressure, GPa.
    """
    contact = touching(pressure)
    corrected, subgrid = corrected_area(contact, periodic), relative_contact_area_subgrid(pressure, gap, periodic)
    gradient = ContactGradient.of(squared_gradient, contact, periodic)
    statistics = STATISTICS[periodic]
    return {
        "relative_contact_area": float(contact.mean()),
        "relative_contact_area_corrected": corrected,
        "relative_contact_area_subgrid": subgrid,
        "contact_edges": contact_edges(contact, periodic),
        "rms_gradient_contact": statistics.rms_gradient(heights, spacing, contact),
        "rms_gradient_contact_pairs": statistics.rms_gradient_pairs(heights, spacing, contact),
        "rms_gradient_contact_corrected": gradient.within(corrected),
        "rms_gradient_contact_subgrid": gradient.within(subgrid),
        "mean_gap": float(gap.mean()),
        "mean_pressure": float(pressure.mean()),
        "max_pressure": float(pressure.max()),
    }
