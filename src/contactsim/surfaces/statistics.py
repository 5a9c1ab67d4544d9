"""Statistics of height profiles, over all of a surface or over the part in contact.

Root-mean-square height, gradient and curvature by finite differences on the periodic grid.
Eq. 3.8 gives a contact point the mean of its two squared slopes, one of which leads out of the contact at an edge of
a patch: the statistic then depends on the grid. `rms_gradient_pairs` counts only the slopes between two points that
are both in contact; in the limit of a fine grid the two agree, on real grids the second is there already.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from contactsim.grid import Array, blocks


def rms_height(heights: Array, where: Array | None = None) -> float:
    """Root-mean-square deviation from the mean height, any shape, in the unit of heights."""
    chosen = heights if where is None else heights[where]
    return float(np.std(chosen)) if chosen.size else float("nan")


def _strips(fields: Sequence[Array]) -> Iterator[list[Array]]:
    """The same block of rows of each field, with the row before and the one after, periodic; a line is one row."""
    for low, high in blocks(fields[0].shape):
        rows = np.arange(low - 1, high + 1)
        yield [np.take(field.reshape(-1, field.shape[-1]), rows, axis=0, mode="wrap") for field in fields]


def _neighbours(strip: Array, axis: int) -> tuple[Array, Array]:
    """Those before and after, along an axis of the surface, the points of a strip's inner rows."""
    if axis == 0:
        return strip[:-2], strip[2:]
    return np.roll(strip[1:-1], 1, 1), np.roll(strip[1:-1], -1, 1)


def _squares(strip: Array, axis: int, step: float) -> Array:
    """Mean of the two squared slopes along an axis at each point of a strip's inner rows."""
    here, (before, after) = strip[1:-1], _neighbours(strip, axis)
    return 0.5 * (((after - here) / step) ** 2 + ((here - before) / step) ** 2)


def _steps(spacing: float | Sequence[float], dimensions: int) -> list[tuple[int, float]]:
    """Each axis of the surface, of which a line has the second, and the spacing along it."""
    return list(zip(range(2 - dimensions, 2), np.broadcast_to(spacing, dimensions), strict=True))


def rms_gradient(heights: Array, spacing: float | Sequence[float], where: Array | None = None) -> float:
    """Root-mean-square gradient over the points in `where`, default all (Eqs 3.8 and 3.9).

    Over a surface the mean squares along both axes are added: this reading of Eq. 3.8 gives c/(R√2) for a sphere, as
    Table 3.1 has it, and the text's κ_r; half of that sum would not. heights: (n,) or (ny, nx) and spacing (one, or one
    each direction) in one unit; where: bool of the same shape. NaN if `where` is empty.
    """
    total, count = np.zeros(2), 0
    for strip, *chosen in _strips([heights] if where is None else [heights, where]):
        pick = chosen[0][1:-1] if chosen else np.s_[:]
        for axis, step in _steps(spacing, heights.ndim):
            local = _squares(strip, axis, step)[pick]
            total[axis] += local.sum()
        count += local.size
    return float(np.sqrt(np.sum(total / count))) if count else float("nan")


def local_squares(heights: Array, spacing: float | Sequence[float]) -> Array:
    """Mean of the two squared slopes at each point (Eq. 3.8), over a surface their sum along both axes.

    heights: (n,) or (ny, nx), the shape of what is returned, and spacing (one, or one each direction) in one unit.
    """
    steps = _steps(spacing, heights.ndim)
    blocks_of_rows = [sum(_squares(strip, axis, step) for axis, step in steps) for (strip,) in _strips([heights])]
    return np.concatenate(blocks_of_rows).reshape(heights.shape)


def rms_gradient_pairs(heights: Array, spacing: float | Sequence[float], where: Array) -> float:
    """Root-mean-square slope over neighbouring pairs with both ends in `where`; NaN without such a pair.

    Over a surface the mean squares of the pairs along each axis are added. heights: (n,) or (ny, nx) and spacing (one,
    or one each direction) in one unit; where: bool of the same shape.
    """
    steps = _steps(spacing, heights.ndim)
    total, count = np.zeros(len(steps)), np.zeros(len(steps), int)
    for strip, chosen in _strips([heights, where]):
        for place, (axis, step) in enumerate(steps):
            both = chosen[1:-1] & _neighbours(chosen, axis)[1]
            slopes = (_neighbours(strip, axis)[1] - strip[1:-1])[both] / step
            total[place] += np.sum(slopes**2)
            count[place] += slopes.size
    return float(np.sqrt(np.sum(total / count))) if count.all() else float("nan")


def rms_curvature(heights: Array, spacing: float | Sequence[float], where: Array | None = None) -> float:
    """Root-mean-square curvature, over a surface of the mean of both directions, in 1/unit of spacing.

    heights: (n,) or (ny, nx); spacing: one, or one each direction; NaN if `where` is empty.
    """
    total, count = 0.0, 0
    for strip, *chosen in _strips([heights] if where is None else [heights, where]):
        here = strip[1:-1]
        second = np.zeros(here.shape)
        for axis, step in _steps(spacing, heights.ndim):
            before, after = _neighbours(strip, axis)
            second += (after - 2 * here + before) / (step**2 * heights.ndim)
        picked = second[chosen[0][1:-1]] if chosen else second
        total += np.sum(picked**2)
        count += picked.size
    return float(np.sqrt(total / count)) if count else float("nan")
