"""The equations of a path's state, written once more, to judge what the solvers return.

Of a state that is called converged, the gap and the traction are taken, and nothing else. The traction must be that of
the law at the gap. The gap must be that of the undeformed surfaces and of the displacement that the traction causes, to
the tolerance or, of an interpolated state, to its stated residual. Prescribed approach, mean pressure and sliding
distance must be there. No displacement may grow on its own. Errors are over what they may be, so that 1 is allowed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from contactsim import Scene, Status
from contactsim.contact.steps import LoadStep
from contactsim.grid import Array

Bodies = list[tuple[str, float, float, float, int]]
"""Kind, contact modulus, Poisson's ratio, thickness, and side (0 lower, 1 upper) of each elastic body."""
Tractions = Callable[[Array, Array], tuple[Array, Array]]
"""Normal and tangential traction, as a function of the normal and the tangential gap."""
ROUNDING = 1e-9
"""What rounding may add to an error, over the size of what is compared."""
SLIP_ROUNDING = 1e-7
"""The same for the slip of a surface free of shear."""
GROWTH = 1e-3
"""Rate, over the law's largest tangent, at which a displacement may grow at a stable state. An interpolated one is off
by its stated residual, which adds to it."""
STABILITY_POINTS = {True: 512, False: 128}
"""Points up to which the whole stiffness is looked at, of laws with a potential and of others."""
DEEPEST = -10.0
"""Gap, in the law's lengths, below which laws are continued by their tangents."""


