"""Factors of 1 + D C on a process zone: solutions for them, and displacements that grow on their own.

C is the compliance of the zone and D the tangent of the laws there. The tractions t = (1 + D C)⁻¹ D u belong to the
displacement u - C t, and displacements grow where K + D, with K = C⁻¹, has eigenvalues with a negative real part.

Where a law reads and exerts one component alone, C + D⁻¹ is symmetric. As K is positive definite, K + D has as many
negative eigenvalues as C + D⁻¹ has positive ones beyond those of D (Sylvester's law of inertia, for both orders of
elimination of the matrix with the blocks K, 1, 1 and -D⁻¹). The factors show their signs. Other matrices need not be
symmetric. Nothing grows where the symmetric part of C (1 + D C), which is that of K + D for displacements C t, is
positive definite; only elsewhere eigenvalues are computed, of (1 + D C) t = λ C t. These are the rates of the
overdamped motion -du/dt = (K + D) u of the zone, which the rest of the surface follows without delay. Those of 1 + D C
have other signs where a motion swings while it grows.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.linalg import cholesky, eigh
from scipy.linalg.lapack import dgetrf, dgetrs, dpotrf, dsytrf, dsytrs

from contactsim.grid import Array

ROUNDING = 1e-9
"""Part of its diagonal that is added to the compliance of a zone, so that rounding does not make it indefinite."""


class ZoneFactors(Protocol):
    """Factors of 1 + D C on a process zone; tractions are (exerted, zone), displacements (read, zone)."""

    def solve(self, displacement: Array) -> Array:
        """Return the tractions (1 + D C)⁻¹ D u under a displacement u."""

    def growing(self) -> Array | None:
        """Return the tractions of the displacement that grows most on its own; None if none does.

        One traction (1, exerted, zone), or two of a displacement that swings.
        """


class SymmetricFactors:
    """Factors for laws that read and exert the normal component alone.

    Parameters
    ----------
    tangent
        D (zone,), GPa/nm, nowhere zero.
    compliance
        C (zone, zone), nm/GPa.
    """

    def __init__(self, tangent: Array, compliance: Array) -> None:
        self._tangent, self._compliance = tangent, compliance
        matrix = compliance.copy()
        matrix[np.diag_indices(len(matrix))] += 1 / tangent
        self._factors, self._pivots, _ = dsytrf(matrix, lower=1, lwork=64 * len(matrix), overwrite_a=1)

    def solve(self, displacement: Array) -> Array:
        """Return the tractions (1 + D C)⁻¹ D u = (C + D⁻¹)⁻¹ u under a displacement u."""
        traction, _ = dsytrs(self._factors, self._pivots, displacement[0], lower=1)
        return traction[None]

    @property
    def negative(self) -> int:
        """Number of negative eigenvalues of K + D."""
        alone = self._pivots > 0  # a pair of rows that are eliminated together has an eigenvalue of each sign
        pairs = np.count_nonzero(~alone) // 2
        positive = np.count_nonzero(self._factors.diagonal()[alone] > 0) + pairs
        return int(positive - np.count_nonzero(self._tangent > 0))

    def growing(self) -> Array | None:
        """Return the traction (1, 1, zone) of the displacement that grows most on its own; None if none does.

        With C = L Lᵀ the matrix 1 + Lᵀ D L is symmetric and has the eigenvalues of 1 + D C, and eigenvectors L⁻¹ w.
        """
        if self.negative <= 0:
            return None
        compliance = self._compliance.copy()
        compliance[np.diag_indices(len(compliance))] *= 1 + ROUNDING  # C is singular where the zone is everywhere
        lower = cholesky(compliance, lower=True)
        symmetric = lower.T @ (self._tangent[:, None] * lower)
        symmetric[np.diag_indices(len(symmetric))] += 1
        values, vectors = eigh(symmetric, subset_by_index=[0, 0])
        return (self._tangent * (lower @ vectors[:, 0]))[None, None] if values[0] < 0 else None


class GeneralFactors:
    """Factors for laws that read or exert two components.

    Parameters
    ----------
    tangent
        D (exerted, read, zone), GPa/nm.
    compliance
        C (read, zone, exerted, zone), nm/GPa; the exerted components are the first ones.
    """

    def __init__(self, tangent: Array, compliance: Array) -> None:
        self._tangent = tangent
        exerted, _, zone = tangent.shape
        self._compliance = compliance[:exerted].reshape(exerted * zone, -1)
        flat = compliance.reshape(len(compliance), zone, -1)
        matrix = tangent[:, 0, :, None] * flat[0]
        for read in range(1, len(flat)):
            matrix += tangent[:, read, :, None] * flat[read]
        self._matrix = matrix.reshape(exerted * zone, -1)
        self._matrix[np.diag_indices(exerted * zone)] += 1
        self._factors, self._swaps, _ = dgetrf(self._matrix)

    def solve(self, displacement: Array) -> Array:
        """Return the tractions (1 + D C)⁻¹ D u under a displacement u."""
        pull = (self._tangent * displacement).sum(1)
        return dgetrs(self._factors, self._swaps, pull.ravel())[0].reshape(pull.shape)

    @property
    def is_definite(self) -> bool:
        """True where the symmetric part of K + D is positive definite, so that nothing grows."""
        half = self._compliance @ self._matrix
        symmetric = half + half.T
        symmetric[np.diag_indices(len(symmetric))] += 2 * ROUNDING * self._compliance.diagonal()
        return bool(dpotrf(symmetric, overwrite_a=1)[1] == 0)

    def growing(self) -> Array | None:
        """Return the tractions (1 or 2, exerted, zone) of what grows most on its own; None if nothing does."""
        if self.is_definite:
            return None
        compliance = self._compliance.copy()
        compliance[np.diag_indices(len(compliance))] *= 1 + ROUNDING
        stiffness = np.linalg.solve(compliance.T, self._matrix.T).T  # K + D, of displacements of the zone
        if np.linalg.eigvals(stiffness).real.min() >= 0:  # no eigenvectors are needed
            return None
        rates, displacements = np.linalg.eig(stiffness)
        most = np.argmin(rates.real)
        traction = np.linalg.solve(compliance, displacements[:, most]).reshape(len(self._tangent), -1)
        return np.stack([traction.real, traction.imag] if rates[most].imag else [traction.real])
