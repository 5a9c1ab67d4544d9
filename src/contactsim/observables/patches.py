"""Patches of contact: points in contact that are connected along the grid."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from contactsim.arguments import Only, checked
from contactsim.grid import Array

AREA_EDGES = 2.0 ** np.arange(-30, 1)
"""Ends of the bins of areas of patches, over the area of the heights; the last is in the last bin."""
AREA_BINS = np.sqrt(AREA_EDGES[1:] * AREA_EDGES[:-1])
"""Geometric middle of each bin."""

Contact = Annotated[
    NDArray[Any],
    Only(
        "an array of bool in 1D or 2D, such as `contact` of a result",
        lambda contact: contact.dtype == bool and contact.ndim in (1, 2) and contact.size > 0,
    ),
]


@dataclass(frozen=True)
class Patches:
    """Patches of contact of one state.

    Parameters
    ----------
    labels : array, shape (n,) or (ny, nx)
        Number of the patch of each point, from 1; 0 without contact.
    points : array, shape (patch,)
        Points of each patch.
    spans : tuple of bool
        Whether a patch goes from one end of the heights to the other in each direction, x last.
    """

    labels: Array = field(repr=False)
    points: Array
    spans: tuple[bool, ...]

    @property
    def count(self) -> int:
        """Number of patches."""
        return self.points.size

    @property
    def counts_by_area(self) -> Array:
        """Number of patches by their area over that of the heights, in the bins `AREA_EDGES`."""
        return np.histogram(self.points / self.labels.size, AREA_EDGES)[0].astype(float)

    @property
    def numbers(self) -> dict[str, float]:
        """Number of patches, share of the contact in the largest one, and 1 where a patch spans the heights, else 0."""
        share = self.points.max() / self.points.sum() if self.count else np.nan
        return {"patches": self.count, "largest_patch_share": share, "spanning": float(any(self.spans))}


@checked
def find_patches(contact: Contact, periodic: bool = True) -> Patches:
    """Return the patches of a contact set.

    Parameters
    ----------
    contact : array of bool, shape (n,) or (ny, nx)
        Points in contact; neighbours along the grid are connected, two on a line and four on a surface.
    periodic : bool
        Whether patches go on at the other end.
    """
    from scipy.ndimage import label  # takes longer to import than most contacts to label

    labels_inside, count = label(contact)
    across = [_pairs_across(labels_inside, axis) if periodic else np.zeros((2, 0), int) for axis in range(contact.ndim)]
    spans = []
    for axis in range(contact.ndim):
        others = [pairs for other, pairs in enumerate(across) if other != axis]
        labels = _merge(labels_inside, count, others)
        ends = labels.take(0, axis), labels.take(-1, axis)
        spans.append(bool(np.intersect1d(ends[0][ends[0] > 0], ends[1]).size))
    labels = _merge(labels_inside, count, across)
    return Patches(labels, np.bincount(labels.ravel(), minlength=1)[1:], tuple(spans))


def _pairs_across(labels: Array, axis: int) -> Array:
    """Return the labels of points in contact that are neighbours across the period, (2, m)."""
    ends = np.stack([labels.take(0, axis).ravel(), labels.take(-1, axis).ravel()])
    return ends[:, (ends > 0).all(0)]


def _merge(labels: Array, count: int, pairs: list[Array]) -> Array:
    """Return labels (from 1 to `count`) in which pairs are one, numbered in the order of their first points."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    rows, columns = np.concatenate([np.zeros((2, 0), int), *pairs], axis=1) - 1
    links = coo_array((np.ones(rows.size), (rows, columns)), shape=(count, count))
    merged = connected_components(links, directed=False)[1] if count else np.zeros(0, int)
    return np.asarray(np.concatenate([[0], merged + 1])[labels])
