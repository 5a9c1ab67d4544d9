"""Prolongation of a signed field from one grid of a surface to a finer one, compiled."""

from __future__ import annotations

import numpy as np

from contactsim.solvers.hard_wall.kernels import compiled


@compiled
def interpolate(before, left, right, after, part):
    """Return a signed field `part` of the way from left to right: cubic at one sign, else linear in the square."""
    if part == 0.0:
        return left
    if (before > 0) == (left > 0) == (right > 0) == (after > 0):
        a = -part * (part - 1) * (part - 2) / 6
        b = (part + 1) * (part - 1) * (part - 2) / 2
        c = -(part + 1) * part * (part - 2) / 2
        d = (part + 1) * part * (part - 1) / 6
        return a * before + b * left + c * right + d * after
    square = (1 - part) * left * abs(left) + part * right * abs(right)
    return np.sqrt(square) if square > 0 else -np.sqrt(-square)


@compiled
def interpolate_row(signed, row, line):
    """Write one periodic row of a signed field on the points of a longer line."""
    mx, nx = signed.shape[1], line.size
    for j in range(nx):
        at = j * mx // nx
        west = at - 1 if at > 0 else mx - 1
        east = at + 1 if at < mx - 1 else 0
        far = east + 1 if east < mx - 1 else 0
        part = (j * mx - at * nx) / nx
        line[j] = interpolate(signed[row, west], signed[row, at], signed[row, east], signed[row, far], part)


@compiled
def refine(low, high, nx, signed, out, sums):
    """Write a signed field (my, mx) on a finer grid out (ny, nx), along x, then along y; negative values are 0."""
    ny = out.shape[0]
    my = signed.shape[0]
    lines = np.empty((4, nx))
    held = np.full(4, -1)
    for i in range(low, high):
        first = i * my // ny
        for k in range(4):
            row = (first - 1 + k) % my
            slot = (first + 3 + k) % 4
            if held[slot] != row:
                interpolate_row(signed, row, lines[slot])
                held[slot] = row
        before = (first + 3) % 4
        left = first % 4
        right = (first + 1) % 4
        after = (first + 2) % 4
        part = (i * my - first * ny) / ny
        for j in range(nx):
            out[i, j] = max(interpolate(lines[before, j], lines[left, j], lines[right, j], lines[after, j], part), 0.0)
