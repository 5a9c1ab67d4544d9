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

    Both are empty for a number that is no extreme of single values, where one of them is unknown, and at one place.
    A finding has no band and no share.
    """
    found = None if claim["absent"] is not None or comparison.is_empty else comparison.extreme()
    if found is None or found[0].size < 2 or bool(found[0].isnull().any()):
        return dict(NO_EXTREME)
    values, place = found
    there = values.isel(place)
    words = ", ".join(range_text(str(dim), *[float(there[dim])] * 2) for dim in values.dims)
    if claim["is_finding"]:
        return {**NO_EXTREME, "extreme_at": words}
    low, high = band(claim)
    return {"extreme_at": words, "share_in_band": float(((values > low) & (values < high)).mean())}
