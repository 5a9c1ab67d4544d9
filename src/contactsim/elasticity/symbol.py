"""Symbols: matrices that are diagonal in Fourier space and act on one or two components of a field.

At each wavenumber a compliance takes tractions to displacements, a stiffness the other way. Rows are the components,
normal and then along x. With one component the matrix is a number; with two it is [[nn, i·nt], [-i·nt, tt]], with three
real numbers: Hermitian and mirror symmetric.

The uniform mode of half-spaces and incompressible layers is held: it does not move, by convention or because volume is
kept. Its entry is zero in a compliance and in every inverse, so that no infinity is ever multiplied.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Protocol

import numpy as np

from contactsim.grid import Array


class Symbol(Protocol):
    """A matrix at each wavenumber that acts on coefficients of shape (component, …)."""

    components: ClassVar[tuple[str, ...]]

    @property
    def diagonal(self) -> Array:
        """Entry of each component with itself, shape (component, …)."""
        ...

    @property
    def held(self) -> Array:
        """Components and modes that do not move, shape (component, …), boolean."""
        ...

    def apply(self, coefficients: Array, out: Array | None = None) -> Array:
        """Return the product with coefficients, shape (component, …), also in `out`, which may be `coefficients`."""
        ...

    def inverse(self, shift: float | Array = 0.0) -> Symbol:
        """Return the inverse of the symbol plus `shift` ≥ 0, one number or one for each component; held modes stay."""
        ...

    def with_diagonal(self, diagonal: Array) -> Symbol:
        """Return the same symbol with other entries of each component with itself."""
        ...

    def flattened(self) -> Symbol:
        """Return the symbol with all wavenumbers in one row, shape (component, m)."""
        ...

    def modes(self, selection: slice | Array) -> Symbol:
        """Return the symbol, with its wavenumbers in one row, at some of them."""
        ...

    def coarser(self, places: Array, shortest: Array) -> Symbol:
        """Return the symbol on a coarser grid: some of its waves (m,), the shortest of them (m,) uncoupled."""
        ...


@dataclass(frozen=True)
class NormalSymbol:
    """Symbol of the normal component alone.

    Parameters
    ----------
    diagonal : array, shape (1, …)
        Entry nn at each wavenumber.
    """

    diagonal: Array
    components: ClassVar[tuple[str, ...]] = ("n",)

    @cached_property
    def held(self) -> Array:
        """Modes that do not move, shape (1, …), boolean."""
        return self.diagonal == 0

    def apply(self, coefficients: Array, out: Array | None = None) -> Array:
        """Return the product with coefficients, shape (1, …); `out`, which may be `coefficients`, receives it."""
        return np.multiply(self.diagonal, coefficients, out=out)

    def inverse(self, shift: float | Array = 0.0) -> NormalSymbol:
        """Return one over the sum of the diagonal and `shift`; held modes stay zero."""
        moved = np.add(self.diagonal, np.reshape(shift, (-1,) + (1,) * (self.diagonal.ndim - 1)))
        return NormalSymbol(np.divide(1.0, moved, out=np.zeros_like(moved), where=~self.held))

    def with_diagonal(self, diagonal: Array) -> NormalSymbol:
        """Return the same symbol with other entries of each component with itself."""
        return replace(self, diagonal=diagonal)

    def flattened(self) -> NormalSymbol:
        """Return the symbol with all wavenumbers in one row, shape (1, m)."""
        return NormalSymbol(self.diagonal.reshape(1, -1))

    def modes(self, selection: slice | Array) -> NormalSymbol:
        """Return the symbol, with its wavenumbers in one row, at some of them."""
        return NormalSymbol(self.diagonal[:, selection])

    def coarser(self, places: Array, shortest: Array) -> NormalSymbol:
        """Return the symbol on a coarser grid: some of its waves (m,)."""
        return self.modes(places)

    def mirrored(self) -> NormalSymbol:
        """Return the symbol of the same body upside down."""
        return self

    def __add__(self, other: NormalSymbol) -> NormalSymbol:
        return NormalSymbol(self.diagonal + other.diagonal)


@dataclass(frozen=True)
class CoupledSymbol:
    """Symbol of two coupled components of a line, normal and along x.

    Parameters
    ----------
    diagonal : array, shape (2, m)
        Entries nn and tt.
    coupling : array, shape (m,)
        Imaginary part nt of the entry that takes t to n; zero where either component is held.
    """

    diagonal: Array
    coupling: Array
    components: ClassVar[tuple[str, ...]] = ("n", "t")

    @cached_property
    def held(self) -> Array:
        """Components and modes that do not move, shape (2, m), boolean."""
        return self.diagonal == 0

    @cached_property
    def _straight(self) -> Array:
        """Diagonal as complex numbers: numpy multiplies two complex arrays twice as fast."""
        return self.diagonal.astype(complex)

    @cached_property
    def _cross(self) -> Array:
        """Entries that take t to n, and n to t, shape (2, m), complex."""
        return 1j * np.stack([self.coupling, -self.coupling])

    def apply(self, coefficients: Array, out: Array | None = None) -> Array:
        """Return the product with coefficients, shape (2, m); `out`, which may be `coefficients`, receives it."""
        crossed = self._cross * coefficients[::-1]
        out = np.multiply(self._straight, coefficients, out=out)
        out += crossed
        return out

    def inverse(self, shift: float | Array = 0.0) -> CoupledSymbol:
        """Return the inverse of the symbol plus `shift`, one number or one for each component; held modes stay.

        For a compliance or a stiffness, both positive definite, errors are below 3e-15 √(nn·tt).
        """
        moved = np.where(self.held, 1.0, self.diagonal + np.reshape(shift, (-1, 1)))
        determinant = moved[0] * moved[1] - self.coupling**2
        diagonal = np.where(self.held, 0.0, moved[::-1] / determinant)
        return CoupledSymbol(diagonal, -self.coupling / determinant)

    def with_diagonal(self, diagonal: Array) -> CoupledSymbol:
        """Return the same symbol with other entries of each component with itself."""
        return replace(self, diagonal=diagonal)

    def flattened(self) -> CoupledSymbol:
        """Return the symbol itself: that of a line is one row."""
        return self

    def modes(self, selection: slice | Array) -> CoupledSymbol:
        """Return the symbol at some of the wavenumbers."""
        return CoupledSymbol(self.diagonal[:, selection], self.coupling[selection])

    def coarser(self, places: Array, shortest: Array) -> CoupledSymbol:
        """Return the symbol on a coarser grid: some of its waves (m,), the shortest of them (m,) uncoupled."""
        part = self.modes(places)
        return CoupledSymbol(part.diagonal, np.where(shortest, 0.0, part.coupling))

    def mirrored(self) -> CoupledSymbol:
        """Return the symbol of the same body upside down: the coupling changes sign."""
        return CoupledSymbol(self.diagonal, -self.coupling)

    def __add__(self, other: CoupledSymbol) -> CoupledSymbol:
        return CoupledSymbol(self.diagonal + other.diagonal, self.coupling + other.coupling)

    def without_shear(self) -> NormalSymbol:
        """Return, of a compliance, that of a surface without shear, which slips."""
        return NormalSymbol(self.diagonal[:1])

    def slip(self) -> Array:
        """Return, of a compliance, the ratio of displacement along x to normal displacement without shear.

        The ratio is complex, shape (m,), and 0 for held modes.
        """
        normal = self.diagonal[0]
        return -1j * np.divide(self.coupling, normal, out=np.zeros_like(normal), where=normal != 0)
