"""The problem that smooth laws pose between two elastic bodies, at one load step.

The bodies are aligned, so one relative displacement v is enough: the growth of the gap when both surfaces deform. With
C the sum of the bodies' compliances and T the traction of the laws,

    v = -C T(g + v),   or   K v + T(g + v) = 0   with K = C⁻¹,

where g is the gap of the undeformed bodies. Where a hard wall acts beside the laws, T includes its push at an estimate
of its pressure. Fields of a surface are rows of all its points, and of all its waves.

The unknowns are the Fourier coefficients of v in the components in which a law exerts traction; K is diagonal in the
wavenumber. A component that is read but not exerted, like the tangential gap of a frictionless coupled law, is no
unknown: the tangential displacement of a surface free of shear is the normal one times a factor at each wavenumber. K
is always the inverse of the compliance of the exerted components; a part of the inverse of the whole compliance would
fix the other components.

Normal approach enters as the uniform mode of the gap. Where the uniform compliance is zero (a half-space, by
convention, and an incompressible layer) that mode of v is fixed at zero. Under a prescribed mean pressure the uniform
mode of the gap is free, its stiffness is zero, and the equation says that the law carries the load; the approach
follows. A slide enters as the uniform mode of the tangential gap: it moves the far boundary of a layer, or the mean of
a half-space.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contactsim.contact.steps import LoadStep
from contactsim.elasticity.symbol import Symbol
from contactsim.grid import Array, Grid, TransformCounter
from contactsim.interface.base import Law, potential
from contactsim.interface.pairing import Pairing
from contactsim.interface.wall_pressure import WallPressure
from contactsim.traits import Trait


@dataclass(frozen=True)
class CohesiveProblem:
    """Equilibrium K v + T(g + v) = 0 at one load step; see the module's text.

    Parameters
    ----------
    grid
        Grid of the line or surface.
    shape
        Gap of the undeformed bodies at zero approach (components, n), nm.
    law
        All laws as one.
    pairing
        Rule by which points face each other.
    stiffness
        K of the exerted components.
    slip_factor
        Tangential over normal displacement at each wavenumber (m,), where the tangential gap is read but no shear is
        exerted; None elsewhere.
    tolerance
        Largest residual at any point, over the strength of the law.
    counter
        Counter of the work.
    approach, load
        Approach, nm, or mean pressure, GPa; the other one is None.
    origin
        Approach at which that of load steps is zero, nm.
    sliding_distance
        Displacement of the upper body along x, nm.
    heights_grid
        Grid of the heights, the first points of `grid` in each direction: all of it where heights repeat. Beyond them
        the gap is too wide for any traction.
    wall
        Pressure of a hard wall beside the laws; None without a wall.
    """

    grid: Grid
    shape: Array
    law: Law
    pairing: Pairing
    stiffness: Symbol
    slip_factor: Array | None
    tolerance: float
    counter: TransformCounter
    approach: float | None = 0.0
    load: float | None = None
    origin: float = 0.0
    sliding_distance: float = 0.0
    heights_grid: Grid | None = None
    wall: WallPressure | None = None

    @property
    def heights(self) -> Grid:
        """Grid of the heights."""
        return self.heights_grid or self.grid

    def on_heights(self, rows: Array) -> Array:
        """Return rows (…, n) of all points at those of the heights alone, (…, points of the heights)."""
        if self.heights_grid is None:
            return rows
        ny, nx = self.heights_grid.shape
        fields = rows.reshape(*rows.shape[:-1], *self.grid.shape)
        return fields[..., :ny, :nx].reshape(*rows.shape[:-1], ny * nx)

    @property
    def unknowns(self) -> tuple[int, int]:
        """Shape of the unknown coefficients: exerted components and wavenumbers."""
        exerted, wavenumbers = self.stiffness.diagonal.shape
        return exerted, wavenumbers

    @cached_property
    def fixed_modes(self) -> Array:
        """Exerted components whose uniform mode is fixed, bool (exerted,)."""
        fixed = self.stiffness.held[:, 0].copy()
        fixed[0] &= self.load is None
        return fixed

    @cached_property
    def regularised_stiffness(self) -> Symbol:
        """Stiffness in which a uniform mode that a load leaves free has that of the longest wave, or of softer laws."""
        if self.load is None:
            return self.stiffness
        diagonal = self.stiffness.diagonal.copy()
        diagonal[0, 0] = min(diagonal[0, 1], self.law_stiffness)
        return self.stiffness.with_diagonal(diagonal)

    @property
    def mode_weights(self) -> Array:
        """Number of times that each coefficient of a real transform counts in a mean over the period (m,): 1 or 2."""
        return self.grid.mode_weights

    @property
    def mean_displacement(self) -> float:
        """Mean displacement of the surfaces under a prescribed mean pressure, nm."""
        uniform = float(self.stiffness.diagonal[0, 0])
        return self.load / uniform if self.load is not None and uniform else 0.0

    @property
    def strength(self) -> float:
        """Strength of the law, GPa."""
        return self.law.strength

    @property
    def law_stiffness(self) -> float:
        """Largest tangent of the law, GPa/nm."""
        return self.law.stiffness

    @property
    def interaction_range(self) -> float:
        """Shortest length over which the law changes, nm."""
        return self.law.interaction_range

    @property
    def lattice_constant(self) -> float:
        """Distance along x after which the interaction repeats itself, nm; infinite if it never does."""
        return self.pairing.lattice_constant

    def at(self, step: LoadStep) -> CohesiveProblem:
        """Return the problem of the same scene at another load step."""
        normal = step.normal
        if normal.control is Trait.APPROACH:
            return replace(self, approach=normal.value + self.origin, load=None, sliding_distance=step.sliding_distance)
        return replace(self, approach=None, load=normal.value, sliding_distance=step.sliding_distance)

    def field(self, coefficients: Array) -> Array:
        """Return the values (read, n) of a displacement's coefficients (exerted, m), with those that follow it."""
        if self.slip_factor is not None:
            coefficients = np.concatenate((coefficients, self.slip_factor * coefficients))
        self.counter.add(len(coefficients), self.grid.size)
        return self.grid.backward_rows(coefficients)

    def coefficients(self, field: Array) -> Array:
        """Return the Fourier coefficients (rows, m) of values (rows, n)."""
        self.counter.add(len(field), self.grid.size)
        return self.grid.forward_rows(field)

    def gap(self, displacement: Array) -> Array:
        """Return the gap (read, n), nm, at the coefficients of a displacement (exerted, m)."""
        gap = self.field(displacement)
        gap += self.shape
        if self.approach is not None:
            gap[0] -= self.approach
        if self.sliding_distance:
            gap[1] += self.sliding_distance
        return gap

    def offset(self, gap: Array) -> Array:
        """Return the tangential gap (n,), nm, between points that face each other; gap: (2, n)."""
        return self.pairing.offset(gap)

    def traction(self, gap: Array) -> Array:
        """Return the traction (exerted, n), GPa, at a gap (read, n), nm."""
        traction = self.law.traction(gap)
        return traction if self.wall is None else traction - self.wall.push(gap[0])

    def tangent(self, gap: Array) -> tuple[Array, Tangent]:
        """Return the traction (exerted, n), GPa, and its derivative at a gap (read, n), nm."""
        traction, values = self.law.tangent(gap)
        if self.wall is not None:
            push = self.wall.push(gap[0])
            traction, values = traction - push, values + self.wall.stiffness * (push > 0)
        return traction, Tangent(self, values)

    def energy(self, displacement: Array, gap: Array) -> float:
        """Return the mean potential energy over the period, N/m: elastic, of the laws, and of the load."""
        weighted = self.elastic(displacement) * self.mode_weights
        elastic = 0.5 * float(np.vdot(displacement, weighted).real)
        of_load = 0.0 if self.load is None else self.load * float(displacement[0, 0].real)
        of_laws = potential(self.law, gap)
        if self.wall is not None:
            of_laws = of_laws + self.wall.energy(gap[0])
        return elastic + of_load + float(of_laws.mean())

    def residual(self, displacement: Array, traction: Array) -> Array:
        """Return the coefficients (exerted, m) of K v + T, GPa; zero where the displacement is fixed."""
        out = self.coefficients(traction)
        if self.load is not None:
            out[0, 0] += self.load
        return self.add_elastic(out, displacement)

    def add_elastic(self, traction: Array, displacement: Array) -> Array:
        """Add K v to a traction's coefficients (exerted, m), in place; zero where the displacement is fixed."""
        traction += self.elastic(displacement)
        traction[self.fixed_modes, 0] = 0
        return traction

    def elastic(self, displacement: Array) -> Array:
        """Return the coefficients (exerted, m) of K v, GPa; zero where the displacement is fixed."""
        elastic = self.stiffness.apply(displacement)
        if self.load is not None:
            elastic[0, 0] = 0
        elastic[self.fixed_modes, 0] = 0
        return elastic

    def norm(self, residual: Array) -> float:
        """Return the largest value at any point of a residual's coefficients (exerted, m), over the strength.

        What is left beyond heights that do not repeat moves them as more would that is left at their edges: the largest
        value there is added, times the root of the points along a side. If an upper bound, the sum of all coefficients,
        is within the tolerance, the bound is returned.
        """
        edge = 0.0 if self.heights_grid is None else math.sqrt(max(self.heights_grid.shape))
        bound = (1 + edge) * (2 * np.abs(residual).sum(axis=1)).max() / self.strength
        if bound <= self.tolerance:
            return float(bound)
        self.counter.add(len(residual), self.grid.size)
        values = np.abs(self.grid.backward_rows(residual))
        if self.heights_grid is None:
            return float(values.max() / self.strength)
        inside = self.on_heights(values).max()
        fields = values.reshape(-1, *self.grid.shape)
        fields[(slice(None), *map(slice, self.heights_grid.shape))] = 0.0
        return float((inside + edge * fields.max()) / self.strength)


@dataclass(frozen=True)
class Tangent:
    """Derivative of the traction by the gap at each point (exerted, read, n), GPa/nm, as a map of coefficients."""

    problem: CohesiveProblem
    values: Array

    def __call__(self, change: Array) -> Array:
        """Return the change of the traction's coefficients for one of the displacement's, both (exerted, m)."""
        field = self.problem.field(change)
        return self.problem.coefficients(contract(self.values, field))


def contract(tangent: Array, field: Array) -> Array:
    """Return derivatives (exerted, read, n) times a change of the gap (read, n), summed over what is read."""
    out = tangent[:, 0] * field[0]
    for row in range(1, len(field)):
        out += tangent[:, row] * field[row]
    return out
