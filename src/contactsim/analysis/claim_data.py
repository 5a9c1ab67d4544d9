"""The data that answer a claim, in words: studies, members, points and loads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.analysis.comparison import SECOND_STUDY, Comparison, studies_of
from contactsim.analysis.more_members import TRANSFERRED_FROM
from contactsim.variables import LOADS

NAME_MARKS = "`{}`"
"""How the name of a study is marked."""


def data_text(claim: Mapping, data: Sequence[xr.Dataset]) -> str:
    """Return the studies of a claim with their members, points and loads; nothing for an equation.

    Parameters
    ----------
    claim
        Settings of the claim.
    data
        Datasets of its studies: none, one, or two for a comparison.
    """
    if not data:
        return ""
    words = ["", *(second.word for key, second in SECOND_STUDY.items() if claim[key])]
    selected = Comparison(claim, data).select(claim["select"]).data
    parts = [f"{word} {NAME_MARKS.format(name)}" for word, name in zip(words, studies_of(claim), strict=True)]
    texts = [f"{part}: {_size_text(study)}" for part, study in zip(parts, selected, strict=True)]
    return "; ".join(text.strip() for text in texts)


def _size_text(data: xr.Dataset) -> str:
    """Return members, points and loads of a dataset, and the studies that further members come from."""
    is_random = dataset.settings_of(data)["surface"]["kind"] == "self_affine"
    square = "²" * ("length_y" in data)
    points = " or ".join(f"{int(number)}{square}" for number in np.unique(data.points))
    (_, members, _), *others = data.attrs.get(TRANSFERRED_FROM, [("", data.sizes.get("member", 1), 0)])
    parts = [f"{members} member{'s' * (members > 1)} of {points} points" if is_random else f"{points} points"]
    parts += [f"{count} of {number}{square} ({NAME_MARKS.format(name)})" for name, count, number in others]
    loads = [data.sizes[load] for load in LOADS if load in data.dims]
    return ", ".join([" and ".join(parts), *(f"{number} load{'s' * (number > 1)}" for number in loads)])
