"""Where the extreme lies that answers a claim, and for which share of loads and variants the claim holds."""

from __future__ import annotations

from collections.abc import Mapping

from contactsim.analysis.comparison import Comparison
from contactsim.analysis.verdict import band
from contactsim.analysis.wording import range_text

NO_EXTREME: Mapping[str, object] = {"extreme_at": "", "share_in_band": float("nan")}
"""Entries of a row without an extreme."""


def describe_extreme(claim: Mapping, comparison: Comparison) -> dict[str, object]:
    """Return the place of the extreme in words, and the share of all loads and variants with a value in the band.

    Both are those of the means over all members. A finding has no band, so no share. There is neither for

    - a number that is not the least or the largest of single values;
    - values of which one is unknown, or does not exist;
    - a single value.
    """
    extreme = None if claim["absent"] is not None or comparison.is_empty else comparison.extreme()
    if extreme is None or extreme[0].size < 2 or bool(extreme[0].isnull().any()):
        return dict(NO_EXTREME)
    values, place = extreme
    coordinates = values.isel(place)
    place_text = ", ".join(range_text(str(dim), *[float(coordinates[dim])] * 2) for dim in values.dims)
    if claim["is_finding"]:
        return {**NO_EXTREME, "extreme_at": place_text}
    low, high = band(claim)
    return {"extreme_at": place_text, "share_in_band": float(((values > low) & (values < high)).mean())}
