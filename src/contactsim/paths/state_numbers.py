"""The numbers of states of cohesive laws, on a line and on a surface."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.grid import Array
from contactsim.observables.adhesion import find_peaks, gradients, state_observables, touching_peaks
from contactsim.observables.conformity import conformities, first_short_mode
from contactsim.observables.surface_adhesion import surface_observables
from contactsim.surfaces.height_statistics import STATISTICS
from contactsim.surfaces.statistics import local_squares


class StateReader(Protocol):
    """What reads the numbers of states of one path."""

    def numbers(self, problem: CohesiveProblem, displacement: Array, gap: Array, traction: Array) -> dict[str, float]:
        """Return the numbers of a state with a displacement (exerted, m), gap (read, n), traction (exerted, n).

        Gap and traction are those at the points of the heights.
        """
        ...

    def is_complete(self, numbers: dict[str, float]) -> bool:
        """Return True for the numbers of a state in which every gap is closed."""
        ...


class LineReader:
    """Numbers of states on a line, and what they need of the profile, which is found once for each grid.

    Parameters
    ----------
    problem
        The problem on the full grid.
    """

    def __init__(self, problem: CohesiveProblem) -> None:
        self._squares: dict[int, Array] = {}
        self._coefficients: dict[int, Array] = {}
        self._peaks: dict[int, Array] = {}
        self._length = problem.grid.lengths[0]
        self._first_short = first_short_mode(self._profile(problem))

    def _local_squares(self, problem: CohesiveProblem) -> Array:
        """Return the local squares of the slopes on the grid of a problem, (n,)."""
        points = problem.grid.size
        if points not in self._squares:
            self._squares[points] = local_squares(problem.shape[0], problem.grid.spacing[0])
        return self._squares[points]

    def _profile_peaks(self, problem: CohesiveProblem) -> Array:
        """Return the peaks of the profile on the grid of a problem, bool (n,)."""
        points = problem.grid.size
        if points not in self._peaks:
            self._peaks[points] = find_peaks(problem.shape[0])
        return self._peaks[points]

    def _profile(self, problem: CohesiveProblem) -> Array:
        """Return the Fourier coefficients of the undeformed gap on the grid of a problem, (m,), nm."""
        points = problem.grid.size
        if points not in self._coefficients:
            self._coefficients[points] = problem.grid.forward(problem.shape[0])
        return self._coefficients[points]

    def numbers(self, problem: CohesiveProblem, displacement: Array, gap: Array, traction: Array) -> dict[str, float]:
        """Return the numbers of a state; see `StateReader`."""
        before = self._profile(problem)
        return {
            **state_observables(problem, gap, traction),
            "touching_peaks": touching_peaks(self._profile_peaks(problem), np.abs(traction[0]) / problem.strength),
            **gradients(self._local_squares(problem), problem, gap, traction),
            **conformities(before, before + displacement[0], self._first_short),
        }

    def is_complete(self, numbers: dict[str, float]) -> bool:
        """Return True for the numbers of a state in which every gap is closed."""
        return numbers["contact_length"] >= self._length


class SurfaceReader:
    """Numbers of states on a surface, and what they need of its heights, which is found once for each grid.

    Parameters
    ----------
    problem
        The problem on the full grid.
    """

    def __init__(self, problem: CohesiveProblem) -> None:
        self._area = float(np.prod(problem.heights.lengths))
        self._squares: dict[int, Array] = {}

    def _local_squares(self, problem: CohesiveProblem) -> Array:
        """Return the local squares of the slopes at the heights' points of a problem, (n,)."""
        grid = problem.heights
        if grid.size not in self._squares:
            heights = problem.on_heights(problem.shape[0]).reshape(grid.shape)
            squares = STATISTICS[problem.heights_grid is None].local_squares(heights, grid.spacing)
            self._squares[grid.size] = squares.ravel()
        return self._squares[grid.size]

    def numbers(self, problem: CohesiveProblem, displacement: Array, gap: Array, traction: Array) -> dict[str, float]:
        """Return the numbers of a state; see `StateReader`."""
        numbers = surface_observables(problem, gap, traction)
        return numbers | gradients(self._local_squares(problem), problem, gap, traction)

    def is_complete(self, numbers: dict[str, float]) -> bool:
        """Return True for the numbers of a state in which every gap is closed."""
        return numbers["contact_area"] >= self._area


STATE_READERS: dict[int, type[LineReader] | type[SurfaceReader]] = {1: LineReader, 2: SurfaceReader}
"""Readers of states by the number of dimensions."""
