"""An elastic body as its surface shows it: displacement from traction, one Fourier coefficient at a time."""

from __future__ import annotations

import operator
from functools import reduce
from typing import Annotated, Protocol

from contactsim.arguments import Only
from contactsim.elasticity.symbol import CoupledSymbol, NormalSymbol, Symbol
from contactsim.errors import InputError, is_number
from contactsim.grid import Array, Grid
from contactsim.traits import Trait

PoissonRatio = Annotated[
    float, Only("a number above -1 and at most 0.5", lambda value: is_number(value) and -1 < value <= 0.5)
]


class Elasticity(Protocol):
    """A linear elastic body whose surface is flat but for small slopes.

    Notes
    -----
    Traction of wavenumber q displaces the surface by the compliance at q times the traction. The axis z points out of
    the body. Displacements are (u_n, u_t) = (u_z, u_x); tractions (T_n, T_t) = (σ_zz, σ_xz) are positive where they
    pull the body up and along x.

    Of two bodies the upper one feels the opposite tractions. Turned upside down it is a lower body under (T_n, -T_t),
    with the displacement (-u_z, u_x). The displacement of the lower relative to the upper body is therefore S + S',
    where the coupling of S' is reversed. Two equal bodies do not slip under a normal load.

    A direction without traction is left out of a compliance, not of a stiffness: the surface slips there. To hold it
    instead would be 9 % too stiff at ν = 0.3 and 25 % at ν = 0.1.
    """

    @property
    def contact_modulus(self) -> float:
        """Contact modulus E* = E/(1-ν²), GPa."""
        ...

    @property
    def poisson_ratio(self) -> float | None:
        """Poisson's ratio ν; None if unknown, where normal displacements alone are computed."""
        ...

    @property
    def youngs_modulus(self) -> float | None:
        """Young's modulus E, GPa; None without Poisson's ratio."""
        ...

    @property
    def base_depth(self) -> float:
        """Depth of the rigid base, nm; infinite for a half-space."""
        ...

    @property
    def couples(self) -> bool:
        """True if a normal traction moves the surface along x."""
        ...

    @property
    def traits(self) -> frozenset[Trait]:
        """Properties that a solver has to accept."""
        ...

    def incompressible(self) -> Elasticity:
        """Return the body with ν = 1/2 and the same contact modulus; itself where ν is unknown."""
        ...

    def compliance(self, wavenumber: Array) -> Array:
        """Return the normal displacement per normal traction without shear, nm/GPa, at each |q| (rad/nm)."""
        ...

    def coupled_compliance(self, wavenumber: Array) -> CoupledSymbol:
        """Return the displacement per traction, normal and along x, nm/GPa, at each q ≥ 0 (rad/nm) of a line."""
        ...

    def coupled_stiffness(self, wavenumber: Array) -> CoupledSymbol:
        """Return the traction per displacement (Eqs 2.9-2.13), GPa/nm, at each q ≥ 0; zero for held modes."""
        ...


def known_poisson_ratio(body: Elasticity) -> float:
    """Return the Poisson's ratio of a body; raise an InputError if there is none."""
    if body.poisson_ratio is None:
        raise InputError("poisson_ratio", None, "a number above -1 and at most 0.5, where displacements along x exist")
    return body.poisson_ratio


def relative_compliance(
    lower: Elasticity | None, upper: Elasticity | None, grid: Grid, components: tuple[str, ...]
) -> Symbol:
    """Return the displacement of the lower relative to the upper surface per traction on the lower one.

    The surfaces are aligned. With an even number of points the shortest wave has no coupling, because its sine is zero
    at every point.

    Parameters
    ----------
    lower, upper : Elasticity or None
        The bodies; None is rigid.
    grid : Grid
        Grid of both surfaces.
    components : tuple of str
        ("n",), or on a line ("n", "t").

    Returns
    -------
    Symbol
        Compliance, nm/GPa, at each coefficient of the grid.

    Raises
    ------
    InputError
        If both bodies are rigid, or the components do not exist on the grid.
    """
    if components == CoupledSymbol.components:
        return relative_coupled_compliance(lower, upper, grid)
    if components != NormalSymbol.components:
        raise InputError("components", components, "('n',), or on a line ('n', 't')")
    bodies = _elastic_bodies(lower, upper)
    return reduce(operator.add, [NormalSymbol(body.compliance(grid.wavenumber)[None]) for body, _ in bodies])


def relative_coupled_compliance(lower: Elasticity | None, upper: Elasticity | None, grid: Grid) -> CoupledSymbol:
    """Return the relative displacement per traction on a line, both normal and along x; see `relative_compliance`."""
    if len(grid.shape) != 1:
        allowed = "('n',), or on a line ('n', 't'): displacements along x of surfaces are not modelled"
        raise InputError("components", CoupledSymbol.components, allowed)
    return reduce(operator.add, [_coupled_symbol(body, grid, turned) for body, turned in _elastic_bodies(lower, upper)])


def _elastic_bodies(lower: Elasticity | None, upper: Elasticity | None) -> list[tuple[Elasticity, bool]]:
    """Return the bodies that give way, each with whether it is upside down."""
    bodies = [(body, turned) for body, turned in ((lower, False), (upper, True)) if body is not None]
    if not bodies:
        raise InputError("elasticity", None, "an elastic body: at least one of the two must give way")
    return bodies


def _coupled_symbol(body: Elasticity, grid: Grid, turned: bool) -> CoupledSymbol:
    """Return the compliance of a body on a line; `turned`: of the body upside down."""
    symbol = body.coupled_compliance(grid.wavenumber)
    if grid.shape[0] % 2 == 0:
        symbol.coupling[-1] = 0.0
    return symbol.mirrored() if turned else symbol
