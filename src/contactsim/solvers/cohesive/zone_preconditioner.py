"""Preconditioner of the stiffness plus the tangent of laws that act on a small part of a line or surface.

Long waves, those of a coarser grid, are solved for exactly: with C the compliance and D the tangent, (K + D) w = r is
w = C (r - t) with the tractions t = D w. As D is not zero on the process zone Z alone,

    (1 + D_Z C_ZZ) t_Z = D_Z (C r)_Z,   w = C (r - t_Z),

which is one dense factorisation of the size of the zone (`zone_factors`). Short waves have the
stiffness plus a constant shift.

Under a prescribed load the uniform mode has no stiffness, and C no entry for it. It first gets a stiffness k, which
then is taken away again (Sherman and Morrison): with e the uniform mode and y = (K + k e eᵀ + D)⁻¹ e,

    (K + D)⁻¹ r = w + k (eᵀ w) / (1 - k eᵀ y) y,   w = (K + k e eᵀ + D)⁻¹ r.

A negative 1 - k eᵀ y is one more negative eigenvalue of K + D.
"""

from __future__ import annotations

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem, Tangent
from contactsim.elasticity.symbol import Symbol
from contactsim.grid import Array
from contactsim.solvers.cohesive.long_waves import WAVES, LongWaves, node_averages
from contactsim.solvers.cohesive.zone_factors import GeneralFactors, SymmetricFactors, ZoneFactors

COARSENING = 8
"""Points of the grid for each node of the coarse grid of long waves, along a side."""
MIN_NODES, SMALL_GRID = {1: 128, 2: 32}, {1: 256, 2: 32}
"""Smallest number of nodes, and points up to which the grid itself is the coarse one, along x, by dimension."""
SHORT_WAVE_SHIFT, MIN_TANGENT = 0.3, (1.0, 0.01)
"""Shift of short waves, over the largest tangent of a component; smallest value taken for that, normal and tangential,
over the laws' tangent at zero gap."""
SHIFT_RATIO = 2.0
"""Ratio of the largest tangents of two states up to which they share the shift of short waves."""
ZONE_THRESHOLD = 1e-3
"""Tangent, over the laws' largest, below which a point is outside the process zone."""
MIN_REST = 1e-9
"""Smallest size of 1 - k eᵀ y that rounding leaves right."""
MAX_UNKNOWNS = {1: 300, 2: 900}
"""Unknowns of the zone above which its factorisation costs more than it saves, by dimension: the coarse grid gets
coarser."""


