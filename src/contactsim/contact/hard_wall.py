"""The problem of a hard wall at one load step.

It has no units, so that no solver can depend on the units of the input. Lengths are in grid steps, the typical height
difference of neighbouring points (`contactsim.contact.grid_step`); pressures are in E*·step/spacing. With w the
displacement of the elastic surface and h ≤ 0 the heights below the highest point,

    gap = w - h - a ≥ 0,   w = S p,   p ≥ 0,   p·gap = 0,

where a is the approach beyond first touch; it is prescribed, or follows from a prescribed mean pressure. The mean of w
is zero on a periodic half-space by convention, and on an incompressible layer because it keeps its volume. Under a
prescribed mean pressure it is zero for any periodic body: a uniform displacement does not change the gap, and is added
to the approach afterwards. Of a free half-space it is what the pressure gives.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from contactsim.contact.certificate import Certificate, certify_gap
from contactsim.elasticity.fourier_operator import Compliance
from contactsim.errors import InputError
from contactsim.grid import Array, TransformCounter, map_blocks


@dataclass(frozen=True)
class Scale:
    """Units of a problem, and what is left out of its approach.

    Parameters
    ----------
    step
        Length of a grid step, nm.
    pressure
        Unit of pressure E*·step/spacing, GPa.
    highest
        Largest height, nm.
    mean_displacement
        Mean displacement under the prescribed mean pressure, nm.
    """

    step: float
    pressure: float
    highest: float
    mean_displacement: float = 0.0


@dataclass(frozen=True)
class Profile:
    """Heights below the highest, in grid steps; computed by rows where they are read, so that no second array is held.

    Parameters
    ----------
    heights
        Heights (n,) or (ny, nx), nm.
    highest
        Largest height, nm.
    step
        Length of a grid step, nm.
    """

    heights: Array
    highest: float
    step: float

    def __getitem__(self, places: Any) -> Array:
        """Return the heights at some places."""
        values = self.heights[places] - self.highest
        values /= self.step
        return values

    def subtract_from(self, field: Array, threads: int) -> None:
        """Subtract the heights from a field, in place."""
        if field.ndim == 1:
            field -= self[:]
            return

        def subtract(low: int, high: int) -> None:
            """Subtract some rows."""
            field[low:high] -= self[low:high]

        map_blocks(subtract, field.shape, threads)


@dataclass(frozen=True)
class WarmStart:
    """A solution on fewer points, from which a cascade of grids can start.

    Parameters
    ----------
    pressure
        Pressure (m,) or (my, mx) in E*·step/spacing.
    gap
        Gap of the same shape, in grid steps of the problem that uses it.
    """

    pressure: Array
    gap: Array


@dataclass
class HardWallProblem:
    """The complementarity problem at one load step, without units; see the module's text.

    Parameters
    ----------
    profile
        Heights (n,) or (ny, nx), at most 0.
    compliance
        S.
    tolerance
        Largest gap in contact, and largest overlap elsewhere, in grid steps.
    load, approach
        Mean pressure, or approach beyond first touch; the other one is None.
    counter
        Counter of the work.
    warm_start
        Solution on fewer points, if there is one.
    """

    profile: Profile
    compliance: Compliance
    tolerance: float
    load: float | None
    approach: float | None
    counter: TransformCounter
    warm_start: WarmStart | None = None

    @cached_property
    def heights(self) -> Array:
        """Heights at all points; solvers of surfaces, where memory is short, read the profile instead."""
        return self.profile[...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Points in each direction."""
        return self.profile.heights.shape

    @property
    def size(self) -> int:
        """Number of points."""
        return self.profile.heights.size

    @property
    def is_separated(self) -> bool:
        """True where there is no contact to solve for: no load, or an approach before first touch."""
        return self.load == 0 if self.approach is None else self.approach <= 0

    @property
    def prescribed_load(self) -> float:
        """Mean pressure, for methods that need one to be prescribed."""
        if self.load is None:
            raise InputError("load", None, "a mean pressure: the approach is prescribed")
        return self.load

    def coarser(self, tolerance: float) -> HardWallProblem:
        """Return the problem on half of the points in each direction, in grid steps of its own; heights are sampled."""
        shape = tuple(size // 2 for size in self.shape)
        places = [np.arange(half) * size // half for half, size in zip(shape, self.shape, strict=True)]
        ratio = shape[-1] / self.shape[-1]
        sampled = self.profile[np.ix_(*places)] * ratio
        highest = float(sampled.max())
        approach = None if self.approach is None else self.approach * ratio + highest
        warm_start = self.warm_start and replace(self.warm_start, gap=self.warm_start.gap * ratio)
        return HardWallProblem(
            Profile(sampled, highest, 1.0),
            self.compliance.coarser(shape),
            tolerance,
            self.load,
            approach,
            self.counter,
            warm_start,
        )

    @property
    def usable_start(self) -> WarmStart | None:
        """Warm start if this grid has at most twice as many points along x as that has; None elsewhere."""
        start = self.warm_start
        return start if start is not None and self.shape[-1] <= 2 * start.pressure.shape[-1] else None

    def project(self, pressure: Array, out: Array | None = None) -> Array:
        """Return a pressure cut at zero and scaled to the prescribed load, in memory of its own or in `out`."""
        result = np.empty(pressure.shape, np.result_type(pressure, 0.0)) if out is None else out
        rows, given = np.atleast_2d(result, pressure)

        def cut(low: int, high: int) -> float:
            """Cut some rows and return the sum of what is left."""
            np.maximum(given[low:high], 0.0, out=rows[low:high])
            return float(rows[low:high].sum(dtype=float))

        mean = float(np.sum(map_blocks(cut, self.shape, self._threads))) / self.size
        if self.load is None:
            return result
        if not mean > 0:
            result[...] = self.load
            return result
        factor = self.load / mean

        def scale(low: int, high: int) -> None:
            """Scale some rows."""
            rows[low:high] *= factor

        map_blocks(scale, self.shape, self._threads)
        return result

    @property
    def _threads(self) -> int:
        """Threads that share the work on a field."""
        return self.compliance.grid.threads

    def certify(self, pressure: Array) -> tuple[Certificate, Array]:
        """Return the errors of a pressure, and its gap in grid steps, both computed from the pressure alone."""
        gap = self.compliance(pressure)
        self.profile.subtract_from(gap, self._threads)
        return certify_gap(gap, pressure, self.approach, self.load, self._threads), gap
