"""Smooth laws between two elastic bodies on a line: the problem they pose at one load step.

The bodies are aligned, so one relative displacement v suffices: what the gap grows by when both surfaces give way. With
C the sum of the bodies' compliances and T the traction of the laws,

    v = -C T(g + v),   or   K v + T(g + v) = 0   with K = C⁻¹,

where g is the gap of the undeformed bodies. The unknowns are the Fourier coefficients of v, in the components in which
a law exerts traction; there K is diagonal in the wavenumber. A component that is read but not exerted, like the
tangential gap of a frictionless coupled law, is no unknown: a surface free of shear follows the normal displacement by
a factor a wavenumber. The stiffness is always inverted from the compliance of the exerted components: slicing the
stiffness itself would hold the others fast.

Normal approach enters as the uniform mode of the gap. Where the uniform compliance is zero (a half-space, by
convention, and an incompressible layer) that mode of v is held at zero. Under a prescribed mean pressure the uniform
mode of the gap is free, its stiffness zero, and the equation says that the law carries the load; the approach follows.
A slide enters as the uniform mode of the tangential gap: the far boundary of a layer, or the mean of a half-space, is
what moves. Springs between sites of two lattices are one law of the gap to the site that is opposite without a slide.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import ducc0
import numpy as np

from contactsim.contact.loading import LoadStep
from contactsim.contact.scene import Scene
from contactsim.elasticity.solids import relative_compliance
from contactsim.elasticity.symbol import Symbol
from contactsim.errors import SceneError, is_number
from contactsim.grid import Array, Grid, Tally
from contactsim.interface.laws import Law
from contactsim.interface.pairing import LatticeInteraction
from contactsim.interface.superposition import Superposition, superposed
from contactsim.traits import Trait

LOOSEST = 0.1
"""Largest tolerance: beyond it, doing nothing would soon be a solution."""


@dataclass(frozen=True)
class Tangent:
    """Derivative of the traction at each point, (exerted, read, n), GPa/nm; a linear map on coefficients."""

    problem: CohesiveProblem
    values: Array

    def __call__(self, change: Array) -> Array:
        """Change of the traction's coefficients (exerted, m) for one of the displacement's (exerted, m)."""
        field = self.problem.field(change)
        return self.problem.coefficients(contracted(self.values, field))


def contracted(tangent: Array, field: Array) -> Array:
    """Derivatives (exerted, read, n) times a change of the gap (read, n), summed over what is read: (exerted, n)."""
    out = tangent[:, 0] * field[0]
    for row in range(1, len(field)):
        out += tangent[:, row] * field[row]
    return out


@dataclass(frozen=True)
class CohesiveProblem:
    """What smooth laws pose at one load step (see the module's text).

    shape: gap of the undeformed bodies at zero approach (components, n), nm; stiffness: K of the exerted components;
    derived: factor (m,) by which the tangential displacement follows the normal one, where it is read but not exerted;
    approach, nm, or load: mean pressure, GPa; tolerance: largest residual, over the laws' strength; tally: the work;
    origin: approach (nm) at which those of load steps are zero; sliding_distance: how far (nm) the upper body has moved
    along x.
    """

    grid: Grid
    shape: Array
    law: Law | Superposition | LatticeInteraction
    stiffness: Symbol
    derived: Array | None
    tolerance: float
    tally: Tally
    approach: float | None = 0.0
    load: float | None = None
    origin: float = 0.0
    sliding_distance: float = 0.0

    @property
    def unknowns(self) -> tuple[int, int]:
        """Shape of the coefficients sought: exerted components and wavenumbers."""
        return self.stiffness.diagonal.shape

    @cached_property
    def held(self) -> Array:
        """Components whose uniform mode is no unknown, bool (exerted,)."""
        held = self.stiffness.held[:, 0].copy()
        held[0] &= self.load is None
        return held

    @cached_property
    def supported(self) -> Symbol:
        """The stiffness, with that of the longest wave for a uniform mode that a load leaves free."""
        if self.load is None:
            return self.stiffness
        diagonal = self.stiffness.diagonal.copy()
        diagonal[0, 0] = diagonal[0, 1]
        return replace(self.stiffness, diagonal=diagonal)

    @property
    def yielded(self) -> float:
        """Mean displacement of the surfaces under the mean pressure, nm."""
        uniform = float(self.stiffness.diagonal[0, 0])
        return self.load / uniform if self.load is not None and uniform else 0.0

    @property
    def strength(self) -> float:
        """Of the laws together, GPa."""
        return self.law.strength

    @property
    def softening(self) -> float:
        """Largest tangent of the laws together, GPa/nm."""
        return self.law.stiffness

    @property
    def interaction_range(self) -> float:
        """Shortest length over which a law changes, nm."""
        return self.law.interaction_range

    def at(self, step: LoadStep) -> CohesiveProblem:
        """The same scene at another load step."""
        normal = step.normal
        if normal.control is Trait.APPROACH:
            return replace(self, approach=normal.value + self.origin, load=None, sliding_distance=step.sliding_distance)
        return replace(self, approach=None, load=normal.value, sliding_distance=step.sliding_distance)

    def coarser(self, points: int, tolerance: float) -> CohesiveProblem:
        """The same scene on fewer points, an even number: without the waves that these cannot carry, in heights too."""
        grid, count = self.grid.coarser((points,)), points // 2 + 1
        shape = self.grid.forward(self.shape[0])[:count]
        shape[-1] = 0
        gap = np.zeros((len(self.shape), points))
        gap[0] = grid.backward(shape)
        derived = None if self.derived is None else np.where(np.arange(count) < count - 1, self.derived[:count], 0)
        stiffness = self.stiffness.coarser(count)
        return replace(self, grid=grid, shape=gap, stiffness=stiffness, derived=derived, tolerance=tolerance)

    def refined(self, displacement: Array) -> Array:
        """A displacement of a coarser grid (exerted, m), on this one; its shortest wave is left out."""
        out = np.zeros(self.unknowns, complex)
        out[:, : displacement.shape[1] - 1] = displacement[:, :-1]
        return out

    def field(self, coefficients: Array) -> Array:
        """Values (components, n) of a displacement (exerted, m), with the derived component."""
        if self.derived is not None:
            coefficients = np.concatenate((coefficients, self.derived * coefficients))
        self.tally.add(len(coefficients), self.grid.size)
        return ducc0.fft.c2r(
            coefficients, axes=(1,), lastsize=self.grid.size, forward=False, nthreads=self.grid.threads
        )

    def coefficients(self, field: Array) -> Array:
        """Fourier coefficients (rows, m) of values (rows, n)."""
        self.tally.add(len(field), self.grid.size)
        return ducc0.fft.r2c(field, axes=(1,), forward=True, inorm=2, nthreads=self.grid.threads)

    def gap(self, displacement: Array) -> Array:
        """The gap (components, n), nm, at the coefficients of a displacement (exerted, m)."""
        gap = self.field(displacement)
        gap += self.shape
        if self.approach is not None:
            gap[0] -= self.approach
        if self.sliding_distance:
            gap[1] += self.sliding_distance
        return gap

    @property
    def lattice_constant(self) -> float:
        """Of the sites that springs join, nm; infinite without."""
        return self.law.spacing if isinstance(self.law, LatticeInteraction) else np.inf

    def offset(self, gap: Array) -> Array:
        """Tangential gap (n,), nm, between what faces each other; gap: (2, n)."""
        return self.law.offset(gap) if isinstance(self.law, LatticeInteraction) else gap[1]

    def traction(self, gap: Array) -> Array:
        """The laws' traction (exerted, n), GPa."""
        return self.law.traction(gap)

    def tangent(self, gap: Array) -> tuple[Array, Tangent]:
        """The laws' traction (exerted, n) and its derivative."""
        traction, values = self.law.tangent(gap)
        return traction, Tangent(self, values)

    def energy(self, displacement: Array, gap: Array) -> float:
        """Elastic energy plus the laws' potentials, less the work of the load, over the period, N/m; they need one."""
        weighted = self.balanced(np.zeros_like(displacement), displacement) * self.weights
        stored = 0.5 * float(np.vdot(displacement, weighted).real)
        pressed = 0.0 if self.load is None else self.load * float(displacement[0, 0].real)
        return stored + pressed + float(self.law.energy(gap).mean())

    @cached_property
    def weights(self) -> Array:
        """How often each coefficient of a real transform counts in a mean over the period, (m,): once or twice."""
        weights = np.full(self.unknowns[1], 2.0)
        weights[0] = 1.0
        if self.grid.size % 2 == 0:
            weights[-1] = 1.0
        return weights

    def residual(self, displacement: Array, traction: Array) -> Array:
        """Coefficients (exerted, m) of K v + T, GPa, zero where the displacement is held."""
        out = self.coefficients(traction)
        if self.load is not None:
            out[0, 0] += self.load
        return self.balanced(out, displacement)

    def balanced(self, traction: Array, displacement: Array) -> Array:
        """`traction` (exerted, m) plus K v, in its place; zero where the displacement is held."""
        elastic = self.stiffness.apply(displacement)
        if self.load is not None:
            elastic[0, 0] = 0
        traction += elastic
        traction[self.held, 0] = 0
        return traction

    def certify(self, displacement: Array) -> float:
        """Largest |K v + T| at any point, over the laws' strength, from the displacement alone; NaN if not finite."""
        residual = self.residual(displacement, self.traction(self.gap(displacement)))
        return self.size(residual)

    def size(self, residual: Array) -> float:
        """Largest value at any point of a residual's coefficients, over the laws' strength."""
        bound = (2 * np.abs(residual).sum(axis=1)).max() / self.strength
        if bound <= self.tolerance:
            return float(bound)
        self.tally.add(len(residual), self.grid.size)
        field = ducc0.fft.c2r(residual, axes=(1,), lastsize=self.grid.size, forward=False, nthreads=self.grid.threads)
        return float(np.abs(field).max() / self.strength)


def check_tolerance(tolerance: object, name: str = "tolerance") -> None:
    """SceneError for what is no tolerance, or so loose that doing nothing would meet it."""
    if not (is_number(tolerance) and 0 < tolerance <= LOOSEST):
        raise SceneError(name, tolerance, f"a number above 0, at most {LOOSEST}, in parts of the laws' strength")


def pose_cohesive(scene: Scene, heights: Array, tolerance: float, threads: int = 1) -> CohesiveProblem:
    """The problem that a scene of smooth laws poses on the grid of `heights` (n,), nm, at zero approach."""
    check_tolerance(tolerance)
    grid = Grid(heights.shape, scene.lengths, threads)
    compliance = relative_compliance(scene.lower.elasticity, scene.upper.elasticity, grid, scene.components)
    derived = None
    if len(scene.exerted) < len(scene.components):
        derived, compliance = compliance.slip(), compliance.without_shear()
    shape = np.zeros((len(scene.components), grid.size))
    shape[0] = -heights
    law = scene.pairing.joined(superposed(scene.acting), scene.lower.surface.heights(grid.size), scene.length)
    origin = scene.path.origin(heights)
    return CohesiveProblem(grid, shape, law, compliance.inverse(), derived, tolerance, Tally(grid.size), origin=origin)
