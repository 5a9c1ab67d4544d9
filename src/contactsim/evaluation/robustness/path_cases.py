"""A path of smooth laws to follow, and what is right for it.

What a state must satisfy is written out here once more: the laws as printed, without the continuation of deep overlap,
and the elastic bodies as a boundary value problem solved wave by wave, by numpy's transforms. Where elastic bodies are
stiff against the law, v = -C T(g + v) contracts, and its fixed point is an exact answer that no solver made. Which of
several equilibria is right is a matter of the past: there the same path in smaller increments is to agree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.loading import LoadPath
from contactsim.contact.pose_cohesive import MAX_TOLERANCE, pose_cohesive
from contactsim.contact.scene import Scene
from contactsim.contact.steps import LoadStep
from contactsim.evaluation.robustness.navier import surface_compliance
from contactsim.evaluation.robustness.printed_laws import FORMULAS
from contactsim.grid import Array
from contactsim.interface.base import Law
from contactsim.interface.lattice import Lattice
from contactsim.paths.requested import Requested
from contactsim.paths.state import PathState
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.solvers.registry import make_solver
from contactsim.status import Status
from contactsim.threads import limit_threads
from contactsim.traits import Trait

FAR = 12.0
"""Tangential lengths beyond which a site does nothing, to all digits."""
BRANCH_SOLVER = "mass_weighted_verlet"
"""The solver of smaller increments: not the default one, and it moves as the surface itself would."""
SWEEPS, SHRINKING = 400, 0.9
"""Most steps of the fixed point, and how much each must be smaller than the one before."""


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
    def laws(self) -> tuple[Law, ...]:
        """The smooth laws of the scene."""
        return self.scene.laws

    @property
    def heights(self) -> Array:
        """Sum of both surfaces' heights (n,) or (ny, nx), nm."""
        return self.scene.heights(self.points)

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
        return pose_cohesive(self.scene, self.heights, MAX_TOLERANCE).strength

    @cached_property
    def shape(self) -> Array:
        """The gap of the undeformed bodies at zero approach, normal and along x, (2, n), nm."""
        return np.stack([-self.heights, np.zeros(self.points)])

    @cached_property
    def compliance(self) -> Array:
        """Displacement per traction of both bodies together, complex, (n//2 + 1, 2, 2), nm/GPa."""
        q = 2 * np.pi * np.fft.rfftfreq(self.points, self.scene.length / self.points)
        signs = np.array([[1, -1], [-1, 1]])
        bodies = (self.scene.lower.elasticity, 1), (self.scene.upper.elasticity, signs)
        total = np.asarray(sum(surface_compliance(body, q) * turn for body, turn in bodies if body is not None))
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
        tractions: list[Array] = [self._of_sites(law, gap) for law in self.laws]
        return np.asarray(sum(tractions))

    def _of_sites(self, law: Law, gap: Array) -> Array:
        pairing = self.scene.pairing
        lattice = pairing.lattice_constant
        if np.isinf(lattice):
            return FORMULAS[type(law)](law, *gap)
        most = int(np.ceil(FAR * law.tangential_length / lattice))
        nearest = gap[1] - lattice * np.round(gap[1] / lattice)
        assert isinstance(pairing, Lattice), "no other pairing repeats itself"
        sites: list[Array] = [
            FORMULAS[type(law)](law, gap[0], nearest + lattice * site) for site in range(-most, most + 1)
        ]
        return pairing.weight * np.asarray(sum(sites))

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
        problem = pose_cohesive(self.scene, self.heights, self.tolerance)
        with limit_threads(1):
            return problem, list(Requested().follow(problem, method, self.steps))

    @cached_property
    def exact(self) -> Array | None:
        """Forces (step, 1 or 2), N/m, of the fixed point at each step; None where it does not contract."""
        displacement: Array = np.zeros((len(self.shape), len(self.compliance)), complex)
        loads = []
        for step in self.steps:
            solution = self._fixed_point(step, displacement)
            if solution is None:
                return None
            displacement = solution
            loads.append(self.forces(step, displacement))
        return np.array(loads)

    @property
    def branch_solver(self) -> CohesiveSolver:
        """The solver of smaller increments."""
        solver: CohesiveSolver = make_solver(BRANCH_SOLVER, budget=500)
        return solver

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
        states = slow.follow(self.branch_solver)[1][self.parts - 1 :: self.parts]
        if any(state.status is not Status.CONVERGED for state in states):
            return None
        return np.array([slow.forces(state.step, state.displacement) for state in states])

    def answer(self, step: LoadStep, displacement: Array) -> Array:
        """Coefficients (2, m) of -C T(g + v), with which the bodies answer a displacement v."""
        traction = np.fft.rfft(self.traction(self.gap(step, displacement))) / self.points
        traction[len(self.scene.exerted) :] = 0.0
        return np.asarray(-np.einsum("qij,jq->iq", self.compliance, traction))

    def _fixed_point(self, step: LoadStep, start: Array) -> Array | None:
        """Coefficients (2, m) of v = -C T(g + v), by insertion; None where that does not contract."""
        if step.normal.control is not Trait.APPROACH:
            return None
        displacement, before = start, np.inf
        with np.errstate(over="ignore", invalid="ignore"):  # what does not contract may overflow
            for _ in range(SWEEPS):
                after = self.answer(step, displacement)
                change = float(np.abs(after - displacement).sum())
                displacement = after
                if change <= 1e-12 * np.abs(after).sum():
                    return displacement
                if not change <= SHRINKING * before:
                    return None
                before = change
        return None


def max_interpenetration(problem: CohesiveProblem, states: Sequence[PathState]) -> float:
    """Return the deepest overlap of states over the laws' length, as results report it."""
    deepest = 0.0
    for state in states:
        here = problem.at(state.step)
        gap = here.gap(state.displacement)
        deepest = max(deepest, -float(gap[0].min()) / here.interaction_range)
    return deepest
