"""Problems of smooth laws on coarser grids of a line, and their displacements on finer ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.grid import Array
from contactsim.interface.wall_pressure import WallPressure


def coarsen(problem: CohesiveProblem, points: int, tolerance: float) -> CohesiveProblem:
    """Return a problem on fewer points, an even number; waves that these cannot carry are left out of heights."""
    grid, count = problem.grid.coarser((points,)), points // 2 + 1
    shape = problem.grid.forward(problem.shape[0])[:count]
    shape[-1] = 0
    gap = np.zeros((len(problem.shape), points))
    gap[0] = grid.backward(shape)
    factor = None
    if problem.slip_factor is not None:
        factor = np.where(np.arange(count) < count - 1, problem.slip_factor[:count], 0)
    stiffness = problem.stiffness.coarser(count)
    wall = None if problem.wall is None else WallPressure.zero(points, stiffness.diagonal[0], problem.law_stiffness)
    return replace(
        problem, grid=grid, shape=gap, stiffness=stiffness, slip_factor=factor, tolerance=tolerance, wall=wall
    )


def prolong(problem: CohesiveProblem, displacement: Array) -> Array:
    """Return a displacement of a coarser grid (exerted, m) on that of a problem, without its shortest wave."""
    out = np.zeros(problem.unknowns, complex)
    out[:, : displacement.shape[1] - 1] = displacement[:, :-1]
    return out
