"""A signed field continued from one grid of a surface to a finer one, compiled: what a cascade starts a level from."""

from __future__ import annotations

import numpy as np

from contactsim.solvers.hard_wall.kernels import compiled


@compiled
def between(before, left, right, after, part):
    """A signed field `part` of the way from left to right: cubic among one sign, else linear in the signed square."""
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
def along_x(signed, row, line):
    """One row of a signed field, periodic, on the points of a longer line."""
    mx, nx = signed.shape[1], line.size
    for j in range(nx):
        at = j * mx // nx
        west = at - 1 if at > 0 else mx - 1
        east = at + 1 if at < mx - 1 else 0
        far = east + 1 if east < mx - 1 else 0
        part = (j * mx - at * nx) / nx
        line[j] = between(signed[row, west], signed[row, at], signed[row, east], signed[row, far], part)


@compiled
def refine(low, high, nx, signed, out, sums):
    """A signed field (my, mx) on the points of a finer grid out (ny, nx), first along x, then along y; clipped at 0."""
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
                along_x(signed, row, lines[slot])
                held[slot] = row
        before = (first + 3) % 4
        left = first % 4
        right = (first + 1) % 4
        after = (first + 2) % 4
        part = (i * my - first * ny) / ny
        for j in range(nx):
            out[i, j] = max(between(lines[before, j], lines[left, j], lines[right, j], lines[after, j], part), 0.0)
