"""A contact set of a line: solved by elimination where it has few points, or preconditioned across its gaps."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from contactsim.contact.hard_wall import HardWallProblem
from contactsim.grid import Array
from contactsim.solvers.hard_wall.negative_gap_preconditioner import BlockStiffness, NegativeGapPreconditioner


class Line:
    """What all contact sets of a line share.

    Parameters
    ----------
    problem
        Problem of the line.

    Attributes
    ----------
    work
        Arrays (3, n) that every step overwrites.
    """

    def __init__(self, problem: HardWallProblem) -> None:
        self._problem = problem
        self.work = np.empty((3, problem.heights.size))

    @cached_property
    def response(self) -> Array:
        """Displacement (n,) at each distance from a point of unit pressure; it is even, so its sign does not matter.

        Under a prescribed load the problem has no compliance of the uniform mode. Here it has that of the longest wave,
        which makes the matrix of a contact set positive definite and changes the approach alone.
        """
        compliance, point = self._problem.compliance, np.zeros(self._problem.heights.size)
        point[0] = 1.0
        uniform = 0.0 if self._problem.load is None else compliance.symbol[1] / point.size
        return compliance(point) + uniform

    @cached_property
    def stiffness(self) -> BlockStiffness:
        """Stiffness of the line, for preconditioners."""
        return BlockStiffness(self._problem.compliance, uniform=self._problem.load is not None)


class ContactSet:
    """A contact set: its points, and its preconditioner, made when it is first asked for.

    Parameters
    ----------
    index
        Indices of its points (m,); at least one.
    line
        What it shares with other sets.
    """

    def __init__(self, index: Array, line: Line) -> None:
        self.index, self.line = index, line

    def only(self, pressure: Array) -> Array:
        """Return a pressure (n,) without what lies outside the set."""
        return _spread(pressure[self.index], self.index, pressure.size)

    @cached_property
    def preconditioner(self) -> NegativeGapPreconditioner:
        """Preconditioner of conjugate gradients on the set."""
        return NegativeGapPreconditioner(self.index, self.line.stiffness)

    def eliminate(self, problem: HardWallProblem) -> tuple[Array, ContactSet]:
        """Solve by elimination, and again without the points that pull, until none does; if all pull, they stay.

        Returns
        -------
        pressure, contact
            Pressure (n,), and the set of the points left.
        """
        index, load, approach = self.index, problem.load, problem.approach
        matrix = self.line.response[np.abs(np.subtract.outer(index, index))]
        right_sides = np.ones((index.size, 2))  # for the heights, and for all of them raised by one
        right_sides[:, 0] = problem.heights[index]
        while True:
            solution, of_approach = np.linalg.solve(matrix, right_sides).T
            if load is not None:
                approach = (load * problem.heights.size - solution.sum()) / of_approach.sum()
            solution += approach * of_approach
            stays = solution > 0
            if stays.all() or not stays.any():
                return _spread(solution, index, problem.heights.size), ContactSet(index, self.line)
            index, matrix, right_sides = index[stays], matrix[stays][:, stays], right_sides[stays]

    def gather(self, problem: HardWallProblem, pressure: Array) -> Array:
        """Return a pressure (n,) on the set: points outside give what they carried to their neighbours in it."""
        kept = self.preconditioner.gather(pressure)
        if problem.load is not None and kept.size == 1:
            kept[:] = problem.load * pressure.size  # exactly: a small load would be lost in rounding
        return _spread(kept, self.index, pressure.size)


def _spread(values: Array, index: Array, size: int) -> Array:
    """Return values at some points (m,), and zero elsewhere, (size,)."""
    field = np.zeros(size)
    field[index] = values
    return field
