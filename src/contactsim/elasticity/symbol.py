"""What is diagonal in Fourier space and acts on one or two components of a field at once.

A symbol gives, at each wavenumber of a real transform, the matrix that takes one surface field to another: a compliance
takes tractions to displacements, a stiffness the other way. Rows are the components, normal and then along x, as a
scene lists them, and a solver need not know how many there are. With one component the matrix is a number; with two it
is [[nn, i·nt], [-i·nt, tt]], three real numbers: Hermitian, and mirror symmetric.

Half-spaces and incompressible layers do not say how far their mean moves: it is zero by convention, or because volume
is kept. Such a mode is held. Its entry is zero in a compliance, and stays zero in every inverse, so that a held mode
is left out of whatever a symbol is applied to, and no infinity is ever multiplied.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Protocol

import numpy as np

from contactsim.grid import Array


class Symbol(Protocol):
    """A matrix at each wavenumber, acting on coefficients of shape (component, …)."""

    components: ClassVar[tuple[str, ...]]
    diagonal: Array

    @property
    def held(self) -> Array:
        """Which components of which modes do not move, shape (component, …), boolean."""
        ...

    def apply(self, coefficients: Array, out: Array | None = None) -> Array:
        """Multiply coefficients (component, …), complex; `out` (may be `coefficients`) receives the result."""
        ...

    def inverse(self, shift: float | Array = 0.0) -> Symbol:
        """Inverse after adding `shift` ≥ 0, one number or one for each component, to the diagonal; held modes stay."""
        ...


@dataclass(frozen=True)
class Normal:
    """One component. diagonal: (1, …)."""

    diagonal: Array
    components: ClassVar[tuple[str, ...]] = ("n",)

    @cached_property
    def held(self) -> Array:
        """Which modes do not move, boolean, (1, …)."""
        return self.diagonal == 0

    def apply(self, coefficients: Array, out: Array | None = None) -> Array:
        """Multiply coefficients (1, …); `out` (may be `coefficients`) receives the result."""
        return np.multiply(self.diagonal, coefficients, out=out)

    def inverse(self, shift: float | Array = 0.0) -> Normal:
        """One over the diagonal plus `shift`; held modes stay zero."""
        moved = np.add(self.diagonal, np.reshape(shift, (-1,) + (1,) * (self.diagonal.ndim - 1)))
        return Normal(np.divide(1.0, moved, out=np.zeros_like(moved), where=~self.held))

    def modes(self, chosen: slice) -> Normal:
        """The part for some of the wavenumbers of a line."""
        return Normal(self.diagonal[:, chosen])

    def coarser(self, count: int) -> Normal:
        """The same on a line of fewer points, an even number, with `count` wavenumbers."""
        return self.modes(slice(0, count))

    def mirrored(self) -> Normal:
        """The same body turned upside down, in the frame of the one that it faces."""
        return self

    def __add__(self, other: Normal) -> Normal:
        return Normal(self.diagonal + other.diagonal)


@dataclass(frozen=True)
class Coupled:
    """Two components of a line, normal and along x, which move each other.

    diagonal: nn and tt, real, (2, m); coupling: imaginary part nt of the entry that takes t to n, (m,), zero where
    either component is held.
    """

    diagonal: Array
    coupling: Array
    components: ClassVar[tuple[str, ...]] = ("n", "t")

    @cached_property
    def held(self) -> Array:
        """Which components of which modes do not move, boolean, (2, m)."""
        return self.diagonal == 0

    @cached_property
    def _straight(self) -> Array:
        """The diagonal as complex numbers, which numpy multiplies by others twice as fast."""
        return self.diagonal.astype(complex)

    @cached_property
    def _cross(self) -> Array:
        """What takes t to n, and n to t: complex, (2, m)."""
        return 1j * np.stack([self.coupling, -self.coupling])

    def apply(self, coefficients: Array, out: Array | None = None) -> Array:
        """Multiply coefficients (2, m); `out` (may be `coefficients`) receives the result."""
        crossed = self._cross * coefficients[::-1]
        out = np.multiply(self._straight, coefficients, out=out)
        out += crossed
        return out

    def inverse(self, shift: float | Array = 0.0) -> Coupled:
        """Inverse after `shift`, one number or one for each component, is added to the diagonal; held modes stay.

        Of a compliance or stiffness, both positive definite, it is right to 3e-15 of √(nn·tt).
        """
        moved = np.where(self.held, 1.0, self.diagonal + np.reshape(shift, (-1, 1)))
        determinant = moved[0] * moved[1] - self.coupling**2
        diagonal = np.where(self.held, 0.0, moved[::-1] / determinant)
        return Coupled(diagonal, -self.coupling / determinant)

    def modes(self, chosen: slice) -> Coupled:
        """The part for some of the wavenumbers."""
        return Coupled(self.diagonal[:, chosen], self.coupling[chosen])

    def coarser(self, count: int) -> Coupled:
        """The same on a line of fewer points, an even number, with `count` wavenumbers; the last is not coupled."""
        part = self.modes(slice(0, count))
        return Coupled(part.diagonal, np.where(np.arange(count) < count - 1, part.coupling, 0.0))

    def mirrored(self) -> Coupled:
        """The same body turned upside down, in the frame of the one that it faces: its coupling changes sign."""
        return Coupled(self.diagonal, -self.coupling)

    def __add__(self, other: Coupled) -> Coupled:
        return Coupled(self.diagonal + other.diagonal, self.coupling + other.coupling)

    def without_shear(self) -> Normal:
        """Of a compliance: the normal one of a surface that no shear acts on, which slips."""
        return Normal(self.diagonal[:1])

    def slip(self) -> Array:
        """Of a compliance: displacement along x over the normal one where no shear acts, complex, (m,); 0 if held."""
        normal = self.diagonal[0]
        return -1j * np.divide(self.coupling, normal, out=np.zeros_like(normal), where=normal != 0)