class ZonePreconditioner:
    """Approximate inverse of K + D + shift, for coefficients (exerted, m).

    Parameters
    ----------
    problem
        Problem at a load step.
    tangent
        D at a state.
    shift
        Inverse of a time step, GPa/nm.
    before
        Preconditioner of an earlier state with the same shift; what does not depend on the tangent is shared with it.
    """

    def __init__(
        self,
        problem: CohesiveProblem,
        tangent: Tangent,
        shift: float = 0.0,
        before: ZonePreconditioner | None = None,
    ) -> None:
        self._problem = problem
        points, dimensions = problem.grid.shape[-1], len(problem.grid.shape)
        ratio = min(COARSENING, points // MIN_NODES[dimensions]) if points > SMALL_GRID[dimensions] else 1
        values = node_averages(tangent.values, problem.grid, ratio)
        while np.count_nonzero(self._acting(values)) * len(values) > MAX_UNKNOWNS[dimensions]:
            ratio *= 2
            values = node_averages(tangent.values, problem.grid, ratio)
        before = before if before is not None and before._waves.nodes == values.shape[-1] else None
        self._waves: LongWaves = WAVES[dimensions](problem.grid, ratio) if before is None else before._waves
        diagonal = tangent.values[range(len(values)), range(len(values))]
        least = problem.law_stiffness * np.array(MIN_TANGENT[: len(values)])
        self._largest_tangents = np.maximum(np.abs(diagonal).max(axis=1), least)
        self._high: Symbol
        self._compliance: Symbol
        self._responses: list[Array]
        self._set_short_waves(shift, before)
        self._set_long_waves(shift, before)
        self._factor(values)
        self._set_free_mode()

    def _set_short_waves(self, shift: float, before: ZonePreconditioner | None) -> None:
        """Invert the stiffness of short waves plus a shift, or share it with another preconditioner."""
        if before is not None and np.abs(np.log(self._largest_tangents / before._largest_tangents)).max() <= np.log(
            SHIFT_RATIO
        ):
            self._high, self._largest_tangents = before._high, before._largest_tangents
            return
        extra = shift + SHORT_WAVE_SHIFT * self._largest_tangents
        self._high = self._problem.stiffness.modes(self._waves.high).inverse(extra)

    def _set_long_waves(self, shift: float, before: ZonePreconditioner | None) -> None:
        """Invert the stiffness of long waves, or share it with another preconditioner."""
        if before is not None:
            self._compliance, self._responses = before._compliance, before._responses
            return
        self._compliance = self._problem.regularised_stiffness.modes(self._waves.low).inverse(shift)
        self._responses = [self._response(row) for row in range(self._problem.unknowns[0])]

    def _acting(self, values: Array) -> Array:
        """Return the nodes where the tangent is not negligible, bool."""
        return np.abs(values).max(axis=(0, 1)) > ZONE_THRESHOLD * self._problem.law_stiffness

    def _field(self, coefficients: Array) -> Array:
        """Return the values (read, nodes) of long waves (exerted, low)."""
        factor = self._problem.slip_factor
        if factor is not None:
            coefficients = np.concatenate((coefficients, factor[self._waves.low] * coefficients))
        return self._waves.field(coefficients)

    def _response(self, row: int) -> Array:
        """Return the displacement (read, nodes) under a unit of traction in one component at the first node."""
        unit = np.zeros((len(self._compliance.diagonal), self._waves.count), complex)
        unit[row] = 1 / self._waves.nodes
        return self._field(self._compliance.apply(unit))

    def _factor(self, values: Array) -> None:
        """Factorise 1 + D C on the process zone, for derivatives (exerted, read, nodes)."""
        self._zone = np.flatnonzero(self._acting(values))
        self._factors: ZoneFactors | None = None
        if not len(self._zone):
            return
        self._problem.counter.add_factors(len(values) * len(self._zone))
        tangent, apart = values[..., self._zone], self._waves.differences(self._zone)
        if values.shape[:2] == (1, 1):
            self._factors = SymmetricFactors(tangent[0, 0], self._responses[0][0][apart])
            return
        compliance = np.stack([response[:, apart] for response in self._responses], 2)
        self._factors = GeneralFactors(tangent, compliance)

    def _set_free_mode(self) -> None:
        """Find how the stiffness of a uniform mode that a load leaves free is taken away again."""
        self._free_wave: Array | None = None
        problem = self._problem
        if problem.load is None or self._factors is None:
            return
        uniform = np.zeros(problem.unknowns, complex)
        uniform[0, 0] = problem.regularised_stiffness.diagonal[0, 0]
        wave = self._solve(uniform)  # k y
        rest = 1 - wave[0, 0].real
        if abs(rest) > MIN_REST:
            self._free_wave, self._rest = wave, rest

    def growing(self) -> list[Array]:
        """Return the displacement (exerted, m) that would grow most on its own, in this approximation.

        None, one, or two between which a displacement swings as it grows.
        """
        tractions = None if self._factors is None else self._factors.growing()
        if tractions is None:
            return [self._free_wave] if self._free_wave is not None and self._rest < 0 else []
        waves = []
        for traction in tractions:
            wave = np.zeros(self._problem.unknowns, complex)
            wave[:, self._waves.low] = self._spread(traction)
            waves.append(wave)
        return waves

    def _spread(self, traction: Array) -> Array:
        """Return the displacement (exerted, low) under tractions on the zone (exerted, zone)."""
        pull = np.zeros((len(traction), self._waves.nodes))
        pull[:, self._zone] = traction
        return self._compliance.apply(self._waves.coefficients(pull))

    def __call__(self, residual: Array) -> Array:
        """Return the displacement (exerted, m) for a residual of the same shape."""
        out = self._solve(residual)
        if self._free_wave is not None:
            out += out[0, 0].real / self._rest * self._free_wave
        return out

    def _solve(self, residual: Array) -> Array:
        """Return the displacement (exerted, m) where a free uniform mode has a stiffness."""
        out = np.empty_like(residual)
        out[:, self._waves.high] = self._high.apply(residual[:, self._waves.high])
        long = self._compliance.apply(residual[:, self._waves.low])
        if self._factors is not None:
            long -= self._spread(self._factors.solve(self._field(long)[:, self._zone]))
            self._problem.counter.add(len(self._problem.shape) + len(residual), self._waves.nodes)
        out[:, self._waves.low] = long
        return out
