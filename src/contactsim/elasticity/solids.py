"""How far a surface gives way under a sinusoidal load.

A linear elastic body is diagonal in Fourier space: traction of wavenumber q moves its surface by compliance(q) times
the traction. Two bodies in series add their compliances; a rigid body is absent. On a half-space the uniform mode is
free (the mean displacement is zero by convention), so its compliance and stiffness at q = 0 are both zero. A layer of
thickness h on a rigid base gives way uniformly too, by h/C11 with C11 = E*(1-ν)²/(1-2ν), and by h/C44 along x; one of
ν = 1/2 keeps its volume, so its mean normal displacement is not free but zero.

The normal compliance of the layer, with x = |q|h and k = 3-4ν, solves Navier's equations in plane strain for a bonded
base and a surface without shear:

    S = 2/(E*|q|) [k (sinh 2x - 2x) + 2x (2-4ν)] / [k cosh 2x + (1+k²)/2 + 2x²].

Numerator and denominator are sums of terms of one sign at any ν, so nothing cancels but sinh 2x - 2x, which has its
series where x is below 1. Multiplied by 2e^{-2x} nothing overflows, and the half-space follows mode by mode where
e^{-2x} is negligible. It is the entry nn of the coupled compliance, whose formulas are those of `plane_strain`. A
direction that carries no traction is dropped from a compliance, never from a stiffness: the surface slips there, and
to hold it would be 9 % too stiff at ν = 0.3 and 25 % at ν = 0.1.

Signs: z points from the lower body to the upper one, the lower body's displacement is (u_n, u_t) = (u_z, u_x) and the
tractions on it, (T_n, T_t) = (σ_zz, σ_xz), are positive where they pull it up and along x. The upper body feels their
opposite. Turned upside down it is a lower body under (T_n, -T_t), whose displacement is (-u_z, u_x); so the
displacement of the lower relative to the upper body is S + S' of the two, with the coupling of S' reversed. Two equal
bodies do not slip under a normal load.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass
from functools import reduce
from typing import Protocol

import numpy as np

from contactsim.elasticity import plane_strain
from contactsim.elasticity.plane_strain import DEEP, bonded_denominator, sinh_less_argument
from contactsim.elasticity.symbol import Coupled, Normal, Symbol
from contactsim.errors import InputError, is_number
from contactsim.grid import Array, Grid
from contactsim.traits import Trait

LONGEST = 1e-60
"""|q|h below which a wave is not told from a uniform displacement."""


class Elasticity(Protocol):
    """An elastic body seen from its surface, z pointing out of it.

    base_depth: of the rigid base (nm), infinite for a half-space; couples: whether normal traction moves it along x.
    """

    contact_modulus: float
    base_depth: float
    couples: bool
    traits: frozenset[Trait]

    def compliance(self, wavenumber: Array) -> Array:
        """Normal displacement per normal pressure without shear, at each |q| (rad/nm), nm/GPa."""
        ...

    def coupled_compliance(self, wavenumber: Array) -> Coupled:
        """Displacement per traction, normal and along x, at each q ≥ 0 (rad/nm) of a line, nm/GPa."""
        ...

    def coupled_stiffness(self, wavenumber: Array) -> Coupled:
        """Its inverse (Eqs 2.9-2.13), GPa/nm; held modes are zero."""
        ...


def _check_modulus(contact_modulus: float) -> None:
    if not (is_number(contact_modulus) and contact_modulus > 0):
        raise InputError("contact_modulus", contact_modulus, "a positive, finite number in GPa")


def _check_ratio(poisson_ratio: float) -> None:
    if not (is_number(poisson_ratio) and -1 < poisson_ratio <= 0.5):
        raise InputError("poisson_ratio", poisson_ratio, "a number above -1 and at most 0.5")


@dataclass(frozen=True)
class HalfSpace:
    """Semi-infinite elastic body with contact modulus E* = E/(1-ν²), GPa (limit of Eq. 2.11).

    Poisson's ratio ν up to 1/2 is needed only where displacements along x, or fields inside, are asked for.
    """

    contact_modulus: float
    poisson_ratio: float | None = None
    traits = frozenset({Trait.HALF_SPACE})
    base_depth = math.inf

    def __post_init__(self) -> None:
        _check_modulus(self.contact_modulus)
        if self.poisson_ratio is not None:
            _check_ratio(self.poisson_ratio)

    @property
    def youngs_modulus(self) -> float | None:
        """Young's modulus E = (1 - ν²) E*, GPa; None without Poisson's ratio."""
        return None if self.poisson_ratio is None else self.contact_modulus * (1 - self.poisson_ratio**2)

    @property
    def couples(self) -> bool:
        """Whether normal traction moves the surface along x: unless it keeps its volume."""
        return self.poisson_ratio != 0.5

    def compliance(self, wavenumber: Array) -> Array:
        """Normal compliance 2/(E*|q|), 0 at q = 0, nm/GPa."""
        safe = np.where(wavenumber > 0, wavenumber, np.inf)
        return 2.0 / (self.contact_modulus * safe)

    def coupled_compliance(self, wavenumber: Array) -> Coupled:
        """Displacement per traction [[1-ν, i(½-ν)], [-i(½-ν), 1-ν]]/(μq), 0 at q = 0, nm/GPa."""
        normal = self.compliance(wavenumber)
        ratio = _known_ratio(self)
        return Coupled(np.stack([normal, normal]), (0.5 - ratio) / (1 - ratio) * normal)

    def coupled_stiffness(self, wavenumber: Array) -> Coupled:
        """Traction per displacement μq/(3-4ν) [[4(1-ν), -2i(1-2ν)], [2i(1-2ν), 4(1-ν)]], GPa/nm."""
        ratio = _known_ratio(self)
        own = self.contact_modulus * (1 - ratio) / (3 - 4 * ratio) * np.asarray(wavenumber)
        return Coupled(2 * (1 - ratio) * np.stack([own, own]), (2 * ratio - 1) * own)


@dataclass(frozen=True)
class Layer:
    """Layer bonded to a rigid base: thickness h (nm), contact modulus E* = E/(1-ν²) (GPa), Poisson's ratio ν up to 1/2.

    E* is the half-space's of the same material, which the layer becomes for waves much shorter than h.
    """

    contact_modulus: float
    poisson_ratio: float
    thickness: float
    traits = frozenset({Trait.LAYER})
    couples = True

    def __post_init__(self) -> None:
        _check_modulus(self.contact_modulus)
        _check_ratio(self.poisson_ratio)
        if not (is_number(self.thickness) and self.thickness > 0):
            raise InputError("thickness", self.thickness, "a positive, finite number in nm")

    @property
    def youngs_modulus(self) -> float | None:
        """Young's modulus E = (1 - ν²) E*, GPa; None without Poisson's ratio."""
        return None if self.poisson_ratio is None else self.contact_modulus * (1 - self.poisson_ratio**2)

    @property
    def base_depth(self) -> float:
        """Depth of the base (nm)."""
        return self.thickness

    @property
    def shear_modulus(self) -> float:
        """C44 (GPa)."""
        return self.contact_modulus * (1 - self.poisson_ratio) / 2

    def compliance(self, wavenumber: Array) -> Array:
        """Normal compliance of the bonded layer without surface shear (Eqs 2.11-2.13), h/C11 at q = 0, nm/GPa."""
        k, width = 3 - 4 * self.poisson_ratio, 1 - 2 * self.poisson_ratio
        twice = np.minimum(2 * self.thickness * wavenumber, DEEP)
        decay = np.exp(-twice)
        bulk = k * sinh_less_argument(twice) / np.where(wavenumber > 0, wavenumber, 1.0)
        uniform = 8 * self.thickness * width * decay
        return 2 / self.contact_modulus * (bulk + uniform) / bonded_denominator(twice, decay, k)

    def coupled_compliance(self, wavenumber: Array) -> Coupled:
        """Displacement per traction (Eqs 2.11-2.13, inverted); h/C11 and h/C44 at q = 0; nm/GPa."""
        long, q = self._waves(wavenumber)
        along, across = plane_strain.bonded_shear(q * self.thickness, self.poisson_ratio) / (self.shear_modulus * q)
        along = np.where(long, self.thickness / self.shear_modulus, along)
        return Coupled(np.stack([self.compliance(wavenumber), along]), np.where(long, 0.0, across))

    def coupled_stiffness(self, wavenumber: Array) -> Coupled:
        """Traction per displacement (Eqs 2.11-2.13); C11/h, held at ν = 1/2, and C44/h at q = 0; GPa/nm."""
        long, q = self._waves(wavenumber)
        pair = self.shear_modulus * q * plane_strain.bonded_stiffness(q * self.thickness, self.poisson_ratio)
        normal, along = self._springs()
        uniform = [normal if math.isfinite(normal) else 0.0, along, 0.0]
        whole = np.where(long, np.reshape(uniform, (3, 1)), pair)
        return Coupled(whole[:2], whole[2])

    def both_faces(self, wavenumber: Array) -> Array:
        """Stiffness of both faces of the layer cut off its base (Eqs 2.10-2.13, mended), complex, (4, 4, m), GPa/nm.

        Order: normal and along x of the surface, normal and along x of the other face; tractions from outside. At q = 0
        the entries of normal displacements are infinite if ν = 1/2.
        """
        long, q = self._waves(wavenumber)
        waves = self.shear_modulus * q * plane_strain.both_faces(q * self.thickness, self.poisson_ratio)
        springs = np.diag(np.tile(self._springs(), 2))
        springs[[0, 1, 2, 3], [2, 3, 0, 1]] = -springs.diagonal()
        return np.where(long, springs[..., None], waves)

    def _waves(self, wavenumber: Array) -> tuple[Array, Array]:
        """Which waves are too long to be told from none, and q with another in place of those."""
        long = np.asarray(wavenumber) * self.thickness < LONGEST
        return long, np.where(long, 1 / self.thickness, wavenumber)

    def _springs(self) -> tuple[float, float]:
        """C11/h and C44/h (GPa/nm)."""
        width = 1 - 2 * self.poisson_ratio
        uniaxial = self.contact_modulus * (1 - self.poisson_ratio) ** 2 / width if width else math.inf
        return uniaxial / self.thickness, self.shear_modulus / self.thickness


@dataclass(frozen=True)
class FreeLayer(Layer):
    """Layer whose other face carries nothing but a uniform load, in place of a rigid base: long waves bend it.

    Displacements are relative to the mean of that face, which is where a load or an approach is applied (Fig. 2.1).
    """

    @property
    def base_depth(self) -> float:
        """There is no base."""
        raise InputError("body", type(self).__name__, "a half-space or a layer on a rigid base, to have fields inside")

    def compliance(self, wavenumber: Array) -> Array:
        """Normal compliance without surface shear; h/C11 at q = 0, nm/GPa."""
        return self.coupled_compliance(wavenumber).diagonal[0]

    def coupled_compliance(self, wavenumber: Array) -> Coupled:
        """Displacement per traction; h/C11 and h/C44 at q = 0; nm/GPa."""
        long, q = self._waves(wavenumber)
        pair = plane_strain.free_compliance(q * self.thickness, self.poisson_ratio) / (self.shear_modulus * q)
        whole = np.where(long, np.reshape([*(1 / np.array(self._springs())), 0.0], (3, 1)), pair)
        return Coupled(whole[:2], whole[2])

    def coupled_stiffness(self, wavenumber: Array) -> Coupled:
        """Traction per displacement, GPa/nm."""
        return self.coupled_compliance(wavenumber).inverse()


def _known_ratio(body: HalfSpace) -> float:
    if body.poisson_ratio is None:
        raise InputError("poisson_ratio", None, "a number above -1 and at most 0.5, where displacements along x exist")
    return body.poisson_ratio


def relative_compliance(
    lower: Elasticity | None, upper: Elasticity | None, grid: Grid, components: tuple[str, ...]
) -> Symbol:
    """Displacement of the lower relative to the upper surface, aligned, per traction on the lower one, nm/GPa.

    None is rigid. The mode of the shortest wave, with an even number of points, has no coupling: its sine is not seen.
    """
    bodies = [(lower, False), (upper, True)]
    symbols = [_symbol(body, grid, components, turned) for body, turned in bodies if body is not None]
    if not symbols:
        raise InputError("elasticity", None, "an elastic body: at least one of the two must give way")
    return reduce(operator.add, symbols)


def _symbol(body: Elasticity, grid: Grid, components: tuple[str, ...], turned: bool) -> Symbol:
    """Compliance on a grid; turned: of a body upside down."""
    if components == Normal.components:
        return Normal(body.compliance(grid.wavenumber)[None])
    if components != Coupled.components or len(grid.shape) != 1:
        allowed = "('n',), or on a line ('n', 't'): displacements along x of surfaces are not modelled"
        raise InputError("components", components, allowed)
    symbol = body.coupled_compliance(grid.wavenumber)
    if grid.shape[0] % 2 == 0:
        symbol.coupling[-1] = 0.0
    return symbol.mirrored() if turned else symbol


ELASTICITIES = {"half_space": HalfSpace, "layer": Layer, "free_layer": FreeLayer}
