"""Generalised minimal residual method on Fourier coefficients, for maps that are linear over the real numbers.

Coefficients of a real transform are treated as pairs of real numbers. In their Euclidean inner product the uniform and
the shortest wave count twice as much as the others, which is a norm as good as any.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contactsim.grid import Array

LEAST_LEFT = 0.1
"""Part of a vector's length down to which it is made orthogonal once, not twice."""
LinearMap = Callable[[Array], Array]


def gmres(
    product: LinearMap, precondition: LinearMap, target: Array, tolerance: float, budget: int
) -> tuple[Array, int]:
    """Solve product(x) = target, preconditioned from the right.

    Parameters
    ----------
    product
        The linear map.
    precondition
        Its approximate inverse.
    target
        Complex, of any shape.
    tolerance
        Relative residual.
    budget
        Largest number of iterations.

    Returns
    -------
    x, iterations
        The best x within the budget, of the shape of the target, and the number of iterations.

    References
    ----------
    Y. Saad and M. H. Schultz, SIAM J. Sci. Stat. Comput. 7, 856 (1986), doi:10.1137/0907058.
    """
    flat = target.reshape(-1).view(float)
    norm = np.linalg.norm(flat)
    if norm == 0:
        return np.zeros_like(target), 0
    basis = np.empty((budget + 1, flat.size))
    basis[0] = flat / norm
    steps: list[Array] = []
    hessenberg = np.zeros((budget + 1, budget))
    rotations: list[tuple[float, float]] = []
    right = np.zeros(budget + 1)
    right[0] = norm
    for column in range(budget):
        steps.append(precondition(basis[column].view(complex).reshape(target.shape)))
        vector = product(steps[-1]).reshape(-1).view(float)
        entries = hessenberg[: column + 2, column]
        _orthogonalise(vector, basis[: column + 1], entries)
        broken = not entries[-1] > 0
        if not broken:
            np.divide(vector, entries[-1], out=basis[column + 1])
        if not _eliminate(entries, right[column : column + 2], rotations):
            steps.pop()
            break
        if broken or abs(right[column + 1]) <= tolerance * norm:
            break
    return _combine(steps, hessenberg, right, target), len(steps)


def _orthogonalise(vector: Array, basis: Array, entries: Array) -> None:
    """Take from a vector its parts along an orthonormal basis; add them, and write its norm, to a column of H.

    Where little of it is left, so that rounding counts, a second pass takes what the first has left.
    """
    for _ in range(2):
        size, shares = np.linalg.norm(vector), basis @ vector
        vector -= shares @ basis
        entries[:-1] += shares
        entries[-1] = np.linalg.norm(vector)
        if entries[-1] > LEAST_LEFT * size:
            break


def _eliminate(entries: Array, right: Array, rotations: list[tuple[float, float]]) -> bool:
    """Rotate a column of H so that its last entry is zero, and the right-hand side with it.

    The rotations of earlier columns come first. Returns False for a column of zeros, which is no use.
    """
    for row, (cosine, sine) in enumerate(rotations):
        upper, lower = entries[row], entries[row + 1]
        entries[row], entries[row + 1] = cosine * upper + sine * lower, cosine * lower - sine * upper
    length = np.hypot(entries[-2], entries[-1])
    if not length > 0:
        return False
    cosine, sine = entries[-2] / length, entries[-1] / length
    rotations.append((cosine, sine))
    entries[-2], entries[-1] = length, 0.0
    right[0], right[1] = cosine * right[0], -sine * right[0]
    return True


def _combine(steps: list[Array], hessenberg: Array, right: Array, target: Array) -> Array:
    """Return the sum of the steps that leaves the smallest residual, of the shape of the target."""
    from scipy.linalg.lapack import dtrtrs  # takes longer to import than the rest of a solver

    out, count = np.zeros_like(target), len(steps)
    if not count:
        return out
    weights = dtrtrs(hessenberg[:count, :count], right[:count])[0]
    for weight, step in zip(weights, steps, strict=True):
        out += weight * step
    return out
