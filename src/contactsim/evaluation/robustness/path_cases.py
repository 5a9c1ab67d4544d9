"""A path of smooth laws to follow, and what is right for it.

What a state must satisfy is written out here once more: the laws as printed, without the continuation of deep overlap,
and the elastic bodies as a boundary value problem solved wave by wave, by numpy's transforms. Where elastic bodies are
stiff against the law, v = -C T(g + v) contracts, and its fixed point is an exact answer that no solver made. Which of
several equilibria is right is a matter of the past: there the same path in smaller increments is to agree.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from threadpoolctl import threadpool_limits

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.loading import LoadPath
from contactsim.contact.pose_cohesive import MAX_TOLERANCE, pose_cohesive
from contactsim.contact.scene import Scene
from contactsim.contact.steps import LoadStep
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.grid import Array
from contactsim.interface.base import Law
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.paths.increments import Requested
from contactsim.paths.state import PathState
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.solvers.registry import make_solver
from contactsim.status import Status
from contactsim.traits import Trait

DEEP = 40.0
"""|q|h from which on a layer is a half-space to all digits."""
FAR = 12.0
"""Tangential lengths beyond which a site does nothing, to all digits."""
SWEEPS, SHRINKING = 400, 0.9
"""Most steps of the fixed point, and how much each must be smaller than the one before."""

BRANCH_SOLVER = "mass_weighted_verlet"
"""The solver of smaller increments: not the default one, and it moves as the surface itself would."""


@dataclass(frozen=True)
class PathCase:
    """A scene of smooth laws, and how its path must end.

    tolerance: in parts of the laws' strength; ends: status of the last step, that of all others is converged; begin:
    datum from which the path comes, and parts: into how many smaller increments each of its own is divided to compare
    the branch, 0 not to compare; even: whether scene and answer are mirror images of themselves; twin:
    laws by which a scene has the same answer, None where there are none.
    """

    scene: Scene
    points: int = 128
    tolerance: float = 1e-7
    ends: Status = Status.CONVERGED
    begin: float = -10.0
    parts: int = 0
    even: bool = True
    twin: tuple[Law, ...] | None = None

    @property
    def kind(self) -> frozenset[Trait]:
        """Traits that a solver must accept to solve such cases."""
        return frozenset({Trait.LINE}).union(*(effect.traits for effect in self.scene.effects))

    @property
    def steps(self) -> tuple[LoadStep, ...]:
        """The states asked for."""
        return self.scene.path.steps

    @property
    def statuses(self) -> list[Status]:
        """End that each step must have."""
        return [Status.CONVERGED] * (len(self.steps) - 1) + [self.ends]

    @cached_property
    def strength(self) -> float:
        """Sum of the laws' strengths (GPa), of springs as many as pull as one."""
        return pose_cohesive(self.scene, -self.shape[0], MAX_TOLERANCE).strength

    @cached_property
    def shape(self) -> Array:
        """The gap of the undeformed bodies at zero approach, normal and along x, (2, n), nm."""
        return np.stack([-self.scene.heights(self.points), np.zeros(self.points)])

    @cached_property
    def compliance(self) -> Array:
        """Displacement per traction of both bodies together, complex, (n//2 + 1, 2, 2), nm/GPa."""
        q = 2 * np.pi * np.fft.rfftfreq(self.points, self.scene.length / self.points)
        signs = np.array([[1, -1], [-1, 1]])
        bodies = (self.scene.lower.elasticity, 1), (self.scene.upper.elasticity, signs)
        total = sum(surface_compliance(body, q) * turn for body, turn in bodies if body is not None)
        if self.points % 2 == 0:
            total[-1, [0, 1], [1, 0]] = 0.0
        return total

    def gap(self, step: LoadStep, displacement: Array) -> Array:
        """The gap (2, n), nm, at the coefficients of a displacement (exerted, m), along x as the surface slips."""
        waves = np.zeros((2, self.points // 2 + 1), complex)
        waves[: len(displacement)] = displacement
        if len(displacement) == 1:
            slip = self.compliance[:, 1, 0]
            normal = self.compliance[:, 0, 0]
            waves[1] = displacement[0] * np.divide(slip, normal, out=np.zeros_like(slip), where=normal != 0)
        gap = self.shape + self.points * np.fft.irfft(waves, self.points)
        if step.normal.control is Trait.APPROACH:
            gap[0] -= step.normal.value
        gap[1] += step.sliding_distance
        return gap

    def traction(self, gap: Array) -> Array:
        """Normal traction and that along x (2, n), GPa, at a gap (2, n), nm: of all sites of a flat lattice below."""
        return sum(self._of_sites(law, gap) for law in self.scene.effects)

    def _of_sites(self, law: Law, gap: Array) -> Array:
        lattice = self.scene.pairing.lattice_constant
        if np.isinf(lattice):
            return FORMULAS[type(law)](law, *gap)
        most = int(np.ceil(FAR * law.tangential_length / lattice))
        nearest = gap[1] - lattice * np.round(gap[1] / lattice)
        sites = (FORMULAS[type(law)](law, gap[0], nearest + lattice * site) for site in range(-most, most + 1))
        return self.scene.pairing.weight * sum(sites)

    def forces(self, step: LoadStep, displacement: Array) -> Array:
        """Compression and, on a slide, the force along x of a state (N/m)."""
        traction = self.traction(self.gap(step, displacement)) * [[-1.0], [1.0]]
        return traction[: 1 + self.scene.sliding].mean(1) * self.scene.length

    def residual(self, step: LoadStep, displacement: Array) -> float:
        """Largest traction, normal or along x, that nothing balances (GPa)."""
        rows = len(displacement)
        waves = np.fft.rfft(self.traction(self.gap(step, displacement))[:rows]) / self.points
        elastic, uniform = np.zeros_like(waves), self.compliance[0].diagonal()[:rows].real
        inverse = np.linalg.inv(self.compliance[1:, :rows, :rows])
        elastic[:, 1:] = np.einsum("qij,jq->iq", inverse, displacement[:, 1:])
        elastic[:, 0] = np.divide(displacement[:, 0], uniform, out=np.zeros(rows, complex), where=uniform > 0)
        waves[uniform == 0, 0] = 0.0
        if step.normal.control is Trait.MEAN_PRESSURE:
            elastic[0, 0] = step.normal.value
            waves[0, 0] = self.traction(self.gap(step, displacement))[0].mean()
        return float(np.abs(self.points * np.fft.irfft(waves + elastic, self.points)).max())

    def follow(self, method: CohesiveSolver) -> tuple[CohesiveProblem, list[PathState]]:
        """The problem, which has counted the work, and the states that a solver finds."""
        problem = pose_cohesive(self.scene, -self.shape[0], self.tolerance)
        with threadpool_limits(1, "blas"):  # on small dense systems more would only wait for each other
            return problem, list(Requested().follow(problem, method, self.steps))

    @cached_property
    def exact(self) -> Array | None:
        """Forces (step, 1 or 2), N/m, of the fixed point at each step; None where it does not contract."""
        displacement, loads = np.zeros((2, self.points // 2 + 1), complex), []
        for step in self.steps:
            displacement = self._fixed_point(step, displacement)
            if displacement is None:
                return None
            loads.append(self.forces(step, displacement))
        return np.array(loads)

    @cached_property
    def branch(self) -> Array | None:
        """Forces (step, 1 or 2), N/m, of damped dynamics in smaller increments, for the twin where there is one.

        None where none is asked for, and where they do not come to rest.
        """
        if not self.parts:
            return None
        parts, place = [], {self.steps[0].control: self.begin}
        for step in self.steps:
            values = np.linspace(place.get(step.control, 0.0), step.value, self.parts + 1)[1:]
            parts += [replace(step, value=float(value)) for value in values]
            place[step.control] = step.value
        path = LoadPath(tuple(parts))
        slow = replace(self, scene=replace(self.scene, path=path, effects=self.twin or self.scene.effects))
        states = slow.follow(make_solver(BRANCH_SOLVER, budget=500))[1][self.parts - 1 :: self.parts]
        if any(state.status is not Status.CONVERGED for state in states):
            return None
        return np.array([slow.forces(state.step, state.displacement) for state in states])

    def _fixed_point(self, step: LoadStep, start: Array) -> Array | None:
        """Coefficients (2, m) of v = -C T(g + v), by insertion; None where that does not contract."""
        if step.normal.control is not Trait.APPROACH:
            return None
        displacement, before, rows = start, np.inf, len(self.scene.exerted)
        with np.errstate(over="ignore", invalid="ignore"):  # what does not contract may overflow
            for _ in range(SWEEPS):
                pulled = np.fft.rfft(self.traction(self.gap(step, displacement))) / self.points
                pulled[rows:] = 0.0
                after = -np.einsum("qij,jq->iq", self.compliance, pulled)
                change = float(np.abs(after - displacement).sum())
                displacement = after
                if change <= 1e-12 * np.abs(after).sum():
                    return displacement
                if not change <= SHRINKING * before:
                    return None
                before = change
        return None


def surface_compliance(body: Elasticity, q: Array) -> Array:
    """Displacement per traction, normal and along x, of a body from below, at q ≥ 0 (m,), complex, (m, 2, 2), nm/GPa.

    With φ = (a + b e^{-2qz}…) and ψ harmonic, u = ∇(φ + zψ) - 4(1-ν) ψ e_z solves Navier's equations; its amplitudes
    e^{qz} and e^{-q(z+h)} are found, wave by wave, from no displacement at depth h and the tractions at z = 0.
    """
    ratio, shear = body.poisson_ratio, body.contact_modulus * (1 - body.poisson_ratio) / 2
    waves = np.empty((q.size, 2, 2), complex)
    waves[0] = np.diag(_uniform(body, shear))
    deep = np.minimum(q[1:] * body.base_depth, DEEP)
    decay = np.exp(-deep)

    def state(z: Array, harmonic: Array, sign: int) -> list[tuple[Array, ...]]:
        """For φ and for ψ, with qz and the harmonic there: u_n, u_t/i, and the tractions σ_zz/2μq, σ_xz/2μqi."""
        k = 3 - 4 * ratio
        phi = sign * harmonic, harmonic, harmonic, sign * harmonic
        psi = (
            (sign * z - k) * harmonic,
            z * harmonic,
            (z - 2 * (1 - ratio) * sign) * harmonic,
            (sign * z + (1 - k) / 2) * harmonic,
        )
        return [phi, psi]

    one, zero = np.ones_like(deep), np.zeros_like(deep)
    top = np.array(state(zero, one, 1) + state(zero, decay, -1)).transpose(2, 1, 0)
    base = np.array(state(-deep, decay, 1) + state(-deep, one, -1)).transpose(2, 1, 0)
    system = np.concatenate([base[:, :2], top[:, 2:]], axis=1)
    amplitudes = np.linalg.solve(system, np.broadcast_to(np.eye(4)[:, 2:], (deep.size, 4, 2)))
    moved = (top[:, :2] @ amplitudes) / (2 * shear * q[1:, None, None])
    waves[1:] = moved * np.array([[1, -1j], [1j, 1]])
    return waves


def _uniform(body: Elasticity, shear: float) -> tuple[float, float]:
    """Displacement per uniform traction, normal and along x; zero where the mean does not move, or is free."""
    depth, ratio = body.base_depth, body.poisson_ratio
    return UNIFORM[type(body)](depth, ratio, shear)


UNIFORM: dict[type, Callable[..., tuple[float, float]]] = {
    HalfSpace: lambda *_: (0.0, 0.0),
    Layer: lambda depth, ratio, shear: (depth * (1 - 2 * ratio) / (2 * shear * (1 - ratio)), depth / shear),
}


def _mixed_mode(law: CohesiveZone | UncoupledCohesiveZone, normal: Array, tangential: Array) -> Array:
    """Eq. 2.17 as printed, (2, n), GPa."""
    y, s = normal / law.normal_length, tangential / law.tangential_length
    far = np.exp(-y - s**2)
    size = law.work_of_separation / law.normal_length, 2 * law.work_of_separation * law.work_ratio
    return np.stack([size[0] * y * far, size[1] / law.tangential_length * s * far])


def _normal(law: NormalCohesiveZone, normal: Array, tangential: Array) -> Array:
    """Eq. 4.1 as printed, (2, n), GPa."""
    y = normal / law.normal_length
    return np.stack([law.work_of_separation / law.normal_length * y * np.exp(-y), np.zeros_like(tangential)])


def _uncoupled(law: UncoupledCohesiveZone, normal: Array, tangential: Array) -> Array:
    """Eq. 4.1 and the tangential traction of Eq. 2.17 as printed, (2, n), GPa."""
    return np.stack([_normal(law.without_slip(), normal, tangential)[0], _mixed_mode(law, normal, tangential)[1]])


FORMULAS: dict[type, Callable[..., Array]] = {
    CohesiveZone: _mixed_mode,
    NormalCohesiveZone: _normal,
    UncoupledCohesiveZone: _uncoupled,
}
