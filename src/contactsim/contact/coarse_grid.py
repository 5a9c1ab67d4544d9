"""Problems of smooth laws on coarser grids, and their displacements on finer ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.grid import Array, Grid
from contactsim.interface.wall_pressure import WallPressure


def coarsen(problem: CohesiveProblem, ratio: int, tolerance: float) -> CohesiveProblem:
    """Return a problem on a grid with fewer points along each side; waves that these cannot carry are left out.

    Parameters
    ----------
    problem
        Problem of heights that repeat.
    ratio
        Points along a side over those of the coarse grid, which are an even number.
    tolerance
        Tolerance on the coarse grid.
    """
    grid = problem.grid.coarser(tuple(points // ratio for points in problem.grid.shape))
    places, shortest = _waves(grid, problem.grid)
    shape = problem.grid.forward_rows(problem.shape[:1])[:, places]
    shape[:, shortest] = 0
    gap = np.zeros((len(problem.shape), grid.size))
    gap[:1] = grid.backward_rows(shape)
    factor = None
    if problem.slip_factor is not None:
        factor = np.where(shortest, 0, problem.slip_factor[places])
    stiffness = problem.stiffness.coarser(places, shortest)
    wall = None if problem.wall is None else WallPressure.zero(grid.size, stiffness.diagonal[0], problem.law_stiffness)
    return replace(
        problem, grid=grid, shape=gap, stiffness=stiffness, slip_factor=factor, tolerance=tolerance, wall=wall
    )


def prolong(problem: CohesiveProblem, grid: Grid, displacement: Array) -> Array:
    """Return a displacement (exerted, m) of a coarser grid on that of a problem, without its shortest waves."""
    places, shortest = _waves(grid, problem.grid)
    out = np.zeros(problem.unknowns, complex)
    out[:, places[~shortest]] = displacement[:, ~shortest]
    return out


def _waves(grid: Grid, finer: Grid) -> tuple[Array, Array]:
    """Return the places of a grid's waves among those of a finer one, (m,), and which are the shortest, bool (m,)."""
    shortest = np.zeros(grid.half_shape, bool)
    shortest[..., -1] = True
    if len(grid.shape) > 1:
        shortest[grid.shape[0] // 2] = True
    return np.ravel_multi_index(grid.modes_of(finer), finer.half_shape).ravel(), shortest.ravel()
