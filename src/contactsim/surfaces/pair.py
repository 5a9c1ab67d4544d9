"""Heights of two bodies that face each other: only their sum counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from contactsim.errors import InputError, Words
from contactsim.grid import Array
from contactsim.surfaces.topography import Topography
from contactsim.topography_files.io import TOLERANCE


def add_heights(
    first: Topography, second: Topography | None, offset: int | Sequence[int] | None, periodic: bool
) -> Topography:
    """Return the sum of the heights of two bodies, those of the first where the second is flat.

    Parameters
    ----------
    first : Topography
        Heights of a body.
    second : Topography or None
        Heights of the other at the same places, each positive towards the other body; None for a flat one.
    offset : int, (int, int) or None
        Whole points by which the second is moved, along x or along (y, x).
    periodic : bool
        True: what leaves at one end comes in at the other; False: only the part in which both have heights is kept.

    Raises
    ------
    InputError
        For different spacings, of periodic heights for different shapes, for an offset that is none, or one that leaves
        fewer than two points each way, or is given without a second body.
    """
    if second is None:
        if offset is not None:
            raise InputError("offset", offset, "none without the heights of another body")
        return first
    here, there = first.values, second.values
    if here.ndim != there.ndim or (periodic and here.shape != there.shape):
        raise InputError("other", Words(f"shape {there.shape}"), f"that of heights, {here.shape}")
    if not np.allclose(first.spacing, second.spacing, rtol=TOLERANCE, atol=0):
        raise InputError("other", Words(f"spacing {second.spacing}"), f"that of heights, {first.spacing}")
    moves = _moves(offset, here.ndim)
    if periodic:
        return replace(first, values=here + np.roll(there, moves, tuple(range(here.ndim))))
    back = [-move for move in moves]
    return replace(first, values=here[_facing(here, there, moves)] + there[_facing(there, here, back)])


def _moves(offset: int | Sequence[int] | None, dimensions: int) -> list[int]:
    """Return the points to move in each direction, x last."""
    if offset is None:
        return [0] * dimensions
    moves = list(offset) if isinstance(offset, Sequence) else [offset]
    if len(moves) != dimensions:
        allowed = "whole points along x" if dimensions == 1 else "a pair of whole points, along y and along x"
        raise InputError("offset", offset, allowed)
    return moves


def _facing(heights: Array, others: Array, moves: list[int]) -> tuple[slice, ...]:
    """Return the part of heights that faces others which are moved."""
    sizes = zip(heights.shape, others.shape, moves, strict=True)
    part = tuple(slice(max(move, 0), max(min(size, other + move), 0)) for size, other, move in sizes)
    if min(heights[part].shape) < 2:
        raise InputError("offset", Words(", ".join(map(str, moves))), "one that leaves two points or more each way")
    return part
