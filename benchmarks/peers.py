"""Other codes on a problem of ours, to measure against, used by no other part of contactsim.

aspher: conjugate gradients of Polonsky and Keer in C++, preconditioned by |q| with a transform and started from a
cascade of grids (V. A. Yastrebov, aspher 0.1.3, on PyPI). Its compliance on a periodic half-space is ours, its
tolerance part of the range of heights. ContactMechanics: the same method on a single grid.
"""

from __future__ import annotations

import itertools
import time
from dataclasses import dataclass, replace

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.grid import Array

RUNGS = tuple(10 ** (-power / 2) for power in range(8, 29))
"""Tolerances tried: 1e-4 to 1e-14, two a decade."""
COARSEST = 64
"""Points along a side of aspher's coarsest grid, its default."""


def nearest_rung(tolerance: float) -> int:
    """The place in RUNGS of the tolerance nearest to one."""
    return int(np.argmin(np.abs(np.log(np.divide(RUNGS, tolerance)))))


@dataclass(frozen=True)
class Settings:
    """aspher's settings that cost and accuracy hang on; the others are its defaults."""

    tolerance: float
    precision: str
    coarse_tolerance: float

    def __str__(self) -> str:
        return f"{self.tolerance:.1e} {self.precision} {self.coarse_tolerance:g}"

    @classmethod
    def read(cls, text: str) -> Settings:
        """The settings that were written so; the tolerance, which was rounded, is one of RUNGS."""
        tolerance, precision, coarse = text.split()
        return cls(RUNGS[nearest_rung(float(tolerance))], precision, float(coarse))


def pressed(problem: HardWallProblem, settings: Settings) -> tuple[Array, float]:
    """Pressure (ny, nx), and the transforms made: two a product and two a preconditioning, one of which an iteration.

    Without units, as the problem is: spacing 1, E* = 1.
    """
    import aspher

    points = len(problem.heights)
    result = aspher.solve_nested(
        grid_size=points,
        gap=-problem.heights,
        p_nominal=problem.load,
        domain_size=float(points),
        E_star=1.0,
        backend="periodic",
        coarsest=COARSEST,
        tol=settings.tolerance,
        coarse_tol=settings.coarse_tolerance,
        precision=settings.precision,
        light_result=True,
    )
    spent = 0.0
    for stage in result.stage_stats:
        side = int(stage["name"].partition(":")[2])
        spent += 2 * (stage["matvec_count"] + stage["iterations"]) * (side / points) ** 2
    return result.pressure, spent


def pressed_by_contact_mechanics(problem: HardWallProblem, tolerance: float, *, is_free: bool) -> Array:
    """Pressure by ContactMechanics; a free half-space has a doubled grid, a periodic one that of the heights."""
    from ContactMechanics import FreeFFTElasticHalfSpace, PeriodicFFTElasticHalfSpace
    from ContactMechanics.Optimization import constrained_conjugate_gradients
    from SurfaceTopography import Topography, UniformLineScan

    heights, sizes = problem.heights.copy(), tuple(float(size) for size in problem.shape)
    substrate = FreeFFTElasticHalfSpace if is_free else PeriodicFFTElasticHalfSpace
    topography = UniformLineScan(heights, *sizes) if len(sizes) == 1 else Topography(heights, sizes)
    limits = dict.fromkeys(("pentol", "forcetol", "thermotol"), tolerance)
    load = problem.prescribed_load * problem.size
    found = constrained_conjugate_gradients(
        substrate(problem.shape, 1.0, sizes), topography, external_force=load, maxiter=20000, **limits
    )
    return np.array(found.jac)[tuple(map(slice, problem.shape))]


def quickest(problem: HardWallProblem, rung: int) -> tuple[Settings, int]:
    """The settings with the least CPU time, each at the loosest tolerance that is certified; and its place in RUNGS.

    rung: where to begin. Raises ValueError if nothing is certified.
    """
    found = {}
    for precision, coarse in itertools.product(("double", "float_then_double"), (1e-3, 1e-2)):
        spent: dict[int, float] = {}
        while 0 <= rung < len(RUNGS) and rung not in spent:
            spent[rung] = seconds(problem, Settings(RUNGS[rung], precision, coarse))
            rung += 1 if spent[rung] == float("inf") else -1
        certified = [place for place, time in spent.items() if time < float("inf")]
        if certified:
            rung = min(certified)
            found[spent[rung]] = Settings(RUNGS[rung], precision, coarse), rung
        rung = min(max(rung, 0), len(RUNGS) - 1)
    if not found:
        raise ValueError("nothing that aspher returned is certified")
    return found[min(found)]


def tightened(problem: HardWallProblem, settings: Settings) -> tuple[Settings, int]:
    """The settings at the loosest tolerance that is certified, from theirs on; and its place in RUNGS.

    Raises ValueError if nothing is certified.
    """
    for rung in range(nearest_rung(settings.tolerance), len(RUNGS)):
        tried = replace(settings, tolerance=RUNGS[rung])
        if seconds(problem, tried) < float("inf"):
            return tried, rung
    raise ValueError("nothing that aspher returned is certified")


def seconds(problem: HardWallProblem, settings: Settings) -> float:
    """CPU seconds of a solution; infinite if it is not certified."""
    begin = time.process_time()
    pressure, _ = pressed(problem, settings)
    spent = time.process_time() - begin
    certificate, _ = problem.certify(problem.project(pressure))
    return spent if certificate.met(problem.tolerance) else float("inf")