@dataclass(frozen=True)
class Equations:
    """What the states of a scene must fulfil.

    Parameters
    ----------
    scene
        The scene, of one law.
    bodies
        Its elastic bodies.
    points, tolerance
        Of the simulation.
    """

    scene: Scene
    bodies: Bodies
    points: int
    tolerance: float

    @cached_property
    def interface(self) -> Any:
        """The law between the surfaces; its strength and stiffness are units of errors."""
        return self.scene.pairing.join(self.law, np.zeros(self.points), self.scene.length)

    @property
    def law(self) -> Any:
        """The law between two points."""
        return self.scene.laws[0]

    @cached_property
    def tractions(self) -> Tractions:
        """The tractions of the law, or of the springs of a lattice."""
        bare = own_law(self.law)
        return bare if math.isinf(self.scene.pairing.lattice_constant) else own_springs(bare, self.law, self.scene)

    @property
    def has_potential(self) -> bool:
        """True where the law has a potential."""
        return type(self.law).__name__ in ("NormalCohesiveZone", "RepulsiveZone", "StiffCohesiveZone")

    @property
    def exerts_shear(self) -> bool:
        """True where the law has friction."""
        return bool(getattr(self.law, "work_ratio", 0.0) or getattr(self.law, "friction_coefficient", 0.0))

    @cached_property
    def compliance(self) -> tuple[Array, Array, Array]:
        """What a traction on the lower surface moves it by, relative to the upper: (nn, tt, nt) (m,), nm/GPa."""
        q = 2 * np.pi * np.arange(self.points // 2 + 1) / self.scene.length
        total = np.zeros((3, q.size))
        for kind, modulus, ratio, thickness, side in self.bodies:
            own, shear_modulus = np.zeros((3, q.size)), modulus * (1 - ratio) / 2
            depth = thickness if kind == "layer" else np.inf
            own[:, 1:] = layer_compliance(q[1:] * depth, ratio) / (shear_modulus * q[1:])
            if kind == "layer":
                own[0, 0] = thickness * (1 - 2 * ratio) / (modulus * (1 - ratio) ** 2)
                own[1, 0] = thickness / shear_modulus
            total += own * np.array([1.0, 1.0, -1.0 if side else 1.0])[:, None]
        if self.points % 2 == 0:
            total[2, -1] = 0.0
        return total[0], total[1], total[2]

    @property
    def is_small(self) -> bool:
        """True for a grid on which the growth at every state can be looked at."""
        return self.points <= STABILITY_POINTS[self.has_potential]

    def judge(
        self, data: xr.Dataset, place: int, heights: Array, looks_at_growth: bool | None = None
    ) -> dict[str, float]:
        """Return the errors of a state that is called converged, each over what it may be.

        Parameters
        ----------
        data
            Numbers and fields of the state.
        place
            Number of its step.
        heights
            Heights of the surfaces together, nm.
        looks_at_growth
            True where all eigenvalues are computed; on small grids without it.
        """
        state = State(self, data, self.scene.path.steps[place], heights)
        if not all(np.isfinite(values).all() for values in (state.normal, state.slip, state.pull, state.shear)):
            return {"finite": math.inf}
        growth = state.growth_error() if (self.is_small if looks_at_growth is None else looks_at_growth) else {}
        return {**state.law_errors(), **state.mean_errors(), **state.equilibrium_errors(), **growth}


class State:
    """Gap and traction of one state, and what is wrong with them."""

    def __init__(self, equations: Equations, data: xr.Dataset, step: LoadStep, heights: Array) -> None:
        self._equations, self._step, self._heights = equations, step, heights
        nothing = np.zeros(heights.size)
        self.normal, self.pull = data.normal_gap.values, data.normal_traction.values
        self.slip = data.tangential_gap.values if "tangential_gap" in data else nothing
        self.shear = data.tangential_traction.values if "tangential_traction" in data else nothing
        self._reads_slip, self._approach = "tangential_gap" in data, float(data.approach)
        is_interpolated = int(data.status) == Status.INTERPOLATED.value[0]
        tolerance = float(data.residual) if is_interpolated else equations.tolerance
        self._growth = GROWTH + (tolerance if is_interpolated else 0.0)
        self._allowed = tolerance * equations.interface.strength
        self._under_load = step.normal.control.name == "MEAN_PRESSURE"
        self._length = equations.law.normal_length

    def law_errors(self) -> dict[str, float]:
        """Return the errors of the tractions at these gaps."""
        law, errors = self._equations.tractions(self.normal, self.slip), {}
        within = self.normal >= DEEPEST * self._length
        for name, found, own in zip(("normal law", "tangential law"), (self.pull, self.shear), law, strict=True):
            size = np.abs(own).max() + self._equations.interface.strength
            errors[name] = float(np.abs(found - own)[within].max(initial=0.0) / size / ROUNDING)
        return errors

    def mean_errors(self) -> dict[str, float]:
        """Return the errors of approach and load: as told and as prescribed."""
        free, mean = self._equations.compliance[0][0] * self.pull.mean(), self.normal.mean() + self._heights.mean()
        size = abs(mean) + abs(free) + np.abs(self._heights).max() + self._length
        may_be = ROUNDING * size + self._equations.compliance[0][0] * self._allowed
        errors = {"approach": abs(mean + self._approach + free) / may_be}
        value = self._step.normal.value
        if self._under_load:
            errors["load"] = abs(self.pull.mean() + value) / (self._allowed + ROUNDING * value)
        else:
            errors["prescribed approach"] = abs(self._approach - value) / (ROUNDING * (abs(value) + self._length))
        return errors

    def equilibrium_errors(self) -> dict[str, float]:
        """Return the errors of the gap that follows from the traction."""
        (nn, tt, nt), points = self._equations.compliance, self.normal.size
        pulls, shears = np.fft.rfft(self.pull), np.fft.rfft(self.shear)
        off_normal = np.fft.rfft(self.normal + self._heights) + nn * pulls + 1j * nt * shears
        off_slip = np.fft.rfft(self.slip) + tt * shears - 1j * nt * pulls
        off_normal[0] = 0.0 if self._under_load else off_normal[0] + points * self._step.normal.value
        off_slip[0] -= points * self._step.sliding_distance
        if not self._reads_slip:
            off_slip[:] = 0.0
        errors: dict[str, float] = {}
        size = self._length + sum(np.abs(values).max() for values in (self.normal, self._heights, self.slip))
        for name, off, entry in (("normal", off_normal, nn), ("tangential", off_slip, tt)):
            if entry[0] == 0:
                errors[f"{name} held mode"] = abs(off[0]) / points / (ROUNDING * size)
                off[0] = 0.0
        residual = self._residual(off_normal, off_slip)
        if self._under_load:  # the law carries it
            residual[0] += self.pull.mean() + self._step.normal.value
        stiffest = 1 / nn[1:].min()
        may_be = self._allowed + 1e-13 * stiffest * size + 1e-12 * self._equations.interface.strength
        errors["equilibrium"] = float(np.abs(residual).max() / may_be)
        if self._reads_slip and not self._equations.exerts_shear:  # a surface free of shear follows its normal traction
            rest = np.fft.irfft(off_slip - self._slip_factor() * off_normal, points)
            errors["free slip"] = float(np.abs(rest).max() / (SLIP_ROUNDING * size))
        return errors

    def _slip_factor(self) -> Array:
        """Return the tangential over the normal displacement of a surface free of shear."""
        nn, _, nt = self._equations.compliance
        return np.divide(-1j * nt, nn, out=np.zeros_like(nt, complex), where=nn > 0)

    def _residual(self, off_normal: Array, off_slip: Array) -> Array:
        """Return the traction that is out of balance at each point (1 or 2, n), GPa."""
        blocks = stiffness(*self._equations.compliance, self._equations.exerts_shear)
        off, points = (off_normal, off_slip)[: len(blocks)], self.normal.size
        rows = [sum(entry * part for entry, part in zip(row, off, strict=True)) for row in blocks]
        return np.stack([np.fft.irfft(row, points) for row in rows])

    def growth_error(self) -> dict[str, float]:
        """Return the largest rate at which a displacement grows; nothing where laws are continued."""
        equations, points = self._equations, self.normal.size
        if self.normal.min() < DEEPEST * self._length:
            return {}
        nn, tt, _ = equations.compliance
        (pull_normal, shear_normal), (pull_slip, shear_slip) = self._derivatives()
        blocks = [[operator(entry, points) for entry in row] for row in self._stiffness()]
        blocks[0][0] += np.diag(pull_normal)
        if equations.exerts_shear:
            blocks[0][1] += np.diag(pull_slip)
            blocks[1][0] += np.diag(shear_normal)
            blocks[1][1] += np.diag(shear_slip)
        elif self._reads_slip:
            blocks[0][0] += pull_slip[:, None] * operator(self._slip_factor(), points)
        if self._under_load and nn[0]:  # the uniform mode of the gap is free
            blocks[0][0] -= 1 / nn[0] / points
        whole = np.block(blocks)
        is_held = [nn[0] == 0 and not self._under_load, tt[0] == 0][: len(blocks)]
        for row in np.flatnonzero(is_held):
            mean = np.zeros(len(whole))
            mean[row * points : (row + 1) * points] = points**-0.5
            away = np.eye(len(whole)) - np.outer(mean, mean)
            whole = away @ whole @ away + 10 * equations.interface.stiffness * np.outer(mean, mean)
        values = np.linalg.eigvalsh(whole) if equations.has_potential else np.linalg.eigvals(whole).real
        return {"stability": float(-values.min() / (self._growth * equations.interface.stiffness))}

    def zone(self) -> int:
        """Return the number of points where the law's tangent is a thousandth of its largest or more."""
        derivatives = np.abs(np.stack([part for parts in self._derivatives() for part in parts]))
        return int(np.count_nonzero(derivatives.max(axis=0) >= 1e-3 * self._equations.interface.stiffness))

    def _stiffness(self) -> list[list[Array]]:
        """Return the stiffness of the components that are exerted."""
        return stiffness(*self._equations.compliance, self._equations.exerts_shear)

    def _derivatives(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Return the derivatives of both tractions by the normal and by the tangential gap, by finite differences."""
        across = min(getattr(self._equations.law, "tangential_length", math.inf), self._length)
        found = []
        for step in ((1e-6 * self._length, 0.0), (0.0, 1e-6 * across)):
            after, before = (
                self._equations.tractions(self.normal + sign * step[0], self.slip + sign * step[1]) for sign in (1, -1)
            )
            found.append(tuple((a - b) / (2 * max(step)) for a, b in zip(after, before, strict=True)))
        return found[0], found[1]


def own_law(law: Any) -> Tractions:
    """Return the tractions of a law between two points."""
    name, unit, work = type(law).__name__, law.normal_length, law.work_of_separation
    across, ratio = getattr(law, "tangential_length", math.inf), getattr(law, "work_ratio", 0.0)
    wall, friction = getattr(law, "contact_stiffness", 0.0), getattr(law, "friction_coefficient", 0.0)

    def tractions(normal: Array, slip: Array) -> tuple[Array, Array]:
        y, t = normal / unit, slip / across
        pull = work / unit * y * np.exp(-y)
        shear = 2 * ratio * work / across * t * np.exp(-y - t**2) if ratio else np.zeros_like(y)
        if name in ("CohesiveZone", "StiffMixedZone"):
            pull = pull * np.exp(-(t**2))
        if name in ("RepulsiveZone", "FrictionalRepulsiveZone"):
            pull = np.where(y < 0, pull, 0.0)
        if name == "FrictionalRepulsiveZone":
            shear = -pull * friction * math.sqrt(2 * math.e) * t * np.exp(-(t**2))
        if name in ("StiffCohesiveZone", "StiffMixedZone"):
            pull = np.where(y < 0, wall * normal * np.exp(-y), pull)
        return pull, shear

    return tractions


def own_springs(bare: Tractions, law: Any, scene: Scene) -> Tractions:
    """Return the tractions of all springs of a site to a flat lattice."""
    pairing: Any = scene.pairing
    sites = math.ceil(pairing.tangential_cutoff * law.tangential_length / pairing.lattice_constant)

    def tractions(normal: Array, slip: Array) -> tuple[Array, Array]:
        nearest = np.rint(slip / pairing.lattice_constant)
        reach = range(-sites, sites + 1)
        each = [bare(normal, slip - pairing.lattice_constant * (nearest + site)) for site in reach]
        return sum(part[0] for part in each), sum(part[1] for part in each)

    return tractions


def layer_compliance(x: Array, ratio: float) -> Array:
    """Return the entries nn, tt and nt of the compliance of a bonded layer (3, m), over 1/(μq), at qh = x."""
    k = 3 - 4 * ratio
    deep = x > 20
    y = np.where(deep, 1.0, x)
    below = k * np.cosh(2 * y) + (1 + k**2) / 2 + 2 * y**2
    series = 8 * y**3 / 6 + 32 * y**5 / 120  # sinh 2y - 2y, which loses its digits
    odd = np.where(y < 1e-3, series, np.sinh(2 * y) - 2 * y)
    normal = (1 - ratio) * (k * odd + (4 - 8 * ratio) * y) / below
    along = (1 - ratio) * (k * np.sinh(2 * y) + 2 * y) / below
    across = ((1 - 2 * ratio) * k * np.sinh(y) ** 2 - y**2) / below
    return np.where(deep, [[1 - ratio], [1 - ratio], [0.5 - ratio]], np.stack([normal, along, across]))


def stiffness(nn: Array, tt: Array, nt: Array, has_shear: bool) -> list[list[Array]]:
    """Return the inverse of the compliance, of the normal component alone or of both; held modes have none."""
    normal_alone = np.divide(1.0, nn, out=np.zeros_like(nn), where=nn > 0)
    if not has_shear:
        return [[normal_alone]]
    along_alone = np.divide(1.0, tt, out=np.zeros_like(tt), where=tt > 0)
    both = (nn > 0) & (tt > 0)
    below = np.where(both, nn * tt - nt**2, 1.0)
    normal, along = np.where(both, tt / below, normal_alone), np.where(both, nn / below, along_alone)
    cross = np.where(both, -1j * nt / below, 0.0)
    return [[normal, cross], [-cross, along]]


def operator(symbol: Array, points: int) -> Array:
    """Return the matrix that multiplies the waves of values at the points by a symbol (m,)."""
    return np.fft.irfft(symbol[:, None] * np.fft.rfft(np.eye(points), axis=0), points, axis=0)
