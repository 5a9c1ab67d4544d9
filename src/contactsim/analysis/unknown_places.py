"""Where a quantity of a claim is unknown, in words."""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.analysis.comparison import Comparison
from contactsim.analysis.quantities import source_quantity, unknown
from contactsim.analysis.wording import quantity_text, range_text


def unknown_places(comparison: Comparison) -> str:
    """Return in words where the quantities are unknown: the first place, and the number of others; else nothing."""
    claim = comparison.claim
    for study in comparison.data:
        for name in filter(None, (claim["quantity"], claim["against"])):
            source = source_quantity(name)
            if source is None or "member" not in study[source].dims:
                continue
            is_unknown = unknown(study, source)
            if claim["absent"] is None and not is_unknown.any():
                is_unknown = study[source].isnull()
            if words := _places_text(study, is_unknown.transpose(*study[source].dims)):
                return f"{quantity_text(source)} at {words}"
    return ""


def _places_text(data: xr.Dataset, marks: xr.DataArray) -> str:
    """Return the first marked place in words, and the number of others; nothing without a mark."""
    places = np.argwhere(marks.values)
    if not len(places):
        return ""
    coordinates = ((str(dim), data[dim].values[index]) for dim, index in zip(marks.dims, places[0], strict=True))
    words = ", ".join(range_text(dim, value, value) for dim, value in coordinates)
    return words + (f" and {len(places) - 1} more" if len(places) > 1 else "")
